// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/flanks/patch.hpp"
#include "solver/elements/flank_surface.hpp"

#include <span>
#include <vector>

namespace flank
{
  /// Some patches as the flank's elements see them: the consistent nodal forces f_j of a unit force spread
  /// evenly over each, which is also the functional N_i that reads its mean displacement. Every patch is
  /// clipped to each element and integrated there: exact for the elements' shape functions. The weights of
  /// all patches stand one after the other in memory, because they are read most.
  class PatchWeights
  {
  public:
    PatchWeights(const FlankSurface &surface, const std::vector<Patch> &patches);

    std::size_t size() const { return extent_.size(); }
    std::span<const int> nodes(const std::size_t patch) const
    {
      return { &node_[begin_[patch]], begin_[patch + 1] - begin_[patch] };
    }
    std::span<const double> values(const std::size_t patch) const
    {
      return { &value_[begin_[patch]], begin_[patch + 1] - begin_[patch] };
    }

    /// The rectangle that a patch lies in: rows and layers of elements of the flank's surface. [element
    /// coordinates]
    struct Extent
    {
      double row_low, row_high, layer_low, layer_high;
    };
    const Extent &extent(const std::size_t patch) const { return extent_[patch]; }

  private:
    std::vector<Extent> extent_;
    std::vector<std::size_t> begin_;
    std::vector<int> node_;     ///< by FlankSurface::node()
    std::vector<double> value_; ///< of a patch they sum to 1
  };
} // namespace flank
