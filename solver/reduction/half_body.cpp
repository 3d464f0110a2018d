// SPDX-License-Identifier: GPL-2.0-or-later
#include "solver/parallel_session.hpp"
#include "solver/reduction/tooth_responses.hpp"

namespace flank
{
  namespace
  {
    /// A load on one side of the mid-plane is half the sum of a symmetric and an antisymmetric pair of loads,
    /// each of which one half of the body answers: R(lower, lower) = (S + A)/2 = R(upper, upper), R(upper,
    /// lower) = (S - A)/2.
    Eigen::MatrixXd of_both_halves(const Eigen::MatrixXd &symmetric, const Eigen::MatrixXd &antisymmetric,
                                   const FlankSurface &lower)
    {
      const int rows = lower.n_row_nodes(), half = lower.n_layer_nodes(), layers = 2 * half - 1;
      const Eigen::Index n_half = lower.n_nodes(), n = static_cast<Eigen::Index>(rows) * layers,
                         planes = symmetric.rows() / n_half;
      const Eigen::MatrixXd same = 0.5 * (symmetric + antisymmetric),
                            other = 0.5 * (symmetric - antisymmetric);
      Eigen::MatrixXd result(planes * n, n);
      for (int load_layer = 0; load_layer < layers; ++load_layer)
        for (int layer = 0; layer < layers; ++layer)
          {
            const int from = std::min(load_layer, layers - 1 - load_layer),
                      to = std::min(layer, layers - 1 - layer);
            const auto &part =
                (load_layer < half) == (layer < half) ? same : other; // on the mid-plane both are the same
            for (Eigen::Index d = 0; d < planes; ++d)
              result.block(d * n + layer * rows, load_layer * rows, rows, rows) =
                  part.block(d * n_half + to * rows, from * rows, rows, rows);
          }
      return result;
    }

  } // namespace

  ToothResponses half_body_responses(const Gear &gear, const SectorResolution &resolution,
                                     const BodyModel &model, const int max_offset, const int depth_planes,
                                     const ParallelSession *distributed,
                                     const std::function<void(const char *)> &finished)
  {
    Gear half_gear = gear; // elasticity does not know where along z a spur body lies: the half is centred
    SectorResolution half = resolution;
    half_gear.face_width /= 2;
    half.face_layers /= 2;
    const ToothSector sector = make_tooth_sector(half_gear, half);
    const auto body = make_elastic_body(sector.mesh, half.degree, gear.youngs_modulus, gear.poissons_ratio);
    finished("mesh and elements");
    ToothResponses parts[2];
    for (const MidPlane mid_plane : { MidPlane::symmetric, MidPlane::antisymmetric })
      {
        const CondensedSector condensed =
            condense_sector(sector, *body, mid_plane, depth_planes, distributed);
        finished(mid_plane == MidPlane::symmetric ? "condensation, symmetric half"
                                                  : "condensation, antisymmetric half");
        if (!distributed || distributed->rank() == 0)
          parts[mid_plane == MidPlane::antisymmetric] =
              closed_responses(condensed, model, gear.teeth, max_offset);
        finished("closing the teeth");
      }
    ToothResponses result;
    for (std::size_t m = 0; m < parts[0].size(); ++m)
      result.push_back(of_both_halves(parts[0][m], parts[1][m], flank_surface(sector)));
    return result;
  }
} // namespace flank
