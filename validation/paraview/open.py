# SPDX-License-Identifier: GPL-2.0-or-later
# pvbatch open.py FOLDER TORQUE: opens every kind of file of a result folder's fields/ and checks arrays,
# ranges and times against te.csv.
import csv
import glob
import os
import sys

from paraview.simple import *
from paraview.vtk.numpy_interface import dataset_adapter
from paraview import servermanager

folder, torque = sys.argv[1], sys.argv[2]
fields = os.path.join(folder, "fields")
failures = []


def check(holds, what):
    print(("  holds: " if holds else "  FAILS: ") + what)
    if not holds:
        failures.append(what)


def ranges(data):
    arrays = data.PointData
    return {
        arrays[i].Name: [arrays[i].GetRange(c) for c in range(arrays[i].GetNumberOfComponents())]
        for i in range(len(arrays))
    }


below = list(
    csv.DictReader(line for line in open(os.path.join(folder, "subsurface.csv")) if not line.startswith("#"))
)
table = list(
    csv.DictReader(line for line in open(os.path.join(folder, "te.csv")) if not line.startswith("#"))
)
phases = {int(row["position"]): float(row["phase"]) for row in table}
pressure = {
    float(row["phase"]): max(float(row["max_pressure_MPa"]), float(row["edge_pressure_MPa"]))
    for row in table
    if row["torque_Nm"] == torque
}

components = {
    "displacement_mm": 3,
    "stress_MPa": 9,
    "von_mises_MPa": 1,
    "principal_stresses_MPa": 3,
    "body_1_pinion_2_gear": 1,
    "tooth": 1,
}
bodies = OpenDataFile(os.path.join(fields, f"bodies_{torque}Nm.pvd"))
contact = OpenDataFile(os.path.join(fields, f"contact_{torque}Nm.pvd"))
times = list(bodies.TimestepValues)
check(
    times == list(contact.TimestepValues)
    and all(any(abs(t - p) < 1e-12 for p in phases.values()) for t in times),
    f"times are phases: {times}",
)
for time in times:
    bodies.UpdatePipeline(time)
    found = ranges(bodies)
    check(
        {name: len(parts) for name, parts in found.items()} == components, f"arrays of the bodies at {time}"
    )
    largest = max(abs(v) for part in found["displacement_mm"] for v in part)
    check(1e-4 < largest < 1, f"greatest displacement {largest * 1e3:.2f} um")
    low, high = found["von_mises_MPa"][0]
    check(0 <= low < high, f"von Mises {low:.3g} to {high:.4g} MPa")
    first, last = found["principal_stresses_MPa"][0], found["principal_stresses_MPa"][2]
    check(first[1] >= last[1] and first[0] >= last[0], "principal stresses in falling order")
    check(found["body_1_pinion_2_gear"][0] == (1, 2), "both bodies")
    contact.UpdatePipeline(time)
    surface = servermanager.Fetch(contact)
    data = dataset_adapter.WrapDataObject(surface).PointData
    sides = data["body_1_pinion_2_gear"]
    peak = float(max(data["pressure_MPa"]))
    check(abs(peak - pressure[time]) < 1e-4 * peak, f"greatest pressure {peak:.2f} MPa is that of te.csv")
    first, second = (
        float(sum((data["pressure_MPa"] * data["area_mm2"])[sides == side])) / 4 for side in (1, 2)
    )
    check(abs(first - second) < 1e-5 * first, f"both flanks carry {first:.1f} N")
    x = bodies.GetDataInformation().GetBounds()
    y = contact.GetDataInformation().GetBounds()
    cell = 0.2  # mm: a cell cut by an edge is drawn as a rectangle of the same area, which hangs over
    check(
        all(x[2 * d] - cell <= y[2 * d] and y[2 * d + 1] <= x[2 * d + 1] + cell for d in range(3)),
        "the contact lies within the bodies",
    )
    # Below the greatest pressure inside the flanks the bodies' file must say what the half-space alone says
    # in subsurface.csv; both are samples, and the finite elements add the tooth's bending to the one.
    row = next(r for r in below if r["torque_Nm"] == torque and abs(float(r["phase"]) - time) < 1e-9)
    at = int(abs(data["pressure_MPa"] - float(row["max_pressure_MPa"])).argmin())
    place = dataset_adapter.WrapDataObject(surface).Points[at]
    whole = servermanager.Fetch(
        MergeBlocks(Input=bodies) if bodies.GetDataInformation().IsCompositeDataSet() else bodies
    )
    near = abs(dataset_adapter.WrapDataObject(whole).Points - place).max(axis=1) < 0.35
    found, expected = float(
        dataset_adapter.WrapDataObject(whole).PointData["von_mises_MPa"][near].max()
    ), float(row["von_mises_MPa"])
    check(
        abs(found - expected) < 0.1 * expected,
        f"von Mises below the contact {found:.1f} MPa, subsurface.csv {expected:.1f}",
    )
pieces = glob.glob(os.path.join(fields, "*.vtu")) + glob.glob(os.path.join(fields, "*.pvtu"))
for name in sorted(pieces):
    piece = OpenDataFile(name)
    piece.UpdatePipeline()
    check(
        piece.GetDataInformation().GetNumberOfCells() > 0
        and len(ranges(piece)) == (7 if "contact" in name else 6),
        os.path.basename(name),
    )
sys.exit(1 if failures else 0)
