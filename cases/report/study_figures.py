# SPDX-License-Identifier: GPL-2.0-or-later
"""Figures of a study of drives over mesh cycles: Harris charts of some variants, then each axis over torque
with the others at their first value.
"""
import textwrap
from dataclasses import dataclass

import numpy as np

from error_curves import error_curves
from errors import InputError
from figure import Figure, LeftOut, joined
from mesh_figures import harris_chart
from results import rows
from style import (
    BLUE,
    MOST_TICKS,
    VERMILION,
    contour_lines,
    curve_styles,
    legend_above,
    literal,
    panels,
    spread,
)

AMPLITUDES = {"A1_um": "A1 [um]", "A2_um": "A2 [um]", "peak_to_peak_um": "peak-to-peak [um]"}
LOADS = {
    "mean_mesh_stiffness_N_per_um": "mean tangent\nstiffness [N/um]",
    "max_pressure_MPa": "greatest\npressure [MPa]",
    "edge_pressure_MPa": "greatest pressure\nat edges [MPa]",
}


@dataclass(frozen=True)
class Line:
    """The computed variants along one axis, the other axes at their first value."""

    files: str  # beginning of the names of the figures' files
    key: str  # of the axis: the first that varies
    name: str  # with the keys that go along
    variants: list  # a variant a point
    labels: list  # of the points
    # where a point stands: its number, or its place in the order of the case where it is a name or a list
    at: np.ndarray
    numeric: bool
    designs: dict  # rows of designs.csv
    note: str  # what is held, what failed


def line_along(results, number):
    axis, designs = results.axes[number], results.tables["designs.csv"]
    others = [other for other in results.axes if other is not axis]
    at_first = np.all(
        [other.point_of == 0 for other in others] or [np.full(len(axis.point_of), True)], axis=0
    )
    candidates = np.flatnonzero(at_first)
    points, first = np.unique(axis.point_of[candidates], return_index=True)
    if len(points) < len(axis.labels):
        raise InputError("designs.csv lacks some combination of the points of its axes")
    variants = [int(variant) for variant in candidates[first]]
    is_computed = np.isin(variants, designs["variant"][designs["status"] == "ok"])
    computed = np.flatnonzero(is_computed)
    failed = [axis.labels[point] for point in np.flatnonzero(~is_computed)]
    note = (
        " The other axes are at their first value: "
        f"{'; '.join(f'{other.name} = {other.labels[0]}' for other in others)}."
        if others
        else ""
    )
    note += f" Left out, because they failed: {'; '.join(failed)}." if failed else ""
    at = np.arange(len(variants)) if axis.numbers is None else axis.numbers
    kept = [variants[point] for point in computed]
    return Line(
        f"axis_{number + 1}",
        axis.keys[0],
        axis.name,
        kept,
        [axis.labels[point] for point in computed],
        at[computed],
        axis.numbers is not None,
        rows(designs, np.isin(designs["variant"], kept) & (designs["status"] == "ok")),
        note,
    )


def design_torques(designs, variant, by):
    """All T_d of a variant [N m]; designs.csv parts them by semicolons."""
    first = np.searchsorted(designs["variant"], variant)
    return [float(torque) for torque in designs[f"T_d_by_{by}_Nm"][first].split(";") if torque]


def harris(results):
    """Of the first, middle and last variant that was computed."""
    te, designs = results.tables["te.csv"], results.tables["designs.csv"]
    for variant in spread(np.unique(te["variant"]), 3):
        by_a1, by_peaks = (design_torques(designs, variant, by) for by in ("A1", "peak_to_peak"))
        curves = error_curves(rows(te, te["variant"] == variant), results.mesh_cycle)
        values = "; ".join(
            f"{axis.name} = {axis.labels[axis.point_of[int(variant)]]}" for axis in results.axes
        )
        yield harris_chart(
            f"harris_chart_variant_{int(variant)}",
            f"Harris chart of variant {int(variant)}",
            curves,
            by_a1,
            by_peaks,
            results.mesh_cycle,
            f"Variant {int(variant)}: {values}. ",
        )


def quantities(line, columns, name, what, meaning):
    """Columns of designs.csv over torque, or over the axis where all its variants have
    one and the same torque.
    """
    draw = over_torque if len(np.unique(line.designs["torque_Nm"])) > 1 else over_axis
    return draw(line, columns, f"{line.files}_{name}", what, meaning)


def over_axis(line, columns, name, what, meaning):
    """One curve, a dot a point of the axis."""
    title = f"{what} over {line.key}"
    drawing, axes = panels(len(columns), 1, 1.2 + 1.8 * len(columns), title, sharex=True)
    order = np.argsort(line.at)
    torque = line.designs["torque_Nm"][0]
    for row, (column, label) in enumerate(columns.items()):
        axes[row, 0].plot(
            line.at[order], line.designs[column][order], "o-" if line.numeric else "o", color=BLUE
        )
        axes[row, 0].set(ylabel=label)
    axes[-1, 0].set_xlabel(textwrap.fill(literal(line.name), 60, break_long_words=False))
    if not line.numeric:
        axes[-1, 0].set_xticks(*ticks(line), rotation=20, ha="right")
    table = {
        "variant": line.designs["variant"],
        line.key: line.labels,
        **{column: line.designs[column] for column in ("torque_Nm", *columns)},
    }
    return Figure(
        name, title, f"{meaning} At {torque:g} N m, a dot a point of {line.name}.{line.note}", table, drawing
    )


def over_torque(line, columns, name, what, meaning):
    """One curve a point of the axis."""
    title = f"{what} over torque, by {line.key}"
    points = spread(range(len(line.variants)))
    drawing, axes = panels(len(columns), 1, 1.2 + 1.8 * len(columns), title, sharex=True)
    tables = []
    for point, style in zip(points, curve_styles(len(points))):
        of_variant = rows(line.designs, line.designs["variant"] == line.variants[point])
        for row, (column, label) in enumerate(columns.items()):
            axes[row, 0].plot(
                of_variant["torque_Nm"],
                of_variant[column],
                marker=".",
                markersize=4,
                label=label_of(line, point, 60),
                **style,
            )
            axes[row, 0].set(ylabel=label)
        tables.append(
            {
                "variant": of_variant["variant"],
                line.key: [line.labels[point]] * len(of_variant["variant"]),
                **{column: of_variant[column] for column in ("torque_Nm", *columns)},
            }
        )
    axes[-1, 0].set(xlabel="torque [N m]")
    legend_above(axes[0, 0])
    some = (
        f" {len(points)} of its {len(line.variants)} points are drawn."
        if len(points) < len(line.variants)
        else ""
    )
    return Figure(
        name,
        title,
        f"{meaning} One curve a point of {line.name}; dots: computed torques.{some}{line.note}",
        joined(tables),
        drawing,
    )


def on_grid(line, column, torques):
    """Points of the axis by torques; not-a-number where a variant was not computed at a torque."""
    values = np.full((len(line.variants), len(torques)), np.nan)
    point_of = {variant: point for point, variant in enumerate(line.variants)}
    values[
        [point_of[variant] for variant in line.designs["variant"]],
        np.searchsorted(torques, line.designs["torque_Nm"]),
    ] = line.designs[column]
    return values


def label_of(line, point, width):
    """Of a point, short enough to be drawn."""
    return literal(textwrap.shorten(line.labels[point], width))


def ticks(line):
    shown = spread(range(len(line.at)), MOST_TICKS)
    return line.at[shown], [label_of(line, point, 24) for point in shown]


def label_axis(line, axes):
    axes.set_ylabel(textwrap.fill(literal(line.name), 40, break_long_words=False), fontsize=9)
    if not line.numeric:
        axes.set_yticks(*ticks(line))
        axes.set_ylim(line.at[0] - 0.5, line.at[-1] + 0.5)


def map_over_torque(line):
    title = f"A1 and A2 over torque and {line.key}"
    torques = np.unique(line.designs["torque_Nm"])
    if len(line.variants) < 2 or len(torques) < 2:
        return LeftOut(title, "a map needs two points of the axis and two torques")
    order = np.argsort(line.at)
    valley = [
        (torque, line.at[point])
        for point, variant in enumerate(line.variants)
        for torque in design_torques(line.designs, variant, "A1")
    ]
    drawing, axes = panels(2, 1, 6.6, title)
    grids = {}
    for row, column in enumerate(("A1_um", "A2_um")):
        grids[column] = on_grid(line, column, torques)
        values = np.ma.masked_invalid(grids[column][order])
        shown = axes[row, 0].pcolormesh(
            torques, line.at[order], values, shading="nearest", vmin=0, rasterized=True
        )
        scale = drawing.colorbar(shown, ax=axes[row, 0], label=AMPLITUDES[column])
        if line.numeric and values.count() and np.ptp(values.compressed()) > 0:
            contours = contour_lines(axes[row, 0], torques, line.at[order], values, 7)
            scale.ax.hlines(
                contours.levels[contours.levels <= values.max()], 0, 1, colors="white", linewidth=0.8
            )
        if valley:
            axes[row, 0].plot(
                *zip(*valley),
                "o",
                color=VERMILION,
                markeredgecolor="white",
                markersize=6,
                label="T_d by A1",
                clip_on=False,
            )
        axes[row, 0].grid(False)
        label_axis(line, axes[row, 0])
    axes[1, 0].set(xlabel="torque [N m]")
    if valley:
        legend_above(axes[0, 0])
    table = {
        line.key: np.repeat(line.labels, len(torques)),
        "torque_Nm": np.tile(torques, len(line.variants)),
        **{column: grid.ravel() for column, grid in grids.items()},
    }
    caption = (
        f"Peak amplitudes of the first two mesh harmonics of TE over torque and {line.name}: "
        "each computed combination is a field; white lines are contours, their values on the colour bar. "
        "Circles in both maps: the valley of A1, all local minima over torque (T_d). "
        if line.numeric
        else f"Peak amplitudes of the first two mesh harmonics of TE over torque and {line.name}; "
        "its points are no numbers, so there are no contours. "
        "Circles in both maps: all local minima of A1 over torque (T_d). "
    )
    return Figure(f"{line.files}_map", title, caption.strip() + line.note, table, drawing)


def design_torque_along(line):
    title = f"Design torques over {line.key}"
    minima = {
        by: [
            (torque, point)
            for point, variant in enumerate(line.variants)
            for torque in design_torques(line.designs, variant, by)
        ]
        for by in ("A1", "peak_to_peak")
    }
    if len(line.variants) < 2 or not any(minima.values()):
        return LeftOut(title, "needs two points of the axis and a local minimum over torque")
    drawing, ((axes,),) = panels(1, 1, 3.6, title)
    tables = []
    for (by, found), look in zip(
        minima.items(), ({"marker": "o", "color": BLUE}, {"marker": "x", "color": VERMILION})
    ):
        torques, points = [torque for torque, _ in found], [point for _, point in found]
        axes.plot(torques, line.at[points], linestyle="", label=f"by least {by.replace('_', '-')}", **look)
        tables.append(
            {"by": [by] * len(found), line.key: [line.labels[point] for point in points], "T_d_Nm": torques}
        )
    axes.set(xlabel="design torque T_d [N m]")
    label_axis(line, axes)
    legend_above(axes)
    caption = (
        "All local minima of A1 and of peak-to-peak over torque inside the computed range, "
        f"for each point of {line.name}; by cubics through values and exact slopes of TE at every position. "
        f"Points without a mark have none.{line.note}"
    )
    return Figure(
        f"{line.files}_design_torques",
        title,
        caption,
        joined([table for table in tables if table["by"]]),
        drawing,
    )


def study_figures(results, of_runs):
    yield from harris(results)
    for number in range(len(results.axes)):
        line = line_along(results, number)
        if not line.variants:
            yield LeftOut(f"Figures over {line.key}", "every variant along this axis failed")
            continue
        yield map_over_torque(line)
        yield design_torque_along(line)
        yield quantities(
            line,
            AMPLITUDES,
            "amplitudes",
            "A1, A2 and peak-to-peak",
            "Peak amplitudes of mesh harmonics and peak-to-peak of TE.",
        )
        yield quantities(
            line,
            LOADS,
            "loads",
            "Stiffness and pressure",
            "Mean tangent stiffness over the mesh cycle; greatest pressure over it away from edges, "
            "and at edges, where it depends on the grid.",
        )
    yield LeftOut(
        of_runs,
        "a study keeps transmission error, stiffness and greatest pressures of its variants; a report of "
        "`flank run` has the rest",
    )
