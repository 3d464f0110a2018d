// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/result_folder.hpp"

#include "cases/journal.hpp"
#include "mesh/base/errors.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>

#include <unistd.h>

namespace flank
{
  namespace
  {
    namespace fs = std::filesystem;

    bool is_result_file(const std::string &name)
    {
      static const std::set<std::string> names = {
        "te.csv",         "harmonics.csv",   "pairs.csv",          "lines.csv",     "pattern.csv",  "modifications.csv",
        "subsurface.csv", "root_stress.csv", "error_estimate.csv", "sidebands.csv", "unloaded.csv", "results.h5",
        "summary.txt",    "case.toml",       "designs.csv",        "study.h5",      "report.html"
      };
      return names.contains(name) || name.ends_with(".partial") || Journal::is_journal(name);
    }
    /// A folder of fields or of a report's figures (each as SVG, PNG and CSV) with nothing else in it.
    bool is_result_subfolder(const fs::path &folder)
    {
      static const std::regex field("(pinion|gear|bodies|contact|drive|pressure)_.*Nm.*\\.p?v(tu|d)(\\.partial)?|view\\.py(\\.partial)?");
      if (!fs::is_directory(folder) || (folder.filename() != "fields" && folder.filename() != "figures"))
        return false;
      for (const auto &entry : fs::directory_iterator(folder))
        {
          const auto has = [&](const char *ending) { return fs::exists(fs::path(entry.path()).replace_extension(ending)); };
          if (!entry.is_regular_file() || (folder.filename() == "fields" ? !std::regex_match(entry.path().filename().string(), field)
                                                                         : !has(".svg") || !has(".png") || !has(".csv")))
            return false;
        }
      return true;
    }

    bool is_result(const fs::path &path)
    {
      return is_result_file(path.filename()) || is_result_subfolder(path);
    }
  } // namespace

  ResultFolder::ResultFolder(std::string path, const bool force)
      : path_(std::move(path))
  {
    fs::path existing = fs::absolute(path_);
    if (fs::exists(existing) && !fs::is_directory(existing))
      throw InputError(fmt::format("-o {}: is a file; give a folder", path_));
    while (!fs::exists(existing) && existing.has_parent_path() && existing != existing.parent_path())
      existing = existing.parent_path();
    if (!fs::is_directory(existing) || access(existing.c_str(), W_OK | X_OK) != 0)
      throw InputError(fmt::format("-o {}: {} cannot be written; choose another folder", path_, existing.string()));
    if (force || !fs::exists(path_))
      return;
    for (const auto &entry : fs::directory_iterator(path_))
      if (const std::string name = entry.path().filename(); !is_result(entry.path()))
        throw InputError(fmt::format("-o {}: holds {}, which is not a result of Flank; choose another folder or add --force", path_, name));
  }

  void ResultFolder::begin(const bool resume) const
  {
    std::error_code problem;
    fs::create_directories(path_, problem);
    if (problem)
      throw InputError(fmt::format("-o {}: cannot be made: {}; choose another folder", path_, problem.message()));
    for (const auto &entry : fs::directory_iterator(path_))
      if (const std::string name = entry.path().filename();
          is_result(entry.path()) && !(resume && (Journal::is_journal(name) || name.ends_with(".journal.partial"))))
        fs::remove_all(entry.path());
  }

  void ResultFolder::write(const std::string &name, const std::string &content) const
  {
    write(name, [&](const std::string &path) {
      std::ofstream stream(path, std::ios::binary);
      stream << content;
      if (!stream.flush())
        throw ComputationError(fmt::format("cannot write {}", path));
    });
  }

  void ResultFolder::write(const std::string &name, const std::function<void(const std::string &path)> &writer) const
  {
    const fs::path path = fs::path(path_) / name, partial = fs::path(path_) / (name + ".partial");
    try
      {
        if (path.parent_path() != fs::path(path_))
          fs::create_directories(path.parent_path());
        writer(partial.string());
        fs::rename(partial, path);
      }
    catch (const fs::filesystem_error &error)
      {
        throw ComputationError(error.what());
      }
  }
} // namespace flank
