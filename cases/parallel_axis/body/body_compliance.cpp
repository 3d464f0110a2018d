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

  PatchGroup BodyCompliance::group(std::vector<Patch> patches) const
  {
    PatchGroup group{ patches.front().tooth, std::move(patches), {}, {}, {}, {} };
    for (const Patch &patch : group.patches)
      {
        FLANK_ASSERT(patch.tooth == group.tooth, "patches of one tooth");
        group.weights.push_back(patch_weights(far_field_.surface, patch));
      }
    if (projected_)
      group.near = projected_->respond(group.patches, group.weights);
    else
      group.below = responses_below(far_field_, near_field_.depth, group.weights);
    return group;
  }

  /// C_h f_j on a whole flank so many teeth ahead.
  const Eigen::MatrixXd &BodyCompliance::far_response(PatchGroup &loads, const int ahead) const
  {
    const auto [it, is_new] = loads.far.try_emplace(ahead);
    if (!is_new)
      return it->second;
    const int teeth = gear_.teeth, offset = std::min(ahead, teeth - ahead);
    FLANK_ASSERT(offset < static_cast<int>(far_field_.by_tooth_offset.size()), std::to_string(offset));
    const auto     &h = far_field_.by_tooth_offset[offset];
    Eigen::MatrixXd response(h.rows(), static_cast<Eigen::Index>(loads.patches.size()));
    response.setZero();
    for (std::size_t j = 0; j < loads.patches.size(); ++j)
      for (std::size_t k = 0; k < loads.weights[j].value.size(); ++k)
        if (ahead == offset)
          response.col(static_cast<Eigen::Index>(j)) += loads.weights[j].value[k] * h.col(loads.weights[j].node[k]);
        else
          response.col(static_cast<Eigen::Index>(j)) += loads.weights[j].value[k] * h.row(loads.weights[j].node[k]).transpose();
    it->second = response.transpose();
    return it->second;
  }

  void BodyCompliance::add_far(const PatchGroup &first, PatchGroup &second, Eigen::MatrixXd &c) const
  {
    if (first.tooth == second.tooth && !projected_)
      return;
    const int              teeth = gear_.teeth, ahead = ((first.tooth - second.tooth) % teeth + teeth) % teeth;
    const Eigen::MatrixXd &far = far_response(second, ahead);
    Eigen::VectorXd        row(far.rows());
    for (std::size_t i = 0; i < first.patches.size(); ++i)
      {
        row.setZero();
        for (std::size_t k = 0; k < first.weights[i].value.size(); ++k)
          row += first.weights[i].value[k] * far.col(first.weights[i].node[k]);
        c.row(static_cast<Eigen::Index>(i)) += row;
      }
  }

  bool BodyCompliance::is_near(const PatchGroup &first, const PatchGroup &second) const
  {
    if (first.tooth != second.tooth || !projected_)
      return first.tooth == second.tooth;
    return projected_->reaches(first.weights, second.near) || projected_->reaches(second.weights, first.near);
  }
} // namespace flank
