// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/matching/tip_means.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

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

  /// A patch, in two halves of its generator where that comes nearer to the edge by half of its distance.
  std::vector<Patch> TipMeans::along_the_edge(const Patch &patch) const
  {
    const wedge::Strip strip = edges_.strip(FlankEdge::tip, patch);
    if (edges_.nearer_along(patch.half_generator) <= 0.5 * strip.middle())
      return { patch };
    std::vector<Patch> halves(2, patch);
    for (const int side : { 0, 1 })
      {
        const double y = (side - 0.5) * patch.half_generator;
        halves[side].roll = patch.roll + y * flank_.roll_per_generator();
        halves[side].z = patch.z + y * flank_.cos_base_helix();
        halves[side].half_generator = patch.half_generator / 2;
      }
    return halves;
  }

  /// Of lines along the edge of these half-lengths, at these distances from it.
  double TipMeans::of_lines(const double along, const double one, const double other, const double half,
                            const double other_half) const
  {
    const wedge::FaceTable &face = edges_.face(FlankEdge::tip);
    const double x = std::abs(along), most = half + other_half;
    if (x > 2.1 * most || one + other > 4.1 * most)
      { // As the second moment of both lengths says.
        const double aside = std::sqrt((half * half + other_half * other_half) / 3);
        return 0.5 * (face.at(x - aside, one, other) + face.at(x + aside, one, other));
      }
    const auto [near, far] = std::minmax(one, other); // the same in either order
    return wedge::StripMeans(face, { near, near }, { far, far }, true).mean(x, half, other_half);
  }

  double TipMeans::mean(const Patch &one, const Patch &other) const
  {
    double sum = 0;
    const std::vector<Patch> parts = along_the_edge(one), other_parts = along_the_edge(other);
    for (const Patch &part : parts)
      for (const Patch &other_part : other_parts)
        sum += of_rectangles(part, other_part);
    return sum / static_cast<double>(parts.size() * other_parts.size());
  }

  /// The mean of two patches that count as rectangles along the edge.
  double TipMeans::of_rectangles(const Patch &one, const Patch &other) const
  {
    const double x = along(one, other), half = edges_.half_along(FlankEdge::tip, one),
                 other_half = edges_.half_along(FlankEdge::tip, other);
    const wedge::Strip strip = edges_.strip(FlankEdge::tip, one),
                       other_strip = edges_.strip(FlankEdge::tip, other);
    if (std::hypot(std::max(0.0, std::abs(x) - half - other_half), strip.low + other_strip.low) >
        beside_lines * std::max(strip.length(), other_strip.length()))
      return of_lines(x, strip.middle(), other_strip.middle(), half, other_half);
    const auto &[near, far] = std::pair(strip.low, strip.high) < std::pair(other_strip.low, other_strip.high)
                                  ? std::tie(strip, other_strip)
                                  : std::tie(other_strip, strip);
    return strips_
        .try_emplace({ near.low, near.high, far.low, far.high }, edges_.face(FlankEdge::tip), near, far)
        .first->second.mean(x, half, other_half);
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
        known_.setConstant(place(first_.size()), place(second_.size()),
                           std::numeric_limits<double>::quiet_NaN());
        tabulate();
      }
    double &known = known_(place(first), place(second));
    if (!std::isnan(known))
      return known;
    known = mean(first_[first], second_[second]);
    if (&first_ == &second_)
      known_(place(second), place(first)) = known;
    return known;
  }
} // namespace flank
