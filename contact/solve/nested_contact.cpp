// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/solve/nested_contact.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <span>
#include <utility>

namespace flank
{
  namespace
  {
    constexpr int pivoting_cap = 30;
  } // namespace

  double entry_torque(const double torque, const double force, const double force_by_torque)
  {
    return force_by_torque > 0 ? torque - force / (2 * force_by_torque) : 0;
  }

  struct NestedContact::Rim
  {
    Eigen::Index core;                ///< cells eliminated
    std::vector<Eigen::Index> places; ///< of the rim's cells in cells_, ascending
    Eigen::MatrixXd compliance;       ///< S
    Eigen::VectorXd lever, gap;       ///< l', g'
    double core_stiffness,
        core_preload; ///< the core's torque: theta core_stiffness - core_preload, and what the rim adds
    Eigen::VectorXd force, force_by_torque; ///< once solved
  };

  NestedContact::NestedContact(const Equilibrated &problem)
      : problem_(problem)
  {
    assert(problem.symmetric);
  }

  bool NestedContact::append(ExpectedContact added)
  {
    const auto m = static_cast<Eigen::Index>(cells_.size()),
               n = static_cast<Eigen::Index>(added.cells.size()), all = m + n;
    std::vector<int> order(added.cells.size());
    std::iota(order.begin(), order.end(), 0);
    const auto key = [&](const int i) { return std::pair(added.entry[i], added.cells[i]); };
    std::sort(order.begin(), order.end(), [&](const int a, const int b) { return key(a) < key(b); });
    for (const int i : order)
      {
        cells_.push_back(added.cells[i]);
        entry_.push_back(added.entry[i]);
      }
    solved_ = 0;
    if (factor_.rows() < all)
      {
        Eigen::MatrixXd larger(all + all / 4, all + all / 4);
        larger.topLeftCorner(m, m).triangularView<Eigen::Lower>() = factor_.topLeftCorner(m, m);
        factor_.swap(larger);
      }
    const Eigen::VectorXd scale = problem_.scale(cells_);
    for (Eigen::Index j = 0; j < all; ++j)
      {
        const auto first = std::max(j, m);
        const std::span behind = std::span(cells_).subspan(first);
        factor_.col(j).segment(first, all - first) =
            scale[j] * problem_.compliance->col(cells_[j])(behind).cwiseProduct(scale.tail(all - first));
      }
    auto rows = factor_.block(m, 0, n, m), corner = factor_.block(m, m, n, n);
    if (m > 0)
      {
        factor_.topLeftCorner(m, m)
            .transpose()
            .triangularView<Eigen::Upper>()
            .solveInPlace<Eigen::OnTheRight>(rows);
        corner.selfadjointView<Eigen::Lower>().rankUpdate(rows, -1);
      }
    if (!cholesky_in_place(corner))
      return false;
    for (auto [vector, data] : { std::pair(&lever_, &problem_.lever), std::pair(&gap_, &problem_.gap) })
      {
        vector->conservativeResize(all);
        for (Eigen::Index i = m; i < all; ++i)
          (*vector)[i] = (*data)[cells_[i]];
        auto tail = vector->tail(n);
        tail.noalias() -= rows * vector->head(m);
        corner.triangularView<Eigen::Lower>().solveInPlace(tail);
      }
    return true;
  }

  NestedContact::Rim NestedContact::around(const Eigen::Index core, const std::vector<char> &in_rim) const
  {
    Rim rim{};
    const auto m = static_cast<Eigen::Index>(cells_.size()), behind = m - core;
    rim.core = core;
    for (Eigen::Index i = core; i < m; ++i)
      if (in_rim[i])
        rim.places.push_back(i);
    const auto n = static_cast<Eigen::Index>(rim.places.size());
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(n, behind);
    for (Eigen::Index i = 0; i < n; ++i)
      {
        const Eigen::Index length = rim.places[i] - core + 1;
        rows.row(i).head(length) = factor_.row(rim.places[i]).segment(core, length);
      }
    rim.compliance.setZero(n, n);
    if (n > 0)
      rim.compliance.selfadjointView<Eigen::Lower>().rankUpdate(rows);
    rim.lever = rows * lever_.tail(behind);
    rim.gap = rows * gap_.tail(behind);
    rim.core_stiffness = lever_.head(core).squaredNorm();
    rim.core_preload = lever_.head(core).dot(gap_.head(core));
    return rim;
  }

  /// Block pivoting on the rim, from contact.active, which it changes.
  bool NestedContact::pivot(Rim &rim, const double torque, Contact &contact) const
  {
    const auto n = static_cast<Eigen::Index>(rim.places.size());
    std::vector<Eigen::Index> in;
    Eigen::MatrixXd block(n, n);
    Eigen::VectorXd by_lever(n), by_gap(n), w(n);
    for (int round = 0; round < pivoting_cap; ++round)
      {
        in.clear();
        for (Eigen::Index i = 0; i < n; ++i)
          if (contact.active[rim.places[i]])
            in.push_back(i);
        const auto m = static_cast<Eigen::Index>(in.size());
        auto corner = block.topLeftCorner(m, m);
        corner = rim.compliance(in, in);
        if (!cholesky_in_place(corner))
          return false;
        const auto lower = corner.triangularView<Eigen::Lower>();
        const auto upper = corner.transpose().triangularView<Eigen::Upper>();
        auto u = by_lever.head(m), v = by_gap.head(m);
        u = rim.lever(in);
        v = rim.gap(in);
        lower.solveInPlace(u);
        lower.solveInPlace(v);
        contact.stiffness = rim.core_stiffness + u.squaredNorm();
        if (!(contact.stiffness > 0))
          return false;
        contact.theta = (torque + rim.core_preload + u.dot(v)) / contact.stiffness;
        v = contact.theta * u - v;
        upper.solveInPlace(v);
        rim.force.setZero(n);
        rim.force(in) = v;
        w = rim.gap - contact.theta * rim.lever;
        if (n > 0)
          w.noalias() += rim.compliance.selfadjointView<Eigen::Lower>() * rim.force;
        const double allowed = m > 0 ? Equilibrated::rounding * v.cwiseAbs().maxCoeff() : 0;
        int changes = 0;
        for (Eigen::Index i = 0; i < n; ++i)
          {
            char &active = contact.active[rim.places[i]];
            if (active ? rim.force[i] < -allowed
                       : problem_.overlaps(cells_[rim.places[i]], w[i], contact.theta))
              {
                active = !active;
                ++changes;
              }
          }
        contact.pivots += changes;
        if (changes == 0)
          {
            upper.solveInPlace(u);
            rim.force_by_torque.setZero(n);
            rim.force_by_torque(in) = u / contact.stiffness;
            return true;
          }
      }
    return false;
  }

  /// Forces on all cells from those on the rim. `rigid`: L^-1 of what presses on the cells, theta l - g; on
  /// return what the forces do not carry of it: behind the core L^-1 of -w.
  Eigen::VectorXd NestedContact::forces(const Rim &rim, const Eigen::VectorXd &of_rim,
                                        Eigen::VectorXd &rigid) const
  {
    const auto core = rim.core, m = static_cast<Eigen::Index>(cells_.size()), behind = m - core;
    Eigen::VectorXd force = Eigen::VectorXd::Zero(m);
    for (std::size_t i = 0; i < rim.places.size(); ++i)
      force[rim.places[i]] = of_rim[static_cast<Eigen::Index>(i)];
    const auto corner = factor_.block(core, core, behind, behind);
    rigid.head(core).noalias() -= factor_.block(core, 0, behind, core).transpose() * force.tail(behind);
    rigid.tail(behind) -= corner.transpose().triangularView<Eigen::Upper>() * force.tail(behind);
    auto of_core = force.head(core);
    of_core = rigid.head(core);
    factor_.topLeftCorner(core, core).transpose().triangularView<Eigen::Upper>().solveInPlace(of_core);
    return force;
  }

  /// Goes from the expected contact to one that every cell agrees with. The header tells one turn of it,
  /// whose steps share the rim and its forces.
  std::optional<NestedContact::Contact> NestedContact::solve(const double torque)
  {
    const std::size_t m = cells_.size();
    // Share of the torque by which entries may be wrong: half the way from where they were learned, in
    // bounds. Too little costs rounds, too much a larger rim; 0.05 to 0.2 for what is guessed makes no
    // difference in gears.
    const double unsure = solved_ > 0 ? std::clamp(0.5 * std::abs(1 - torque / solved_), 0.01, 0.1) : 0.1;
    std::size_t core = 0;
    while (core < m && entry_[core] < (1 - unsure) * torque)
      ++core;
    Contact contact;
    std::vector<char> in_rim(m);
    contact.active.resize(m);
    for (std::size_t i = 0; i < m; ++i)
      {
        in_rim[i] = i >= core && entry_[i] < (1 + unsure) * torque;
        contact.active[i] = i < core || entry_[i] < torque;
      }
    for (bool looked_at_corner = false;;)
      {
        Rim rim = around(static_cast<Eigen::Index>(core), in_rim);
        if (!pivot(rim, torque, contact))
          return std::nullopt;
        Eigen::VectorXd rigid = contact.theta * lever_ - gap_;
        contact.force = forces(rim, rim.force, rigid);

        const double allowed = m > 0 ? Equilibrated::rounding * contact.force.maxCoeff() : 0;
        std::size_t sure = 0; // cells of the core in front of the first one that pulls
        while (sure < core && contact.force[sure] >= -allowed)
          ++sure;
        const Eigen::Index behind = m - core;
        const Eigen::VectorXd w =
            -(factor_.block(core, core, behind, behind).triangularView<Eigen::Lower>() * rigid.tail(behind));
        bool right = sure == core;
        const auto join = [&](const std::size_t i) {
          in_rim[i] = contact.active[i] = 1;
          right = false;
          ++contact.pivots;
        };
        for (std::size_t i = core; i < m; ++i)
          if (!in_rim[i] && problem_.overlaps(cells_[i], w[i - core], contact.theta))
            join(i);
        // At a corner of theta(T) the stiffness is that above it: cells that just touch are given one chance
        // to carry.
        if (right && !std::exchange(looked_at_corner, true))
          for (std::size_t i = core; i < m; ++i)
            if (!contact.active[i] && problem_.touches(cells_[i], w[i - core], contact.theta))
              join(i);
        if (right)
          {
            rigid = lever_ / contact.stiffness;
            const Eigen::VectorXd force_by_torque = forces(rim, rim.force_by_torque, rigid);
            for (std::size_t i = 0; i < m; ++i)
              entry_[i] = contact.active[i] ? entry_torque(torque, contact.force[i], force_by_torque[i])
                                            : std::max(entry_[i], torque);
            solved_ = torque;
            return contact;
          }
        std::fill(in_rim.begin() + sure, in_rim.begin() + core, 1);
        core = sure;
      }
  }

  ExpectedContact NestedContact::expected(const Contact &last) const
  {
    ExpectedContact result;
    for (std::size_t i = 0; i < cells_.size(); ++i)
      if (last.active[i])
        {
          result.cells.push_back(cells_[i]);
          result.entry.push_back(entry_[i]);
        }
    return result;
  }
} // namespace flank
