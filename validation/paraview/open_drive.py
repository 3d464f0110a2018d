# SPDX-License-Identifier: GPL-2.0-or-later
# pvbatch open_drive.py FOLDER TORQUE: opens the fields of a double-roller drive and checks arrays, times,
# pressures and forces against pairs.csv.
import csv
import os
import sys

from paraview.simple import *
from paraview.vtk.numpy_interface import dataset_adapter
from paraview import servermanager

folder, torque = sys.argv[1], sys.argv[2]
failures = []


def check(holds, what):
    print(("  holds: " if holds else "  FAILS: ") + what)
    if not holds:
        failures.append(what)


pairs = list(
    csv.DictReader(line for line in open(os.path.join(folder, "pairs.csv")) if not line.startswith("#"))
)
pressure = OpenDataFile(os.path.join(folder, "fields", f"pressure_{torque}Nm.pvd"))
drive = OpenDataFile(os.path.join(folder, "fields", f"drive_{torque}Nm.pvd"))
for time in drive.TimestepValues:
    rows = [r for r in pairs if r["torque_Nm"] == torque and abs(float(r["crank_angle_deg"]) - time) < 1e-9]
    pressure.UpdatePipeline(time)
    data = dataset_adapter.WrapDataObject(servermanager.Fetch(pressure)).PointData
    for body, name in ((1, "rollers"), (2, "sleeves")):
        worst = 0
        for row in rows:
            mine = (
                (data["roller"] == int(row["roller"]))
                & (data["sleeve"] == int(row["sleeve"]))
                & (data["body_1_roller_2_sleeve"] == body)
            )
            force = float((data["pressure_MPa"] * data["area_mm2"])[mine].sum()) / 4  # four points a cell
            worst = max(worst, abs(force / float(row["normal_force_N"]) - 1))
        check(
            rows and worst < 1e-3,
            f"crank angle {time:g}: pressures on {name} carry the forces of "
            f"{len(rows)} pairs within {worst:.1e}",
        )
    drive.UpdatePipeline(time)
    total = dataset_adapter.WrapDataObject(servermanager.Fetch(drive)).PointData["force_N"]
    check(
        float(total.max()) >= max(float(r["normal_force_N"]) for r in rows) * (1 - 1e-6),
        f"the drive's parts carry up to {float(total.max()):.1f} N",
    )
sys.exit(1 if failures else 0)
