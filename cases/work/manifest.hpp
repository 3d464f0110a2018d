// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/files/checked_file.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace flank
{
  /// What a folder of finished results holds, as its manifest.txt says: only files listed there, and as they
  /// were written, are ever replaced or removed.
  struct Manifest
  {
    std::string program;                      ///< the program that made the results: its revision
    std::string command;                      ///< "run" or "study"
    std::map<std::string, Fingerprint> files; ///< by path from the folder
    std::vector<std::string> failures;        ///< what was asked for and could not be computed, a line each
    std::string inputs;                       ///< everything the results depend on, line by line

    static constexpr const char *name = "manifest.txt";

    std::string text() const;

    /// The manifest that a text is; nothing where it is none.
    static std::optional<Manifest> parse(const std::string &text);

    /// The manifest that a file is; nothing where there is no file, or it is none.
    static std::optional<Manifest> read(const std::string &path);
  };

  /// In words for the user: the first line in which the inputs of results that are there and those of now
  /// differ.
  std::string first_difference(const std::string &there, const std::string &now);
} // namespace flank
