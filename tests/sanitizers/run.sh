# SPDX-License-Identifier: GPL-2.0-or-later
# Sourced by tests/run --sanitize; $root is the checkout. Of its three parts (gcc, clang, memcheck) the first
# argument can name one alone; other arguments go to ctest.
# Fewer random cases and no kills at random moments (both take long, and find what the plain build finds
# too). Left out is what runs no compiled code of ours, allocation_test, which counts what malloc is
# asked for in a malloc of its own, as the sanitizers do, and studies of convergence, which run the same
# code on finer meshes.
export FLANK_KILLS=0 FLANK_RANDOM_CASES=4 FLANK_PATIENCE=400
of_convergence=(ProjectedSplit.OwnComplianceAgainstElementsThatResolveThePatch
                Loaded.EveryDegreeOfElementConvergesOnTheSameTransmissionError)
export GTEST_FILTER="-Convergence.*$(printf ':%s' "${of_convergence[@]}")"
parts=(gcc clang memcheck)
if [[ " ${parts[*]} " == *" ${1:-none} "* ]]; then
  parts=("$1")
  shift
elif [[ -n ${1:-} && $1 != -* ]]; then
  echo "there is no part \"$1\"; there are: ${parts[*]}" >&2
  exit 2
fi
flank_install "${test_packages[@]}" clang libclang-rt-dev llvm valgrind
failed=()

# sanitized_tests FOLDER LEAKS [CTEST_ARGUMENT]...: LEAKS 0: they are not looked for.
sanitized_tests() {
  local folder=$1 options="log_path='$1/reports/report'" leaks=$2
  shift 2
  ASAN_OPTIONS="$options:detect_leaks=$leaks:${ASAN_OPTIONS:-}" UBSAN_OPTIONS="$options:${UBSAN_OPTIONS:-}" \
    ctest --test-dir "$folder" --parallel 2 --no-tests=error --output-on-failure \
    -E "^(report_faults|sources|includes_run_one_way)$" "$@"
}

# sanitize NAME COMPILER [CTEST_ARGUMENT]...: builds in build/sanitize-NAME and tests there.
# Reports go to files, because some tests throw away what the program says.
sanitize() {
  local name=$1 compiler=$2 flank_folder=sanitize-$1 folder=$root/build/sanitize-$1 report
  shift 2
  # clang++ compiles each file alone: what it includes must be enough.
  flank_build Release all FLANK_TESTS=ON FLANK_SANITIZE=ON CMAKE_CXX_COMPILER="$(command -v "$compiler")" \
    CMAKE_UNITY_BUILD="$([[ $name == clang ]] && echo OFF || echo ON)"
  echo "tests, AddressSanitizer and UndefinedBehaviorSanitizer of $compiler"
  rm -rf "$folder/reports"
  mkdir "$folder/reports"
  # The search for leaks ends by a signal of its own on some machines, always or now and then.
  local leaks=1 untold
  if { "$folder/contact_test" --gtest_filter='Certificate.*' 2>&1 || true; } | grep -q "Tracer caught"; then
    echo "the search for leaks does not work here: switched off"
    leaks=0
  fi
  if ! sanitized_tests "$folder" $leaks "$@"; then
    untold=$(grep -ls "Tracer caught" "$folder"/reports/* |
      xargs -r grep -LE "ERROR: AddressSanitizer|runtime error" || true)
    if [[ -n $untold ]]; then
      echo "the search for leaks failed $(wc -w <<<"$untold") times: failed tests again without it"
      xargs rm <<<"$untold"
    fi
    [[ -n $untold ]] && sanitized_tests "$folder" 0 --rerun-failed || failed+=("tests of $flank_folder")
  fi
  for report in "$folder"/reports/*; do
    [[ -s $report ]] || continue
    cat "$report"
    failed+=("$report")
  done
}

memcheck() {
  # For any processor: valgrind does not know the newest instructions.
  flank_folder=memcheck flank_build Debug solver_test FLANK_TESTS=ON FLANK_PORTABLE=ON
  echo "contact solver, memcheck of valgrind"
  valgrind --quiet --leak-check=full --error-exitcode=9 "$root/build/memcheck/solver_test" --gtest_brief=1 ||
    failed+=("solver_test under valgrind")
}

for part in "${parts[@]}"; do
  case $part in
    gcc) sanitize gcc g++ "$@" ;;
    clang) sanitize clang clang++ "$@" ;;
    memcheck) memcheck ;;
  esac
done
if [[ ${#failed[@]} -gt 0 ]]; then
  printf 'FAILED: %s\n' "${failed[@]}"
  exit 1
fi
echo "no findings"
