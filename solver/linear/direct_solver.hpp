// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "solver/linear/stiffness_matrix.hpp"

#include <Eigen/Dense>

#include <memory>
#include <vector>

namespace flank
{
  /// Sparse Cholesky factor (MUMPS) with fixed unknowns held at given values.
  class DirectSolver
  {
  public:
    virtual ~DirectSolver() = default;

    /// Displacements [mm] for loads [N]; `prescribed` holds the fixed unknowns' values (empty: zero). Not for
    /// several threads at once.
    virtual Eigen::VectorXd solve(const Eigen::VectorXd &load,
                                  const Eigen::VectorXd &prescribed = {}) const = 0;
  };

  struct Condensation
  {
    Eigen::MatrixXd
        complement; ///< the dense symmetric Schur complement in the order of the kept unknowns [N/mm]
    std::unique_ptr<const DirectSolver>
        inside; ///< with kept unknowns fixed too; null where it was not asked for
  };

  /// Exact static condensation by MUMPS in the order of METIS's nested dissection, on this process alone.
  /// Unknowns in `fixed` (nonzero flag) are held at zero; all others outside `kept` are eliminated.
  /// `keep_inside`: their factor is kept. Throws ComputationError if the matrix is not positive definite.
  Condensation condense(const StiffnessMatrix &stiffness, const std::vector<char> &fixed,
                        const std::vector<int> &kept, bool keep_inside);

  /// Factors a stiffness matrix by MUMPS, the unknowns in `fixed` (nonzero flag) held. Throws
  /// ComputationError if it is not positive definite.
  std::unique_ptr<const DirectSolver> make_direct_solver(const StiffnessMatrix &stiffness,
                                                         const std::vector<char> &fixed);
} // namespace flank
