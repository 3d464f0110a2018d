#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# Includes run one way: mesh <- contact, mesh <- solver, all <- cases; contact and solver do not know each other;
# each third-party library has one home. Names file and line of every breach.
cd "$1" || exit 1
status=0
forbid() { # FOLDERS PATTERN WHY
  local found
  found=$(grep -rnE "#include [<\"]($2)" $1 --include=*.hpp --include=*.cpp)
  if [[ -n $found ]]; then echo "$found"; echo "  ^ $3"; status=1; fi
}
forbid mesh '(contact|solver|cases)/' "mesh knows nothing above it"
forbid contact '(solver|cases)/' "contact knows no finite elements"
forbid solver '(contact|cases)/' "solver knows no contact"
forbid mesh/base 'mesh/(gear|segment)/' "base knows nothing of ours"
forbid "contact mesh/base mesh/gear cases" 'petsc|gmsh' "PETSc's home is solver, Gmsh's is mesh/segment"
forbid "mesh contact cases" 'deal\.II' "deal.II's home is solver"
forbid "mesh contact solver" 'toml|CLI' "the case file's parser has its home in cases"
forbid "mesh solver cases/*.?pp cases/parallel_axis cases/double_roller" 'boost' "Boost's homes are contact/grid and cases/study"
forbid "mesh contact solver" 'zlib' "zlib's home is the operator cache"
forbid contact/solve '(mesh/|contact/(grid|half_space)/|fmt|spdlog)' "the contact solver stands alone: Eigen and the standard library"
exit $status
