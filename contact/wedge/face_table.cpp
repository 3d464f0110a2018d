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
                 at_along = std::log(x + std::sqrt(1 + x * x)) / step;
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
    /// Places along the edge, counted in AlongEdge::scale_: up to 1, then octaves. Beyond, the value between
    /// the middles of strips is their mean.
    constexpr int intervals = 10;
    constexpr int points = 5; // of a polynomial on an interval

    double low_end(const int interval)
    {
      return interval == 0 ? 0 : std::ldexp(1.0, interval - 1);
    }

    double length_of(const int interval)
    {
      return interval == 0 ? 1 : std::ldexp(1.0, interval - 1);
    }

    /// From values at equal distances on [0, 1] to the coefficients of powers.
    Eigen::Matrix<double, points, points> coefficients()
    {
      Eigen::Matrix<double, points, points> powers;
      for (int i = 0; i < points; ++i)
        for (int j = 0; j < points; ++j)
          powers(i, j) = j == 0 ? 1 : std::pow(i / (points - 1.0), j);
      return powers.inverse();
    }

    /// Gauss points of a strip, graded towards the edge down to 1/64 of it.
    std::vector<std::pair<double, double>> points_of(const FaceMeans::Strip &strip)
    {
      const GaussRule &rule = gauss(3);
      std::vector<std::pair<double, double>> points;
      for (double high = strip.high; high > strip.low;)
        {
          const double low = 0.5 * high > std::max(strip.low, strip.high / 64) ? 0.5 * high : strip.low;
          for (std::size_t q = 0; q < rule.point.size(); ++q)
            points.emplace_back(low + (high - low) * rule.point[q],
                                rule.weight[q] * (high - low) / (strip.high - strip.low));
          high = low;
        }
      return points;
    }
  } // namespace

  FaceMeans::AlongEdge::AlongEdge(const FaceTable &table, const Strip &first, const Strip &second)
      : table_(&table)
      , middle_{ 0.5 * (first.low + first.high), 0.5 * (second.low + second.high) }
      , scale_(0.05 * std::max(first.high, second.high))
      , value_(points, intervals)
  {
    static const Eigen::Matrix<double, points, points> to_powers = coefficients();
    const auto one = points_of(first), other = points_of(second);
    for (int k = 0; k < intervals; ++k)
      {
        Eigen::Matrix<double, points, 1> at = Eigen::Matrix<double, points, 1>::Zero();
        for (int i = 0; i < points; ++i)
          for (const auto &[d, weight] : one)
            for (const auto &[s, share] : other)
              at[i] +=
                  weight * share * table.at(scale_ * (low_end(k) + length_of(k) * i / (points - 1)), s, d);
        value_.col(k) = to_powers * at;
      }
  }

  double FaceMeans::AlongEdge::at(const double along) const
  {
    const double x = std::abs(along) / scale_;
    int interval = 0;
    if (x >= 1)
      std::frexp(x, &interval); // x = m 2^interval, 1/2 <= m < 1
    if (interval >= intervals)
      return table_->at(along, middle_[0], middle_[1]);
    const double t = (x - low_end(interval)) / length_of(interval), *c = &value_.coeffRef(0, interval);
    return c[0] + t * (c[1] + t * (c[2] + t * (c[3] + t * c[4])));
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

  double FaceMeans::mean(const Strip &first, const Strip &second, const double along, const double a,
                         const double b) const
  {
    const double lengths = first.high - first.low + second.high - second.low;
    if (first.low + second.low < lengths)
      return between(first, second).mean(along, a, b);
    constexpr double half = 0.2113248654051871; // of Gauss's two points on [0, 1]
    double sum = 0;
    for (const double d : { half, 1 - half })
      for (const double s : { half, 1 - half })
        sum += 0.25 * table_.at(along, first.low + (first.high - first.low) * d,
                                second.low + (second.high - second.low) * s);
    return sum;
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
