#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""The period of the double-roller drive: what runs, studies and reports say over it.
Use: drive_period.py FLANK ROOT"""
import cmath
import csv
import math
import re
import subprocess
import sys
import tempfile
from pathlib import Path

flank, root = sys.argv[1], Path(sys.argv[2])
SMALL = ("contact_grid.cells_across=8", "contact_grid.cells_along=8", "load.output_torque_Nm=[5, 20]")
ARCSEC_OF_UM = 1e-3 / 22.15 * 180 / math.pi * 3600  # at the circle of the sleeves
failures = []


def check(holds, what):
    if not holds:
        failures.append(what)
        print("FAILED:", what)


def near(found, expected, tolerance, what):
    check(abs(found - expected) <= tolerance, f"{what}: {found}, expected {expected}")


def call(command, case, *settings, folder=None):
    """The finished process of `flank command case`."""
    words = [word for setting in (*SMALL, *settings) for word in ("--set", setting)]
    output = ["-o", str(folder)] if folder else []
    return subprocess.run([flank, command, str(case), *words, *output], capture_output=True, text=True)


def angles(begin, end, step):
    """Settings of the crank angles [deg]; None: as the case has it."""
    return [
        f"mesh_cycle.crank_angles_deg.{key}={value}"
        for key, value in (("from", begin), ("to", end), ("step", step))
        if value is not None
    ]


def rows(path):
    """Lines of a table as dictionaries, its comments left out."""
    with open(path) as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def errors_of(folder, torque):
    """Transmission errors of a torque over the positions [um]."""
    return [float(row["te_um"]) for row in rows(folder / "te.csv") if float(row["torque_Nm"]) == torque]


def mean(values):
    return sum(values) / len(values)


def means_of_summary(folder):
    """Of each torque: mean transmission error [arcsec] and A1 [arcsec]; torsional stiffnesses [N m/arcmin]."""
    table = [line.split() for line in (folder / "summary.txt").read_text().splitlines()]
    table = [words for words in table if len(words) == 12 and re.match(r"^\d+\.\d{3}$", words[0])]
    return {float(words[0]): [float(words[i]) for i in (1, 4, 10, 11)] for words in table}


def study_of(work, name, case, *settings, axis):
    """Rows of designs.csv of a study along one axis: a key and the text of its values."""
    file, folder = work / f"{name}.toml", work / name
    file.write_text(case.read_text() + f'\n[[study]]\nset = "{axis[0]}"\nvalues = {axis[1]}\n')
    found = call("study", file, *settings, folder=folder)
    if found.returncode != 0:
        sys.exit(f"FAILED: study {name}: {found.stderr}")
    return rows(folder / "designs.csv")


def means_are_those_of_the_first_period(work):
    """From one to two and a half periods, with the end point and without: the same means, of run, study and
    report alike; and the transmission error is its mean and its harmonics.
    """
    case, ends = root / "cases/double_roller/exact.toml", (15, 20, 35, 40, 50)
    axis = ("mesh_cycle.crank_angles_deg.to", list(ends))
    designs = study_of(work, "ends", case, *angles(0, None, 5), axis=axis)
    for end in ends:
        folder = work / f"to_{end}"
        check(call("run", case, *angles(0, end, 5), folder=folder).returncode == 0, f"run to {end}")
        for torque, found in means_of_summary(folder).items():
            te = errors_of(folder, torque)
            where = f"to {end} deg, {torque} N m"
            row = next(
                row
                for row in designs
                if float(row["mesh_cycle.crank_angles_deg.to"]) == end and float(row["torque_Nm"]) == torque
            )
            near(found[0], mean(te[:4]) * ARCSEC_OF_UM, 6e-5, f"mean of the run, {where}")
            near(float(row["mean_te_um"]), mean(te[:4]), 2e-9, f"mean of the study, {where}")
            own = [r for r in rows(folder / "te.csv") if float(r["torque_Nm"]) == torque][:4]
            of_column = lambda name: mean([float(r[name]) for r in own])
            near(found[2], of_column("torsional_stiffness_Nm_per_arcmin"), 6e-5, f"tangent, {where}")
            near(found[3], of_column("torsional_stiffness_secant_Nm_per_arcmin"), 6e-5, f"secant, {where}")
            stiffness = of_column("mesh_stiffness_N_per_um")
            near(float(row["mean_mesh_stiffness_N_per_um"]), stiffness, 2e-6, f"stiffness, {where}")
            spectrum = [r for r in rows(folder / "harmonics.csv") if float(r["torque_Nm"]) == torque]
            for k, value in enumerate(te):
                again = float(row["mean_te_um"]) + sum(
                    float(r["amplitude_um"])
                    * math.cos(2 * math.pi * int(r["harmonic"]) * k / 4 + math.radians(float(r["phase_deg"])))
                    for r in spectrum
                )
                near(again, value, 1e-6, f"mean and harmonics at position {k}, {where}")
    check(subprocess.run([flank, "report", str(work / "to_50")]).returncode == 0, "report")
    page = (work / "to_50/report.html").read_text()
    for torque in (5, 20):
        te = errors_of(work / "to_50", torque)
        check(f"{mean(te[:4]):.4f}</td>" in page, f"mean of the report, {torque} N m")


with tempfile.TemporaryDirectory() as work:
    for test in (means_are_those_of_the_first_period,):
        (Path(work) / test.__name__).mkdir()
        test(Path(work) / test.__name__)
print(f"{len(failures)} failed")
sys.exit(1 if failures else 0)
