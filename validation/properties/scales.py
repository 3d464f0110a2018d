# SPDX-License-Identifier: GPL-2.0-or-later
"""Other lengths and other moduli: geometric similarity and linear elasticity."""
import copy

from sameness import exact, same


def scaled(case, s, stiffer=1):
    """All lengths s times as long, and moduli `stiffer` times as high: transmission error s times as large
    under s^3 stiffer times the torque.
    """
    other = copy.deepcopy(case)

    def visit(table):
        for key, value in table.items():
            if isinstance(value, dict):
                visit(value)
            elif key == "bias":
                for item in value:
                    visit(item)
            elif isinstance(value, list):
                if key == "index_errors_um":
                    table[key] = [s * v for v in value]
                elif key == "pinion_torque_Nm":
                    table[key] = [s**3 * stiffer * v for v in value]
            elif key.endswith("_Nm_per_mrad"):
                table[key] = s**3 * stiffer * value
            elif key.endswith("_GPa"):
                table[key] = stiffer * value
            elif key.endswith(("_mm", "_um")):
                table[key] = s * value

    files = other.pop("files")
    visit(other)
    for table in files.values():
        table["um"] = [[s * v for v in row] for row in table["um"]]
        table["z"] = [s * v for v in table["z"]]
        if table["axis"] != "roll_angle_deg":
            table["at"] = [s * v for v in table["at"]]
    other["files"] = files
    return other


def lengths(case, g, base, run, r):
    """Geometric similarity, by powers of two: windows come in steps of the root of two
    and stay the same cells.
    """
    s = r.choice([0.5, 2.0, 4.0])
    return same(base, run(scaled(case, s), "lengths"), f"lengths times {s}", exact, scale=s)


def moduli(case, g, base, run, r):
    """Linear elasticity: E and the torque together change nothing."""
    s = r.choice([0.5, 2.0])
    return same(base, run(scaled(case, 1, s), "moduli"), f"moduli times {s}", exact)
