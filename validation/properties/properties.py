# SPDX-License-Identifier: GPL-2.0-or-later
"""What must hold of every result, and between the results of cases that say the same thing differently.
Every tolerance has its reason beside it.
"""
import copy, csv, itertools, math, re, subprocess

from pairs import GEARS, Geometry, write


class Broken(Exception):
    """A property does not hold."""


class Refused(Exception):
    """The program says in one line that it does not compute this."""


def require(holds, message):
    if not holds:
        raise Broken(message)


# ---------------------------------------------------------------------------------------------------- running


class Result:
    """Tables of a run: at[torque][position] is a row of te.csv, in the case's order of torques."""

    def __init__(self, folder, case):
        self.torques = case["load"]["pinion_torque_Nm"]
        rows = self._read(folder / "te.csv")
        n = len(rows) // len(self.torques)
        self.at = [rows[i * n : (i + 1) * n] for i in range(len(self.torques))]
        self.pairs, self.lines, self.harmonics = (
            self._read(folder / f"{name}.csv") for name in ("pairs", "lines", "harmonics")
        )
        self.summary = (folder / "summary.txt").read_text()
        loaded_slices = {}
        for row in self.lines:
            key = row["torque_Nm"], row["position"]
            loaded_slices[key] = loaded_slices.get(key, 0) + 1
        self.on_one_slice = {key for key, count in loaded_slices.items() if count == 1}
        self.other = [
            self._read(path)
            for path in sorted(folder.glob("*.csv"))
            if path.name in ("subsurface.csv", "root_stress.csv", "sidebands.csv", "pattern.csv")
        ]

    @staticmethod
    def _read(path):
        with open(path) as file:
            rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
        for row in rows:
            for key, text in row.items():
                if (
                    text == "" and path.name == "subsurface.csv"
                ):  # loaded at edges alone: nothing below the inside
                    continue
                try:
                    row[key] = float(text)
                except ValueError:
                    if key not in ("body", "fillet"):
                        raise Broken(f"{path.name}: {key} is {text!r}")
                if isinstance(row[key], float) and not math.isfinite(row[key]):
                    raise Broken(f"{path.name}: {key} is {text}")
        return rows

    def te(self, torque):
        return [row["te_um"] for row in self.at[torque]]


class Program:
    """Runs cases in a folder, with an operator cache of its own."""

    def __init__(self, flank, folder, environment, seconds=300):
        self.flank, self.folder, self.environment, self.seconds, self.log = (
            flank,
            folder,
            environment,
            seconds,
            [],
        )

    def __call__(self, case, name, text=None):
        """The result of a case; Refused or Broken where there is none.
        `text`: what becomes of the case file before it is read.
        """
        place = self.folder / name
        place.mkdir(parents=True)
        write(case, place / "case.toml")
        if text:
            path = place / "case.toml"
            path.write_bytes(text(path.read_text()).encode(errors="surrogateescape"))
        command = [str(self.flank), "run", str(place / "case.toml"), "-o", str(place / "out")]
        self.log.append(name)
        try:
            ran = subprocess.run(
                command,
                capture_output=True,
                text=True,
                errors="replace",
                env=self.environment,
                timeout=self.seconds,
            )
        except subprocess.TimeoutExpired:
            raise Broken(f"{name}: no end after {self.seconds} s")
        (place / "messages").write_text(ran.stderr)
        lines = [line for line in ran.stderr.splitlines() if line.strip()]
        bad = [
            line
            for line in lines
            if re.search(r"internal error|[Aa]ssert|terminate called|Traceback|what\(\)|std::", line)
        ]
        require(ran.returncode >= 0, f"{name}: ended by signal {-ran.returncode}: {lines[-1:]}")
        require(not bad, f"{name}: {bad[:1]}")
        left = [path.name for path in (place / "out").iterdir()] if (place / "out").exists() else []
        if ran.returncode == 2:
            require(len(lines) == 1, f"{name}: refused in {len(lines)} lines: {lines}")
            require(not left, f"{name}: refused, and wrote {left}")
            raise Refused(lines[0])
        if ran.returncode == 3:
            why = [line for line in lines if line.startswith("the computation failed, nothing was written: ")]
            require(
                len(why) == 1 and why[0] == lines[-1] and len(why[0]) > 60,
                f"{name}: no result, and says {lines[-3:]}",
            )
            require(
                not {"te.csv", "results.h5", "summary.txt"} & set(left),
                f"{name}: no result, and wrote {left}",
            )
            raise Refused(why[0])
        require(
            ran.returncode == 0 and "certificate: holds for all" in ran.stdout,
            f"{name}: exit code {ran.returncode}, {lines[-2:]}",
        )
        return Result(place / "out", case)


# -------------------------------------------------------------------------------------------- of every result


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


# -------------------------------------------------------------------------------------------- between results


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


def rounding(te):
    """The same numbers in another order of operations: 1e-6 um, as the seam of a mesh cycle;
    in proportion above a micrometre's scale of 1 mm.
    """
    return 1e-6 * max(1, abs(te) / 100)


def flanks(case):
    """The tables that hold modifications."""
    for name in GEARS:
        for table in [case[name]] + [
            case[name][side] for side in ("left_flank", "right_flank") if side in case[name]
        ]:
            yield table


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


def finer_cells(case):
    """Three times as many cells across the profile: what too few of them make must be gone."""
    finer = copy.deepcopy(case)
    finer["contact_grid"]["profile_cells"] = 3 * case["contact_grid"]["profile_cells"]
    return finer


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


def applicable(case, g):
    """Properties that a case can show."""
    single = any("index_errors_um" in table or "runout" in table for table in flanks(case))
    whole = [mirror, alone, virtual_work, lengths, moduli, stand_back, positions, spelling]
    # z is counted from the driving gear's middle: with an offset, phase 0 of a helical pair and the point it
    # tilts about move with it.
    if not single and not (case["pair"].get("axial_offset_mm") and (g.helix > 0 or "misalignment" in case)):
        whole.append(exchange)
    if case["hunting"]:
        whole = [hunting]
    return whole
