// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/process.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <malloc.h>
#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <system_error>

namespace flank
{
  namespace
  {
    bool output_is_closed = false;

    void set_up_streams()
    {
      for (const int stream : { STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO })
        if (fcntl(stream, F_GETFD) < 0)
          {
            output_is_closed = output_is_closed || stream == STDOUT_FILENO;
            open("/dev/null", O_RDWR); // else it would become some other file's
          }
    }

    constexpr int stops[] = { SIGINT, SIGTERM, SIGHUP, SIGUSR1, SIGUSR2, SIGXCPU };
    bool speaks = true; ///< of a stop: one process of all ranks does

    /// A run is stopped where it is: what it has finished stands in its journal, whole. (A study finishes the
    /// pieces in work first.)
    void stop_at_once(int)
    {
      constexpr char text[] = "stopped by a signal: go on with --resume\n";
      if (speaks) [[maybe_unused]]
        const auto written = write(STDERR_FILENO, text, sizeof text - 1);
      _exit(stopped_by_signal);
    }

    void block_stops(const int how)
    {
      sigset_t set;
      sigemptyset(&set);
      for (const int signal : stops)
        sigaddset(&set, signal);
      sigprocmask(how, &set, nullptr);
    }

    /// Under nohup it goes on ignoring SIGHUP.
    void set_up_signals()
    {
      const char *rank = std::getenv("OMPI_COMM_WORLD_RANK");
      speaks = !rank || rank == std::string_view("0");
      struct sigaction action = {}, before = {};
      action.sa_handler = stop_at_once;
      for (const int signal : stops)
        if (signal != SIGHUP || sigaction(signal, nullptr, &before) != 0 || before.sa_handler != SIG_IGN)
          sigaction(signal, &action, nullptr);
      // A pipe that nobody reads and a file that may not grow are errors of writing, which are checked.
      std::signal(SIGPIPE, SIG_IGN);
      std::signal(SIGXFSZ, SIG_IGN);
    }

    /// Matrices of contact grids come and go: their memory is kept instead of given back and cleared again (4
    /// % of a study). In a study it lies in large pages too (7 %), which the C library takes from the
    /// environment at its start alone: the program starts once more (1 ms; signals wait until it can take
    /// them). Elsewhere more would be cleared than used (1 s of the fields of a position).
    void set_up_memory(const int argc, char **argv)
    {
      mallopt(M_MMAP_THRESHOLD, 32 << 20);
      mallopt(M_TRIM_THRESHOLD, 1 << 30);
      constexpr const char *tunables = "GLIBC_TUNABLES", *large_pages = "glibc.malloc.hugetlb=1";
      if (argc < 2 || argv[1] != std::string_view("study"))
        return;
      if (const char *given = std::getenv(tunables))
        {
          if (given == std::string_view(large_pages))
            block_stops(SIG_UNBLOCK);
          return;
        }
      std::error_code error;
      const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
      block_stops(SIG_BLOCK);
      if (!error && setenv(tunables, large_pages, 0) == 0)
        execv(program.c_str(), argv); // returns only where it could not: then without
      block_stops(SIG_UNBLOCK);
    }

    /// Raises a limit to `enough` as far as it may be. Returns what it is then.
    rlim_t raised(const __rlimit_resource_t resource, const rlim_t enough)
    {
      rlimit limit = {};
      if (getrlimit(resource, &limit) != 0 || limit.rlim_cur >= enough) // RLIM_INFINITY is the greatest
        return std::max(limit.rlim_cur, enough);
      limit.rlim_cur = std::min(enough, limit.rlim_max);
      setrlimit(resource, &limit);
      getrlimit(resource, &limit);
      return limit.rlim_cur;
    }
  } // namespace

  void set_up_process(const int argc, char **argv)
  {
    set_up_streams();
    set_up_signals();
    set_up_memory(argc, argv);
  }

  void require_limits()
  {
    constexpr rlim_t files = 64, enough_files = 1024, stack = 2u << 20, enough_stack = 8u << 20;
    if (const rlim_t given = raised(RLIMIT_NOFILE, enough_files); given < files)
      throw std::system_error(
          EMFILE, std::generic_category(),
          fmt::format("the program may open {} files at a time and needs {}; raise the limit (ulimit -n)",
                      given, files));
    const rlim_t given = raised(RLIMIT_STACK, enough_stack);
    if (given < stack)
      throw std::system_error(
          ENOMEM, std::generic_category(),
          fmt::format("the program's stack may take {} kB and needs {}; raise the limit (ulimit -s)",
                      given / 1024, stack / 1024));
    pthread_attr_t attributes; // threads were given the size that the limit had at the start
    pthread_attr_init(&attributes);
    pthread_attr_setstacksize(&attributes, std::min(given, enough_stack));
    pthread_setattr_default_np(&attributes);
    pthread_attr_destroy(&attributes);
  }

  bool output_was_closed()
  {
    return output_is_closed;
  }
} // namespace flank
