# SPDX-License-Identifier: GPL-2.0-or-later
"""Two results that must be the same, and how nearly they can be; every tolerance has its reason beside it."""
import copy

from deviations import removed
from program import require


def near(case):
    """Two grids of one contact, tolerance(te) in um.
    Neighbouring torque bands of the ready cases, which yield some 20 um and have 10 um taken off,
    agree to 0.005 um; random flanks to twice that, in proportion to both.
    """
    off = removed(case)
    return lambda te: 0.01 * max(1, abs(te) / 20, off / 10)


def exact(te):
    """The same grid, its contact solved in another order of operations; nine decimals are written."""
    return 4e-9 + 2e-9 * abs(te)


def rounding(te):
    """The same numbers in another order of operations: 1e-6 um, as the seam of a mesh cycle;
    in proportion above a micrometre's scale of 1 mm.
    """
    return 1e-6 * max(1, abs(te) / 100)


def same(first, second, what, tolerance, scale=1, order=None):
    """Transmission error, and where it is the same grid the rest; tolerance(te) in um.
    Returns the greatest difference over the tolerance.
    """
    worst = 0
    for t in range(len(first.torques)):
        a, b = first.te(t), second.te(t)
        for k, value in enumerate(a):
            other = b[order(k) if order else k] / scale
            ratio = abs(value - other) / tolerance(value)
            worst = max(worst, ratio)
            require(
                ratio <= 1,
                f"{what}: {other} um, not {value} um at {first.torques[t]} N m, "
                f"position {k} ({ratio:.3g} of the tolerance)",
            )
    return worst


def finer_cells(case):
    """Three times as many cells across the profile: what too few of them make must be gone."""
    finer = copy.deepcopy(case)
    finer["contact_grid"]["profile_cells"] = 3 * case["contact_grid"]["profile_cells"]
    return finer
