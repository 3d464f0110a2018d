// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/parallel_axis/pair/pair_case.hpp"
#include "cases/parallel_axis/pair/stated_errors.hpp"
#include "contact/loaded/position_result.hpp"

#include <span>
#include <vector>

namespace flank
{
  /// The kind of the greatest pressure of one torque over a mesh cycle, whose positions are given.
  PressureKind pressure_kind(const ParallelAxisCase &input, const std::vector<PositionResult> &positions);

  /// The kinds of the greatest pressures of single positions. [torque][position]
  std::vector<std::vector<PressureKind>> pressure_kinds_of(
      const ParallelAxisCase &input, const std::vector<std::vector<PositionResult>> &at);

  /// Pressures away from kinks of the flanks and from edges, at one torque: they have a limit as cells
  /// shrink.
  class RegularPressures
  {
  public:
    /// The positions' widest contact and longest slice tell which turns of a flank are kinks. What is near
    /// one is the same on the case's grid, which they are of, and on the coarser one of its error estimate.
    /// The case is kept by reference.
    RegularPressures(const ParallelAxisCase &input, const std::vector<PositionResult> &positions);

    /// The greatest of a position, on either grid, over the slices that have no kink, no loaded edge and no
    /// face end in them or nearer than the contact is wide and a slice and so many slices more; 0: there is
    /// none. [MPa]
    double of(const PositionResult &position, double slices = 0) const;

    /// The greatest of a position at sharp edges and at face ends of any kind. [MPa]
    double at_edges(const PositionResult &position) const;

    /// The kind of the greatest pressure of these positions.
    PressureKind kind_of(std::span<const PositionResult> positions) const;

  private:
    /// The greatest inside the flanks in slices that have a kink that near, or within half a step between
    /// positions. [MPa]
    double at_kinks(std::span<const PositionResult> positions) const;

    static constexpr int most_slices = 31; ///< finer grids do not go nearer

    /// Whether either flank turns within less than two cells, which then see a kink, near a slice or where it
    /// is so many pitches on or back.
    bool has_kink(const LineLoad &line, double pitches, double slices) const;

    /// How near is near, along the face. [mm]
    double near(const LineLoad &line, double slices) const;

    const ParallelAxisCase &input_;
    double slice_;                       ///< [mm]
    double half_width_ = 0, height_ = 0; ///< greatest of all slices [mm]
  };
} // namespace flank
