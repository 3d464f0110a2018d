// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/parallel_axis/pair/pair_case.hpp"
#include "contact/loaded/position_result.hpp"

#include <string>
#include <vector>

namespace flank
{
  /// Whether the greatest pressure has a limit as cells shrink, and if not, why.
  enum class PressureKind
  {
    regular,
    kink, ///< it is, or may be between positions, where a flank's slope jumps
    edge  ///< tips, cut cells and face ends carry more than the flanks inside do
  };

  /// Names of the kinds in tables, in the order of PressureKind.
  const std::vector<std::string> &pressure_kinds();

  /// The kind of the greatest pressure of one torque over a mesh cycle, whose positions are given.
  PressureKind pressure_kind(const ParallelAxisCase &input, const std::vector<PositionResult> &positions);

  /// Pressures away from kinks of the flanks and from edges, at one torque: they have a limit as cells
  /// shrink.
  class RegularPressures
  {
  public:
    /// `grid`: of the positions, whose widest contact and longest slice tell which turns are kinks to it. The
    /// case is kept by reference.
    RegularPressures(const ParallelAxisCase &input, const ContactGridSize &grid,
                     const std::vector<PositionResult> &positions);

    /// The greatest of a position over the slices that have no kink in or beside them, no loaded edge and no
    /// face end nearer than the contact is wide and so many slices more; 0: there is none. [MPa]
    double of(const PositionResult &position, double slices = 0) const;

    /// The greatest inside the flanks in slices that meet a kink there or within half a step between
    /// positions. [MPa]
    double at_kinks(const std::vector<PositionResult> &positions) const;

  private:
    /// Whether either flank turns within less than two cells, which then see a kink, where a slice carries,
    /// two cells beside, so many pitches on or back, or so much further along the face [mm].
    bool has_kink(const LineLoad &line, double pitches, double more) const;

    double cell(double half_width) const; ///< across a contact so wide [mm]

    const ParallelAxisCase &input_;
    ContactGridSize grid_;
    double half_width_ = 0, height_ = 0; ///< greatest of all slices [mm]
  };
} // namespace flank
