// SPDX-License-Identifier: GPL-2.0-or-later
#include "cases/parallel_axis/position_compliance.hpp"

#include <algorithm>

namespace flank
{
  PositionCompliance::PositionCompliance(const BodyCompliance &pinion, const BodyCompliance &gear, const InvoluteHelicoid &pinion_flank)
      : pinion_(pinion)
      , gear_(gear)
      , flank_(pinion_flank)
  {
  }

  int PositionCompliance::group(const Window &window, const ContactCell *cells, const std::size_t count)
  {
    const auto [it, is_new] = numbers_.try_emplace(window, static_cast<int>(groups_.size()));
    if (is_new)
      {
        std::vector<Patch> pinion, gear;
        for (std::size_t k = 0; k < count; ++k)
          {
            pinion.push_back(cells[k].pinion);
            gear.push_back(cells[k].gear);
          }
        groups_.push_back(std::make_unique<Group>(Group{ pinion_.group(std::move(pinion)), gear_.group(std::move(gear)) }));
      }
    return it->second;
  }

  const PositionCompliance::Block &PositionCompliance::block(const int first, const int second)
  {
    if (static_cast<int>(place_.size()) <= first)
      place_.resize(first + 1);
    std::vector<int> &row = place_[first];
    if (static_cast<int>(row.size()) <= second)
      row.resize(groups_.size(), -1);
    if (row[second] < 0)
      {
        row[second]  = static_cast<int>(blocks_.size());
        Block &block = blocks_.emplace_back();
        Group &a = *groups_[first], &b = *groups_[second];
        block.c.setZero(static_cast<Eigen::Index>(a.pinion.patches.size()), static_cast<Eigen::Index>(b.pinion.patches.size()));
        pinion_.add_far(a.pinion, b.pinion, block.c);
        gear_.add_far(a.gear, b.gear, block.c);
        if (pinion_.is_near(a.pinion, b.pinion) || gear_.is_near(a.gear, b.gear))
          {
            // Both half-spaces carry the same rectangles: one set of potentials, along the pinion's flank.
            PatchPotentials potentials(a.pinion.patches, b.pinion.patches, flank_);
            const auto      forth = [&](const std::size_t i, const std::size_t j) { return potentials(i, j); };
            const auto      back  = [&](const std::size_t i, const std::size_t j) { return potentials(j, i); };
            Eigen::MatrixXd there = Eigen::MatrixXd::Zero(block.c.rows(), block.c.cols()),
                            here  = Eigen::MatrixXd::Zero(block.c.cols(), block.c.rows());
            pinion_.add_near(a.pinion, b.pinion, forth, there);
            pinion_.add_near(b.pinion, a.pinion, back, here);
            gear_.add_near(a.gear, b.gear, forth, there);
            gear_.add_near(b.gear, a.gear, back, here);
            block.difference = (there - here.transpose()).cwiseAbs().maxCoeff();
            block.c += 0.5 * (there + here.transpose());
          }
        block.greatest = block.c.cwiseAbs().maxCoeff();
      }
    return blocks_[row[second]];
  }

  double PositionCompliance::assemble(const std::vector<ContactCell> &cells, const std::vector<Window> &windows, Eigen::MatrixXd &c)
  {
    struct Part
    {
      Eigen::Index first;
      int          group;
    };
    std::vector<Part> parts;
    for (std::size_t i = 0; i < cells.size();)
      {
        std::size_t end = i + 1;
        while (end < cells.size() && cells[end].slice == cells[i].slice)
          ++end;
        parts.push_back({ static_cast<Eigen::Index>(i), group(windows[cells[i].slice], &cells[i], end - i) });
        i = end;
      }
    const auto n = static_cast<Eigen::Index>(cells.size());
    c.resize(n, n);
    double difference = 0, greatest = 0;
    for (const Part &column : parts)
      for (const Part &row : parts)
        {
          if (row.first > column.first)
            break;
          const Block &b                                           = block(row.group, column.group);
          c.block(row.first, column.first, b.c.rows(), b.c.cols()) = b.c;
          c.block(column.first, row.first, b.c.cols(), b.c.rows()) = b.c.transpose();
          difference                                               = std::max(difference, b.difference);
          greatest                                                 = std::max(greatest, b.greatest);
        }
    return greatest > 0 ? difference / greatest : 0;
  }
} // namespace flank
