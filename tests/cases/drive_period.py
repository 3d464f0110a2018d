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
    """Of each torque: mean transmission error and A1 [arcsec], torsional stiffnesses [N m/arcmin]."""
    table = [line.split() for line in (folder / "summary.txt").read_text().splitlines()]
    table = [words for words in table if len(words) == 12 and re.match(r"^\d+\.\d{3}$", words[0])]
    number = lambda word: math.nan if word == "-" else float(word)
    return {float(words[0]): [number(words[i]) for i in (1, 4, 10, 11)] for words in table}


def study_of(work, name, case, *settings, axis):
    """Rows of designs.csv of a study along one axis: a key and the text of its values."""
    file, folder = work / f"{name}.toml", work / name
    file.write_text(case.read_text() + f'\n[[study]]\nset = "{axis[0]}"\nvalues = {axis[1]}\n')
    found = call("study", file, *settings, folder=folder)
    if found.returncode != 0:
        sys.exit(f"FAILED: study {name}: {found.stderr}")
    return rows(folder / "designs.csv")


def report_of(folder):
    """Text of a folder's report: empty where the folder is refused."""
    done = subprocess.run([flank, "report", str(folder)], capture_output=True, text=True)
    check(done.returncode == 0, f"report of {folder.name}: {done.stderr}")
    return (folder / "report.html").read_text() if done.returncode == 0 else ""


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
    page = report_of(work / "to_50")
    for torque in (5, 20):
        te = errors_of(work / "to_50", torque)
        check(f"{mean(te[:4]):.4f}</td>" in page, f"mean of the report, {torque} N m")


def scatter(count):
    """Errors of single parts, no two alike, as a case has them [um]."""
    return str([round(math.sin(3 * k * k + k), 3) for k in range(count)])


def amplitude(values, line):
    """Of a line of the spectrum of one period, in the unit of the values."""
    n = len(values)
    return 2 * abs(sum(v * cmath.exp(-2j * math.pi * line * k / n) for k, v in enumerate(values))) / n


def errors_of_single_parts_make_the_period_longer(work):
    """Whole periods are used; over a part of one there are no harmonics, means are over all that is computed,
    and a warning says so. Lists of equal errors are none.
    """
    case, own = root / "cases/double_roller/exact.toml", {}
    rollers, sleeves = scatter(18), scatter(17)
    for name, setting, begin, end, step, count in (
        ("rollers_part", f"drive.roller_radial_errors_um={rollers}", 0, 20, 5, 0),
        ("rollers", f"drive.roller_radial_errors_um={rollers}", 5, 375, 5, 72),
        ("sleeves_part", f"drive.sleeve_radius_errors_um={sleeves}", 0, 100, 10, 0),
        ("sleeves", f"drive.sleeve_tangential_errors_um={sleeves}", 0, 350, 5, 68),
        ("equal", f"drive.roller_radius_errors_um={[0.5] * 18}", 0, 40, 5, 4),
        ("alternating", f"drive.roller_radius_errors_um={[0.0, 0.5] * 9}", 0, 45, 5, 8),
    ):
        folder = work / name
        done = call("run", case, setting, *angles(begin, end, step), folder=folder)
        check(done.returncode == 0, f"{name}: {done.stderr}")
        warned = [line for line in done.stderr.splitlines() if "errors of single parts repeat after" in line]
        check(len(warned) == (0 if count else 1), f"{name}: a warning where the period is not computed")
        order = {"equal": 1, "alternating": 2}.get(name, count // 4)
        spectrum = rows(folder / "harmonics.csv")
        for torque, found in means_of_summary(folder).items():
            te = errors_of(folder, torque)
            near(found[0], mean(te[: count or None]) * ARCSEC_OF_UM, 6e-5, f"mean of {name}, {torque} N m")
            if count:
                near(te[count], te[0], 1e-8, f"the period of {name}, {torque} N m")
                a1 = next(r for r in spectrum if float(r["torque_Nm"]) == torque and r["harmonic"] == "1")
                expected = amplitude(te[:count], order)
                near(float(a1["amplitude_um"]), expected, 2e-9, f"A1 of {name}, {torque} N m")
                near(found[1], expected * ARCSEC_OF_UM, 6e-5, f"A1 in the summary of {name}, {torque} N m")
        if not count:
            check(not spectrum and math.isnan(found[1]), f"{name}: no harmonics")
            said = (folder / "summary.txt").read_text()
            check("of least A1: none" in said, f"{name}: no torque of least A1")
        own[name] = [(torque, errors_of(folder, torque)) for torque in (5, 20)]
    check("to = 360," in (work / "rollers_part/summary.txt").read_text(), "what computes the period")
    check("to = 340," in (work / "sleeves_part/summary.txt").read_text(), "what computes the sleeves' period")
    for name in ("rollers_part", "rollers"):
        page, count = report_of(work / name), {"rollers": 72}.get(name)
        check(all(f"{mean(te[:count]):.4f}</td>" in page for _, te in own[name]), f"mean of {name}'s report")
    study_with_and_without_errors(work, case, rollers, own["rollers_part"])


def study_with_and_without_errors(work, case, errors, of_run):
    """A variant has the numbers of its run, and is told where its positions hold no period."""
    axis = ("drive.roller_radial_errors_um", [[0.0] * 18, [float(word) for word in errors[1:-1].split(",")]])
    designs = study_of(work, "study", case, *angles(0, 20, 5), axis=axis)
    summary = (work / "study/summary.txt").read_text()
    check("warning: the positions of 1 variant hold no whole period" in summary, "the study's warning")
    check([row["A1_um"] == "" for row in designs] == [False, False, True, True], "A1 where there is a period")
    for row, (torque, te) in zip(designs[2:], of_run):
        near(float(row["mean_te_um"]), mean(te), 2e-9, f"mean of a variant with errors, {torque} N m")
        near(float(row["peak_to_peak_um"]), max(te) - min(te), 2e-9, f"its peak-to-peak, {torque} N m")
    report_of(work / "study")


def crank_angles_are_whole_steps(work):
    """What the step does not meet is refused with what would be met; what is left out, is met."""
    case = root / "cases/double_roller/exact.toml"
    refused = ((0, 20, 3, "18 or 21"), (1, 17, 5, "16 or 21"), (0, 359, 360, "0 or 360"))
    for begin, end, step, allowed in refused:
        done = call("check", case, *angles(begin, end, step))
        message, where = done.stderr.splitlines(), f"from {begin} to {end} by {step}"
        check(done.returncode == 2 and len(message) == 1, f"{where}: {done.returncode}, {message}")
        check(f"crank_angles_deg.to = {end}" in done.stderr and allowed in done.stderr, f"{where}: {message}")
    for begin, end, step in ((0, 18, 3), (0, 0, 360), (-1, 0, 1 / 3), (0, 6120, 0.1)):
        done = call("check", case, *angles(begin, end, step))
        check(done.returncode == 0, f"from {begin} to {end} by {step}: {done.stderr}")
    lines = case.read_text().splitlines()
    without = work / "without.toml"
    for text, allowed in (("{ step = 3 }", "18 or 21"), ("{ step = 360 }", "0 or 360"), ("{ from = 7 }", "")):
        changed = [f"crank_angles_deg = {text}" if "crank_angles" in line else line for line in lines]
        without.write_text("\n".join(changed) + "\n")
        done = call("check", without)
        check(done.returncode == (2 if allowed else 0) and allowed in done.stderr, f"{text}: {done.stderr}")
        check("divide 360/N_r = 20," in done.stderr or not allowed, f"{text}: {done.stderr}")
    # Left out: 360/16 = 22.5 deg in 23 parts, the end among them.
    sizes = ["drive.rollers=16", "drive.roller_circle_radius_mm=23.7", "drive.sleeve_circle_radius_mm=19.2"]
    done = call("run", without, *sizes, "load.output_torque_Nm=[5]", folder=work / "sixteen")
    check(done.returncode == 0, f"sixteen rollers: {done.stderr}")
    at = [float(row["crank_angle_deg"]) for row in rows(work / "sixteen/te.csv")]
    check(len(at) == 24, f"sixteen rollers: {len(at)} angles")
    near(at[-1] - at[0], 22.5, 1e-6, "sixteen rollers: one pitch")
    near(at[1] - at[0], 22.5 / 23, 1e-6, "sixteen rollers: step")


with tempfile.TemporaryDirectory() as work:
    for test in (
        means_are_those_of_the_first_period,
        errors_of_single_parts_make_the_period_longer,
        crank_angles_are_whole_steps,
    ):
        (Path(work) / test.__name__).mkdir()
        test(Path(work) / test.__name__)
print(f"{len(failures)} failed")
sys.exit(1 if failures else 0)
