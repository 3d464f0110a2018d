// SPDX-License-Identifier: GPL-2.0-or-later
#include "solver/reduction/flank_compliance.hpp"

#include "mesh/base/errors.hpp"
#include "solver/parallel_session.hpp"
#include "solver/reduction/tooth_responses.hpp"

namespace flank
{
  ToothResponses closed_responses(const CondensedSector &sector, const BodyModel &model, const int teeth,
                                  const int max_offset)
  {
    return model.kind == BodyModel::Kind::ring
               ? ring_responses(sector, teeth, max_offset)
               : segment_responses(sector, model.segment_teeth, model.clamped_cuts, max_offset);
  }

  namespace
  {
    ToothResponses direct(const ToothSector &sector, const BodyModel &model, const int max_offset)
    {
      return model.kind == BodyModel::Kind::ring
                 ? direct_ring_responses(sector, max_offset)
                 : direct_segment_responses(sector, model.segment_teeth, model.clamped_cuts, max_offset);
    }
  } // namespace

  FlankCompliance flank_compliance(const BodyElements &elements, const BodyModel &model, const int max_offset,
                                   const int depth_planes, const ParallelSession *session, StageClock *clock)
  {
    const bool distributed = model.reduction == BodyModel::Reduction::distributed;
    FLANK_ASSERT(!distributed || session, "the ranks that share the elements");
    FLANK_ASSERT(depth_planes == 0 || model.reduction != BodyModel::Reduction::direct,
                 "the check answers at the flank alone");
    const auto finished = [clock](const char *stage) {
      if (clock)
        clock->finished(stage);
    };
    const ParallelSession *ranks = distributed ? session : nullptr;
    const ToothSector &sector = elements.sector();
    const FlankSurface surface = flank_surface(sector);
    ToothResponses responses;
    if (model.reduction == BodyModel::Reduction::direct)
      {
        responses = direct(sector, model, max_offset);
        finished("whole body");
      }
    else if (model.use_mid_plane && has_mid_plane(sector.gear, sector.resolution))
      responses = half_body_responses(sector.gear, sector.resolution, model, max_offset, depth_planes, ranks,
                                      finished);
    else
      {
        elements.body();
        finished("mesh and elements");
        const CondensedSector condensed =
            condense_sector(sector, elements.body(), MidPlane::none, depth_planes, ranks);
        finished("condensation");
        if (!ranks || ranks->rank() == 0)
          responses = closed_responses(condensed, model, sector.gear.teeth, max_offset);
        finished("closing the teeth");
      }
    if (responses.empty())
      return {};

    FlankCompliance result;
    result.surface = surface;
    const Eigen::Index n_flank = surface.n_nodes();
    const Eigen::MatrixXd self = responses[0].topRows(n_flank);
    result.by_tooth_offset.emplace_back(Eigen::MatrixXd(0.5 * (self + self.transpose())));
    for (std::size_t m = 1; m < responses.size(); ++m)
      result.by_tooth_offset.emplace_back(std::move(responses[m]));
    if (depth_planes > 0)
      {
        for (int d = 0; d <= depth_planes; ++d)
          {
            result.by_depth.push_back(d == 0 ? result.by_tooth_offset[0]
                                             : SharedMatrix(responses[0].middleRows(d * n_flank, n_flank)));
            Eigen::Matrix3Xd positions(3, n_flank);
            const auto nodes = flank_nodes(sector, surface, elements.body(), d);
            for (Eigen::Index i = 0; i < n_flank; ++i)
              positions.col(i) = elements.body().node_positions()[nodes[i]];
            result.depth_positions.push_back(positions);
          }
      }
    return result;
  }
} // namespace flank
