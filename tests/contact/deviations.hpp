// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/parallel_axis/whole_case.hpp"
#include "cases/results/harmonics.hpp"
#include "cases/scenes.hpp"
#include "mesh/base/units.hpp"
#include "tests/contact/small_mesh.hpp"
#include "tests/messages.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

// Bodies, rigid flanks and case files that the tests of deviations share.

namespace flank
{
  inline LoadedPair mesh_of(const GearPair &pair, const MeshDeviations &deviations = {},
                            const Mounting &pinion = {}, const Mounting &gear = {},
                            const int slices = small_grid.slices)
  {
    const BodyCompliance &b = small_body(pair.data.helix_angle);
    LoadedPair mesh = small_loaded_pair(pair, b, b, deviations, { slices, small_grid.profile_cells });
    mesh.bodies.pinion_mounting = pinion;
    mesh.bodies.gear_mounting = gear;
    return mesh;
  }

  inline MeshDeviations on_pinion(std::shared_ptr<const FlankModification> modification)
  {
    MeshDeviations deviations;
    deviations.pinion.modifications = { std::move(modification) };
    return deviations;
  }

  /// Peak amplitude of the first mesh harmonic over eight positions. [um]
  inline double first_harmonic(const LoadedPair &mesh, const double torque, const int positions = 8)
  {
    std::vector<double> values;
    for (int k = 0; k < positions; ++k)
      values.push_back(te(mesh.bodies.pair, mesh.solve(1.0 * k / positions, { torque })[0]));
    return harmonics(values)[0].amplitude;
  }

  /// Least gap of rigid flanks over the plane of action, along the line of action [mm]: sampled without the
  /// scene's code. In the canonical frame (right hand, counter-clockwise).
  template <class Gap>
  double rigid_error(const GearPair &pair, const double phase, const Gap &normal_gap)
  {
    double least = 1e9;
    for (int k = -3; k <= 3; ++k)
      for (int i = 0; i <= 4000; ++i)
        {
          const double z = -10 + i * 0.005,
                       roll = std::tan(20 * units::degree) + (phase + k) * 2 * units::pi / 50 +
                              z * std::tan(pair.data.helix_angle) / 75,
                       mate = 2 * std::tan(20 * units::degree) - roll;
          if (roll <= pair.pinion.tip_roll && mate <= pair.gear.tip_roll)
            least = std::min(least, normal_gap(roll, mate, z) / std::cos(pair.base_helix_angle));
        }
    return least;
  }

  /// The pair of the helical example with its flanks replaced by `flanks`.
  inline ParallelAxisCase read(const std::string &flanks, const std::vector<std::string> &settings = {},
                               const std::string &gear = "like = \"pinion\"")
  {
    const std::filesystem::path path =
        std::filesystem::path(testing::TempDir()) / "flank_deviation_test.toml";
    std::ofstream(path) << R"(scene = "parallel_axis"
[pair]
centre_distance_mm = 150.0
transverse_module_mm = 3.0
transverse_pressure_angle_deg = 20.0
helix_angle_deg = 25.232
[load]
pinion_torque_Nm = [100]
[pinion]
teeth = 50
face_width_mm = 20.0
tip_diameter_mm = 156.0
root_diameter_mm = 140.68
tooth_thickness_mm = 4.64
bore_diameter_mm = 70.34
fillet_radius_mm = 1.0
youngs_modulus_GPa = 207.0
poissons_ratio = 0.3
)" << flanks << "\n[gear]\n"
                        << gear << "\n";
    return read_parallel_axis(CaseFile::read(schema(), path.string(), settings));
  }

  inline std::string refusal(const std::string &flanks, const std::vector<std::string> &settings = {},
                             const std::string &gear = "like = \"pinion\"")
  {
    return refusal_of([&] { read(flanks, settings, gear); });
  }

  inline void write_table(const std::string &name, const std::string &content)
  {
    std::ofstream(std::filesystem::path(testing::TempDir()) / name) << content;
  }
} // namespace flank
