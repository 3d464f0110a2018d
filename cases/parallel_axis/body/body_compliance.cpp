// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/body/body_compliance.hpp"

#include "mesh/base/errors.hpp"
#include "solver/parallel_session.hpp"

#include <map>

namespace flank
{
  BodyCompliance::BodyCompliance(const Gear &gear, const SectorResolution &resolution, const int max_offset, const NearField &near_field,
                                 const BodyModel &model, const ParallelSession *session, StageClock *clock)
      : gear_(gear)
      , near_field_(near_field)
      , elements_(std::make_unique<BodyElements>(gear, resolution))
      , n_unknowns_(elements_->body().n_unknowns())
  {
    // The near field does not need the far field: it is tabulated beside the condensation, which keeps one core busy.
    std::unique_ptr<BackgroundWork> tables;
    if (near_field.split == Split::projected && !(model.reduction == BodyModel::Reduction::distributed && session->rank() != 0))
      {
        projected_ = std::make_unique<ProjectedSplit>(gear, flank_surface(elements_->sector()), near_field.points,
                                                      [elements = elements_.get()]() -> const FlankBlocks & { return elements->blocks(); });
        tables     = projected_->prepare(available_threads() - 1);
      }
    far_field_ =
        flank_compliance(*elements_, model, max_offset,
                         near_field.split == Split::projected ? 0 : depth_planes(near_field.depth, resolution.degree), session, clock);
    if (tables)
      {
        tables->finish();
        if (clock)
          clock->finished("near field tables (the rest of them)");
      }
  }

  BodyCompliance::BodyCompliance(const Gear &gear, const SectorResolution &resolution, const NearField &near_field,
                                 FlankCompliance far_field, const int n_unknowns, ProjectedSplit::Tables tables)
      : gear_(gear)
      , near_field_(near_field)
      , elements_(std::make_unique<BodyElements>(gear, resolution))
      , far_field_(std::move(far_field))
      , n_unknowns_(n_unknowns)
  {
    if (near_field.split == Split::projected)
      projected_ = std::make_unique<ProjectedSplit>(
          gear, far_field_.surface, near_field.points, [elements = elements_.get()]() -> const FlankBlocks & { return elements->blocks(); },
          std::move(tables));
  }

  /// N_i C_h f_j with the operator of the tooth offset, the patches of one tooth at a time. The classical split takes the
  /// finite elements' answer on the loaded tooth itself below the surface, so that tooth is left to it.
  void BodyCompliance::add_far_field(const std::vector<Patch> &patches, const std::vector<PatchWeights> &weights, Eigen::MatrixXd &c) const
  {
    const FlankSurface             &s = far_field_.surface;
    std::map<int, std::vector<int>> of_tooth;
    for (std::size_t i = 0; i < patches.size(); ++i)
      of_tooth[patches[i].tooth].push_back(static_cast<int>(i));
    // The flank nodes that the patches of a tooth touch, and their places among these.
    struct Touched
    {
      std::vector<int> nodes, place;
    };
    std::map<int, Touched> touched;
    for (const auto &[tooth, list] : of_tooth)
      {
        Touched &t = touched[tooth];
        t.place.assign(s.n_nodes(), -1);
        for (const int i : list)
          for (const int node : weights[i].node)
            t.place[node] = 0;
        for (int node = 0; node < s.n_nodes(); ++node)
          if (t.place[node] == 0)
            {
              t.place[node] = static_cast<int>(t.nodes.size());
              t.nodes.push_back(node);
            }
      }
    // Along long columns throughout: C_h times the loads, turned over, then a sum of few columns for each output.
    const auto add_columns = [](const Eigen::MatrixXd &columns, const std::vector<int> &place, const PatchWeights &w, auto &&result) {
      for (std::size_t k = 0; k < w.value.size(); ++k)
        result += w.value[k] * columns.col(place[w.node[k]]);
    };
    Eigen::MatrixXd near, response, by_load, output;
    for (const auto &[load_tooth, loads] : of_tooth)
      for (const auto &[tooth, outputs] : of_tooth)
        {
          if (tooth < load_tooth || (tooth == load_tooth && !projected_))
            continue; // reciprocity gives the other half
          const int teeth = gear_.teeth, ahead = ((tooth - load_tooth) % teeth + teeth) % teeth, offset = std::min(ahead, teeth - ahead);
          FLANK_ASSERT(offset < static_cast<int>(far_field_.by_tooth_offset.size()), std::to_string(offset));
          const Eigen::MatrixXd &h    = far_field_.by_tooth_offset[offset];
          const Touched         &from = touched[load_tooth], &to = touched[tooth];
          near = ahead == offset ? Eigen::MatrixXd(h(to.nodes, from.nodes)) : Eigen::MatrixXd(h(from.nodes, to.nodes).transpose());
          response.setZero(near.rows(), static_cast<Eigen::Index>(loads.size()));
          for (std::size_t j = 0; j < loads.size(); ++j)
            add_columns(near, from.place, weights[loads[j]], response.col(static_cast<Eigen::Index>(j)));
          by_load = response.transpose();
          output.setZero(static_cast<Eigen::Index>(loads.size()), static_cast<Eigen::Index>(outputs.size()));
          for (std::size_t i = 0; i < outputs.size(); ++i)
            {
              add_columns(by_load, to.place, weights[outputs[i]], output.col(static_cast<Eigen::Index>(i)));
              for (std::size_t j = 0; j < loads.size(); ++j)
                c(loads[j], outputs[i]) += output(j, i); // the transposed entry; the same on one tooth
            }
          constexpr std::size_t tile = 16; // rows of a tile's transpose stay in the cache
          if (tooth != load_tooth)
            for (std::size_t i0 = 0; i0 < outputs.size(); i0 += tile)
              for (std::size_t j = 0; j < loads.size(); ++j)
                for (std::size_t i = i0; i < std::min(i0 + tile, outputs.size()); ++i)
                  c(outputs[i], loads[j]) += output(j, i);
        }
  }

  void BodyCompliance::add(const std::vector<Patch> &patches, PatchPotentials &potentials, Eigen::MatrixXd &c) const
  {
    std::vector<PatchWeights> weights;
    for (const Patch &patch : patches)
      weights.push_back(patch_weights(far_field_.surface, patch));
    add_far_field(patches, weights, c);
    if (projected_)
      projected_->add(patches, weights, potentials, c);
    else
      add_classical_split(far_field_, gear_, near_field_.depth, patches, weights, c);
  }

  double symmetrise(Eigen::MatrixXd &c)
  {
    const Eigen::Index     n        = c.rows();
    double                 greatest = 0, difference = 0;
    constexpr Eigen::Index tile = 64; // both halves of a tile pair stay in the cache
    for (Eigen::Index j0 = 0; j0 < n; j0 += tile)
      for (Eigen::Index i0 = 0; i0 <= j0; i0 += tile)
        for (Eigen::Index j = j0; j < std::min(n, j0 + tile); ++j)
          for (Eigen::Index i = i0; i < std::min(j + 1, i0 + tile); ++i)
            {
              const double a = c(i, j), b = c(j, i);
              greatest   = std::max({ greatest, std::abs(a), std::abs(b) });
              difference = std::max(difference, std::abs(a - b));
              c(i, j) = c(j, i) = 0.5 * (a + b);
            }
    return greatest > 0 ? difference / greatest : 0;
  }
} // namespace flank
