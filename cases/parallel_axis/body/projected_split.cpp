// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/body/projected_split.hpp"

#include "contact/half_space/half_space.hpp"
#include "mesh/base/gauss.hpp"

#include <cmath>

namespace flank
{
  PatchPotentials::PatchPotentials(const std::vector<Patch> &patches, const InvoluteHelicoid &flank)
      : patches_(patches)
      , flank_(flank)
  {
    std::map<int, int> count;
    for (const Patch &patch : patches)
      place_.push_back(count[patch.tooth]++);
    for (const auto &[tooth, n] : count)
      of_tooth_[tooth].setConstant(n, n, -1);
    for (const Patch &patch : patches)
      own_.push_back(&of_tooth_[patch.tooth]);
  }

  double PatchPotentials::operator()(const std::size_t i, const std::size_t j)
  {
    double &value = (*own_[i])(place_[i], place_[j]);
    if (value < 0)
      {
        const Patch          &a = patches_[std::min(i, j)], &b = patches_[std::max(i, j)];
        const Eigen::Vector2d d = b.seen_from(a, flank_);
        value =
            half_space::mean_love_potential({ 0, 0, a.half_profile, a.half_generator }, { d.x(), d.y(), b.half_profile, b.half_generator });
        (*own_[i])(place_[j], place_[i]) = value;
      }
    return value;
  }

  ProjectedSplit::ProjectedSplit(const Gear &gear, const FlankSurface &surface, const int points,
                                 std::function<const FlankBlocks &()> blocks, Tables tables)
      : gear_(gear)
      , helicoid_(gear.flank())
      , surface_(surface)
      , points_(points)
      , blocks_(std::move(blocks))
      , tables_(std::move(tables))
  {
  }

  std::shared_ptr<const SourceTable> ProjectedSplit::table(const Key &key) const
  {
    {
      const std::lock_guard lock(mutex_);
      if (const auto it = tables_.find(key); it != tables_.end())
        return it->second;
    }
    const auto [first_row, last_row, first_layer, last_layer] = key;
    auto made =
        std::make_shared<const SourceTable>(make_source_table(blocks_().around(first_row, last_row, first_layer, last_layer), surface_,
                                                              gear_, first_row, last_row, first_layer, last_layer, { points_ }));
    const std::lock_guard lock(mutex_);
    return tables_.try_emplace(key, std::move(made)).first->second;
  }

  std::unique_ptr<BackgroundWork> ProjectedSplit::prepare(const int threads)
  {
    std::vector<Key> keys;
    for (int layer = 0; layer < surface_.layers; ++layer)
      if (const int shifted = layer + layer_shift(surface_, layer, layer); shifted == layer)
        for (int row = 0; row < surface_.rows; ++row)
          keys.emplace_back(row, row, layer, layer);
    const int count = static_cast<int>(keys.size());
    return std::make_unique<BackgroundWork>(
        count, [this, keys = std::move(keys)](const int k) { table(keys[k]); }, threads);
  }

  void ProjectedSplit::add(const std::vector<Patch> &patches, const std::vector<PatchWeights> &weights, PatchPotentials &potentials,
                           Eigen::MatrixXd &c) const
  {
    const FlankSurface &s     = surface_;
    const double        scale = half_space::surface_compliance(gear_.youngs_modulus, gear_.poissons_ratio);
    const int           p     = s.degree;

    // Patches on the same elements share a block; those of one tooth are read together.
    std::map<int, std::vector<int>>                 of_tooth;
    std::map<std::pair<int, Key>, std::vector<int>> of_elements;
    for (std::size_t j = 0; j < patches.size(); ++j)
      {
        // Loaded elements: those the patch reaches into by more than half an element, so the cut stays more than 1.5 away.
        const auto range = [](const double low, const double high, const int count) {
          const double middle = 0.5 * (low + high), reach = std::max(0.0, 0.5 * (high - low) - 0.5);
          return std::pair{ std::clamp(static_cast<int>(middle - reach), 0, count - 1),
                            std::clamp(static_cast<int>(middle + reach), 0, count - 1) };
        };
        const auto [row_a, row_b]     = range(weights[j].row_low, weights[j].row_high, s.rows);
        const auto [layer_a, layer_b] = range(weights[j].layer_low, weights[j].layer_high, s.layers);
        of_tooth[patches[j].tooth].push_back(static_cast<int>(j));
        of_elements[{ patches[j].tooth, { row_a, row_b, layer_a, layer_b } }].push_back(static_cast<int>(j));
      }

    SourceTable::ColumnWeights sources;
    Eigen::MatrixXd            response, by_patch, elements;
    for (const auto &[place, loads] : of_elements)
      {
        const auto &[tooth, key]                    = place;
        const auto [row_a, row_b, layer_a, layer_b] = key;
        const int  shift                            = layer_shift(s, layer_a, layer_b);
        const auto block                            = table({ row_a, row_b, layer_a + shift, layer_b + shift });
        const auto local                            = [&](const PatchWeights &w, const std::size_t k) {
          return block->node(w.row_node[k] - block->first_row * p, w.layer_node[k] + (shift - block->first_layer) * p);
        };

        // W_j: nodal loads, and the half-space of the patch by point forces over it.
        response.setZero(block->load_response.rows(), static_cast<Eigen::Index>(loads.size()));
        for (std::size_t l = 0; l < loads.size(); ++l)
          {
            const Patch        &patch = patches[loads[l]];
            const PatchWeights &wj    = weights[loads[l]];
            auto                moved = response.col(static_cast<Eigen::Index>(l));
            for (std::size_t k = 0; k < wj.value.size(); ++k)
              moved += wj.value[k] * block->load_response.col(local(wj, k));
            sources.reset(block->source_response.cols());
            const auto points_of = [this](const double low, const double high) {
              return std::clamp(static_cast<int>(std::ceil(2 * (high - low))) + points_ - 3, points_ - 2, points_);
            };
            const GaussRule &across = gauss(points_of(wj.row_low, wj.row_high)), &along = gauss(points_of(wj.layer_low, wj.layer_high));
            for (std::size_t v = 0; v < along.point.size(); ++v)
              for (std::size_t u = 0; u < across.point.size(); ++u)
                {
                  const double x = (2 * across.point[u] - 1) * patch.half_profile, y = (2 * along.point[v] - 1) * patch.half_generator;
                  const double roll = patch.roll + y * helicoid_.roll_per_generator(), q = roll * roll + 2 * x / helicoid_.base_radius();
                  block->add_source(s.row_coordinate(q), s.layer_coordinate(patch.z + y * helicoid_.cos_base_helix()) + shift,
                                    across.weight[u] * along.weight[v], sources);
                }
            for (const int k : sources.used)
              moved += sources.weight[k] * block->source_response.col(k);
          }

        // N_i W_j and the half-space for all patches of the tooth inside the block; the loads side by side.
        by_patch             = response.transpose();
        const double row_end = std::min(block->last_row + 1, s.rows), layer_begin = block->first_layer - shift,
                     layer_end = block->last_layer + 1 - shift;
        std::vector<int> outputs;
        for (const int i : of_tooth[tooth])
          if (const PatchWeights &wi = weights[i];
              wi.row_low >= block->first_row && wi.row_high <= row_end && wi.layer_low >= layer_begin && wi.layer_high <= layer_end)
            outputs.push_back(i);
        elements.setZero(static_cast<Eigen::Index>(loads.size()), static_cast<Eigen::Index>(outputs.size()));
        for (std::size_t o = 0; o < outputs.size(); ++o)
          {
            const PatchWeights &wi = weights[outputs[o]];
            auto                of = elements.col(static_cast<Eigen::Index>(o));
            for (std::size_t k = 0; k < wi.value.size(); ++k)
              of += wi.value[k] * by_patch.col(local(wi, k));
          }
        for (std::size_t l = 0; l < loads.size(); ++l)
          for (std::size_t o = 0; o < outputs.size(); ++o)
            c(outputs[o], loads[l]) += scale * potentials(outputs[o], loads[l]) - elements(l, o);
      }
  }
} // namespace flank
