// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/work/result_folder.hpp"

#include "cases/work/folder_files.hpp"
#include "cases/work/journal.hpp"
#include "cases/work/work_folder.hpp"
#include "mesh/base/errors.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <climits>
#include <cstring>
#include <filesystem>
#include <thread>

namespace flank
{
  namespace fs = std::filesystem;

  namespace
  {
    /// The first folder on the way to a path that is not there; empty: all are.
    std::string topmost_missing(fs::path path)
    {
      std::string missing;
      for (; !path.empty() && !is_there(path); path = path.parent_path())
        missing = path.string();
      return missing;
    }
  } // namespace

  ResultFolder::ResultFolder(Request request)
      : request_(std::move(request))
  {
    std::string &path = request_.path;
    while (path.size() > 1 && path.ends_with('/')) // else no parent of a file in it equals it
      path.pop_back();
    struct stat state = {};
    if (path.empty())
      throw InputError("-o: is empty; give a folder");
    constexpr std::size_t most_letters = PATH_MAX - 200; // the names of results come behind it
    if (fs::absolute(path).native().size() > most_letters)
      throw InputError(
          fmt::format("-o {}...: {} letters with the folders it lies in, at most {} can be used; "
                      "choose another folder",
                      path.substr(0, 80), fs::absolute(path).native().size(), most_letters));
    if (stat(path.c_str(), &state) != 0 && errno != ENOENT)
      throw InputError(fmt::format("-o {}: {}; choose another folder",
                                   path.size() > 300 ? path.substr(0, 300) + "..." : path,
                                   std::strerror(errno)));
    fs::path existing = fs::absolute(path);
    if (is_there(existing) && !fs::is_directory(existing))
      throw InputError(fmt::format("-o {}: is {}; give a folder", path,
                                   fs::exists(existing) ? "a file" : "a link that leads nowhere"));
    while (!fs::exists(existing) && existing.has_parent_path() && existing != existing.parent_path())
      existing = existing.parent_path();
    if (!fs::is_directory(existing) || access(existing.c_str(), W_OK | X_OK) != 0)
      throw InputError(
          fmt::format("-o {}: {} cannot be written; choose another folder", path, existing.string()));
  }

  bool ResultFolder::is_result_name(const std::string &name) const
  {
    const auto ends = [&](const char *ending) { return name.ends_with(ending); };
    const bool is_flat = std::ranges::count(name, '/') == 1; // what lies deeper may lie behind a link
    if (name.starts_with("fields/"))
      return is_flat && (ends(".vtu") || ends(".pvtu") || ends(".pvd") || ends("/view.py"));
    if (name.starts_with("figures/"))
      return is_flat && (ends(".svg") || ends(".png") || ends(".csv"));
    return std::find(request_.names.begin(), request_.names.end(), name) != request_.names.end();
  }

  std::string ResultFolder::work() const
  {
    return request_.path + "/" + work_folder_name;
  }

  std::string ResultFolder::staged() const
  {
    return work() + "/new";
  }

  Manifest ResultFolder::listed() const
  {
    const fs::path path = fs::path(request_.path) / Manifest::name;
    if (!is_there(path))
      return {};
    auto manifest = Manifest::read(path);
    if (!manifest || std::any_of(manifest->files.begin(), manifest->files.end(),
                                 [&](const auto &file) { return !is_result_name(file.first); }))
      throw InputError(fmt::format(
          "-o {}: its {} is damaged or not Flank's: what belongs to whom is not known; choose another folder",
          request_.path, Manifest::name));
    return std::move(*manifest);
  }

  /// The manifest of results that are complete and about to be put in their places.
  std::optional<Manifest> ResultFolder::ready() const
  {
    return says_it_is_ours(work()) ? Manifest::read(work() + "/" + Manifest::name) : std::nullopt;
  }

  void ResultFolder::make_work_folder(const std::string &inputs) const
  {
    make_folder(work());
    const std::string path = work() + "/" + work_folder_marker,
                      text = std::string(work_folder_marker_head) + "\n" + request_.command + "\n" + inputs;
    if (is_there(path))
      {
        std::string there;
        try
          {
            there = content_of(path, 1u << 30);
          }
        catch (const std::runtime_error &)
          {
          }
        if (there == text)
          return;
        if (!there.starts_with(work_folder_marker_head))
          throw InputError(fmt::format("-o {}: holds {}, which is not Flank's; choose another folder",
                                       request_.path, work_folder_name));
        if (request_.resume)
          throw InputError(fmt::format(
              "--resume: {} was made from other inputs: {}; run without --resume", work(),
              first_difference(there.substr(std::min(there.size(), std::strlen(work_folder_marker_head) + 1)),
                               request_.command + "\n" + inputs)));
        if (!request_.force)
          throw InputError(fmt::format(
              "-o {}: holds unfinished work of other inputs: {}; choose another folder or add --force",
              request_.path,
              first_difference(there.substr(std::min(there.size(), std::strlen(work_folder_marker_head) + 1)),
                               request_.command + "\n" + inputs)));
        clear_work_folder(true);
        fs::remove(path);
      }
    // Under its name it is complete.
    const std::string beside = fmt::format("{}.{}", path, getpid());
    std::error_code error;
    fs::remove(beside, error);
    CheckedFile file(beside);
    file.write(text);
    file.finish();
    fs::rename(beside, path, error);
    if (error)
      throw OutputError(fmt::format("cannot write {}: {}", path, error.message()));
  }

  /// What an earlier process of these results staged; its journals too, or not.
  void ResultFolder::clear_work_folder(const bool journals) const
  {
    std::error_code error;
    for (const std::string &name : files_in(staged()))
      if (is_result_name(name))
        fs::remove(fs::path(staged()) / name, error);
    for (const char *folder : { "/fields", "/figures", "" })
      remove_if_empty(staged() + folder);
    fs::remove(work() + "/" + Manifest::name, error);
    if (journals)
      for (const std::string &name : Journal::files(work()))
        fs::remove(work() + "/" + name, error);
  }

  ResultFolder::Held ResultFolder::held(const std::string &inputs,
                                        const std::vector<std::string> &input_files) const
  {
    const Manifest old = listed();
    require_no_inputs(old, input_files);
    require_own_names(old);
    if (old.files.empty() || old.command != request_.command || old.inputs != inputs)
      {
        require_same(old, inputs);
        return { .these = false, .missing = {} };
      }
    const auto missing = std::ranges::find_if(old.files, [&](const auto &file) {
      const bool is_of_report = file.first == "report.html" || file.first.starts_with("figures/");
      return !is_of_report && !is_there(fs::path(request_.path) / file.first);
    });
    return { .these = missing == old.files.end(),
             .missing = missing == old.files.end() ? std::string() : missing->first };
  }

  void ResultFolder::lock(const bool is_part)
  {
    constexpr int most = 20;
    for (int tries = 1;; ++tries)
      try
        {
          require_possible(work());
          lock_ = std::make_shared<FolderLock>(work(), lock_name(), [&](const std::string &other) {
            return !is_part || other == "whole" || request_.force;
          });
          return;
        }
      catch (const OutputError &)
        {
          if (tries == most) // else the end of another run may have removed it just now
            throw;
          std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
  }

  void ResultFolder::remove_made() const
  {
    const fs::path top = made_;
    for (fs::path folder = request_.path; !made_.empty() && !folder.empty(); folder = folder.parent_path())
      {
        remove_if_empty(folder);
        if (folder == top)
          return;
      }
  }

  ResultFolder::Start ResultFolder::begin(const std::string &inputs,
                                          const std::vector<std::string> &input_files)
  {
    inputs_ = inputs;
    const bool is_part = !request_.part.empty(), goes_on = request_.resume || is_part;
    made_ = topmost_missing(request_.path);
    for (int tries = 0; is_there(work()) && !is_work_folder(work()); ++tries)
      if (constexpr int most = 20; tries == most) // another run may be making or removing it just now
        throw InputError(fmt::format("-o {}: holds {}, which is not Flank's; choose another folder",
                                     request_.path, work_folder_name));
      else
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    if (!ready() && held(inputs, input_files).these && goes_on && !is_there(work()))
      return Start::finished;
    require_possible(request_.path);
    try
      {
        lock(is_part);
        owner_ = lock_->owner();
        // Another run may have been here since the folder was looked at. What a killed process was putting in
        // place is put there first.
        const auto fresh = ready();
        if (fresh)
          {
            swap(*fresh);
            clear_work_folder(true);
          }
        const Held there = held(inputs, input_files);
        if (goes_on && !there.missing.empty())
          spdlog::warn("{}/{} is gone: these results are computed again", request_.path, there.missing);
        if (there.these && goes_on && (fresh || !is_there(work() + "/" + work_folder_marker)))
          {
            clear_away();
            return Start::finished;
          }
        make_work_folder(inputs);
        if (!is_part)
          clear_work_folder(!goes_on);
        make_folder(staged());
      }
    catch (...)
      {
        lock_.reset();
        owner_.clear();
        std::error_code error;
        if (!is_there(work() + "/" + work_folder_marker))
          {
            fs::remove(work() + "/lock.guard", error);
            remove_if_empty(work());
          }
        remove_made();
        throw;
      }
    return Start::begun;
  }

  std::string ResultFolder::lock_name() const
  {
    return request_.part.empty() ? "whole" : "part-" + request_.part;
  }

  bool ResultFolder::is_lost() const
  {
    return !owner_.empty() && !FolderLock::is_held(work(), lock_name(), owner_);
  }

  void ResultFolder::require_not_lost() const
  {
    if (is_lost())
      throw OutputError(fmt::format("{} was moved or removed, or somebody took it over, while this {} worked "
                                    "in it: nothing is written there; if it was moved, put it back",
                                    request_.path, request_.command));
  }

  void ResultFolder::write(const std::string &name, const std::string &content) const
  {
    write(name, [&](const std::string &path) {
      CheckedFile file(path);
      file.write(content);
      file.finish();
    });
  }

  void ResultFolder::write(const std::string &name,
                           const std::function<void(const std::string &path)> &writer) const
  {
    require_not_lost();
    const fs::path path = fs::path(staged()) / name;
    make_folder(path.parent_path());
    writer(path);
    synchronise(path);
  }

  /// Moves the results from the work folder to their places. Can be begun again after a kill at any point.
  void ResultFolder::swap(const Manifest &fresh) const
  {
    const fs::path folder = request_.path, from = staged();
    const Manifest old = listed();
    const auto is_done = [&](const std::string &name, const Fingerprint &fingerprint) {
      return is_there(folder / name) && is_as_listed(folder / name, fingerprint) && !is_there(from / name);
    };
    // Nothing is moved unless everything can be.
    for (const auto &[name, fingerprint] : fresh.files)
      {
        const fs::path place = folder / name;
        const auto known = old.files.find(name);
        if (is_there(place) && !is_as_listed(place, fingerprint) &&
            (known == old.files.end() || !is_as_listed(place, known->second)))
          throw OutputError(
              fmt::format("cannot write {}, which is not Flank's; the new results wait in {}: move it away",
                          place.string(), from.string()));
        if (const fs::path parent = place.parent_path();
            parent != folder && is_there(parent) && !is_folder(parent))
          throw OutputError(
              fmt::format("cannot write {}: {} is no folder; the new results wait in {}: move it away",
                          place.string(), parent.string(), from.string()));
        if (!is_there(from / name) && !is_done(name, fingerprint))
          throw OutputError(
              fmt::format("cannot write {}: {} is gone", place.string(), (from / name).string()));
      }
    for (const auto &[name, fingerprint] : fresh.files)
      {
        const fs::path place = folder / name, source = from / name;
        if (is_done(name, fingerprint))
          continue; // before a kill
        make_folder(place.parent_path());
        std::error_code problem;
        fs::rename(source, place, problem);
        if (problem)
          throw OutputError(fmt::format("cannot write {}: {}", place.string(), problem.message()));
      }
    for (const auto &[name, fingerprint] : old.files)
      if (const fs::path parent = (folder / name).parent_path();
          !fresh.files.contains(name) && is_there(folder / name) && (parent == folder || is_folder(parent)))
        {
          std::error_code error;
          if (is_as_listed(folder / name, fingerprint))
            fs::remove(folder / name, error);
          else
            spdlog::warn("{} is not as Flank wrote it: it stays", (folder / name).string());
        }
    for (const char *sub : { "fields", "figures" }) // those that results lay in, not somebody's own
      if (std::ranges::any_of(
              old.files, [&](const auto &file) { return file.first.starts_with(std::string(sub) + "/"); }))
        remove_if_empty(folder / sub);
    std::error_code problem;
    fs::rename(work() + "/" + Manifest::name, folder / Manifest::name, problem);
    if (problem)
      throw OutputError(
          fmt::format("{} cannot be written: {}", (folder / Manifest::name).string(), problem.message()));
    synchronise(folder);
  }

  void ResultFolder::finish(const std::vector<std::string> &failures)
  {
    Manifest fresh{
      .program = request_.program, .command = request_.command, .files = {}, .failures = {}, .inputs = inputs_
    };
    for (std::string failure : failures)
      {
        std::ranges::replace(failure, '\n', ' ');
        fresh.failures.push_back(std::move(failure));
      }
    require_not_lost();
    for (const std::string &name : files_in(staged()))
      if (is_result_name(name))
        fresh.files.emplace(name, fingerprint_of_file(staged() + "/" + name));
    // Complete under its name or not there: it says that everything is ready to be put in place.
    const std::string beside = work() + "/ready.txt", path = work() + "/" + Manifest::name;
    std::error_code problem;
    fs::remove(beside, problem);
    CheckedFile file(beside);
    file.write(fresh.text());
    file.finish();
    fs::rename(beside, path, problem);
    if (problem)
      throw OutputError(fmt::format("cannot write {}: {}", path, problem.message()));
    swap(fresh);
    clear_away();
  }

  void ResultFolder::discard()
  {
    if (!is_lost() && request_.part.empty()) // else what stands there is somebody else's too
      clear_away();
    lock_.reset();
    owner_.clear();
  }

  void ResultFolder::clear_away()
  {
    std::error_code error;
    clear_work_folder(true);
    for (const auto &entry : fs::directory_iterator(work(), error))
      if (const std::string name = entry.path().filename();
          name == work_folder_marker || is_marker_at_work(name) || name == "ready.txt")
        fs::remove(entry.path(), error);
    lock_.reset();
    owner_.clear();
    fs::remove(work() + "/lock.guard", error);
    remove_if_empty(work());
    remove_made();
  }
} // namespace flank
