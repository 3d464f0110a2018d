#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# Cases that ask for an error instead of a level of accuracy.
source "$(dirname "$0")/shell.sh"
spur=$root/cases/parallel_axis/spur_tip_relief_23p6.toml
narrow=(--set pinion.face_width_mm=3 --set 'load.pinion_torque_Nm=[20]' --set pinion.lead_crown.amount_um=0)
sought() { # FOLDER ARGUMENTS...
  "$flank" run "$spur" "${narrow[@]}" "${@:2}" -o "$1" >screen 2>&1
}

# What states more is computed again, finer, and the results are those of a case that sets what was found to
# do.
sought target --accuracy 1% || { cat screen; fail "an error asked for"; }
[[ $(grep -c "^plan: " screen) -gt 1 ]] || { cat screen; fail "a finer try"; }
found='([a-z]+) level, ([0-9]+) by ([0-9]+) cells, ([0-9]+) positions'
read -r level slices cells positions <<<"$(
  sed -nE "s/^accuracy: 1 % .* stated: $found\$/\1 \2 \3 \4/p" target/summary.txt)"
sought as_said --accuracy "$level" --set contact_grid.slices="$slices" \
  --set contact_grid.profile_cells="$cells" --set mesh_cycle.positions="$positions" || fail "what it says"
for table in te error_estimate pairs; do
  cmp target/$table.csv as_said/$table.csv || fail "$table.csv of an error asked for"
done
/usr/bin/python3 -c '
import csv, statistics, sys
estimate, te = ([*csv.DictReader(l for l in open(p) if l[0] != "#")] for p in sys.argv[1:])
mean = statistics.fmean(float(row["te_um"]) for row in te)
sys.exit(not 0 < float(estimate[0]["mean_te_um"]) <= 0.01 * mean)
' target/error_estimate.csv target/te.csv || fail "states what was asked for"
mpirun --oversubscribe -n 2 "$flank" run "$spur" "${narrow[@]}" --accuracy 1% -o ranks >screen 2>&1 ||
  { cat screen; fail "sought on 2 ranks"; }
cmp target/te.csv ranks/te.csv || fail "2 ranks find the same"

# Killed at any moment, it goes on to the same results.
for part in 0.3 0.6 1.2; do
  FLANK_THREADS=1 timeout -s KILL $part "$flank" run "$spur" "${narrow[@]}" --accuracy 1% -o killed \
    --resume >screen 2>&1
done
sought killed --accuracy 1% --resume || { cat screen; fail "goes on"; }
cmp target/te.csv killed/te.csv || fail "the same after kills"

# Tries on one grid at the same positions differ by their bodies alone: none goes on from another's positions.
same_grid=(--set contact_grid.slices=9 --set contact_grid.profile_cells=15 --set mesh_cycle.positions=16)
sought by_bodies --accuracy 1% "${same_grid[@]}" || { cat screen; fail "finer bodies alone"; }
[[ $(grep -c "^plan: " screen) -eq 2 ]] || { cat screen; fail "two tries on one grid"; }
: >screen
"$flank" run "$spur" "${narrow[@]}" "${same_grid[@]}" --accuracy 1% -o other_bodies >screen 2>&1 &
until [[ $(grep -c "^plan: " screen) -eq 2 ]] || ! kill -0 $! 2>/dev/null; do sleep 0.01; done
kill -KILL $! 2>/dev/null
wait $! 2>/dev/null
[[ -n $(find other_bodies* .other_bodies* -name '*.journal' 2>/dev/null) ]] ||
  fail "the first try's positions are kept"
sought other_bodies --accuracy 1% "${same_grid[@]}" --resume ||
  { cat screen; fail "goes on with finer bodies"; }
cmp by_bodies/te.csv other_bodies/te.csv || fail "positions of the bodies that they are of"

# Where the case gives all elements and cells, levels differ by the near field's quadratures alone.
same_cells=("${same_grid[@]}" --set mesh.flank_rows=6 --set mesh.tooth_columns=4 --set mesh.rim_layers=4
  --set mesh.face_layers=4 --set mesh.fillet_rows=2 --set mesh.fillet_columns=2 --set mesh.degree=2)
sought by_quadratures --accuracy 1% "${same_cells[@]}"
[[ $? -eq 3 && $(grep -c "^plan: " screen) -gt 1 ]] || { cat screen; fail "finer quadratures alone"; }
: >screen
"$flank" run "$spur" "${narrow[@]}" "${same_cells[@]}" --accuracy 1% -o other_quadratures >screen 2>&1 &
until [[ $(grep -c "^plan: " screen) -ge 2 ]] || ! kill -0 $! 2>/dev/null; do sleep 0.01; done
kill -KILL $! 2>/dev/null
wait $! 2>/dev/null
[[ ! -e other_quadratures/te.csv ]] || fail "killed in a later try"
sought other_quadratures --accuracy 1% "${same_cells[@]}" --resume
cmp by_quadratures/te.csv other_quadratures/te.csv || fail "positions of the try that they are of"

# What cannot be had is said, beside what was found.
fixed=(--set contact_grid.slices=5 --set contact_grid.profile_cells=7 --set mesh_cycle.positions=4
  --set mesh.flank_rows=4 --set mesh.tooth_columns=4 --set mesh.rim_layers=4 --set mesh.face_layers=4)
sought missed --accuracy 0.05% "${fixed[@]}"
[[ $? -eq 3 ]] && grep -q "^failed: accuracy: 0.05 % of the mean" missed/summary.txt &&
  [[ -s missed/te.csv ]] || { cat screen; fail "an error that cannot be had"; }

# A grid that the case gives is not refined, and finer bodies do not help: one try.
coarse=(--set pinion.face_width_mm=10 --set 'load.pinion_torque_Nm=[20]' --set pinion.lead_crown.amount_um=60
  --set contact_grid.slices=9 --set contact_grid.profile_cells=7)
"$flank" run "$spur" "${coarse[@]}" --accuracy 1.2% -o coarse >screen 2>&1
[[ $? -eq 3 ]] && grep -Eq "1.2 % .* was asked for, [0-9.]+ % is stated: draft" coarse/summary.txt &&
  [[ $(grep -c "^plan: " screen) -eq 1 ]] || { cat screen; fail "a grid that is too coarse"; }

# Nothing can be stated of the coarsest there is, nor of unloaded gears: refused.
for never in contact_grid.profile_cells=5 mesh.rim_layers=1 'load.pinion_torque_Nm=[0]'; do
  sought never --accuracy 2% --set "$never"
  [[ $? -eq 2 && ! -e never && $(wc -l <screen) -eq 1 ]] && grep -q "accuracy.mean_te_percent = 2: " screen ||
    { cat screen; fail "an error that cannot be stated: $never"; }
done
# Three positions are no curve: nothing is stated of it, and no error is said to be reached.
sought three --accuracy 20% "${fixed[@]}" --set mesh_cycle.positions=3
[[ $? -eq 3 ]] && grep -q "was asked for, nothing is stated" three/summary.txt ||
  { cat screen; fail "an error of three positions"; }

[[ $(grep -c "^plan: " screen) -eq 1 ]] || { cat screen; fail "tries without any hope"; }

# Fields stay where they are in the mesh cycle, whatever positions are added.
none() { printf '0,%.0s' $(seq "$1"); }
cat >steps.toml <<END
scene = "parallel_axis"
[pair]
centre_distance_mm = 92.1
normal_module_mm = 2.0
normal_pressure_angle_deg = 20.0
helix_angle_deg = 12
[pinion]
teeth = 30
face_width_mm = 20.0
bore_diameter_mm = 30
fillet_radius_mm = 0.5
youngs_modulus_GPa = 207.0
poissons_ratio = 0.3
tip_relief = { amount_um = 60, start_diameter_mm = 64 }
lead_crown = { amount_um = 3.0 }
index_errors_um = [0, 3, 0, -2, $(none 26)]
runout = { amount_um = 5, angle_deg = 20 }
[gear]
like = "pinion"
teeth = 60
bore_diameter_mm = 50
index_errors_um = [0, 3, 0, -2, $(none 56)]
tip_relief = { amount_um = 60, start_diameter_mm = 125 }
[load]
pinion_torque_Nm = [5]
[misalignment]
in_plane_um = 3
[output]
fields = ["contact"]
field_positions = [8]
END
"$flank" run steps.toml --accuracy 2% --set output.root_stress=yes -o fields >screen 2>&1 ||
  { cat screen; fail "an error asked for, with fields"; }
[[ $(grep -c '^plan: ' screen) -gt 1 ]] && grep -Eq '^root stress at .*: pinion \+- [0-9.]+ %, gear' screen ||
  { cat screen; fail "root stress of the try that is good enough"; }
[[ $(grep -vc '^#' fields/te.csv) -gt 17 ]] || fail "no positions were added: nothing is tested"
grep -q 'timestep="0.5"' fields/fields/contact_5Nm.pvd || fail "the phase of the fields"

# What the case's own positions leave, with the least that is stated, is told before anything finer is tried.
"$flank" run "$spur" --set 'load.pinion_torque_Nm=[100]' --set mesh_cycle.positions=8 --accuracy 0.7% \
  -o own_positions >screen 2>&1
[[ $? -eq 3 && -s own_positions/te.csv && $(grep -c '^plan: ' screen) -eq 1 ]] &&
  grep -q "^failed: accuracy: 0.7 %.* is stated: draft level.* takes away leaves 0.7 %" screen ||
  { cat screen; fail "a target that nothing finer reaches"; }

# What there is no memory for ends the search; the results that there are stay.
if takes_limits; then
  (
    ulimit -v 1800000
    FLANK_THREADS=1 "$flank" run "$spur" --set 'load.pinion_torque_Nm=[100]' --set mesh_cycle.positions=8 \
      --accuracy 0.8% -o narrow >screen 2>&1
  )
  [[ $? -eq 3 && -s narrow/te.csv ]] && grep -q "^failed: accuracy: 0.8 %.* finer: this run would" screen ||
    { cat screen; fail "too little memory for a finer try"; }
fi

"$flank" plan "$spur" --accuracy 2% >screen && grep -q "first try of 2 %" screen &&
  [[ $(grep -cE "^  (draft|standard|reference) +[0-9.]+ s" screen) -eq 3 ]] ||
  { cat screen; fail "its plan"; }
"$flank" check "$spur" --set 'accuracy={mean_te_percent=2}' >/dev/null || fail "its check"
"$flank" run "$spur" --accuracy 2% --set output.error_estimate=no -o none 2>message
[[ $? -eq 2 ]] && grep -q "mean_te_percent = 2: contradicts" message || fail "no estimate to reach it by"
for wrong in 0% -1% x% 0.01% %; do
  "$flank" run "$spur" --accuracy=$wrong -o none 2>message
  [[ $? -eq 2 && $(wc -l <message) -eq 1 ]] || { cat message; fail "--accuracy $wrong"; }
done
"$flank" study "$root/cases/parallel_axis/wagaj_kahraman_2002/fig12.toml" --accuracy 1% -o none 2>message
[[ $? -eq 2 ]] && grep -q "is of runs" message || { cat message; fail "a study has levels"; }
[[ ! -e none ]] || fail "nothing is written"
"$flank" plan "$root/cases/parallel_axis/wagaj_kahraman_2002/fig12.toml" --accuracy 1% >screen &&
  grep -q "first try of 1 %" screen && grep -q "^flank study: refused: .*is of runs" screen ||
  { cat screen; fail "the plan of a run, where a study is refused"; }
echo "1 passed, 0 failed"
