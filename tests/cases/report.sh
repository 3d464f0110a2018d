#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# The report of a run, a study and a drive: all figures, their numbers, the same bytes again; wrong input.
source "$(dirname "$0")/shell.sh"
small=(--accuracy draft --set contact_grid.slices=9 --set mesh_cycle.positions=8)
sed 's/centre_distance_mm = 150.0/centre_distance_mm = 159.0/
  s/^like = "pinion"/&\nteeth = 56\ntip_diameter_mm = 174.0\nroot_diameter_mm = 158.6/' \
  "$root/cases/parallel_axis/helical.toml" >unequal.toml
"$flank" run unequal.toml "${small[@]}" --set 'load.pinion_torque_Nm=[50,100,200]' \
    --set output.root_stress=yes --set output.subsurface_stress=yes -o gears >/dev/null 2>&1 || fail "run"
cat "$root/cases/parallel_axis/helical.toml" - >study.toml <<END
[[study]]
set = ["pinion.tip_relief.amount_um", "gear.tip_relief.amount_um"]
values = [0, 5, 10]
END
"$flank" study study.toml "${small[@]}" --set 'load.pinion_torque_Nm=[50,100,200]' \
    --set output.root_stress=yes --set output.subsurface_stress=yes -o study >/dev/null 2>&1 ||
  fail "study"
# A turn of the crank later no roller meets the sleeve of its own number.
"$flank" run "$root/cases/double_roller/paper.toml" --set mesh_cycle.crank_angles_deg.from=500 \
    --set mesh_cycle.crank_angles_deg.to=520 --set output.pressure_maps_deg=[500,510] \
    -o drive >/dev/null 2>&1 ||
  fail "drive"
for folder in gears study drive; do
  "$flank" report $folder >screen 2>&1 || { cat screen; fail "report of $folder"; }
  [[ -s $folder/report.html ]] || fail "page of $folder"
  grep -q '<script\|src="http\|href="http' $folder/report.html && fail "$folder: the page stands alone"
  pictures=$(ls $folder/figures/*.svg | wc -l)
  [[ $pictures -ge 5 && $pictures -eq $(ls $folder/figures/*.png | wc -l) &&
    $pictures -eq $(ls $folder/figures/*.csv | wc -l) ]] ||
    fail "$folder: a figure is SVG, PNG and CSV"
  [[ $(grep -o "src='data:image/svg" $folder/report.html | wc -l) -eq $pictures ]] ||
    fail "$folder: all figures stand on the page"
  [[ $(grep -c " figures/" $folder/manifest.txt) -eq $((3 * pictures)) ]] &&
    grep -q " report.html$" $folder/manifest.txt || fail "$folder: the manifest has the report"
  cp -r $folder first
  "$flank" report $folder >/dev/null 2>&1 && diff -rq first $folder || fail "$folder: the same report again"
  rm -r first
done
# So few positions that they show the first harmonic alone.
"$flank" run "$root/cases/double_roller/exact.toml" --set mesh_cycle.crank_angles_deg.to=20 \
  --set mesh_cycle.crank_angles_deg.step=10 -o few >/dev/null 2>&1 || fail "a drive at few crank angles"
sed 's/values = \[0, 5, 10\]/values = [1, 2, 3]/' study.toml >few.toml
"$flank" study few.toml "${small[@]}" --set mesh_cycle.positions=2 --set 'load.pinion_torque_Nm=[50,100]' \
  -o few_study >/dev/null 2>&1 || fail "a study at few positions"
for folder in few few_study; do
  "$flank" report $folder >screen 2>&1 || { cat screen; fail "report of $folder"; }
done
# The figures' numbers are the results'.
/usr/bin/python3 "$root/tests/cases/recomputed/report_figures.py" "$flank" gears study drive ||
  fail "the figures' tables show the results"
for folder in gears study; do
  for name in root_stress subsurface_over_phase; do
    [[ -s $folder/figures/$name.csv ]] || fail "$folder: $name in the report"
  done
done
# What a page says was left out is not in the folder, and what is neither drawn nor there is named.
left_out() { sed -n "s/.*id='left-out'//p" $1/report.html | sed "s/<h2.*//"; }
left_out study | grep -qi 'root stress\|below the surface' && fail "a study's figures are said to be left out"
left_out study | grep -q 'Contact pattern, load share.*flank run' || fail "what a study leaves out"
left_out few_study | grep -q 'Root stress of variant 0: not computed (output.root_stress' &&
  left_out few_study | grep -q 'Stress below the surface of variant 0: not computed (output.subsurface' ||
  fail "what a study was not asked for"
# Numbers over the positions that no list of the report names are drawn as they are.
cp -r gears unnamed && mv unnamed/subsurface.csv unnamed/below_the_flanks.csv
sed -i 's/ subsurface.csv$/ below_the_flanks.csv/' unnamed/manifest.txt
"$flank" report unnamed >screen 2>&1 || { cat screen; fail "a table that no list names"; }
diff <(tail -n +2 gears/figures/subsurface_over_phase.csv) \
    <(tail -n +2 unnamed/figures/below_the_flanks_over_phase.csv) &&
  grep -q 'alt=.Below the flanks. ' unnamed/report.html || fail "a table that no list names is drawn"
cp -r gears changed; echo mine >changed/report.html
"$flank" report changed 2>message
[[ $? -eq 2 && $(cat changed/report.html) == mine ]] && grep -q "not as Flank wrote it" message ||
  fail "a report that was changed by hand"
sed 's/te_um/te/' gears/te.csv >other.csv; cp -r gears other; mv other.csv other/te.csv
"$flank" report other 2>message
[[ $? -eq 2 && $(wc -l <message) -eq 1 ]] || fail "tables that Flank did not write"
rm other/te.csv other/manifest.txt
"$flank" report other 2>message
[[ $? -eq 2 && $(wc -l <message) -eq 1 ]] || fail "a folder without its manifest"
mkdir without && cp -r "$root"/cases without &&
  echo 'raise ModuleNotFoundError("none", name="matplotlib")' >without/cases/report/matplotlib.py
/usr/bin/python3 without/cases/report/report.py study 2>message
[[ $? -eq 2 && $(wc -l <message) -eq 1 ]] && grep -q "install python3-matplotlib" message ||
  fail "no matplotlib: the package's name"
mkdir empty
"$flank" report empty 2>message
[[ $? -eq 2 && $(wc -l <message) -eq 1 && -z $(ls empty) ]] || fail "a folder without results"
"$flank" report nowhere 2>message; [[ $? -eq 2 && $(wc -l <message) -eq 1 ]] || fail "no folder"
"$flank" run "$root/cases/parallel_axis/helical.toml" "${small[@]}" --set 'load.pinion_torque_Nm=[50]' \
    -o gears --force >/dev/null 2>&1 ||
  fail "another run in a folder with a report"
[[ ! -e gears/report.html && ! -e gears/figures ]] || fail "a report of an earlier run stays"
echo "1 passed, 0 failed"
