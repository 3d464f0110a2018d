// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/matching/end_means.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace flank
{
  EndMeans::Strips EndMeans::strips_of(const FlankEdges &edges, const FlankEdge edge,
                                       const std::vector<Patch> &patches)
  {
    Strips result;
    for (const Patch &patch : patches)
      {
        const wedge::Strip strip = edges.strip(edge, patch);
        const auto found =
            std::find(result.strip.rbegin(), result.strip.rend(), strip); // mostly the last one
        result.of_patch.push_back(static_cast<std::size_t>(result.strip.rend() - found) - 1);
        if (found == result.strip.rend())
          {
            result.of_patch.back() = result.strip.size();
            result.strip.push_back(strip);
          }
      }
    return result;
  }

  EndMeans::AtEnd &EndMeans::at(const FlankEdge edge)
  {
    auto &at_end = at_[static_cast<std::size_t>(edge)];
    if (!at_end)
      {
        at_end.emplace(AtEnd{ strips_of(edges_, edge, first_), strips_of(edges_, edge, second_), {}, {} });
        at_end->means.resize(at_end->of_first.strip.size() * at_end->of_second.strip.size());
        at_end->known.setConstant(static_cast<Eigen::Index>(first_.size()),
                                  static_cast<Eigen::Index>(second_.size()),
                                  std::numeric_limits<double>::quiet_NaN());
      }
    return *at_end;
  }

  namespace
  {
    bool is_cut(const Patch &patch)
    {
      return patch.outline.size() != 4;
    }

    bool nearer_to_edge(const wedge::Strip &one, const wedge::Strip &other)
    {
      return std::pair(one.low, one.high) < std::pair(other.low, other.high);
    }
  } // namespace

  double EndMeans::mean(const FlankEdge edge, AtEnd &here, const std::size_t first,
                        const std::size_t second) const
  {
    const Patch &one = first_[first], &other = second_[second];
    // As both see it: on a curved flank these differ in second order, and the mean must not depend on which
    // of both comes first.
    const double along = 0.5 * (other.seen_from(one, flank_).x() - one.seen_from(other, flank_).x());
    const std::size_t of_one = here.of_first.of_patch[first], of_other = here.of_second.of_patch[second];
    const wedge::Strip &strip = here.of_first.strip[of_one], &other_strip = here.of_second.strip[of_other];
    // Patches cut by the flank's tip have strips of their own, which are not worth a table. The mean of
    // 1 / (s + d) over strips of an eighth of s + d is its value in the middle within 3e-3, and this mean is
    // by then some hundredths of what a patch yields under its own load.
    if ((is_cut(one) || is_cut(other)) &&
        strip.low + other_strip.low >
            8.1 * std::max({ strip.length(), other_strip.length(), one.half_profile, other.half_profile }))
      return edges_.face(edge).at(along, strip.middle(), other_strip.middle());
    auto &means = here.means[of_one * here.of_second.strip.size() + of_other];
    if (!means)
      {
        const auto [near, far] = std::minmax(strip, other_strip, nearer_to_edge); // the same in either order
        means.emplace(edges_.face(edge), near, far);
      }
    return means->mean(along, one.half_profile, other.half_profile);
  }

  double EndMeans::between(const FlankEdge edge, const std::size_t first, const std::size_t second)
  {
    AtEnd &here = at(edge);
    double &known = here.known(static_cast<Eigen::Index>(first), static_cast<Eigen::Index>(second));
    if (std::isnan(known))
      {
        known = mean(edge, here, first, second);
        if (&first_ == &second_)
          here.known(static_cast<Eigen::Index>(second), static_cast<Eigen::Index>(first)) = known;
      }
    return known;
  }
} // namespace flank
