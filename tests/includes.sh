#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# Includes run one way: mesh <- solver <- contact <- cases, and inside contact from half_space, solve and
# flanks over matching and rollers to loaded and stress. Each third-party library has one home, and no
# scene knows another one.
# Names file and line of every breach.
cd "$1" || exit 1
status=0
readonly sources="--include=*.hpp --include=*.cpp" include='#\s*include\s*[<"]'
included() { # FOLDERS PATTERN: file, line and include
  grep -rHnP "$include($2)" $1 $sources
  if [[ $? -gt 1 ]]; then echo "$1: cannot be searched"; fi
}
breach() { # LINES WHY
  if [[ -n $1 ]]; then echo "$1"; echo "  ^ $2"; status=1; fi
}
forbid() { # FOLDERS PATTERN WHY [FILES THAT MAY]
  breach "$(included "$1" "$2" | grep -vE "^(${4:-none}):")" "$3"
}
allow() { # FOLDERS PATTERN WHY: nothing else
  breach "$(included "$1" "" | grep -vP "$include($2)[>\"]")" "$3"
}
# Every rule reads paths from the root.
forbid "mesh solver contact cases" '(\.|[^/"]+")' "files of ours are included by their path from the root"
# The chain.
forbid mesh '(solver|contact|cases)/' "mesh knows nothing above it"
forbid solver '(contact|cases)/' "solver knows no contact"
forbid contact 'cases/' "contact knows nothing of the program"
forbid solver/linear 'solver/(elements|libraries|reduction|fields)/' "linear algebra knows no elements"
forbid solver/elements 'solver/(libraries|reduction|fields)/' "elements know nothing of who makes them"
forbid solver/libraries 'solver/(reduction|fields)/' "libraries serve the reduction, they do not know it"
forbid solver/reduction 'solver/fields/' "fields stand on reduced bodies"
readonly session="solver/parallel_session.hpp solver/parallel_session.cpp"
forbid "$session" 'solver/(linear|elements|reduction|fields)/' \
  "a session starts libraries, it knows no bodies"
forbid mesh/base 'mesh/(gear|segment)/' "base knows nothing of ours"
forbid mesh/gear 'mesh/segment/' "gears know nothing of their meshes"
# Inside contact.
allow contact/solve '(contact/solve/[a-z_]+\.hpp|Eigen/[A-Z][A-Za-z]*|[a-z_]+)' \
  "the contact solver stands alone: Eigen and the standard library"
forbid contact/wedge '(solver/(libraries|reduction|fields)/|contact/[^hw])' \
  "wedges need shapes of elements, linear algebra and the half-space"
forbid contact/half_space '(mesh/(gear|segment)/|solver/|contact/([^h]))' \
  "the half-space needs mesh/base alone"
forbid contact/flanks '(solver/|contact/(half_space|solve|matching|rollers|loaded|stress)/)' \
  "flanks meet without a solver"
forbid "contact/matching contact/rollers" 'contact/(loaded|stress)/' "below loaded nothing sees loaded"
forbid contact/rollers '(solver/|contact/(flanks|matching)/)' \
  "rollers need half-space, contact problem and their geometry"
forbid contact/matching 'contact/(solve|rollers)/' "compliance knows no contact problem"
forbid contact/loaded 'contact/(stress|rollers)/' "stress stands on loaded bodies, not under them"
forbid contact/stress 'contact/rollers/' "loaded teeth know no rollers"
# Scenes and the case file.
for scene in cases/*/scene.cpp; do
  scene=$(basename "$(dirname "$scene")")
  forbid "cases --exclude-dir=$scene" "cases/$scene/" "scenes are known to the list of scenes alone"
done
forbid cases 'cases/scenes' "the list of scenes is the program's" "cases/(main|scenes).cpp"
forbid "cases/case_file cases/work cases/results cases/study" 'cases/scene/' \
  "what all scenes use knows no scene" "cases/study/study.[ch]pp"
forbid cases/files '(cases/[^f]|solver/|contact/|mesh/(gear|segment)/)' \
  "files are read and written on mesh/base alone"
forbid cases/case_file 'cases/(work|results|study)/' "a case file is read before anything is worked out"
forbid cases/results 'cases/study/' "results know no study: it writes them"
forbid cases/work 'cases/(results|study|scene)/' "work knows nothing of what is worked out"
forbid cases/scene 'cases/(results|study)/' "a scene is what a folder of cases brings, no more"
forbid cases/report '(cases/[^r]|cases/results|solver/|contact/)' \
  "reports are made of finished results: no code in common with what computes them"
forbid "cases/parallel_axis/pair" 'cases/parallel_axis/([^p]|plan)' \
  "the pair stands under its input, extras and results"
forbid cases/parallel_axis/pair 'cases/case_file/' "the pair knows no case file: its input does"
forbid "cases/parallel_axis/input" 'cases/parallel_axis/(extras|[a-z_]*\.hpp)' \
  "input stands under extras and results"
forbid "cases/work cases/results" 'cases/case_file/(case_file|schema|toml)' \
  "results and work know no case file"
forbid cases/parallel_axis/extras 'cases/parallel_axis/(input/|[a-z_]*\.hpp)' \
  "extras stand on the pair: input, results and studies know them"
# Third parties, one home each.
readonly solvers='(mpi|petsc|[a-z]mumps|metis|scotch|deal\.II)'
forbid "mesh contact cases" "$solvers" "MPI, PETSc, MUMPS, METIS, Scotch and deal.II live in solver"
forbid solver "$solvers" \
  "third-party solvers live in solver/libraries, MPI's start in the session" \
  "solver/(libraries/.*|parallel_session.cpp)"
forbid cases 'solver/libraries/(?!vtu_file\.hpp)' \
  "cases see no library of the solver; fields are written by vtu_file"
forbid contact '(solver/libraries|solver/parallel_session)' "contact reads plain matrices and surfaces" \
  contact/matching/body_compliance.cpp
forbid "mesh/base mesh/gear solver contact cases" 'gmsh' "Gmsh's home is mesh/segment"
forbid "mesh contact solver cases" '(toml(\+\+|\.hpp)|cases/case_file/(toml_text|value))' \
  "TOML's home is cases/case_file" "cases/(case_file/.*|study/study_ax(es|is).cpp)"
forbid "mesh contact solver cases" CLI "the command line is read in cases/main.cpp" cases/main.cpp
forbid "mesh contact solver cases" '(hdf5|H5)' "HDF5's home is cases/results" "cases/results/.*"
forbid "mesh contact solver cases" 'zlib' "zlib's home is cases/files" "cases/files/.*"
forbid "mesh solver cases contact/solve contact/rollers contact/matching contact/loaded contact/stress" \
  boost "Boost has its homes in mesh/base/least.hpp, contact/half_space, contact/wedge and contact/flanks" \
  mesh/base/least.hpp
forbid "mesh solver contact cases" '(sys/|unistd|fcntl|c?signal)' \
  "the operating system is met in mesh/base, cases/files, cases/work and where processes start and end" \
  "(mesh/base|cases/files|cases/work)/.*|solver/parallel_session.cpp|cases/(process|report/make_report).cpp"
exit $status
