#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# What is kept on disk is known by the sources that it comes from: a change of any of them is seen,
# found by what includes what, not by a list. And no line of a source or a script is longer than 110 columns.
# Usage: sources.sh ROOT
set -u
root=$1 work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "FAILED: $1"; exit 1; }

# Lines: of all that is compiled or run; data and texts are free, and so is a file that a planted fault is in.
folders=(CMakeLists.txt .ci mesh solver contact cases tests validation)
mapfile -t files < <(cd "$root" && find "${folders[@]}" -path '*/fuzz/corpus' -prune -o -type f \
  \( -name '*.?pp' -o -name '*.py' -o -name '*.sh' -o -name '*.slurm' -o -name '*.cmake' -o -name '*.in' \
  -o -name CMakeLists.txt -o -name run \) -print)
[[ ${#files[@]} -gt 300 ]] || fail "the sources are not there: ${#files[@]} files"
for file in "${files[@]}"; do
  grep -q 'flank_planted("[a-z0-9]' "$root/$file" && continue
  LC_ALL=C.UTF-8 grep -anE '.{111}' "$root/$file" | sed "s|^|$file:|"
done >"$work/long"
[[ ! -s $work/long ]] || { cat "$work/long"; fail "lines of more than 110 columns"; }

# Fingerprints.
mkdir "$work/tree"
cp -r "$root"/{CMakeLists.txt,README.md,mesh,solver,contact,cases} "$work/tree"
fingerprints() {
  cmake -DROOT="$work/tree" -DOUT="$work/revision.hpp" -P "$work/tree/cases/revision.cmake" 2>/dev/null ||
    fail "revision.cmake"
  sed -n "s/.*flank_$1_sources = \"\(.*\)\";/\1/p" "$work/revision.hpp"
}
operator=$(fingerprints operator) program=$(fingerprints program)
[[ ${#operator} -eq 64 && ${#program} -eq 64 && $operator != "$program" ]] || fail "fingerprints"
changed() { # FILE OPERATOR PROGRAM: whether a change is to be seen
  [[ -f $work/tree/$1 ]] || fail "$1 is not there any more"
  cp "$work/tree/$1" "$work/kept"; echo "// changed" >>"$work/tree/$1"
  [[ $2 == yes ]] && expected=!= || expected===
  test "$(fingerprints operator)" $expected "$operator" || fail "$1: operators seen to change: not $2"
  [[ $3 == yes ]] && expected=!= || expected===
  test "$(fingerprints program)" $expected "$program" || fail "$1: results seen to change: not $3"
  cp "$work/kept" "$work/tree/$1"
}
for file in mesh/gear/involute.cpp mesh/segment/gmsh_section.cpp solver/libraries/dealii_body.cpp \
    solver/reduction/ring.cpp cases/work/packing.hpp contact/half_space/half_space.cpp \
    contact/matching/source_table.cpp cases/work/operator_image.cpp cases/work/operator_cache.cpp; do
  changed $file yes yes
done
for file in contact/solve/simplex_solver.cpp contact/solve/nested_contact.cpp contact/loaded/loaded_pair.cpp \
    contact/loaded/position_grid.cpp cases/parallel_axis/pair/position_record.cpp cases/study/study_work.hpp \
    contact/rollers/drive_position.cpp contact/rollers/roller_contact.cpp cases/work/journal.cpp; do
  changed $file no yes
done
changed README.md no no
changed cases/README.md no no
echo "1 passed, 0 failed"
