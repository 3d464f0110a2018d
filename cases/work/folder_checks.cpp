// SPDX-License-Identifier: GPL-2.0-or-later
// What must hold before results may come into a folder: nothing there is anybody else's.
#include "cases/work/folder_files.hpp"
#include "cases/work/result_folder.hpp"
#include "cases/work/work_folder.hpp"
#include "mesh/base/errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace flank
{
  namespace fs = std::filesystem;

  namespace
  {
    /// The folder that a report is made in: ".report-" and 16 hexadecimal digits.
    bool is_report_at_work(const std::string &name)
    {
      constexpr std::string_view head = ".report-";
      return name.starts_with(head) && name.size() == head.size() + 16 &&
             std::all_of(name.begin() + head.size(), name.end(),
                         [](const unsigned char c) { return std::isxdigit(c) != 0; });
    }

    [[noreturn]] void refuse_unlisted(const std::string &folder, const std::string &name)
    {
      throw InputError(fmt::format("-o {}: holds {}, which no manifest of Flank lists; it is not touched: "
                                   "move it away or choose another folder",
                                   folder, name));
    }

    [[noreturn]] void refuse_foreign(const std::string &folder, const std::string &name)
    {
      throw InputError(
          fmt::format("-o {}: holds {}, which is not a result of Flank; choose another folder or add --force",
                      folder, name));
    }
  } // namespace

  /// What has the name of the folder "fields" or "figures". Throws InputError where that is no folder, or
  /// holds what no manifest lists: a field in any case, anything else unless forced.
  void ResultFolder::require_own_subfolder(const std::string &name, const bool is_folder,
                                           const Manifest &old) const
  {
    if (!is_folder)
      throw InputError(fmt::format(
          "-o {}: {} in it is no folder; it is not touched: move it away or choose another folder",
          request_.path, name));
    std::vector<std::string> others;
    for (const std::string &file : files_in(fs::path(request_.path) / name))
      if (!old.files.contains(name + "/" + file))
        others.push_back(name + "/" + file);
    for (const std::string &other : others)
      if (name == "fields" && is_result_name(other)) // figures are reports' alone, which look for themselves
        refuse_unlisted(request_.path, other);
    if (!others.empty() && !request_.force)
      refuse_foreign(request_.path, others.front());
  }

  /// Throws InputError where something of somebody else's stands where results will.
  void ResultFolder::require_own_names(const Manifest &old) const
  {
    const fs::path folder = request_.path;
    std::error_code error;
    const fs::directory_iterator entries(folder, error);
    if (error && fs::exists(folder))
      throw InputError(fmt::format("-o {}: what is in it cannot be seen ({}); choose another folder",
                                   request_.path, error.message()));
    for (const auto &entry : entries)
      {
        const std::string name = entry.path().filename();
        const bool is_dir = entry.symlink_status(error).type() == fs::file_type::directory;
        if (name == Manifest::name || old.files.contains(name))
          continue;
        if (is_dir && is_report_at_work(name))
          continue; // reports clear away what a killed one has left
        if (name == work_folder_name)
          {
            if (is_dir && is_work_folder(entry.path()))
              continue;
            throw InputError(fmt::format("-o {}: holds {}, which is not Flank's; choose another folder",
                                         request_.path, name));
          }
        if (name == "fields" || name == "figures")
          require_own_subfolder(name, is_dir, old);
        else if (is_result_name(name))
          refuse_unlisted(request_.path, name);
        else if (!request_.force)
          refuse_foreign(request_.path, name);
      }
    for (const auto &[name, fingerprint] : old.files)
      if (is_there(folder / name) && !is_as_listed(folder / name, fingerprint))
        throw InputError(fmt::format(
            "-o {}: {} is not as Flank wrote it; it is not touched: move it away or choose another folder",
            request_.path, name));
  }

  void ResultFolder::require_no_inputs(const Manifest &old, const std::vector<std::string> &input_files) const
  {
    std::error_code error;
    for (const std::string &input : input_files)
      if (fs::path at = fs::canonical(input, error); !error)
        for (at = at.parent_path(); at.has_relative_path(); at = at.parent_path())
          if (fs::equivalent(at, work(), error) && !error)
            throw InputError(
                fmt::format("{}: lies in {}, which is cleared; copy it elsewhere", input, work()));
    for (const std::string &input : input_files)
      for (const auto &[name, fingerprint] : old.files)
        if (fs::equivalent(input, fs::path(request_.path) / name, error) && !error)
          throw InputError(fmt::format("{}: is a result in {}, which this run would replace; copy it "
                                       "elsewhere or choose another folder",
                                       input, request_.path));
  }

  void ResultFolder::require_same(const Manifest &old, const std::string &inputs) const
  {
    if (old.files.empty() || request_.force || (old.command == request_.command && old.inputs == inputs))
      return;
    throw InputError(fmt::format("-o {}: holds results of {}: {}; choose another folder or add --force",
                                 request_.path,
                                 old.command == request_.command ? "other inputs" : "flank " + old.command,
                                 old.command == request_.command ? first_difference(old.inputs, inputs)
                                                                 : "this is flank " + request_.command));
  }

  void ResultFolder::require_possible(const std::string &path) const
  {
    if (const std::error_code problem = try_to_make_folder(path))
      for (const std::errc why : { std::errc::permission_denied, std::errc::read_only_file_system,
                                   std::errc::no_such_file_or_directory, std::errc::not_a_directory,
                                   std::errc::operation_not_permitted, std::errc::filename_too_long,
                                   std::errc::too_many_symbolic_link_levels, std::errc::file_exists })
        if (problem == why)
          throw InputError(fmt::format("-o {}: {} cannot be made: {}; choose another folder", request_.path,
                                       path, problem.message()));
    make_folder(path);
  }
} // namespace flank
