// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/solve/simplex_solver.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

namespace flank
{
  double TorqueCurve::theta_at(const double torque) const
  {
    const auto above =
        std::upper_bound(points.begin() + 1, points.end() - 1, torque, [](const double t, const Breakpoint &p) { return t < p.torque; });
    const auto below = above - 1;
    return below->stiffness > 0 ? below->theta + (torque - below->torque) / below->stiffness : below->theta;
  }

  double TorqueCurve::stiffness_at(const double torque) const
  {
    return (std::upper_bound(points.begin() + 1, points.end() - 1, torque,
                             [](const double t, const Breakpoint &p) { return t < p.torque; }) -
            1)
        ->stiffness;
  }

  namespace
  {
    /// Torques at which the active cells came into contact. [N mm]
    std::vector<double> entries(const ContactSolution &solution, const Eigen::VectorXd &force_by_torque)
    {
      std::vector<double> result;
      for (const int i : solution.active)
        result.push_back(entry_torque(solution.torque, solution.force[i], force_by_torque[i]));
      return result;
    }

    /// The same for the m cells of a guess, the surest first: a Hertz contact that has grown from its middle over all of them. [N mm]
    std::vector<double> entries(const double torque, const std::size_t m)
    {
      std::vector<double> result;
      for (std::size_t i = 0; i < m; ++i)
        result.push_back(torque * std::pow((static_cast<double>(i) + 0.5) / static_cast<double>(m), 2));
      return result;
    }
  } // namespace

  /// Cells that overlap under forces on those held. Ascending.
  std::vector<int> SimplexSolver::overlapping(const std::vector<int> &held, const Eigen::VectorXd &force, const double theta)
  {
    const auto &p = equilibrated_;
    w_            = p.gap - theta * p.lever;
    p.add_deflection(held, force, w_);
    std::vector<char> is_held(p.size(), 0);
    for (const int i : held)
      is_held[i] = 1;
    std::vector<int> result;
    for (Eigen::Index i = 0; i < p.size(); ++i)
      if (!is_held[i] && p.overlaps(i, w_[i], theta))
        result.push_back(static_cast<int>(i));
    return result;
  }

  void SimplexSolver::take(const NestedContact &nested, const NestedContact::Contact &contact, const double torque,
                           ContactSolution &solution) const
  {
    const auto &p           = equilibrated_;
    solution.status         = Status::solved;
    solution.torque         = torque;
    solution.theta          = p.first_touch + contact.theta;
    solution.stiffness      = contact.stiffness;
    solution.pivots         = contact.pivots;
    solution.regularisation = 0;
    solution.force          = Eigen::VectorXd::Zero(p.size());
    solution.active.clear();
    for (std::size_t k = 0; k < nested.cells().size(); ++k)
      if (contact.active[k])
        {
          const int cell = nested.cells()[k];
          solution.active.push_back(cell);
          solution.force[cell] = std::max(0.0, contact.force[static_cast<Eigen::Index>(k)] * p.scale[cell]);
        }
    std::sort(solution.active.begin(), solution.active.end());
  }

  /// From a guess, which what overlaps joins until nothing does. Returns df/dT of all cells [1/mm]; empty if it fails.
  Eigen::VectorXd SimplexSolver::solve_nested(const double torque, const std::vector<int> &start, ContactSolution &solution)
  {
    constexpr int   rounds = 8; // two are the rule
    const auto     &p      = equilibrated_;
    NestedContact   nested(p);
    Eigen::VectorXd force_by_torque;
    bool            goes_on = nested.append(start, entries(torque, start.size()));
    for (int round = 0; round < rounds && goes_on; ++round)
      {
        const auto contact = nested.solve(torque);
        if (!contact)
          break;
        const std::vector<int> over = overlapping(nested.cells(), contact->force, contact->theta);
        if (over.empty())
          {
            take(nested, *contact, torque, solution);
            force_by_torque.setZero(p.size());
            for (std::size_t k = 0; k < nested.cells().size(); ++k)
              force_by_torque[nested.cells()[k]] = contact->force_by_torque[static_cast<Eigen::Index>(k)] * p.scale[nested.cells()[k]];
            break;
          }
        goes_on = nested.append(over, std::vector<double>(over.size(), torque));
      }
    return force_by_torque;
  }

  /// At those of `lower` (numbers of torques) where its active cells carry the load alone, from a solution above them; returns the others.
  std::vector<std::size_t> SimplexSolver::solve_lower(const std::vector<std::size_t> &lower, const std::vector<double> &torques,
                                                      const ContactSolution &above, const Eigen::VectorXd &force_by_torque,
                                                      std::vector<ContactSolution> &solutions)
  {
    const auto   &p = equilibrated_;
    NestedContact nested(p);
    if (!nested.append(above.active, entries(above, force_by_torque)))
      return lower;
    const std::vector<int> &held = nested.cells();
    std::vector<char>       is_held(p.size(), 0);
    for (const int i : held)
      is_held[i] = 1;
    std::vector<int> others;
    for (int i = 0; i < p.size(); ++i)
      if (!is_held[i])
        others.push_back(i);
    std::vector<std::optional<NestedContact::Contact>> contacts;
    for (const std::size_t t : lower)
      contacts.push_back(nested.solve(torques[t]));

    // All other cells at all torques: one product.
    const auto      m = static_cast<Eigen::Index>(held.size()), n = static_cast<Eigen::Index>(others.size());
    Eigen::MatrixXd compliance(n, m), force                       = Eigen::MatrixXd::Zero(m, static_cast<Eigen::Index>(lower.size()));
    for (Eigen::Index k = 0; k < m; ++k)
      {
        const double *column = problem_->compliance.col(held[k]).data();
        for (Eigen::Index i = 0; i < n; ++i)
          compliance(i, k) = p.scale[others[i]] * p.scale[held[k]] * column[others[i]];
      }
    for (std::size_t t = 0; t < lower.size(); ++t)
      if (contacts[t])
        force.col(static_cast<Eigen::Index>(t)) = contacts[t]->force;
    const Eigen::MatrixXd    deflection = compliance * force;
    std::vector<std::size_t> failed;
    for (std::size_t t = 0; t < lower.size(); ++t)
      {
        bool holds = contacts[t].has_value();
        for (Eigen::Index i = 0; i < n && holds; ++i)
          {
            const int    cell  = others[i];
            const double theta = contacts[t]->theta, w = p.gap[cell] - theta * p.lever[cell] + deflection(i, static_cast<Eigen::Index>(t));
            holds = !p.overlaps(cell, w, theta);
          }
        if (holds)
          take(nested, *contacts[t], torques[lower[t]], solutions[lower[t]]);
        else
          failed.push_back(lower[t]);
      }
    return failed;
  }

  std::vector<ContactSolution> SimplexSolver::sweep(const std::vector<double> &torques, const std::vector<int> &start,
                                                    const std::function<bool(const ContactSolution &)> &goes_on)
  {
    constexpr double             order_lasts = 0.4; // an order of entries is worth keeping down to this share of its torque
    std::vector<ContactSolution> solutions(torques.size());
    std::vector<std::size_t>     order(torques.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](const auto a, const auto b) { return torques[a] > torques[b]; });
    if (torques.empty())
      return solutions;
    const double high = torques[order.front()], low = torques[order.back()];
    orient(high);
    const bool       nests    = problem_->symmetric && low > 0 && has_lever_ && !preloaded_;
    ContactSolution &greatest = solutions[order.front()];
    Eigen::VectorXd  force_by_torque;
    if (nests && !start.empty())
      force_by_torque = solve_nested(high, start, greatest);
    if (greatest.status != Status::solved)
      solve(high, start, greatest);
    if (goes_on && !goes_on(greatest))
      return solutions;
    const ContactSolution *above = &greatest;
    for (std::size_t from = 1, to = from; from < order.size(); from = to)
      {
        while (to < order.size() && (to == from || torques[order[to]] > order_lasts * above->torque))
          ++to;
        std::vector<std::size_t> left(order.begin() + from, order.begin() + to);
        if (nests && above->status == Status::solved && above->regularisation == 0)
          {
            if (force_by_torque.size() == 0)
              force_by_torque = sensitivities(*above).force_by_torque;
            left = solve_lower(left, torques, *above, force_by_torque, solutions);
            force_by_torque.resize(0);
          }
        for (const std::size_t t : left)
          {
            solve(torques[t], above->active, solutions[t]);
            above = &solutions[t];
          }
        above = &solutions[order[to - 1]];
      }
    return solutions;
  }

  TorqueCurve SimplexSolver::curve(const double low, const double high, const std::vector<int> &start)
  {
    assert(low >= 0 && low < high);
    TorqueCurve           result;
    const ContactSolution top = solve(high, start);
    result.status             = top.status;
    if (top.status != Status::solved)
      return result;
    // Down from the greatest torque over all cells, so that one that enters on the way is seen.
    const auto             &p = equilibrated_;
    ParametricPath          path(p);
    std::vector<int>        active = top.active;
    std::vector<Breakpoint> down;
    double                  theta = p.sense * top.theta - p.first_touch;
    const auto              end =
        path.follow(active, p.gap, -p.lever, theta, low > 0 || preloaded_ ? -std::numeric_limits<double>::infinity() : 0.0, low, &down);
    if (end == ParametricPath::End::lost)
      {
        result.status = Status::failed;
        return result;
      }
    const auto slope_of = [&](const std::vector<int> &cells) {
      ActiveBlock block;
      if (cells.empty() || !block.factor(p, cells))
        return 0.0;
      Eigen::VectorXd u = p.lever(cells);
      block.solve(u);
      return p.lever(cells).dot(u);
    };
    // A corner met on the way down closes the piece above it: its slope is the one recorded there.
    result.points.push_back({ low, p.first_touch + theta, slope_of(active), -1 });
    for (auto corner = down.rbegin(); corner != down.rend(); ++corner)
      result.points.push_back({ corner->torque, p.first_touch + corner->theta, corner->stiffness, corner->cell });
    result.points.push_back({ high, top.theta, top.stiffness, -1 });
    return result;
  }
} // namespace flank
