# SPDX-License-Identifier: GPL-2.0-or-later
"""What a case takes off its flanks and out of its backlash."""

from geometry import GEARS


def flanks(case):
    """The tables that hold modifications."""
    for name in GEARS:
        for table in [case[name]] + [
            case[name][side] for side in ("left_flank", "right_flank") if side in case[name]
        ]:
            yield table


def removed(case):
    """What deviations of both gears come to at most, um: each one's amount."""
    total = sum(
        abs(v) * (1 if k.endswith("_um") else min(case[name]["face_width_mm"] for name in GEARS))
        for k, v in case.get("misalignment", {}).items()
    )
    for table in flanks(case):
        total += sum(
            abs(part["amount_um"])
            for part in table.values()
            if isinstance(part, dict) and "amount_um" in part
        )
        total += sum(bias["amount_um"] for bias in table.get("bias", [])) + max(
            map(abs, table.get("index_errors_um", [0]))
        )
        if "topography" in table:
            total += max(abs(v) for row in case["files"][table["topography"]["file"]]["um"] for v in row)
    return total


def backlash_taken(case, g):
    """At most, by index errors, runout and tilts of the teeth, um: tilts may bring the other flanks together
    as far as they set these apart.
    """
    taken = sum(
        2 * abs(v) * (1 if k.endswith("_um") else g.face) for k, v in case.get("misalignment", {}).items()
    )
    for table in flanks(case):
        errors = table.get("index_errors_um", [0])
        taken += max(errors) - min(errors) + table.get("runout", {}).get("amount_um", 0)
    return taken
