#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# Studies as a user meets them: the same tables on any number of ranks and after any number of stops,
# one reduction a distinct body.
source "$(dirname "$0")/shell.sh"
small=(--accuracy draft --set mesh_cycle.positions=4 --set contact_grid.slices=9
  --set mesh.face_layers=4
  --set 'load.pinion_torque_Nm=[0,50,100,200]' --set output.error_estimate=no)
case_with() { cat "$root/cases/parallel_axis/helical.toml" - >"$1"; }
same() {
  for file in designs.csv te.csv study.h5 summary.txt; do cmp "$1/$file" "$2/$file" || fail "$3: $file"; done
}
ranks() { local n=$1; shift; mpirun --oversubscribe --allow-run-as-root -n "$n" "$@"; }

case_with modifications.toml <<'END'
[[study]]
set = "pinion.tip_relief.amount_um"
from = 0
to = 10
count = 5
[[study]]
set = ["pinion.lead_crown.amount_um", "pinion.profile_crown.amount_um"]
rows = [[0, 1], [2.0, 0]]
[[study]]
set = "pinion.tip_relief.shape"
values = ["linear", "quadratic"]
END
"$flank" plan modifications.toml "${small[@]}" >screen || fail "plan"
grep -q "20 variants of 4 keys" screen && grep -q "1 distinct body$" screen &&
  grep -q "320 contact solutions" screen || fail "plan counts bodies and solutions"
"$flank" study modifications.toml "${small[@]}" -o one >screen 2>progress || fail "study"
grep -q "20 variants, 0 failed" screen && grep -q "pieces, about" progress || fail "summary and progress"
[[ $(grep -vc '^#' one/designs.csv) -eq 81 && $(grep -vc '^#' one/te.csv) -eq 321 ]] ||
  fail "rows of the tables"
[[ $(find cache -name '*.operator' | wc -l) -le 1 && $(find cache -type f | wc -l) -eq 1 ]] ||
  fail "what changes gaps alone was reduced once"
grep -q "^3,0,2,0,quadratic,ok,200," one/designs.csv || fail "the last axis is the fastest"
for n in 2 4; do
  ranks $n "$flank" study modifications.toml "${small[@]}" -o ranks$n >/dev/null 2>message ||
    fail "study on $n ranks"
  same one ranks$n "$n ranks"
done

# Four positions show two harmonics: the fields of the others are empty, not zero.
[[ $(grep -v '^#' one/designs.csv | awk -F, 'NR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i }
  NR == 9 { print ($at["A1_um"] != "") ($at["A2_um"] != "") ($at["A3_um"] == "") ($at["A5_um"] == "") }'
  ) == 1111 ]] ||
  fail "harmonics that the positions do not show"

# A variant of the study is the run of that case.
"$flank" run modifications.toml "${small[@]}" --set pinion.tip_relief.amount_um=5 \
    --set pinion.lead_crown.amount_um=2.0 --set pinion.profile_crown.amount_um=0 \
    -o single >/dev/null 2>message ||
  fail "run of a case with axes"
grep -q "without its \[\[study\]\] axes" message || fail "a run says that axes are left out"
columns() {
  grep -v '^#' "$2" |
    awk -F, -v v="$1" 'NR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i; next }
      $1 == v { print $at["torque_Nm"], $at["position"], $at["te_um"], $at["max_pressure_MPa"],
                $at["edge_pressure_MPa"], $at["mesh_stiffness_N_per_um"], $at["contacts"] }'
}
cmp <(columns 10 one/te.csv) <(columns 0 single/te.csv) || fail "a variant differs from its run"
/usr/bin/python3 - <<'END' || fail "design torques of a variant, to the last digit those of its run"
import csv
read = lambda path: [*csv.DictReader(line for line in open(path) if line[0] != "#")]
variant = next(row for row in read("one/designs.csv") if row["variant"] == "10")
for by in ("A1", "peak_to_peak"):
    of_run = [row["torque_Nm"] for row in read("single/design_torques.csv") if row["by"] == by]
    assert variant[f"T_d_by_{by}_Nm"] == ";".join(of_run), (variant, of_run)
assert variant["T_d_by_A1_Nm"] or variant["T_d_by_peak_to_peak_Nm"], "no design torque: nothing is tested"
END
# A variant that cannot be made is recorded, the first one too.
case_with first.toml <<<$'[[study]]\nset = "pinion.bore_diameter_mm"\nvalues = [140.0, 61.0]'
"$flank" study first.toml "${small[@]}" --set 'gear.bore_diameter_mm=61' -o first >/dev/null 2>&1
[[ $? -eq 3 ]] || fail "a first variant that cannot be made"
"$flank" study first.toml "${small[@]}" --set 'gear.bore_diameter_mm=61' -o first --resume >screen 2>&1
[[ $? -eq 3 ]] && grep -q "^failed: variant 0: .*bore too large" screen ||
  fail "a failed variant gone on with"
grep -q '^0,140.*failed: .*bore too large' first/designs.csv && grep -q '^1,61.*,ok,' first/designs.csv ||
  fail "a first variant that cannot be made: designs.csv"
# A load without a solution leaves the others as they are without it, their estimates and what is asked of
# the first variant too, on any number of ranks; so in a report, and in a study of drives.
case_with crowns.toml <<<$'[[study]]\nset = "pinion.lead_crown.amount_um"\nvalues = [2.0, 4.0]'
both=("${small[@]}" --set output.error_estimate=every_variant --set output.subsurface_stress=yes)
for n in 1 2; do
  ranks $n "$flank" study crowns.toml "${both[@]}" --set 'load.pinion_torque_Nm=[100,1e9,50]' \
    -o lost_$n >screen 2>message
  [[ $? -eq 3 ]] && grep -q "^study: 2 variants, 0 failed, 2 without some loads" screen &&
    grep -q "^failed: variant 1, 1e+09 N m has no results: .*lower the torque" screen ||
    { cat screen message; fail "a load without a solution, $n ranks"; }
done
same lost_1 lost_2 "a load without a solution on two ranks"
"$flank" study crowns.toml "${both[@]}" --set 'load.pinion_torque_Nm=[100,50]' -o not_lost >/dev/null 2>&1 ||
  fail "the same without that load"
for file in te.csv error_estimate.csv error_estimates.csv subsurface.csv; do
  cmp lost_1/$file not_lost/$file || fail "a load without a solution changes others: $file"
done
cmp <(grep -v ',"failed: ' lost_1/designs.csv) not_lost/designs.csv &&
  [[ $(grep -c '^[01],[24],"failed: .*",1e+09,,' lost_1/designs.csv) -eq 2 ]] ||
  fail "a load without a solution: designs.csv"
"$flank" report lost_1 >screen 2>&1 || { cat screen; fail "report of a study without a load"; }
cat "$root/cases/double_roller/exact.toml" - >drives.toml \
  <<<$'[[study]]\nset = "drive.width_mm"\nvalues = [10, 12]'
few=(--set mesh_cycle.crank_angles_deg.to=4 --set mesh_cycle.crank_angles_deg.step=2)
"$flank" study drives.toml "${few[@]}" --set 'load.output_torque_Nm=[1e7,5]' -o lost_drives >/dev/null 2>&1
[[ $? -eq 3 ]] || fail "drives with a torque too high"
"$flank" study drives.toml "${few[@]}" --set 'load.output_torque_Nm=[5]' -o drives >/dev/null 2>&1 ||
  fail "drives"
cmp drives/te.csv lost_drives/te.csv || fail "a torque too high changes a drive's others"
# An input among unfinished work is not cleared away with it.
mkdir -p unfinished_input; cp modifications.toml parts.toml
"$flank" study parts.toml "${small[@]}" --part 1/2 -o unfinished_input/out >/dev/null 2>&1 || fail "a part"
mkdir -p unfinished_input/out/unfinished/new
printf 'pinion.lead_crown.amount_um\n1\n' >unfinished_input/out/unfinished/new/te.csv
case_with inside.toml <<<$'[[study]]\nfile = "unfinished_input/out/unfinished/new/te.csv"'
"$flank" study inside.toml "${small[@]}" -o unfinished_input/out --force >/dev/null 2>message
[[ $? -eq 2 && -s unfinished_input/out/unfinished/new/te.csv ]] && grep -q "lies in" message ||
  { cat message; fail "an input among unfinished work"; }
# So is one of another centre distance: its cells lie elsewhere.
case_with apart.toml <<<$'[[study]]\nset = "pair.centre_distance_mm"\nvalues = [150.0, 150.3]'
"$flank" study apart.toml "${small[@]}" -o apart >/dev/null 2>&1 || fail "study of centre distances"
"$flank" run apart.toml "${small[@]}" --set pair.centre_distance_mm=150.3 -o apart_single >/dev/null 2>&1 ||
  fail "run of a centre distance"
cmp <(columns 1 apart/te.csv) <(columns 0 apart_single/te.csv) ||
  fail "a variant of another centre distance differs from its run"
# What a case asks for of every position, a study has of its first variant: as the run of that one,
# on any number of ranks, after a stop.
asked=("${small[@]}" --set 'load.pinion_torque_Nm=[100]' --set output.error_estimate=yes
  --set output.subsurface_stress=yes --set output.root_stress=yes --set output.light_load_pattern=yes)
"$flank" study apart.toml "${asked[@]}" -o asked >screen 2>&1 ||
  { cat screen; fail "study with outputs of its first variant"; }
"$flank" run apart.toml "${asked[@]}" -o asked_single >/dev/null 2>&1 || fail "run with the same outputs"
ranks 2 "$flank" study apart.toml "${asked[@]}" -o asked_2 >/dev/null 2>&1 || fail "the same on two ranks"
for file in error_estimate subsurface root_stress; do
  cmp asked/$file.csv asked_single/$file.csv && cmp asked/$file.csv asked_2/$file.csv ||
    fail "$file of the first variant"
done
cmp asked/study.h5 asked_2/study.h5 || fail "their groups in study.h5"
[[ ! -e asked/pattern.csv ]] && grep -q "^of variant 0:" screen &&
  grep -q "^results with their errors" screen ||
  fail "the summary has the first variant's"
cmp <(columns 0 asked/te.csv) <(columns 0 asked_single/te.csv) || fail "the variants of such a study"
"$flank" plan apart.toml "${asked[@]}" >screen && grep -q "of the first variant, from its positions" screen ||
  fail "plan of such a study"
# Of every variant where the case says so: what the runs of them say, on any number of ranks.
every=("${small[@]}" --set 'load.pinion_torque_Nm=[50, 100]' --set output.error_estimate=every_variant)
"$flank" study apart.toml "${every[@]}" -o every >screen 2>&1 ||
  { cat screen; fail "estimates of all variants"; }
ranks 2 "$flank" study apart.toml "${every[@]}" -o every_2 >/dev/null 2>&1 || fail "the same on two ranks"
for variant in 0 1; do
  "$flank" run apart.toml "${every[@]}" --set pair.centre_distance_mm=150.$((3 * variant)) \
    -o every_$variant.single >/dev/null 2>&1 || fail "run of variant $variant with its estimate"
  cmp <(grep "^$variant," every/error_estimates.csv) \
    <(sed -n "s/^0,/$variant,/p" every_$variant.single/error_estimate.csv) ||
    fail "estimate of variant $variant"
done
cmp every/error_estimate.csv every_0.single/error_estimate.csv && cmp every/study.h5 every_2/study.h5 &&
  cmp every/error_estimates.csv every_2/error_estimates.csv ||
  fail "estimates beside that of the first variant"
"$flank" plan apart.toml "${every[@]}" >screen && grep -q "estimates of all other variants" screen ||
  fail "plan of all estimates"
# Also where the first variant has no results.
"$flank" study first.toml "${every[@]}" --set 'gear.bore_diameter_mm=61' -o every_first >screen 2>&1
[[ $? -eq 3 && $(grep -c '^1,' every_first/error_estimates.csv) -eq 2 ]] &&
  ! grep -q '^0,' every_first/error_estimates.csv && [[ ! -e every_first/error_estimate.csv ]] ||
  { cat screen; fail "estimates beside a first variant that failed"; }
# Its positions are solved once, among those of all variants: what its outputs need of them is kept, whoever
# solved them; what was damaged there is solved again.
once=("${asked[@]}" --set output.error_estimate=no)
for k in 2 1; do
  "$flank" study apart.toml "${once[@]}" --part $k/2 -o once >screen 2>&1 ||
    { cat screen; fail "part $k of a study with outputs of its first variant"; }
done
grep -q "is done, 4 of 4 pieces" screen || { cat screen; fail "pieces alone are counted"; }
cp -r once damaged
read -r journal at < <(grep -abo "position 2 of 4, 1 mesh cycles" damaged/unfinished/*.journal |
  sed -E 's/:([0-9]+):.*/ \1/')
((at += 400))
byte=$(od -An -tu1 -j $at -N 1 "$journal")
printf "\\$(printf %03o $((255 - byte)))" | dd of="$journal" bs=1 seek=$at conv=notrunc 2>/dev/null ||
  fail "a record of the first variant"
without_bounds() { # which one of them was not asked for: the last of root_stress.csv, seven of designs.csv
  case $1 in
    */root_stress.csv) grep -v '^#' "$1" | cut -d, -f1-9 ;;
    */designs.csv) /usr/bin/python3 -c 'import csv, sys
for row in csv.DictReader(line for line in sys.stdin if line[0] != "#"):
    print([value for key, value in row.items() if "bound" not in key and key != "pressure_kind"])' <"$1" ;;
    *) cat "$1" ;;
  esac
}
for kind in once damaged; do
  ranks 2 "$flank" study apart.toml "${once[@]}" -o $kind --resume >screen 2>&1 ||
    { cat screen; fail "$kind: outputs of the first variant"; }
  [[ $(grep -c "contact: " screen) -eq $([[ $kind == once ]]; echo $?) ]] ||
    { cat screen; fail "$kind: how many positions were solved again"; }
  for file in subsurface.csv root_stress.csv te.csv designs.csv; do
    cmp <(without_bounds asked/$file) <(without_bounds $kind/$file) || fail "$kind: $file"
  done
done
# Without errors of single teeth a hunting period is its mesh cycle many times: a harmonic of the mesh
# has another number there.
case_with hunting.toml <<<$'[[study]]\nset = "pinion.tip_relief.amount_um"\nvalues = [5, 10]'
for period in mesh hunting; do
  "$flank" study hunting.toml "${small[@]}" --set mesh_cycle.period=$period --set mesh_cycle.positions=3 \
      -o period_$period >/dev/null 2>message ||
    { cat message; fail "study of a $period period"; }
done
designs() {
  grep -v '^#' "$1/designs.csv" |
    awk -F, 'NR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i; next }
      { printf "%s %s %.5f %.5f\n", $at["variant"], $at["torque_Nm"], $at["A1_um"], $at["peak_to_peak_um"] }'
}
cmp <(designs period_mesh) <(designs period_hunting) || fail "a study of a hunting period without errors"

# Killed at any moment, on any number of ranks, and gone on with; stopped by a signal.
longer=("${small[@]}" --set mesh_cycle.positions=48)
"$flank" study modifications.toml "${longer[@]}" -o whole >/dev/null 2>&1 || fail "longer study"
began() {
  for _ in $(seq 6000); do
    [[ $(cat "$1"/unfinished/*.journal 2>/dev/null | wc -c) -gt $2 ]] && return
    sleep 0.01
  done
  fail "no piece was finished in a minute"
}
mkdir killed
for bytes in 10000 60000; do
  setsid "$flank" study modifications.toml "${longer[@]}" -o killed --resume >/dev/null 2>&1 & pid=$!
  began killed $bytes; sleep 0.0$((RANDOM % 10)); kill -9 $pid; wait $pid 2>/dev/null
  [[ ! -e killed/designs.csv ]] || fail "it was not killed in time"
done
ranks 2 "$flank" study modifications.toml "${longer[@]}" -o killed --resume >/dev/null 2>message ||
  fail "resume"
same whole killed "killed and gone on with"
[[ -z $(find killed -name '*.journal') ]] || fail "the journal is gone when the tables are there"
"$flank" study modifications.toml "${longer[@]}" -o stopped >screen 2>message & pid=$!
began stopped 20000; kill -TERM $pid; wait $pid
[[ $? -eq 4 ]] && grep -q "go on with --resume" screen || fail "SIGTERM stops cleanly"
"$flank" study modifications.toml "${longer[@]}" --set pinion.profile_slope.amount_um=1 \
  -o stopped --resume 2>message
[[ $? -eq 2 ]] && grep -q "profile_slope" message || fail "changed inputs are refused by name"
sed 's/\[0, 1\]/[0, 3]/' modifications.toml >changed.toml
"$flank" study changed.toml "${longer[@]}" -o stopped --resume 2>message
[[ $? -eq 2 ]] && grep -q "(0, 3)" message || fail "changed axes are refused by name"
"$flank" study modifications.toml "${longer[@]}" -o stopped --resume >/dev/null 2>&1 ||
  fail "resume after SIGTERM"
same whole stopped "stopped and gone on with"
sed "s#measured_flank.csv#$work/measured.csv#" "$root/cases/parallel_axis/as_made.toml" >measured.toml
sed -i 's/period = "hunting"/period = "mesh"/' measured.toml
cat >>measured.toml <<'END'
[[study]]
set = "pinion.lead_crown.amount_um"
values = [1, 2]
END
cp "$root/cases/parallel_axis/measured_flank.csv" measured.csv
"$flank" study measured.toml "${small[@]}" --part 1/2 -o measured >/dev/null 2>message ||
  { cat message; fail "a part of a study of a measured flank"; }
sed -i '$s/[0-9.]*$/9.9/' measured.csv
"$flank" study measured.toml "${small[@]}" -o measured --resume 2>message
[[ $? -eq 2 ]] && grep -q "content of pinion.topography.file" message ||
  { cat message; fail "a changed measured flank is refused"; }
# Measured flanks of variants: each is known by its name, also one that is a copy of another.
flat() { printf 'removed_um(roll_angle_deg,z_mm),-10,10\n14,%s,%s\n28,%s,%s\n' "$1" "$1" "$1" "$2"; }
case_with flanks.toml <<<$'[[study]]\nset = "pinion.topography.file"\nvalues = ["a.csv", "b.csv", "c.csv"]'
flat 0 4 >a.csv; flat 2 0 >b.csv; flat 0 4 >c.csv
"$flank" study flanks.toml "${small[@]}" --part 1/2 -o flanks >/dev/null 2>message ||
  { cat message; fail "a part of a study over measured flanks"; }
flat 2 0 >c.csv
"$flank" study flanks.toml "${small[@]}" --part 2/2 -o flanks >/dev/null 2>message
[[ $? -eq 2 ]] && grep -q "file c.csv" message ||
  { cat message; fail "a measured flank that was a copy of one, and is now of another"; }
"$flank" study flanks.toml "${small[@]}" -o flanks_now >/dev/null 2>message ||
  fail "study over measured flanks"
rm c.csv
"$flank" study flanks.toml "${small[@]}" -o flanks_now --resume >/dev/null 2>message
[[ $? -eq 2 ]] && grep -q "file c.csv" message ||
  { cat message; fail "a measured flank that is gone, of a finished study"; }
# A list stands in one cell of a table of designs, in quotes.
errors="[$(printf '0.1, %.0s' {1..49})0]"
printf 'pinion.lead_crown.amount_um,pinion.index_errors_um\n1,"%s"\n2,"%s"\n3,"%s"\n' \
  "$errors" "$errors" "$errors" >lists.csv
case_with lists.toml <<<$'[[study]]\nfile = "lists.csv"'
"$flank" plan lists.toml "${small[@]}" >screen 2>&1 && grep -q "3 variants" screen ||
  { cat screen; fail "lists in a table of designs"; }
# A measured flank that changes while the study lasts: all is of what was read first.
case_with lasting.toml <<'END'
[[study]]
set = "pinion.topography.file"
values = ["a.csv", "b.csv"]
[[study]]
set = "pinion.lead_crown.amount_um"
from = 0
to = 9
count = 150
END
"$flank" study lasting.toml "${small[@]}" -o lasting >/dev/null 2>message & pid=$!
until ls lasting/unfinished/*.journal >/dev/null 2>&1; do
  kill -0 $pid 2>/dev/null || { cat message; fail "the study over measured flanks ended"; }; sleep 0.02
done
cp b.csv kept.csv; flat 9 -9 >changed.csv; mv changed.csv b.csv
wait $pid || { cat message; fail "a measured flank that changes while a study lasts"; }
mv kept.csv b.csv
"$flank" study lasting.toml "${small[@]}" -o lasting_again >/dev/null 2>&1 || fail "the study again"
same lasting lasting_again "a measured flank that changed while the study lasted"
# Processes that do not see the same files.
mkdir -p elsewhere; cp flanks.toml a.csv b.csv elsewhere; flat 1 1 >elsewhere/c.csv; flat 0 4 >c.csv
mpirun --oversubscribe --allow-run-as-root \
    -n 1 "$flank" study flanks.toml "${small[@]}" -o "$PWD/apart_files" \
    : -n 1 -wdir "$PWD/elsewhere" "$flank" study flanks.toml "${small[@]}" -o "$PWD/apart_files" \
    >/dev/null 2>message
[[ $? -eq 2 && ! -e apart_files ]] && grep -q "the processes read different inputs" message ||
  { cat message; fail "processes that read different files"; }

# One of two processes cannot write: both end, with the reason, and what was finished is gone on with.
timeout 120 mpirun --oversubscribe --allow-run-as-root \
    -n 1 "$flank" study modifications.toml "${small[@]}" -o half_full \
    : -n 1 bash -c 'ulimit -f 4; exec "$@"' _ "$flank" study modifications.toml "${small[@]}" -o half_full \
    >/dev/null 2>message
[[ $? -eq 3 && $(grep -c "cannot write" message) -eq 1 && ! -e half_full/te.csv ]] ||
  { cat message; fail "a process of two that cannot write"; }
"$flank" study modifications.toml "${small[@]}" -o half_full --resume >/dev/null 2>message ||
  { cat message; fail "going on after one process could not write"; }
same one half_full "after one process could not write"

# In parts, as a job array does, one after the other or at once.
for k in 1 2 3; do
  "$flank" study modifications.toml "${longer[@]}" -o parts --part $k/3 >screen$k 2>message$k &
done
wait
for k in 1 2 3; do
  grep -q "pieces of all parts" screen$k || { cat screen$k message$k; fail "a part says how far all are"; }
done
"$flank" study modifications.toml "${longer[@]}" -o parts --resume >screen 2>message ||
  fail "tables of all parts"
same whole parts "three parts"
"$flank" study modifications.toml --part 4/3 -o wrong 2>message
[[ $? -eq 2 && ! -e wrong ]] && grep -q -- "--part 4/3" message || fail "a part that is none"

# What changes the body is reduced once each; a variant that cannot be is recorded, the rest goes on.
case_with bodies.toml <<'END'
[[study]]
set = "pinion.bore_diameter_mm"
values = [70.34, 60.0, 139.9]
[[study]]
set = "pair.centre_distance_error_um"
values = [0, 20]
END
"$flank" plan bodies.toml "${small[@]}" |
  grep -q "3 distinct bodies, 1 of them cached\|2 distinct bodies, 1 of them cached" || fail "plan of bodies"
ranks 2 "$flank" study bodies.toml "${small[@]}" -o bodies >screen 2>message; code=$?
[[ $(find cache -type f | wc -l) -ge 2 ]] || fail "one reduction a distinct body"
grep -q "^0,70.34,0,ok,200" bodies/designs.csv &&
  grep -q "^2,60,0,ok,200\|^2,60.0,0,ok,200" bodies/designs.csv || fail "variants of both bodies"
[[ $code -eq 3 ]] && grep -q "^4,139.9,0,.*failed: .*bore" bodies/designs.csv && grep -q "2 failed" screen ||
  fail "a variant that cannot be is recorded with its reason (exit code $code)"

# Derivatives, where asked for: d(mean TE) by the amount of tip relief against the neighbouring
# variants (2 um apart: 2 %).
case_with derivatives.toml <<'END'
[[study]]
set = "pinion.tip_relief.amount_um"
values = [4, 5, 6]
END
"$flank" study derivatives.toml "${small[@]}" --set output.derivatives=yes -o derivatives >/dev/null 2>&1 ||
  fail "study with derivatives"
grep -v '^#' derivatives/designs.csv |
  awk -F, 'NR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i; next }
    $at["torque_Nm"] == 200 {
      te[$2] = $at["mean_te_um"]; by[$2] = $at["d_mean_te_um/d_pinion.tip_relief.amount_um"]
    }
    END { d = (te[6] - te[4]) / 2; exit !(by[5] > 0.98 * d && by[5] < 1.02 * d) }' ||
  fail "derivatives in designs.csv"

# The other scene, a file of designs, axes that go together, a logarithmic range.
cp "$root/cases/double_roller/exact.toml" drive.toml
cat >>drive.toml <<'END'
[[study]]
file = "designs.csv"
[[study]]
set = "drive.uniform_clearance_um"
from = 1
to = 4
count = 3
spacing = "logarithmic"
together_with_previous = true
END
printf 'drive.poissons_ratio, "drive.width_mm"\n0.3, 10\n"0.3", 12\n0.25, "10"\n' >designs.csv
sed -i 's/step = 1 /step = 20 /' drive.toml
"$flank" study drive.toml -o drive >/dev/null 2>message || { cat message; fail "study of the drive"; }
grep -q "^1,0.3,12,2,ok,10" drive/designs.csv || fail "designs of a file, together with a range"
"$flank" plan drive.toml | grep -q "3 variants of 3 keys" || fail "plan of the drive's study"

# Wrong axes: one line, exit code 2, nothing written.
wrong() {
  case_with wrong.toml
  "$flank" study wrong.toml -o wrong 2>message
  [[ $? -eq 2 && $(wc -l <message) -eq 1 && ! -e wrong ]] && grep -q "$1" message ||
    { cat message; fail "wrong axes: $1"; }
}
wrong "pinion.teeth" <<<$'[[study]]\nset = "pinion.teht"\nvalues = [1]'
wrong "out of bounds" <<<$'[[study]]\nset = "pinion.poissons_ratio"\nvalues = [0.3, 3]'
wrong "says no values" <<<$'[[study]]\nset = "pinion.teeth"'
wrong "unknown key valeus" <<<$'[[study]]\nset = "pinion.teeth"\nvaleus = [1]'
wrong "set by an axis before" <<'END'
[[study]]
set = "pinion.teeth"
values = [50]
[[study]]
set = "pinion.teeth"
values = [50]
END
wrong "needs from and to above 0" <<'END'
[[study]]
set = "pinion.teeth"
from = 0
to = 1
count = 2
spacing = "logarithmic"
END
"$flank" study "$root/cases/parallel_axis/helical.toml" -o wrong 2>message
[[ $? -eq 2 && ! -e wrong ]] && grep -q "no \[\[study\]\]" message || fail "a case without axes"
echo "all passed"
