#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# The bound of the greatest root stress is of the tooth and the place where it is greatest. Here that is at a
# face end, where a pair's last contact presses beside the fillet: not where load times roll angle is
# greatest, which is better known. Few elements see 14 % too much there, of which 3 % were stated.
source "$(dirname "$0")/shell.sh"
cat >short_contact.toml <<'END'
scene = "parallel_axis"
[pair]
normal_module_mm = 4.37
normal_pressure_angle_deg = 17.5
helix_angle_deg = 29.35
pinion_hand = "right"
centre_distance_mm = 229.38312
[pinion]
teeth = 77
face_width_mm = 22.2
profile_shift = -0.0724
bore_diameter_mm = 227.529
fillet_radius_mm = 1.457
youngs_modulus_GPa = 206
poissons_ratio = 0.3
[gear]
teeth = 14
face_width_mm = 22.2
profile_shift = 0.287
bore_diameter_mm = 45.7087
fillet_radius_mm = 1.444
youngs_modulus_GPa = 110
poissons_ratio = 0.34
tip_relief = { amount_um = 7.19, start_roll_angle_deg = 25.2725, shape = "linear" }
helix_slope = { amount_um = -0.185 }
[load]
pinion_torque_Nm = [245.9]
[mesh_cycle]
positions = 16
[output]
root_stress = "yes"
END
"$flank" run short_contact.toml --accuracy draft -o draft >screen 2>&1 || { cat screen; fail "the run"; }
/usr/bin/python3 - <<'END' || fail "a bound of root stress that does not hold"
import csv

rows = [row for row in csv.DictReader(line for line in open("draft/root_stress.csv") if line[0] != "#")]
# Of elements that no longer matter, and 48 positions: scene 684 of validation/coverage/truths.jsonl.
for body, fine in (("pinion", 60.73), ("gear", 53.92)):
    of_body = [row for row in rows if row["body"] == body]
    greatest = max(of_body, key=lambda row: float(row["tensile_stress_MPa"]))
    off = abs(float(greatest["tensile_stress_MPa"]) - fine)
    print(f"{body}: off by {off:.2f} MPa", greatest)
    assert off <= float(greatest["tensile_stress_bound_MPa"]), greatest
    if body == "gear":  # what the test is about
        assert off > 0.1 * fine and abs(float(greatest["z_mm"])) == 11.1, greatest
END
echo "1 passed, 0 failed"
