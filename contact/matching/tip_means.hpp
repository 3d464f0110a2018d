// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/flanks/patch.hpp"
#include "contact/matching/flank_edges.hpp"
#include "contact/matching/piecewise_polynomial.hpp"
#include "contact/wedge/strip_means.hpp"

#include <array>
#include <map>
#include <vector>

namespace flank
{
  /// Means over strips beside a tip edge, by their distances from it: a spur gear's slices have the same
  /// ones. For one thread.
  using TipStrips = std::map<std::array<double, 4>, wedge::StripMeans>;

  /// What a free tip edge adds to the mean displacements between the patches of two groups, in either
  /// direction: it is symmetric. Two slices that keep farther from the edge, or from each other, than they
  /// reach along the profile are tabulated over the distances of both from the edge. Worked out where it is
  /// asked for, once. For one thread.
  class TipMeans
  {
  public:
    /// All are kept by reference.
    TipMeans(const FlankEdges &edges, const InvoluteHelicoid &flank, const std::vector<Patch> &first,
             const std::vector<Patch> &second, TipStrips &strips)
        : edges_(edges)
        , flank_(flank)
        , first_(first)
        , second_(second)
        , strips_(strips)
    {
    }

    /// The mean displacement of one of these patches under a unit force on the other, by their numbers in
    /// their groups, times Young's modulus. [1/mm]
    double between(std::size_t first, std::size_t second);

  private:
    /// A group's whole patches, where they lie one above the other along the profile.
    struct Slice
    {
      explicit Slice(const FlankEdges &edges, const std::vector<Patch> &patches);
      bool is_slice = false;                          ///< they do
      std::size_t lowest = 0, highest = 0, whole = 0; ///< nearest to the edge, farthest, how many
      double low = 0, high = 0, longest = 0; ///< middles of these, greatest length square to the edge [mm]
      double length() const { return high - low; }
    };

    /// A patch that counts as a rectangle along the edge.
    struct Rectangle
    {
      Patch patch;
      wedge::Strip strip; ///< square to the edge
      double half;        ///< half of the length along it [mm]
    };

    /// A patch as one rectangle, and, for what is near, as two halves of its generator where that comes
    /// nearer to the edge by half of its distance.
    struct AlongEdge
    {
      Rectangle whole;
      std::vector<Rectangle> halves;
      double nearer; ///< by half of the generator [mm]
    };

    struct Pair
    {
      const Rectangle &one, &other;
      double along, apart; ///< of both middles; at least, along the edge and over it [mm]
      bool are_lines;      ///< that far apart
    };

    double along(const Patch &one, const Patch &other) const;
    Rectangle rectangle(const Patch &patch) const;
    std::vector<AlongEdge> along_the_edge(const std::vector<Patch> &patches) const;
    double mean(const AlongEdge &one, const AlongEdge &other) const;
    Pair pair_of(const Rectangle &one, const Rectangle &other) const;
    double of_pair(const Pair &pair) const;
    double of_lines(double along, double one, double other, double half, double other_half) const;
    void tabulate();
    Eigen::MatrixXd weights(const PiecewisePolynomial &table, const std::vector<Patch> &patches) const;

    const FlankEdges &edges_;
    const InvoluteHelicoid &flank_;
    const std::vector<Patch> &first_, &second_;
    TipStrips &strips_;
    bool is_asked_ = false;
    std::vector<AlongEdge> of_first_, of_second_; ///< once it is
    Eigen::MatrixXd known_;                       ///< not a number: not asked for yet
  };
} // namespace flank
