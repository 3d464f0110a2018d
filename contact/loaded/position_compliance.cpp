// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/loaded/position_compliance.hpp"

#include <algorithm>
#include <utility>

namespace flank
{
  PositionCompliance::PositionCompliance(const BodyCompliance &pinion, const BodyCompliance &gear,
                                         const InvoluteHelicoid &pinion_flank)
      : pinion_(pinion)
      , gear_(gear)
      , flank_(pinion_flank)
  {
  }

  int PositionCompliance::group(const std::vector<Window> &windows, const ContactCell *cells,
                                const std::size_t count)
  {
    const auto [it, is_new] = numbers_.try_emplace(windows, static_cast<int>(groups_.size()));
    if (is_new)
      {
        std::vector<Patch> pinion, gear;
        for (std::size_t k = 0; k < count; ++k)
          {
            pinion.push_back(cells[k].pinion);
            gear.push_back(cells[k].gear);
          }
        groups_.push_back(
            std::make_unique<Group>(Group{ pinion_.group(std::move(pinion)), gear_.group(std::move(gear)) }));
        place_.emplace_back();
      }
    return it->second;
  }

  void PositionCompliance::couple(const int column, const std::vector<int> &rows)
  {
    const Group &loads = *groups_[column];
    std::vector<const PatchGroup *> pinion, gear;
    std::vector<Eigen::MatrixXd *> c;
    place_[column].resize(groups_.size(), -1);
    for (const int row : rows)
      {
        place_[column][row] = static_cast<int>(blocks_.size());
        pinion.push_back(&groups_[row]->pinion);
        gear.push_back(&groups_[row]->gear);
        Block &block = blocks_.emplace_back();
        block.c.setZero(static_cast<Eigen::Index>(loads.pinion.patches.size()),
                        static_cast<Eigen::Index>(pinion.back()->patches.size()));
        entries_ += static_cast<std::size_t>(block.c.size());
        c.push_back(&block.c);
      }
    pinion_.add_far(loads.pinion, pinion, c);
    gear_.add_far(loads.gear, gear, c);
    for (const int row : rows)
      {
        const Group &outputs = *groups_[row];
        Block &block = blocks_[place_[column][row]];
        if (pinion_.is_near(outputs.pinion, loads.pinion) || gear_.is_near(outputs.gear, loads.gear))
          {
            // Both half-spaces carry the same rectangles: one set of potentials, along the pinion's flank.
            const Eigen::MatrixXd potential =
                patch_potentials(outputs.pinion.patches, loads.pinion.patches, flank_);
            Eigen::MatrixXd forth = Eigen::MatrixXd::Zero(block.c.cols(), block.c.rows()),
                            back = Eigen::MatrixXd::Zero(block.c.rows(), block.c.cols());
            const bool own = row == column; // then both ways are the same
            pinion_.add_near(outputs.pinion, loads.pinion, potential, forth, own ? nullptr : &back,
                             pinion_strips_);
            gear_.add_near(outputs.gear, loads.gear, potential, forth, own ? nullptr : &back, gear_strips_);
            const Eigen::MatrixXd &other = own ? forth : back;
            block.difference = (forth.transpose() - other).cwiseAbs().maxCoeff();
            block.c += 0.5 * (forth.transpose() + other);
          }
        block.greatest = block.c.cwiseAbs().maxCoeff();
      }
  }

  void PositionCompliance::forget()
  {
    numbers_.clear();
    groups_.clear();
    blocks_.clear();
    place_.clear();
    entries_ = 0;
    pinion_strips_.clear();
    gear_strips_.clear();
  }

  /// Slices of one tooth, until there are as many cells as are worked on at once.
  std::vector<PositionCompliance::Part> PositionCompliance::parts_of(const std::vector<ContactCell> &cells,
                                                                     const std::vector<Window> &windows)
  {
    std::vector<Part> parts;
    for (std::size_t i = 0; i < cells.size();)
      {
        std::vector<Window> of_part;
        std::size_t end = i;
        while (end < cells.size() && cells[end].pinion.tooth == cells[i].pinion.tooth)
          {
            const int slice = cells[end].slice;
            std::size_t next = end;
            while (next < cells.size() && cells[next].slice == slice)
              ++next;
            if (end > i && next - i > LoadResponses::width)
              break;
            of_part.push_back(windows[slice]);
            end = next;
          }
        parts.push_back({ static_cast<Eigen::Index>(i), group(of_part, &cells[i], end - i) });
        i = end;
      }
    return parts;
  }

  double PositionCompliance::assemble(const std::vector<ContactCell> &cells,
                                      const std::vector<Window> &windows, Eigen::MatrixXd &c)
  {
    // A grid's blocks are half of its matrix.
    constexpr std::size_t grids_kept = 8, always_kept = 8u << 20;
    if (entries_ > std::max(always_kept, grids_kept * cells.size() * cells.size() / 2))
      forget();
    const std::vector<Part> parts = parts_of(cells, windows);
    const auto n = static_cast<Eigen::Index>(cells.size());
    // A failed Eigen resize leaves a pointer to memory given back: a matrix of its own takes the place.
    if (c.rows() != n || c.cols() != n)
      c = Eigen::MatrixXd(n, n);
    double difference = 0, greatest = 0;
    for (const Part &column : parts)
      {
        std::vector<int> missing;
        const auto &known = place_[column.group];
        for (const Part *row = parts.data(); row <= &column; ++row)
          {
            const bool is_new_tooth = !missing.empty() && groups_[missing.front()]->pinion.tooth !=
                                                              groups_[row->group]->pinion.tooth;
            if (is_new_tooth)
              couple(column.group, std::exchange(missing, {}));
            if (row->group >= static_cast<int>(known.size()) || known[row->group] < 0)
              missing.push_back(row->group);
          }
        if (!missing.empty())
          couple(column.group, missing);
      }
    // Some columns from top to bottom before the next: they stay in the processor's nearest memories.
    for (const Part &column : parts)
      for (const Part &row : parts)
        if (&row >= &column)
          {
            const Block &b = blocks_[place_[row.group][column.group]];
            c.block(row.first, column.first, b.c.rows(), b.c.cols()) = b.c;
            difference = std::max(difference, b.difference);
            greatest = std::max(greatest, b.greatest);
          }
        else
          {
            const Block &b = blocks_[place_[column.group][row.group]];
            c.block(row.first, column.first, b.c.cols(), b.c.rows()) = b.c.transpose();
          }
    return greatest > 0 ? difference / greatest : 0;
  }
} // namespace flank
