// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/loaded/position_result.hpp"
#include "contact/matching/tangent_half_space.hpp"
#include "contact/stress/side.hpp"
#include "solver/elements/body_elements.hpp"
#include "solver/linear/direct_solver.hpp"

#include <map>
#include <memory>
#include <vector>

namespace flank
{
  /// The forces of the contact on one tooth as the half-space sees them: every cell spreads its force evenly
  /// over a rectangle of its own tangent plane.
  class HalfSpaceLoads
  {
  public:
    HalfSpaceLoads(const Gear &gear, const FlankSurface &surface);

    void add(const Patch &patch, double force); ///< inward [N]

    struct Field
    {
      Eigen::Vector3d displacement = Eigen::Vector3d::Zero(); ///< [mm]
      Eigen::Matrix3d stress = Eigen::Matrix3d::Zero();       ///< tension positive [MPa]
    };

    /// The field of all the forces together at a point in the tooth's own axes [mm]. Love's formulas nearby,
    /// Boussinesq's beyond six half-lengths, where they differ by a twentieth of themselves, 0.3 % of the
    /// cell's own pressure (a test).
    Field at(const Eigen::Vector3d &point) const;

    /// Whether any force lies on an element of the flank.
    bool on(int row, int layer) const
    {
      return loaded_[static_cast<std::size_t>(layer * surface_.rows + row)] != 0;
    }

  private:
    struct Source
    {
      TangentHalfSpace below;
      double half_profile, half_generator, force;
    };
    const Gear &gear_;
    FlankSurface surface_;
    std::vector<Source> sources_;
    std::vector<char> loaded_; ///< elements of the flank
  };

  /// The half-space's loads of every loaded tooth of one side, by the body's number of the tooth.
  std::map<int, HalfSpaceLoads> half_space_loads(const Gear &gear, const FlankSurface &surface,
                                                 const PositionResult &result, Side side);

  /// The elements below a flank, from its tip to its form circle and three layers deep, where the half-space
  /// joins the finite elements:
  ///   u = u_FE + u_s - u_B,  and stresses likewise,
  /// u_s: the half-space's field, u_B: what these same elements make of it, under the same nodal forces, with
  /// u_s on the cut from the rest of the tooth and sigma(u_s).n on the true free faces. Far from the contact
  /// u_s and u_B are the same but for the elements' error, so that nothing is counted twice and nothing jumps
  /// at the cut; below it u_B takes out what the elements cannot resolve.
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
                                    const HalfSpaceLoads &loads) const;

  private:
    std::vector<char> number_nodes(const std::vector<int> &cells, int rows, int depth, bool cuts_tooth);

    const BodyElements &elements_;
    std::vector<int> of_sector_cell_;
    std::unique_ptr<const ElasticBody> body_;
    std::vector<int> sector_node_;                ///< of each of the region's nodes
    std::vector<int> flank_;                      ///< the region's node for each of the flank's
    std::vector<int> cut_;                        ///< nodes
    std::vector<std::pair<int, int>> free_faces_; ///< cell, face; the loaded flank is not among them
    std::unique_ptr<const DirectSolver> solver_;
  };
} // namespace flank
