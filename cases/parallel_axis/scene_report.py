# SPDX-License-Identifier: GPL-2.0-or-later
"""The report's part for gear pairs."""
from errors import InputError
from mesh_cycle import DriveTables, read_drive, run_slopes
from results import SceneResults

RUN = {
    "te.csv": "variant torque_Nm position phase te_um contacts max_pressure_MPa edge_pressure_MPa "
    "mesh_stiffness_N_per_um secant_stiffness_N_per_um certificate",
    "harmonics.csv": "torque_Nm harmonic amplitude_um aliased",
    "pairs.csv": "torque_Nm position phase pair normal_force_N load_share",
    "lines.csv": "torque_Nm position phase pair z_mm pinion_roll_angle_deg load_per_length_N_per_mm",
    "pattern.csv": "torque_Nm pinion_roll_angle_deg z_mm pressure_MPa",
    "modifications.csv": "flank roll_angle_deg z_mm removed_um",
    "sidebands.csv": "torque_Nm line mesh_order amplitude_um",
    "design_torques.csv": "by torque_Nm least_um",
    "root_stress.csv": "torque_Nm position phase body pair fillet z_mm tensile_stress_MPa",
    "error_estimate.csv": "torque_Nm level compared_with mean_te_um te_rms_um peak_to_peak_te_um A1_um max_pressure_percent",
}
OF_STUDIES = {name: RUN[name] for name in ("error_estimate.csv",)}
TABLES = DriveTables(RUN, "phase", "pinion_torque", "phase", study=OF_STUDIES)
FINER = "--accuracy reference"


def read(source):
    tables, conventions, blocks = read_drive(source, TABLES)
    if source.is_study:
        return SceneResults(tables, conventions)
    slopes = run_slopes(source.store, blocks[0])
    radii = tuple(float(source.store.numbers(f"{name}_base_radius", 1)[0]) for name in ("pinion", "gear"))
    if not all(radius > 0 for radius in radii):
        raise InputError("results.h5 holds no base radius")
    return SceneResults(tables, conventions, slopes=slopes, base_radii=radii)


def subject(results):
    import drive_page

    return drive_page.subject(results, "External gear pair")


def key_figures(results):
    import drive_page

    return drive_page.key_figures(results)


def figures(results):
    import flank_figures as flank
    import mesh_figures as mesh
    from study_figures import study_figures

    if results.is_study:
        yield from study_figures(
            results,
            "Contact pattern, load share, load along contact lines, flank modifications, root stress",
        )
        return
    for figure in (
        mesh.harris,
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
