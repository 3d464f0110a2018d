// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/matching/projected_split.hpp"

#include "contact/half_space/half_space.hpp"
#include "mesh/base/gauss.hpp"

#include <algorithm>
#include <cmath>

namespace flank
{
  Eigen::MatrixXd patch_potentials(const std::vector<Patch> &first, const std::vector<Patch> &second,
                                   const InvoluteHelicoid &flank)
  {
    const bool same = &first == &second;
    std::vector<half_space::RectanglePair> pairs;
    pairs.reserve(first.size() * second.size());
    for (std::size_t j = 0; j < second.size(); ++j)
      for (std::size_t i = 0; i < (same ? j + 1 : first.size()); ++i)
        {
          const Patch &a = first[i], &b = second[j];
          const Eigen::Vector2d d = b.seen_from(a, flank);
          pairs.push_back(
              { d.x(), d.y(), a.half_profile, a.half_generator, b.half_profile, b.half_generator });
        }
    std::vector<double> mean(pairs.size());
    half_space::mean_love_potentials(pairs, mean);
    Eigen::MatrixXd result(static_cast<Eigen::Index>(first.size()), static_cast<Eigen::Index>(second.size()));
    auto next = mean.begin();
    for (Eigen::Index j = 0; j < result.cols(); ++j)
      for (Eigen::Index i = 0; i < (same ? j + 1 : result.rows()); ++i)
        result(i, j) = *next++;
    if (same)
      result.triangularView<Eigen::StrictlyLower>() = result.transpose();
    return result;
  }

  ProjectedSplit::ProjectedSplit(const Gear &gear, const FlankSurface &surface, const NearField &near_field,
                                 std::function<const FlankBlocks &()> blocks, Tables tables,
                                 const FlankEdges::Faces *faces)
      : gear_(gear)
      , helicoid_(gear.flank())
      , surface_(surface)
      , points_(near_field.points)
      , edges_(gear, near_field.free_ends, faces)
      , scale_(half_space::surface_compliance(gear.youngs_modulus, gear.poissons_ratio))
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
    const int last = surface_.layers - 1;
    const bool is_mirrored = gear_.base_helix_angle == 0 && first_layer + last_layer > last;
    auto made = std::make_shared<const SourceTable>(
        is_mirrored
            ? mirrored(*table({ first_row, last_row, last - last_layer, last - first_layer }), last + 1)
            : make_source_table(blocks_().around(first_row, last_row, first_layer, last_layer), surface_,
                                gear_, edges_, first_row, last_row, first_layer, last_layer, { points_ }));
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

  namespace
  {
    /// Rounding error of middles and lengths of patches, in elements: which elements count as loaded, and how
    /// many points a quadrature has, must not depend on it.
    constexpr double rounding = 1e-9;

    /// A column of numbers and its weight in a sum.
    struct Term
    {
      double weight;
      const double *column;
    };

    /// The weighted sum of all columns, four columns at a time, so that the sum is read and written a quarter
    /// as often.
    void sum_up(const std::vector<Term> &terms, Eigen::Ref<Eigen::VectorXd> sum)
    {
      const auto column = [&](const std::size_t k) {
        return Eigen::Map<const Eigen::VectorXd>(terms[k].column, sum.size());
      };
      sum.setZero();
      std::size_t k = 0;
      for (; k + 4 <= terms.size(); k += 4)
        sum += (terms[k].weight * column(k) + terms[k + 1].weight * column(k + 1)) +
               (terms[k + 2].weight * column(k + 2) + terms[k + 3].weight * column(k + 3));
      for (; k < terms.size(); ++k)
        sum += terms[k].weight * column(k);
    }
  } // namespace

  /// Loaded elements of a patch: those it reaches into by more than half an element, so the cut stays more
  /// than 1.5 away. A patch whose middle lies between two elements loads the further one, however it is
  /// rounded.
  ProjectedSplit::Key ProjectedSplit::loaded_elements(const PatchWeights::Extent &extent) const
  {
    const auto range = [](const double low, const double high, const int count) {
      const double middle = 0.5 * (low + high), reach = std::max(0.0, 0.5 * (high - low) - 0.5);
      return std::pair{ std::clamp(static_cast<int>(middle - reach + rounding), 0, count - 1),
                        std::clamp(static_cast<int>(middle + reach + rounding), 0, count - 1) };
    };
    const auto [row_a, row_b] = range(extent.row_low, extent.row_high, surface_.rows);
    const auto [layer_a, layer_b] = range(extent.layer_low, extent.layer_high, surface_.layers);
    return { row_a, row_b, layer_a, layer_b };
  }

  /// The half-space of a patch as point forces over it, on the table's sources.
  void ProjectedSplit::add_point_forces(const Patch &patch, const PatchWeights::Extent &extent,
                                        const int shift, SourceTable::ColumnWeights &sources) const
  {
    const auto points_of = [this](const double low, const double high) {
      return std::clamp(static_cast<int>(std::ceil(2 * (high - low) - rounding)) + points_ - 3, points_ - 2,
                        points_);
    };
    const GaussRule &across = gauss(points_of(extent.row_low, extent.row_high)),
                    &along = gauss(points_of(extent.layer_low, extent.layer_high));
    std::vector<double> rows(across.point.size()), forces(across.point.size());
    for (std::size_t v = 0; v < along.point.size(); ++v)
      {
        const double y = (2 * along.point[v] - 1) * patch.half_generator;
        for (std::size_t u = 0; u < across.point.size(); ++u)
          {
            const double x = (2 * across.point[u] - 1) * patch.half_profile;
            rows[u] = surface_.row_coordinate(helicoid_.roll_squared(patch.roll, x, y));
            forces[u] = across.weight[u] * along.weight[v];
          }
        sources.add(rows, surface_.layer_coordinate(patch.z + y * helicoid_.cos_base_helix()) + shift,
                    forces);
      }
  }

  /// W_j of patches on the same elements: nodal loads, and the half-space of each patch.
  ProjectedSplit::Response ProjectedSplit::respond_on(const Key &key, const std::vector<int> &loads,
                                                      const std::vector<Patch> &patches,
                                                      const PatchWeights &weights) const
  {
    const auto &[row_a, row_b, layer_a, layer_b] = key;
    const int p = surface_.degree, row_nodes = surface_.n_row_nodes(),
              shift = layer_shift(surface_, layer_a, layer_b);
    const auto block = table({ row_a, row_b, layer_a + shift, layer_b + shift });
    SourceTable::ColumnWeights sources;
    std::vector<Term> terms;
    Eigen::MatrixXd moved(block->load_response.rows(), static_cast<Eigen::Index>(loads.size()));
    for (std::size_t l = 0; l < loads.size(); ++l)
      {
        const auto nodes = weights.nodes(loads[l]);
        const auto values = weights.values(loads[l]);
        terms.clear();
        for (std::size_t k = 0; k < nodes.size(); ++k)
          {
            const int row_node = nodes[k] % row_nodes, layer_node = nodes[k] / row_nodes;
            terms.push_back({ values[k], &block->load_response
                                              .col(block->node(row_node - block->first_row * p,
                                                               layer_node + (shift - block->first_layer) * p))
                                              .coeffRef(0) });
          }
        sources.reset(*block);
        add_point_forces(patches[loads[l]], weights.extent(loads[l]), shift, sources);
        for (const int k : sources.used())
          terms.push_back({ sources.weight()[k], &block->source_response.col(k).coeffRef(0) });
        sum_up(terms, moved.col(static_cast<Eigen::Index>(l)));
      }
    LoadResponses on_flank(moved.cols(), static_cast<Eigen::Index>(block->layers_of_nodes) * row_nodes);
    for (Eigen::Index load = 0; load < moved.cols(); ++load)
      for (int layer = 0; layer < block->layers_of_nodes; ++layer)
        for (int row = 0; row < block->rows_of_nodes; ++row)
          on_flank(load, layer * row_nodes + row) = moved(block->node(row, layer), load);
    return { block, shift, loads, surface_.node(block->first_row * p, (block->first_layer - shift) * p),
             std::move(on_flank) };
  }

  std::vector<ProjectedSplit::Response> ProjectedSplit::respond(const std::vector<Patch> &patches,
                                                                const PatchWeights &weights) const
  {
    std::map<Key, std::vector<int>> of_elements; // patches on the same ones share a block
    for (std::size_t j = 0; j < patches.size(); ++j)
      of_elements[loaded_elements(weights.extent(j))].push_back(static_cast<int>(j));
    std::vector<Response> responses;
    for (const auto &[key, loads] : of_elements)
      responses.push_back(respond_on(key, loads, patches, weights));
    return responses;
  }

  bool ProjectedSplit::reaches(const PatchWeights &outputs, const std::vector<Response> &loads) const
  {
    for (const Response &response : loads)
      for (std::size_t i = 0; i < outputs.size(); ++i)
        if (lies_on(outputs.extent(i), response))
          return true;
    return false;
  }

  void ProjectedSplit::add(const PatchWeights &outputs, const std::vector<Response> &responses,
                           const Eigen::MatrixXd &potential, const MeansOfEdges &of_edges,
                           Eigen::MatrixXd &c) const
  {
    std::size_t most = 0;
    for (const Response &response : responses)
      most = std::max(most, response.loads.size());
    Eigen::VectorXd of_loads(static_cast<Eigen::Index>(most));
    for (const Response &response : responses)
      {
        for (std::size_t i = 0; i < outputs.size(); ++i)
          {
            if (!lies_on(outputs.extent(i), response))
              continue;
            auto elements = of_loads.head(static_cast<Eigen::Index>(response.loads.size()));
            elements.setZero();
            response.moved.add_mean(outputs.values(i), outputs.nodes(i), response.first_node, elements);
            for (std::size_t l = 0; l < response.loads.size(); ++l)
              {
                const int load = response.loads[l];
                c(i, load) += scale_ * potential(i, load) - elements[l];
                response.block->free.each([&](const FlankEdge edge) {
                  c(i, load) += of_edges(edge, i, static_cast<std::size_t>(load)) / gear_.youngs_modulus;
                });
              }
          }
      }
  }
} // namespace flank
