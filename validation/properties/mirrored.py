# SPDX-License-Identifier: GPL-2.0-or-later
"""The same drive seen in a mirror, turned over, or driven from its other gear."""
import copy
import math

from deviations import flanks, removed
from geometry import GEARS
from program import require
from sameness import finer_cells, rounding, same


def mirror_z(case):
    pair, tilt = case["pair"], case.get("misalignment", {})
    if "axial_offset_mm" in pair:
        pair["axial_offset_mm"] *= -1
    for key in tilt:
        tilt[key] *= -1
    for table in flanks(case):
        if "helix_slope" in table:
            table["helix_slope"]["amount_um"] *= -1
        end = table.get("end_relief", {}).get("end")
        if end in ("negative_z", "positive_z"):
            table["end_relief"]["end"] = "positive_z" if end == "negative_z" else "negative_z"
    for table in case["files"].values():
        table["z"] = [-z for z in reversed(table["z"])]
        table["um"] = [row[::-1] for row in table["um"]]


def other_hand(case):
    """A spur pair is the limit of a right-hand pinion: what is mirrored has the corners of its
    bias exchanged instead.
    """
    if case["pair"].get("helix_angle_deg", 0) != 0:
        case["pair"]["pinion_hand"] = "left" if case["pair"]["pinion_hand"] == "right" else "right"
    else:
        for table in flanks(case):
            for bias in table.get("bias", []):
                bias["corner"] = {1: 2, 2: 1, 3: 4, 4: 3}[bias["corner"]]


def other_sense(case):
    case["load"]["drive_flank"] = (
        "clockwise" if case["load"]["drive_flank"] == "counter_clockwise" else "counter_clockwise"
    )
    for name in GEARS:
        left, right = case[name].pop("left_flank", None), case[name].pop("right_flank", None)
        case[name].update(
            {
                side: table
                for side, table in (("left_flank", right), ("right_flank", left))
                if table is not None
            }
        )


def mirror(case, g, base, run, r):
    """The drive mirrored in z or in y, or turned about x."""
    which = r.choice(["z", "y", "x"])
    other = copy.deepcopy(case)
    if which in "zx":
        mirror_z(other)
    if which in "zy":
        other_hand(other)
    if which in "yx":
        other_sense(other)
    result = run(other, f"mirror_{which}")
    worst = same(base, result, f"mirrored, {which}", rounding)
    for rows, others in zip(base.at, result.at):
        for row, image in zip(rows, others):
            for key in ("mesh_stiffness_N_per_um", "gear_torque_Nm", "max_pressure_MPa"):
                # Written with four to six decimals. Mirrored cells are summed in another order, and where the
                # contact is sought stops at 1e-6 of its range.
                require(
                    abs(row[key] - image[key]) <= 1e-3 + 1e-5 * abs(row[key]),
                    f"mirrored, {which}: {key} {image[key]}, not {row[key]}",
                )
    return worst


def exchange(case, g, base, run, r):
    """The gear drives: the pair turned by half a turn about an axis parallel to its own.
    Cells lie along the driver's profile: few of them are other ones then.
    """
    worst, message = exchanged(case, g, base, run, "exchange")
    if worst > 1:
        finer = finer_cells(case)
        worst, message = exchanged(finer, g, run(finer, "finer"), run, "exchange_finer")
    require(worst <= 1, message)
    return worst


def exchanged(case, g, base, run, name):
    """The greatest difference over its tolerance, and what it is.
    Senses and z stay, so the same flanks carry when the new pinion drives in the old one's sense; the mesh
    runs backwards, position k is N - k. Torques are those of the gear, in the ratio of teeth where contact
    stays on the path of action.
    """
    other = copy.deepcopy(case)
    other["pinion"], other["gear"] = other["gear"], other["pinion"]
    other_hand(other)
    if "axial_offset_mm" in other["pair"]:
        other["pair"]["axial_offset_mm"] *= -1
    springs = other.get("mounting", {})
    other["mounting"] = {
        ("gear" if key.startswith("pinion") else "pinion") + key[key.index("_") :]: value
        for key, value in springs.items()
    }
    ratio = g.bodies[1].teeth / g.bodies[0].teeth
    other["load"]["pinion_torque_Nm"] = [t * ratio for t in base.torques]
    result = run(other, name)
    n, off = case["mesh_cycle"]["positions"], removed(case)
    worst, message = 0, ""

    def from_ratio(k, torque):
        """How far the torques of the gears are from the ratio of their teeth; unloaded,
        what touches carries the lightest load.
        """
        carried = [t for t, other in enumerate(base.torques) if other > 0 and torque in (0, other)]
        lightest = min(carried, key=lambda t: base.torques[t], default=None)
        return lightest is not None and abs(
            base.at[lightest][k]["gear_torque_Nm"] / base.torques[lightest] / ratio - 1
        )

    for t, torque in enumerate(base.torques):
        swing = max(base.te(t)) - min(base.te(t))
        for k, row in enumerate(base.at[t]):
            image = result.at[t][(n - k) % n]
            # Gaps are taken along the normal at the pinion's point: at the other gear's they differ by gap
            # times slope, some 1e-4 of what the flanks yield and stand back.
            tolerance = 0.002 + 5e-4 * (abs(row["te_um"]) + off)
            away = from_ratio(k, torque)
            if away > 1e-8:
                # Tip edges carry: torque and TE are no longer in the ratio of base circles, and the position,
                # which the driver's nominal rotation names, differs by TE over the base pitch; TE changes by
                # up to 2 pi times its swing in a cycle.
                tolerance += (abs(row["te_um"]) + off) * (
                    2 * away + 2 * math.pi * 1e-3 * swing / g.base_pitch
                )
            difference = abs(row["te_um"] - image["te_um"]) / tolerance
            if difference >= worst:
                worst, message = difference, (
                    f"exchanged: {image['te_um']} um, not {row['te_um']} um at {torque} N m, "
                    f"position {k} ({difference:.3g} of the tolerance)"
                )
    return worst, message
