// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/solve/nested_contact.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <span>

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
    Eigen::Index              core;               ///< cells eliminated
    std::vector<Eigen::Index> places;             ///< of the rim's cells in cells_, ascending
    Eigen::MatrixXd           compliance;         ///< S
    Eigen::VectorXd           lever, gap;         ///< l', g'
    double          core_stiffness, core_preload; ///< the core's torque: theta core_stiffness - core_preload, and what the rim adds
    Eigen::VectorXd force, force_by_torque;       ///< once solved
  };

  NestedContact::NestedContact(const Equilibrated &problem)
      : problem_(problem)
  {
    assert(problem.symmetric);
  }

  bool NestedContact::append(const std::vector<int> &cells, const std::vector<double> &entry)
  {
    const auto       m = static_cast<Eigen::Index>(cells_.size()), added = static_cast<Eigen::Index>(cells.size()), all = m + added;
    std::vector<int> order(cells.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(),
              [&](const int a, const int b) { return std::pair(entry[a], cells[a]) < std::pair(entry[b], cells[b]); });
    for (const int i : order)
      {
        cells_.push_back(cells[i]);
        entry_.push_back(entry[i]);
      }
    if (m == 0)
      in_order_ = cells_.size();
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
        const auto      first  = std::max(j, m);
        const std::span behind = std::span(cells_).subspan(first);
        factor_.col(j).segment(first, all - first) =
            scale[j] * problem_.compliance->col(cells_[j])(behind).cwiseProduct(scale.tail(all - first));
      }
    auto rows = factor_.block(m, 0, added, m), corner = factor_.block(m, m, added, added);
    if (m > 0)
      {
        factor_.topLeftCorner(m, m).transpose().triangularView<Eigen::Upper>().solveInPlace<Eigen::OnTheRight>(rows);
        corner.selfadjointView<Eigen::Lower>().rankUpdate(rows, -1);
      }
    if (!cholesky_in_place(corner))
      return false;
    for (auto [vector, data] : { std::pair(&lever_, &problem_.lever), std::pair(&gap_, &problem_.gap) })
      {
        vector->conservativeResize(all);
        for (Eigen::Index i = m; i < all; ++i)
          (*vector)[i] = (*data)[cells_[i]];
        auto tail = vector->tail(added);
        tail.noalias() -= rows * vector->head(m);
        corner.triangularView<Eigen::Lower>().solveInPlace(tail);
      }
    return true;
  }

  NestedContact::Rim NestedContact::around(const Eigen::Index core, const std::vector<char> &in_rim) const
  {
    Rim        rim{};
    const auto m = static_cast<Eigen::Index>(cells_.size()), behind = m - core;
    rim.core = core;
    for (Eigen::Index i = core; i < m; ++i)
      if (in_rim[i])
        rim.places.push_back(i);
    const auto      n    = static_cast<Eigen::Index>(rim.places.size());
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(n, behind);
    for (Eigen::Index c = 0, first = 0; c < behind; ++c)
      {
        while (first < n && rim.places[first] < core + c)
          ++first;
        for (Eigen::Index i = first; i < n; ++i)
          rows(i, c) = factor_(rim.places[i], core + c);
      }
    rim.compliance.setZero(n, n);
    rim.compliance.selfadjointView<Eigen::Lower>().rankUpdate(rows);
    rim.lever          = rows * lever_.tail(behind);
    rim.gap            = rows * gap_.tail(behind);
    rim.core_stiffness = lever_.head(core).squaredNorm();
    rim.core_preload   = lever_.head(core).dot(gap_.head(core));
    return rim;
  }

  /// Block pivoting on the rim, from contact.active, which it changes.
  bool NestedContact::pivot(Rim &rim, const double torque, Contact &contact) const
  {
    const auto                n = static_cast<Eigen::Index>(rim.places.size());
    std::vector<Eigen::Index> in;
    Eigen::MatrixXd           block(n, n);
    Eigen::VectorXd           by_lever(n), by_gap(n), w(n);
    for (int round = 0; round < pivoting_cap; ++round)
      {
        in.clear();
        for (Eigen::Index i = 0; i < n; ++i)
          if (contact.active[rim.places[i]])
            in.push_back(i);
        const auto m = static_cast<Eigen::Index>(in.size());
        for (Eigen::Index j = 0; j < m; ++j)
          {
            for (Eigen::Index i = j; i < m; ++i)
              block(i, j) = rim.compliance(in[i], in[j]);
            by_lever[j] = rim.lever[in[j]];
            by_gap[j]   = rim.gap[in[j]];
          }
        auto corner = block.topLeftCorner(m, m);
        if (!cholesky_in_place(corner))
          return false;
        auto u = by_lever.head(m), v = by_gap.head(m);
        corner.triangularView<Eigen::Lower>().solveInPlace(u);
        corner.triangularView<Eigen::Lower>().solveInPlace(v);
        contact.stiffness = rim.core_stiffness + u.squaredNorm();
        if (!(contact.stiffness > 0))
          return false;
        contact.theta = (torque + rim.core_preload + u.dot(v)) / contact.stiffness;
        v             = contact.theta * u - v;
        corner.transpose().triangularView<Eigen::Upper>().solveInPlace(u);
        corner.transpose().triangularView<Eigen::Upper>().solveInPlace(v);
        rim.force.setZero(n);
        rim.force_by_torque.setZero(n);
        for (Eigen::Index j = 0; j < m; ++j)
          {
            rim.force[in[j]]           = v[j];
            rim.force_by_torque[in[j]] = u[j] / contact.stiffness;
          }
        w = rim.gap - contact.theta * rim.lever;
        w.noalias() += rim.compliance.selfadjointView<Eigen::Lower>() * rim.force;
        const double allowed = m > 0 ? Equilibrated::rounding * v.cwiseAbs().maxCoeff() : 0;
        int          changes = 0;
        for (Eigen::Index i = 0; i < n; ++i)
          {
            char &active = contact.active[rim.places[i]];
            if (active ? rim.force[i] < -allowed : problem_.touches(cells_[rim.places[i]], w[i], contact.theta))
              {
                active = !active;
                ++changes;
              }
          }
        contact.pivots += changes;
        if (changes == 0)
          return true;
      }
    return false;
  }

  /// Forces on all cells from those on the rim; `rigid`: L^-1 of what presses on the cells, theta l - g. What it leaves there behind
  /// the core is L^-1 of what presses on and is not carried: minus w.
  Eigen::VectorXd NestedContact::forces(const Rim &rim, const Eigen::VectorXd &of_rim, Eigen::VectorXd &rigid) const
  {
    const auto      core = rim.core, m = static_cast<Eigen::Index>(cells_.size()), behind = m - core;
    Eigen::VectorXd force = Eigen::VectorXd::Zero(m);
    for (std::size_t i = 0; i < rim.places.size(); ++i)
      force[rim.places[i]] = of_rim[static_cast<Eigen::Index>(i)];
    const auto corner = factor_.block(core, core, behind, behind);
    rigid.head(core).noalias() -= factor_.block(core, 0, behind, core).transpose() * force.tail(behind);
    rigid.tail(behind) -= corner.transpose().triangularView<Eigen::Upper>() * force.tail(behind);
    auto of_core = force.head(core);
    of_core      = rigid.head(core);
    factor_.topLeftCorner(core, core).transpose().triangularView<Eigen::Upper>().solveInPlace(of_core);
    return force;
  }

  std::optional<NestedContact::Contact> NestedContact::solve(const double torque)
  {
    const std::size_t m      = cells_.size();
    const double      unsure = solved_ > 0 ? std::clamp(0.5 * std::abs(1 - torque / solved_), 0.01, 0.1) : 0.1; // share of the torque
    std::size_t       core   = 0;
    while (core < in_order_ && entry_[core] < (1 - unsure) * torque)
      ++core;
    Contact           contact;
    std::vector<char> in_rim(m);
    contact.active.resize(m);
    for (std::size_t i = 0; i < m; ++i)
      {
        in_rim[i]         = i >= core && entry_[i] < (1 + unsure) * torque;
        contact.active[i] = i < core || entry_[i] < torque;
      }
    while (true)
      {
        Rim rim = around(static_cast<Eigen::Index>(core), in_rim);
        if (!pivot(rim, torque, contact))
          return std::nullopt;
        Eigen::VectorXd rigid = contact.theta * lever_ - gap_;
        contact.force         = forces(rim, rim.force, rigid);

        std::size_t sure = 0; // cells of the core in front of the first one that pulls
        while (sure < core && contact.force[sure] >= -Equilibrated::rounding * contact.force.maxCoeff())
          ++sure;
        const Eigen::Index    behind = m - core;
        const Eigen::VectorXd w      = -(factor_.block(core, core, behind, behind).triangularView<Eigen::Lower>() * rigid.tail(behind));
        bool                  right  = sure == core;
        for (std::size_t i = core; i < m; ++i)
          if (!in_rim[i] && problem_.touches(cells_[i], w[i - core], contact.theta))
            {
              in_rim[i] = contact.active[i] = 1;
              right                         = false;
            }
        if (right)
          {
            rigid                   = lever_ / contact.stiffness;
            contact.force_by_torque = forces(rim, rim.force_by_torque, rigid);
            for (std::size_t i = 0; i < m; ++i)
              if (contact.active[i])
                entry_[i] = entry_torque(torque, contact.force[i], contact.force_by_torque[i]);
            solved_ = torque;
            return contact;
          }
        std::fill(in_rim.begin() + sure, in_rim.begin() + core, 1);
        core = sure;
      }
  }
} // namespace flank
