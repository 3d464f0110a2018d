// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/solve/nested_contact.hpp"
#include "contact/solve/simplex_solver.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace flank
{
  namespace
  {
    /// A guess of m cells, the surest first, as a Hertz contact that has grown from its middle over all of
    /// them.
    ExpectedContact guessed(const double torque, const std::vector<int> &cells)
    {
      ExpectedContact result{ cells, {} };
      const auto m = static_cast<double>(cells.size());
      for (std::size_t i = 0; i < cells.size(); ++i)
        result.entry.push_back(torque * std::pow((static_cast<double>(i) + 0.5) / m, 2));
      return result;
    }

    /// The active cells of a solution, at torques below it. force_by_torque: df/dT of all cells [1/mm]
    ExpectedContact expected_below(const ContactSolution &solution, const Eigen::VectorXd &force_by_torque)
    {
      ExpectedContact result{ solution.active, {} };
      for (const int i : solution.active)
        result.entry.push_back(entry_torque(solution.torque, solution.force[i], force_by_torque[i]));
      return result;
    }

    /// All cells but those held. Ascending.
    std::vector<int> others(const Eigen::Index n, const std::vector<int> &held)
    {
      std::vector<char> is_held(n, 0);
      for (const int i : held)
        is_held[i] = 1;
      std::vector<int> result;
      for (int i = 0; i < n; ++i)
        if (!is_held[i])
          result.push_back(i);
      return result;
    }

    ContactSolution solution_of(const Equilibrated &p, const NestedContact &nested,
                                const NestedContact::Contact &contact, const double torque)
    {
      ContactSolution solution;
      solution.status = Status::solved;
      solution.torque = torque;
      solution.theta = p.first_touch + contact.theta;
      solution.stiffness = contact.stiffness;
      solution.pivots = contact.pivots;
      solution.force = Eigen::VectorXd::Zero(p.size());
      for (std::size_t k = 0; k < nested.cells().size(); ++k)
        if (contact.active[k])
          {
            const int cell = nested.cells()[k];
            solution.active.push_back(cell);
            solution.force[cell] = std::max(0.0, contact.force[static_cast<Eigen::Index>(k)] * p.scale[cell]);
          }
      std::sort(solution.active.begin(), solution.active.end());
      return solution;
    }

    /// Solves from a guess of the contact: cells that overlap join it until none does. False if that fails;
    /// `expected` is then as it was.
    bool solve_from_guess(const Equilibrated &p, const double torque, const std::vector<int> &start,
                          ContactSolution &solution, ExpectedContact &expected)
    {
      constexpr int rounds = 8; // two are the rule
      NestedContact nested(p);
      Eigen::VectorXd w(p.size());
      bool holds = nested.append(guessed(torque, start));
      int pivots = 0;
      for (int round = 0; round < rounds && holds; ++round)
        {
          const auto contact = nested.solve(torque);
          if (!contact)
            return false;
          w = p.gap - contact->theta * p.lever;
          p.add_deflection(nested.cells(), contact->force, w);
          std::vector<int> over;
          for (const int i : others(p.size(), nested.cells()))
            if (p.overlaps(i, w[i], contact->theta))
              over.push_back(i);
          pivots += contact->pivots + static_cast<int>(over.size());
          if (over.empty())
            {
              solution = solution_of(p, nested, *contact, torque);
              solution.pivots = pivots;
              expected = nested.expected(*contact);
              return true;
            }
          holds = nested.append({ over, std::vector<double>(over.size(), torque) });
        }
      return false;
    }

    /// At those of `lower` (numbers of torques, descending) where the cells expected carry the load alone;
    /// returns the others. expected: of a solution above them; of the lowest on return, empty where that is
    /// among the others.
    std::vector<std::size_t> solve_lower(const Equilibrated &p, const std::vector<std::size_t> &lower,
                                         const std::vector<double> &torques, ExpectedContact &expected,
                                         std::vector<ContactSolution> &solutions)
    {
      NestedContact nested(p);
      if (!nested.append(std::exchange(expected, {})))
        return lower;
      const auto m = static_cast<Eigen::Index>(nested.cells().size());
      std::vector<std::optional<NestedContact::Contact>> contacts;
      Eigen::MatrixXd force = Eigen::MatrixXd::Zero(m, static_cast<Eigen::Index>(lower.size()));
      for (const std::size_t t : lower)
        {
          contacts.push_back(nested.solve(torques[t]));
          if (contacts.back())
            force.col(static_cast<Eigen::Index>(contacts.size()) - 1) = contacts.back()->force;
        }
      // All other cells at all torques: one product.
      const std::vector<int> rest = others(p.size(), nested.cells());
      const Eigen::MatrixXd compliance = p.scale(rest).asDiagonal() * (*p.compliance)(rest, nested.cells()) *
                                         p.scale(nested.cells()).asDiagonal();
      const Eigen::MatrixXd deflection = compliance * force;
      std::vector<std::size_t> failed;
      for (std::size_t t = 0; t < lower.size(); ++t)
        {
          bool holds = contacts[t].has_value();
          for (std::size_t i = 0; i < rest.size() && holds; ++i)
            {
              const int cell = rest[i];
              const double theta = contacts[t]->theta,
                           bent = deflection(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(t));
              holds = !p.overlaps(cell, p.gap[cell] - theta * p.lever[cell] + bent, theta);
            }
          if (holds)
            solutions[lower[t]] = solution_of(p, nested, *contacts[t], torques[lower[t]]);
          else
            failed.push_back(lower[t]);
        }
      if (failed.empty() || failed.back() != lower.back())
        expected = nested.expected(*contacts.back());
      return failed;
    }
  } // namespace

  std::vector<ContactSolution> SimplexSolver::sweep(const std::vector<double> &torques,
                                                    const std::vector<int> &start)
  {
    constexpr double order_lasts =
        0.4; // the order in which cells come is worth keeping down to this share of its torque
    std::vector<ContactSolution> solutions(torques.size());
    std::vector<std::size_t> order(torques.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](const auto a, const auto b) { return torques[a] > torques[b]; });
    if (torques.empty())
      return solutions;
    const double high = torques[order.front()], low = torques[order.back()];
    orient(high);
    const bool nests = problem_->symmetric && low > 0 && has_lever_ && !preloaded_;
    ContactSolution &greatest = solutions[order.front()];
    ExpectedContact expected;
    if (!nests || start.empty() || !solve_from_guess(equilibrated_, high, start, greatest, expected))
      solve(high, start, greatest);
    const ContactSolution *above = &greatest;
    for (std::size_t from = 1, to = from; from < order.size(); from = to)
      {
        while (to < order.size() && (to == from || torques[order[to]] > order_lasts * above->torque))
          ++to;
        std::vector<std::size_t> left(order.begin() + from, order.begin() + to);
        if (nests && above->status == Status::solved && above->regularisation == 0)
          {
            if (expected.cells.empty())
              expected = expected_below(*above, sensitivities(*above).force_by_torque);
            left = solve_lower(equilibrated_, left, torques, expected, solutions);
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
    TorqueCurve result;
    const ContactSolution top = solve(high, start);
    result.status = top.status;
    if (top.status != Status::solved)
      return result;
    // Down from the greatest torque over all cells, so that one that enters on the way is seen.
    const auto &p = equilibrated_;
    ParametricPath path(p);
    std::vector<int> active = top.active;
    std::vector<Breakpoint> down;
    double theta = p.sense * top.theta - p.first_touch;
    const auto end =
        path.follow(active, p.gap, -p.lever, theta,
                    low > 0 || preloaded_ ? -std::numeric_limits<double>::infinity() : 0.0, low, &down);
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
      result.points.push_back(
          { corner->torque, p.first_touch + corner->theta, corner->stiffness, corner->cell });
    result.points.push_back({ high, top.theta, top.stiffness, -1 });
    return result;
  }
} // namespace flank
