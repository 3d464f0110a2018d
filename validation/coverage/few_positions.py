# SPDX-License-Identifier: GPL-2.0-or-later
"""Bounds at few positions a mesh cycle: each scene at draft with 4 to 16 positions, beside the same scene
with 240. What is wrong is then what the positions miss alone; the bounds allow for grids and bodies too.
"""
import math, shutil, statistics

NUMBERS = (4, 5, 6, 8, 10, 12, 16)
NAMES = ("mean", "peak_to_peak", "A1", "A2", "A3")


def triples_of(folder, compute, rows, columns):
    """By number of positions and quantity: true error, bound, true value. [um]"""
    draft = {"accuracy": '"draft"'}
    truth = compute(
        folder, "all", {**draft, "mesh_cycle.positions": 240, "output.error_estimate": "no"}
    )
    found = {}
    for n in NUMBERS:
        few = compute(folder, "few", {**draft, "mesh_cycle.positions": n})
        stated = rows(folder / "few" / "error_estimate.csv")[0]
        shutil.rmtree(folder / "few")
        for name in NAMES:
            bound = float(stated[columns[name]])
            if not math.isnan(bound):
                found[n, name] = (abs(few[name] - truth[name]), bound, truth[name])
    return found


def show(scenes):
    """A line a number of positions: how often each bound holds, and the median of bound over error."""
    print(f"{len(scenes)} scenes at draft; contained %, stated over true (median)")
    print(f"{'positions':>9}" + "".join(f"{name:>18}" for name in NAMES))
    for n in NUMBERS:
        line = f"{n:9}"
        for name in NAMES:
            known = [scene[n, name] for scene in scenes if (n, name) in scene]
            if not known:
                line += f"{'-':>18}"
                continue
            held = statistics.fmean(error <= bound + 5e-4 for error, bound, _ in known)
            ratio = statistics.median(bound / max(error, 1e-9) for error, bound, _ in known)
            line += f"{100 * held:10.0f}{ratio:8.1f}"
        print(line)
    for number, scene in enumerate(scenes, start=1):
        for (n, name), (error, bound, truth) in scene.items():
            if error > bound + 5e-4:
                print(f"  scene {number} of them, {n} positions: {name} {truth:.4g} is {error:.4g} off, "
                      f"stated {bound:.4g}")
