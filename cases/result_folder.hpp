// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <functional>
#include <string>

namespace flank
{
  /// The folder a run writes into. Files appear complete or not at all.
  class ResultFolder
  {
  public:
    /// Refuses (InputError) a folder that holds anything but results of Flank, unless forced, and one that cannot be
    /// written. Changes nothing.
    ResultFolder(std::string path, bool force);

    /// Creates the folder and removes results of an earlier run: from here on a run that stops leaves nothing that looks finished.
    /// resume: what a killed run has journalled stays.
    void begin(bool resume = false) const;

    /// Writes beside the final place, then renames. Throws ComputationError where it cannot.
    void write(const std::string &name, const std::string &content) const;
    void write(const std::string &name, const std::function<void(const std::string &path)> &writer) const;

    const std::string &path() const { return path_; }

  private:
    std::string path_;
  };
} // namespace flank
