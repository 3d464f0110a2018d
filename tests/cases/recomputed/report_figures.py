#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""The numbers of a report's figures against the result files that they are drawn from: of a run, a study
and a drive. The figures' tables give nine digits.

Usage: report_figures.py FLANK RUN STUDY DRIVE    (result folders with a report)
"""
import math, pathlib, re, sys

sys.dont_write_bytecode = True
import checks
import h5py, numpy
from checks import Table, check, harmonics, near
from gear_geometry import Pair
from study import cubic

digits = 2e-8  # relative: half a unit of the ninth digit, of both


def figure(folder, name):
    return Table(folder / "figures" / f"{name}.csv")


def shows(drawn, columns, source, what):
    """Every row that is drawn stands in the source: `columns` of the figure by those of the source,
    the first ones name the row.
    """
    *keys, (shown, stored) = columns
    key = lambda table, names: [tuple(round(float(row[name]), 6) for name in names) for row in table.rows]
    known = dict(zip(key(source, [there for _, there in keys]), source[stored]))
    rows = key(drawn, [here for here, _ in keys])
    check(len(rows) > 0 and all(row in known for row in rows), f"{what}: rows that are not in the results")
    near(drawn[shown], [known.get(row, math.nan) for row in rows], what, relative=digits)


def harris_chart(folder, name, te, what):
    chart = figure(folder, name)
    check(len(chart.rows) >= 2 * len(te.rows), f"{what}: every torque and position, over two cycles")
    for number, torque in enumerate(sorted(set(chart["torque_Nm"]))):
        mine, own = chart["torque_Nm"] == torque, te["torque_Nm"] == torque
        values = dict(zip(numpy.round(te["phase"][own], 6), te["te_um"][own]))
        mean = numpy.mean(list(values.values()))
        near(
            chart["te_um"][mine],
            [values[round(phase % 1, 6)] for phase in chart["phase"][mine]],
            f"{what}, {torque} N m",
            relative=digits,
        )
        near(
            chart["mean_te_um"][mine],
            numpy.full(mine.sum(), mean),
            f"{what}, mean at {torque} N m",
            relative=digits,
        )
        height = chart["drawn_at_um"][mine] - (chart["te_um"][mine] - mean)
        check(
            numpy.ptp(height) < 1e-6 and (number == 0) == (abs(height[0]) < 1e-6),
            f"{what}: curve of {torque} N m about its line",
        )


def amplitudes_over_torque(folder, te, slopes, what):
    """The cubic between neighbouring torques through values and slopes at every position;
    first and second harmonic, peak-to-peak.
    """
    table = figure(folder, "amplitudes_over_torque")
    torques = numpy.array(sorted(set(te["torque_Nm"][te["torque_Nm"] > 0])))
    values = numpy.array([te["te_um"][te["torque_Nm"] == torque] for torque in torques])
    slope = numpy.array([slopes[te["torque_Nm"] == torque] for torque in torques])
    for row in table.rows[:: max(1, len(table.rows) // 40)]:
        x = cubic(torques, values, slope, float(row["torque_Nm"]))
        (first, _), (second, _) = harmonics(x)[:2]
        # A torque is printed with nine digits.
        near(
            [float(row[name]) for name in ("A1_um", "A2_um", "peak_to_peak_um")],
            [first, second, numpy.ptp(x)],
            f"{what} at {row['torque_Nm']} N m",
            absolute=1e-6,
        )
    check(sorted(table["torque_Nm"][table["computed"] == 1]) == list(torques), f"{what}: computed torques")
    stored = Table(folder / "amplitudes_over_torque.csv")
    for column in ("A1_bound_um", "A2_bound_um", "peak_to_peak_bound_um"):
        shows(table, [("torque_Nm", "torque_Nm"), (column, column)], stored, f"{what}: {column}")


def stated_errors(folder):
    """The page's table of bounds: what error_estimate.csv has of every torque, to four digits."""
    page = (folder / "report.html").read_text().split("<h3>Error estimate</h3>")[1].split("</table>")[0]
    head, *found = [re.findall(r"<t[hd][^>]*>(.*?)</t[hd]>", row) for row in page.split("<tr>")[1:]]
    columns = (
        "torque_Nm mean_te_um peak_to_peak_te_um A1_um A2_um A3_um max_pressure_percent "
        "regular_pressure_MPa regular_pressure_percent load_share root_stress_pinion_percent "
        "root_stress_gear_percent"
    ).split()
    kinds = {"kink": "at a kink", "edge": "more at edges"}
    stored = Table(folder / "error_estimate.csv").rows
    check(len(head) == len(columns) and len(found) == len(stored) > 1, f"bounds on the page: {head}")
    for row, cells in zip(stored, found):
        for column, title, cell in zip(columns, head, cells):
            expected = f"{float(row[column]):.4g}"
            if expected == "nan":
                expected = "not estimated"
                if column == "max_pressure_percent":
                    expected = kinds[row["pressure_kind"]]
            check(cell == expected, f"bounds on the page, {title}: {cell}, {column} is {row[column]}")


def run(folder):
    """Every figure of a run of a gear pair."""
    case = Pair(folder / "case.toml")
    te, pairs, lines = Table(folder / "te.csv"), Table(folder / "pairs.csv"), Table(folder / "lines.csv")
    check(case.gear.base > 1.05 * case.pinion.base, "an unequal pair")
    spectrum = Table(folder / "harmonics.csv")
    by_harmonic = [(name, name) for name in ("torque_Nm", "harmonic")]
    for column in ("amplitude_um", "aliased"):
        shows(
            figure(folder, "harmonics"), [*by_harmonic, (column, column)], spectrum, f"harmonics: {column}"
        )
    harris_chart(folder, "harris_chart", te, "Harris chart")
    amplitudes_over_torque(
        folder, te, 1e3 / (case.pinion.base * te["mesh_stiffness_N_per_um"]), "amplitudes over torque"
    )
    stated_errors(folder)
    stiffnesses(folder, te)
    load_share(folder, pairs)
    keys = [(name, name) for name in ("torque_Nm", "phase", "pair", "z_mm")]
    for column in ("pinion_roll_angle_deg", "load_per_length_N_per_mm"):
        shows(figure(folder, "contact_lines"), [*keys, (column, column)], lines, f"contact lines: {column}")
    contact_pattern(folder, case)
    modifications(folder)
    root_stress(folder)
    subsurface(folder)


def stiffnesses(folder, te):
    """The tangent and the secant stiffness at every torque and phase, over more than one cycle."""
    stiffness = figure(folder, "stiffness")
    for kind, column in (("tangent", "mesh_stiffness_N_per_um"), ("secant", "secant_stiffness_N_per_um")):
        mine = numpy.array(stiffness.text("kind")) == kind
        known = {(t, round(p, 6)): value for t, p, value in zip(te["torque_Nm"], te["phase"], te[column])}
        keys = zip(stiffness["torque_Nm"][mine], stiffness["phase"][mine])
        near(
            stiffness["stiffness_N_per_um"][mine],
            [known[t, round(p % 1, 6)] for t, p in keys],
            f"stiffness: {kind}",
            relative=digits,
        )


def load_share(folder, pairs):
    """Every share of every tooth pair once, at its place on the pair's way through the mesh."""
    share, passage = figure(folder, "load_share"), pairs["phase"] + pairs["pair"]
    for at in sorted(set(share["torque_Nm"])):
        mine, own = share["torque_Nm"] == at, pairs["torque_Nm"] == at
        for name, drawn, stored in (
            ("place", share["mesh_position_of_pair"][mine], passage[own]),
            ("value", share["load_share"][mine], pairs["load_share"][own]),
        ):
            near(
                numpy.sort(drawn),
                numpy.sort(stored),
                f"load share: {name} at {at} N m",
                relative=digits,
                absolute=1e-9,
            )
        by_place = dict(zip(numpy.round(passage[own], 6), pairs["load_share"][own]))
        near(
            share["load_share"][mine],
            [by_place[round(p, 6)] for p in share["mesh_position_of_pair"][mine]],
            f"load share at {at} N m",
            relative=digits,
        )


def contact_pattern(folder, case):
    """The pattern on the pinion as it is stored; on the gear the same pressures at the mate's roll angles."""
    pattern, drawn = Table(folder / "pattern.csv"), figure(folder, "contact_pattern")
    roll_of = next(name for name in pattern.names if name.endswith("roll_angle_deg"))
    for flank in ("pinion", "gear"):
        for at in sorted(set(drawn["torque_Nm"])):
            mine = (numpy.array(drawn.text("flank")) == flank) & (drawn["torque_Nm"] == at)
            own = pattern["torque_Nm"] == at
            roll = pattern[roll_of][own]
            expected = (
                roll
                if flank == "pinion"
                else numpy.degrees((case.action - case.pinion.base * numpy.radians(roll)) / case.gear.base)
            )
            near(
                drawn["roll_angle_deg"][mine],
                expected,
                f"contact pattern of the {flank}: roll angle",
                absolute=1e-6,
            )
            near(
                drawn["pressure_MPa"][mine],
                pattern["pressure_MPa"][own],
                f"contact pattern of the {flank}: pressure",
                relative=digits,
            )


def modifications(folder):
    """What is removed from every flank that is drawn, row by row."""
    removed, shown = Table(folder / "modifications.csv"), figure(folder, "modifications")
    for flank in set(shown.text("flank")):
        mine, own = (numpy.array(table.text("flank")) == flank for table in (shown, removed))
        for column in ("roll_angle_deg", "z_mm", "removed_um"):
            near(
                shown[column][mine],
                removed[column][own],
                f"modifications of the {flank}: {column}",
                relative=digits,
            )


def root_stress(folder):
    """Over a tooth's way through the mesh the greatest along the face;
    along the face when that is greatest.
    """
    drawn, table = figure(folder, "root_stress"), Table(folder / "root_stress.csv")
    greatest_torque = table["torque_Nm"].max()
    for body in ("pinion", "gear"):
        for fillet in ("loaded", "other"):
            of = lambda t: (numpy.array(t.text("body")) == body) & (numpy.array(t.text("fillet")) == fillet)
            own = of(table) & (table["torque_Nm"] == greatest_torque)
            passage = numpy.round(table["phase"] + table["pair"], 6)
            whole = {at: table["tensile_stress_MPa"][own & (passage == at)].max() for at in set(passage[own])}
            is_whole = numpy.array([z == "all" for z in drawn.text("z_mm")])
            here = of(drawn) & is_whole
            what = f"root stress, {body}, {fillet}"
            check(here.sum() == len(whole), f"{what}: {here.sum()} places")
            near(
                drawn["tensile_stress_MPa"][here],
                [whole.get(round(at, 6), math.nan) for at in drawn["phase_plus_pair"][here]],
                what,
                relative=digits,
            )
            here = of(drawn) & ~is_whole
            worst = max(whole, key=whole.get)
            check(
                set(numpy.round(drawn["phase_plus_pair"][here], 6)) == {worst}, f"{what}: when it is greatest"
            )
            along = own & (passage == worst)
            order = numpy.argsort(table["z_mm"][along])
            near(
                drawn["tensile_stress_MPa"][here],
                table["tensile_stress_MPa"][along][order],
                f"{what}, along the face",
                relative=digits,
            )


def subsurface(folder):
    """Every number below the surface at every torque and position that has them."""
    drawn, table = figure(folder, "subsurface_over_phase"), Table(folder / "subsurface.csv")
    check(len(drawn.rows) == len(table.rows), f"stress below the surface: {len(drawn.rows)} rows")
    for column in ("shear_MPa", "shear_depth_um", "von_mises_MPa", "von_mises_depth_um"):
        keys = [(name, name) for name in ("torque_Nm", "phase")]
        shows(drawn, [*keys, (column, column)], table, f"below the surface: {column}")
    check(all(drawn["von_mises_MPa"] > drawn["shear_MPa"]), "below the surface: von Mises above shear")


def study(folder):
    """Every figure of a study of one axis; root stress and stress below the surface are of variant 0."""
    root_stress(folder)
    subsurface(folder)
    designs = Table(folder / "designs.csv")
    drawn_variants = 0
    for path in sorted((folder / "figures").glob("harris_chart_variant_*.csv")):
        variant = int(path.stem.split("_")[-1])
        own = Table(folder / "te.csv")
        own.rows = [row for row in own.rows if int(row["variant"]) == variant]
        harris_chart(folder, path.stem, own, f"Harris chart of variant {variant}")
        drawn_variants += 1
    check(drawn_variants > 1, "Harris charts of a study")
    keys = [(name, name) for name in ("variant", "torque_Nm")]
    for name, columns in (
        ("amplitudes", ("A1_um", "A2_um", "peak_to_peak_um")),
        ("loads", ("mean_mesh_stiffness_N_per_um", "max_pressure_MPa", "edge_pressure_MPa")),
    ):
        for column in columns:
            shows(
                figure(folder, f"axis_1_{name}"),
                [*keys, (column, column)],
                designs,
                f"study, {name}: {column}",
            )
    # The map names a point by its label, which the amplitudes' table has beside the variant.
    amplitudes, map_ = figure(folder, "axis_1_amplitudes"), figure(folder, "axis_1_map")
    label = map_.names[0]
    variant_of = dict(zip(amplitudes.text(label), amplitudes["variant"]))
    for row in map_.rows:
        design = next(
            r
            for r in designs.rows
            if float(r["variant"]) == variant_of[row[label]]
            and float(r["torque_Nm"]) == float(row["torque_Nm"])
        )
        for column in ("A1_um", "A2_um"):
            near(
                float(row[column]),
                float(design[column]),
                f"study's map: {column} of {row[label]} at {row['torque_Nm']} N m",
                relative=digits,
            )
    found = figure(folder, "axis_1_design_torques")
    for by in ("A1", "peak_to_peak"):
        drawn = sorted(
            (variant_of[row[label]], float(row["T_d_Nm"])) for row in found.rows if row["by"] == by
        )
        stored = sorted(
            {
                (float(r["variant"]), float(word))
                for r in designs.rows
                for word in r[f"T_d_by_{by}_Nm"].split(";")
                if word
            }
        )
        check(drawn == stored, f"study's design torques by {by}: {drawn} drawn, {stored} in designs.csv")


def drive(folder):
    """Every figure of a run of a drive."""
    te, pairs = Table(folder / "te.csv"), Table(folder / "pairs.csv")
    check(all(pairs["roller"] != pairs["sleeve"]), "drive: other numbers of rollers than of sleeves")
    keys = [(name, name) for name in ("torque_Nm", "crank_angle_deg")]
    for name, column in (
        ("contacts", "contacts"),
        ("gear_ratio", "gear_ratio"),
        ("transmission_error", "te_arcsec"),
    ):
        shows(figure(folder, name), [*keys, (column, column)], te, f"drive: {name}")
    spectrum = Table(folder / "harmonics.csv")
    shows(
        figure(folder, "harmonics"),
        [keys[0], ("harmonic", "harmonic"), ("amplitude_um", "amplitude_um")],
        spectrum,
        "drive: harmonics",
    )
    for name, column in (
        ("edge_pressure", "edge_pressure_MPa"),
        ("force", "normal_force_N"),
        ("mid_pressure", "mid_pressure_MPa"),
    ):
        places = [*keys, ("sleeve", "sleeve"), ("roller", "roller")]
        shows(
            figure(folder, f"pair_{name}"), [*places, (column, column)], pairs, f"drive: {name} of every pair"
        )
    stiffness = figure(folder, "stiffness")
    for kind, column in (
        ("tangent", "torsional_stiffness_Nm_per_arcmin"),
        ("secant", "torsional_stiffness_secant_Nm_per_arcmin"),
    ):
        part = figure(folder, "stiffness")
        part.rows = [row for row in stiffness.rows if row["kind"] == kind]
        shows(part, [*keys, ("stiffness_Nm_per_arcmin", column)], te, f"drive: {kind} stiffness")
    h5, along = h5py.File(folder / "results.h5"), figure(folder, "pressure_along_rollers")
    places = {}
    for name, position in h5["pressure_maps"].items():
        t, k = (int(name.split("_")[i]) for i in (1, 3))
        angle = float(h5["crank_angle"][k])
        for pair, columns in position.items():
            roller, sleeve = (int(pair.split("_")[i]) for i in (1, 3))
            for y in set(columns["y"][:]):
                key = (float(h5["torque"][t]), round(angle, 6), roller, sleeve, round(y, 5))
                places[key] = columns["pressure"][:][columns["y"][:] == y].max()
    drawn = [
        tuple(round(float(row[name]), 6) for name in ("torque_Nm", "crank_angle_deg", "roller", "sleeve"))
        for row in along.rows
    ]
    drawn = [(*key, round(y, 5)) for key, y in zip(drawn, along["distance_from_mid_roller_mm"])]
    near(
        along["greatest_pressure_MPa"],
        [places.get(key, math.nan) for key in drawn],
        "drive: pressure along the rollers",
        relative=digits,
    )


run(pathlib.Path(sys.argv[2]))
study(pathlib.Path(sys.argv[3]))
drive(pathlib.Path(sys.argv[4]))
for failure in checks.failures:
    print("FAILED:", failure)
print(f"{checks.checks} checks, {len(checks.failures)} failed")
sys.exit(bool(checks.failures))
