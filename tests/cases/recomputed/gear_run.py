# SPDX-License-Identifier: GPL-2.0-or-later
"""A run of a gear pair: its tables and HDF5 file from the forces on its cells."""
import math

import h5py
from checks import Table, arcsec, check, check_harmonics, near, run, unit
from gear_cells import check_cells, positions
from gear_geometry import Pair
from gear_tables import check_maps, check_root_stress, check_subsurface, check_summary

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

    # Transmission error: of the driven gear's rotation; its stiffnesses, of the force in the transverse plane.
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
    quotient = 10.0 / pb / (at[90.01] - at[90.0])
    # The columns' 1e-9 um over 0.004 um: 5e-7; between both torques a cell may enter, which changes it by less than 1e-3.
    near(tangent[90.0], quotient, "mesh stiffness: difference quotient of force and TE", relative=1e-3)
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
    asymmetry = h5["compliance_asymmetry"][:]
    check(
        1e-6 < asymmetry.max() < 0.05, f"asymmetry of the near field before it is averaged: {asymmetry.max()}"
    )
    check_harmonics(Table(folder / "harmonics.csv"), at, "harmonics.csv")
    check_maps(folder, pair, h5, torques, lines)
    check_summary(folder, pair, te, pairs, lines, at, tangent, h5)
    check_subsurface(folder, pair, te)
    if with_roots:
        check_root_stress(folder, pair, pairs)


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


def check_hdf5(te, h5):
    """results.h5 = te.csv; units."""
    for name, column, absolute in (
        ("transmission_error", "te_um", 6e-10),
        ("mesh_stiffness", "mesh_stiffness_N_per_um", 6e-7),
        ("max_pressure", "max_pressure_MPa", 6e-5),
        ("max_pressure_roll_angle", "max_pressure_pinion_roll_angle_deg", 6e-7),
        ("max_pressure_z", "max_pressure_z_mm", 6e-7),
        ("edge_pressure", "edge_pressure_MPa", 6e-5),
        ("gear_torque", "gear_torque_Nm", 1e-6),
        ("max_line_load", "max_line_load_N_per_mm", 6e-7),
        ("load_centre_z", "load_centre_z_mm", 6e-7),
        ("shuttling_moment", "shuttling_moment_Nm", 6e-10),
    ):
        near(h5[name][:].ravel(), te[column], f"results.h5, {name}", absolute=absolute)
    for name, expected in UNITS.items():
        check(unit(h5[name]) == expected, f"unit of {name}: {unit(h5[name])!r}")
