// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/flanks/mesh_position.hpp"
#include "contact/matching/body_compliance.hpp"

#include <deque>

namespace flank
{
  /// The compliance between the cells of one mesh position [mm/N], kept by the windows of their slices.
  /// Windows change in steps, so that the position's grids for other torques, flank modifications or mesh
  /// cycles find here what an earlier grid needed. What is kept is bounded: beyond some grids' worth it is
  /// forgotten and computed again. For one thread.
  class PositionCompliance
  {
  public:
    /// Which mesh position it belongs to is told by the cells given to assemble(), which must all be of one.
    /// The bodies are kept by reference.
    PositionCompliance(const BodyCompliance &pinion, const BodyCompliance &gear,
                       const InvoluteHelicoid &pinion_flank);

    /// Where the cells of a slice lie: slices with equal windows have the same cells. PositionGrid chooses
    /// the steps.
    struct Window
    {
      int slice;  ///< number of the slice among all of the position
      int centre; ///< middle of the window along the profile, in steps
      int width;  ///< logarithm of the window's half-width, in steps
      int cells;  ///< number of cells across the profile

      auto operator<=>(const Window &) const = default;
    };

    /// The symmetric compliance of a grid, whose cells stand slice by slice; windows[slice of a cell].
    /// Returns the greatest difference between an entry and its mirror image before, over the greatest entry.
    double assemble(const std::vector<ContactCell> &cells, const std::vector<Window> &windows,
                    Eigen::MatrixXd &c);

  private:
    struct Group
    {
      PatchGroup pinion, gear;
    };
    struct Block
    {
      Eigen::MatrixXd c; ///< symmetrised; rows: the column's group
      double difference = 0, greatest = 0;
    };
    struct Part
    {
      Eigen::Index first; ///< cell
      int group;
    };
    std::vector<Part> parts_of(const std::vector<ContactCell> &cells, const std::vector<Window> &windows);
    int group(const std::vector<Window> &windows, const ContactCell *cells, std::size_t count);
    void couple(int column, const std::vector<int> &rows); ///< groups of one tooth
    void forget();

    const BodyCompliance &pinion_, &gear_;
    TipStrips pinion_strips_, gear_strips_;
    InvoluteHelicoid flank_;
    std::map<std::vector<Window>, int> numbers_;
    std::vector<std::unique_ptr<Group>> groups_;
    std::deque<Block> blocks_;
    std::vector<std::vector<int>>
        place_;               ///< of a block, by the groups of its column and row; -1: not there yet
    std::size_t entries_ = 0; ///< of all blocks
  };
} // namespace flank
