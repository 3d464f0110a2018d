# SPDX-License-Identifier: GPL-2.0-or-later
"""Figures of tooth flanks: contact pattern, load on the contact lines, modifications,
hunting period, root stress.
"""
import numpy as np
from matplotlib import colormaps
from matplotlib.collections import LineCollection
from matplotlib.ticker import MaxNLocator

from errors import InputError
from figure import Figure, LeftOut, joined
from mesh_figures import curves_of
from results import rows
from style import (
    BLUE,
    MAP_COLOURS,
    VERMILION,
    contour_lines,
    curve_styles,
    label_contours,
    legend_above,
    panels,
    spread,
)

MOST_PAIRS = 64  # in contact at once: more cannot be told apart, and no gear pair has them
FACE = "position along the face z [mm]"


def flank_map(table, value):
    """Roll angles [deg], face positions z [mm] and values (roll by z) of a map whose rows are ordered by roll
    angle, then by z. Where the rows hold two maps, because a torque of the case is also 1 % of another one,
    the first map is taken: the torque's own.
    """
    roll = next(values for name, values in table.items() if name.endswith("roll_angle_deg"))
    rolls, faces = np.unique(roll), np.unique(table["z_mm"])
    count = len(rolls) * len(faces)
    is_complete = np.array_equal(roll[:count], np.repeat(rolls, len(faces))) and np.array_equal(
        table["z_mm"][:count], np.tile(faces, len(rolls))
    )
    if not is_complete or len(roll) % max(count, 1) or not count:
        raise InputError(
            f"a map of {value} is not complete: {len(roll)} rows for {len(rolls)} roll angles and "
            f"{len(faces)} face positions"
        )
    return rolls, faces, table[value][:count].reshape(len(rolls), len(faces))


def light_torque(torques):
    """The torque of the pattern at light load: of those up to 2 % of the greatest the nearest to 1 % of it;
    None where there is none. Where output.light_load_pattern asked for it, that is the run's own, 1 % to the
    last digit; else it is one of the case's torques, which the run does not know to be a light one.
    """
    greatest = max(torques)
    light = [torque for torque in torques if 0 < torque <= 0.02 * greatest]
    return min(light, key=lambda torque: abs(torque - 0.01 * greatest)) if light else None


def pattern_on_flanks(of_torque):
    """A flank's name, roll angles [deg], face positions z [mm] and pressures [MPa] (roll by z), first the
    pinion's and then the gear's, which is the pinion's at the roll angles where it meets the gear.
    """
    rolls, faces, pressure = flank_map(of_torque, "pressure_MPa")
    mating = of_torque["gear_roll_angle_deg"][: pressure.size : len(faces)]
    return [
        (flank, angles, faces, pressure)
        for flank, angles in (("pinion", rolls), ("gear", mating))
    ]


def pattern_table(flank, torque, angles, faces, pressure):
    """The numbers of one map, a row a place of the flank."""
    return {
        "flank": [flank] * pressure.size,
        "torque_Nm": np.full(pressure.size, torque),
        "roll_angle_deg": np.repeat(angles, len(faces)),
        "z_mm": np.tile(faces, len(angles)),
        "pressure_MPa": pressure.ravel(),
    }


def draw_pattern(axes, torque, flank, angles, faces, pressure, highest):
    """One map whose colours end at `highest` [MPa]; what is above it has a colour of its own."""
    colours = colormaps[MAP_COLOURS].copy()
    colours.set_over(VERMILION)
    axes.set(title=f"{flank}, {torque:g} N m", ylabel="roll angle [deg]")
    return axes.pcolormesh(
        faces,
        angles,
        np.ma.masked_equal(pressure, 0),
        cmap=colours,
        vmin=0,
        vmax=highest,
        shading="nearest",
        rasterized=True,
    )


def pattern_caption(full, inside, edge):
    """Of the greatest torque [N m] and the greatest pressures away from edges and at them [MPa]."""
    return (
        "Greatest pressure that each place of the flank sees over one mesh cycle; white: no contact. "
        "Tip on top on both flanks; z along the axis, 0 at mid-face, so the two flanks are not mirrored. "
        "The gear's map is the pinion's, carried over along the line of action. "
        f"At {full:g} N m the scale ends at the greatest pressure away from edges, {inside:.0f} MPa; "
        "orange-red is above it: cells at sharp tip edges and face ends, "
        f"up to {edge:.0f} MPa, where the value depends on the grid. "
    )


def contact_pattern(results):
    title = "Contact pattern of both flanks"
    pattern = results.tables.get("pattern.csv")
    if pattern is None or not len(pattern["torque_Nm"]):
        return LeftOut(title, "no pattern.csv with a torque above zero")
    full = max(pattern["torque_Nm"])
    light = light_torque(np.unique(pattern["torque_Nm"]))
    columns = [full] if light is None else [full, light]
    te = results.tables["te.csv"]
    inside = max(te["max_pressure_MPa"][te["torque_Nm"] == full])
    drawing, axes = panels(2, len(columns), 5.6, title)
    tables = []
    for c, torque in enumerate(columns):
        of_torque = rows(pattern, pattern["torque_Nm"] == torque)
        for r, (flank, angles, faces, pressure) in enumerate(pattern_on_flanks(of_torque)):
            scaled = torque == full and inside > 0
            highest = inside * (1 + 1e-6) if scaled else pressure.max()  # te.csv rounds
            shown = draw_pattern(axes[r, c], torque, flank, angles, faces, pressure, highest)
            tables.append(pattern_table(flank, torque, angles, faces, pressure))
        axes[1, c].set(xlabel="z [mm]")
        extend = "max" if torque == full else "neither"
        drawing.colorbar(
            shown,
            ax=axes[:, c],
            location="bottom",
            shrink=0.9,
            extend=extend,
            label="greatest pressure [MPa]",
        )
    caption = pattern_caption(full, inside, pattern["pressure_MPa"][pattern["torque_Nm"] == full].max())
    missing = None
    if light is not None:
        caption += f"The light load, {light:g} N m, is {100 * light / full:.2g} % of the greatest torque."
    else:
        missing = LeftOut(
            "Contact pattern at 1 % of the load",
            f'not computed: set output.light_load_pattern = "yes", or add the torque {0.01 * full:g} '
            "to load.pinion_torque_Nm",
        )
        caption += f"{missing.title}: {missing.reason}."
    return Figure("contact_pattern", title, caption, joined(tables), drawing, missing)


def first_cycle(table):
    return rows(table, table["phase"] < 1 - 1e-9)


def load_share(results):
    title = "Load share of a tooth pair"
    pairs = first_cycle(results.tables["pairs.csv"])
    torques = spread(np.unique(pairs["torque_Nm"]))
    if not len(torques):
        return LeftOut(title, "no tooth pair carries load")
    drawing, ((axes,),) = panels(1, 1, 3.4, title)
    tables = []
    for torque, style in zip(torques, curve_styles(len(torques))):
        of_torque = rows(pairs, pairs["torque_Nm"] == torque)
        at = of_torque["phase"] + of_torque["pair"]
        order = np.argsort(at)
        share = of_torque["load_share"][order]
        axes.plot(at[order], share, label=f"{torque:g} N m", **style)
        tables.append(
            {"torque_Nm": np.full(len(at), torque), "mesh_position_of_pair": at[order], "load_share": share}
        )
    axes.set(
        xlabel="position of the tooth pair [mesh cycles]",
        ylabel="share of the normal force [-]",
        ylim=(0, 1.05),
    )
    legend_above(axes)
    caption = (
        "Share of the whole normal force that one tooth pair carries on its way through the mesh, "
        "from its entry (left) to its exit; 0: at the pitch point at mid-face. Put together from the pairs "
        "in contact at each position of one mesh cycle. Only positions with contact are drawn."
    )
    return Figure("load_share", title, caption, joined(tables), drawing)


def draw_loaded_lines(axes, lines):
    """The contact lines on the pinion's flank, coloured by load; returns what a colour bar is made of."""
    load, extent = lines["load_per_length_N_per_mm"], lines["extent_mm"]
    steps = np.flatnonzero(
        (np.diff(lines["position"]) == 0)
        & (np.diff(lines["pair"]) == 0)
        & (np.diff(lines["z_mm"]) < 0.75 * (extent[1:] + extent[:-1]))  # neighbours touch
    )
    points = np.column_stack([lines["z_mm"], lines["pinion_roll_angle_deg"]])
    segments = LineCollection(
        np.stack([points[steps], points[steps + 1]], axis=1),
        array=(load[steps] + load[steps + 1]) / 2,
        linewidths=2.5,
    )
    segments.set_clim(0, load.max())
    axes.add_collection(segments)
    axes.autoscale()
    return segments


def draw_load_along_face(axes, lines):
    """Load per length along the face at one position, a curve a tooth pair."""
    pairs = np.unique(lines["pair"])
    if len(pairs) > MOST_PAIRS:
        raise InputError(f"lines.csv has more than {MOST_PAIRS} tooth pairs in contact at once")
    for pair, style in zip(pairs, curve_styles(len(pairs))):
        of_pair = lines["pair"] == pair
        axes.plot(
            lines["z_mm"][of_pair],
            lines["load_per_length_N_per_mm"][of_pair],
            marker=".",
            label=f"pair {pair:g}",
            **style,
        )
    axes.set(xlabel=FACE, ylabel="load per length [N/mm]", ylim=(0, None))
    axes.set_title(f"phase {lines['phase'][0]:.4g}: the greatest load per length", pad=22)
    legend_above(axes)


def contact_lines(results):
    title = "Load along the contact lines"
    lines = results.tables.get("lines.csv")
    if lines is None or not len(lines["torque_Nm"]):
        return LeftOut(title, "no lines.csv with a torque above zero")
    torque = max(lines["torque_Nm"])
    lines = first_cycle(rows(lines, lines["torque_Nm"] == torque))
    drawing, ((flank,), (worst,)) = panels(2, 1, 6.4, title, gridspec_kw={"height_ratios": [1.3, 1]})
    segments = draw_loaded_lines(flank, lines)
    flank.set(
        xlabel=FACE,
        ylabel="pinion roll angle [deg]",
        title=f"all positions of one mesh cycle, {torque:g} N m",
    )
    drawing.colorbar(segments, ax=flank, label="load per length [N/mm]")
    position = lines["position"][np.argmax(lines["load_per_length_N_per_mm"])]
    draw_load_along_face(worst, rows(lines, lines["position"] == position))
    table = {
        name: lines[name]
        for name in (
            "torque_Nm",
            "phase",
            "pair",
            "z_mm",
            "pinion_roll_angle_deg",
            "load_per_length_N_per_mm",
        )
    }
    caption = (
        f"Load per length of contact line at the greatest torque, {torque:g} N m. "
        "Above: the loaded contact lines on the pinion's flank at all computed positions of one mesh cycle. "
        "Below: the tooth pairs in contact at the position with the greatest value; "
        "pair 0 is at the pitch point at mid-face at phase 0."
    )
    return Figure("contact_lines", title, caption, table, drawing)


def modifications(results):
    title = "Flank modifications"
    table = results.tables.get("modifications.csv")
    if table is None:
        return LeftOut(title, "the case modifies no loaded flank (no modifications.csv)")
    drawing, axes = panels(3, 1, 7.6, title)
    low, high = table["removed_um"].min(), table["removed_um"].max()
    levels = [level for level in MaxNLocator(9).tick_values(low, high) if low < level < high]
    for row, (flank, name) in enumerate(
        (("pinion", "pinion"), ("gear", "gear"), ("sum", "sum of both, over the pinion's roll angle"))
    ):
        rolls, faces, removed = flank_map(rows(table, table["flank"] == flank), "removed_um")
        shown = axes[row, 0].pcolormesh(
            faces, rolls, removed, vmin=low, vmax=high, shading="nearest", rasterized=True
        )
        if any(removed.min() < level < removed.max() for level in levels):
            label_contours(axes[row, 0], contour_lines(axes[row, 0], faces, rolls, removed, levels))
        axes[row, 0].set(title=name, ylabel="roll angle [deg]")
    axes[2, 0].set(xlabel=FACE)
    drawing.colorbar(shown, ax=axes[:, 0], label="material removed [um]")
    caption = (
        "Material removed normal to the loaded flanks (tip on top), as the contact sees it as gaps: "
        "modifications and measured topography, without index errors, runout and misalignment. "
        "The sum is taken where both flanks meet on the line of action."
    )
    return Figure("modifications", title, caption, table, drawing)


def hunting_period(results):
    title = "Hunting period"
    lines = results.tables.get("sidebands.csv")
    if lines is None:
        return LeftOut(
            title,
            'the run rolls one mesh cycle (mesh_cycle.period = "hunting" rolls '
            "until the same teeth meet again)",
        )
    curves = curves_of(results)
    torque = curves.torques[-1]
    lines = rows(lines, (lines["torque_Nm"] == torque) & (lines["mesh_order"] <= 3.5))
    drawing, ((over_phase,), (spectrum,)) = panels(2, 1, 5.6, title)
    over_phase.plot(curves.abscissa, curves.te[-1], color=BLUE, linewidth=0.9)
    over_phase.set(xlabel="mesh phase [mesh cycles]", ylabel="TE [um]", xlim=(0, curves.cycles))
    floor = lines["amplitude_um"].max() * 1e-6
    drawn = np.maximum(lines["amplitude_um"], floor)
    spectrum.vlines(lines["mesh_order"], floor, drawn, color=BLUE, linewidth=1)
    spectrum.set(
        yscale="log",
        xlabel="order of the mesh frequency [-]",
        ylabel="peak amplitude [um]",
        ylim=(floor, None),
        xlim=(0, 3.5),
    )
    count = len(curves.abscissa)
    table = {
        "curve": ["te"] * count + ["spectrum"] * len(drawn),
        "torque_Nm": np.full(count + len(drawn), torque),
        "phase_or_mesh_order": np.concatenate([curves.abscissa, lines["mesh_order"]]),
        "te_or_amplitude_um": np.concatenate([curves.te[-1], lines["amplitude_um"]]),
    }
    caption = (
        f"Above: TE at {torque:g} N m until the same teeth meet again, {curves.cycles} mesh cycles. "
        "Below: its spectrum; whole orders are mesh harmonics, the lines between them come from the "
        "revolutions. Amplitudes below a millionth of the greatest are not drawn."
    )
    return Figure("hunting_period", title, caption, table, drawing)


def root_stress(results):
    """One tooth through the mesh: pair k at phase p is what the same tooth sees k mesh cycles on."""
    title = "Root stress of variant 0" if results.is_study else "Root stress"
    table = results.tables.get("root_stress.csv")
    if table is None:
        return LeftOut(title, 'not computed (output.root_stress = "yes" gives it)')
    torque = max(table["torque_Nm"])
    table = rows(table, table["torque_Nm"] == torque)
    stress, passage = table["tensile_stress_MPa"], np.round(table["phase"] + table["pair"], 9)
    drawing, axes = panels(2, 1, 5.4, title)
    tables = []
    for body, colour in (("pinion", BLUE), ("gear", VERMILION)):
        for fillet, line in (("loaded", "-"), ("other", "--")):
            own = (np.array(table["body"]) == body) & (np.array(table["fillet"]) == fillet)
            times, place = np.unique(passage[own], return_inverse=True)
            greatest = np.full(len(times), -np.inf)
            np.maximum.at(greatest, place, stress[own])
            axes[0, 0].plot(times, greatest, line, color=colour, label=f"{body}, {fillet} side")
            tables.append(root_table(torque, body, fillet, times, "all", greatest))
            at = times[np.argmax(greatest)]
            along = own & (passage == at)
            order = np.argsort(table["z_mm"][along])
            z, value = table["z_mm"][along][order], stress[along][order]
            axes[1, 0].plot(z, value, line, color=colour)
            tables.append(root_table(torque, body, fillet, np.full(len(z), at), z, value))
    axes[0, 0].set(
        xlabel="phase + tooth pair [mesh cycles]: a tooth's way through the mesh",
        ylabel="greatest over the face [MPa]",
    )
    axes[1, 0].set(xlabel="z [mm]", ylabel="when it is greatest [MPa]")
    legend_above(axes[0, 0], 2)
    caption = (
        "Greatest principal stress over the arc of each fillet, tension positive, "
        f"at {torque:g} N m, of the finite elements. Above: greatest along the face while a tooth passes the "
        "mesh. Below: along the face at the moment of each curve's greatest value."
    )
    return Figure("root_stress", title, caption, joined(tables), drawing)


def root_table(torque, body, fillet, passage, z, stress):
    count = len(stress)
    return {
        "torque_Nm": np.full(count, torque),
        "body": [body] * count,
        "fillet": [fillet] * count,
        "phase_plus_pair": passage,
        "z_mm": [z] * count if isinstance(z, str) else [f"{value:.9g}" for value in z],
        "tensile_stress_MPa": stress,
    }
