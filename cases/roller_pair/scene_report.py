# SPDX-License-Identifier: GPL-2.0-or-later
"""The report's part for two rollers pressed together: its tables, checked against the store."""
from dataclasses import dataclass

import numpy as np

from errors import InputError
from results import SceneResults
from tables import numbers_or_empty, read_table

FINER = "roller_grid.cells_across, roller_grid.cells_along"

RUN = {
    "contact.csv": "variant force_N approach_um stiffness_N_per_um max_pressure_MPa edge_pressure_MPa "
    "width_mm length_mm shear_MPa shear_depth_um von_mises_MPa von_mises_depth_um "
    "hertz_approach_um hertz_stiffness_N_per_um hertz_max_pressure_MPa "
    "hertz_shear_MPa hertz_shear_depth_um hertz_von_mises_MPa hertz_von_mises_depth_um certificate"
}
STUDY = {
    "designs.csv": "variant status force_N approach_um max_pressure_MPa edge_pressure_MPa stiffness_N_per_um "
    "certificate"
}
MOST_CELLS = 1 << 20
ROUNDING = 1e-7  # of numbers in tables


@dataclass(frozen=True)
class PressedCells:
    """The contact at the greatest force: places and pressures on a grid of equal cells."""

    force: float
    x: np.ndarray  # across [mm]
    y: np.ndarray  # along [mm]
    pressure: np.ndarray  # [MPa], rows: y


def read(source):
    """Tables by name, the comments of the first one, and the cells pressed by the greatest force of a run."""
    tables, conventions = {}, []
    for name, columns in (STUDY if source.is_study else RUN).items():
        keys = source.axis_keys if name == "designs.csv" else ()
        content = source.files.content(name)
        # Numbers of variants that failed are empty, and Hertz's where his formulas do not hold.
        tables[name], comments = read_table(name, content, columns.split(), {}, numbers_or_empty, keys)
        conventions = conventions or comments
    if source.is_study:
        check_study(source.store, tables["designs.csv"])
        return SceneResults(tables, conventions, "designs.csv")
    check_run(source.store, tables["contact.csv"])
    cells = pressed_cells(source.store, tables["contact.csv"])
    return SceneResults(tables, conventions, "contact.csv", own=cells)


def check_run(store, table):
    """contact.csv must hold the forces and approaches of the store."""
    for column in ("force_N", "approach_um"):
        values = store.numbers(f"contact/{column}", None)
        if len(values) != len(table[column]) or not np.allclose(
            values, table[column], rtol=ROUNDING, atol=1e-12
        ):
            raise InputError("contact.csv and results.h5 are not of one computation")
    needed = [name for name in table if not name.startswith(("hertz_", "end_"))]
    if not len(table["force_N"]) or any(np.isnan(np.asarray(table[name], float)).any() for name in needed):
        raise InputError("contact.csv holds empty cells where numbers must be")


def check_study(store, table):
    """designs.csv must hold the approaches of the store, variant by variant."""
    is_ok = table["status"] == "ok"
    found = {}
    for block in (name for name in store.names() if name.startswith("block_")):
        variants, forces = (store.numbers(f"{block}/{name}", None) for name in ("variant", "force"))
        approach = store.numbers(f"{block}/approach", len(variants), len(forces), 1)
        for number, variant in enumerate(variants):
            found[variant] = (forces, approach[number, :, 0])
    for variant in np.unique(table["variant"][is_ok]):
        own = is_ok & (table["variant"] == variant)
        forces, approach = found.pop(variant, (np.zeros(0), np.zeros(0)))
        pairs = ((forces, "force_N"), (approach, "approach_um"))
        if any(
            len(values) != own.sum() or not np.allclose(values, table[name][own], rtol=ROUNDING, atol=1e-12)
            for values, name in pairs
        ):
            raise InputError("designs.csv and study.h5 are not of one computation")
    if found:
        raise InputError("designs.csv and study.h5 are not of one computation")


def pressed_cells(store, table):
    """Of the greatest force; nothing where nothing is loaded."""
    number = int(np.argmax(table["force_N"]))
    if not table["force_N"][number] > 0:
        return None
    group = f"pressure_maps/force_{number}"
    pressure = store.numbers(f"{group}/pressure", None)
    if not 0 < len(pressure) <= MOST_CELLS:
        raise InputError("results.h5 holds no pressures of the greatest force")
    x, y, half_x, half_y = (
        store.numbers(f"{group}/{name}", len(pressure)) for name in ("x", "y", "half_x", "half_y")
    )
    if not (half_x > 0).all() or not (half_y > 0).all():
        raise InputError("results.h5 holds cells without a size")
    columns, rows = (
        np.rint((place - place.min()) / (2 * half[0])).astype(int)
        for place, half in ((x, half_x), (y, half_y))
    )
    if (columns.max() + 1) * (rows.max() + 1) > MOST_CELLS:
        raise InputError("results.h5 holds cells that are no grid")
    grid = np.zeros((rows.max() + 1, columns.max() + 1))
    grid[rows, columns] = pressure
    return PressedCells(
        float(table["force_N"][number]),
        x.min() + 2 * half_x[0] * np.arange(grid.shape[1]),
        y.min() + 2 * half_y[0] * np.arange(grid.shape[0]),
        grid,
    )


def subject(results):
    table = next(iter(results.tables.values()))
    kind = f"study of {len(np.unique(table['variant']))} variants" if results.is_study else "run"
    forces = table["force_N"][~np.isnan(table["force_N"])]
    return (
        f"Two rollers pressed together, {kind}: {len(np.unique(forces))} forces. "
        f"Computed with {results.versions.splitlines()[0]}."
    )


def key_figures(results):
    """Heads, rows and a note."""
    names = {
        "force N": "force_N",
        "approach um": "approach_um",
        "stiffness N/um": "stiffness_N_per_um",
        "greatest pressure MPa": "max_pressure_MPa",
        "at ends MPa": "edge_pressure_MPa",
    }
    if results.is_study:
        names = {"variant": "variant", "status": "status", **names}
    else:
        names |= {"Hertz: approach um": "hertz_approach_um", "Hertz: pressure MPa": "hertz_max_pressure_MPa"}
    table = next(iter(results.tables.values()))
    rows = [[shown(table[name][k]) for name in names.values()] for k in range(len(table["variant"]))]
    return list(names), rows, ""


def shown(value):
    if isinstance(value, str):
        return value
    return "" if np.isnan(value) else f"{value:.6g}"


def figures(results):
    from roller_pair_figures import figures_of

    return figures_of(results)
