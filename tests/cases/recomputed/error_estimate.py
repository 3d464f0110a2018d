#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""error_estimate.csv recomputed from runs with the coarser grid and mesh given as keys.

Usage: error_estimate.py ESTIMATE GRID BODIES    (result folders: N positions; the coarser grid at 2 N; the
coarser grid and mesh at N)
"""
import pathlib, re, sys

sys.dont_write_bytecode = True
import checks
import numpy
from checks import Table, check, near

folder, on_grid, on_bodies = (pathlib.Path(argument) for argument in sys.argv[1:4])


class Run:
    """Of one torque."""

    def __init__(self, path):
        self.table, pairs = Table(path / "te.csv"), Table(path / "pairs.csv")
        self.te, self.pressure = self.table["te_um"], self.table["max_pressure_MPa"]
        self.shares = [
            {
                int(pair): share
                for k, pair, share in zip(pairs["position"], pairs["pair"], pairs["load_share"])
                if k == position
            }
            for position in range(len(self.te))
        ]


def apart(one, other):
    return max(abs(one.get(pair, 0) - other.get(pair, 0)) for pair in {*one, *other})


fine, grid, bodies = Run(folder), Run(on_grid), Run(on_bodies)
te, n = fine.te, len(fine.te)
check(len(grid.te) == 2 * n and len(bodies.te) == n, "positions of the runs to compare with")
sampled = numpy.round(numpy.arange(max(3, n // 5)) * n / max(3, n // 5)).astype(int)
by_grid = grid.te[2 * sampled] - te[sampled]
by_bodies = bodies.te[sampled] - grid.te[2 * sampled]
deviation = by_grid.std(ddof=1) + by_bodies.std(ddof=1)



def root_stresses(path, body):
    """The greatest of a tooth in both fillets, by position and pair."""
    found = {}
    for row in Table(path / "root_stress.csv").rows:
        if row["body"] == body:
            at = (int(row["position"]), int(row["pair"]))
            found[at] = max(found.get(at, 0), float(row["tensile_stress_MPa"]))
    return found


def greatest_by_position(of_teeth):
    positions = sorted({k for k, _ in of_teeth})
    return numpy.array([max(v for (k, _), v in of_teeth.items() if k == position) for position in positions])


roots, roots_on_grid = (
    [root_stresses(path, body) for body in ("pinion", "gear")] for path in (folder, on_grid)
)

# What half as many positions would fold into a harmonic: twice the modulus, once at the highest.
spectrum = 2 * numpy.abs(numpy.fft.rfft(te)) / n
spectrum[-1] /= 2
half = n // 2
# Peaks that may hide: twice what lies halfway beside the extremes, and as far as curves can go that bend one
# way between what is known, below the lines through the neighbours on either side.
regular = fine.table["edge_pressure_MPa"].max() <= fine.pressure.max()


def beside(peaks):
    return [int(2 * k + side) % (2 * n) for k in peaks for side in (-1, 1)]


# By how much steps rise or fall more than those beside them, as far as that is all of the step; the two
# greatest are looked into halfway.
def jump(rise, *beside_it):
    beyond = abs(rise) - max(0, *(numpy.sign(rise) * other for other in beside_it))
    return numpy.sign(rise) * beyond**2 / abs(rise) if beyond > 0 else 0


rises = numpy.diff(te, append=te[:1])
heights = [jump(rises[k], rises[k - 1], rises[(k + 1) % n]) for k in range(n)]
of_jumps = [k for k in numpy.argsort(-numpy.abs(heights))[:2] if abs(heights[k]) > 0.02 * numpy.ptp(te)]
of_peaks = beside([te.argmax(), te.argmin()])
of_te = of_peaks + [2 * int(k) + 1 for k in of_jumps]
known = {**dict(zip(range(0, 2 * n, 2), te)), **{k: grid.te[k] - by_grid.mean() for k in of_te}}
seen = numpy.array([known[k] for k in sorted(known)])
of_seen = 2 * (numpy.ptp(seen) - numpy.ptp(te))


def reach_inside(places, values, times=2):
    """Greatest value under both lines, looked for at many places of every interval but the outer two. A turn
    more than so many times as steep as before may be a jump.
    """
    greatest = max(values[1:-1])
    for i in range(1, len(places) - 2):
        where = numpy.linspace(places[i], places[i + 1], 100001)
        lines = [
            values[a] + (values[b] - values[a]) / (places[b] - places[a]) * (where - places[a])
            for a, b in ((i - 1, i), (i + 1, i + 2))
        ]
        greatest = max(greatest, numpy.minimum(*lines).max())
        here, there = values[i], values[i + 1]
        onward, back = lines[0][-1] - here, lines[1][0] - there  # along the lines, over the interval
        for line, top, other in ((onward, here, there), (back, there, here)):
            if top - other > times * line > 0:  # a jump
                greatest = max(greatest, top + 0.8 * line)
    return greatest


def reach(points, sign=1, times=2):
    """The same over the period."""
    places = numpy.array(sorted(points))
    values = sign * numpy.array([points[k] for k in places])
    unrolled = numpy.concatenate([places[-1:] - 2 * n, places, places[:2] + 2 * n])
    return reach_inside(unrolled, numpy.concatenate([values[-1:], values, values[:2]]), times)


of_curve = reach(known) + reach(known, -1) - numpy.ptp(te)


def steps_of_pressure():
    """The two steps in which the greatest pressure may hide, by the values at and beside their ends."""
    around = [fine.pressure[(k + numpy.arange(-1, 3)) % n] for k in range(n)]
    reaches = numpy.array([reach_inside([-1, 0, 1, 2], values, 0.9) for values in around])
    greatest = numpy.argsort(-reaches, kind="stable")[:2]
    return [2 * int(k) + 1 for k in greatest if reaches[k] > (1 + 2e-4) * fine.pressure.max()]


of_contact = of_te + (steps_of_pressure() if regular else [])
inside = max(fine.pressure.max(), grid.pressure[of_contact].max())
regular = regular and grid.table["edge_pressure_MPa"][of_contact].max() <= inside
hidden = max(of_seen, of_curve)
check(abs(of_seen - of_curve) > 0.01 * hidden > 0, f"what tells of hidden peaks: {of_seen}, {of_curve}")


halved = {}  # step: what is halfway beyond a smooth curve, the jumps of both halves
for k in of_jumps:
    middle, (before, low, high, after) = known[2 * k + 1], te[(k + numpy.arange(-1, 3)) % n]
    up, on = middle - low, high - middle
    both = jump(up, (low - before) / 2, on), jump(on, up, (after - high) / 2)
    halved[int(k)] = middle - (9 * (low + high) - before - after) / 16, both
def moved(harmonic):
    """By how much a harmonic changes when what is halfway in steps with jumps counts."""
    complex_ = 2 * numpy.fft.rfft(te)[harmonic] / n
    more = sum(
        beyond / n * numpy.exp(-2j * numpy.pi * harmonic * (k + 0.5) / n) for k, (beyond, _) in halved.items()
    )
    return abs(abs(complex_ + more) - abs(complex_))


if any((k + 1) % n in halved for k in halved):  # a contact that one position has seen: how high is not known
    halved = {}
knows_jumps = len(halved) == len(of_jumps)
print(f"jumps looked into: {len(halved)} of {len(of_jumps)}, A1 moves by {moved(1)}")


def folded(harmonic):
    """What folds into a mesh harmonic (0: the mean): the upper half of the spectrum, as it falls on."""
    orders = numpy.arange(max(harmonic + 1, half // 2), half + 1)
    fallen = (orders / (n - harmonic)) ** 1.5 * numpy.array([spectrum[i] for i in orders])
    shares = (0.45, 0.2, 0.3, 0.4) if knows_jumps else (0.45, 0.45, 0.4, 0.55)
    return shares[harmonic] * numpy.linalg.norm(fallen)


# What stands out halfway beyond both neighbours, from cubic curves through the next four positions, as wide
# as 0.6 steps.
smooth = {k: numpy.dot([-1, 9, 9, -1], te[(k // 2 + numpy.arange(-1, 3)) % n]) / 16 for k in of_te}
neighbours = {k: (te[k // 2], te[(k // 2 + 1) % n]) for k in of_te}
outside = [k for k in set(of_te) if not min(neighbours[k]) <= known[k] <= max(neighbours[k])]
between = sum(abs(known[k] - smooth[k]) for k in outside) * 0.6 / n
# What jumps leave open: 0.6 of what half a step of place makes of a harmonic; a step that is known halfway
# has two half as wide.
def open_by_jumps(halved):
    open_ = []
    for k in range(n):
        open_ += [height / 2 for height in halved[k][1]] if k in halved else [heights[k]]
    both_ends = [max(0, -x * y) for x, y in zip(heights, [*heights[1:], heights[0]])]  # of one position
    return 0.6 * numpy.sqrt(numpy.square(open_).sum() + 2 * sum(both_ends)) / n


parts = {
    "mean_te_by_grid_um": 0.45 * abs(by_grid.mean()) + 0.3 * by_grid.std(ddof=1),
    "mean_te_by_bodies_um": 0.45 * abs(by_bodies.mean()) + 0.3 * by_bodies.std(ddof=1),
    "mean_te_by_positions_um": max(folded(0), 0.7 * open_by_jumps({}), between),
}
# Of the scatter of differences, which are smooth; of the mean.
shares = ((1, 0.15, 1.35e-4), (2, 0.05, 0), (3, 0.03, 0))
over_coarser = fine.pressure[sampled].sum() / grid.pressure[2 * sampled].sum()
of_halves = [fine.pressure[::2].max(), fine.pressure[1::2].max()]
hidden_pressure = 2 * max(0, over_coarser * grid.pressure[of_contact].max() / fine.pressure.max() - 1)


def beyond_greatest(values, halfway):
    """How far beside the greatest value curves reach that bend one way between what is known, relative."""
    most = values.argmax()
    around = {k: values[(most + k // 2) % n] for k in (-4, -2, 0, 2, 4)}
    around.update({k: halfway[(2 * most + k) % (2 * n)] for k in (-1, 1)})
    return reach_inside(sorted(around), [around[k] for k in sorted(around)]) / values.max() - 1


if regular:
    seen_of_pressure = {k: over_coarser * grid.pressure[k] for k in of_contact}
    seen_of_pressure.update(zip(range(0, 2 * n, 2), fine.pressure))
    seen_here, reached = max(seen_of_pressure.values()), reach(seen_of_pressure, times=0.9)
    hidden_pressure = (seen_here + 0.9 * (reached - seen_here)) / fine.pressure.max() - 1
else:  # nothing was computed beside it
    hidden_pressure = max(hidden_pressure, 0.375 * (1 - min(of_halves) / max(of_halves)))
noise = 1e-4 * numpy.ptp(te) + 1e-5 * te.mean()
of_coarser = 0.45 * (
    numpy.abs(grid.pressure[2 * sampled] / fine.pressure[sampled] - 1).max()
    + numpy.abs(bodies.pressure[sampled] / grid.pressure[2 * sampled] - 1).max()
)
# What 11 cells may leave: 0.1 % of Hertz's line contacts, 1.6 % where there are none; how surely the most
# pressed one is such a contact, tables do not say (that is gear_cells.py's).
stated = float(Table(folder / "error_estimate.csv").rows[0]["regular_pressure_percent"]) / 100
of_cells = stated - 2e-4 - hidden_pressure if regular else 0.02
by_coarser = abs(of_cells - of_coarser) < 1e-6
within = max(of_coarser, 0.001) < of_cells < (0.016 if regular else 0.021)
check(by_coarser or within, f"what cells may leave: {of_cells}")
expected = {
    **parts,
    "mean_te_um": sum(parts.values()) + 2e-4 * te.mean(),
    "mean_te_shift_um": -(by_grid.mean() + by_bodies.mean()) / 2,
    "te_rms_um": deviation,
    "peak_to_peak_te_um": 0.85 * hidden + deviation + noise,
    **{
        f"A{i}_um": max(folded(i), open_by_jumps(halved), 2 * between)
        + moved(i)
        + share * deviation
        + of_mean * te.mean()
        + noise
        for i, share, of_mean in shares
    },
    "max_pressure_percent": 0.02 + 100 * (max(of_coarser, of_cells) + hidden_pressure),
    "load_share": max(apart(grid.shares[2 * k], fine.shares[k]) for k in sampled)
    + max(apart(bodies.shares[k], grid.shares[2 * k]) for k in sampled),
}
# A pair's steps at and beside its first and last share; a pitch on it is the next pair.
of_coarser_shares = expected["load_share"]
passage = {
    k + n * pair: share for k, shares in enumerate(fine.shares) for pair, share in shares.items() if share
}
steps = [0]
for k, share in passage.items():
    for side in (-1, 1):
        if k + side not in passage:
            steps += [share, abs(passage.get(k - side, 0) - share)]
check(max(steps) > 0.01, f"a pair begins or ends: {max(steps)}")
relative = (parts["mean_te_by_grid_um"] + parts["mean_te_by_bodies_um"]) / numpy.sqrt((te**2).mean())
expected["load_share"] = 1e-4 + 0.5 * of_coarser_shares + 1.6 * relative * max(steps)
(row,) = Table(folder / "error_estimate.csv").rows
of_harmonics = Table(folder / "harmonics.csv").rows
check(len(of_harmonics) > 3, "harmonics without a bound")
for harmonic in of_harmonics:
    name = f"A{harmonic['harmonic']}_um"
    check(harmonic["bound_um"] == row.get(name, "nan"), f"harmonics.csv: bound of {name}")
# What other tables have of it: the mean's parts without the positions', and 1.2 deviations of a position's.
of_position = expected["mean_te_um"] - parts["mean_te_by_positions_um"] + 1.2 * deviation + noise
near(fine.table["te_bound_um"], numpy.full(n, of_position), "te.csv: bound", absolute=2e-6)
of_shares = {pair["load_share_bound"] for pair in Table(folder / "pairs.csv").rows}
check(of_shares == {row["load_share"]}, f"pairs.csv: bound {of_shares}")
of_pressures = fine.table["max_pressure_bound_MPa"]
if regular:  # of the greatest: without what hides between positions; elsewhere no less than by coarser ones
    most = fine.pressure.argmax()
    without_hidden = (float(row["max_pressure_percent"]) / 100 - hidden_pressure) * fine.pressure.max()
    near(of_pressures[most], without_hidden, "te.csv: bound of the greatest pressure", absolute=1e-3)
    least = (2e-4 + of_coarser) * fine.pressure.max()
    there = ~numpy.isnan(of_pressures)
    check((of_pressures[there] > least - 1e-3).all(), f"te.csv: bounds of pressures {of_pressures}")
for body in ("pinion", "gear"):
    mine = [r for r in Table(folder / "root_stress.csv").rows if r["body"] == body]
    most = max(mine, key=lambda r: float(r["tensile_stress_MPa"]))
    of_most = float(row[f"root_stress_{body}_percent"]) / 100 * float(most["tensile_stress_MPa"])
    found = float(most["tensile_stress_bound_MPa"])
    near(found, of_most, f"root_stress.csv: bound of the {body}", absolute=1e-3)
    stated = [r for r in mine if r["tensile_stress_bound_MPa"] != "nan"]
    check(len(stated) == 1, f"root_stress.csv: {len(stated)} bounds of the {body}")
of_regular = {name: float(row[f"regular_pressure_{name}"]) for name in ("MPa", "percent")}
if regular:  # it is the greatest pressure itself
    near(of_regular["MPa"], fine.pressure.max(), "regular pressure", absolute=1.1e-4)
    near(of_regular["percent"], expected["max_pressure_percent"], "its bound", absolute=1e-4)
else:
    expected["max_pressure_percent"] = numpy.nan
    check(0 < of_regular["MPa"] <= fine.pressure.max() + 1e-4, f"regular pressure: {of_regular}")
    check(0 < of_regular["percent"] < 100, f"its bound: {of_regular}")


# Root stress: of the tooth for which it is greatest on coarser bodies, and what hides between positions: as
# much again as halfway is seen, or 0.45 of what curves reach; halfway by the coarser grid, over what that
# finds of the greatest. The run on coarser bodies finds forces of its own, which differ by as much as the
# load shares do.
for body, of_teeth, of_teeth_on_grid in zip(("pinion", "gear"), roots, roots_on_grid):
    most = max(of_teeth, key=of_teeth.get)
    stresses, halfway = greatest_by_position(of_teeth), greatest_by_position(of_teeth_on_grid)
    halfway *= stresses.max() / halfway[2 * most[0]]
    seen = halfway[beside([most[0]])].max()
    between = max(0, 2 * (seen / stresses.max() - 1), 0.45 * beyond_greatest(stresses, halfway))
    name = f"root_stress_{body}_percent"
    apart_by = abs(root_stresses(on_bodies, body)[most] / of_teeth[most] - 1)
    check(apart_by > 0.01, f"root stress of the {body} on coarser bodies: a difference to tell, {apart_by}")
    if float(row["torque_Nm"]) == 100:  # at 200 N m less hides
        check(between > 4 * of_coarser_shares, f"root stress of the {body} between positions: {between}")
    near(float(row[name]), 100 * (apart_by + between), name, absolute=100 * of_coarser_shares)
words = (row["variant"], row["level"], row["compared_with"])
check(words == ("0", "draft", "coarser"), f"variant, level and what it is compared with: {words}")
names = {"variant", "torque_Nm", "level", "compared_with", "pressure_kind", *expected}
names |= {"root_stress_pinion_percent", "root_stress_gear_percent"}
names |= {"regular_pressure_MPa", "regular_pressure_percent"}
check(set(row) == names, f"columns {sorted(row)}")
check(row["pressure_kind"] == ("regular" if regular else "edge"), f"kind of pressure: {row['pressure_kind']}")
check(expected["mean_te_by_bodies_um"] > expected["mean_te_by_grid_um"] > 0, "differences to tell")
# The screen's table: values and their bounds, the pressure's in MPa though the table has percent.
told = (folder / "summary.txt").read_text().split("results with their errors")[1]
told = re.search(rf"^ +{float(row['torque_Nm']):.3f} +(.*)$", told, re.M)
shown = [float(number) for number in re.findall(r"\+- ([0-9.]+)", told[1])]
bounds = [float(row[name]) for name in ("mean_te_um", "peak_to_peak_te_um", "A1_um", "A2_um", "A3_um")]
if regular:
    bounds.append(float(row["max_pressure_percent"]) / 100 * fine.pressure.max())
bounds.append(float(row["load_share"]))
near(shown, bounds, "bounds on the screen", absolute=0.051)
check(not regular or shown[5] > 0.1, f"a pressure's bound to tell: {shown}")
for name, value in expected.items():
    # A unit of the last digit, and as much of rounded pressures.
    if numpy.isnan(value):
        check(row[name] == "nan", f"{name}: {row[name]}, which cannot be estimated")
        continue
    near(float(row[name]), value, name, absolute=1e-4 if "percent" in name else 1.1e-6)
for failure in checks.failures:
    print("FAILED:", failure)
sys.exit(bool(checks.failures))
