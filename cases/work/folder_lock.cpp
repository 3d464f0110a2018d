// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/work/folder_lock.hpp"

#include "cases/files/checked_file.hpp"
#include "cases/work/host.hpp"
#include "mesh/base/errors.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <condition_variable>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <regex>
#include <sstream>
#include <thread>

namespace flank
{
  namespace
  {
    namespace fs = std::filesystem;
    using namespace std::chrono_literals;

    constexpr auto beat = 5s;
    constexpr auto silence = 60s;              ///< of an owner on another host, before it counts as dead
    constexpr std::uint64_t most_bytes = 4096; ///< of a lock
    constexpr const char *prefix = "lock-";
    constexpr const char *guard = "lock.guard"; ///< held while locks are looked at and changed

    std::string first_line(const std::string &path)
    {
      std::ifstream stream(path);
      std::string line;
      std::getline(stream, line);
      return line;
    }

    /// When a process started, in clock ticks since the boot: a later process of the same number has another
    /// one. Empty: there is none.
    std::string start_of(const long process)
    {
      const std::string stat = first_line(fmt::format("/proc/{}/stat", process));
      const auto name_end = stat.rfind(')');
      if (name_end == std::string::npos)
        return {};
      std::istringstream rest(stat.substr(name_end + 1));
      std::string word;
      for (int field = 3; field <= 22 && rest >> word; ++field)
        if (field == 3 && (word == "Z" || word == "X")) // ended, and not yet fetched by its parent
          return {};
      return word;
    }

    std::string name_space()
    {
      std::error_code error;
      return fs::read_symlink("/proc/self/ns/pid", error).string();
    }

    struct Owner
    {
      std::string host, boot, process, start;
      std::string processes; ///< the name space in which its number is one

      static Owner of_this_process()
      {
        return { host_name(), first_line("/proc/sys/kernel/random/boot_id"), std::to_string(getpid()),
                 start_of(getpid()), name_space() };
      }
      static Owner read(const std::string &path)
      {
        Owner owner;
        try
          {
            std::istringstream stream(content_of(path, most_bytes));
            for (std::string *line :
                 { &owner.host, &owner.boot, &owner.process, &owner.start, &owner.processes })
              std::getline(stream, *line);
          }
        catch (const std::runtime_error &)
          {
            return {};
          }
        const auto shown = [](const char c) {
          return std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '-' || c == '_';
        };
        const bool sound = owner.process.size() < 12 && owner.host.size() < 256 &&
                           std::all_of(owner.process.begin(), owner.process.end(),
                                       [](const char c) { return c >= '0' && c <= '9'; }) &&
                           std::all_of(owner.host.begin(), owner.host.end(), shown);
        return sound ? owner : Owner{};
      }
      std::string text() const
      {
        return host + "\n" + boot + "\n" + process + "\n" + start + "\n" + processes + "\n";
      }
      bool is_read() const { return !process.empty(); }
    };

    std::string path_of(const std::string &folder, const std::string &name)
    {
      return folder + "/" + prefix + name;
    }

    bool is_mine(const std::string &path, const std::string &own)
    {
      return Owner::read(path).text() == own;
    }

    /// A file of this process alone, for a moment while it holds the guard.
    std::string passing_file(const std::string &folder)
    {
      return fmt::format("{}/{}time-{}-{}", folder, prefix, host_name(), getpid());
    }

    /// The time by the file system's own clock, whatever this host's says.
    fs::file_time_type now_there(const std::string &folder)
    {
      const std::string path = passing_file(folder);
      std::error_code error;
      fs::remove(path, error);
      const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
      if (file >= 0)
        close(file);
      const auto time = fs::last_write_time(path, error);
      const bool known = !error;
      fs::remove(path, error);
      return known ? time : fs::file_time_type::clock::now();
    }

    bool alive(const std::string &folder, const std::string &path, const Owner &owner)
    {
      const Owner self = Owner::of_this_process();
      // A container has the host's name and boot, and does not see the host's processes.
      if (owner.host == self.host && owner.boot == self.boot && owner.processes == self.processes)
        return !owner.start.empty() && start_of(std::atol(owner.process.c_str())) == owner.start;
      std::error_code error;
      const auto last = fs::last_write_time(path, error);
      const auto since = now_there(folder) - last;
      return !error && since < silence && since > -silence;
    }

    /// Alone with the folder's locks, on every host that shares it.
    class Guard
    {
    public:
      explicit Guard(const std::string &folder)
      {
        const std::string path = folder + "/" + guard;
        for (;;)
          {
            file_ = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
            if (file_ < 0)
              throw OutputError(fmt::format("cannot write {}: {}", path, std::strerror(errno)));
            while (flock(file_, LOCK_EX) != 0 && errno == EINTR)
              ;
            struct stat here = {}, there = {};
            if (fstat(file_, &here) == 0 && stat(path.c_str(), &there) == 0 && here.st_ino == there.st_ino)
              return;
            close(file_); // its folder was removed meanwhile, and perhaps made again
            if (!fs::exists(folder))
              throw OutputError(fmt::format("{} was removed", folder));
          }
      }
      ~Guard() { close(file_); }
      Guard(const Guard &) = delete;

    private:
      int file_;
    };
  } // namespace

  struct FolderLock::Implementation
  {
    std::string folder, path, own;
    std::mutex mutex;
    std::condition_variable ended;
    bool end = false;
    std::jthread heart;

    /// Of this owner alone: where its folder was moved, somebody else's may stand in its place.
    void show_life()
    {
      std::unique_lock lock(mutex);
      while (!ended.wait_for(lock, beat, [this] { return end; }))
        if (is_mine(path, own))
          utimensat(AT_FDCWD, path.c_str(), nullptr, 0);
    }
  };

  FolderLock::FolderLock(const std::string &folder, const std::string &name, const Conflicts &conflicts)
      : implementation_(std::make_unique<Implementation>())
  {
    implementation_->folder = folder;
    implementation_->path = path_of(folder, name);
    implementation_->own = Owner::of_this_process().text();
    {
      const Guard guarded(folder);
      std::error_code error;
      for (const auto &entry : fs::directory_iterator(folder, error))
        {
          const std::string file = entry.path().filename();
          if (!file.starts_with(prefix))
            continue;
          if (file.starts_with(std::string(prefix) + "time-") && is_lock(file))
            {
              fs::remove(entry.path(),
                         error); // of a process that was killed: only one at a time has such a file
              continue;
            }
          const std::string other = file.substr(std::strlen(prefix));
          if (other != name && !conflicts(other))
            continue;
          if (entry.symlink_status(error).type() != fs::file_type::regular)
            throw InputError(fmt::format("{}: is not Flank's; move it away, or choose another folder with -o",
                                         entry.path().string()));
          const Owner owner = Owner::read(entry.path());
          // A process that was killed just then has left an empty one.
          if (!owner.is_read() && fs::file_size(entry.path(), error) > 0 && !error)
            throw InputError(fmt::format("{}: is not Flank's; move it away, or choose another folder with -o",
                                         entry.path().string()));
          if (alive(folder, entry.path(), owner))
            throw InputError(fmt::format("{} is in use by {}; wait for it, or choose another folder with -o",
                                         fs::path(folder).parent_path().string(),
                                         owner.is_read()
                                             ? fmt::format("process {} on {}", owner.process, owner.host)
                                             : fmt::format("somebody whose lock cannot be read ({})", file)));
          spdlog::info("process {} on {}, which worked here, is dead: going on in its place", owner.process,
                       owner.host);
          fs::remove(entry.path(), error);
        }
      // Whole under its name or not there, whenever this process is killed.
      const std::string beside = passing_file(folder);
      fs::remove(beside, error);
      CheckedFile file(beside);
      file.write(implementation_->own);
      file.finish();
      fs::rename(beside, implementation_->path, error);
      if (error)
        throw OutputError(fmt::format("cannot write {}: {}", implementation_->path, error.message()));
    }
    implementation_->heart = std::jthread([i = implementation_.get()] { i->show_life(); });
  }

  const std::string &FolderLock::owner() const
  {
    return implementation_->own;
  }

  bool FolderLock::is_held(const std::string &folder, const std::string &name, const std::string &owner)
  {
    const std::string path = path_of(folder, name);
    std::error_code error;
    if (!fs::exists(path, error) && !error)
      return false;
    const Owner there = Owner::read(path);
    return !there.is_read() || there.text() == owner;
  }

  FolderLock::~FolderLock()
  {
    {
      const std::lock_guard lock(implementation_->mutex);
      implementation_->end = true;
    }
    implementation_->ended.notify_all();
    implementation_->heart = {};
    std::error_code error;
    if (is_mine(implementation_->path, implementation_->own))
      fs::remove(implementation_->path, error);
  }

  bool FolderLock::is_lock(const std::string &file_name)
  {
    static const std::regex names("lock\\.guard|lock-(whole|part-[0-9]{1,9}-of-[0-9]{1,9}|time-.{1,200})");
    return file_name.size() < 256 && std::regex_match(file_name, names);
  }
} // namespace flank
