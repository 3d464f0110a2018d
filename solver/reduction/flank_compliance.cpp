// SPDX-License-Identifier: GPL-2.0-or-later
#include "solver/reduction/flank_compliance.hpp"

#include "mesh/base/errors.hpp"
#include "solver/parallel_session.hpp"
#include "solver/reduction/body_models.hpp"

#include <fmt/format.h>

namespace flank
{
  std::string BodyModel::describe() const
  {
    return kind == Kind::ring ? "ring: the whole gear, clamped at the bore"
                              : fmt::format("segment: {} teeth around the loaded one, clamped at the bore, cut faces {}", segment_teeth,
                                            clamped_cuts ? "clamped" : "free");
  }

  std::string BodyModel::describe_reduction() const
  {
    switch (reduction)
      {
      case Reduction::direct:
        return "all teeth meshed and factored at once";
      case Reduction::distributed:
        return "one tooth sector, shared out over the ranks";
      default:
        return "one tooth sector";
      }
  }

  bool has_mid_plane(const Gear &gear, const SectorResolution &resolution)
  {
    return gear.base_helix_angle == 0 && resolution.face_layers % 2 == 0;
  }

  namespace
  {
    ToothResponses closed(const CondensedSector &sector, const BodyModel &model, const int teeth, const int max_offset)
    {
      return model.kind == BodyModel::Kind::ring ? ring_responses(sector, teeth, max_offset)
                                                 : segment_responses(sector, model.segment_teeth, model.clamped_cuts, max_offset);
    }

    ToothResponses direct(const ToothSector &sector, const BodyModel &model, const int max_offset)
    {
      return model.kind == BodyModel::Kind::ring ? direct_ring_responses(sector, max_offset)
                                                 : direct_segment_responses(sector, model.segment_teeth, model.clamped_cuts, max_offset);
    }

    /// A load on one side of the mid-plane is half the sum of a symmetric and an antisymmetric pair of loads, each of which one half of
    /// the body answers: R(lower, lower) = (S + A)/2 = R(upper, upper), R(upper, lower) = (S - A)/2.
    Eigen::MatrixXd of_both_halves(const Eigen::MatrixXd &symmetric, const Eigen::MatrixXd &antisymmetric, const FlankSurface &whole)
    {
      const int             rows = whole.n_row_nodes(), layers = whole.n_layer_nodes(), half = (layers + 1) / 2;
      const Eigen::Index    n_half = static_cast<Eigen::Index>(rows) * half, n = whole.n_nodes(), planes = symmetric.rows() / n_half;
      const Eigen::MatrixXd same = 0.5 * (symmetric + antisymmetric), other = 0.5 * (symmetric - antisymmetric);
      Eigen::MatrixXd       result(planes * n, n);
      for (int load_layer = 0; load_layer < layers; ++load_layer)
        for (int layer = 0; layer < layers; ++layer)
          {
            const int   from = std::min(load_layer, layers - 1 - load_layer), to = std::min(layer, layers - 1 - layer);
            const auto &part = (load_layer < half) == (layer < half) ? same : other; // on the mid-plane both are the same
            for (Eigen::Index d = 0; d < planes; ++d)
              result.block(d * n + layer * rows, load_layer * rows, rows, rows) =
                  part.block(d * n_half + to * rows, from * rows, rows, rows);
          }
      return result;
    }

    ToothResponses from_one_half(const Gear &gear, const SectorResolution &resolution, const FlankSurface &whole, const BodyModel &model,
                                 const int max_offset, const int depth_planes, const ParallelSession *distributed,
                                 const std::function<void(const char *)> &finished)
    {
      Gear             half_gear = gear; // elasticity does not know where along z a spur body lies: the half is centred
      SectorResolution half      = resolution;
      half_gear.face_width /= 2;
      half.face_layers /= 2;
      const ToothSector sector = make_tooth_sector(half_gear, half);
      const ElasticBody body(sector.mesh, half.degree, gear.youngs_modulus, gear.poissons_ratio);
      finished("mesh and elements");
      ToothResponses parts[2];
      for (const MidPlane mid_plane : { MidPlane::symmetric, MidPlane::antisymmetric })
        {
          const CondensedSector condensed = condense_sector(sector, body, mid_plane, depth_planes, distributed);
          finished(mid_plane == MidPlane::symmetric ? "condensation, symmetric half" : "condensation, antisymmetric half");
          if (!distributed || distributed->rank() == 0)
            parts[mid_plane == MidPlane::antisymmetric] = closed(condensed, model, gear.teeth, max_offset);
          finished("closing the teeth");
        }
      ToothResponses result;
      for (std::size_t m = 0; m < parts[0].size(); ++m)
        result.push_back(of_both_halves(parts[0][m], parts[1][m], whole));
      return result;
    }
  } // namespace

  FlankCompliance flank_compliance(const BodyElements &elements, const BodyModel &model, const int max_offset, const int depth_planes,
                                   const ParallelSession *session, StageClock *clock)
  {
    const bool distributed = model.reduction == BodyModel::Reduction::distributed;
    FLANK_ASSERT(!distributed || session, "the ranks that share the elements");
    FLANK_ASSERT(depth_planes == 0 || model.reduction != BodyModel::Reduction::direct, "the check answers at the flank alone");
    const auto finished = [clock](const char *stage) {
      if (clock)
        clock->finished(stage);
    };
    const ParallelSession *ranks   = distributed ? session : nullptr;
    const ToothSector     &sector  = elements.sector();
    const FlankSurface     surface = flank_surface(sector);
    ToothResponses         responses;
    if (model.reduction == BodyModel::Reduction::direct)
      {
        responses = direct(sector, model, max_offset);
        finished("whole body");
      }
    else if (model.use_mid_plane && has_mid_plane(sector.gear, sector.resolution))
      responses = from_one_half(sector.gear, sector.resolution, surface, model, max_offset, depth_planes, ranks, finished);
    else
      {
        elements.body();
        finished("mesh and elements");
        const CondensedSector condensed = condense_sector(sector, elements.body(), MidPlane::none, depth_planes, ranks);
        finished("condensation");
        if (!ranks || ranks->rank() == 0)
          responses = closed(condensed, model, sector.gear.teeth, max_offset);
        finished("closing the teeth");
      }
    if (responses.empty())
      return {};

    FlankCompliance       result{ surface, {}, {}, {} };
    const Eigen::Index    n_flank = surface.n_nodes();
    const Eigen::MatrixXd self    = responses[0].topRows(n_flank);
    result.by_tooth_offset.emplace_back(Eigen::MatrixXd(0.5 * (self + self.transpose())));
    for (std::size_t m = 1; m < responses.size(); ++m)
      result.by_tooth_offset.emplace_back(std::move(responses[m]));
    if (depth_planes > 0)
      {
        for (int d = 0; d <= depth_planes; ++d)
          {
            result.by_depth.push_back(d == 0 ? result.by_tooth_offset[0] : SharedMatrix(responses[0].middleRows(d * n_flank, n_flank)));
            Eigen::Matrix3Xd positions(3, n_flank);
            const auto       nodes = flank_nodes(sector, surface, elements.body(), d);
            for (Eigen::Index i = 0; i < n_flank; ++i)
              positions.col(i) = elements.body().node_positions()[nodes[i]];
            result.depth_positions.push_back(positions);
          }
      }
    return result;
  }
} // namespace flank
