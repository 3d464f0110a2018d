// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "solver/elements/field_piece.hpp"

namespace flank
{
  /// Writes a VTU file with higher-order cells (deal.II). Throws OutputError where it cannot.
  void write_vtu(const std::string &path, const FieldPiece &piece);

  /// A file that opens several pieces with the same arrays as one; names relative to its folder.
  void write_pvtu(const std::string &path, const std::vector<FieldPiece::Array> &arrays,
                  const std::vector<std::string> &pieces);

  /// A file that opens a series over time: the time and the name of each file, names relative to its folder.
  void write_pvd(const std::string &path, const std::vector<std::pair<double, std::string>> &files);
} // namespace flank
