// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "mesh/base/errors.hpp"

#include <petscmat.h>

#include <fmt/format.h>

// PETSc for the files of this folder: calls that throw, objects that destroy themselves.

namespace flank::petsc
{
  inline void check(const PetscErrorCode code, const char *call)
  {
    if (code != 0)
      throw ComputationError(fmt::format("PETSc error {} in {}", static_cast<int>(code), call));
  }
#define FLANK_PETSC(call) ::flank::petsc::check(call, #call)

  struct Matrix
  {
    Mat mat = nullptr;
    Matrix() = default;
    Matrix(const Matrix &) = delete;
    ~Matrix() { MatDestroy(&mat); }
  };

  struct IndexSet
  {
    IS is = nullptr;
    IndexSet() = default;
    IndexSet(const IndexSet &) = delete;
    ~IndexSet() { ISDestroy(&is); }
  };

  /// Cholesky factor by MUMPS of a matrix that MatGetFactor() was asked for. Throws if it is not positive
  /// definite.
  inline void factor_cholesky(const Mat factor, const Mat matrix)
  {
    FLANK_PETSC(MatCholeskyFactorSymbolic(factor, matrix, nullptr, nullptr));
    FLANK_PETSC(MatCholeskyFactorNumeric(factor, matrix, nullptr));
    MatFactorError error;
    FLANK_PETSC(MatFactorGetError(factor, &error));
    PetscInt info = 0;
    MatMumpsGetInfog(factor, 1, &info);
    if (error != MAT_FACTOR_NOERROR || info < 0)
      throw ComputationError(fmt::format("the stiffness matrix could not be factored (PETSc {}, MUMPS "
                                         "INFOG(1) = {}): broken mesh or missing support",
                                         static_cast<int>(error), info));
  }
} // namespace flank::petsc
