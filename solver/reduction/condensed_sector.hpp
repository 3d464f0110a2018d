// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "solver/elements/flank_surface.hpp"
#include "solver/linear/direct_solver.hpp"

#include <optional>

namespace flank
{
  class ParallelSession;

  /// What holds the end of a sector at +z: nothing, or the symmetry of a body of twice its face width, whose
  /// mid-plane it is.
  enum class MidPlane
  {
    none,
    symmetric,    ///< no displacement along z
    antisymmetric ///< displacement along z alone
  };

  /// One tooth sector condensed to its cuts, clamped at the bore. Loads are unit forces on the flank's nodes
  /// along their inward normals, outputs displacements along the same normals: of the flank's nodes, then of
  /// `depth_planes` planes of nodes below it. The cut at +pitch/2 (plus) is given in the axes of the next
  /// tooth, so that it moves as that tooth's minus cut does.
  struct CondensedSector
  {
    Eigen::MatrixXd plus_plus, plus_minus, minus_minus; ///< stiffness of the cuts [N/mm]
    Eigen::MatrixXd load_plus, load_minus; ///< forces that unit loads put on the cuts; cut unknowns x loads
    Eigen::MatrixXd output_plus,
        output_minus;    ///< outputs for unit displacements of the cuts; outputs x cut unknowns
    Eigen::MatrixXd own; ///< outputs x loads, cuts held [mm/N]

    /// A symmetry T of the unloaded sector that swaps its cuts: node i of one goes to node image[i] of the
    /// other, its displacement u to turn u, turn = turn' = turn^-1. None where the mesh has none.
    struct CutSymmetry
    {
      std::vector<int> image;
      Eigen::Matrix3d turn;
    };
    std::optional<CutSymmetry> symmetry;

    Eigen::Index n_cut() const { return minus_minus.rows(); }
    Eigen::Index n_flank() const { return own.cols(); }
    Eigen::Index n_outputs() const { return own.rows(); }
  };

  /// The inside of a sector whose cuts and flank move in a known way: the flank's nodes in axes of their own,
  /// of which the first is the inward normal. Displacements elsewhere follow from them by the factor that the
  /// condensation leaves.
  struct SectorInside
  {
    std::unique_ptr<const DirectSolver> solver; ///< cuts and the flank's normal displacements held
    NodeAxes axes;
  };

  /// `distributed`: null condenses on this process alone; else all ranks share the elements (collective) and
  /// rank 0 receives the result, the others an empty one. `inside`, where given (not with `distributed`),
  /// receives the sector's inside.
  CondensedSector condense_sector(const ToothSector &sector, const ElasticBody &body, MidPlane mid_plane,
                                  int depth_planes, const ParallelSession *distributed,
                                  SectorInside *inside = nullptr);
} // namespace flank
