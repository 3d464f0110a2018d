# SPDX-License-Identifier: GPL-2.0-or-later
"""Two rollers pressed together: tables against the cells in results.h5,
Hertz's formulas from complete elliptic integrals by the arithmetic-geometric mean,
the principal curvatures as eigenvalues, a study against runs.
"""
import math, re, tomllib

import h5py, numpy
from checks import Table, check, near, run, unit


def elliptic(m):
    """K and E of the parameter m, by the arithmetic-geometric mean."""
    a, b, c, power, total = 1.0, math.sqrt(1 - m), math.sqrt(m), 1.0, m / 2
    for _ in range(12):  # digits double each time
        a, b, c = (a + b) / 2, math.sqrt(a * b), (a - b) / 2
        total += power * c * c
        power *= 2
    k = math.pi / (2 * a)
    return k, k * (1 - total)


def hertz(least, greatest, modulus, force):
    """Half-axes, pressure and approach of the ellipse, by bisection of its axes' ratio."""
    low, high = 1e-9, 1 - 1e-9
    for _ in range(200):
        ratio = math.sqrt(low * high)
        k, e = elliptic(1 - ratio**2)
        if (e / ratio**2 - k) / (k - e) > greatest / least:
            low = ratio
        else:
            high = ratio
    m = 1 - ratio**2
    long = (force * 3 * (k - e) / m / (math.pi * modulus * least)) ** (1 / 3)
    pressure = 1.5 * force / (math.pi * ratio * long**2)
    return long, ratio * long, pressure, pressure / modulus * ratio * long * k


def curvatures(first, second, angle):
    """Eigenvalues of the sum of both rollers' curvatures: 1/R across the axis, 1/crown along it."""
    total = numpy.diag([1 / first[0], 1 / first[1] if first[1] else 0])
    c, s = math.cos(angle), math.sin(angle)
    turn = numpy.array([[c, -s], [s, c]])
    total = total + turn @ numpy.diag([1 / second[0], 1 / second[1] if second[1] else 0]) @ turn.T
    return numpy.linalg.eigvalsh(total)


def roller_run(case, folder, first, second, angle=0.0, modulus=206e3 / 0.91 / 2, ends_at=math.inf):
    """first, second: radius and crown radius (0: none) [mm]; up to the force `ends_at` the contact ends
    before the rollers do.
    """
    run("run", case, "-o", folder)
    table, h5 = Table(folder / "contact.csv"), h5py.File(folder / "results.h5")
    check_hdf5(table, h5)
    least, greatest = curvatures(first, second, angle)
    for k, force in enumerate(table["force_N"]):
        if force == 0:
            check(f"force_{k}" not in h5.get("pressure_maps", {}), "unloaded there is no pressure")
            check(table["approach_um"][k] == 0 and table["stiffness_N_per_um"][k] == 0, "unloaded")
            continue
        check_cells(table, h5[f"pressure_maps/force_{k}"], k, force)
        if least > 1e-12:
            check_hertz(table, k, force, hertz(least, greatest, modulus, force), force <= ends_at)
    return table


def check_hdf5(table, h5):
    """results.h5 = contact.csv; units."""
    units = {
        "end_power": "1",
        "end_intensity_MPa_mm": "MPa mm^-end_power",
        "_N_per_um": "N/um",
        "_um": "um",
        "_MPa": "MPa",
        "_mm": "mm",
        "_N": "N",
        "certificate": "relative",
    }
    check(set(h5["contact"]) == set(table.names) - {"variant"}, "results.h5 has the columns of contact.csv")
    for name, values in h5["contact"].items():
        there = ~numpy.isnan(table[name])
        check((numpy.isnan(values[:]) == ~there).all(), f"results.h5: {name} where contact.csv has it")
        if there.any():  # free ends alone have powers and intensities
            near(
                values[:][there],
                table[name][there],
                f"results.h5 and contact.csv, {name}",
                relative=1e-3 if name == "certificate" else 1e-8,
            )
        check(
            unit(values) == next(of for end, of in units.items() if name.endswith(end)),
            f"results.h5: unit of {name}",
        )


def check_cells(table, pressure_map, k, force):
    """The pressures on the cells make the force, in the middle; their extent and the greatest of them."""
    cells = {name: values[:] for name, values in pressure_map.items()}
    forces = 4 * cells["half_x"] * cells["half_y"] * cells["pressure"]
    near(forces.sum(), force, f"sum of pressures at {force} N", relative=1e-9)
    for axis in ("x", "y"):
        near((forces * cells[axis]).sum(), 0, "the force acts in the middle", absolute=1e-9 * force)
        extent = 2 * (abs(cells[axis]) + cells[f"half_{axis}"]).max()
        near(table["width_mm" if axis == "x" else "length_mm"][k], extent, "extent of the contact", 1e-8)
    edge, inside = table["edge_pressure_MPa"][k], table["max_pressure_MPa"][k]
    if edge == 0:
        near(inside, cells["pressure"].max(), "greatest pressure", relative=1e-8)
    else:  # before the rise towards the ends; no contact of these ends across
        row = numpy.round(abs(cells["y"]) / (2 * cells["half_y"]) - 0.5).astype(int)
        of_row = [cells["pressure"][row == r].max() for r in range(row.max() + 1)]
        near(edge, of_row[-1], "pressure at the ends", relative=1e-8)
        falls = [r for r in range(len(of_row) - 5, 0, -1) if of_row[r - 1] >= of_row[r]]
        near(inside, max(of_row[: (falls or [0])[0] + 1]), "pressure before the ends", relative=1e-8)
    check(table["certificate"][k] < 1e-10, "certificate")


def check_hertz(table, k, force, ellipse, is_whole):
    """Hertz's numbers in the table, and the contact against them, if it is a whole ellipse; none if not."""
    long, short, pressure, approach = ellipse
    if not is_whole:
        for name in (name for name in table.names if name.startswith("hertz_")):
            check(math.isnan(table[name][k]), f"{name} of a contact that the ends cut at {force} N")
        check(table["approach_um"][k] > approach * 1e3, f"ends make the contact at {force} N softer")
        return
    near(table["hertz_length_mm"][k], 2 * long, "Hertz, long axis", relative=1e-7)
    near(table["hertz_width_mm"][k], 2 * short, "Hertz, short axis", relative=1e-7)
    near(table["hertz_max_pressure_MPa"][k], pressure, "Hertz, pressure", relative=1e-7)
    near(table["hertz_approach_um"][k], approach * 1e3, "Hertz, approach", relative=1e-7)
    near(table["hertz_stiffness_N_per_um"][k], 1.5 * force / approach / 1e3, "Hertz, stiffness", 1e-7)
    # Cells of 1/16 of the half-axes: see roller_pair_test.
    near(table["approach_um"][k], approach * 1e3, f"approach at {force} N", relative=1e-3)
    near(table["max_pressure_MPa"][k], pressure, f"pressure at {force} N", relative=5e-3)
    near(table["stiffness_N_per_um"][k], 1.5 * force / approach / 1e3, "stiffness", relative=6e-3)
    check(table["edge_pressure_MPa"][k] == 0, f"the contact reaches no end at {force} N")
    # Johnson (1985), table 4.1: 0.300 of the pressure for a line, 0.325 between, 0.310 for a circle.
    check(0.297 < table["shear_MPa"][k] / pressure < 0.33, f"shear below the contact at {force} N")
    check(0.45 < table["shear_depth_um"][k] / (short * 1e3) < 0.82, "depth of the greatest shear")
    check(0.54 < table["von_mises_MPa"][k] / pressure < 0.63, "von Mises below the contact")
    for name in ("shear", "von_mises"):
        own, closed = table[f"{name}_MPa"][k], table[f"hertz_{name}_MPa"][k]
        near(own, closed, f"{name} beside Hertz's at {force} N", relative=1e-2)


def line_contact(text, work):
    """Two straight rollers with parallel axes: Hertz's line, by the shorter one's length."""
    text = re.sub(r"^crown_radius_mm = .*\n|^straight_length_mm = .*\n", "", text, flags=re.M)
    (work / "line.toml").write_text(text)
    run("run", work / "line.toml", "-o", work / "line")
    table, case = Table(work / "line/contact.csv"), tomllib.loads(text)
    first, second = case["first_roller"], case["second_roller"]
    modulus, radius = 206e3 / 0.91 / 2, 1 / (1 / first["radius_mm"] + 1 / second["radius_mm"])
    load = table["force_N"] / min(first["length_mm"], second["length_mm"])
    half_width = numpy.sqrt(4 * load * radius / (math.pi * modulus))
    near(table["hertz_width_mm"], 2 * half_width, "Hertz, width of a line contact", relative=1e-7)
    pressure = 2 * load / (math.pi * half_width)
    near(table["hertz_max_pressure_MPa"], pressure, "Hertz, its pressure", relative=1e-7)


def roller_study(case, folder, single):
    """A study's rows are those of runs: `single` is that of variant 1."""
    run("study", case, "-o", folder)
    designs, h5 = Table(folder / "designs.csv"), h5py.File(folder / "study.h5")
    block = h5["block_0"]
    check(list(block["force"][:]) == list(single["force_N"]), "study.h5: forces")
    check(unit(block["force"]) == "N" and unit(block["approach_slope"]) == "um/N", "study.h5: units")
    check(not (folder / "te.csv").exists(), "a study without positions has no table over them")
    own = designs["variant"] == 1
    for column in ("approach_um", "max_pressure_MPa", "edge_pressure_MPa", "stiffness_N_per_um"):
        near(designs[column][own], single[column], f"designs.csv, {column}", relative=1e-8)
    for column, name in (("approach_um", "approach"), ("stiffness_N_per_um", "stiffness")):
        near(block[name][1, :, 0], single[column], f"study.h5, {name}", relative=1e-8)
    loaded = block["force"][:] > 0
    near(
        block["approach_slope"][1, :, 0][loaded],
        1 / single["stiffness_N_per_um"][loaded],
        "study.h5: slope",
        relative=1e-8,
    )


def roller_pair(cases, work):
    roller_run(cases / "crowned.toml", work / "crowned", (8, 1500), (25, 0), ends_at=1000)
    roller_run(cases / "crossed.toml", work / "crossed", (10, 0), (10, 0), math.pi / 2)
    line_contact((cases / "crowned.toml").read_text(), work)
    mixed = (cases / "crowned.toml").read_text()
    mixed = mixed.replace(
        "radius_mm = 25\nlength_mm = 40\nyoungs_modulus_GPa = 206\npoissons_ratio = 0.3",
        "radius_mm = 11\nlength_mm = 40\ncrown_radius_mm = 200\nyoungs_modulus_GPa = 110\n"
        "poissons_ratio = 0.34",
    ).replace("[1, 10, 100, 1000, 5000]", "[0, 20, 300]")
    mixed += "\n[axes]\ncrossing_angle_deg = 25\n"
    (work / "mixed.toml").write_text(mixed)
    modulus = 1 / (0.91 / 206e3 + (1 - 0.34**2) / 110e3)
    angle = math.radians(25)
    single = roller_run(work / "mixed.toml", work / "mixed", (8, 1500), (11, 200), angle, modulus)
    axes = '[[study]]\nset = "axes.crossing_angle_deg"\nvalues = [0, 25, 60]\n'
    (work / "angles.toml").write_text(mixed + axes)
    roller_study(work / "angles.toml", work / "angles", single)
