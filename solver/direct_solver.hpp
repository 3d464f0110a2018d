// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "solver/elastic_body.hpp"

#include <string>
#include <vector>

namespace flank
{
  /// Starts MPI and PETSc for the life of the object, one thread a rank inside deal.II. One per program, in main.
  class ParallelSession
  {
  public:
    ParallelSession(int &argc, char **&argv);
    ~ParallelSession();

    int ranks() const; ///< MPI processes of this run

  private:
    struct Implementation;
    Implementation *implementation_;
  };

  /// PETSc, MPI and HDF5 as linked, one a line.
  std::string solver_libraries();

  /// Exact static condensation by MUMPS (PETSc, on this process alone).
  /// Unknowns in `fixed` (nonzero flag) are held at zero; all others outside `kept` are eliminated.
  /// Returns the dense symmetric Schur complement in the order of `kept`. [N/mm]
  /// Throws ComputationError if the matrix is not positive definite.
  Eigen::MatrixXd condense(const StiffnessMatrix &stiffness, const std::vector<char> &fixed, const std::vector<int> &kept);

  /// Sparse Cholesky factor (MUMPS through PETSc) with fixed unknowns held at given values.
  class DirectSolver
  {
  public:
    DirectSolver(const StiffnessMatrix &stiffness, const std::vector<char> &fixed);
    ~DirectSolver();
    DirectSolver(const DirectSolver &) = delete;

    /// Displacements [mm] for loads [N]; `prescribed` holds the fixed unknowns' values (empty: zero).
    Eigen::VectorXd solve(const Eigen::VectorXd &load, const Eigen::VectorXd &prescribed = {}) const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
  };
} // namespace flank
