# SPDX-License-Identifier: GPL-2.0-or-later
"""Prints the benchmark's CSV as a table: ms, ratio to the floors, and the reference's."""
import csv
import sys

times, active = {}, {}
for row in csv.DictReader(line for line in open(sys.argv[1]) if line.startswith(("name", '"'))):
    name, n = row["name"].split("/")
    times[name, int(n)] = float(row["real_time"])
    active[int(n)] = int(float(row["active"]))
reference = {
    int(r["n"]): r for r in csv.DictReader(line for line in open(sys.argv[2]) if not line.startswith("#"))
}
print(
    "floor = one dense Cholesky of the active block + one product C f, measured here; of the reference: "
    "at 50 GF/s and 100 (n < 1500) or 25 GB/s\n"
)
print(
    f"{'n':>5} {'active':>6} {'floor ms':>9} | {'what':<16} {'ms':>9} {'/ floor':>8} | "
    f"{'reference ms':>12} {'/ floor':>8}"
)
for n in sorted(active):
    floor = times["floor_cholesky", n] + times["floor_product", n]
    for name in ("cold", "warm", "hundred_torques", "finite_path"):
        line = (
            f"{n:5} {active[n]:6} {floor:9.3f} | {name:<16} {times[name, n]:9.3f} "
            f"{times[name, n] / floor:8.1f} |"
        )
        if n in reference and name in reference[n]:
            r = reference[n]
            other = float(r["active"]) ** 3 / 3 / 50e9 * 1e3 + 8 * n * n / (100e9 if n < 1500 else 25e9) * 1e3
            line += f" {float(r[name]):12.3f} {float(r[name]) / other:8.1f}"
        print(line)
