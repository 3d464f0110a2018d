// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include "mesh/base/errors.hpp"
#include "solver/libraries/mumps_failure.hpp"

#include <petscmat.h>

#include <fmt/format.h>

#include <new>

// PETSc for the files of this folder: calls that throw, objects that destroy themselves.

namespace flank::petsc
{
  inline void check(const PetscErrorCode code, const char *call)
  {
    if (code == PETSC_ERR_MEM)
      throw std::bad_alloc();
    if (code != 0)
      throw LibraryError(fmt::format("PETSc error {} in {}", static_cast<int>(code), call));
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
    require_factored(info, "factorisation");
    if (error != MAT_FACTOR_NOERROR)
      throw LibraryError(fmt::format("PETSc factored no stiffness matrix ({})", static_cast<int>(error)));
  }
} // namespace flank::petsc
