#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Result files, recomputed from their own raw columns, by name, and from the case: a run of the second standing example, a study of it and a drive.
Nothing here is the product's: geometry by ISO 21771 (gear_geometry.py), sums, quotients and numpy's Fourier transform.

Usage: recomputed.py FLANK ROOT
"""
import csv, math, os, pathlib, re, subprocess, sys, tempfile

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import h5py, numpy
from gear_geometry import Pair

flank, root = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
arcsec = math.pi / 180 / 3600
failures, checks = [], 0


def check(holds, what):
    global checks
    checks += 1
    if not holds and len(failures) < 40:
        failures.append(what)


def near(one, other, what, relative=0.0, absolute=0.0):
    """Both may be arrays. Tolerances: `absolute` is half a unit of the last digit that a column prints (twice, where both are printed)."""
    one, other = numpy.asarray(one, dtype=float), numpy.asarray(other, dtype=float)
    if one.shape != other.shape:
        return check(False, f"{what}: {one.shape} against {other.shape} numbers")
    off = numpy.abs(one - other) - absolute - relative * numpy.abs(other)
    worst = int(numpy.argmax(off)) if off.size else 0
    check(off.size > 0 and not off.flat[worst] > 0 and not numpy.isnan(off).any(),
          f"{what}: {one.flat[worst] if one.size else None!r}, recomputed {other.flat[worst] if one.size else None!r} (number {worst})")


class Table:
    """Columns of a CSV file by name."""

    def __init__(self, path):
        with open(path) as file:
            rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
        self.rows, self.names = rows, list(rows[0])

    def __getitem__(self, name):
        return numpy.array([float(row[name]) if row[name] else math.nan for row in self.rows])

    def text(self, name):
        return [row[name] for row in self.rows]


def run(*arguments, code=0):
    ended = subprocess.run([str(flank), *map(str, arguments)], capture_output=True, text=True)
    if ended.returncode != code:
        sys.exit(f"FAILED: flank {' '.join(map(str, arguments))}: exit code {ended.returncode}\n{ended.stderr}")
    return ended.stdout


def harmonics(values):
    """Amplitudes and phases [deg] of value = mean + sum A_i cos(2 pi i k/n + phase_i)."""
    n = len(values)
    c = numpy.fft.fft(values) / n
    return [(abs(c[i]) * (1 if 2 * i == n else 2), math.degrees(numpy.angle(c[i]))) for i in range(1, n // 2 + 1)]


def same_phase(one, other):
    return abs((one - other + 180) % 360 - 180)


def check_harmonics(table, te_by_torque, what):
    for torque, te in te_by_torque.items():
        rows = [row for row in table.rows if float(row["torque_Nm"]) == torque]
        expected = harmonics(te)
        check(len(rows) == len(expected), f"{what}: {len(rows)} harmonics at {torque} N m, of {len(te)} positions {len(expected)}")
        for row, (amplitude, phase) in zip(rows, expected):
            near(float(row["amplitude_um"]), amplitude, f"{what}: A{row['harmonic']} at {torque} N m", absolute=3e-9)
            if amplitude > 1e-4:
                check(same_phase(float(row["phase_deg"]), phase) < 1e-3, f"{what}: phase of A{row['harmonic']} at {torque} N m")
            check(int(row["aliased"]) == int(4 * int(row["harmonic"]) > len(te)), f"{what}: aliased, A{row['harmonic']}")


UNITS = {
    "pinion_torque": "N m", "phase": "mesh cycle", "transmission_error": "um", "mesh_stiffness": "N/um", "max_pressure": "MPa",
    "max_pressure_roll_angle": "deg", "max_pressure_z": "mm", "edge_pressure": "MPa", "gear_torque": "N m", "max_line_load": "N/mm",
    "load_centre_z": "mm", "shuttling_moment": "N m", "tilt_pinion_in_plane": "mrad", "tilt_pinion_across_plane": "mrad",
    "tilt_gear_in_plane": "mrad", "tilt_gear_across_plane": "mrad", "cells/z": "mm", "cells/pinion_roll_angle": "deg",
    "cells/gear_roll_angle": "deg", "cells/area": "mm^2", "cells/unloaded_gap": "um", "cells/pressure": "MPa",
    "modifications/pinion/value": "um", "modifications/gear/roll_angle": "deg", "contact_pattern/torque_1/value": "MPa",
    "contact_pattern/torque_1/z": "mm",
}


def unit(dataset):
    value = dataset.attrs.get("unit", dataset.attrs.get("units"))
    return value.decode() if isinstance(value, bytes) else value


def gear_run(case, folder):
    run("run", case, "-o", folder)
    pair, h5 = Pair(case), h5py.File(folder / "results.h5")
    te, pairs, lines = Table(folder / "te.csv"), Table(folder / "pairs.csv"), Table(folder / "lines.csv")
    positions, torques = 8, sorted(set(te["torque_Nm"]))
    pb, gb, cosine = pair.pinion.base, pair.gear.base, math.cos(pair.beta_b)
    T, um = te["torque_Nm"], te["te_um"]

    # Transmission error: of the driven gear's rotation; its stiffnesses, of the force in the transverse plane.
    near(te["te_arcsec"], um * 1e-3 / gb / arcsec, "te_arcsec, at the gear's base radius", absolute=1e-8)
    near(te["secant_stiffness_N_per_um"], T * 1e3 / pb / um, "secant stiffness: torque over base radius and TE", absolute=1e-6)
    near(te["phase"], te["position"] / positions, "phase", absolute=1e-9)
    at = {torque: um[T == torque] for torque in torques}
    tangent = {torque: te["mesh_stiffness_N_per_um"][T == torque] for torque in torques}
    quotient = 10.0 / pb / (at[90.01] - at[90.0])
    # The columns' 1e-9 um over 0.004 um: 5e-7; between both torques a cell may enter, which changes it by less than 1e-3.
    near(tangent[90.0], quotient, "mesh stiffness: difference quotient of force and TE", relative=1e-3)
    check(abs(tangent[0.0]).max() == 0 and abs(te["secant_stiffness_N_per_um"][T == 0]).max() == 0, "stiffness unloaded")
    check(all((tangent[b] >= 0.97 * tangent[a]).all() for a, b in zip(torques, torques[1:])), "mesh stiffness grows with torque")

    # Pairs: forces in equilibrium, shares, contacts.
    for row in range(len(te.rows)):
        mine = (pairs["torque_Nm"] == T[row]) & (pairs["position"] == te["position"][row])
        force = pairs["normal_force_N"][mine]
        where = f"at {T[row]} N m, position {int(te['position'][row])}"
        check(int(te["contacts"][row]) == mine.sum(), f"contacts {where}")
        if not mine.any():
            check(T[row] == 0, f"nothing carries {where}")
            continue
        near(pairs["load_share"][mine], force / force.sum(), f"load shares {where}", absolute=1e-8)
        near(te["shuttling_moment_Nm"][row], 1e-3 * force.sum() * cosine * te["load_centre_z_mm"][row],
             f"shuttling moment: force in the transverse plane by its centre {where}", absolute=3e-5 * force.sum() / 1e3, relative=1e-6)
        line = (lines["torque_Nm"] == T[row]) & (lines["position"] == te["position"][row])
        near(te["max_line_load_N_per_mm"][row], lines["load_per_length_N_per_mm"][line].max(), f"greatest line load {where}", absolute=1e-6)

    # Cells: the raw state that all of it follows from.
    c, slices = h5["cells"], 31
    width = (pair.high - pair.low) / slices
    gaps = edge_gaps = 0
    for t, torque in enumerate(h5["pinion_torque"]):
        for k in range(positions):
            n, first, start = (int(c[name][t, k]) for name in ("count", "first_cell", "first_pressure"))
            if n == 0:
                continue
            cell = {name: c[name][first : first + n] for name in ("pair", "z", "pinion_roll_angle", "gear_roll_angle", "area", "unloaded_gap", "place")}
            pressure = c["pressure"][start : start + n]
            force, where, row = pressure * cell["area"], f"at {torque} N m, position {k}", t * positions + k
            mine = (pairs["torque_Nm"] == torque) & (pairs["position"] == k)
            for number, share in zip(pairs["pair"][mine], pairs["normal_force_N"][mine]):
                near(force[cell["pair"] == number].sum(), share, f"force of pair {int(number)} {where}", absolute=2e-6)
            near(te["load_centre_z_mm"][row], (force * cell["z"]).sum() / force.sum(), f"load centre {where}", absolute=1e-6)
            inside = cell["place"] == 0
            near(te["max_pressure_MPa"][row], pressure[inside].max(initial=0), f"greatest pressure inside {where}", absolute=1e-4)
            near(te["edge_pressure_MPa"][row], pressure[~inside].max(initial=0), f"greatest pressure at edges {where}", absolute=1e-4)
            if pressure[inside].max(initial=0) > 0:
                peak = numpy.flatnonzero(inside)[pressure[inside].argmax()]
                near(te["max_pressure_pinion_roll_angle_deg"][row], cell["pinion_roll_angle"][peak], f"roll angle of the greatest pressure {where}", absolute=1e-6)
                near(te["max_pressure_z_mm"][row], cell["z"][peak], f"z of the greatest pressure {where}", absolute=1e-6)
            # Lines: the force of a slice over the length of contact line in it.
            mine = (lines["torque_Nm"] == torque) & (lines["position"] == k)
            for number, z, load in zip(lines["pair"][mine], lines["z_mm"][mine], lines["load_per_length_N_per_mm"][mine]):
                here = (cell["pair"] == number) & (numpy.abs(cell["z"] - z) < width / 2) & inside
                if here.sum() == ((cell["pair"] == number) & (numpy.abs(cell["z"] - z) < width / 2)).sum():
                    near(load, force[here].sum() / (width / cosine), f"load per length of contact line at z = {z} {where}", absolute=1e-5, relative=2e-3)
            # Moments: a force normal to an involute has its base radius as lever about its gear; tip edges have the mate's normal.
            entering = cell["pinion_roll_angle"] < math.degrees(math.tan(pair.alpha_wt))  # there it is the gear's tip that is an edge
            edges = numpy.flatnonzero(((cell["place"] == 1) | (cell["place"] == 3)) & (force > 0))
            pinion_levers, gear_levers = numpy.full(n, pb * cosine), numpy.full(n, gb * cosine)
            for i in edges:
                tip, at_roll, z, number = "gear" if entering[i] else "pinion", math.radians(cell["pinion_roll_angle"][i]), cell["z"][i], int(cell["pair"][i])
                apart, mate, _, _, opened = pair.edge_contact(at_roll, z, number, k / positions, tip)
                middle = pair.low + (math.floor((z - pair.low) / width) + 0.5) * width  # of the slice: a cell that is cut at the edge has another
                pinion_levers[i], gear_levers[i] = pair.levers(middle, number, k / positions)
                expected = 1e3 * apart + pair.removed("pinion", at_roll, z) + pair.removed("gear", mate, z - pair.offset) + pair.stand_back(number, k / positions) + opened
                near(cell["unloaded_gap"][i], expected, f"gap at the {tip}'s tip edge, pair {number}, z = {z:.3f} {where}", absolute=0.1)
                edge_gaps += 1
            near((force * pinion_levers).sum() / 1e3, torque, f"torque of the pinion {where}", relative=1e-7)
            near(te["gear_torque_Nm"][row], (force * gear_levers).sum() / 1e3, f"torque of the gear {where}", relative=1e-7)
            # Tilts of the axes: springs under the moments of the normal forces about each gear's middle. Half a percent: at tip edges the normal is another.
            sine = math.sin(pair.beta_b)
            for name, side, moments, across in (
                ("pinion", -1, cell["z"] * cosine + pair.lead_sign * pb * numpy.radians(cell["pinion_roll_angle"]) * sine, pb * sine),
                ("gear", 1, (cell["z"] - pair.offset) * cosine - pair.lead_sign * gb * numpy.radians(cell["gear_roll_angle"]) * sine, gb * sine)):
                stiffness = [pair.case["mounting"][f"{name}_tilt_{plane}_Nm_per_mrad"] for plane in ("in_plane", "across_plane")]
                near(h5[f"tilt_{name}_in_plane"][t, k] * stiffness[0], side * 1e-3 * (force * moments).sum(), f"tilt of the {name} in the plane of action {where}",
                     relative=0.005, absolute=2e-3)
                near(h5[f"tilt_{name}_across_plane"][t, k] * stiffness[1], 1e-3 * force.sum() * across, f"tilt of the {name} across the plane of action {where}", relative=0.005)
            # Gaps on the contact lines, from the case: 0.1 um is what a relief's knee or a quadratic relief averages to over a cell.
            roll = numpy.radians(cell["pinion_roll_angle"])
            on_line = inside & (numpy.abs(pb * roll + gb * numpy.radians(cell["gear_roll_angle"]) - pair.action) < 1e-9)
            for i in numpy.flatnonzero(on_line):
                number, z = int(cell["pair"][i]), cell["z"][i]
                off = pair.on_line_of_action(roll[i], z, number, k / positions)
                check(abs(off) < 1e-6, f"a cell of pair {number} at z = {z:.3f} is {off:.6f} mm off its contact line {where}")
                half = cell["area"][i] / (2 * width / cosine)
                near(cell["unloaded_gap"][i], pair.gap(roll[i], z, number, k / positions) + 1e3 * half**2 / 6 / pair.normal_radius(roll[i]),
                     f"gap of pair {number} at z = {z:.3f} {where}", absolute=0.1)
                gaps += 1
    check(gaps > 300 and edge_gaps > 50, f"{gaps} gaps on contact lines, {edge_gaps} at tip edges")

    # results.h5 = te.csv; units.
    for name, column, absolute in (
        ("transmission_error", "te_um", 6e-10), ("mesh_stiffness", "mesh_stiffness_N_per_um", 6e-7), ("max_pressure", "max_pressure_MPa", 6e-5),
        ("max_pressure_roll_angle", "max_pressure_pinion_roll_angle_deg", 6e-7), ("max_pressure_z", "max_pressure_z_mm", 6e-7),
        ("edge_pressure", "edge_pressure_MPa", 6e-5), ("gear_torque", "gear_torque_Nm", 1e-6), ("max_line_load", "max_line_load_N_per_mm", 6e-7),
        ("load_centre_z", "load_centre_z_mm", 6e-7), ("shuttling_moment", "shuttling_moment_Nm", 6e-10)):
        near(h5[name][:].ravel(), te[column], f"results.h5, {name}", absolute=absolute)
    for name, expected in UNITS.items():
        check(unit(h5[name]) == expected, f"unit of {name}: {unit(h5[name])!r}")
    check_harmonics(Table(folder / "harmonics.csv"), at, "harmonics.csv")

    # Maps.
    for name in ("pinion", "gear"):
        group, body = h5[f"modifications/{name}"], getattr(pair, name)
        middle = 0.0 if name == "pinion" else pair.offset
        expected = [[pair.removed(name, math.radians(roll), z - middle) for z in group["z"]] for roll in group["roll_angle"]]
        near(group["value"][:], expected, f"modifications/{name}", absolute=1e-6)
        near([group["roll_angle"][0], group["roll_angle"][-1]], numpy.degrees([body.start_roll, body.tip_roll]), f"active profile of the {name}", absolute=1e-6)
    total, roll = h5["modifications/sum"], numpy.radians(h5["modifications/sum/roll_angle"][:])
    near(total["value"][:], [[pair.removed("pinion", r, z) + pair.removed("gear", (pair.action - pb * r) / gb, z - pair.offset) for z in total["z"]] for r in roll],
         "modifications/sum", absolute=1e-6)
    removed = Table(folder / "modifications.csv")
    for name in ("pinion", "gear", "sum"):
        near(removed["removed_um"][[flank_name == name for flank_name in removed.text("flank")]], h5[f"modifications/{name}/value"][:].ravel(), f"modifications.csv, {name}", absolute=6e-7)
    pattern = Table(folder / "pattern.csv")
    for t, torque in enumerate(torques):
        if torque > 0:
            map_ = h5[f"contact_pattern/torque_{t}/value"][:]
            near(pattern["pressure_MPa"][pattern["torque_Nm"] == torque], map_.ravel(), f"pattern.csv at {torque} N m", absolute=6e-7)
            light = h5[f"contact_pattern_at_1_percent/torque_{t}/value"][:]
            near(pattern["pressure_MPa"][numpy.abs(pattern["torque_Nm"] - torque / 100) < 1e-9], light.ravel(), f"pattern.csv at 1 % of {torque} N m", absolute=6e-7)
            check(light.max() < 0.5 * map_.max(), f"pattern at 1 % of {torque} N m")
    summary_of_run(folder, pair, te, pairs, lines, at, tangent, h5)
    subsurface(folder, pair, te)


def summary_of_run(folder, pair, te, pairs, lines, at, tangent, h5):
    """The two tables on the screen."""
    text = (folder / "summary.txt").read_text().splitlines()
    rows = [[float(word) for word in line.split()] for line in text if re.fullmatch(r"[\s0-9.e+-]+", line) and line.strip()]
    first, second = [row for row in rows if len(row) == 13], [row for row in rows if len(row) == 11]
    check(len(first) == len(at) and len(second) == len(at) - 1, f"summary: {len(first)} and {len(second)} rows")
    T, pb = te["torque_Nm"], pair.pinion.base
    for row, torque in zip(first, sorted(at)):
        values, mine = at[torque], T == torque
        amplitudes = [a for a, _ in harmonics(values)] + [0.0]
        expected = [torque, values.mean(), values.max() - values.min(), *amplitudes[:5], te["contacts"][mine].mean(), te["max_pressure_MPa"][mine].max(),
                    te["edge_pressure_MPa"][mine].max(), tangent[torque].mean(), torque * 1e3 / pb / values.mean()]
        near(row, expected, f"summary, first table at {torque} N m", absolute=[6e-4] + [6e-5] * 7 + [6e-4, 0.06, 0.06, 6e-3, 6e-3])
    for row, torque in zip(second, [torque for torque in sorted(at) if torque > 0]):
        mine, line, share = T == torque, lines["torque_Nm"] == torque, pairs["load_share"][pairs["torque_Nm"] == torque]
        peak = numpy.flatnonzero(mine)[te["max_pressure_MPa"][mine].argmax()]
        by_slice = {}
        for z, load in zip(lines["z_mm"][line], lines["load_per_length_N_per_mm"][line]):
            by_slice[round((z - pair.low) / (pair.high - pair.low) * 31 - 0.5)] = by_slice.get(round((z - pair.low) / (pair.high - pair.low) * 31 - 0.5), 0) + load
        moment = te["shuttling_moment_Nm"][mine]
        t = sorted(at).index(torque)
        covered = (h5[f"contact_pattern/torque_{t}/value"][:] > 0).mean()
        expected = [torque, share.min(), share.max(), te["max_pressure_pinion_roll_angle_deg"][peak], te["max_pressure_z_mm"][peak], te["phase"][peak],
                    te["max_line_load_N_per_mm"][mine].max(), max(by_slice.values()) / (sum(by_slice.values()) / 31), 100 * covered, moment.mean(), moment.max() - moment.min()]
        near(row, expected, f"summary, second table at {torque} N m", absolute=[6e-4] + [6e-5] * 5 + [0.06, 6e-5, 0.06, 6e-5, 6e-5])


def subsurface(folder, pair, te):
    """Against Hertz's line contact at the same greatest pressure, where the contact is one: away from edges and knees of reliefs."""
    table = Table(folder / "subsurface.csv")
    near(table["max_pressure_MPa"], te["max_pressure_MPa"][te["torque_Nm"] > 0], "subsurface.csv: greatest pressure", absolute=1e-4)
    modulus = 1 / sum((1 - body.nu**2) / body.youngs for body in (pair.pinion, pair.gear))
    rows = [(row, te.rows[i]) for row, i in zip(table.rows, numpy.flatnonzero(te["torque_Nm"] > 0))]
    compared = 0
    for row, whole in rows:
        roll, z = math.radians(float(whole["max_pressure_pinion_roll_angle_deg"])), float(whole["max_pressure_z_mm"])
        if abs(z) > 1 or not 22 < math.degrees(roll) < 26 or not row["shear_MPa"]:
            continue
        pressure = float(row["max_pressure_MPa"])
        half_width = 2 * pressure * pair.normal_radius(roll) / modulus
        near(float(row["shear_MPa"]), 0.3003 * pressure, "greatest shear of a line contact", relative=0.05)
        near(float(row["shear_depth_um"]), 786 * half_width, "its depth (at draft: five cells over the half-width)", relative=0.2)
        compared += 1
    # One shape of the pressure, whatever its size: both depths keep their ratio, that of a line contact (0.786 to 0.70 half-widths at nu 0.3).
    both = [(float(r["shear_depth_um"]), float(r["von_mises_depth_um"])) for r in table.rows if r["shear_MPa"] and float(r["von_mises_depth_um"]) > 0]
    check(all(1.0 < a / b < 1.35 for a, b in both) and len(both) > 10, "depths of greatest shear and von Mises stress")
    check(compared > 0, "no line contact to compare with")


def cubic(torques, values, slopes, torque):
    """Hermite's cubic between two neighbouring torques."""
    i = min(max(numpy.searchsorted(torques, torque, side="right") - 1, 0), len(torques) - 2)
    w = torques[i + 1] - torques[i]
    s = (torque - torques[i]) / w
    return ((1 + 2 * s) * (1 - s) ** 2 * values[i] + s * (1 - s) ** 2 * w * slopes[i] + s * s * (3 - 2 * s) * values[i + 1] + s * s * (s - 1) * w * slopes[i + 1])


def minima(torques, quantity):
    """All local minima inside, from a fine sampling: to a thousandth of the range."""
    at = numpy.linspace(torques[0], torques[-1], 2401)
    value = [quantity(torque) for torque in at]
    return [at[i] for i in range(1, len(at) - 1) if value[i] <= value[i - 1] and value[i] < value[i + 1]]


def study(case, folder, base_radius, run_folder=None):
    """designs.csv and te.csv from study.h5's transmission errors and slopes; variant 0 is the run."""
    run("study", case, "-o", folder)
    designs, te, h5 = Table(folder / "designs.csv"), Table(folder / "te.csv"), h5py.File(folder / "study.h5")
    block = h5["block_0"]
    torques = block["torque"][:]
    order = numpy.argsort(torques)
    for v, variant in enumerate(block["variant"]):
        rows = te["variant"] == variant
        for name, column, absolute in (("te", "te_um", 6e-10), ("max_pressure", "max_pressure_MPa", 6e-5), ("edge_pressure", "edge_pressure_MPa", 6e-5),
                                       ("mesh_stiffness", "mesh_stiffness_N_per_um", 6e-7)):
            near(block[name][v].ravel(), te[column][rows], f"study.h5, {name} of variant {v}", absolute=absolute)
        loaded = torques > 0
        near(block["te_slope"][v][loaded], 1e3 / (base_radius * block["mesh_stiffness"][v][loaded]), f"te_slope of variant {v}", relative=1e-9)
        values, slopes = block["te"][v][order], block["te_slope"][v][order]
        sides = [lambda x: harmonics(x)[0][0], lambda x: x.max() - x.min()]
        if (slopes > 0).all():
            for column, quantity in zip(("T_d_by_A1_Nm", "T_d_by_peak_to_peak_Nm"), sides):
                expected = minima(torques[order], lambda T: quantity(cubic(torques[order], values, slopes, T)))
                for text in {row[column] for row in designs.rows if float(row["variant"]) == variant}:
                    found = [float(word) for word in text.split(";") if word]
                    near(found, expected, f"{column} of variant {v}", absolute=torques.max() / 1000) if expected or found else None
        for t, torque in enumerate(torques):
            row = next(r for r in designs.rows if float(r["variant"]) == variant and abs(float(r["torque_Nm"]) - torque) < 1e-9)
            x, where = block["te"][v][t], f"of variant {v} at {torque} N m"
            amplitudes = [a for a, _ in harmonics(x)] + [0.0] * 5
            for name, expected in [("mean_te_um", x.mean()), ("peak_to_peak_um", x.max() - x.min()), *((f"A{i + 1}_um", amplitudes[i]) for i in range(5))]:
                near(float(row[name]), expected, f"{name} {where}", absolute=2e-9)
            near(float(row["max_pressure_MPa"]), block["max_pressure"][v][t].max(), f"max_pressure_MPa {where}", absolute=6e-5)
            near(float(row["edge_pressure_MPa"]), block["edge_pressure"][v][t].max(), f"edge_pressure_MPa {where}", absolute=6e-5)
            near(float(row["mean_mesh_stiffness_N_per_um"]), block["mesh_stiffness"][v][t].mean(), f"mean stiffness {where}", absolute=6e-7)
    for name, expected in (("torque", "N m"), ("te", "um"), ("te_slope", "um/(N m)"), ("max_pressure", "MPa"), ("edge_pressure", "MPa"), ("mesh_stiffness", "N/um")):
        check(unit(block[name]) == expected, f"study.h5, unit of {name}: {unit(block[name])!r}")
    if run_folder:
        single = Table(run_folder / "te.csv")
        for column in ("torque_Nm", "position", "phase", "te_um", "contacts", "max_pressure_MPa", "edge_pressure_MPa", "mesh_stiffness_N_per_um"):
            near(te[column][te["variant"] == 0], single[column], f"variant 0 against the run, {column}")
    return designs


def derivatives(designs, keys):
    """Exact ones against central differences of variants: 0 the base, then two for each key, a step more and a step less."""
    torques = sorted(set(designs["torque_Nm"]))
    for number, (key, step) in enumerate(keys):
        for torque in torques[1:]:
            base, more, less = (next(r for r in designs.rows if float(r["variant"]) == v and float(r["torque_Nm"]) == torque) for v in (0, 2 * number + 1, 2 * number + 2))
            for column, name in (("mean_te_um", "mean_te"), ("A1_um", "A1"), ("A2_um", "A2"), ("peak_to_peak_um", "peak_to_peak")):
                quotient = (float(more[column]) - float(less[column])) / (2 * step)
                # A window of the grid may be another one on both sides: up to 0.005 um, as between neighbouring torque bands (seen here: 0.003).
                near(float(base[f"d_{name}_um/d_{key}"]), quotient, f"derivative of {name} by {key} at {torque} N m", relative=0.02, absolute=0.005 / (2 * step))


class Drive:
    """Kinematics of the drive from its case: crank counter-clockwise, carrier clockwise by psi [rad]."""

    def __init__(self, path):
        import tomllib
        with open(path, "rb") as file:
            self.case = tomllib.load(file)
        d = self.d = self.case["drive"]
        self.n = d["rollers"]
        self.radius = d["sleeve_circle_radius_mm"]

    def centre(self, part, radius, count, number):
        angle = 2 * math.pi / count * (number if part == "roller" else number - 0.5)
        outwards, along = numpy.array([math.cos(angle), math.sin(angle)]), numpy.array([-math.sin(angle), math.cos(angle)])
        errors = [1e-3 * self.d.get(f"{part}_{way}_errors_um", [0] * count)[number - 1] for way in ("radial", "tangential")]
        return (radius + errors[0]) * outwards + errors[1] * along

    def apart(self, roller, sleeve, phi, psi):
        """From the axis of the sleeve to that of the roller."""
        turn = numpy.array([[math.cos(psi), math.sin(psi)], [-math.sin(psi), math.cos(psi)]])
        axis = self.d["eccentricity_mm"] * numpy.array([math.cos(phi), math.sin(phi)])
        arm = turn @ self.centre("sleeve", self.radius, self.n - 1, sleeve)
        return self.centre("roller", self.d["roller_circle_radius_mm"], self.n, roller) - axis - arm, arm, axis

    def gap(self, roller, sleeve, phi, psi):
        radii = self.d["roller_radius_mm"] + self.d["sleeve_radius_mm"] - 1e-3 * self.d.get("uniform_clearance_um", 0)
        for part, number in (("roller", roller), ("sleeve", sleeve)):
            radii += 1e-3 * self.d.get(f"{part}_radius_errors_um", [0] * self.n)[number - 1]
        return math.hypot(*self.apart(roller, sleeve, phi, psi)[0]) - radii

    def levers(self, roller, sleeve, phi, psi):
        """Of a unit force: about the carrier's axis, turning it on, and for the crank [mm]."""
        d, arm, axis = self.apart(roller, sleeve, phi, psi)
        t = -d / math.hypot(*d)  # of the roller's force on the sleeve
        return -(arm[0] * t[1] - arm[1] * t[0]), -(axis[0] * t[1] - axis[1] * t[0])


def drive_run(case, folder, *settings):
    run("run", case, "-o", folder, *(word for setting in settings for word in ("--set", setting)))
    drive, h5 = Drive(case), h5py.File(folder / "results.h5")
    te, pairs, unloaded = Table(folder / "te.csv"), Table(folder / "pairs.csv"), Table(folder / "unloaded.csv")
    on_input = "model.torque_on=input" in settings
    n = drive.n - 1
    phi, psi, T = numpy.radians(te["crank_angle_deg"]), numpy.radians(te["carrier_rotation_deg"]), te["torque_Nm"]
    near(te["te_arcsec"], (phi / n - psi) / arcsec, "te_arcsec: lag of the carrier", absolute=2e-6)
    near(te["te_um"], te["te_arcsec"] * arcsec * drive.radius * 1e3, "te_um at R1", absolute=2e-9, relative=1e-8)
    torques = sorted(set(T))
    loads = numpy.zeros(len(T))
    for row in range(len(te.rows)):
        mine = numpy.flatnonzero((pairs["torque_Nm"] == T[row]) & (pairs["position"] == te["position"][row]))
        where, moments = f"at {T[row]} N m, crank angle {te['crank_angle_deg'][row]}", []
        check(int(te["contacts"][row]) == len(mine), f"contacts {where}")
        near(te["max_pressure_MPa"][row], pairs["mid_pressure_MPa"][mine].max(initial=0), f"greatest pressure {where}", absolute=1e-4)
        near(te["edge_pressure_MPa"][row], pairs["edge_pressure_MPa"][mine].max(initial=0), f"edge pressure {where}", absolute=1e-4)
        for i in mine:
            roller, sleeve = int(pairs["roller"][i]), int(pairs["sleeve"][i])
            near(pairs["approach_um"][i], -1e3 * drive.gap(roller, sleeve, phi[row], psi[row]), f"approach of {roller}, {sleeve} {where}", absolute=2e-6)
            lever, crank = drive.levers(roller, sleeve, phi[row], psi[row])
            near(pairs["lever_mm"][i], lever, f"lever of {roller}, {sleeve} {where}", absolute=1e-8)
            check((pairs.text("flank")[i] == "drive") == (lever > 0), f"flank of {roller}, {sleeve} {where}")
            moments.append(pairs["normal_force_N"][i] * (crank if on_input else lever) / 1e3)
        if T[row] > 0:
            near(sum(moments), T[row], f"torque on the {'crank' if on_input else 'carrier'} {where}", relative=1e-6)
    at = {torque: T == torque for torque in torques}
    count = int(at[torques[0]].sum())
    lag = {torque: (phi / n - psi)[at[torque]] for torque in torques}
    # Ratios: of the crank over a degree, and at a point, of its own column of rotations: central differences over two degrees are good to 1 %.
    for torque in torques:
        secant = numpy.radians(1.0) / numpy.diff(psi[at[torque]])
        near(te["gear_ratio_secant"][at[torque]][:-1], secant, f"gear_ratio_secant at {torque} N m", relative=1e-7)
    near(te["gear_ratio"], te["gear_ratio_instantaneous"], "gear_ratio: instantaneous by default")
    if not on_input:
        quotient = 1.0 / ((lag[10.001] - lag[10.0]) / arcsec / 60)  # 1e-3 N m over what it winds up, in arcmin: [1e-3 N m/arcmin]
        near(te["torsional_stiffness_Nm_per_arcmin"][at[10.0]], 1e-3 * quotient, "torsional stiffness: difference quotient", relative=1e-3)
        near(te["torsional_stiffness_secant_Nm_per_arcmin"][at[30.0]], 30.0 / ((lag[30.0] - lag[0.0]) / arcsec / 60), "secant torsional stiffness", relative=1e-6)
        near(te["mesh_stiffness_N_per_um"], te["torsional_stiffness_Nm_per_arcmin"] * 1e3 / (60 * arcsec) / drive.radius**2 / 1e3, "mesh stiffness: torsional over R1^2",
             relative=1e-6, absolute=1e-6)
    for name, column, absolute in (("transmission_error", "te_um", 6e-10), ("transmission_error_rotation", "te_arcsec", 6e-10), ("gear_ratio_instantaneous", "gear_ratio_instantaneous", 6e-10),
                                   ("gear_ratio_secant", "gear_ratio_secant", 6e-10), ("contacts", "contacts", 0), ("max_pressure", "max_pressure_MPa", 6e-5),
                                   ("edge_pressure", "edge_pressure_MPa", 6e-5), ("torsional_stiffness", "torsional_stiffness_Nm_per_arcmin", 6e-10)):
        near(h5[name][:].ravel(), te[column], f"drive's results.h5, {name}", absolute=absolute)
    for name, expected in (("torque", "N m"), ("crank_angle", "deg"), ("transmission_error", "um"), ("transmission_error_rotation", "arcsec"), ("max_pressure", "MPa"),
                           ("torsional_stiffness", "N m/arcmin"), ("preload", "N")):
        check(unit(h5[name]) == expected, f"drive's unit of {name}: {unit(h5[name])!r}")
    check_harmonics(Table(folder / "harmonics.csv"), {torque: te["te_um"][at[torque]][: 20] for torque in torques}, "drive's harmonics.csv")
    # Unloaded: the gap at the nominal rotation, none at the contact rotation; the backlash from the first pair to touch.
    for row in unloaded.rows:
        angle, roller, sleeve = math.radians(float(row["crank_angle_deg"])), int(row["roller"]), int(row["sleeve"])
        touching, where = math.radians(float(row["contact_rotation_deg"])), f"of {row['roller']}, {row['sleeve']} at crank angle {row['crank_angle_deg']}"
        near(float(row["gap_um"]), 1e3 * drive.gap(roller, sleeve, angle, angle / n), f"nominal gap {where}", absolute=2e-6)
        near(drive.gap(roller, sleeve, angle, touching), 0, f"gap at the contact rotation {where}", absolute=1e-9)
        near(float(row["lever_mm"]), drive.levers(roller, sleeve, angle, touching)[0], f"lever at the contact rotation {where}", absolute=1e-8)
        mine = [float(r["contact_rotation_deg"]) for r in unloaded.rows if r["crank_angle_deg"] == row["crank_angle_deg"] and r["flank"] == row["flank"]]
        first = max(mine) if row["flank"] == "drive" else min(mine)
        near(float(row["phi_d_deg"]), first, f"first contact rotation {where}", absolute=1e-9)
        near(float(row["backlash_arcsec"]), abs(first - float(row["contact_rotation_deg"])) * 3600, f"backlash {where}", absolute=1e-5)
    # Pressure maps, a quarter of the contact: four times their sum is the pair's force; along the roller a light load stays on the straight part and what the crown leaves of it.
    maps = 0
    for name, position in h5["pressure_maps"].items():
        t, k = (int(word) for word in re.fullmatch(r"torque_(\d+)_position_(\d+)", name).groups())
        for pair, columns in position.items():
            roller, sleeve = (int(word) for word in re.fullmatch(r"roller_(\d+)_sleeve_(\d+)", pair).groups())
            force = next(float(r["normal_force_N"]) for r in pairs.rows if float(r["torque_Nm"]) == h5["torque"][t] and int(r["position"]) == k
                         and int(r["roller"]) == roller and int(r["sleeve"]) == sleeve)
            p, y = columns["pressure"][:], columns["y"][:]
            near(4 * (p * 4 * columns["half_x"][:] * columns["half_y"][:]).sum(), force, f"force of the pressure map {name}/{pair}", relative=1e-6)
            crown = drive.d["crown"]
            reach = numpy.abs(y[p > 0]).max()
            approach = next(float(r["approach_um"]) for r in pairs.rows if float(r["torque_Nm"]) == h5["torque"][t] and int(r["position"]) == k
                            and int(r["roller"]) == roller and int(r["sleeve"]) == sleeve)
            most = crown["straight_length_mm"] / 2 + math.sqrt(2 * crown["radius_mm"] * 1e-3 * approach)
            half_cell = columns["half_y"][:].max()
            check(crown["straight_length_mm"] / 2 - half_cell < reach < min(most, drive.d["width_mm"] / 2) + half_cell,
                  f"loaded length of {name}/{pair}: {reach:.3f} mm, straight to {crown['straight_length_mm'] / 2}, the crown has dropped by the approach at {most:.3f}")
            maps += 1
    check(maps > 2, f"{maps} pressure maps")


def main():
    with tempfile.TemporaryDirectory() as work:
        work = pathlib.Path(work)
        os.environ.update({"FLANK_CACHE": str(work / "cache"), "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"})
        pair_case = root / "tests/cases/standing_pair.toml"
        gear_run(pair_case, work / "run")
        text = pair_case.read_text()
        text = text[: text.index("[output]")] + '[output]\nderivatives = "yes"\n'
        keys = [("pinion.lead_crown.amount_um", 4.0, 0.3), ("gear.root_relief.amount_um", 4.0, 0.3), ("pinion.right_flank.tip_relief.amount_um", 7.0, 0.3)]
        text += "[[study]]\nset = [" + ", ".join(f'"{key}"' for key, _, _ in keys) + "]\nrows = [" + ", ".join(
            "[" + ", ".join(str(value + side * step * (i == changed)) for i, (_, value, step) in enumerate(keys)) + "]"
            for changed, side in [(-1, 0), *((i, side) for i in range(len(keys)) for side in (1, -1))]) + "]\n"
        (work / "study.toml").write_text(text)
        designs = study(work / "study.toml", work / "study", Pair(pair_case).pinion.base, work / "run")
        derivatives(designs, [(key, step) for key, _, step in keys])
        spur = (root / "cases/parallel_axis/spur_tip_relief_23p6.toml").read_text().replace("[50, 100, 200, 300]", "[20, 60, 100, 140, 180, 220, 260, 300]")
        (work / "spur.toml").write_text('accuracy = "draft"\n' + spur + '[[study]]\nset = "pinion.tip_relief.amount_um"\nvalues = [10, 14]\n')
        study(work / "spur.toml", work / "spur", 75 * math.cos(math.radians(20)))
        drive_case = root / "tests/cases/standing_drive.toml"
        drive_run(drive_case, work / "drive")
        drive_run(drive_case, work / "crank", "model.torque_on=input", "load.output_torque_Nm=[0.5, 1, 2]")
    for failure in failures:
        print("FAILED:", failure)
    print(f"{checks} checks, {len(failures)} failed")
    sys.exit(bool(failures))


if __name__ == "__main__":
    main()
