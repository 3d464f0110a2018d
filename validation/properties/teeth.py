# SPDX-License-Identifier: GPL-2.0-or-later
"""Which teeth mesh, and where they stand: hunting periods, and all teeth of a gear set back."""
import copy
import itertools
import math

from deviations import backlash_taken, flanks
from geometry import GEARS
from of_results import growing
from program import Refused, require
from sameness import finer_cells, near, rounding, same


def all_teeth_meet(case, g, run):
    """The run of a hunting period. Teeth that do not meet in the first mesh cycle can take the backlash that
    is left there: then `case` gets deviations of single teeth half as large, until it is enough.
    """
    for name_of_run in (f"hunting{'_halved' * k}" for k in itertools.count()):
        try:
            return run(case, name_of_run)
        except Refused as refusal:
            if (
                "the other flanks would touch" not in str(refusal)
                or backlash_taken(case, g) <= 1e3 * g.normal_backlash
            ):
                raise
        for name in GEARS:
            if "index_errors_um" in case[name]:
                case[name]["index_errors_um"] = [v / 2 for v in case[name]["index_errors_um"]]
            if "runout" in case[name]:
                case[name]["runout"]["amount_um"] /= 2


def hunting(case, g, base, run, r):
    """Until the same teeth meet again: without deviations of single teeth every mesh cycle repeats the first;
    with them, teeth counted from the next one on meet a cycle earlier.
    """
    other = copy.deepcopy(case)
    other["mesh_cycle"]["period"] = "hunting"
    single = any("index_errors_um" in table or "runout" in table for table in flanks(case))
    n, cycles = case["mesh_cycle"]["positions"], math.lcm(*(b.teeth for b in g.bodies))
    whole = all_teeth_meet(other, g, run)
    require(
        all(len(rows) == n * cycles for rows in whole.at),
        f"hunting: {len(whole.at[0])} positions for {cycles} cycles of {n}",
    )
    growing(other, g, whole)
    if not single:
        return max(
            same(base, whole, f"hunting, cycle {c}", rounding, order=lambda k: c * n + k)
            for c in range(cycles)
        )
    for name, body in zip(GEARS, g.bodies):
        table = other[name]
        if "index_errors_um" in table:
            table["index_errors_um"] = table["index_errors_um"][1:] + table["index_errors_um"][:1]
        if "runout" in table:
            table["runout"]["angle_deg"] = math.remainder(
                table["runout"]["angle_deg"] - 360 / body.teeth, 360
            )
    return same(
        whole,
        run(other, "hunting_shifted"),
        "hunting, one tooth on",
        rounding,
        order=lambda k: (k - n) % (n * cycles),
    )


def at_tip(g, run, row):
    """Is a slice loaded beside the path of action, where the tip edge of a gear touches?"""
    return any(
        abs(arm / b.base / math.cos(g.base_helix) - 1) > 1e-9
        for line in run.lines
        if line["torque_Nm"] == row["torque_Nm"] and line["position"] == row["position"]
        for arm, b in zip(g.levers(line["phase"], round(line["pair"]), line["z_mm"]), g.bodies)
    )


def stand_back(case, g, base, run, r):
    """Every tooth of a gear set back alike is a rotation: TE grows by it over cos(beta_b).
    Those of the pinion turn it to where it was, whatever touches; those of the gear make it meet at another
    phase, which shows where contact is outside the path of action.
    """
    name = r.choice(GEARS)
    back, other = 2.0 * g.module, copy.deepcopy(case)
    errors = case[name].get("index_errors_um", [0.0] * case[name]["teeth"])
    other[name]["index_errors_um"] = [e + back for e in errors]
    for side in ("left_flank", "right_flank"):
        if "index_errors_um" in other[name].get(side, {}):
            return None
    later = run(other, "stand_back")
    worst, message = stood_back(g, base, later, back, name, rounding)
    if worst > 1:
        # A tip edge that touches under another torque of a position is in the grid and moves apart: few cells
        # then lie elsewhere.
        finer = run(finer_cells(case), "finer"), run(finer_cells(other), "stand_back_finer")
        worst, message = stood_back(g, *finer, back, name, rounding)
        if worst > 1 and name == "gear":
            # Tip edges that nearly touch, and do so at another phase, can have the first guess of a position
            # on one side alone: the cells are then others.
            worst, message = stood_back(g, *finer, back, name, near(case))
    require(worst <= 1, f"all teeth of the {name} {back} um back: {message}")
    return worst


def stood_back(g, base, result, back, name, tolerance):
    """The greatest difference over its tolerance, and what it is."""
    worst, message = 0, ""
    for k, rows in enumerate(zip(*base.at)):
        for t, (torque, row) in enumerate(zip(base.torques, rows)):
            runs = ((base, row), (result, result.at[t][k]))
            if torque == 0 or name == "gear" and any(at_tip(g, *of_run) for of_run in runs):
                continue
            later = result.at[t][k]["te_um"]
            difference = abs(later - row["te_um"] - back / math.cos(g.base_helix)) / tolerance(later)
            if difference > worst:
                worst = difference
                message = f"{later} um after {row['te_um']} um at {torque} N m, position {k}"
    return worst, message
