// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "cases/parallel_axis/body_compliance.hpp"
#include "contact/grid/mesh_position.hpp"
#include "contact/solve/certificate.hpp"

namespace flank
{
  struct ContactGridSize
  {
    int slices        = 41; ///< across the face, 2N+1 of P1
    int profile_cells = 11; ///< across the profile, 2M+1 of P1
  };

  struct PairLoad
  {
    int    pair;
    double force;        ///< normal force [N]
    double max_pressure; ///< [MPa]
  };

  struct CellResult
  {
    int    pair;
    double z, pinion_roll, gear_roll; ///< user's z [mm], [rad]
    double area, gap, force;          ///< [mm^2], [mm], [N]
    bool   edge;
  };

  /// One mesh position at one torque.
  struct PositionResult
  {
    double                  torque = 0, phase = 0;
    double                  theta        = 0;                          ///< pinion rotation ahead of the gear [rad]
    double                  stiffness    = 0;                          ///< tangent dT/dtheta [N mm/rad]; 0 unloaded
    double                  gear_torque  = 0;                          ///< [N mm]
    double                  max_pressure = 0, edge_pressure = 0;       ///< inside, and at edges [MPa]
    double                  max_pressure_roll = 0, max_pressure_z = 0; ///< pinion's roll angle [rad], user's z [mm]
    Certificate             certificate;
    double                  asymmetry = 0; ///< of the compliance before symmetrising, relative
    int                     cells = 0, pivots = 0, grids = 0;
    std::vector<PairLoad>   pairs;
    std::vector<CellResult> cell_results;
  };

  struct LoadedMesh
  {
    const GearPair           &pair;
    const FlankModifications &pinion_modifications, &gear_modifications;
    const BodyCompliance     &pinion, &gear;
    ContactGridSize           grid;

    /// Torques of one band (each > 0) at one phase: a grid is sized for the greatest, all share it.
    /// Throws ComputationError if a solution fails its certificate or the grid cannot be made to enclose the contact.
    std::vector<PositionResult> solve(double phase, const std::vector<double> &torques) const;

    /// Unloaded: the geometric transmission error of the true surfaces.
    PositionResult unloaded(double phase) const;
  };

  /// Torques grouped so that one grid serves each group: indices into `torques`, greatest first; zero torques left out.
  std::vector<std::vector<int>> torque_bands(const std::vector<double> &torques, int profile_cells);
} // namespace flank
