# SPDX-License-Identifier: GPL-2.0-or-later
"""Tables and store of a drive's transmission error over a mesh cycle, checked against one another."""
import re
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from error_curves import amplitudes, as_computed
from errors import InputError
from tables import heads_of, numbers, numbers_or_empty, numbers_or_texts, read_table

ROUNDING = 1e-8  # of numbers in tables, relative and absolute
STUDY = {
    "te.csv": "variant torque_Nm position {abscissa} te_um max_pressure_MPa edge_pressure_MPa "
    "mesh_stiffness_N_per_um certificate",
    "designs.csv": "variant status torque_Nm peak_to_peak_um A1_um A2_um T_d_by_A1_Nm T_d_by_peak_to_peak_Nm "
    "max_pressure_MPa edge_pressure_MPa mean_mesh_stiffness_N_per_um",
}
NEEDED = {"te.csv", "harmonics.csv", "pairs.csv", "designs.csv"}  # the others where the case asks for them


@dataclass(frozen=True)
class Block:
    """Transmission errors of variants over the same torques and positions, from the store."""

    variants: np.ndarray
    torques: np.ndarray  # [N m]
    abscissa: np.ndarray  # of the positions, in the unit of the drive
    te: np.ndarray  # [um], variants by torques by positions


@dataclass(frozen=True)
class Abscissa:
    """What a drive counts its mesh positions by."""

    column: str  # of tables, and of a study's store
    in_store: str  # of a run
    label: str  # with its unit
    # from its values and the variant: positions after which the error repeats, 0: it does not; and mesh
    # cycles in them
    period: Callable
    extent: Callable  # from ErrorCurves: what a Harris chart is drawn over, in words
    drawn: Callable = as_computed  # from ErrorCurves and values (T by K): both as they are drawn


@dataclass(frozen=True)
class Stiffness:
    """Columns of te.csv with the stiffness of a drive in its own unit."""

    title: str
    tangent: str
    secant: str
    unit: str
    meaning: str  # a sentence


@dataclass(frozen=True)
class MeshCycle:
    """A kind of drive with a transmission error over a mesh cycle: what it writes, and how that is drawn."""

    run: dict  # columns that are used, by the file's name
    torque_in_store: str  # of a run
    abscissa: Abscissa
    te_meaning: str  # a sentence
    stiffness: Stiffness
    greatest_pressure: str  # where it is: a few words
    study: dict = field(default_factory=dict)  # beyond what every study has
    kinds: dict = field(default_factory=dict)  # of its own columns
    checks: dict = field(default_factory=dict)  # of its own files, called as has_all_contacts is
    spectra: dict = field(default_factory=dict)  # files with the period's spectrum: column of the line
    # tables over positions by the file's name: title of the figure, what a case says to have it
    asked: dict = field(default_factory=dict)

    def of(self, is_study):
        return {**STUDY, **self.study} if is_study else self.run


@dataclass(frozen=True)
class OverPositions:
    """A table of an optional output that no list names: numbers of every position of a run, or of the first
    variant of a study.
    """

    table: dict
    columns: list  # of numbers that te.csv does not have, in the order of the file
    meaning: str  # what the file's comments say of it alone


@dataclass(frozen=True)
class Drive:
    """What every drive with a mesh cycle reads."""

    tables: dict  # checked
    conventions: list  # the comments of te.csv
    blocks: list  # the transmission errors of the store, one for variants of equal torques and positions
    over_positions: dict  # by the file's name


def read_drive(source, mesh_cycle):
    """A Drive. Throws InputError where its files are not of one computation."""
    store = source.store
    blocks = study_blocks(store, mesh_cycle) if source.is_study else [run_block(store, mesh_cycle)]
    tables, conventions = read_tables(source, mesh_cycle)
    check_errors(tables["te.csv"], blocks, mesh_cycle.abscissa.column, source.store_name)
    over_positions = read_over_positions(source, mesh_cycle, tables, conventions)
    if source.is_study:
        check_variants(tables, blocks, source.summary)
        of_first = {name: tables[name] for name in mesh_cycle.study if name in tables}
    else:
        check_run(tables, blocks[0], mesh_cycle)
        of_first = {}
    of_first |= {name: found.table for name, found in over_positions.items()}
    check_first_variant(of_first, blocks, mesh_cycle)
    return Drive(tables, conventions, blocks, over_positions)


def read_over_positions(source, mesh_cycle, tables, conventions):
    """The tables that are there, begin as te.csv does and have a row a torque and position."""
    counted, found = ["torque_Nm", "position", mesh_cycle.abscissa.column], {}
    for name in (name for name in source.files.tables() if name not in tables):
        content = source.files.content(name)
        columns = heads_of(content)
        if columns[:4] != ["variant", *counted] or not re.fullmatch(r"[a-z][a-z0-9_]{0,40}\.csv", name):
            continue
        kinds = {**dict.fromkeys(counted[::2], numbers), **dict.fromkeys(columns[4:], numbers_or_texts)}
        table, comments = read_table(name, content, columns, kinds)
        places = {*zip(table["torque_Nm"], table["position"])}
        shown = [column for column in columns[4:] if table[column].dtype == float]
        shown = [column for column in shown if column not in tables["te.csv"]]
        if shown and 0 < len(places) == len(table["position"]):
            meaning = " ".join(line for line in comments if line not in conventions)
            found[name] = OverPositions(table, shown, meaning)
    return found


def read_tables(source, mesh_cycle):
    """Those that are needed and those that are there, with the comments of te.csv."""
    tables, conventions = {}, []
    for name, columns in mesh_cycle.of(source.is_study).items():
        if name in NEEDED or name in source.files:
            columns = columns.format(abscissa=mesh_cycle.abscissa.column).split()
            # Numbers of variants that failed are empty, and amplitudes that the positions do not show.
            others, keys = (numbers_or_empty, source.axis_keys) if name == "designs.csv" else (numbers, ())
            content = source.files.content(name)
            tables[name], comments = read_table(name, content, columns, mesh_cycle.kinds, others, keys)
            conventions = comments if name == "te.csv" else conventions
    return tables, conventions


def run_block(store, mesh_cycle):
    torques = store.numbers(mesh_cycle.torque_in_store, None)
    abscissa = store.numbers(mesh_cycle.abscissa.in_store, None)
    te = store.numbers("transmission_error", len(torques), len(abscissa))
    if not te.size:
        raise InputError("results.h5 holds no transmission errors")
    return Block(np.zeros(1), torques, abscissa, te[None])


def study_blocks(store, mesh_cycle):
    blocks = []
    for name in (name for name in store.names() if name.startswith("block_")):
        variants, torques, abscissa = (
            store.numbers(f"{name}/{key}", None) for key in ("variant", "torque", mesh_cycle.abscissa.column)
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
        (int(found[1]) for line in summary[1:] if (found := re.match(r"study: (\d{1,9}) variants?, ", line))),
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


def check_first_variant(tables, blocks, mesh_cycle):
    """These tables must be of the torques and positions of a study's first variant, or of a run."""
    first = [block for block in blocks if 0 in block.variants]
    for name, table in tables.items():
        if not first or not is_of_run(table, first[0], mesh_cycle):
            raise InputError(f"te.csv and {name} are not of one computation")


def check_run(tables, block, mesh_cycle):
    """The tables beside te.csv must be of its torques, positions and errors."""
    checks = {
        "pairs.csv": has_all_contacts,
        "design_torques.csv": is_between,
        "amplitudes_over_torque.csv": is_of_loaded,
        **mesh_cycle.checks,
    }
    for name, table in tables.items():
        fits = name == "te.csv" or checks.get(name, is_of_run)(table, block, mesh_cycle, tables["te.csv"])
        if not fits:
            raise InputError(f"te.csv and {name} are not of one computation")
    check_spectra(tables, block, mesh_cycle)


def is_of_run(table, block, mesh_cycle, *_):
    """Every row stands at a torque and a position of the run."""
    return torque_numbers(table, block.torques) is not None and has_positions(table, block, mesh_cycle)


def torque_numbers(table, torques):
    """Which of these torques each row has; None where one has another."""
    order = np.argsort(torques)
    at = np.searchsorted(torques[order], table["torque_Nm"] * (1 - ROUNDING))
    number = order[np.minimum(at, len(order) - 1)]
    return number if close(torques[number], table["torque_Nm"]) else None


def has_positions(table, block, mesh_cycle):
    """Where a table has positions, they are those of the run."""
    if "position" not in table:
        return True
    position, column = table["position"].astype(int), table[mesh_cycle.abscissa.column]
    return np.all(position < len(block.abscissa)) and close(block.abscissa[position], column)


def has_all_contacts(pairs, block, mesh_cycle, te):
    """There is a row a contact."""
    if not is_of_run(pairs, block, mesh_cycle):
        return False
    place = torque_numbers(pairs, block.torques) * len(block.abscissa) + pairs["position"].astype(int)
    return np.array_equal(np.bincount(place, minlength=len(te["contacts"])), te["contacts"])


def is_between(table, block, *_):
    """Torques lie between those of the run."""
    torque = table["torque_Nm"]
    return np.all((torque >= np.min(block.torques)) & (torque <= np.max(block.torques)))


def is_of_loaded(table, block, *_):
    """The torques that count as computed are the loaded ones of the run, and the others lie between them."""
    loaded = np.sort(block.torques[block.torques > 0])
    computed = table["torque_Nm"][table["computed"] == 1]
    return close(loaded, computed) and np.all(np.diff(table["torque_Nm"]) > 0) and is_between(table, block)


def check_spectra(tables, block, mesh_cycle):
    """Amplitudes in harmonics.csv and the drive's own spectra must be those of the errors."""
    period, cycles = mesh_cycle.abscissa.period(block.abscissa, block.variants[0])
    steps = {"harmonics.csv": ("harmonic", cycles)}
    steps |= {name: (number, 1) for name, number in mesh_cycle.spectra.items() if name in tables}
    for name, (number, step) in steps.items():
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
