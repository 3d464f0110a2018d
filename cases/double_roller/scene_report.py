# SPDX-License-Identifier: GPL-2.0-or-later
"""The report's part for the double-roller drive."""
import re
from dataclasses import dataclass

import numpy as np

from errors import InputError
from mesh_cycle import Abscissa, MeshCycle, Stiffness, read_drive
from results import SceneResults, number
from tables import choice, counts

MOST_ROLLERS = 1000
RUN = {
    "te.csv": "variant torque_Nm position crank_angle_deg te_um te_arcsec gear_ratio contacts "
    "max_pressure_MPa edge_pressure_MPa mesh_stiffness_N_per_um torsional_stiffness_Nm_per_arcmin "
    "torsional_stiffness_secant_Nm_per_arcmin certificate",
    "harmonics.csv": "torque_Nm harmonic amplitude_um aliased",
    "pairs.csv": "torque_Nm position crank_angle_deg roller sleeve flank normal_force_N "
    "mid_pressure_MPa edge_pressure_MPa",
    "design_torques.csv": "by torque_Nm least_um",
    "amplitudes_over_torque.csv": "torque_Nm A1_um A2_um peak_to_peak_um computed",
}
KINDS = {"roller": counts, "sleeve": counts, "flank": choice("drive", "coast")}
FINER = "contact_grid.cells_across, contact_grid.cells_along"


@dataclass(frozen=True)
class PressureMap:
    """Cells of one pair of roller and sleeve, a quarter of the contact: it is symmetric."""

    torque: float  # [N m]
    crank_angle: float  # [deg]
    roller: int
    sleeve: int
    along: np.ndarray  # distance of the centres from mid-roller [mm]
    half_length: np.ndarray  # of the cells, along the roller [mm]
    pressure: np.ndarray  # [MPa]


@dataclass(frozen=True)
class OwnResults:
    """What the figures of rollers and sleeves want."""

    rollers: int  # N_r
    pressure_maps: list = ()  # of a run


def periods_of(source):
    """Of each variant: positions of the drive's period (0: they hold none), and pitches of the rollers in it.
    Errors of single parts make it longer than one pitch, and variants may differ in them.
    """
    store, periods = source.store, {}
    blocks = [name + "/" for name in store.names() if name.startswith("block_")] if source.is_study else [""]
    for block in blocks:
        variants = store.numbers(f"{block}variant", None) if block else [0]
        positions = len(store.numbers(f"{block}crank_angle{'_deg' if block else ''}", None))
        period, order = (store.numbers(f"{block}{name}", 1)[0] for name in ("period", "order"))
        if period not in range(positions + 1) or order not in range(1, MOST_ROLLERS**2 + 1):
            raise InputError(f"{source.store_name} gives a period that its crank angles do not have")
        periods |= {float(variant): (int(period), int(order)) for variant in variants}
    return periods


def mesh_cycle_of(periods):
    """Over crank angles; periods as periods_of gives them."""
    return MeshCycle(
        RUN,
        torque_in_store="torque",
        abscissa=Abscissa(
            "crank_angle_deg",
            "crank_angle",
            "crank angle [deg]",
            lambda _angles, variant: periods[float(variant)],
            lambda curves: "the computed crank angles",
        ),
        te_meaning="TE is the lag of the carrier behind crank angle / N_s, "
        "in um at the circle of the sleeves.",
        stiffness=Stiffness(
            "Torsional stiffness",
            "torsional_stiffness_Nm_per_arcmin",
            "torsional_stiffness_secant_Nm_per_arcmin",
            "N m/arcmin",
            "Tangent dT/d(rotation of the carrier), exact from the solver, "
            "and secant T/(rotation of the carrier from the unloaded drive).",
        ),
        greatest_pressure="at mid-roller",
        kinds=KINDS,
    )


def read(source):
    rollers = number(source.case, "drive.rollers")
    if rollers not in range(3, MOST_ROLLERS + 1):
        raise InputError(f"its case has no number of rollers from 3 to {MOST_ROLLERS}")
    rollers = int(rollers)
    mesh_cycle = mesh_cycle_of(periods_of(source))
    drive = read_drive(source, mesh_cycle)
    own = OwnResults(rollers)
    if not source.is_study:
        check_pairs(drive.tables["pairs.csv"]["roller"], drive.tables["pairs.csv"]["sleeve"], rollers)
        own = OwnResults(rollers, pressure_maps(source.store, drive.blocks[0], rollers))
    return SceneResults(
        drive.tables,
        drive.conventions,
        "te.csv",
        mesh_cycle,
        over_positions=drive.over_positions,
        own=own,
    )


def check_pairs(roller, sleeve, rollers):
    if not np.all(
        (1 <= np.asarray(roller)) & (roller <= rollers) & (1 <= np.asarray(sleeve)) & (sleeve < rollers)
    ):
        raise InputError("its tables hold rollers or sleeves that the drive of its case does not have")


def pressure_maps(store, block, rollers):
    """Groups torque_T_position_P / roller_R_sleeve_S of a double-roller run, where the case asks for them."""
    result = []
    for position_name in store.names("pressure_maps"):
        torque, position = numbers_in(r"torque_(\d{1,9})_position_(\d{1,9})", position_name)
        pair_names = store.names(f"pressure_maps/{position_name}")
        if torque >= len(block.torques) or position >= len(block.abscissa) or len(pair_names) > 2 * rollers:
            raise InputError("results.h5 holds pressures of what was not computed")
        for pair_name in pair_names:
            roller, sleeve = numbers_in(r"roller_(\d{1,4})_sleeve_(\d{1,4})", pair_name)
            check_pairs(roller, sleeve, rollers)
            pressure = store.numbers(f"pressure_maps/{position_name}/{pair_name}/pressure", None)
            along, half_length = (
                store.numbers(f"pressure_maps/{position_name}/{pair_name}/{name}", len(pressure))
                for name in ("y", "half_y")
            )
            result.append(
                PressureMap(
                    float(block.torques[torque]),
                    float(block.abscissa[position]),
                    roller,
                    sleeve,
                    along,
                    half_length,
                    pressure,
                )
            )
    return sorted(result, key=lambda map: (map.torque, map.crank_angle, map.sleeve, map.roller))


def numbers_in(pattern, name):
    found = re.fullmatch(pattern, name, re.ASCII)
    if not found:
        raise InputError("results.h5 holds pressures under a name that Flank does not give")
    return [int(number) for number in found.groups()]


def subject(results):
    import drive_page

    return drive_page.subject(results, "Double-roller drive")


def key_figures(results):
    import drive_page

    return drive_page.key_figures(results)


def figures(results):
    import mesh_figures as mesh
    import roller_figures as roller
    from study_figures import study_figures

    if results.is_study:
        yield from study_figures(results, "Gear ratio, number of contacts, pressure of every pair")
        return
    for figure in (
        roller.transmission_error,
        roller.gear_ratio,
        roller.contacts,
        roller.mid_pressure,
        roller.edge_pressure,
        roller.pair_forces,
        roller.pressure_along_rollers,
        mesh.harmonics,
        mesh.amplitudes,
        mesh.stiffness,
    ):
        yield figure(results)
    yield from mesh.over_positions(results)
