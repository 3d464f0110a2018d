// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/matching/tip_means.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace flank
{
  namespace
  {
    bool is_whole(const Patch &patch)
    {
      return patch.outline.size() == 4;
    }

    /// Distances from the edge's point beside a place and along the edge, over which strips are lines: 1 / r
    /// over an eighth of r is its value in the middle within 3e-3. Bounds that cells of a grid do not meet.
    constexpr double beside_lines = 8.1;
  } // namespace

  TipMeans::Slice::Slice(const FlankEdges &edges, const std::vector<Patch> &patches)
  {
    low = std::numeric_limits<double>::max(), high = -low;
    double least_z = low, greatest_z = high;
    for (std::size_t i = 0; i < patches.size(); ++i)
      if (is_whole(patches[i]))
        {
          const wedge::Strip strip = edges.strip(FlankEdge::tip, patches[i]);
          ++whole;
          longest = std::max(longest, strip.length());
          least_z = std::min(least_z, patches[i].z), greatest_z = std::max(greatest_z, patches[i].z);
          if (strip.middle() < low)
            low = strip.middle(), lowest = i;
          if (strip.middle() > high)
            high = strip.middle(), highest = i;
        }
    is_slice = greatest_z - least_z < 0.1 * patches[lowest].half_generator && high > low;
  }

  double TipMeans::along(const Patch &one, const Patch &other) const
  {
    // As both see it: on a curved flank these differ in second order, and the mean must not depend on which
    // of both comes first.
    return edges_.along(FlankEdge::tip, 0.5 * (other.seen_from(one, flank_) - one.seen_from(other, flank_)));
  }

  TipMeans::Rectangle TipMeans::rectangle(const Patch &patch) const
  {
    return { patch, edges_.strip(FlankEdge::tip, patch), edges_.half_along(FlankEdge::tip, patch) };
  }

  std::vector<TipMeans::AlongEdge> TipMeans::along_the_edge(const std::vector<Patch> &patches) const
  {
    std::vector<AlongEdge> result;
    for (const Patch &patch : patches)
      {
        AlongEdge &along =
            result.emplace_back(AlongEdge{ rectangle(patch), {}, edges_.nearer_along(patch.half_generator) });
        if (along.nearer > 0.5 * along.whole.strip.middle())
          for (const int side : { -1, 1 })
            {
              const double y = 0.5 * side * patch.half_generator;
              Patch half = patch;
              half.roll = patch.roll + y * flank_.roll_per_generator();
              half.z = patch.z + y * flank_.cos_base_helix();
              half.half_generator = patch.half_generator / 2;
              along.halves.push_back(rectangle(half));
            }
        else
          along.halves.push_back(along.whole);
      }
    return result;
  }

  /// Of lines along the edge of these half-lengths, at these distances from it.
  double TipMeans::of_lines(const double along, const double one, const double other, const double half,
                            const double other_half) const
  {
    const wedge::FaceTable &face = edges_.face(FlankEdge::tip);
    const double x = std::abs(along), both = one + other, most = half + other_half,
                 variance = (half * half + other_half * other_half) / 3, r2 = x * x + both * both;
    if (r2 > 4.1 * 4.1 * most * most) // as of 1 / r, to the second moment of both lengths
      return face.at(x, one, other) * (1 + 0.5 * variance * (2 * x * x - both * both) / (r2 * r2));
    const auto [near, far] = std::minmax(one, other); // the same in either order
    return wedge::StripMeans(face, { near, near }, { far, far }, true).mean(x, half, other_half);
  }

  double TipMeans::mean(const AlongEdge &one, const AlongEdge &other) const
  {
    const double beside = beside_lines * std::max(one.nearer, other.nearer);
    if (const Pair pair = pair_of(one.whole, other.whole); pair.apart > beside && pair.are_lines)
      return of_pair(pair);
    double sum = 0;
    for (const Rectangle &half : one.halves)
      for (const Rectangle &other_half : other.halves)
        sum += of_pair(pair_of(half, other_half));
    return sum / static_cast<double>(one.halves.size() * other.halves.size());
  }

  TipMeans::Pair TipMeans::pair_of(const Rectangle &one, const Rectangle &other) const
  {
    const double x = along(one.patch, other.patch),
                 apart = std::hypot(std::max(0.0, std::abs(x) - one.half - other.half),
                                    one.strip.low + other.strip.low);
    return { one, other, x, apart,
             apart > beside_lines * std::max(one.strip.length(), other.strip.length()) };
  }

  double TipMeans::of_pair(const Pair &pair) const
  {
    const auto &[one, other, x, apart, are_lines] = pair;
    if (are_lines)
      return of_lines(x, one.strip.middle(), other.strip.middle(), one.half, other.half);
    const bool in_order =
        std::pair(one.strip.low, one.strip.high) < std::pair(other.strip.low, other.strip.high);
    const wedge::Strip &near = in_order ? one.strip : other.strip, &far = in_order ? other.strip : one.strip;
    return strips_
        .try_emplace({ near.low, near.high, far.low, far.high }, edges_.face(FlankEdge::tip), near, far)
        .first->second.mean(x, one.half, other.half);
  }

  /// Polynomials through four points leave 1e-3 where slices are as far from the edge, or apart, as they
  /// reach along the profile, less beyond.
  void TipMeans::tabulate()
  {
    constexpr int points = 4;
    const Slice one(edges_, first_), other(edges_, second_);
    if (!one.is_slice || !other.is_slice || std::min(one.whole, other.whole) < points + 2)
      return;
    const double x = along(first_[one.lowest], second_[other.lowest]),
                 by_one = along(first_[one.highest], second_[other.lowest]) - x,
                 by_other = along(first_[one.lowest], second_[other.highest]) - x,
                 half = edges_.half_along(FlankEdge::tip, first_[one.lowest]),
                 other_half = edges_.half_along(FlankEdge::tip, second_[other.lowest]),
                 least = std::abs(x) - std::abs(by_one) - std::abs(by_other) - half - other_half,
                 apart = std::hypot(std::max(0.0, least), one.low + other.low);
    if (apart < std::max(one.length(), other.length()) ||
        apart < beside_lines * std::max(one.longest, other.longest))
      return;
    const PiecewisePolynomial of_first({ one.low, one.high }, points),
        of_second({ other.low, other.high }, points);
    Eigen::MatrixXd value(points, points);
    for (int i = 0; i < points; ++i)
      for (int j = 0; j < points; ++j)
        {
          const double s = of_first.abscissa(i), d = of_second.abscissa(j);
          value(i, j) = of_lines(x + by_one * (s - one.low) / one.length() +
                                     by_other * (d - other.low) / other.length(),
                                 s, d, half, other_half);
        }
    known_ = weights(of_first, first_) * value * weights(of_second, second_).transpose();
  }

  /// Of the values of a table on the patches, a row each; no numbers for those that are not whole.
  Eigen::MatrixXd TipMeans::weights(const PiecewisePolynomial &table, const std::vector<Patch> &patches) const
  {
    Eigen::MatrixXd result(static_cast<Eigen::Index>(patches.size()), table.size());
    std::array<double, PiecewisePolynomial::max_points> of_patch{};
    for (std::size_t k = 0; k < patches.size(); ++k)
      {
        int first = 0;
        table.weights(edges_.strip(FlankEdge::tip, patches[k]).middle(), first, of_patch);
        for (Eigen::Index i = 0; i < result.cols(); ++i)
          result(static_cast<Eigen::Index>(k), i) = is_whole(patches[k])
                                                        ? of_patch[static_cast<std::size_t>(i)]
                                                        : std::numeric_limits<double>::quiet_NaN();
      }
    return result;
  }

  double TipMeans::between(const std::size_t first, const std::size_t second)
  {
    const auto place = [](const std::size_t k) { return static_cast<Eigen::Index>(k); };
    if (!is_asked_)
      {
        is_asked_ = true;
        of_first_ = along_the_edge(first_), of_second_ = along_the_edge(second_);
        known_.setConstant(place(first_.size()), place(second_.size()),
                           std::numeric_limits<double>::quiet_NaN());
        tabulate();
      }
    double &known = known_(place(first), place(second));
    if (!std::isnan(known))
      return known;
    known = mean(of_first_[first], of_second_[second]);
    if (&first_ == &second_)
      known_(place(second), place(first)) = known;
    return known;
  }
} // namespace flank
