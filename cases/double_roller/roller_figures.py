# SPDX-License-Identifier: GPL-2.0-or-later
"""Figures of the double-roller drive: transmission error, gear ratio, contacts,
pressure and force of every pair.
"""
import numpy as np

from figure import Figure, LeftOut, joined
from mesh_figures import curves_of
from style import BLUE, curve_styles, legend_above, panels, spread

ANGLE = "crank angle [deg]"


def over_crank_angle(results, name, title, column, label, caption):
    """One curve a torque, of a column of te.csv."""
    curves = curves_of(results)
    shown = spread(range(len(curves.torques)))
    drawing, ((axes,),) = panels(1, 1, 3.6, title)
    for t, style in zip(shown, curve_styles(len(shown))):
        axes.plot(curves.abscissa, curves.of(column)[t], label=f"{curves.torques[t]:g} N m", **style)
    axes.set(xlabel=ANGLE, ylabel=label, xlim=(curves.abscissa[0], curves.abscissa[-1]))
    legend_above(axes)
    return Figure(name, title, caption, table_of(curves, shown, column), drawing)


def table_of(curves, torques, column):
    return joined(
        [
            {
                "torque_Nm": np.full(len(curves.abscissa), curves.torques[t]),
                "crank_angle_deg": curves.abscissa,
                column: curves.of(column)[t],
            }
            for t in torques
        ]
    )


def transmission_error(results):
    is_zero = results.setting("model.backlash") == "zero" or (
        results.setting("model.preset") == "paper" and not results.setting("model.backlash")
    )
    zero = (
        " Counted from where the most advanced pair touches, because backlash is zero: "
        "d phi - (phi_d - phi/N_s)."
        if is_zero
        else ""
    )
    return over_crank_angle(
        results,
        "transmission_error",
        "Loaded transmission error",
        "te_arcsec",
        "lag of the carrier [arcsec]",
        "Lag of the carrier behind crank angle / N_s under load, one curve a torque (figure 8 of the "
        f"double-roller actuator article, bibliography in contact/bibliography.md).{zero}",
    )


def gear_ratio(results):
    secant = results.setting("model.gear_ratio") == "secant" or (
        results.setting("model.preset") == "paper" and not results.setting("model.gear_ratio")
    )
    kind = "by secant over one degree of the crank" if secant else "by implicit differentiation at each angle"
    return over_crank_angle(
        results,
        "gear_ratio",
        "Gear ratio",
        "gear_ratio",
        "crank over carrier [-]",
        f"Turn of the crank over turn of the carrier, {kind} (figure 9 of the article). "
        f"Nominal: {results.own.rollers - 1}.",
    )


def contacts(results):
    """A panel a torque: the curves may be equal."""
    title = "Number of loaded pairs"
    curves = curves_of(results)
    shown = spread(range(len(curves.torques)), 4)
    drawing, axes = panels(len(shown), 1, 0.8 + 1.15 * len(shown), title, sharex=True, sharey=True)
    for row, t in enumerate(shown):
        axes[row, 0].step(curves.abscissa, curves.of("contacts")[t], where="mid", color=BLUE)
        axes[row, 0].set_title(f"{curves.torques[t]:g} N m", fontsize=9, loc="left")
        axes[row, 0].yaxis.get_major_locator().set_params(integer=True)
        axes[row, 0].set(ylabel="pairs [-]")
    axes[-1, 0].set(xlabel=ANGLE, xlim=(curves.abscissa[0], curves.abscissa[-1]))
    axes[0, 0].margins(y=0.15)
    caption = "Number of pairs of roller and sleeve that carry load (figure 10 of the article)."
    return Figure("contacts", title, caption, table_of(curves, shown, "contacts"), drawing)


def pair_map(results, name, title, column, label, caption):
    """A column of pairs.csv over crank angle and sleeve: a row a torque, a column a flank."""
    pairs = results.tables["pairs.csv"]
    torques = spread(np.unique(pairs["torque_Nm"]), 4)
    flanks = [flank for flank in ("drive", "coast") if np.any(pairs["flank"] == flank)]
    if not len(torques) or not pairs[column].max() > 0:
        return LeftOut(title, "zero everywhere: no pair carries load there")
    angles = np.unique(results.tables["te.csv"]["crank_angle_deg"])
    sleeves = np.arange(1, results.own.rollers)
    drawing, axes = panels(
        len(torques), len(flanks), 0.9 + 1.85 * len(torques), title, sharex=True, sharey=True
    )
    tables = []
    for r, torque in enumerate(torques):
        for c, flank in enumerate(flanks):
            mask = (pairs["torque_Nm"] == torque) & (pairs["flank"] == flank)
            angle, sleeve, value = (pairs[key][mask] for key in ("crank_angle_deg", "sleeve", column))
            shown = np.full((len(sleeves), len(angles)), np.nan)
            at = (np.searchsorted(sleeves, sleeve), np.searchsorted(angles, angle))
            np.fmax.at(shown, at, value)
            mesh = axes[r, c].pcolormesh(
                angles,
                sleeves,
                np.ma.masked_invalid(shown),
                vmin=0,
                vmax=pairs[column].max(),
                shading="nearest",
                rasterized=True,
            )
            axes[r, c].set_title(f"{torque:g} N m, {flank} flank")
            tables.append(
                {
                    "torque_Nm": np.full(len(angle), torque),
                    "flank": [flank] * len(angle),
                    "crank_angle_deg": angle,
                    "sleeve": sleeve,
                    "roller": pairs["roller"][mask],
                    column: value,
                }
            )
        axes[r, 0].set(ylabel="sleeve [-]")
    for bottom in axes[-1]:
        bottom.set(xlabel=ANGLE)
    drawing.colorbar(mesh, ax=axes, label=label, aspect=40)
    return Figure(name, title, caption, joined(tables), drawing)


def mid_pressure(results):
    return pair_map(
        results,
        "pair_mid_pressure",
        "Pressure of every pair, at mid-roller",
        "mid_pressure_MPa",
        "mid-roller pressure [MPa]",
        "Greatest pressure at mid-roller of every loaded pair over crank angle and number of the sleeve; "
        "white: no load. This value does not depend on the grid.",
    )


def of_ends(results):
    if results.setting("model.roller_ends") == "free":
        return "The ends are free: the pressure falls towards them."
    return "At straight ends the pressure is singular and the value grows with the number of cells."


def edge_pressure(results):
    return pair_map(
        results,
        "pair_edge_pressure",
        "Pressure of every pair, at the roller's ends",
        "edge_pressure_MPa",
        "pressure at the ends [MPa]",
        "Greatest pressure at the ends of the roller of every loaded pair; white: no load. "
        f"{of_ends(results)} "
        "With the preset paper these are to be compared with the peaks of the article's figure 7.",
    )


def pair_forces(results):
    return pair_map(
        results,
        "pair_force",
        "Load of every pair",
        "normal_force_N",
        "normal force [N]",
        "Normal force of every loaded pair over crank angle and number of the sleeve: "
        "how the pairs share the load; white: no load.",
    )


def pressure_along_rollers(results):
    """Figure 7 of the article as maps: the greatest pressure across the contact at each
    place along the roller.
    """
    title = "Pressure along the rollers at single crank angles"
    if not results.own.pressure_maps:
        return LeftOut(title, "no maps were kept: give the crank angles in output.pressure_maps_deg")
    angles = spread(sorted({kept.crank_angle for kept in results.own.pressure_maps}), 3)
    torques = spread(sorted({kept.torque for kept in results.own.pressure_maps}), 4)
    highest = max(kept.pressure.max() for kept in results.own.pressure_maps)
    drawing, axes = panels(
        len(torques), len(angles), 0.9 + 1.85 * len(torques), title, sharex="col", sharey=True
    )
    tables = []
    for r, torque in enumerate(torques):
        for c, angle in enumerate(angles):
            kept_here = [
                kept
                for kept in results.own.pressure_maps
                if (kept.torque, kept.crank_angle) == (torque, angle)
            ]
            for i, kept in enumerate(kept_here):
                along, first, place = np.unique(kept.along, return_index=True, return_inverse=True)
                peak = np.zeros(len(along))
                np.maximum.at(peak, place, kept.pressure)
                edges = np.append(along - kept.half_length[first], along[-1] + kept.half_length[first[-1]])
                mesh = axes[r, c].pcolormesh(
                    [i - 0.4, i + 0.4], edges, peak[:, None], vmin=0, vmax=highest, rasterized=True
                )
                tables.append(
                    {
                        "torque_Nm": np.full(len(along), torque),
                        "crank_angle_deg": np.full(len(along), angle),
                        "roller": [kept.roller] * len(along),
                        "sleeve": [kept.sleeve] * len(along),
                        "distance_from_mid_roller_mm": along,
                        "greatest_pressure_MPa": peak,
                    }
                )
            greatest = max((kept.pressure.max() for kept in kept_here), default=0)
            axes[r, c].set_title(f"{torque:g} N m, {angle:g} deg: {greatest:.0f} MPa", fontsize=9)
            axes[r, c].set_xticks(range(len(kept_here)), [f"{kept.sleeve}" for kept in kept_here])
            axes[r, c].grid(False)
        axes[r, 0].set(ylabel="y [mm]")
    for bottom in axes[-1]:
        bottom.set(xlabel="sleeve [-]")
    drawing.colorbar(mesh, ax=axes, label="greatest pressure across the contact [MPa]", aspect=40)
    caption = (
        "Each bar is one loaded pair: the greatest pressure across the contact over the distance y from "
        "mid-roller (the other half is the same; figure 7 of the article seen from above). "
        f"Above each panel the greatest cell. {of_ends(results)}"
    )
    return Figure("pressure_along_rollers", title, caption, joined(tables), drawing)
