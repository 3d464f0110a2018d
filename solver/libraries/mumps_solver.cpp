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

  Eigen::MatrixXd mumps_condense(const StiffnessMatrix &stiffness, const std::vector<char> &fixed, const std::vector<int> &kept)
  {
    UpperTriangle         upper(stiffness, fixed);
    std::vector<PetscInt> indices;
    for (const int k : kept)
      {
        FLANK_ASSERT(upper.reduced[k] >= 0, "kept unknowns are free");
        indices.push_back(upper.reduced[k]);
      }
    petsc::Matrix factor;
    FLANK_PETSC(MatGetFactor(upper.matrix, MATSOLVERMUMPS, MAT_FACTOR_CHOLESKY, &factor.mat));
    FLANK_PETSC(MatMumpsSetIcntl(factor.mat, 14, 40)); // workspace estimate, per cent
    FLANK_PETSC(MatMumpsSetIcntl(factor.mat, 31, 1));  // the factor itself is not used again
    IS schur;
    FLANK_PETSC(ISCreateGeneral(PETSC_COMM_SELF, static_cast<PetscInt>(indices.size()), indices.data(), PETSC_COPY_VALUES, &schur));
    FLANK_PETSC(MatFactorSetSchurIS(factor.mat, schur));
    FLANK_PETSC(ISDestroy(&schur));
    petsc::factor_cholesky(factor.mat, upper.matrix);

    Mat                  complement;
    MatFactorSchurStatus status;
    FLANK_PETSC(MatFactorCreateSchurComplement(factor.mat, &complement, &status));
    FLANK_ASSERT(status == MAT_FACTOR_SCHUR_UNFACTORED, "plain Schur complement");
    const PetscScalar *data;
    FLANK_PETSC(MatDenseGetArrayRead(complement, &data));
    const auto      n      = static_cast<Eigen::Index>(indices.size());
    Eigen::MatrixXd result = Eigen::Map<const Eigen::MatrixXd>(data, n, n);
    FLANK_PETSC(MatDenseRestoreArrayRead(complement, &data));
    FLANK_PETSC(MatDestroy(&complement));
    // MUMPS fills one triangle only.
    const double lower = result.triangularView<Eigen::StrictlyLower>().toDenseMatrix().cwiseAbs().sum();
    const double above = result.triangularView<Eigen::StrictlyUpper>().toDenseMatrix().cwiseAbs().sum();
    if (lower >= above)
      result.triangularView<Eigen::StrictlyUpper>() = result.transpose();
    else
      result.triangularView<Eigen::StrictlyLower>() = result.transpose();
    return result;
  }

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
