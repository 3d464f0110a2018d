# SPDX-License-Identifier: GPL-2.0-or-later
"""The report's part for two rollers pressed together: its tables, checked against the store, and its figures."""
import re
from dataclasses import dataclass

import numpy as np

from errors import InputError, plain_text
from figure import Figure, LeftOut
from style import BLUE, ORANGE, VERMILION, legend_above, panels
from tables import read_table

RUN = {
    "contact.csv": "variant force_N approach_um stiffness_N_per_um max_pressure_MPa edge_pressure_MPa width_mm "
    "length_mm shear_MPa shear_depth_um von_mises_MPa von_mises_depth_um hertz_approach_um "
    "hertz_stiffness_N_per_um hertz_max_pressure_MPa certificate"
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


def read_tables(files, is_study, axis_keys):
    """Tables by name, and the comments of the first one."""
    tables, conventions = {}, []
    for name, columns in (STUDY if is_study else RUN).items():
        keys = axis_keys if name == "designs.csv" else ()
        tables[name], comments = read_table(name, files.content(name), columns.split(), keys)
        conventions = conventions or comments
    return tables, conventions


def read(files, store, is_study, axis_keys):
    """Tables by name, the comments of the first one, and the cells pressed by the greatest force of a run."""
    tables, conventions = read_tables(files, is_study, axis_keys)
    if is_study:
        check_study(store, tables["designs.csv"])
        return tables, conventions, None
    check_run(store, tables["contact.csv"])
    return tables, conventions, pressed_cells(store, tables["contact.csv"])


def check_run(store, table):
    """contact.csv must hold the forces and approaches of the store."""
    for name, column in (("force", "force_N"), ("approach", "approach_um")):
        values = store.numbers(name, None)
        if len(values) != len(table[column]) or not np.allclose(
            values, table[column], rtol=ROUNDING, atol=1e-12
        ):
            raise InputError("contact.csv and results.h5 are not of one computation")
    needed = [name for name in table if not name.startswith("hertz_")]
    if not len(table["force_N"]) or any(np.isnan(np.asarray(table[name], float)).any() for name in needed):
        raise InputError("contact.csv holds empty cells where numbers must be")


def check_study(store, table):
    """designs.csv must hold the approaches of the store, variant by variant."""
    is_ok = table["status"] == "ok"
    found = {}
    for block in store.names():
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


def figures(results):
    if results.is_study:
        return [over_variants(results)]
    return [
        over_force(results, "approach", "Approach", "approach_um", "approach [um]"),
        over_force(
            results,
            "pressure",
            "Greatest pressure",
            "max_pressure_MPa",
            "pressure [MPa]",
            "edge_pressure_MPa",
        ),
        over_force(results, "stiffness", "Contact stiffness", "stiffness_N_per_um", "stiffness [N/um]"),
        subsurface(results),
        pressure_map(results),
    ]


def loaded_rows(results):
    table = results.tables["contact.csv"]
    order = [k for k in np.argsort(table["force_N"], kind="stable") if table["force_N"][k] > 0]
    return {name: np.asarray(values)[order] for name, values in table.items()}


def over_force(results, name, title, column, label, at_ends=None):
    """A column of contact.csv over the force, Hertz's closed form beside it where there is one."""
    rows = loaded_rows(results)
    if not len(rows["force_N"]):
        return LeftOut(title, "no force above 0 was asked for")
    drawing, ((axes,),) = panels(1, 1, 3.4, title)
    axes.loglog(rows["force_N"], rows[column], "o-", color=BLUE, label="computed")
    table = {"force_N": rows["force_N"], column: rows[column]}
    hertz = rows.get(f"hertz_{column}")
    if hertz is not None and not np.isnan(hertz).all():
        axes.loglog(rows["force_N"], hertz, "--", color=ORANGE, label="Hertz")
        table[f"hertz_{column}"] = hertz
    if at_ends and (rows[at_ends] > 0).any():
        axes.loglog(
            rows["force_N"],
            np.where(rows[at_ends] > 0, rows[at_ends], np.nan),
            "s:",
            color=VERMILION,
            label="at the ends",
        )
        table[at_ends] = rows[at_ends]
    axes.set(xlabel="normal force [N]", ylabel=label)
    legend_above(axes)
    caption = f"{title} over the normal force. Hertz: smooth bodies without ends."
    return Figure(f"{name}_over_force", title, caption, table, drawing)


def subsurface(results):
    title = "Greatest stresses below the surface"
    rows = loaded_rows(results)
    if not len(rows["force_N"]):
        return LeftOut(title, "no force above 0 was asked for")
    drawing, ((stress, depth),) = panels(1, 2, 3.4, title)
    for name, label, colour in (("shear", "shear", BLUE), ("von_mises", "von Mises", ORANGE)):
        stress.loglog(rows["force_N"], rows[f"{name}_MPa"], "o-", color=colour, label=label)
        depth.loglog(rows["force_N"], rows[f"{name}_depth_um"], "o-", color=colour)
    stress.set(xlabel="normal force [N]", ylabel="stress [MPa]")
    depth.set(xlabel="normal force [N]", ylabel="depth [um]")
    legend_above(stress)
    names = ("force_N", "shear_MPa", "shear_depth_um", "von_mises_MPa", "von_mises_depth_um")
    caption = "Half the difference of the outer principal stresses, and von Mises, below the greatest pressure; their depths."
    return Figure("subsurface", title, caption, {name: rows[name] for name in names}, drawing)


def pressure_map(results):
    cells = results.pressure_maps
    title = "Contact pressure"
    if cells is None:
        return LeftOut(title, "no force above 0 was asked for")
    drawing, ((axes,),) = panels(1, 1, 3.6, title)
    shown = axes.pcolormesh(cells.y, cells.x, cells.pressure.T, shading="nearest", rasterized=True)
    drawing.colorbar(shown, label="pressure [MPa]")
    axes.set(xlabel="along the contact [mm]", ylabel="across it [mm]")
    axes.grid(False)
    y, x = np.meshgrid(cells.y, cells.x, indexing="ij")
    table = {"across_mm": x.ravel(), "along_mm": y.ravel(), "pressure_MPa": cells.pressure.ravel()}
    caption = f"Pressure under {cells.force:g} N, the axes at different scales."
    return Figure("contact_pressure", title, caption, table, drawing)


def over_variants(results):
    """Approach and pressure at the greatest force, over the one axis or the variants' numbers."""
    title = "Variants"
    designs = results.tables["designs.csv"]
    is_ok = designs["status"] == "ok"
    if not is_ok.any():
        return LeftOut(title, "no variant was computed")
    force = designs["force_N"][is_ok].max()
    own = np.flatnonzero(is_ok & (designs["force_N"] == force))
    variants = designs["variant"][own].astype(int)
    axis = results.axes[0] if len(results.axes) == 1 and results.axes[0].numbers is not None else None
    place = axis.numbers[axis.point_of[variants]] if axis else variants
    name = axis.name if axis else "variant"
    order = np.argsort(place, kind="stable")
    drawing, ((approach, pressure),) = panels(1, 2, 3.4, title)
    for axes, column, label in (
        (approach, "approach_um", "approach [um]"),
        (pressure, "max_pressure_MPa", "greatest pressure [MPa]"),
    ):
        axes.plot(place[order], designs[column][own][order], "o-" if axis else "o", color=BLUE)
        axes.set(xlabel=plain_text(re.sub(r"\$", "", name)), ylabel=label)
    table = {"variant": variants[order], "approach_um": designs["approach_um"][own][order]}
    table["max_pressure_MPa"] = designs["max_pressure_MPa"][own][order]
    return Figure(
        "variants", title, f"Approach and greatest pressure of the variants at {force:g} N.", table, drawing
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
    """Heads and rows of the table at the top of the page."""
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
    return list(names), [
        [shown(table[name][k]) for name in names.values()] for k in range(len(table["variant"]))
    ]


def shown(value):
    if isinstance(value, str):
        return value
    return "" if np.isnan(value) else f"{value:.6g}"
