// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/base/memory.hpp"

#include "mesh/base/errors.hpp"
#include "mesh/base/parallel.hpp"

#include <fmt/format.h>

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>

namespace flank
{
  namespace
  {
    /// What a line "Name:  123 kB" of a file under /proc says. [bytes]
    std::optional<double> kilobytes_of(const std::string &file, const std::string &name)
    {
      std::ifstream stream(file);
      for (std::string word; stream >> word;)
        if (double value = 0; word == name && stream >> value)
          return 1024 * value;
      return std::nullopt;
    }

    std::optional<double> number_in(const std::string &file)
    {
      std::ifstream stream(file);
      double value = 0;
      return stream >> value ? std::optional(value) : std::nullopt; // "max": none
    }

    /// What the control groups of this process leave of their limits, those they stand in too, of both
    /// versions.
    std::optional<double> left_by_control_groups()
    {
      std::optional<double> least;
      std::ifstream groups("/proc/self/cgroup");
      for (std::string line; std::getline(groups, line);)
        {
          const auto first = line.find(':'), second = line.find(':', first + 1);
          if (second == std::string::npos)
            continue;
          const std::string controllers = line.substr(first + 1, second - first - 1);
          const bool unified = controllers.empty();
          if (!unified && controllers.find("memory") == std::string::npos)
            continue;
          const std::string root = unified ? "/sys/fs/cgroup" : "/sys/fs/cgroup/memory";
          for (std::filesystem::path path = line.substr(second + 1);; path = path.parent_path())
            {
              const std::string folder = root + path.string() + "/";
              const auto limit = number_in(folder + (unified ? "memory.max" : "memory.limit_in_bytes")),
                         used = number_in(folder + (unified ? "memory.current" : "memory.usage_in_bytes"));
              if (limit && used && *limit < 1e18)
                {
                  // What is kept of files goes when it is needed.
                  std::ifstream stat(folder + "memory.stat");
                  double files = 0;
                  std::string name;
                  for (double value = 0; stat >> name >> value;)
                    if (name == "inactive_file" || name == "total_inactive_file")
                      files = value;
                  least = std::min(least.value_or(1e300), std::max(0.0, *limit - *used + files));
                }
              if (!path.has_relative_path())
                break;
            }
        }
      return least;
    }

    /// Reserved and never used, beside what is: libraries, the stacks and heaps of threads, the work space of
    /// the linear algebra. [bytes]
    double reserved_only()
    {
      return 0.7e9 + 0.2e9 * available_threads();
    }
  } // namespace

  MemoryLimit available_memory(const int processes)
  {
    MemoryLimit least{ kilobytes_of("/proc/meminfo", "MemAvailable:").value_or(1e300) / processes,
                       "free on this machine" };
    const auto also = [&](const std::optional<double> bytes, const char *by) {
      if (bytes && *bytes < least.bytes)
        least = { *bytes, by };
    };
    if (const auto left = left_by_control_groups())
      also(*left / processes, "left by this process's control group");
    const auto left = [](const int resource, const char *used_name,
                         const double reserved) -> std::optional<double> {
      rlimit limit = {};
      if (getrlimit(resource, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
        return std::nullopt;
      return std::max(0.0, static_cast<double>(limit.rlim_cur) -
                               kilobytes_of("/proc/self/status", used_name).value_or(0) - reserved);
    };
    also(left(RLIMIT_AS, "VmSize:", reserved_only()),
         "left by ulimit -v beside what the program itself takes (about 1 GB)");
    also(left(RLIMIT_DATA, "VmData:", 0.5 * reserved_only()),
         "left by ulimit -d beside what the program itself takes (about 0.5 GB)");
    return least;
  }

  double machine_memory()
  {
    return static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  }

  void require_memory(const double bytes, const int processes, const std::string &what,
                      const std::string &remedy)
  {
    const MemoryLimit limit = available_memory(processes);
    if (bytes > limit.bytes)
      throw InputError(fmt::format(
          "{} would need about {:.3g} GB{}, {:.3g} GB are {}; {}", what, 1e-9 * bytes,
          processes > 1 ? fmt::format(" in each of {} processes, of which each has a share", processes) : "",
          1e-9 * limit.bytes, limit.by, remedy));
  }
} // namespace flank
