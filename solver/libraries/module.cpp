// SPDX-License-Identifier: GPL-2.0-or-later
// The door of the module: what it needs to start, and what it offers.
#include "solver/libraries/module.hpp"

#include "solver/libraries/petsc.hpp"

#include <deal.II/base/multithread_info.h>

#include <petscsys.h>

/// OpenBLAS's own, where that is the BLAS that MUMPS works with.
extern "C" void openblas_set_num_threads(int) __attribute__((weak));

extern "C" __attribute__((visibility("default"))) flank::ElementLibraries flank_element_libraries()
{
  // One rank alone may need the libraries: PETSc starts without a word to the others. What is done together
  // names its communicator.
  PETSC_COMM_WORLD = MPI_COMM_SELF;
  FLANK_PETSC(PetscPushErrorHandler(PetscReturnErrorHandler, nullptr)); // we say what is wrong
  // Nobody's .petscrc may change a factorisation (the session takes PETSC_OPTIONS away).
  static char program[] = "flank", skip[] = "-skip_petscrc", *words[] = { program, skip, nullptr },
              **arguments = words; // PETSc keeps them
  int count = 2;
  FLANK_PETSC(PetscInitialize(&count, &arguments, nullptr, nullptr));
  FLANK_PETSC(PetscOptionsClear(nullptr));
  dealii::MultithreadInfo::set_thread_limit(1);
  if (openblas_set_num_threads)
    openblas_set_num_threads(1); // with more, the last bits of a factorisation would depend on how many
  return { flank::dealii_body,      flank::mumps_condense,    flank::mumps_condense_across_ranks,
           flank::dealii_write_vtu, flank::dealii_write_pvtu, flank::dealii_write_pvd,
           [] { PetscFinalize(); } };
}
