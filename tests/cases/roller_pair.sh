#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# Two rollers pressed together as a user meets them: check, plan, reports, and wrong input in one line.
# The numbers: recomputed, roller_pair_test.
source "$(dirname "$0")/shell.sh"
crowned=$root/cases/roller_pair/crowned.toml

"$flank" check "$crowned" >screen || fail "check"
grep -q "100 N: Hertz, ellipse 3.3803 x 0.10991 mm, pressure 514.06 MPa" screen ||
  fail "Hertz's formulas in check"
"$flank" check "$crowned" --set first_roller.crown_radius_mm=1e7 \
    --set first_roller.straight_length_mm=2 >screen ||
  fail "check"
grep -q "no closed form: a crown has a straight part" screen ||
  fail "a crown with a straight part has no closed form"
"$flank" check "$crowned" --set load.normal_force_N=5000 >screen &&
  grep -q "no closed form: the rollers' ends cut Hertz's ellipse" screen ||
  fail "an ellipse longer than the rollers"
"$flank" plan "$crowned" >screen || fail "plan"
grep -q "5 contacts of 32 by 48 cells" screen && grep -q "Left out" screen && grep -q "operations" screen ||
  fail "plan"

"$flank" run "$crowned" --set 'load.normal_force_N=[0, 50, 5000]' -o run >screen 2>message || fail "run"
mpirun --oversubscribe --allow-run-as-root -n 2 "$flank" run "$crowned" \
  --set 'load.normal_force_N=[0, 50, 5000]' -o ranks >screen 2>&1 ||
  fail "run on two ranks"
FLANK_THREADS=1 "$flank" run "$crowned" --set 'load.normal_force_N=[5000, 50]' -o other >screen 2>&1 ||
  fail "run"
cmp run/contact.csv ranks/contact.csv || fail "two ranks: contact.csv"
/usr/bin/python3 - run/results.h5 ranks/results.h5 <<'END' || fail "two ranks: results.h5"
import sys, h5py
def content(path):
    found = {}
    def keep(name, item):
        if isinstance(item, h5py.Dataset) and name != "stages/seconds":  # wall times
            found[name] = item[()].tobytes() if item.dtype != object else item[()]
    h5py.File(path).visititems(keep)
    return found
one, other = map(content, sys.argv[1:])
sys.exit(not (one == other and len(one) > 20 and "stages/stage" in one))
END
cmp <(grep ^0,50, run/contact.csv) <(grep ^0,50, other/contact.csv) || fail "a force alone is as among others"
"$flank" run "$crowned" --set 'load.normal_force_N=[0, 50, 5000]' -o run --resume >screen 2>&1 &&
  grep -q "nothing to do" screen || fail "resume"
"$flank" run "$crowned" --set 'load.normal_force_N=[50, 1e9]' -o some >screen 2>message
[[ $? -eq 3 ]] && grep -q "^failed: 1e+09 N has no results: .*lower load.normal_force_N" screen message &&
  cmp <(grep ^0,50, run/contact.csv) <(grep ^0,50, some/contact.csv) ||
  fail "a force too high loses the others"
"$flank" report run >screen || fail "report"
for name in approach_over_force pressure_over_force stiffness_over_force subsurface contact_pressure; do
  [[ -s run/figures/$name.svg && -s run/figures/$name.csv ]] || fail "figure $name"
done
grep -q "Two rollers pressed together, run: 3 forces" run/report.html || fail "the report's subject"
/usr/bin/python3 - <<'END' || fail "the cells of the figure of pressures"
import csv, h5py
rows = [*csv.DictReader(line for line in open("run/figures/contact_pressure.csv") if line[0] != "#")]
maps = h5py.File("run/results.h5")["pressure_maps"]
cells = max(maps.values(), key=lambda cells: cells["pressure"][:].max())
for axis, column in (("x", "across_mm"), ("y", "along_mm")):
    places = [float(row[column]) for row in rows]
    for end in (min, max):
        assert abs(end(places) - end(cells[axis][:])) < 1e-6, (column, end(places), end(cells[axis][:]))
END
cat "$crowned" - >study.toml <<'END'
[[study]]
set = "first_roller.crown_radius_mm"
values = [500, 1500, 3]
END
"$flank" study study.toml -o study >screen 2>message
[[ $? -eq 3 ]] || fail "study with a variant that is refused"
grep -q "^2,3,failed: .*must be at least half of the length" study/designs.csv ||
  grep -q '^2,3,"failed: .*must be at least half of the length' study/designs.csv ||
  fail "why a variant has no result"
"$flank" report study >screen && [[ -s study/figures/variants.csv ]] || fail "report of a study"
"$flank" plan study.toml >screen && grep -q "15 contacts" screen || fail "plan of a study"

# Free ends: told in plan, table and summary; two ranks give the same bytes, and the report takes them.
free=(--set 'load.normal_force_N=[50, 5000]' --set 'rollers.ends="free"')
"$flank" plan "$crowned" "${free[@]}" >screen && grep -q "free ends of both rollers" screen ||
  fail "plan of free ends"
"$flank" run "$crowned" "${free[@]}" -o free >screen 2>&1 || fail "free ends"
mpirun --oversubscribe --allow-run-as-root -n 2 "$flank" run "$crowned" "${free[@]}" -o free2 >screen 2>&1 ||
  fail "free ends on two ranks"
cmp free/contact.csv free2/contact.csv || fail "free ends on two ranks: contact.csv"
grep -q "singular, the longer roller goes on; .* power -0.226, times 0 [1-9]" free/summary.txt ||
  fail "the power of the pressure at free ends"
/usr/bin/python3 - run/contact.csv free/contact.csv <<'END' || fail "free ends far from the contact"
import csv, sys
def by_force(path):
    rows = csv.DictReader(line for line in open(path) if line[0] != "#")
    return {float(row["force_N"]): row for row in rows}
half_space, free = map(by_force, sys.argv[1:])
pressure = lambda row: float(row["max_pressure_MPa"])
near = abs(pressure(free[50]) / pressure(half_space[50]) - 1) < 5e-3  # far from the ends of a crowned roller
sys.exit(not (near and half_space[50]["end_power"] == "" and float(free[50]["end_power"]) < -0.2))
END
"$flank" run "$crowned" "${free[@]}" --set second_roller.length_mm=12 -o equal >screen 2>&1 &&
  grep -q "finite, both rollers end there" equal/summary.txt || fail "free ends of equal rollers"
"$flank" report free >screen || fail "report of free ends"

refused() { # WORDS SETTING...
  local words=$1 settings=(); shift
  for setting in "$@"; do settings+=(--set "$setting"); done
  "$flank" run "$crowned" "${settings[@]}" -o refused >screen 2>message
  [[ $? -eq 2 && ! -e refused && $(wc -l <message) -eq 1 ]] && grep -qF -- "$words" message ||
    { cat message; fail "not refused: $*"; }
}
refused "first_roller.straight_length_mm = 12: must be less than the length" \
  first_roller.straight_length_mm=12
refused "second_roller.straight_length_mm = 3: has no effect without crown_radius_mm" \
  second_roller.straight_length_mm=3
refused "first_roller.crown_radius_mm = 5: must be at least half of the length" first_roller.crown_radius_mm=5
refused "roller_grid.cells_across = 17: must be even" roller_grid.cells_across=17
refused "belongs to scene = \"parallel_axis\"" pinion.teeth=20
refused 'rollers.ends = "free": free needs parallel axes' 'rollers.ends="free"' axes.crossing_angle_deg=5
refused 'rollers.ends = "free": free needs a contact that is longer along the axes' 'rollers.ends="free"' \
  first_roller.crown_radius_mm=6.1 second_roller.radius_mm=1000
refused "out of bounds" second_roller.radius_mm=0
refused "out of bounds" axes.crossing_angle_deg=181
"$flank" run "$crowned" --set 'load.normal_force_N=[1e9]' -o wide >screen 2>message
[[ $? -eq 3 && ! -e wide/contact.csv ]] || fail "exit code"
grep -q "half-space holds no longer" message || fail "a contact as wide as a roller"
