# SPDX-License-Identifier: GPL-2.0-or-later
"""A study of gear pairs: its designs from its own transmission errors, its derivatives from its variants."""
import h5py, numpy
from checks import Table, check, harmonics, near, run, unit


def cubic(torques, values, slopes, torque):
    """Hermite's cubic between two neighbouring torques."""
    i = min(max(numpy.searchsorted(torques, torque, side="right") - 1, 0), len(torques) - 2)
    w = torques[i + 1] - torques[i]
    s = (torque - torques[i]) / w
    return (
        (1 + 2 * s) * (1 - s) ** 2 * values[i]
        + s * (1 - s) ** 2 * w * slopes[i]
        + s * s * (3 - 2 * s) * values[i + 1]
        + s * s * (s - 1) * w * slopes[i + 1]
    )


def minima(torques, quantity):
    """All local minima inside, from a fine sampling: to a thousandth of the range."""
    at = numpy.linspace(torques[0], torques[-1], 2401)
    value = [quantity(torque) for torque in at]
    return [at[i] for i in range(1, len(at) - 1) if value[i] <= value[i - 1] and value[i] < value[i + 1]]


def study(case, folder, base_radius, run_folder=None):
    """designs.csv and te.csv from study.h5's transmission errors and slopes; variant 0 is the run."""
    run("study", case, "-o", folder)
    designs, te, h5 = Table(folder / "designs.csv"), Table(folder / "te.csv"), h5py.File(folder / "study.h5")
    block = h5["block_0"]
    for v, variant in enumerate(block["variant"]):
        mine = [row for row in designs.rows if float(row["variant"]) == variant]
        check_positions(block, te, v, variant, base_radius)
        check_design_torques(block, mine, v)
        for t, torque in enumerate(block["torque"][:]):
            row = next(row for row in mine if abs(float(row["torque_Nm"]) - torque) < 1e-9)
            check_design(block, row, v, t, f"of variant {v} at {torque} N m")
    for name, expected in (
        ("torque", "N m"),
        ("te", "um"),
        ("te_slope", "um/(N m)"),
        ("max_pressure", "MPa"),
        ("edge_pressure", "MPa"),
        ("mesh_stiffness", "N/um"),
    ):
        check(unit(block[name]) == expected, f"study.h5, unit of {name}: {unit(block[name])!r}")
    if "mean_te_bound_um" in designs.rows[0]:
        check_bounds(designs, Table(folder / "error_estimate.csv"))
    if run_folder:
        check_variant_0(te, Table(run_folder / "te.csv"))
    return designs


def check_bounds(designs, estimate):
    """Of variant 0 those of error_estimate.csv, which is its; of others none."""
    for row in designs.rows:
        bounds = [row[f"{name}_bound_um"] for name in ("mean_te", "peak_to_peak", "A1", "A2", "A3")]
        if row["variant"] != "0":
            none = {row["max_pressure_bound_MPa"], row["pressure_kind"]}
            check(set(bounds) | none == {""}, f"bounds of {row}")
            continue
        mine = next(r for r in estimate.rows if r["torque_Nm"] == row["torque_Nm"])
        columns = ("mean_te_um", "peak_to_peak_te_um", "A1_um", "A2_um", "A3_um")
        stated = [mine[column] if mine[column] != "nan" else "" for column in columns]
        check(bounds == stated, f"designs.csv: bounds {bounds}, error_estimate.csv {stated}")
        check(row["pressure_kind"] == mine["pressure_kind"], f"designs.csv: kind {row['pressure_kind']}")
        percent = float(mine["max_pressure_percent"])
        found = float(row["max_pressure_bound_MPa"] or "nan")
        expected = percent / 100 * float(row["max_pressure_MPa"])
        near(*numpy.nan_to_num([found, expected], nan=-1.0), "designs.csv: bound of pressure", absolute=1e-3)


def check_positions(block, te, v, variant, base_radius):
    """What study.h5 has at every torque and position of a variant is in te.csv; its slopes are those of
    the tangent stiffness.
    """
    rows, torques = te["variant"] == variant, block["torque"][:]
    for name, column, absolute in (
        ("te", "te_um", 6e-10),
        ("max_pressure", "max_pressure_MPa", 6e-5),
        ("edge_pressure", "edge_pressure_MPa", 6e-5),
        ("mesh_stiffness", "mesh_stiffness_N_per_um", 6e-7),
    ):
        near(
            block[name][v].ravel(),
            te[column][rows],
            f"study.h5, {name} of variant {v}",
            absolute=absolute,
        )
    loaded = torques > 0
    near(
        block["te_slope"][v][loaded],
        1e3 / (base_radius * block["mesh_stiffness"][v][loaded]),
        f"te_slope of variant {v}",
        relative=1e-9,
    )


def check_design_torques(block, rows, v):
    """Where the first harmonic and the peak-to-peak value over torque are least, from the cubic between the
    torques: where the transmission error grows with the torque everywhere.
    """
    order = numpy.argsort(block["torque"][:])
    torques = block["torque"][:][order]
    values, slopes = block["te"][v][order], block["te_slope"][v][order]
    if not (slopes > 0).all():
        return
    sides = [lambda x: harmonics(x)[0][0], lambda x: x.max() - x.min()]
    for column, quantity in zip(("T_d_by_A1_Nm", "T_d_by_peak_to_peak_Nm"), sides):
        expected = minima(torques, lambda T: quantity(cubic(torques, values, slopes, T)))
        for text in {row[column] for row in rows}:
            found = [float(word) for word in text.split(";") if word]
            if expected or found:
                near(found, expected, f"{column} of variant {v}", absolute=torques.max() / 1000)


def check_design(block, row, v, t, where):
    """A row of designs.csv: means, amplitudes and greatest values over the positions of a torque."""
    x = block["te"][v][t]
    amplitudes = [a for a, _ in harmonics(x)]
    for i in range(len(amplitudes), 5):
        check(row[f"A{i + 1}_um"] == "", f"A{i + 1}, which the positions do not show, {where}")
    for name, expected in [
        ("mean_te_um", x.mean()),
        ("peak_to_peak_um", x.max() - x.min()),
        *((f"A{i + 1}_um", amplitude) for i, amplitude in enumerate(amplitudes[:5])),
    ]:
        near(float(row[name]), expected, f"{name} {where}", absolute=2e-9)
    for name in ("max_pressure", "edge_pressure"):
        near(
            float(row[f"{name}_MPa"]),
            block[name][v][t].max(),
            f"{name}_MPa {where}",
            absolute=6e-5,
        )
    near(
        float(row["mean_mesh_stiffness_N_per_um"]),
        block["mesh_stiffness"][v][t].mean(),
        f"mean stiffness {where}",
        absolute=6e-7,
    )


def check_variant_0(te, single):
    """The variant without a change has the rows of the run."""
    for column in (
        "torque_Nm",
        "position",
        "phase",
        "te_um",
        "contacts",
        "max_pressure_MPa",
        "edge_pressure_MPa",
        "mesh_stiffness_N_per_um",
    ):
        near(te[column][te["variant"] == 0], single[column], f"variant 0 against the run, {column}")


def design_torques_of_run(case, folder):
    """design_torques.csv from the transmission errors and slopes in results.h5."""
    run("run", case, "-o", folder)
    table, h5 = Table(folder / "design_torques.csv"), h5py.File(folder / "results.h5")
    order = numpy.argsort(h5["pinion_torque"][:])
    torques = h5["pinion_torque"][:][order]
    values, slopes = h5["transmission_error"][:][order], h5["transmission_error_slope"][:][order]
    over_torque = Table(folder / "amplitudes_over_torque.csv")
    computed = over_torque["torque_Nm"][over_torque["computed"] == 1]
    near(computed, torques[torques > 0], "amplitudes over torque: the computed torques", relative=1e-8)
    sides = {"A1": lambda x: harmonics(x)[0][0], "peak_to_peak": lambda x: x.max() - x.min()}
    for by, quantity in sides.items():
        at = lambda torque: quantity(cubic(torques, values, slopes, torque))
        mine = numpy.array(table.text("by")) == by
        expected = minima(torques, at)
        check(len(expected) > 0, f"a design torque by {by} to compare")
        near(table["torque_Nm"][mine], expected, f"design torques by {by}", absolute=torques.max() / 1000)
        least = [at(torque) for torque in table["torque_Nm"][mine]]
        near(table["least_um"][mine], least, f"least {by}", absolute=1e-8)
    bounds_over_torque(folder, table, over_torque, (torques, values, slopes))


def bounds_over_torque(folder, design, over_torque, curves):
    """Of design_torques.csv and amplitudes_over_torque.csv: error_estimate.csv at computed torques; between
    them the greater of both sides and a parabola over what curves found without a torque differ by there.
    """
    estimate = Table(folder / "error_estimate.csv")
    at_torque = dict(zip(estimate["torque_Nm"], estimate.rows))
    of = {
        "A1": ("A1_um", lambda x: harmonics(x)[0][0]),
        "A2": ("A2_um", lambda x: harmonics(x)[1][0]),
        "peak_to_peak": ("peak_to_peak_te_um", numpy.ptp),
    }
    for name, (column, measure) in of.items():
        stated = numpy.array([float(at_torque[torque][column]) for torque in curves[0]])
        expected = [bound_over_torque(*curves, stated, measure, T) for T in over_torque["torque_Nm"]]
        # A torque is printed with nine digits, and what is beside a computed one changes with its distance.
        off = over_torque[f"{name}_bound_um"]
        near(off, expected, f"bounds of {name} over torque", absolute=1e-7)
        check(numpy.isfinite(off).all() and (off > 0).all(), f"bounds of {name} over torque: all there are")
    for row in design.rows:
        name = row["by"]
        drawn = over_torque["torque_Nm"], over_torque[f"{name}_bound_um"]
        mine = float(numpy.interp(float(row["torque_Nm"]), *drawn))
        near(float(row["least_bound_um"]), mine, f"bound of the least {name}", relative=0.02)


def bound_over_torque(torques, values, slopes, stated, measure, torque):
    """Between torques[i] and torques[i + 1], or at one of them."""
    here = numpy.flatnonzero(numpy.isclose(torques, torque, rtol=1e-8, atol=0))
    if len(here):
        return stated[here[0]]
    i = numpy.searchsorted(torques, torque) - 1
    missed = []
    for k in (i, i + 1):
        if 0 < k < len(torques) - 1:
            others = numpy.arange(len(torques)) != k
            wrong = cubic(torques[others], values[others], slopes[others], torques[k]) - values[k]
            width = torques[k + 1] - torques[k - 1]
            s = (torques[k] - torques[k - 1]) / width
            missed.append(measure(wrong) / (4 * s * (1 - s)) ** 2 / width)
    width = torques[i + 1] - torques[i]
    s = (torque - torques[i]) / width
    return max(stated[i], stated[i + 1]) + 1.25 * max(missed) * width * 4 * s * (1 - s)


def derivatives(designs, keys, folder):
    """Exact ones against central differences of variants: 0 the base, then two for each key,
    a step more and a step less; study.h5 has them of every position, designs.csv their mean.
    """
    torques = sorted(set(designs["torque_Nm"]))
    block = h5py.File(folder / "study.h5")["block_0"]
    for key, _ in keys:
        means = block[f"te_by_{key}"][:].mean(axis=2).ravel()
        near(means, designs[f"d_mean_te_um/d_{key}"], f"study.h5, derivatives by {key}", absolute=1e-8)
    for number, (key, step) in enumerate(keys):
        for torque in torques[1:]:
            base, more, less = (
                next(r for r in designs.rows if float(r["variant"]) == v and float(r["torque_Nm"]) == torque)
                for v in (0, 2 * number + 1, 2 * number + 2)
            )
            for column, name in (
                ("mean_te_um", "mean_te"),
                ("A1_um", "A1"),
                ("A2_um", "A2"),
                ("peak_to_peak_um", "peak_to_peak"),
            ):
                quotient = (float(more[column]) - float(less[column])) / (2 * step)
                # A window of the grid may be another one on both sides: up to 0.005 um,
                # as between neighbouring torque bands (seen here: 0.003).
                near(
                    float(base[f"d_{name}_um/d_{key}"]),
                    quotient,
                    f"derivative of {name} by {key} at {torque} N m",
                    relative=0.02,
                    absolute=0.005 / (2 * step),
                )
