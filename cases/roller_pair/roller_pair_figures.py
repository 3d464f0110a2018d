# SPDX-License-Identifier: GPL-2.0-or-later
"""Figures of two rollers pressed together."""
import re

import numpy as np

from errors import plain_text
from figure import Figure, LeftOut
from style import BLUE, ORANGE, VERMILION, legend_above, panels


def figures_of(results):
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
        if not np.isnan(rows[f"hertz_{name}_MPa"]).all():
            dashed = {"linestyle": "--", "color": VERMILION, "linewidth": 1, "zorder": 3}
            of_hertz = None if name == "shear" else "Hertz"  # one entry for both
            stress.loglog(rows["force_N"], rows[f"hertz_{name}_MPa"], label=of_hertz, **dashed)
            depth.loglog(rows["force_N"], rows[f"hertz_{name}_depth_um"], **dashed)
    stress.set(xlabel="normal force [N]", ylabel="stress [MPa]")
    depth.set(xlabel="normal force [N]", ylabel="depth [um]")
    legend_above(stress, columns=2)
    of_both = ("shear_MPa", "shear_depth_um", "von_mises_MPa", "von_mises_depth_um")
    names = ["force_N", *of_both, *(f"hertz_{name}" for name in of_both)]
    caption = (
        "Half the difference of the outer principal stresses, and von Mises, "
        "below the greatest pressure away from the ends; their depths. Dashed: Hertz's, below the middle of "
        "smooth bodies without ends."
    )
    return Figure("subsurface", title, caption, {name: rows[name] for name in names}, drawing)


def pressure_map(results):
    cells = results.own
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
