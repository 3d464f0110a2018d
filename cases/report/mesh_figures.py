# SPDX-License-Identifier: GPL-2.0-or-later
"""Figures over the mesh cycle of one gear pair or drive: transmission error, its harmonics, stiffness."""
import re

import numpy as np

from error_curves import error_curves
from figure import Figure, LeftOut, joined
from results import rows
from style import BLUE, GREY, ORANGE, VERMILION, curve_styles, legend_above, panels, spread


def curves_of(results):
    return error_curves(results.tables["te.csv"], results.mesh_cycle)


def listed(torques):
    return ", ".join(f"{torque:.4g}" for torque in torques)


def design_torque_text(by_a1, by_peaks):
    """What the minima over torque say, in one sentence."""
    if not by_a1 and not by_peaks:
        return "Inside the range of torques neither A1 nor peak-to-peak has a minimum: no design torque T_d."
    a1 = f"{listed(by_a1)} N m by least A1" if by_a1 else "none by least A1 inside the range"
    peaks = (
        f"{listed(by_peaks)} N m by least peak-to-peak"
        if by_peaks
        else "none by least peak-to-peak inside the range"
    )
    return (
        "Design torque T_d (local minima over torque, between computed torques by cubics "
        f"through values and exact slopes): {a1}; {peaks}."
    )


def run_design_torques(results):
    """T_d by A1 and by peak-to-peak [N m]; two empty lists where there is one torque."""
    table = results.tables.get("design_torques.csv")
    return [
        list(table["torque_Nm"][table["by"] == quantity]) if table else []
        for quantity in ("A1", "peak_to_peak")
    ]


def harris_chart(name, title, curves, by_a1, by_peaks, mesh_cycle, note):
    """Every curve less its mean, set apart by equal steps; the torques nearest to T_d by A1 (else by
    peak-to-peak) stand out.
    """
    abscissa, te = mesh_cycle.abscissa.drawn(curves, curves.te)
    nearest = {curves.at(torque) for torque in by_a1 or by_peaks}
    shown = sorted(nearest | set(spread(range(len(curves.torques)), 8 - min(len(nearest), 4))))
    mean = curves.mean(curves.te)
    step = max(1.25 * max(np.ptp(te[t]) for t in shown), 1e-6)
    drawing, ((axes,),) = panels(1, 1, 1.6 + 0.55 * max(len(shown), 3), title)
    tables = []
    for i, t in enumerate(shown):
        height = i * step + te[t] - mean[t]
        is_design = t in nearest
        axes.axhline(i * step, color="#bbbbbb", linewidth=0.6)
        axes.plot(abscissa, height, color=VERMILION if is_design else BLUE, linewidth=2 if is_design else 1.3)
        axes.annotate(
            f"{curves.torques[t]:g} N m{' (T_d)' if is_design else ''}\nmean {mean[t]:.2f}",
            (1.01, i * step),
            va="center",
            fontsize=8,
            xycoords=("axes fraction", "data"),
            annotation_clip=False,
        )
        tables.append(
            {
                "torque_Nm": np.full(len(abscissa), curves.torques[t]),
                mesh_cycle.abscissa.column: abscissa,
                "te_um": te[t],
                "mean_te_um": np.full(len(abscissa), mean[t]),
                "drawn_at_um": height,
            }
        )
    axes.set(
        xlabel=mesh_cycle.abscissa.label,
        ylabel="TE less its mean,\ncurves set apart [um]",
        xlim=(abscissa[0], abscissa[-1]),
    )
    axes.grid(False)
    some = (
        f" {len(shown)} of the {len(curves.torques)} computed torques are drawn."
        if len(shown) < len(curves.torques)
        else ""
    )
    design = (
        design_torque_text(by_a1, by_peaks)
        if len(curves.torques) > 1
        else "One torque: no design torque T_d."
    )
    marked = (
        f" Orange-red: the computed torque nearest to T_d by least {'A1' if by_a1 else 'peak-to-peak'}."
        if nearest
        else ""
    )
    caption = (
        f"Transmission error over {mesh_cycle.abscissa.extent(curves)}, one curve a torque, "
        f"all at one scale: each less its mean (right, in um), on a line {step:.3g} um above the last.{some} "
        f"{mesh_cycle.te_meaning} {note}{design}{marked}"
    )
    return Figure(name, title, caption, joined(tables), drawing)


def harris(results, note):
    """note: a sentence on the abscissa."""
    title = "Transmission error: Harris chart"
    by_a1, by_peaks = run_design_torques(results)
    curves = curves_of(results)
    return harris_chart("harris_chart", title, curves, by_a1, by_peaks, results.mesh_cycle, f"{note} ")


def harmonics(results):
    title = "Harmonics of the transmission error"
    table = results.tables["harmonics.csv"]
    torques = [torque for torque in np.unique(table["torque_Nm"]) if torque > 0]
    if not torques:
        return LeftOut(
            title, "there are none: no torque above zero, or the positions do not divide one period"
        )
    drawing, ((axes,),) = panels(1, 1, 3.9, title)
    tables = []
    shown = spread(torques)
    for torque, style in zip(shown, curve_styles(len(shown))):
        of_torque = (table["torque_Nm"] == torque) & (table["harmonic"] <= 10)
        harmonic, amplitude, aliased = (
            table[name][of_torque] for name in ("harmonic", "amplitude_um", "aliased")
        )
        bound = table["bound_um"][of_torque] if "bound_um" in table else np.full(len(harmonic), np.nan)
        known = np.isfinite(bound)
        if known.any():
            at, value, above = harmonic[known], amplitude[known], bound[known]
            below = np.minimum(above, 0.9 * value)  # a logarithmic axis has no zero
            axes.errorbar(at, value, [below, above], fmt="none", ecolor=style["color"], capsize=3)
        axes.plot(harmonic, amplitude, linewidth=1, label=f"{torque:g} N m", **style)
        axes.plot(harmonic[aliased == 0], amplitude[aliased == 0], "o", color=style["color"], markersize=5)
        axes.plot(
            harmonic[aliased == 1],
            amplitude[aliased == 1],
            "o",
            color=style["color"],
            markersize=5,
            markerfacecolor="white",
        )
        tables.append(
            {
                "torque_Nm": table["torque_Nm"][of_torque],
                "harmonic": harmonic,
                "amplitude_um": amplitude,
                "aliased": aliased,
                "bound_um": bound,
            }
        )
    axes.set(
        yscale="log",
        xlabel="harmonic i of the mesh frequency [-]",
        ylabel="peak amplitude A_i [um]",
        xticks=range(1, 1 + int(max(table["harmonic"][table["harmonic"] <= 10]))),
    )
    legend_above(axes)
    caption = (
        "Peak amplitudes A_i = 2|c_i| of the mesh harmonics of TE, logarithmic. Open circles: "
        "above a quarter of the number of positions, so aliased by harmonics that were not resolved. "
        "Bars: how far the first three may be off, where it was estimated. "
        "Lines between the circles only lead the eye."
    )
    return Figure("harmonics", title, caption, joined(tables), drawing)


def draw_bounds(axes, smooth, name, colour):
    """A band about a curve over torque, where its error was estimated."""
    bound = smooth.get(name.replace("_um", "_bound_um"), np.nan) * np.ones(len(smooth[name]))
    if np.isfinite(bound).any():
        low, high = np.maximum(smooth[name] - bound, 0), smooth[name] + bound
        axes.fill_between(smooth["torque_Nm"], low, high, color=colour, alpha=0.15, linewidth=0)


def amplitudes(results):
    title = "A1, A2 and peak-to-peak over torque"
    smooth = results.tables.get("amplitudes_over_torque.csv")
    if smooth is None:
        return LeftOut(title, "needs two loaded torques or more, and one whole mesh cycle")
    by_a1, by_peaks = run_design_torques(results)
    drawing, ((axes,),) = panels(1, 1, 3.6, title)
    computed, most = smooth["computed"] == 1, 0
    for name, label, colour, line in (
        ("peak_to_peak_um", "peak-to-peak", GREY, "--"),
        ("A1_um", "A1", BLUE, "-"),
        ("A2_um", "A2", ORANGE, "-."),
    ):
        axes.plot(smooth["torque_Nm"], smooth[name], line, color=colour, label=label)
        axes.plot(smooth["torque_Nm"][computed], smooth[name][computed], "o", color=colour, markersize=4)
        most = max(most, np.nanmax(smooth[name], initial=0))
    axes.set_ylim(0, 1.2 * most or 1)  # by the curves: bands may be far wider
    for name, colour in (("peak_to_peak_um", GREY), ("A1_um", BLUE), ("A2_um", ORANGE)):
        draw_bounds(axes, smooth, name, colour)
    for torques, line, label in ((by_a1, "-", "T_d by A1"), (by_peaks, ":", "T_d by peak-to-peak")):
        for i, torque in enumerate(torques):
            axes.axvline(torque, color=VERMILION, linestyle=line, linewidth=1.2, label=None if i else label)
    axes.set(
        xlabel="torque [N m]",
        ylabel="transmission error [um]",
        xlim=(smooth["torque_Nm"][0], smooth["torque_Nm"][-1]),
    )
    legend_above(axes, 3)
    about_bounds = ""
    if any(np.isfinite(values).any() for name, values in smooth.items() if name.endswith("_bound_um")):
        about_bounds = (
            "Bands: how far they may be off, between computed torques with what the interpolation may leave. "
        )
    caption = (
        "Peak amplitudes of the first two mesh harmonics and peak-to-peak of TE. Dots: computed torques; "
        "lines: cubics through values and exact slopes at every position between them. "
        f"{about_bounds}"
        f"{design_torque_text(by_a1, by_peaks)}"
    )
    return Figure("amplitudes_over_torque", title, caption, smooth, drawing)


def stiffness(results):
    counted, shown = results.mesh_cycle.abscissa, results.mesh_cycle.stiffness
    title, tangent, secant, unit = shown.title, shown.tangent, shown.secant, shown.unit
    curves = curves_of(results)
    loaded = spread(np.flatnonzero(curves.torques > 0))
    if not loaded:
        return LeftOut(title, "no torque above zero")
    drawing, axes = panels(2, 1, 5.2, title, sharex=True)
    tables = []
    for row, (name, kind) in enumerate(((tangent, "tangent"), (secant, "secant"))):
        abscissa, values = counted.drawn(curves, curves.of(name))
        for t, style in zip(loaded, curve_styles(len(loaded))):
            axes[row, 0].plot(abscissa, values[t], label=f"{curves.torques[t]:g} N m", **style)
            tables.append(
                {
                    "kind": [kind] * len(abscissa),
                    "torque_Nm": np.full(len(abscissa), curves.torques[t]),
                    counted.column: abscissa,
                    f"stiffness_{unit.replace('/', '_per_').replace(' ', '')}": values[t],
                }
            )
        axes[row, 0].set(ylabel=f"{kind} [{unit}]")
    axes[1, 0].set(xlabel=counted.label, xlim=(abscissa[0], abscissa[-1]))
    legend_above(axes[0, 0])
    return Figure("stiffness", title, f"{shown.meaning} Axes do not begin at zero.", joined(tables), drawing)


MOST_PANELS = 8  # of one figure
UNIT = re.compile(r"(.+)_(MPa|GPa|um|mm|Nm|N|deg|mrad|arcsec|percent|[A-Za-z]+_per_[A-Za-z]+)", re.ASCII)


def with_unit(column):
    """A column as a label: "shear_depth_um" as "shear depth", below it "[um]"."""
    found = UNIT.fullmatch(column)
    name, unit = found.groups() if found else (column, "")
    name = name.replace("_", " ").replace("von mises", "von Mises")
    return f"{name}\n[{unit.replace('_per_', '/')}]" if unit else name


def draw_over_positions(results, name, title):
    """Every number of an optional output's table over the positions, a curve a torque."""
    found, counted = results.over_positions[name], results.mesh_cycle.abscissa
    columns, torques = found.columns[:MOST_PANELS], np.unique(found.table["torque_Nm"])
    shown = spread(torques)
    drawing, axes = panels(len(columns), 1, 0.9 + 1.5 * len(columns), title, sharex=True)
    tables = []
    for torque, style in zip(shown, curve_styles(len(shown))):
        of_torque = rows(found.table, found.table["torque_Nm"] == torque)
        of_torque = rows(of_torque, np.argsort(of_torque["position"]))
        for row, column in enumerate(columns):
            axes[row, 0].plot(
                of_torque[counted.column], of_torque[column], marker=".", label=f"{torque:g} N m", **style
            )
        tables.append({key: of_torque[key] for key in ("torque_Nm", counted.column, *columns)})
    for row, column in enumerate(columns):
        axes[row, 0].set(ylabel=with_unit(column))
    axes[-1, 0].set(xlabel=counted.label)
    drawing.align_ylabels(axes)
    legend_above(axes[0, 0])
    some = f" {len(shown)} of the {len(torques)} torques are drawn." if len(shown) < len(torques) else ""
    if len(columns) < len(found.columns):
        some += f" The first {len(columns)} of {len(found.columns)} columns are drawn."
    caption = (
        f"{found.meaning[:1].upper()}{found.meaning[1:]}. At all positions that {name} has. "
        f"Axes do not begin at zero.{some}"
    )
    return Figure(
        f"{name.removesuffix('.csv')}_over_{counted.column}", title, caption, joined(tables), drawing
    )


def over_positions(results):
    """A figure of each table of numbers over the positions that an optional output has: no list names them,
    but some their titles. In a study they are of its first variant.
    """
    asked = results.mesh_cycle.asked
    of_first = " of variant 0" if results.is_study else ""
    for name in sorted({*asked, *results.over_positions}):
        title, how = asked.get(name, (name.removesuffix(".csv").replace("_", " ").capitalize(), ""))
        if name in results.over_positions:
            yield draw_over_positions(results, name, title + of_first)
        else:
            yield LeftOut(title + of_first, f"not computed ({how} gives it)")
