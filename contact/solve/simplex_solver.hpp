// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "contact/solve/contact_problem.hpp"

namespace flank
{
  /// Simplex-based solution of the contact problem: restricted basis entry (f and w of a cell are never both basic).
  /// Block principal pivoting is the fast path with an iteration cap; the torque-parametric sweep, which is finite, is
  /// what it falls back to and what carries one torque to the next. Forces are equilibrated by powers of two.
  class SimplexSolver
  {
  public:
    /// Keeps a reference to the problem. Requires levers > 0 somewhere; throws InputError otherwise.
    explicit SimplexSolver(const ContactProblem &problem);

    /// torque > 0 [N mm]; `start`: guess of the active cells (may be empty). Throws ComputationError past the pivot bound.
    ContactSolution solve(double torque, const std::vector<int> &start = {}) const;

    /// Solutions at all torques (each > 0, any order): the greatest first, then the parametric sweep downwards on its active
    /// block, every cell checked at every torque by one matrix product, violators added.
    std::vector<ContactSolution> sweep(const std::vector<double> &torques, const std::vector<int> &start = {}) const;

  private:
    struct State;
    bool            block_pivoting(double torque, std::vector<int> &active, int &pivots) const;
    int             follow(std::vector<int> &active, const std::vector<int> &cells, double from, double to, bool from_first_touch) const;
    ContactSolution finish(double torque, std::vector<int> active, int pivots) const;

    const ContactProblem &problem_;
    Eigen::MatrixXd       compliance_;          ///< D C D
    Eigen::VectorXd       scale_, gap_, lever_; ///< D, D g, D l
  };
} // namespace flank
