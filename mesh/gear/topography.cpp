// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesh/gear/topography.hpp"

#include "mesh/base/units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

namespace flank
{
  namespace
  {
    /// The interpolated value at x is the sum of weight[k] times the table's value at node first + k.
    struct Stencil
    {
      int first = 0;
      std::array<double, 4> weight{};
    };

    /// Adds `factor` times a slope at node i: that of the parabola through it and its neighbours (the nearest
    /// three at an end). Where one interval is much shorter than the other, what its own slope counts for is
    /// bounded, so that the long one swings over by no more than a fraction of the step between its values.
    void add_slope(const std::vector<double> &x, const int i, const double factor, Stencil &stencil)
    {
      const int n = static_cast<int>(x.size());
      const auto secant = [&](const int k, const double weight) { // from node k to the next
        const double share = factor * weight / (x[k + 1] - x[k]);
        stencil.weight[k - stencil.first] -= share;
        stencil.weight[k + 1 - stencil.first] += share;
      };
      constexpr double most = 1.5; // of the short interval's slope, over the ratio of the lengths
      if (n == 2)
        secant(0, 1);
      else if (i == 0 || i == n - 1)
        {
          const int own = i == 0 ? 0 : n - 2, next = i == 0 ? 1 : n - 3;
          const double h = x[own + 1] - x[own], beyond = x[next + 1] - x[next],
                       against = std::min(h / (h + beyond), most * beyond / h);
          secant(own, 1 + against);
          secant(next, -against);
        }
      else
        {
          const double before = x[i] - x[i - 1], after = x[i + 1] - x[i];
          const double of_before = before < after
                                       ? std::min(after / (before + after), most * before / after)
                                       : 1 - std::min(before / (before + after), most * after / before);
          secant(i - 1, of_before);
          secant(i, 1 - of_before);
        }
    }

    Stencil stencil_at(const std::vector<double> &x, double at)
    {
      const int n = static_cast<int>(x.size());
      at = std::clamp(at, x.front(), x.back());
      const int i =
          std::clamp(static_cast<int>(std::upper_bound(x.begin(), x.end(), at) - x.begin()) - 1, 0, n - 2);
      Stencil s;
      s.first = std::clamp(i - 1, 0, std::max(0, n - 4));
      const double h = x[i + 1] - x[i], t = (at - x[i]) / h;
      s.weight[i - s.first] += (1 + 2 * t) * (1 - t) * (1 - t);
      s.weight[i + 1 - s.first] += t * t * (3 - 2 * t);
      add_slope(x, i, h * t * (1 - t) * (1 - t), s);
      add_slope(x, i + 1, -h * t * t * (1 - t), s);
      return s;
    }

    /// The least length within which a sampled curve turns suddenly [mm]; infinite: it does so nowhere.
    double sudden_turn(const std::vector<double> &x, const Eigen::VectorXd &values)
    {
      constexpr double least = 1e-4; // as a slope: gaps of contacts turn by a hundred times as much
      const int n = static_cast<int>(x.size());
      const auto slope = [&](const int i) { return (values[i + 1] - values[i]) / (x[i + 1] - x[i]); };
      // From the interval before a node to the one behind another.
      const auto turned = [&](const int first, const int last) {
        return std::abs(slope(last) - slope(first - 1));
      };
      const auto length = [&](const int first, const int last) { return x[last + 1] - x[first - 1]; };
      const auto curvature = [&](const int node) { return turned(node, node) / length(node, node); };
      double least_length = std::numeric_limits<double>::infinity();
      for (int first = 2; first < n - 2; ++first) // at the ends there is nothing to compare with
        for (int last = first; last <= std::min(first + 1, n - 3); ++last)
          if (const double turn = turned(first, last), within = length(first, last);
              turn > least && turn / within > 3 * std::max(curvature(first - 1), curvature(last + 1)))
            least_length = std::min(least_length, within);
      return least_length;
    }
  } // namespace

  Topography::Topography(std::string name, std::vector<double> roll, std::vector<double> z,
                         Eigen::MatrixXd removed, const double base_radius)
      : name_(std::move(name))
      , roll_(std::move(roll))
      , z_(std::move(z))
      , removed_(std::move(removed))
  {
    assert(roll_.size() >= 2 && z_.size() >= 2 &&
           removed_.rows() == static_cast<Eigen::Index>(roll_.size()) &&
           removed_.cols() == static_cast<Eigen::Index>(z_.size()));
    std::vector<double> along; // the profile, of an involute from its base circle
    for (const double angle : roll_)
      along.push_back(base_radius * angle * angle / 2);
    for (const auto &column : removed_.colwise())
      turn_.along_profile = std::min(turn_.along_profile, sudden_turn(along, column));
    for (const auto &row : removed_.rowwise())
      turn_.along_face = std::min(turn_.along_face, sudden_turn(z_, row));
  }

  double Topography::removed(const double roll, const double z) const
  {
    const Stencil a = stencil_at(roll_, roll), b = stencil_at(z_, z);
    double sum = 0;
    for (int i = 0; i < std::min<int>(4, static_cast<int>(roll_.size())); ++i)
      for (int j = 0; j < std::min<int>(4, static_cast<int>(z_.size())); ++j)
        sum += a.weight[i] * b.weight[j] * removed_(a.first + i, b.first + j);
    return sum;
  }

  std::string Topography::describe(const double) const
  {
    return fmt::format("topography {}: {} roll angles from {:.4f} to {:.4f} deg by {} face positions from "
                       "{:.3f} to {:.3f} mm, {:.3f} to "
                       "{:.3f} um removed",
                       name_, roll_.size(), roll_.front() / units::degree, roll_.back() / units::degree,
                       z_.size(), z_.front(), z_.back(), removed_.minCoeff() / units::micrometre,
                       removed_.maxCoeff() / units::micrometre);
  }
} // namespace flank
