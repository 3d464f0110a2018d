// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/body/patch_weights.hpp"

#include "mesh/base/errors.hpp"
#include "mesh/base/gauss.hpp"

#include <array>

namespace flank
{
  PatchWeights patch_weights(const FlankSurface &s, const Patch &patch)
  {
    Polygon polygon;
    for (const Eigen::Vector2d &corner : patch.outline)
      polygon.emplace_back(std::clamp(s.row_coordinate(corner[0]), 0.0, static_cast<double>(s.rows)),
                           std::clamp(s.layer_coordinate(corner[1]), 0.0, static_cast<double>(s.layers)));
    PatchWeights w;
    w.row_low = w.layer_low = 1e300;
    w.row_high = w.layer_high = -1e300;
    for (const Eigen::Vector2d &corner : polygon)
      {
        w.row_low    = std::min(w.row_low, corner[0]);
        w.row_high   = std::max(w.row_high, corner[0]);
        w.layer_low  = std::min(w.layer_low, corner[1]);
        w.layer_high = std::max(w.layer_high, corner[1]);
      }
    const int p = s.degree, n = p + 1, row_begin = std::min(static_cast<int>(w.row_low), s.rows - 1),
              row_end               = std::min(static_cast<int>(w.row_high), s.rows - 1);
    const int layer_begin           = std::min(static_cast<int>(w.layer_low), s.layers - 1),
              layer_end             = std::min(static_cast<int>(w.layer_high), s.layers - 1);
    const int             row_nodes = (row_end - row_begin + 1) * p + 1, layer_nodes = (layer_end - layer_begin + 1) * p + 1;
    std::vector<double>   value(static_cast<std::size_t>(row_nodes) * layer_nodes, 0.0);
    const GaussRule      &rule = gauss(p + 1); // exact: of degree 2p + 1 outwards, with the collapsed square, and 2p across
    double                area = 0;
    std::array<double, 4> nr{}, nl{};
    const auto            between = [](const Polygon &whole, const int axis, const int low) {
      const Polygon above = clip(whole, [=](const Eigen::Vector2d &x) { return x[axis] - low; });
      return clip(above, [=](const Eigen::Vector2d &x) { return low + 1 - x[axis]; });
    };
    for (int layer = layer_begin; layer <= layer_end; ++layer)
      {
        const Polygon strip = layer_begin == layer_end ? polygon : between(polygon, 1, layer);
        for (int row = row_begin; row <= row_end; ++row)
          {
            const Polygon part = row_begin == row_end ? strip : between(strip, 0, row);
            for (std::size_t t = 2; t < part.size(); ++t)
              {
                const Eigen::Vector2d a = part[t - 1] - part[0], b = part[t] - part[0];
                const double          twice = std::abs(a[0] * b[1] - a[1] * b[0]);
                for (std::size_t i = 0; i < rule.point.size(); ++i) // collapsed square: from the first corner outwards
                  for (std::size_t j = 0; j < rule.point.size(); ++j)
                    {
                      const double          u = rule.point[i], v = rule.point[j], weight = rule.weight[i] * rule.weight[j] * u * twice;
                      const Eigen::Vector2d x = part[0] + u * ((1 - v) * a + v * b);
                      lagrange(s.abscissas, x[0] - row, nr.data());
                      lagrange(s.abscissas, x[1] - layer, nl.data());
                      area += weight;
                      for (int k = 0; k < n; ++k)
                        for (int r = 0; r < n; ++r)
                          value[((layer - layer_begin) * p + k) * row_nodes + (row - row_begin) * p + r] += weight * nr[r] * nl[k];
                    }
              }
          }
      }
    FLANK_ASSERT(area > 0, "a patch lies on the flank");
    for (auto *list : { &w.row_node, &w.layer_node, &w.node })
      list->reserve(value.size());
    w.value.reserve(value.size());
    for (int k = 0; k < layer_nodes; ++k)
      for (int r = 0; r < row_nodes; ++r)
        if (const double v = value[k * row_nodes + r] / area; v != 0)
          {
            w.row_node.push_back(row_begin * p + r);
            w.layer_node.push_back(layer_begin * p + k);
            w.node.push_back(s.node(w.row_node.back(), w.layer_node.back()));
            w.value.push_back(v);
          }
    return w;
  }

  PackedWeights::PackedWeights(const std::vector<PatchWeights> &patches)
  {
    for (const PatchWeights &patch : patches)
      {
        node_.insert(node_.end(), patch.node.begin(), patch.node.end());
        value_.insert(value_.end(), patch.value.begin(), patch.value.end());
        begin_.push_back(node_.size());
      }
  }
} // namespace flank
