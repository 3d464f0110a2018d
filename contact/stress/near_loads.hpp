// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/loaded/position_result.hpp"
#include "contact/matching/flank_edges.hpp"
#include "contact/matching/tangent_half_space.hpp"
#include "contact/stress/side.hpp"
#include "solver/elements/body_elements.hpp"

#include <map>
#include <vector>

namespace flank
{
  /// The forces of the contact on one tooth as the half-space sees them: every cell spreads its force evenly
  /// over a rectangle of its own tangent plane. Near a free end and a sharp tip the half-space is the elastic
  /// wedge that the body is there.
  class NearLoads
  {
  public:
    /// `edges`: of the same gear; null: the half-space goes on there. Both are kept by reference.
    NearLoads(const Gear &gear, const FlankSurface &surface, const FlankEdges *edges = nullptr);

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

    /// Their stress (tension positive, tooth's own axes) on a free face, a face end or another one (`none`):
    /// without what a wedge leaves free there. [MPa]
    Eigen::Matrix3d stress_on(FlankEnd end, const Eigen::Vector3d &point) const;

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
      FreeEdges free;
      std::vector<FlankEdges::PartOfPatch> parts; ///< for the edges
    };

    void add_half_space(const Source &source, const Eigen::Vector3d &relative, Field &sum) const;
    void add_edge(const Source &source, FlankEdge edge, const Eigen::Vector3d &relative, Field &sum) const;
    static void add_rotated(const Source &source, const Field &field, Field &sum);

    const Gear &gear_;
    FlankSurface surface_;
    const FlankEdges *edges_;
    std::vector<Source> sources_;
    std::vector<char> loaded_; ///< elements of the flank
  };

  /// The loads of every loaded tooth of one side, by the body's number of the tooth.
  std::map<int, NearLoads> near_loads(const Gear &gear, const FlankSurface &surface, const FlankEdges *edges,
                                      const PositionResult &result, Side side);
} // namespace flank
