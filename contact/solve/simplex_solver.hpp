// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/solve/parametric_path.hpp"

namespace flank
{
  /// theta(T) between two torques: exact, piecewise linear, ascending in torque.
  struct TorqueCurve
  {
    Status status = Status::failed;
    std::vector<Breakpoint> points; ///< the two ends (cell -1) and every corner between them
  };

  /// Exact first derivatives of a solution while its active set stays: an entry a cell, zero for cells that
  /// are not active.
  struct Sensitivities
  {
    Eigen::VectorXd force_by_torque; ///< df/dT [1/mm]
    Eigen::VectorXd theta_by_gap;    ///< dtheta/dg [rad/mm]; equal to df/dT where C is symmetric
  };

  /// Simplex-based solution of the contact problem: restricted basis entry (f and w of a cell are never both
  /// basic). Block principal pivoting is the fast path, with an iteration cap; the finite parametric path is
  /// what it falls back to. The final factorisation of solve() depends on the active set alone, so its
  /// results do not depend on the way to it.
  class SimplexSolver
  {
  public:
    SimplexSolver() = default;
    explicit SimplexSolver(const ContactProblem &problem) { set(problem); }

    /// Takes a problem; keeps a reference to it. Memory is kept, so that repeated solves of equal size
    /// allocate nothing. Requires C_ii > 0 and finite data (asserted).
    void set(const ContactProblem &problem);

    /// Solves for any torque [N mm]. `start`: a guess of the active cells, such as those of a neighbouring
    /// torque (may be empty).
    void solve(double torque, const std::vector<int> &start, ContactSolution &solution);
    ContactSolution solve(double torque, const std::vector<int> &start = {});

    /// The solution by the finite path alone, from no contact: what solve() falls back to where its pivots do
    /// not end, which hardly a problem brings about. Tests and validation/contact_solver call the fallback
    /// through this, on problems of every kind, and compare it with solve().
    ContactSolution solve_by_path(double torque);

    /// Solutions at all torques (any order and sign). Where all are > 0 and nothing overlaps at first touch
    /// (preload), they come from a NestedContact: cells that it does not hold are checked at every torque by
    /// one matrix product, and the solutions equal solve()'s but for rounding. A torque for which that fails
    /// is solved by itself. `start`: a guess of the active cells, each once, the surest first, which makes it
    /// faster.
    std::vector<ContactSolution> sweep(const std::vector<double> &torques,
                                       const std::vector<int> &start = {});

    /// theta(T) from `low` to `high`, 0 <= low < high, with every breakpoint.
    TorqueCurve curve(double low, double high, const std::vector<int> &start = {});

    /// Derivatives of a solution of this problem, from the factor in hand if it is that solution's, else from
    /// a new one.
    Sensitivities sensitivities(const ContactSolution &solution);

    /// Exact derivatives by the gaps of weight . f at the same torque, an entry a cell [weight's unit x
    /// N/mm]. `sensitivities`: of the same solution.
    Eigen::VectorXd forces_by_gap(const ContactSolution &solution, const Sensitivities &sensitivities,
                                  const Eigen::VectorXd &weight);

  private:
    void attempt(double torque, const std::vector<int> &start, bool pivot_blocks, ContactSolution &solution);
    bool block_pivoting(double torque, bool guessed, std::vector<int> &active, int &pivots);
    bool walk(double torque, std::vector<int> &active, double &theta, int &pivots);
    bool plausible(const ContactSolution &solution);
    void guess(std::vector<int> &active);
    std::pair<double, double> respond(const std::vector<int> &active);
    void finish(double torque, double theta, int pivots, ContactSolution &solution);
    void orient(double torque);
    void factor_block_of(const ContactSolution &solution);

    const ContactProblem *problem_ = nullptr;
    Equilibrated equilibrated_;
    ActiveBlock block_;
    std::vector<int> next_;
    std::vector<std::pair<double, int>> order_;
    Eigen::VectorXd u_, v_, force_, w_, residual_;
    bool preloaded_ = false, has_lever_ = false;
  };
} // namespace flank
