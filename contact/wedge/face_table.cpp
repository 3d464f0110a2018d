// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/wedge/face_table.hpp"

#include "contact/wedge/cubic.hpp"
#include "mesh/base/errors.hpp"
#include "mesh/base/gauss.hpp"

#include <algorithm>
#include <cmath>

namespace flank::wedge
{
  FaceTable::FaceTable(SharedMatrix values)
      : values_(std::move(values))
  {
    FLANK_ASSERT(values_.rows() == rows && values_.cols() == columns, "a table of a face");
  }

  double FaceTable::at(const double along, const double place_distance, const double distance) const
  {
    const auto [near, far] = std::minmax(place_distance, distance);
    double x = std::abs(along) / far, r = near / far;
    constexpr double step = TableAxes::along_step;
    static const double farthest = std::sinh(step * (TableAxes::n_along - 3)),
                        closest = std::exp(TableAxes::radius_step * TableAxes::first_radius);
    const double beyond = std::max(1.0, x / farthest); // as if both were nearer to the edge
    x /= beyond;
    r = std::max(r / beyond, closest);
    const double at_radius = std::log(r) / TableAxes::radius_step - TableAxes::first_radius,
                 at_along = std::asinh(x) / step;
    const int m = std::clamp(static_cast<int>(at_radius), 1, static_cast<int>(columns) - 3),
              i = std::min(static_cast<int>(at_along), TableAxes::n_along - 3);
    const Cubic by_radius(at_radius - m), by_along(at_along - i);
    double sum = 0;
    for (int p = 0; p < 4; ++p)
      for (int q = 0; q < 4; ++q)
        sum += by_radius.value[p] * by_along.value[q] * values_(std::abs(i + q - 1), m + p - 1);
    return sum / (far * beyond);
  }

  FaceMeans::FaceMeans(FaceTable table)
      : table_(std::move(table))
  {
  }

  namespace
  {
    constexpr double along_step = 0.2;
    constexpr int n_along = 52; // to 13,000 times the scale

    /// Gauss points of a strip, graded towards the edge down to 1/64 of it.
    std::vector<std::pair<double, double>> points_of(const FaceMeans::Strip &strip)
    {
      const GaussRule &rule = gauss(3);
      std::vector<std::pair<double, double>> points;
      for (double high = strip.high; high > strip.low;)
        {
          const double low = 0.5 * high > std::max(strip.low, strip.high / 128) ? 0.5 * high : strip.low;
          for (std::size_t q = 0; q < rule.point.size(); ++q)
            points.emplace_back(low + (high - low) * rule.point[q],
                                rule.weight[q] * (high - low) / (strip.high - strip.low));
          high = low;
        }
      return points;
    }
  } // namespace

  FaceMeans::AlongEdge::AlongEdge(const FaceTable &table, const Strip &first, const Strip &second)
      : scale_(0.05 * std::max(first.high, second.high))
      , value_(n_along)
  {
    const auto one = points_of(first), other = points_of(second);
    for (int i = 0; i < n_along; ++i)
      for (const auto &[d, weight] : one)
        for (const auto &[s, share] : other)
          value_[static_cast<std::size_t>(i)] +=
              weight * share * table.at(scale_ * std::sinh(along_step * i), s, d);
  }

  double FaceMeans::AlongEdge::at(const double along) const
  {
    const double at = std::asinh(std::abs(along) / scale_) / along_step;
    const int i = std::min(static_cast<int>(at), n_along - 3);
    const Cubic by(at - i);
    double sum = 0;
    for (int q = 0; q < 4; ++q)
      sum += by.value[static_cast<std::size_t>(q)] * value_[static_cast<std::size_t>(std::abs(i + q - 1))];
    return sum;
  }

  double FaceMeans::AlongEdge::mean(const double along, const double a, const double b) const
  {
    const double x = std::abs(along), most = a + b, flat = std::abs(a - b);
    double sum = 0;
    if (x > 2 * most)
      {
        const GaussRule &rule = gauss(2);
        for (const double p : rule.point)
          for (const double q : rule.point)
            sum += 0.25 * at(x + (2 * p - 1) * a - (2 * q - 1) * b);
        return sum;
      }
    // Two places of the rectangles are t beside their middles' distance as often as the height of a trapezoid
    // at t says. Pieces between its corners, and from 0 on, where places lie beside each other.
    std::array<double, 5> corners = { -most, -flat, flat, most, std::clamp(-x, -most, most) };
    std::sort(corners.begin(), corners.end());
    const GaussRule &rule = gauss(3);
    for (std::size_t k = 0; k + 1 < corners.size(); ++k)
      for (std::size_t q = 0; q < rule.point.size() && corners[k + 1] > corners[k]; ++q)
        {
          const double t = corners[k] + (corners[k + 1] - corners[k]) * rule.point[q],
                       height = std::min(2 * std::min(a, b), most - std::abs(t));
          sum += rule.weight[q] * (corners[k + 1] - corners[k]) * height * at(x + t);
        }
    return sum / (4 * a * b);
  }

  const FaceMeans::AlongEdge &FaceMeans::between(const Strip &first, const Strip &second) const
  {
    const std::array<Strip, 2> key =
        first < second ? std::array{ first, second } : std::array{ second, first };
    const std::lock_guard lock(mutex_);
    const auto it = kept_.find(key);
    return it != kept_.end() ? it->second : kept_.try_emplace(key, table_, key[0], key[1]).first->second;
  }
} // namespace flank::wedge
