// SPDX-License-Identifier: GPL-2.0-or-later
#include "solver/libraries/module.hpp"
#include "solver/libraries/petsc.hpp"

#include <petscvec.h>

namespace flank
{
  namespace
  {
    /// Upper triangle of the free part of a stiffness matrix in the storage PETSc's symmetric format reads.
    struct UpperTriangle
    {
      UpperTriangle(const StiffnessMatrix &stiffness, const std::vector<char> &fixed)
      {
        const int n = static_cast<int>(stiffness.rows());
        FLANK_ASSERT(static_cast<int>(fixed.size()) == n, "one flag an unknown");
        reduced.assign(n, -1);
        int count = 0;
        for (int i = 0; i < n; ++i)
          if (!fixed[i])
            reduced[i] = count++;
        starts.push_back(0);
        for (int i = 0; i < n; ++i)
          if (!fixed[i])
            {
              for (StiffnessMatrix::InnerIterator it(stiffness, i); it; ++it)
                if (it.col() >= i && !fixed[it.col()])
                  {
                    columns.push_back(reduced[it.col()]);
                    values.push_back(it.value());
                  }
              starts.push_back(static_cast<PetscInt>(columns.size()));
            }
        FLANK_PETSC(MatCreateSeqSBAIJWithArrays(PETSC_COMM_SELF, 1, count, count, starts.data(), columns.data(), values.data(), &matrix));
        FLANK_PETSC(MatSetOption(matrix, MAT_SPD, PETSC_TRUE));
      }
      ~UpperTriangle() { MatDestroy(&matrix); }

      std::vector<int>         reduced; ///< free index of an unknown or -1
      std::vector<PetscInt>    starts, columns;
      std::vector<PetscScalar> values;
      Mat                      matrix = nullptr;
    };
  } // namespace

  class MumpsSolver final : public DirectSolver
  {
  public:
    MumpsSolver(const StiffnessMatrix &stiffness, const std::vector<char> &fixed)
        : upper_(stiffness, fixed)
        , stiffness_(stiffness)
    {
      FLANK_PETSC(MatGetFactor(upper_.matrix, MATSOLVERMUMPS, MAT_FACTOR_CHOLESKY, &factor_.mat));
      petsc::factor_cholesky(factor_.mat, upper_.matrix);
    }
    Eigen::VectorXd solve(const Eigen::VectorXd &load, const Eigen::VectorXd &prescribed) const override;

  private:
    UpperTriangle   upper_;
    StiffnessMatrix stiffness_;
    petsc::Matrix   factor_;
  };

  Eigen::VectorXd MumpsSolver::solve(const Eigen::VectorXd &load, const Eigen::VectorXd &prescribed) const
  {
    const auto     &reduced = upper_.reduced;
    Eigen::VectorXd result  = prescribed.size() > 0 ? prescribed : Eigen::VectorXd::Zero(load.size());
    for (Eigen::Index i = 0; i < result.size(); ++i)
      if (reduced[i] >= 0)
        result[i] = 0;
    const Eigen::VectorXd right = prescribed.size() > 0 ? Eigen::VectorXd(load - stiffness_ * result) : load;
    Vec                   b, x;
    FLANK_PETSC(MatCreateVecs(upper_.matrix, &x, &b));
    PetscScalar *data;
    FLANK_PETSC(VecGetArray(b, &data));
    for (Eigen::Index i = 0; i < right.size(); ++i)
      if (reduced[i] >= 0)
        data[reduced[i]] = right[i];
    FLANK_PETSC(VecRestoreArray(b, &data));
    FLANK_PETSC(MatSolve(factor_.mat, b, x));
    FLANK_PETSC(VecGetArray(x, &data));
    for (Eigen::Index i = 0; i < right.size(); ++i)
      if (reduced[i] >= 0)
        result[i] = data[reduced[i]];
    FLANK_PETSC(VecRestoreArray(x, &data));
    VecDestroy(&b);
    VecDestroy(&x);
    return result;
  }

  std::unique_ptr<const DirectSolver> mumps_solver(const StiffnessMatrix &stiffness, const std::vector<char> &fixed)
  {
    return std::make_unique<const MumpsSolver>(stiffness, fixed);
  }
} // namespace flank
