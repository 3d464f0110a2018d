// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/wedge/face_table.hpp"

#include <array>
#include <vector>

namespace flank::wedge
{
  /// Means of a face table over rectangles on two strips, tabulated as a function of the place along the
  /// edge: the cells of two slices of a contact have the same strips.
  class StripMeans
  {
  public:
    /// The table is kept by reference.
    StripMeans(const FaceTable &table, const Strip &first, const Strip &second);

    /// Mean over two rectangles of half-lengths a and b, `along` apart. [1/mm]
    double mean(double along, double a, double b) const;

  private:
    static constexpr int points = 5;
    double at(double along) const;
    void tabulate(std::size_t interval);

    const FaceTable *table_;
    Strip first_, second_;
    bool smooth_;  ///< no kink where the places lie beside each other, because the strips keep off the edge
    double scale_; ///< length of the first interval [mm]
    /// Coefficients of powers on [0, 1] of polynomials through some points on intervals: one, then octaves.
    /// In the first one the polynomial is of the place's square where the function is smooth: it is even.
    /// Beyond them the table itself is asked.
    std::vector<std::array<double, points>> coefficient_;
  };
} // namespace flank::wedge
