#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# The greatest pressure in three kinds: at a kink of a flank and at an edge it grows as cells shrink; away
# from both it converges, and its bound contains what finer cells change.
source "$(dirname "$0")/shell.sh"
linear=$root/cases/parallel_axis/spur_tip_relief_23p6.toml
helical=$root/cases/parallel_axis/helical.toml
pressures() { # FOLDER CASE ARGUMENTS...
  "$flank" run "$2" --accuracy draft --set mesh_cycle.positions=8 "${@:3}" -o "$1" >screen 2>&1 ||
    { cat screen; fail "$1"; }
}
for cells in 11 21 41; do
  pressures "kink_$cells" "$linear" --set 'load.pinion_torque_Nm=[200]' \
    --set contact_grid.profile_cells=$cells
  grep -Eq "^greatest pressure away from kinks and edges at 200.000 N m: [0-9.]+ \+- [0-9.]+ MPa" screen ||
    { cat screen; fail "the regular pressure on the screen"; }
  # Without relief the tip edges of a helical pair carry more than the flanks inside.
  pressures "edge_$cells" "$helical" --set 'load.pinion_torque_Nm=[200]' \
    --set pinion.tip_relief.amount_um=0 --set contact_grid.profile_cells=$cells
done
# Longer and shorter slices tell the same, too.
pressures edge_slices "$helical" --set 'load.pinion_torque_Nm=[200]' --set pinion.tip_relief.amount_um=0 \
  --set contact_grid.slices=91
for slices in 31 91; do
  pressures "relief_$slices" "$helical" --set 'load.pinion_torque_Nm=[200]' \
    --set contact_grid.slices=$slices
done
# A kink that no contact comes near is none to it.
pressures far "$linear" --set 'load.pinion_torque_Nm=[10]' --set pinion.tip_relief.shape=quadratic \
  --set pinion.tip_relief.amount_um=40 --set pinion.lead_crown.amount_um=20 \
  --set pinion.end_relief.amount_um=10 --set pinion.end_relief.length_mm=2
/usr/bin/python3 - <<'END' || fail "pressures that converge and that do not"
import csv


def table(name, folder):
    return list(csv.DictReader(line for line in open(f"{folder}/{name}.csv") if line[0] != "#"))


for kind, column in (("kink", "max_pressure_MPa"), ("edge", "edge_pressure_MPa")):
    regular, bound, greatest = [], [], []
    for cells in (11, 21, 41):
        (row,) = table("error_estimate", f"{kind}_{cells}")
        assert row["pressure_kind"] == kind and row["max_pressure_percent"] == "nan", row
        regular.append(float(row["regular_pressure_MPa"]))
        bound.append(regular[-1] * float(row["regular_pressure_percent"]) / 100)
        greatest.append(max(float(position[column]) for position in table("te", f"{kind}_{cells}")))
    print(kind, regular, bound, greatest)
    for coarse in (0, 1):
        assert greatest[coarse + 1] > 1.05 * greatest[coarse], (kind, greatest)
        assert abs(regular[coarse] - regular[2]) <= bound[coarse] < 0.08 * regular[2], (kind, regular, bound)
    if kind == "edge":
        (row,) = table("error_estimate", "edge_slices")
        assert abs(float(row["regular_pressure_MPa"]) - regular[0]) <= bound[0], (row, regular, bound)
(long_slices,), (short,) = (table("error_estimate", f"relief_{slices}") for slices in (31, 91))
apart = float(short["regular_pressure_MPa"]) / float(long_slices["regular_pressure_MPa"]) - 1
assert 100 * abs(apart) <= float(long_slices["regular_pressure_percent"]), (apart, long_slices, short)
(far,) = table("error_estimate", "far")
assert far["pressure_kind"] == "regular", far
END
echo "1 passed, 0 failed"
