# SPDX-License-Identifier: GPL-2.0-or-later
"""What must hold of every result. Every tolerance has its reason beside it."""
import math

from deviations import removed
from geometry import GEARS
from program import require
from sameness import near


def sound(case, g, result):
    """Every number is finite (or the tables could not be read), certified, and the tables
    agree with each other.
    """
    warned = "the whole load stands on one of" in result.summary
    require(
        warned == bool(result.on_one_slice), "a load on one slice, and no word of it, or the word without it"
    )
    for rows in result.at:
        for row in rows:
            certified(g, row)
    pairs = {}
    for row in result.pairs:
        pairs.setdefault((row["torque_Nm"], row["position"]), []).append(row)
    lines = carried_along_lines(g, result)
    slice_width = g.face / case["contact_grid"]["slices"]
    for torque, rows in zip(result.torques, result.at):
        for row in rows:
            if torque == 0:
                unloaded(case, g, row)
            else:
                key = row["torque_Nm"], row["position"]
                in_balance(g, torque, row, pairs.get(key, []), lines.get(key, Carried()), slice_width)
    for t in range(len(result.torques)):
        harmonics_of_te(result, t, case["mesh_cycle"]["positions"])


def certified(g, row):
    """The certificate is below its gate; both forms of the transmission error say the same."""
    # The gate is 1e-10, or 100 roundings of the widest gap over the deflection where that is more:
    # gaps stay below the module.
    gate = max(1e-10, 2.3e-14 * g.module / max(1e-9, 1e-3 * abs(row["te_um"])))
    require(0 <= row["certificate"] <= gate, f"certificate {row['certificate']}")
    base = g.bodies[1].base
    angle = row["te_um"] * 1e-3 / base * 180 / math.pi * 3600
    written = 6e-10 * (1 + 207 / base)  # both with nine decimals
    require(
        abs(row["te_arcsec"] - angle) <= written + 1e-12 * abs(angle),
        f"te_arcsec {row['te_arcsec']} for {angle}",
    )


class Carried:
    """What the loaded slices of one position carry: force [N], moments about both axes [N mm], how many."""

    def __init__(self):
        self.force, self.moments, self.slices = 0, [0, 0], 0


def carried_along_lines(g, result):
    """By torque and position, from the loads along the contact lines and their levers."""
    carried = {}
    for row in result.lines:
        force = row["load_per_length_N_per_mm"] * row["extent_mm"] / math.cos(g.base_helix)
        arms = g.levers(row["phase"], round(row["pair"]), row["z_mm"])
        here = carried.setdefault((row["torque_Nm"], row["position"]), Carried())
        here.force += force
        here.moments = [moment + force * arm for moment, arm in zip(here.moments, arms)]
        here.slices += 1
    return carried


def unloaded(case, g, row):
    """Nothing is in contact, and the gear is no further ahead than deviations let it be."""
    require(
        row["contacts"] == 0 and row["max_pressure_MPa"] == 0 and row["mesh_stiffness_N_per_um"] == 0,
        "unloaded, but in contact",
    )
    ahead = 1.5 * removed(case) / math.cos(g.base_helix) + 1e-6
    require(row["te_um"] >= -ahead, f"unloaded gear {-row['te_um']} um ahead, not {ahead}")


def in_balance(g, torque, row, pairs, carried, slice_width):
    """Pairs and lines carry the same force, which balances the torques on both gears."""
    key = row["torque_Nm"], row["position"]
    total = sum(pair["normal_force_N"] for pair in pairs)
    require(
        row["contacts"] == len(pairs) > 0,
        f"{row['contacts']} contacts, {len(pairs)} in pairs.csv at {key}",
    )
    require(
        abs(sum(pair["load_share"] for pair in pairs) - 1) <= 1e-9 * len(pairs),
        f"load shares at {key}",
    )
    # Loads along the lines come with six decimals of N/mm, those of pairs with six of N:
    # the same forces summed otherwise.
    rounding = 1e-6 * slice_width / math.cos(g.base_helix) * carried.slices
    require(
        abs(carried.force - total) <= rounding + 1e-6 * len(pairs) + 1e-9 * total,
        f"lines carry {carried.force} N, pairs {total} N at {key}",
    )
    # Equilibrium of both gears under normal forces with their levers, which follow from the involutes
    # alone, tip edges included.
    for i, given in enumerate((torque, row["gear_torque_Nm"])):
        found = carried.moments[i] * 1e-3
        require(
            abs(found - given) <= 1e-3 * 2 * rounding * g.bodies[i].tip + 1e-7 * given,
            f"{GEARS[i]}: forces have the moment {found}, not {given} N m at {key}",
        )
    require(row["mesh_stiffness_N_per_um"] > 0, f"stiffness {row['mesh_stiffness_N_per_um']} at {key}")


def harmonics_of_te(result, t, positions):
    """The amplitudes in harmonics.csv are those of the transmission error at a torque."""
    te = result.te(t)
    for row in [row for row in result.harmonics if row["torque_Nm"] == result.at[t][0]["torque_Nm"]]:
        order = row["harmonic"] * len(te) / positions
        c = [
            sum(v * f(2 * math.pi * order * k / len(te)) for k, v in enumerate(te)) / len(te)
            for f in (math.cos, math.sin)
        ]
        amplitude = (1 if 2 * order == len(te) else 2) * math.hypot(*c)
        require(
            abs(amplitude - row["amplitude_um"]) <= 1e-8 + 1e-12 * max(map(abs, te)),
            f"amplitude {row['amplitude_um']} for {amplitude}",
        )  # nine decimals


def round_as_written(torque):
    return float(f"{torque:.9g}")


def growing(case, g, result):
    """theta(T) increases where the compliance is positive definite: at every position, and so its mean."""
    order = sorted(range(len(result.torques)), key=lambda t: result.torques[t])
    for low, high in zip(order, order[1:]):
        for k, (a, b) in enumerate(zip(result.te(low), result.te(high))):
            # Other grids differ among themselves; unloaded flanks are searched at other
            # places than those of a grid.
            slack = near(case)(b) if result.torques[low] > 0 else 0.05 + 0.02 * abs(b)
            if not result.on_one_slice.isdisjoint(
                {(round_as_written(result.torques[i]), k) for i in (low, high)}
            ):
                continue  # neither grid resolves a load on one slice; the summary has said so (`sound`)
            require(
                b > a - slack,
                f"transmission error {b} um at {result.torques[high]} N m, "
                f"{a} um at {result.torques[low]} N m, position {k}",
            )
