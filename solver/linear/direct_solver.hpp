// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "solver/elements/elastic_body.hpp"

#include <memory>
#include <vector>

namespace flank
{
  /// Exact static condensation by MUMPS (PETSc, on this process alone).
  /// Unknowns in `fixed` (nonzero flag) are held at zero; all others outside `kept` are eliminated.
  /// Returns the dense symmetric Schur complement in the order of `kept`. [N/mm]
  /// Throws ComputationError if the matrix is not positive definite.
  Eigen::MatrixXd condense(const StiffnessMatrix &stiffness, const std::vector<char> &fixed, const std::vector<int> &kept);

  /// Sparse Cholesky factor (MUMPS through PETSc) with fixed unknowns held at given values.
  class DirectSolver
  {
  public:
    virtual ~DirectSolver() = default;

    /// Displacements [mm] for loads [N]; `prescribed` holds the fixed unknowns' values (empty: zero). Not for several threads at once.
    virtual Eigen::VectorXd solve(const Eigen::VectorXd &load, const Eigen::VectorXd &prescribed = {}) const = 0;
  };

  std::unique_ptr<const DirectSolver> make_direct_solver(const StiffnessMatrix &stiffness, const std::vector<char> &fixed);
} // namespace flank
