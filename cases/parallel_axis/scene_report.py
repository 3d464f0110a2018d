# SPDX-License-Identifier: GPL-2.0-or-later
"""The report's part for gear pairs."""
import numpy as np

from error_curves import period_of_phases, two_cycles
from errors import InputError
from mesh_cycle import Abscissa, MeshCycle, Stiffness, close, read_drive, torque_numbers
from results import ErrorEstimate, SceneResults
from tables import choice, counts, numbers_or_unknown, whole_numbers

RUN = {
    "te.csv": "variant torque_Nm position phase te_um contacts max_pressure_MPa edge_pressure_MPa "
    "mesh_stiffness_N_per_um secant_stiffness_N_per_um certificate",
    "harmonics.csv": "torque_Nm harmonic amplitude_um aliased bound_um",
    "pairs.csv": "torque_Nm position phase pair normal_force_N load_share",
    "lines.csv": "torque_Nm position phase pair z_mm pinion_roll_angle_deg load_per_length_N_per_mm "
    "extent_mm",
    "pattern.csv": "torque_Nm pinion_roll_angle_deg z_mm pressure_MPa gear_roll_angle_deg",
    "modifications.csv": "flank roll_angle_deg z_mm removed_um",
    "sidebands.csv": "torque_Nm line mesh_order amplitude_um",
    "design_torques.csv": "by torque_Nm least_um least_bound_um",
    "amplitudes_over_torque.csv": "torque_Nm A1_um A2_um peak_to_peak_um computed A1_bound_um A2_bound_um "
    "peak_to_peak_bound_um",
    "root_stress.csv": "torque_Nm position phase body pair fillet z_mm tensile_stress_MPa",
    "error_estimate.csv": "torque_Nm level compared_with mean_te_um te_rms_um peak_to_peak_te_um A1_um "
    "max_pressure_percent A2_um A3_um load_share mean_te_shift_um mean_te_by_bodies_um mean_te_by_grid_um "
    "mean_te_by_positions_um pressure_kind root_stress_pinion_percent root_stress_gear_percent "
    "regular_pressure_MPa regular_pressure_percent",
}
OF_STUDIES = {name: RUN[name] for name in ("error_estimate.csv", "root_stress.csv")}  # of variant 0
KINDS = {
    "level": choice("draft", "standard", "reference"),
    "compared_with": choice("coarser"),
    **dict.fromkeys(RUN["error_estimate.csv"].split()[3:], numbers_or_unknown),
    **dict.fromkeys(
        (
            "bound_um",
            "least_bound_um",
            "A1_bound_um",
            "A2_bound_um",
            "peak_to_peak_bound_um",
            "te_bound_um",
            "max_pressure_bound_MPa",
            "load_share_bound",
            "tensile_stress_bound_MPa",
        ),
        numbers_or_unknown,
    ),
    "pressure_kind": choice("regular", "kink", "edge"),
    "flank": choice("pinion", "gear", "sum"),
    "body": choice("pinion", "gear"),
    "fillet": choice("loaded", "other"),
    "line": counts,
    "pair": whole_numbers,
}
FINER = "--accuracy reference"


def extent(curves):
    """What is drawn of the phases, in words."""
    if curves.cycles > 1:
        return "the first two mesh cycles of the hunting period"
    return "one computed mesh cycle, drawn twice"


def has_pattern_torques(pattern, block, *_):
    """A pattern may be of 1 % of a torque too."""
    return torque_numbers(pattern, np.concatenate([block.torques, 0.01 * block.torques])) is not None


def has_a_row_a_torque(table, block, *_):
    """In the order of the case."""
    return close(block.torques, table["torque_Nm"])


def is_without_torques(*_):
    """Nothing of a table of flanks alone is in te.csv."""
    return True


MESH_CYCLE = MeshCycle(
    RUN,
    torque_in_store="pinion_torque",
    abscissa=Abscissa("phase", "phase", "mesh phase [mesh cycles]", period_of_phases, extent, two_cycles),
    te_meaning="TE is counted along the transverse line of action and positive when the driven gear lags.",
    stiffness=Stiffness(
        "Mesh stiffness",
        "mesh_stiffness_N_per_um",
        "secant_stiffness_N_per_um",
        "N/um",
        "Tangent d(T/r_b)/d eps, exact from the solver, and secant (T/r_b)/eps, "
        "along the transverse line of action.",
    ),
    greatest_pressure="away from edges",
    study=OF_STUDIES,
    kinds=KINDS,
    checks={
        "pattern.csv": has_pattern_torques,
        "modifications.csv": is_without_torques,
        "error_estimate.csv": has_a_row_a_torque,
    },
    spectra={"sidebands.csv": "line"},
    asked={
        "subsurface.csv": ("Stress below the surface", 'output.subsurface_stress = "yes"'),
    },
)


def read(source):
    drive = read_drive(source, MESH_CYCLE)
    return SceneResults(
        drive.tables,
        drive.conventions,
        "te.csv",
        MESH_CYCLE,
        over_positions=drive.over_positions,
        error_estimate=error_estimate(drive.tables, source),
        estimate_key='output.error_estimate = "yes" (the default)',
    )


def error_estimate(tables, source):
    """Unless the case leaves it out."""
    found = tables.get("error_estimate.csv")
    if found is None:
        return None
    if not len(found["level"]):
        raise InputError("error_estimate.csv holds no torque")
    shown = {
        "torque N m": "torque_Nm",
        "mean TE um": "mean_te_um",
        "peak-to-peak TE um": "peak_to_peak_te_um",
        "A1 um": "A1_um",
        "A2 um": "A2_um",
        "A3 um": "A3_um",
        "greatest pressure %": "max_pressure_percent",
        "away from kinks and edges MPa": "regular_pressure_MPa",
        "of that %": "regular_pressure_percent",
        "load share": "load_share",
        "root stress of pinion %": "root_stress_pinion_percent",
        "of gear %": "root_stress_gear_percent",
    }
    if "root_stress.csv" not in tables:
        del shown["root stress of pinion %"], shown["of gear %"]
    rows = [[bound(found, name, i) for name in shown.values()] for i in range(len(found["torque_Nm"]))]
    others = " (error_estimates.csv: all variants)" if "error_estimates.csv" in source.files else ""
    meaning = (
        "Upper bounds of what elements, contact grid and the number of positions make wrong"
        f"{f' in variant 0{others}' if source.is_study else ''}, from coarser bodies and grids at some "
        "positions. Greatest pressures are those inside the flanks; at a kink of a flank, or where edges "
        "carry more, they grow as cells shrink and have no bound."
    )
    return ErrorEstimate(meaning, list(shown), rows)


def bound(found, name, row):
    """As the page shows it."""
    if not np.isnan(found[name][row]):
        return f"{found[name][row]:.4g}"
    kind = found["pressure_kind"][row] if name == "max_pressure_percent" else "regular"
    return {"kink": "at a kink", "edge": "more at edges"}.get(kind, "not estimated")


def subject(results):
    import drive_page

    return drive_page.subject(results, "External gear pair")


def key_figures(results):
    import drive_page

    return drive_page.key_figures(results)


def harris(results):
    import mesh_figures

    return mesh_figures.harris(
        results, "Phase 0: contact at the pitch point at mid-face; phase 1: one pitch on."
    )


def figures(results):
    import flank_figures as flank
    import mesh_figures as mesh
    from study_figures import study_figures

    if results.is_study:
        yield from study_figures(
            results, "Contact pattern, load share, load along contact lines, flank modifications"
        )
        yield flank.root_stress(results)
        yield from mesh.over_positions(results)
        return
    for figure in (
        harris,
        mesh.harmonics,
        mesh.amplitudes,
        flank.contact_pattern,
        flank.load_share,
        flank.contact_lines,
        flank.modifications,
        mesh.stiffness,
        flank.root_stress,
        flank.hunting_period,
    ):
        yield figure(results)
    yield from mesh.over_positions(results)
