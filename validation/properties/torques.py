# SPDX-License-Identifier: GPL-2.0-or-later
"""What torques have to do with each other: nothing in a list, and virtual work."""
import copy
import math

from program import require
from sameness import exact, finer_cells, near


def alone(case, g, base, run, r):
    """A torque alone gives what it gives in a list."""
    other = copy.deepcopy(case)
    t = r.choice([i for i, torque in enumerate(base.torques) if torque > 0])
    other["load"]["pinion_torque_Nm"] = [base.torques[t]]
    result = run(other, "alone")
    worst = 0
    for k, (a, b) in enumerate(zip(base.te(t), result.te(0))):
        worst = max(worst, abs(a - b) / exact(a))
        require(
            abs(a - b) <= exact(a),
            f"alone: {b} um, not {a} um at {base.torques[t]} N m, position {k}",
        )
    return worst


def virtual_work(case, g, base, run, r):
    """The tangent stiffness is the slope of torque over transmission error, on one grid.
    Windows about a load that few cells resolve follow it, and the slope is of their error too.
    """
    worst, message = slopes(case, g, max(base.torques), run, "virtual_work")
    if worst > 1:
        worst, message = slopes(finer_cells(case), g, max(base.torques), run, "virtual_work_finer")
    require(worst <= 1, message)
    return worst


def slopes(case, g, torque, run, name):
    """The greatest difference of slope and stiffness over its tolerance, and what it is: between torques 1e-4
    apart. Of two such intervals one holds: where a cell comes into contact, or a grid changes, is in the
    other.
    """
    other = copy.deepcopy(case)
    step = 1e-4
    other["load"]["pinion_torque_Nm"] = [torque, torque * (1 - step), torque * (1 - 2 * step)]
    result = run(other, name)
    worst, message = 0, ""
    for k, rows in enumerate(zip(*result.at)):
        outside, told = [], []
        for high, low in zip(rows, rows[1:]):
            difference = high["te_um"] - low["te_um"]
            # Grids may differ by the stated noise: 0.0005 um where `near` is 0.01.
            require(
                difference > -near(case)(high["te_um"]) / 20,
                f"virtual work: {difference} um between torques {step} apart",
            )
            if difference <= 0:  # another grid
                outside.append(math.inf), told.append(f"{difference} um")
                continue
            slope = torque * step * 1e3 / g.bodies[0].base / difference
            ends = [high["mesh_stiffness_N_per_um"], low["mesh_stiffness_N_per_um"]]
            # theta(T) is linear but for cells that enter or leave in between: the slope lies between those at
            # the ends. Nine decimals of um, six of N/um are written. Windows that follow their load: 1e-7 um.
            slack = slope * (2e-7 / difference + 1e-5) + 1e-6
            outside.append(max(0.0, slope - max(ends), min(ends) - slope) / slack)
            told.append(f"slope {slope} N/um, tangent stiffness {ends} N/um")
        if min(outside) >= worst:
            worst, message = (
                min(outside),
                f"virtual work: {'; '.join(told)} at {torque} N m, position {k}",
            )
    return worst, message
