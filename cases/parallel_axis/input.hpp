// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/case_file.hpp"
#include "cases/parallel_axis/loaded_mesh.hpp"

namespace flank
{
  /// A parallel-axis case as the physics sees it: [mm, MPa, N mm, rad].
  struct ParallelAxisCase
  {
    std::string         title;
    GearPair            pair;
    FlankModifications  pinion_modifications, gear_modifications;
    SectorResolution    pinion_mesh, gear_mesh;
    ContactGridSize     grid;
    Split               split;
    ClassicalDepth      classical_depth;
    std::vector<double> torques;
    int                 positions;

    /// The gears are the same body or mirror images of each other: one reduction serves both.
    bool identical_bodies() const;
  };

  /// Throws InputError with file, line, key and value.
  ParallelAxisCase read_parallel_axis(const CaseFile &file);

  /// The report of `flank check`.
  std::string geometry_report(const ParallelAxisCase &input);

  /// ISO 6336-1 method B tooth stiffness for a pair of solid steel-like gears. [N/(mm um)]
  struct IsoStiffness
  {
    double theoretical; ///< c'_th
    double single;      ///< c'
    double mesh;        ///< c_gamma_alpha
  };
  IsoStiffness iso_6336_stiffness(const GearPair &pair);

  /// From the standard's own quantities; dedendum_factor h_fP/m_n of the basic rack.
  IsoStiffness iso_6336_stiffness(double z1, double z2, double x1, double x2, double helix_angle, double normal_pressure_angle, double dedendum_factor, double contact_ratio,
                                  double modulus_ratio);
} // namespace flank
