# SPDX-License-Identifier: GPL-2.0-or-later
"""Tables and store of a drive's transmission error over a mesh cycle, checked against one another."""
import re
from dataclasses import dataclass, field

import numpy as np

from error_curves import amplitudes, period_of
from errors import InputError
from tables import read_table

ROUNDING = 1e-8  # of numbers in tables, relative and absolute
STUDY = {
    "te.csv": "variant torque_Nm position {abscissa} te_um max_pressure_MPa edge_pressure_MPa mesh_stiffness_N_per_um certificate",
    "designs.csv": "variant status torque_Nm peak_to_peak_um A1_um A2_um T_d_by_A1_Nm T_d_by_peak_to_peak_Nm max_pressure_MPa "
    "edge_pressure_MPa mean_mesh_stiffness_N_per_um",
}
NEEDED = {"te.csv", "harmonics.csv", "pairs.csv", "designs.csv"}  # the others where the case asks for them


@dataclass(frozen=True)
class Block:
    """Transmission errors of variants over the same torques and positions, from the store."""

    variants: np.ndarray
    torques: np.ndarray  # [N m]
    abscissa: np.ndarray  # mesh phase [mesh cycles] or crank angle [deg]
    te: np.ndarray  # [um], variants by torques by positions


@dataclass(frozen=True)
class DriveTables:
    """What a kind of drive writes."""

    run: dict  # columns that are used, by the file's name
    abscissa: str  # column of te.csv, and of a study's store
    torque_in_store: str  # of a run
    abscissa_in_store: str  # of a run
    rollers: int = 0  # N_r of the double-roller drive
    study: dict = field(default_factory=dict)  # beyond what every study has

    def of(self, is_study):
        return {**STUDY, **self.study} if is_study else self.run


def read_drive(source, drive):
    """Checked tables, the comments of te.csv, and the transmission errors of the store, a block for variants of equal torques and
    positions."""
    store = source.store
    blocks = study_blocks(store, drive) if source.is_study else [run_block(store, drive)]
    tables, conventions = read_tables(source, drive)
    check_errors(tables["te.csv"], blocks, drive.abscissa, source.store_name)
    if source.is_study:
        check_variants(tables, blocks, source.summary)
    else:
        check_run(tables, blocks[0], drive)
    return tables, conventions, blocks


def read_tables(source, drive):
    """Those that are needed and those that are there, with the comments of te.csv."""
    tables, conventions = {}, []
    for name, columns in drive.of(source.is_study).items():
        if name in NEEDED or name in source.files:
            columns = columns.format(abscissa=drive.abscissa).split()
            keys = source.axis_keys if name == "designs.csv" else ()
            tables[name], comments = read_table(name, source.files.content(name), columns, keys)
            conventions = comments if name == "te.csv" else conventions
    return tables, conventions


def run_block(store, drive):
    torques = store.numbers(drive.torque_in_store, None)
    abscissa = store.numbers(drive.abscissa_in_store, None)
    te = store.numbers("transmission_error", len(torques), len(abscissa))
    if not te.size:
        raise InputError("results.h5 holds no transmission errors")
    return Block(np.zeros(1), torques, abscissa, te[None])


def run_slopes(store, block):
    """d TE / d torque of a run [um/(N m)], ascending torques by positions."""
    slopes = store.numbers("transmission_error_slope", len(block.torques), len(block.abscissa))
    if not np.all(slopes >= 0):
        raise InputError("results.h5 holds a falling transmission error")
    return slopes[np.argsort(block.torques)]


def study_blocks(store, drive):
    blocks = []
    for name in (name for name in store.names() if name.startswith("block_")):
        variants, torques, abscissa = (
            store.numbers(f"{name}/{key}", None) for key in ("variant", "torque", drive.abscissa)
        )
        te = store.numbers(f"{name}/te", len(variants), len(torques), len(abscissa))
        blocks.append(Block(variants, torques, abscissa, te))
    return blocks


def check_errors(te_table, blocks, abscissa, store_name):
    """te.csv must be the transmission errors of the store, in the order of the variants."""
    columns = {"variant": [], "torque_Nm": [], "position": [], abscissa: [], "te_um": []}
    for block in blocks:
        if len({*block.torques}) < len(block.torques):
            raise InputError(
                "one torque was computed twice; give every torque of the case once and compute it anew"
            )
        n, torques, positions = block.te.shape
        columns["variant"].append(np.repeat(block.variants, torques * positions))
        columns["torque_Nm"].append(np.tile(np.repeat(block.torques, positions), n))
        columns["position"].append(np.tile(np.arange(positions), n * torques))
        columns[abscissa].append(np.tile(block.abscissa, n * torques))
        columns["te_um"].append(block.te.ravel())
    expected = {name: np.concatenate(parts) if parts else np.zeros(0) for name, parts in columns.items()}
    order = np.argsort(expected["variant"], kind="stable")
    for name, values in expected.items():
        if not close(values[order], te_table[name]):
            raise InputError(f"te.csv and {store_name} are not of one computation")


def close(a, b):
    return a.shape == b.shape and np.allclose(a, b, rtol=ROUNDING, atol=ROUNDING)


def check_variants(tables, blocks, summary):
    """Every variant must stand in designs.csv; in te.csv and once in study.h5 where it was computed."""
    designs = tables["designs.csv"]
    asked = next(
        (int(found[1]) for line in summary[1:] if (found := re.match(r"study: (\d{1,9}) variants, ", line))),
        -1,
    )
    is_ok = designs["status"] == "ok"
    computed = np.sort(np.concatenate([block.variants for block in blocks])) if blocks else np.zeros(0)
    if not np.array_equal(np.unique(designs["variant"]), np.arange(asked)) or not np.array_equal(
        np.unique(designs["variant"][is_ok]), computed
    ):
        raise InputError("designs.csv, summary.txt and study.h5 are not of one computation, or not complete")
    measured = (
        "torque_Nm",
        "peak_to_peak_um",
        "max_pressure_MPa",
        "edge_pressure_MPa",
        "mean_mesh_stiffness_N_per_um",
    )
    for block in blocks:
        own = is_ok & np.isin(designs["variant"], block.variants)
        if any(np.any(np.isnan(designs[name][own])) for name in measured) or not close(
            designs["torque_Nm"][own], np.tile(block.torques, len(block.variants))
        ):
            raise InputError("designs.csv and study.h5 are not of one computation")


def check_run(tables, block, drive):
    """The tables beside te.csv must be of its torques, positions and errors."""
    te, positions = tables["te.csv"], len(block.abscissa)
    for name, table in tables.items():
        if name in ("te.csv", "modifications.csv"):
            continue
        if name == "design_torques.csv":  # of torques in between
            within = (table["torque_Nm"] >= np.min(block.torques)) & (
                table["torque_Nm"] <= np.max(block.torques)
            )
            if not np.all(within):
                raise InputError(f"te.csv and {name} are not of one computation")
            continue
        light = name == "pattern.csv"  # which may be of 1 % of a torque too
        torques = np.concatenate([block.torques, 0.01 * block.torques]) if light else block.torques
        order = np.argsort(torques)
        at = np.searchsorted(torques[order], table["torque_Nm"] * (1 - ROUNDING))
        number = order[np.minimum(at, len(order) - 1)]  # of each row's torque
        fits = close(torques[number], table["torque_Nm"])
        if name == "error_estimate.csv":
            fits = close(block.torques, table["torque_Nm"])
        if fits and "position" in table:
            position = table["position"].astype(int)
            fits = np.all(position < positions) and close(block.abscissa[position], table[drive.abscissa])
            if fits and name == "pairs.csv":
                pairs = np.bincount(number * positions + position, minlength=len(te["contacts"]))
                fits = np.array_equal(pairs, te["contacts"])
        if not fits:
            raise InputError(f"te.csv and {name} are not of one computation")
    check_spectra(tables, block, drive)


def check_spectra(tables, block, drive):
    """Amplitudes in harmonics.csv and sidebands.csv must be those of the errors."""
    period, cycles = period_of(block.abscissa, drive.rollers)
    spectra = {"harmonics.csv": ("harmonic", cycles)} | (
        {"sidebands.csv": ("line", 1)} if "sidebands.csv" in tables else {}
    )
    for name, (number, step) in spectra.items():
        table = tables[name]
        expected = (
            amplitudes(block.te[0, :, :period])[:, step::step]
            if period
            else np.zeros((len(block.torques), 0))
        )
        if (
            len(table["torque_Nm"]) != expected.size
            or not close(table["torque_Nm"], np.repeat(block.torques, expected.shape[1]))
            or not close(table[number], np.tile(1 + np.arange(expected.shape[1]), len(block.torques)))
            or not close(table["amplitude_um"], expected.ravel())
        ):
            raise InputError(f"te.csv and {name} are not of one computation")
