// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/loaded/options.hpp"

#include <array>
#include <string>

namespace flank
{
  /// What a level of accuracy sets, where a case does not set it itself. Chosen with
  /// validation/work_precision/run: pressure asks for a finer grid, the transmission error for a finer mesh.
  struct AccuracyLevel
  {
    std::string name;

    int flank_rows;                     ///< elements along the involute
    int tooth_columns;                  ///< elements across the tooth
    int rim_layers;                     ///< elements from root to bore
    int fillet_elements;                ///< along the upper half of a root fillet, and along the lower half
    int fewest_layers;                  ///< of elements along the face, however narrow it is
    double layer_length, longest_layer; ///< of elements along the face: as usual, and in wide faces of
                                        ///< helical gears (of spur gears 1.6 times that) [modules]
    int enough_layers;                  ///< layers that are enough for a face until they are the longest ones
    ContactGridSize grid;
    int near_field_points; ///< of the near field's quadratures in each direction

    /// Errors to be expected before anything is computed: medians over the scenes of validation/run coverage
    /// with 16 positions (of the finest level: of the examples, validation/run work_precision), in % of the
    /// quantity, of what was wrong and of what the error estimate states.
    struct Expected
    {
      double mean_te, peak_to_peak, a1, pressure, root_stress;
      double stated_mean_te;
    } expected;

    /// Element layers across a face that is so many modules wide. Beyond 20 modules (25) no more of them
    /// until they are so long that the mean transmission error sees it: of helical gears at 20 modules layers
    /// of 2 modules take 0.2 %, of 3.3 0.6 %; of spur gears at 60 modules layers of 3.3 0.02 %, of 5 0.04 %,
    /// so that theirs may be twice as long.
    int face_layers(double modules, bool is_spur) const;
  };

  /// How many scenes these are of.
  constexpr int scenes_of_expected_errors = 124;

  /// All levels, the coarsest first.
  const std::array<AccuracyLevel, 3> &accuracy_levels();

  const AccuracyLevel &accuracy_level(const std::string &name);
} // namespace flank
