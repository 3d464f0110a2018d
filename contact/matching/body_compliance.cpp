// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/matching/body_compliance.hpp"

#include "contact/matching/end_means.hpp"
#include "mesh/base/errors.hpp"
#include "solver/parallel_session.hpp"

#include <fmt/format.h>

#include <utility>

namespace flank
{
  BodyCompliance::BodyCompliance(const Gear &gear, const SectorResolution &resolution, const int max_offset,
                                 const NearField &near_field, const BodyModel &model,
                                 const ParallelSession *session, StageClock *clock)
      : gear_(gear)
      , near_field_(near_field)
      , elements_(std::make_unique<BodyElements>(gear, resolution))
      , n_unknowns_(elements_->body().n_unknowns())
  {
    if (const double least = elements_->body().least_scaled_jacobian(); !(least > 0))
      throw ComputationError(fmt::format(
          "the element mesh of the {} is folded (least scaled Jacobian {:.3g}): its root, rim or fillet do "
          "not fit its mesh keys",
          gear.name, least));
    // The near field does not need the far field: it is tabulated beside the condensation, which keeps one
    // core busy.
    std::unique_ptr<BackgroundWork> tables;
    if (near_field.split == Split::projected &&
        !(model.reduction == BodyModel::Reduction::distributed && session->rank() != 0))
      {
        projected_ = std::make_unique<ProjectedSplit>(
            gear, flank_surface(elements_->sector()), near_field,
            [elements = elements_.get()]() -> const FlankBlocks & { return elements->blocks(); });
        tables = projected_->prepare(available_threads() - 1);
      }
    far_field_ = flank_compliance(
        *elements_, model, max_offset,
        near_field.split == Split::projected ? 0 : depth_planes(near_field.depth, resolution.degree), session,
        clock);
    if (tables)
      {
        tables->finish();
        if (clock)
          clock->finished("near field tables (the rest of them)");
      }
  }

  BodyCompliance::BodyCompliance(const Gear &gear, const SectorResolution &resolution,
                                 const NearField &near_field, FlankCompliance far_field, const int n_unknowns,
                                 ProjectedSplit::Tables tables, const FlankEdges::Faces *faces)
      : gear_(gear)
      , near_field_(near_field)
      , elements_(std::make_unique<BodyElements>(gear, resolution))
      , far_field_(std::move(far_field))
      , n_unknowns_(n_unknowns)
  {
    if (near_field.split == Split::projected)
      projected_ = std::make_unique<ProjectedSplit>(
          gear, far_field_.surface, near_field,
          [elements = elements_.get()]() -> const FlankBlocks & { return elements->blocks(); },
          std::move(tables), faces);
  }

  PatchGroup BodyCompliance::group(std::vector<Patch> patches) const
  {
    PatchWeights weights(far_field_.surface, patches);
    PatchGroup group{ patches.front().tooth, std::move(patches), std::move(weights) };
    std::vector<int> place(static_cast<std::size_t>(far_field_.surface.n_nodes()), -1);
    for (std::size_t j = 0; j < group.patches.size(); ++j)
      {
        FLANK_ASSERT(group.patches[j].tooth == group.tooth, "patches of one tooth");
        for (const int node : group.weights.nodes(j))
          if (place[node] < 0)
            {
              place[node] = static_cast<int>(group.nodes.size());
              group.nodes.push_back(node);
            }
      }
    group.on_nodes = LoadResponses(static_cast<Eigen::Index>(group.patches.size()),
                                   static_cast<Eigen::Index>(group.nodes.size()));
    for (std::size_t j = 0; j < group.patches.size(); ++j)
      for (std::size_t k = 0; k < group.weights.nodes(j).size(); ++k)
        group.on_nodes(static_cast<Eigen::Index>(j), place[group.weights.nodes(j)[k]]) =
            group.weights.values(j)[k];
    if (projected_)
      group.near = projected_->respond(group.patches, group.weights);
    else
      group.below = responses_below(far_field_, near_field_.depth, group.weights);
    return group;
  }

  void BodyCompliance::add_far(const PatchGroup &loads, const std::vector<const PatchGroup *> &outputs,
                               const std::vector<Eigen::MatrixXd *> &c) const
  {
    const int tooth = outputs.front()->tooth, teeth = gear_.teeth;
    if (tooth == loads.tooth && !projected_)
      return;
    const int ahead = ((tooth - loads.tooth) % teeth + teeth) % teeth,
              offset = std::min(ahead, teeth - ahead);
    FLANK_ASSERT(offset < static_cast<int>(far_field_.by_tooth_offset.size()), std::to_string(offset));
    const auto &h = far_field_.by_tooth_offset[offset];
    std::vector<char> seen(static_cast<std::size_t>(h.rows()), 0);
    std::vector<int> nodes;
    nodes.reserve(static_cast<std::size_t>(h.rows()));
    for (const PatchGroup *group : outputs)
      {
        FLANK_ASSERT(group->tooth == tooth, "outputs on one tooth");
        for (const int node : group->nodes)
          if (!std::exchange(seen[node], 1))
            nodes.push_back(node);
      }
    const LoadResponses far =
        ahead == offset ? LoadResponses::through(h, nodes, loads.nodes, loads.on_nodes, h.rows())
                        : LoadResponses::through(h.transpose(), nodes, loads.nodes, loads.on_nodes, h.rows());
    for (std::size_t g = 0; g < outputs.size(); ++g)
      for (std::size_t i = 0; i < outputs[g]->patches.size(); ++i)
        far.add_mean(outputs[g]->weights.values(i), outputs[g]->weights.nodes(i), 0,
                     c[g]->col(static_cast<Eigen::Index>(i)));
  }

  bool BodyCompliance::is_near(const PatchGroup &first, const PatchGroup &second) const
  {
    if (first.tooth != second.tooth || !projected_)
      return first.tooth == second.tooth;
    return projected_->reaches(first.weights, second.near) || projected_->reaches(second.weights, first.near);
  }

  void BodyCompliance::add_near(const PatchGroup &first, const PatchGroup &second,
                                const Eigen::MatrixXd &potential, Eigen::MatrixXd &forth,
                                Eigen::MatrixXd *back, TipStrips &strips) const
  {
    if (projected_)
      {
        const InvoluteHelicoid flank = gear_.flank();
        EndMeans ends(projected_->edges(), flank, first.patches, second.patches);
        TipMeans tip(projected_->edges(), flank, first.patches, second.patches, strips);
        const auto between = [&](const FlankEdge edge, const std::size_t i, const std::size_t j) {
          return edge == FlankEdge::tip ? tip.between(i, j) : ends.between(edge, i, j);
        };
        projected_->add(first.weights, second.near, potential, between, forth);
        if (back)
          projected_->add(
              second.weights, first.near, potential.transpose(),
              [&](const FlankEdge edge, const std::size_t j, const std::size_t i) {
                return between(edge, i, j);
              },
              *back);
      }
    else
      {
        add_classical_split(far_field_, gear_, near_field_.depth, first, second, forth);
        if (back)
          add_classical_split(far_field_, gear_, near_field_.depth, second, first, *back);
      }
  }
} // namespace flank
