#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# No result knows how large the pair is or how stiff: lengths by any factor, also as far as windows of contact
# are rounded, moduli by any factor with the torque, to nine digits or as far as the tables print.
source "$(dirname "$0")/shell.sh"
/usr/bin/python3 - "$flank" <<'END' || fail "scaled results"
import csv, subprocess, sys

# Table, and the unit of the last digit it prints.
COLUMNS = {
    "te_um": ("te", 1e-9),
    "max_pressure_MPa": ("te", 1e-4),
    "edge_pressure_MPa": ("te", 1e-4),
    "load_share": ("pairs", 1e-9),
}


def case(length, modulus):
    return f"""
scene = "parallel_axis"
[pair]
centre_distance_mm = {92.1 * length!r}
normal_module_mm = {2 * length!r}
normal_pressure_angle_deg = 20
helix_angle_deg = 12
[pinion]
teeth = 30
face_width_mm = {8 * length!r}
bore_diameter_mm = {30 * length!r}
fillet_radius_mm = {0.5 * length!r}
youngs_modulus_GPa = {207 * modulus!r}
poissons_ratio = 0.3
tip_relief = {{ amount_um = {6 * length!r}, start_diameter_mm = {64 * length!r} }}
lead_crown = {{ amount_um = {3 * length!r} }}
[gear]
like = "pinion"
teeth = 60
bore_diameter_mm = {50 * length!r}
tip_relief = {{ amount_um = {6 * length!r}, start_diameter_mm = {125 * length!r} }}
[load]
pinion_torque_Nm = [{20 * length**3 * modulus!r}, {3 * length**3 * modulus!r}]
[mesh_cycle]
positions = 3
"""


def column(folder, table, name):
    with open(f"{folder}/{table}.csv") as file:
        return [float(row[name]) for row in csv.DictReader(line for line in file if line[0] != "#")]


def results(length, modulus):
    """Columns and the units of their last digits, in the units of the pair of length and modulus 1."""
    folder = f"length_{length}_modulus_{modulus}"
    with open(f"{folder}.toml", "w") as file:
        file.write(case(length, modulus))
    command = [sys.argv[1], "run", f"{folder}.toml", "-o", folder, "--accuracy", "draft"]
    subprocess.run(command + ["--set", "output.error_estimate=no"], check=True, stdout=subprocess.DEVNULL)
    scales = {"te_um": length, "max_pressure_MPa": modulus, "edge_pressure_MPa": modulus, "load_share": 1}
    return {
        name: ([value / scales[name] for value in column(folder, table, name)], unit / scales[name])
        for name, (table, unit) in COLUMNS.items()
    }


plain = results(1, 1)
for length, modulus in ((0.0137, 1), (73.1, 1), (1, 1e-3)):
    for name, (values, printed) in results(length, modulus).items():
        expected = plain[name][0]
        assert len(values) == len(expected), name
        for one, other in zip(values, expected):
            apart = 1e-9 * abs(other) + printed + COLUMNS[name][1]
            assert abs(one - other) <= apart, (length, modulus, name, one, other)
END
echo "1 passed, 0 failed"
