// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/stress/near_loads.hpp"
#include "solver/elements/body_elements.hpp"
#include "solver/linear/direct_solver.hpp"

#include <memory>
#include <vector>

namespace flank
{
  /// The elements below a flank, from its tip to its form circle and three layers deep, where the half-space
  /// joins the finite elements:
  ///   u = u_FE + u_s - u_B,  and stresses likewise,
  /// u_s: the half-space's field (or a wedge's, at free edges), u_B: what these same elements make of it,
  /// under the same nodal forces, with u_s on the cut from the rest of the tooth and sigma(u_s).n on the true
  /// free faces. Far from the contact u_s and u_B are the same but for the elements' error, so that nothing
  /// is counted twice and nothing jumps at the cut; below it u_B takes out what the elements cannot resolve.
  class ContactRegion
  {
  public:
    /// Factors the region. `elements` is kept by reference. Throws ComputationError.
    explicit ContactRegion(const BodyElements &elements);

    const ElasticBody &body() const { return *body_; }

    /// The region's cell for one of the sector's tooth cells, -1 where there is none.
    int of_sector_cell(const int cell) const { return of_sector_cell_[static_cast<std::size_t>(cell)]; }

    /// u_FE - u_B on the region's nodes [mm], for displacements of the sector's nodes under nodal forces on
    /// the flank [N]. Not for several threads at once.
    Eigen::VectorXd without_contact(const Eigen::VectorXd &displacement, const Eigen::VectorXd &flank_force,
                                    const NearLoads &loads) const;

  private:
    std::vector<char> number_nodes(const std::vector<int> &cells, int rows, int depth, bool cuts_tooth);

    const BodyElements &elements_;
    std::vector<int> of_sector_cell_;
    std::unique_ptr<const ElasticBody> body_;
    std::vector<int> sector_node_; ///< of each of the region's nodes
    std::vector<int> flank_;       ///< the region's node for each of the flank's
    std::vector<int> cut_;         ///< nodes
    struct FreeFace
    {
      int cell, face;
      FlankEnd end; ///< that it lies on
    };
    std::vector<FreeFace> free_faces_; ///< the loaded flank is not among them
    std::unique_ptr<const DirectSolver> solver_;
  };
} // namespace flank
