# SPDX-License-Identifier: GPL-2.0-or-later
"""A run of a gear pair: its tables and HDF5 file from the forces on its cells."""
import math, re

import h5py, numpy
from checks import Table, arcsec, check, check_harmonics, near, run, unit
from gear_cells import check_cells, positions
from gear_geometry import Pair
from gear_tables import check_iso_stiffness, check_maps, check_root_stress, check_subsurface, check_summary

UNITS = {
    "pinion_torque": "N m",
    "phase": "mesh cycle",
    "transmission_error": "um",
    "mesh_stiffness": "N/um",
    "max_pressure": "MPa",
    "max_pressure_roll_angle": "deg",
    "max_pressure_z": "mm",
    "edge_pressure": "MPa",
    "gear_torque": "N m",
    "max_line_load": "N/mm",
    "tip_edge_load": "N/mm",
    "tip_intensity": "MPa mm^-tip_power",
    "tip_power": "1",
    "end_intensity": "MPa mm^-end_power",
    "end_power": "1",
    "load_centre_z": "mm",
    "shuttling_moment": "N m",
    "tilt_pinion_in_plane": "mrad",
    "tilt_pinion_across_plane": "mrad",
    "tilt_gear_in_plane": "mrad",
    "tilt_gear_across_plane": "mrad",
    "cells/z": "mm",
    "cells/pinion_roll_angle": "deg",
    "cells/gear_roll_angle": "deg",
    "cells/area": "mm^2",
    "cells/unloaded_gap": "um",
    "cells/pressure": "MPa",
    "modifications/pinion/value": "um",
    "modifications/gear/roll_angle": "deg",
    "contact_pattern/torque_1/value": "MPa",
    "contact_pattern/torque_1/z": "mm",
    "contact_pattern/torque_1/gear_roll_angle": "deg",
}


def gear_run(case, folder, drive_flank):
    with_roots = drive_flank == "clockwise"  # root stress takes as long as all the rest
    settings = (f"load.drive_flank={drive_flank}", f"output.root_stress={'yes' if with_roots else 'no'}")
    run("run", case, "-o", folder, *(word for setting in settings for word in ("--set", setting)))
    pair, h5 = Pair(case, load={"drive_flank": drive_flank}), h5py.File(folder / "results.h5")
    te, pairs, lines = Table(folder / "te.csv"), Table(folder / "pairs.csv"), Table(folder / "lines.csv")
    torques = sorted(set(te["torque_Nm"]))
    pb, gb = pair.pinion.base, pair.gear.base
    T, um = te["torque_Nm"], te["te_um"]

    # Transmission error: of the driven gear's rotation; its stiffnesses, of the force
    # in the transverse plane.
    near(te["te_arcsec"], um * 1e-3 / gb / arcsec, "te_arcsec, at the gear's base radius", absolute=1e-8)
    near(
        te["secant_stiffness_N_per_um"],
        T * 1e3 / pb / um,
        "secant stiffness: torque over base radius and TE",
        absolute=1e-6,
    )
    near(te["phase"], te["position"] / positions, "phase", absolute=1e-9)
    at = {torque: um[T == torque] for torque in torques}
    tangent = {torque: te["mesh_stiffness_N_per_um"][T == torque] for torque in torques}
    quotient = 100.0 / pb / (at[90.1] - at[90.0])
    # The columns' 1e-9 um over 0.04 um: 5e-8; between both torques a cell may enter, which
    # changes it by less than 1e-3, and what its line contact is told from, 5e-6 um; or a slice at a face end
    # be halved, 6e-5 um.
    near(tangent[90.0], quotient, "mesh stiffness: difference quotient of force and TE", relative=2e-3)
    check(
        abs(tangent[0.0]).max() == 0 and abs(te["secant_stiffness_N_per_um"][T == 0]).max() == 0,
        "stiffness unloaded",
    )
    check(
        all((tangent[b] >= 0.97 * tangent[a]).all() for a, b in zip(torques, torques[1:])),
        "mesh stiffness grows with torque",
    )

    check_pairs(pair, te, pairs, lines)
    check_cells(pair, h5, te, pairs, lines)
    check_hdf5(te, h5)
    check_tables(folder, h5)
    check_slopes(pair, te, h5)
    asymmetry = h5["compliance_asymmetry"][:]
    check(
        1e-6 < asymmetry.max() < 0.05, f"asymmetry of the near field before it is averaged: {asymmetry.max()}"
    )
    check_condition(h5, (folder / "summary.txt").read_text())
    check_harmonics(Table(folder / "harmonics.csv"), at, "harmonics.csv")
    check_maps(folder, pair, h5, torques, lines)
    check_summary(folder, pair, te, pairs, lines, at, tangent, h5)
    check_subsurface(folder, pair, te)
    check_iso_stiffness((folder / "summary.txt").read_text(), pair)
    if with_roots:
        check_root_stress(folder, pair, pairs)


def check_condition(h5, summary):
    """Cells of one size beside each other: some tens to thousands; where nothing is loaded 0."""
    condition = h5["compliance_condition"][:]
    loaded = condition[h5["max_pressure"][:] > 0]
    told = re.search(r"^condition: .* cells up to (\S+), of the flanks' elements (\S+);", summary, re.M)
    check(
        10 < loaded.min() and loaded.max() < 1e6 and 10 < float(told[2]) < 1e6,
        f"condition of compliances: {loaded.min()} to {loaded.max()}, elements {told[2]}",
    )
    check(abs(float(told[1]) / loaded.max() - 1) < 0.06, f"condition told: {told[1]} of {loaded.max()}")


def check_pairs(pair, te, pairs, lines):
    """Pairs: forces in equilibrium, shares, contacts."""
    T, cosine = te["torque_Nm"], math.cos(pair.beta_b)
    for row in range(len(te.rows)):
        mine = (pairs["torque_Nm"] == T[row]) & (pairs["position"] == te["position"][row])
        force = pairs["normal_force_N"][mine]
        where = f"at {T[row]} N m, position {int(te['position'][row])}"
        check(int(te["contacts"][row]) == mine.sum(), f"contacts {where}")
        if not mine.any():
            check(T[row] == 0, f"nothing carries {where}")
            continue
        near(pairs["load_share"][mine], force / force.sum(), f"load shares {where}", absolute=1e-8)
        near(
            te["shuttling_moment_Nm"][row],
            1e-3 * force.sum() * cosine * te["load_centre_z_mm"][row],
            f"shuttling moment: force in the transverse plane by its centre {where}",
            absolute=3e-5 * force.sum() / 1e3,
            relative=1e-6,
        )
        line = (lines["torque_Nm"] == T[row]) & (lines["position"] == te["position"][row])
        near(
            te["max_line_load_N_per_mm"][row],
            lines["load_per_length_N_per_mm"][line].max(),
            f"greatest line load {where}",
            absolute=1e-6,
        )


def check_tables(folder, h5):
    """Every table but te.csv, and the maps, is a group of results.h5 with the same columns."""
    names = {path.stem for path in folder.glob("*.csv")} - {"te", "pattern", "modifications"}
    check({"harmonics", "pairs", "lines", "design_torques"} <= names, f"tables of a run: {sorted(names)}")
    stages = h5["stages"]
    check(
        set(stages) == {"stage", "seconds"} and "contact" in unit(stages["stage"]), "results.h5: its stages"
    )
    check((stages["seconds"][:] >= 0).all() and stages["seconds"][:].sum() > 0, "results.h5: their times")
    for name in names:
        table, group = Table(folder / f"{name}.csv"), h5[name]
        columns = [column for column in table.names if column != "variant"]
        check(set(group) == set(columns), f"results.h5/{name}: columns {sorted(group)}")
        if not table.rows:
            check(
                all(group[column].size == 0 for column in columns),
                f"results.h5/{name}: rows that the table has not",
            )
            continue
        for column in columns:
            values, words = group[column][:], unit(group[column])
            of_words = re.fullmatch(r"\d \w+(, \d \w+)*", words)
            if of_words and column not in ("aliased", "computed"):
                meaning = dict(word.split(" ", 1) for word in words.split(", "))
                check(
                    [meaning[str(value)] for value in values] == table.text(column),
                    f"results.h5/{name}/{column}: words",
                )
                continue
            written = [row[column] for row in table.rows]
            digits = max((len(text.partition(".")[2].partition("e")[0]) for text in written), default=0)
            found = [float(text) if text else math.nan for text in written]
            near(
                numpy.nan_to_num(values, nan=-1.0),
                numpy.nan_to_num(numpy.array(found), nan=-1.0),
                f"results.h5/{name}/{column}",
                absolute=0.51 * 10.0**-digits,
                relative=5e-9,
            )
            whole = column in ("position", "pair", "harmonic", "line", "aliased", "computed")
            check(numpy.issubdtype(values.dtype, numpy.integer) == whole, f"results.h5/{name}/{column}: kind")


def check_slopes(pair, te, h5):
    """Slopes over torque of the tangent stiffness, and what the dimensions of a table are."""
    slope, stiffness = h5["transmission_error_slope"][:].ravel(), te["mesh_stiffness_N_per_um"]
    loaded = te["torque_Nm"] > 0
    near(
        slope[loaded],
        1e3 / (pair.pinion.base * stiffness[loaded]),
        "results.h5: slope of TE over torque",
        relative=1e-6,  # the stiffness' six decimals
    )
    check((slope[~loaded] == 0).all(), "results.h5: slope unloaded")
    near(h5["pinion_base_radius"][:], [pair.pinion.base], "results.h5: base radius", relative=1e-12)
    near(h5["gear_base_radius"][:], [pair.gear.base], "results.h5: base radius of the gear", relative=1e-12)
    scales = [list(dimension.keys()) for dimension in h5["transmission_error"].dims]
    check(scales == [["pinion_torque"], ["phase"]], f"results.h5: dimension scales {scales}")


def check_hdf5(te, h5):
    """results.h5 = te.csv; units."""
    for name, column, absolute in (
        ("transmission_error", "te_um", 6e-10),
        ("mesh_stiffness", "mesh_stiffness_N_per_um", 6e-7),
        ("secant_stiffness", "secant_stiffness_N_per_um", 6e-7),
        ("max_pressure", "max_pressure_MPa", 6e-5),
        ("max_pressure_roll_angle", "max_pressure_pinion_roll_angle_deg", 6e-7),
        ("max_pressure_z", "max_pressure_z_mm", 6e-7),
        ("edge_pressure", "edge_pressure_MPa", 6e-5),
        ("gear_torque", "gear_torque_Nm", 1e-6),
        ("max_line_load", "max_line_load_N_per_mm", 6e-7),
        ("tip_edge_load", "tip_edge_load_N_per_mm", 6e-7),
        ("tip_intensity", "tip_intensity_MPa_mm", 6e-5),
        ("tip_power", "tip_power", 6e-7),
        ("end_intensity", "end_intensity_MPa_mm", 6e-5),
        ("end_power", "end_power", 6e-7),
        ("load_centre_z", "load_centre_z_mm", 6e-7),
        ("shuttling_moment", "shuttling_moment_Nm", 6e-10),
    ):
        near(h5[name][:].ravel(), te[column], f"results.h5, {name}", absolute=absolute)
    for name, column in (
        ("transmission_error_bound", "te_bound_um"),
        ("max_pressure_bound", "max_pressure_bound_MPa"),
    ):
        if name in h5:
            off = numpy.nan_to_num([h5[name][:].ravel(), te[column]], nan=-1.0)
            near(*off, f"results.h5, {name}", absolute=6e-5)
        else:
            check(numpy.isnan(te[column]).all(), f"results.h5 lacks {name}")
    kinds = [("regular", "kink", "edge")[kind] for kind in h5["pressure_kind"][:].ravel()]
    check(te.text("pressure_kind") == kinds, "results.h5, pressure_kind")
    check(unit(h5["pressure_kind"]) == "0 regular, 1 kink, 2 edge", "unit of pressure_kind")
    for row in te.rows:
        is_bound = row["max_pressure_bound_MPa"] != "nan"
        at_edge = float(row["edge_pressure_MPa"]) > float(row["max_pressure_MPa"])
        check(not (is_bound or at_edge) or (row["pressure_kind"] == "regular") == is_bound, f"kind of {row}")
    for name, expected in UNITS.items():
        check(unit(h5[name]) == expected, f"unit of {name}: {unit(h5[name])!r}")
