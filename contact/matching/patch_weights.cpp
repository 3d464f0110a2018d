// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/matching/patch_weights.hpp"

#include "mesh/base/errors.hpp"
#include "mesh/base/gauss.hpp"
#include "solver/elements/lagrange.hpp"

#include <algorithm>
#include <cmath>

namespace flank
{
  namespace
  {
    /// A place that rounding alone keeps from the border between two elements lies on it: which elements a
    /// patch reaches does not depend on rounding where slices and elements share borders.
    double on_border(const double place)
    {
      const double border = std::round(place);
      return std::abs(place - border) < 1e-9 ? border : place;
    }

    /// The part of a polygon between two whole numbers of an axis.
    Polygon between(const Polygon &whole, const int axis, const int low)
    {
      const Polygon above = clip(whole, [=](const Eigen::Vector2d &x) { return x[axis] - low; });
      return clip(above, [=](const Eigen::Vector2d &x) { return low + 1 - x[axis]; });
    }

    /// Over a polygon: `add` for every point and its weight; returns the area. Triangles about the first
    /// corner, each a collapsed square from there outwards.
    template <class Add>
    double integrate(const Polygon &polygon, const GaussRule &rule, const Add &add)
    {
      double area = 0;
      for (std::size_t t = 2; t < polygon.size(); ++t)
        {
          const Eigen::Vector2d a = polygon[t - 1] - polygon[0], b = polygon[t] - polygon[0];
          const double twice = std::abs(a[0] * b[1] - a[1] * b[0]);
          for (std::size_t i = 0; i < rule.point.size(); ++i)
            for (std::size_t j = 0; j < rule.point.size(); ++j)
              {
                const double u = rule.point[i], v = rule.point[j],
                             weight = rule.weight[i] * rule.weight[j] * u * twice;
                area += weight;
                add(polygon[0] + u * ((1 - v) * a + v * b), weight);
              }
        }
      return area;
    }
  } // namespace

  PatchWeights::PatchWeights(const FlankSurface &surface, const std::vector<Patch> &patches)
  {
    const FlankSurface &s = surface;
    const LagrangePolynomials polynomials(s.abscissas);
    const int p = s.degree, n = p + 1;
    const GaussRule &rule =
        gauss(p + 1); // exact: of degree 2p + 1 outwards, with the collapsed square, and 2p across
    std::vector<double> integral; // of the shape functions of the elements that a patch lies on
    begin_.push_back(0);
    for (const Patch &patch : patches)
      {
        Polygon polygon;
        for (const Eigen::Vector2d &corner : patch.outline)
          polygon.emplace_back(
              on_border(std::clamp(s.row_coordinate(corner[0]), 0.0, static_cast<double>(s.rows))),
              on_border(std::clamp(s.layer_coordinate(corner[1]), 0.0, static_cast<double>(s.layers))));
        Extent &extent = extent_.emplace_back(Extent{ 1e300, -1e300, 1e300, -1e300 });
        for (const Eigen::Vector2d &corner : polygon)
          {
            extent.row_low = std::min(extent.row_low, corner[0]);
            extent.row_high = std::max(extent.row_high, corner[0]);
            extent.layer_low = std::min(extent.layer_low, corner[1]);
            extent.layer_high = std::max(extent.layer_high, corner[1]);
          }
        const int row_begin = std::min(static_cast<int>(extent.row_low), s.rows - 1),
                  row_end = std::min(static_cast<int>(extent.row_high), s.rows - 1),
                  layer_begin = std::min(static_cast<int>(extent.layer_low), s.layers - 1),
                  layer_end = std::min(static_cast<int>(extent.layer_high), s.layers - 1);
        const int row_nodes = (row_end - row_begin + 1) * p + 1,
                  layer_nodes = (layer_end - layer_begin + 1) * p + 1;
        integral.assign(static_cast<std::size_t>(row_nodes) * layer_nodes, 0.0);
        double area = 0;
        for (int layer = layer_begin; layer <= layer_end; ++layer)
          {
            const Polygon strip = layer_begin == layer_end ? polygon : between(polygon, 1, layer);
            for (int row = row_begin; row <= row_end; ++row)
              {
                const Polygon part = row_begin == row_end ? strip : between(strip, 0, row);
                area += integrate(part, rule, [&](const Eigen::Vector2d &x, const double weight) {
                  const auto across = polynomials.values(x[0] - row),
                             along = polynomials.values(x[1] - layer);
                  for (int k = 0; k < n; ++k)
                    for (int r = 0; r < n; ++r)
                      integral[((layer - layer_begin) * p + k) * row_nodes + (row - row_begin) * p + r] +=
                          weight * across[r] * along[k];
                });
              }
          }
        FLANK_ASSERT(area > 0, "a patch lies on the flank");
        for (int k = 0; k < layer_nodes; ++k)
          for (int r = 0; r < row_nodes; ++r)
            if (const double value = integral[k * row_nodes + r] / area; value != 0)
              {
                node_.push_back(s.node(row_begin * p + r, layer_begin * p + k));
                value_.push_back(value);
              }
        begin_.push_back(node_.size());
      }
  }
} // namespace flank
