// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/wedge/face_table.hpp"

#include <array>
#include <span>
#include <utility>

namespace flank::wedge
{
  /// Means of a face table over rectangles on two strips, tabulated as a function of the place along the
  /// edge: the cells of two slices of a contact have the same strips. What is not asked for is not tabulated.
  /// For one thread.
  class StripMeans
  {
  public:
    /// The table is kept by reference. `as_lines`: both strips are short beside their distances from the edge
    /// and count as lines along it, of which nothing is tabulated.
    StripMeans(const FaceTable &table, const Strip &first, const Strip &second, bool as_lines = false);

    /// Mean over two rectangles of half-lengths a and b, `along` apart. [1/mm]
    double mean(double along, double a, double b);

  private:
    static constexpr int points = 5, most_intervals = 7;
    using Coefficients = std::array<double, points>;
    double at(double along);
    double sum(std::span<const std::pair<double, double>> places);
    Coefficients tabulated(std::size_t interval) const;

    const FaceTable *table_;
    Strip first_, second_;
    bool as_lines_;
    bool smooth_;  ///< no kink where the places lie beside each other, because the strips keep off the edge
    double scale_; ///< length of the first interval [mm]
    std::size_t intervals_;
    /// Coefficients of powers on [0, 1] of polynomials through some points on intervals: one, then octaves;
    /// none yet where the last one is not a number. In the first one the polynomial is of the place's square
    /// where the function is smooth: it is even. Beyond them the table itself is asked.
    std::array<Coefficients, most_intervals> coefficient_;
  };
} // namespace flank::wedge
