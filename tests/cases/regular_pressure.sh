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
# On an arc at the start of a relief, as grinding leaves it, pressure has a limit, which the usual cells find.
for cells in 11 41; do
  pressures "arc_$cells" "$linear" --set 'load.pinion_torque_Nm=[200]' --set mesh_cycle.positions=32 \
    --set pinion.tip_relief.blend_radius_mm=20 --set contact_grid.profile_cells=$cells
done
# Beside a face end that both gears have in common it has a limit too, where the pair is tilted towards it.
for size in 31,11 91,21; do
  pressures "end_${size%,*}" "$linear" --set 'load.pinion_torque_Nm=[100]' \
    --set contact_grid.slices="${size%,*}" --set contact_grid.profile_cells="${size#*,}" \
    --set misalignment.in_plane_um=60 \
    $(for gear in pinion gear; do
      echo "--set $gear.tip_relief.shape=quadratic --set $gear.tip_relief.amount_um=60"
      echo "--set $gear.tip_relief.start_roll_angle_deg=22 --set $gear.lead_crown.amount_um=0"
    done)
done
# A kink that no contact comes near is none to it.
pressures far "$linear" --set 'load.pinion_torque_Nm=[10]' --set pinion.tip_relief.shape=quadratic \
  --set pinion.tip_relief.amount_um=40 --set pinion.lead_crown.amount_um=20 \
  --set pinion.end_relief.amount_um=10 --set pinion.end_relief.length_mm=2
# Lightly loaded, a pair that its tip edges begin and end: slices beside these have less as they come nearer.
cat >light.toml <<'END'
scene = "parallel_axis"
[pair]
normal_module_mm = 0.59
normal_pressure_angle_deg = 20
helix_angle_deg = 9.992
pinion_hand = "right"
centre_distance_mm = 17.782424
[pinion]
teeth = 14
face_width_mm = 5.613
profile_shift = 0.0343
bore_diameter_mm = 4.64715
fillet_radius_mm = 0.1906
youngs_modulus_GPa = 206
poissons_ratio = 0.3
[gear]
teeth = 45
face_width_mm = 5.613
profile_shift = 0.0852
bore_diameter_mm = 12.2388
fillet_radius_mm = 0.1801
youngs_modulus_GPa = 206
poissons_ratio = 0.3
tip_relief = { amount_um = 0.0542, start_roll_angle_deg = 24.8332, shape = "linear" }
[load]
pinion_torque_Nm = [0.02297]
END
for slices in 31 91; do
  pressures "light_$slices" light.toml --set mesh_cycle.positions=16 --set contact_grid.slices=$slices
done
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
(arc,), (of_fine_cells,) = (table("error_estimate", f"arc_{cells}") for cells in (11, 41))
pressure, fine = (float(row["regular_pressure_MPa"]) for row in (arc, of_fine_cells))
print("arc", arc, of_fine_cells)
(away,) = table("error_estimate", "kink_11")  # the greatest is on the arc, not elsewhere
assert arc["pressure_kind"] != "kink" and pressure > 1.05 * float(away["regular_pressure_MPa"]), arc
assert abs(pressure / fine - 1) <= float(arc["regular_pressure_percent"]) / 100 < 0.05, (arc, of_fine_cells)
(end,), (of_finer,) = (table("error_estimate", f"end_{slices}") for slices in (31, 91))
pressure, finer = (float(row["regular_pressure_MPa"]) for row in (end, of_finer))
stated = float(end["max_pressure_percent"])
print("end", pressure, finer, stated)
assert end["pressure_kind"] == "regular" and 100 * abs(finer / pressure - 1) <= stated < 12, end
assert max(abs(float(row["max_pressure_z_mm"])) for row in table("te", "end_91")) > 9.5
# A position has a bound where its own greatest pressure is away from both.
bounded = 0
for one, other in (
    ("kink_11", "kink_41"),
    ("edge_11", "edge_41"),
    ("edge_11", "edge_slices"),
    ("relief_31", "relief_91"),
    ("light_31", "light_91"),
):
    for coarse, fine in zip(table("te", one), table("te", other)):
        pressure, edge, stated = (
            float(coarse[f"{name}_MPa"]) for name in ("max_pressure", "edge_pressure", "max_pressure_bound")
        )
        off = abs(pressure - float(fine["max_pressure_MPa"]))
        assert not off > stated and not (stated > 0 and 2 * edge >= pressure), (one, other, coarse, fine)
        bounded += stated > 0 and one != other
print("positions with a bound:", bounded)
assert bounded >= 3, bounded
(far,) = table("error_estimate", "far")
assert far["pressure_kind"] == "regular", far
END
echo "1 passed, 0 failed"
