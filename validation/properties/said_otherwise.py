# SPDX-License-Identifier: GPL-2.0-or-later
"""The same case in other keys, or with more positions."""
import copy
import math

from geometry import GEARS
from sameness import rounding, same


def positions(case, g, base, run, r):
    """Twice as many positions contain the first ones, to the digit."""
    other = copy.deepcopy(case)
    other["mesh_cycle"]["positions"] *= 2
    return same(
        base, run(other, "positions"), "twice the positions", lambda te: 1.1e-9, order=lambda k: 2 * k
    )


def spelling(case, g, base, run, r):
    """The same case in other keys: modules, pressure angles, thickness, starts, tilts,
    default diameters, flanks one by one.
    """
    other = copy.deepcopy(case)
    pair = other["pair"]
    module, angle = (
        ("normal", math.degrees(math.atan(math.tan(g.angle) * math.cos(g.helix))))
        if "transverse_module_mm" in pair
        else ("transverse", math.degrees(g.angle))
    )
    pair.pop("normal_module_mm", None), pair.pop("transverse_module_mm", None)
    pair.pop("normal_pressure_angle_deg", None), pair.pop("transverse_pressure_angle_deg", None)
    pair[f"{module}_module_mm"] = g.normal_module if module == "normal" else g.module
    pair[f"{module}_pressure_angle_deg"] = angle
    if "centre_distance_error_um" in pair:
        pair["centre_distance_mm"] = g.centre_distance
        del pair["centre_distance_error_um"]
    for key in list(other.get("misalignment", {})):
        value = other["misalignment"].pop(key)
        other["misalignment"].update(
            {key[:-3] + "_mrad": value / g.face}
            if key.endswith("_um")
            else {key[:-5] + "_um": value * g.face}
        )
    for name, body in zip(GEARS, g.bodies):
        table = other[name]
        if "tooth_thickness_mm" in table:
            del table["tooth_thickness_mm"]
            table["profile_shift"] = body.shift
        else:
            table.pop("profile_shift", None)
            table["tooth_thickness_mm"] = body.thickness
        table["tip_diameter_mm"], table["root_diameter_mm"] = 2 * body.tip, 2 * body.root
        for key in ("tip_relief", "lead_crown", "helix_slope", "bias"):  # what both flanks have, each has
            if key in table and r.random() < 0.5:
                both = table.pop(key)
                for side in ("left_flank", "right_flank"):
                    table.setdefault(side, {}).setdefault(key, copy.deepcopy(both))
        for flank in [table] + [table[side] for side in ("left_flank", "right_flank") if side in table]:
            for relief in [flank[key] for key in ("tip_relief", "root_relief") if key in flank] + flank.get(
                "bias", []
            ):
                if "start_roll_angle_deg" in relief:
                    relief["start_diameter_mm"] = 2 * body.radius_at(
                        math.radians(relief.pop("start_roll_angle_deg"))
                    )
                elif "start_diameter_mm" in relief:
                    relief["start_length_of_roll_mm"] = body.base * body.roll_at(
                        relief.pop("start_diameter_mm") / 2
                    )
                else:
                    relief["start_roll_angle_deg"] = math.degrees(
                        relief.pop("start_length_of_roll_mm") / body.base
                    )
    return same(base, run(other, "spelling"), "other keys", rounding)
