#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# Includes run one way: mesh <- solver <- contact <- cases, and inside contact from half_space, solve and flanks over
# matching and rollers to loaded and stress. Each third-party library has one home, and no scene knows another one.
# Names file and line of every breach.
cd "$1" || exit 1
status=0
forbid() { # FOLDERS PATTERN WHY [FILES THAT MAY]
  local found
  found=$(grep -rnE "#include [<\"]($2)" $1 --include=*.hpp --include=*.cpp | grep -vE "^(${4:-none}):")
  if [[ -n $found ]]; then echo "$found"; echo "  ^ $3"; status=1; fi
}
# The chain.
forbid mesh '(solver|contact|cases)/' "mesh knows nothing above it"
forbid solver '(contact|cases)/' "solver knows no contact"
forbid contact 'cases/' "contact knows nothing of the program"
forbid solver/linear 'solver/(elements|libraries|reduction|fields)/' "linear algebra knows no elements"
forbid solver/elements 'solver/(libraries|reduction|fields)/' "elements know nothing of who makes them"
forbid solver/libraries 'solver/(reduction|fields)/' "libraries serve the reduction, they do not know it"
forbid solver/reduction 'solver/fields/' "fields stand on reduced bodies"
forbid mesh/base 'mesh/(gear|segment)/' "base knows nothing of ours"
forbid mesh/gear 'mesh/segment/' "gears know nothing of their meshes"
# Inside contact.
forbid contact/solve '(mesh/|solver/|contact/[^s]|contact/stress|fmt|spdlog)' \
  "the contact solver stands alone: Eigen and the standard library"
forbid contact/half_space '(mesh/(gear|segment)/|solver/|contact/([^h]))' "the half-space needs mesh/base alone"
forbid contact/flanks '(solver/|contact/(half_space|solve|matching|rollers|loaded|stress)/)' "flanks meet without a solver"
forbid "contact/matching contact/rollers" 'contact/(loaded|stress)/' "below loaded nothing sees loaded"
forbid contact/rollers '(solver/|contact/(flanks|matching)/)' "rollers need half-space, contact problem and their geometry"
forbid contact/matching 'contact/(solve|rollers)/' "compliance knows no contact problem"
forbid contact/loaded 'contact/(stress|rollers)/' "stress stands on loaded bodies, not under them"
# Scenes and the case file.
for scene in cases/*/*.toml; do
  scene=$(basename "$(dirname "$scene")")
  forbid "cases --exclude-dir=$scene" "cases/$scene/" "scenes are known to the list of scenes alone"
done
forbid "cases/case_file cases/work cases/results cases/study" 'cases/(scene/|scenes)' "what all scenes use knows no scene" \
  "cases/study/study.[ch]pp"
forbid cases/results 'cases/study/' "results know no study: it writes them"
forbid cases/work 'cases/(results|study|scene)/' "work knows nothing of what is worked out"
forbid cases/scene 'cases/(results|study)/' "a scene is what a folder of cases brings, no more"
forbid "cases/parallel_axis/pair" 'cases/parallel_axis/([^p]|plan)' "the pair stands under its input, extras and results"
forbid "cases/parallel_axis/input" 'cases/parallel_axis/(extras|[a-z_]*\.hpp)' "input stands under extras and results"
forbid "cases/work cases/results" 'cases/case_file/(case_file|schema|toml)' "results and work know no case file"
# Third parties, one home each.
forbid "mesh contact cases" 'mpi|petsc|dmumps|metis|deal\.II' "MPI, PETSc, MUMPS, METIS and deal.II live in solver"
forbid "solver/elements solver/linear solver/reduction solver/fields" '(mpi|dmumps|metis|deal\.II)' \
  "third-party solvers live in solver/libraries"
forbid "mesh/base mesh/gear solver contact cases" 'gmsh' "Gmsh's home is mesh/segment"
forbid "mesh contact solver" '(toml|CLI)' "the case file's parser has its home in cases/case_file"
forbid "cases/work cases/results cases/study cases/parallel_axis cases/double_roller" 'toml' \
  "the case file's parser has its home in cases/case_file" "cases/study/study_axes.cpp"
forbid "mesh contact solver" '(hdf5|H5)' "HDF5's home is cases/results"
forbid "cases --exclude-dir=results" '(hdf5|H5|zlib)' "HDF5's home is cases/results, zlib's cases/work" "cases/work/.*"
forbid "mesh contact solver" 'zlib' "zlib's home is cases/work"
forbid "mesh solver cases" boost "Boost has its homes in contact and cases/results" "cases/results/.*"
exit $status
