// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/pair/accuracy_level.hpp"

#include <algorithm>
#include <cmath>

namespace flank
{
  int AccuracyLevel::face_layers(const double modules, const bool is_spur) const
  {
    const auto count = [&](const double length) { return static_cast<int>(std::lround(modules / length)); };
    return std::max({ fewest_layers, std::min(count(layer_length), enough_layers),
                      count(is_spur ? 1.6 * longest_layer : longest_layer) });
  }

  const std::array<AccuracyLevel, 3> &accuracy_levels()
  {
    static const std::array<AccuracyLevel, 3> levels = { {
        { .name = "draft",
          .flank_rows = 6,
          .tooth_columns = 4,
          .rim_layers = 6,
          .fillet_elements = 2,
          .fewest_layers = 2,
          .layer_length = 1.1,
          .longest_layer = 3.2,
          .enough_layers = 18,
          .grid = { .slices = 31, .profile_cells = 11 },
          .near_field_points = 4,
          .expected = { .mean_te = 0.28,
                        .peak_to_peak = 1.3,
                        .a1 = 0.6,
                        .pressure = 0.12,
                        .root_stress = 2.6,
                        .stated_mean_te = 0.48 } },
        { .name = "standard",
          .flank_rows = 9,
          .tooth_columns = 6,
          .rim_layers = 7,
          .fillet_elements = 2,
          .fewest_layers = 4,
          .layer_length = 0.67,
          .longest_layer = 2.6,
          .enough_layers = 30,
          .grid = { .slices = 41, .profile_cells = 11 },
          .near_field_points = 5,
          .expected = { .mean_te = 0.12,
                        .peak_to_peak = 1.1,
                        .a1 = 0.4,
                        .pressure = 0.11,
                        .root_stress = 1.3,
                        .stated_mean_te = 0.25 } },
        { .name = "reference",
          .flank_rows = 13,
          .tooth_columns = 8,
          .rim_layers = 9,
          .fillet_elements = 3,
          .fewest_layers = 6,
          .layer_length = 0.42,
          .longest_layer = 1.2,
          .enough_layers = 60,
          .grid = { .slices = 61, .profile_cells = 15 },
          .near_field_points = 6,
          .expected = { .mean_te = 0.05,
                        .peak_to_peak = 0.2,
                        .a1 = 0.2,
                        .pressure = 0.06,
                        .root_stress = 0.3,
                        .stated_mean_te = 0.12 } },
    } };
    return levels;
  }

  const AccuracyLevel &accuracy_level(const std::string &name)
  {
    const auto &levels = accuracy_levels();
    return *std::find_if(levels.begin(), levels.end() - 1,
                         [&](const auto &level) { return level.name == name; });
  }
} // namespace flank
