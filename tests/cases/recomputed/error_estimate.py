#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""error_estimate.csv recomputed: the difference of a run and of the same run at the other accuracy level.

Usage: error_estimate.py FLANK ESTIMATE OTHER    (result folders)
"""
import pathlib, sys

sys.dont_write_bytecode = True
import checks
import numpy
from checks import Table, check, harmonics, near

folder, other = (pathlib.Path(argument) for argument in sys.argv[2:4])
here, there, estimate = (
    Table(folder / "te.csv"),
    Table(other / "te.csv"),
    Table(folder / "error_estimate.csv"),
)
check(len(estimate.rows) > 0, "error estimates")
for row, torque in zip(estimate.rows, estimate["torque_Nm"]):
    a, b = (table["te_um"][table["torque_Nm"] == torque] for table in (here, there))
    p, q = (table["max_pressure_MPa"][table["torque_Nm"] == torque].max() for table in (here, there))
    expected = {
        "mean_te_um": abs(a.mean() - b.mean()),
        "te_rms_um": numpy.sqrt(numpy.mean((a - a.mean() - b + b.mean()) ** 2)),
        "peak_to_peak_te_um": abs(numpy.ptp(a) - numpy.ptp(b)),
        "A1_um": abs(harmonics(a)[0][0] - harmonics(b)[0][0]),
        "max_pressure_percent": 100 * abs(p - q) / p,
    }
    levels = (row["variant"], row["level"], row["compared_with"])
    check(levels == ("0", "draft", "standard"), f"variant and levels: {levels}")
    check(len(a) > 2 and expected["mean_te_um"] > 0, "curves to compare")
    for name, value in expected.items():
        # Half a unit of the last digit, and as much of rounded pressures.
        near(float(row[name]), value, f"{name} at {torque} N m", absolute=1e-4 if "percent" in name else 1e-6)
for failure in checks.failures:
    print("FAILED:", failure)
sys.exit(bool(checks.failures))
