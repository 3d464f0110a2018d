// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/flanks/patch.hpp"
#include "contact/matching/flank_edges.hpp"
#include "contact/wedge/strip_means.hpp"

#include <array>
#include <optional>
#include <vector>

namespace flank
{
  /// What the free ends of a flank add to the mean displacements between two groups of patches, in either
  /// direction: it is symmetric. Worked out where it is asked for, once. For one thread.
  class EndMeans
  {
  public:
    /// All are kept by reference.
    EndMeans(const FlankEdges &edges, const InvoluteHelicoid &flank, const std::vector<Patch> &first,
             const std::vector<Patch> &second)
        : edges_(edges)
        , flank_(flank)
        , first_(first)
        , second_(second)
    {
    }

    /// The mean displacement of one of these patches under a unit force on the other, by their numbers in
    /// their groups, times Young's modulus. `edge`: one of the ends. [1/mm]
    double between(FlankEdge edge, std::size_t first, std::size_t second);

  private:
    /// The cells of two slices lie on the same two strips.
    struct Strips
    {
      std::vector<wedge::Strip> strip;   ///< different ones
      std::vector<std::size_t> of_patch; ///< numbers of them
    };
    struct AtEnd
    {
      Strips of_first, of_second;
      std::vector<std::optional<wedge::StripMeans>> means; ///< of two strips; none: not asked for yet
      Eigen::MatrixXd known;                               ///< not a number: not asked for yet
    };
    AtEnd &at(FlankEdge edge);
    double mean(FlankEdge edge, AtEnd &here, std::size_t first, std::size_t second) const;
    static Strips strips_of(const FlankEdges &edges, FlankEdge edge, const std::vector<Patch> &patches);

    const FlankEdges &edges_;
    const InvoluteHelicoid &flank_;
    const std::vector<Patch> &first_, &second_;
    std::array<std::optional<AtEnd>, 2> at_;
  };
} // namespace flank
