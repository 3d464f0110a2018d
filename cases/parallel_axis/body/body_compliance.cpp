// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/body/body_compliance.hpp"

#include "mesh/base/errors.hpp"

#include <map>

namespace flank
{
  BodyCompliance::BodyCompliance(const Gear &gear, const SectorResolution &resolution, const int max_offset, const Split split,
                                 const ClassicalDepth depth, const BodyModel &model, const ParallelSession *session)
      : gear_(gear)
      , depth_(depth)
      , elements_(std::make_unique<BodyElements>(gear, resolution))
      , far_field_(flank_compliance(*elements_, model, max_offset, split == Split::projected ? 0 : depth_planes(depth, resolution.degree),
                                    session))
      , n_unknowns_(elements_->body().n_unknowns())
  {
    if (split == Split::projected && !far_field_.by_tooth_offset.empty())
      {
        projected_ = std::make_unique<ProjectedSplit>(gear, far_field_.surface,
                                                      [elements = elements_.get()]() -> const FlankBlocks & { return elements->blocks(); });
        projected_->prepare();
      }
  }

  BodyCompliance::BodyCompliance(const Gear &gear, const SectorResolution &resolution, const Split split, const ClassicalDepth depth,
                                 FlankCompliance far_field, const int n_unknowns, ProjectedSplit::Tables tables)
      : gear_(gear)
      , depth_(depth)
      , elements_(std::make_unique<BodyElements>(gear, resolution))
      , far_field_(std::move(far_field))
      , n_unknowns_(n_unknowns)
  {
    if (split == Split::projected)
      projected_ = std::make_unique<ProjectedSplit>(
          gear, far_field_.surface, [elements = elements_.get()]() -> const FlankBlocks & { return elements->blocks(); },
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
    // Along long columns throughout: C_h times the loads, turned over, then a sum of few columns for each output.
    const auto add_columns = [&](const Eigen::MatrixXd &columns, const PatchWeights &w, auto &&result) {
      for (std::size_t k = 0; k < w.value.size(); ++k)
        result += w.value[k] * columns.col(w.node[k]);
    };
    for (const auto &[load_tooth, loads] : of_tooth)
      for (const auto &[tooth, outputs] : of_tooth)
        {
          if (tooth < load_tooth || (tooth == load_tooth && !projected_))
            continue; // reciprocity gives the other half
          const int teeth = gear_.teeth, ahead = ((tooth - load_tooth) % teeth + teeth) % teeth, offset = std::min(ahead, teeth - ahead);
          FLANK_ASSERT(offset < static_cast<int>(far_field_.by_tooth_offset.size()), std::to_string(offset));
          const Eigen::MatrixXd &h        = far_field_.by_tooth_offset[offset];
          const Eigen::MatrixXd  turned   = ahead != offset ? Eigen::MatrixXd(h.transpose()) : Eigen::MatrixXd();
          Eigen::MatrixXd        response = Eigen::MatrixXd::Zero(s.n_nodes(), loads.size());
          for (std::size_t j = 0; j < loads.size(); ++j)
            add_columns(ahead != offset ? turned : h, weights[loads[j]], response.col(j));
          const Eigen::MatrixXd by_load = response.transpose();
          Eigen::VectorXd       output(loads.size());
          for (const int i : outputs)
            {
              output.setZero();
              add_columns(by_load, weights[i], output);
              for (std::size_t j = 0; j < loads.size(); ++j)
                c(loads[j], i) += output[j]; // the transposed entry; the same on one tooth
              if (tooth != load_tooth)
                for (std::size_t j = 0; j < loads.size(); ++j)
                  c(i, loads[j]) += output[j];
            }
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
      add_classical_split(far_field_, gear_, depth_, patches, weights, c);
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
