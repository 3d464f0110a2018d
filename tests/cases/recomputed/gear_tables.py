# SPDX-License-Identifier: GPL-2.0-or-later
"""What a run of a gear pair makes of its positions: maps, the tables on the screen,
stresses below the surface.
"""
import math, re

import h5py, numpy
from checks import Table, check, harmonics, near, run, unit
from gear_geometry import Pair


def check_maps(folder, pair, h5, torques, lines):
    pb, gb = pair.pinion.base, pair.gear.base
    for name in ("pinion", "gear"):
        group, body = h5[f"modifications/{name}"], getattr(pair, name)
        middle = 0.0 if name == "pinion" else pair.offset
        expected = [
            [pair.removed(name, math.radians(roll), z - middle) for z in group["z"]]
            for roll in group["roll_angle"]
        ]
        near(group["value"][:], expected, f"modifications/{name}", absolute=1e-6)
        near(
            [group["roll_angle"][0], group["roll_angle"][-1]],
            numpy.degrees([body.start_roll, body.tip_roll]),
            f"active profile of the {name}",
            absolute=1e-6,
        )
    total, roll = h5["modifications/sum"], numpy.radians(h5["modifications/sum/roll_angle"][:])
    near(
        total["value"][:],
        [
            [
                pair.removed("pinion", r, z)
                + pair.removed("gear", (pair.action - pb * r) / gb, z - pair.offset)
                for z in total["z"]
            ]
            for r in roll
        ],
        "modifications/sum",
        absolute=1e-6,
    )
    removed = Table(folder / "modifications.csv")
    for name in ("pinion", "gear", "sum"):
        near(
            removed["removed_um"][[flank_name == name for flank_name in removed.text("flank")]],
            h5[f"modifications/{name}/value"][:].ravel(),
            f"modifications.csv, {name}",
            absolute=6e-7,
        )
    pattern = Table(folder / "pattern.csv")
    near(
        pattern["gear_roll_angle_deg"],
        mating_roll_deg(pair, pattern["pinion_roll_angle_deg"]),
        "pattern.csv: the gear's roll angle where it meets the pinion's",
        absolute=5e-7 * (1 + pair.pinion.base / pair.gear.base),  # six decimals of both
    )
    for t, torque in enumerate(torques):
        if torque > 0:
            map_ = h5[f"contact_pattern/torque_{t}/value"][:]
            near(
                h5[f"contact_pattern/torque_{t}/gear_roll_angle"][:],
                mating_roll_deg(pair, h5[f"contact_pattern/torque_{t}/roll_angle"][:]),
                f"results.h5 at {torque} N m: the gear's roll angles",
                absolute=1e-9,
            )
            near(
                pattern["pressure_MPa"][pattern["torque_Nm"] == torque],
                map_.ravel(),
                f"pattern.csv at {torque} N m",
                absolute=6e-7,
            )
            check_way_of_the_contact(pair, h5[f"contact_pattern/torque_{t}"], lines, torque)
            light = h5[f"contact_pattern_at_1_percent/torque_{t}/value"][:]
            near(
                pattern["pressure_MPa"][numpy.abs(pattern["torque_Nm"] - torque / 100) < 1e-9],
                light.ravel(),
                f"pattern.csv at 1 % of {torque} N m",
                absolute=6e-7,
            )
            # A hundredth of the load: a tenth of the pressure on a line, 0.215 at a point, a little more
            # where an edge is left.
            check(0.02 < light.max() / map_.max() < 0.3, f"pattern at 1 % of {torque} N m")


def mating_roll_deg(pair, pinion_roll_deg):
    """The gear's roll angle where it meets the pinion's flank, both on the line of action. [deg]"""
    return numpy.degrees((pair.action - pair.pinion.base * numpy.radians(pinion_roll_deg)) / pair.gear.base)


def check_way_of_the_contact(pair, map_, lines, torque):
    """A tooth pair goes on after a mesh cycle as the next one: between two positions the pattern has no
    less than both in between.
    """
    own, z = lines["torque_Nm"] == torque, map_["z"][:]
    along = pair.pinion.base / 2 * numpy.radians(lines["pinion_roll_angle_deg"][own]) ** 2
    passage, pressure = lines["phase"][own] + lines["pair"][own], lines["max_pressure_MPa"][own]
    face = numpy.abs(lines["z_mm"][own][:, None] - z).argmin(axis=1)
    step = numpy.diff(numpy.unique(lines["phase"])).max()
    places, seams = pair.pinion.base / 2 * numpy.radians(map_["roll_angle"][:]) ** 2, 0
    for s in range(len(z)):
        # Of the parts of a divided slice the one that presses most.
        order = numpy.flatnonzero(face == s)
        order = order[numpy.lexsort((-pressure[order], passage[order]))]
        order = order[numpy.unique(passage[order], return_index=True)[1]]
        for a, b in zip(order, order[1:]):
            if (
                passage[b] - passage[a] < 1.01 * step and along[b] > along[a]
            ):  # at the gear's tip edge it turns back
                t = (places - along[a]) / (along[b] - along[a])
                inside = (t > 1e-4) & (t < 1 - 1e-4)
                seams += inside.any() and math.floor(passage[a]) != math.floor(passage[b])
                least = ((1 - t) * pressure[a] + t * pressure[b])[inside]
                # A roll angle has six decimals.
                enough = map_["value"][inside, s] >= least - 1e-5 * pressure[[a, b]].max()
                check(enough.all(), f"pattern at {torque} N m, slice {s}")
    check(seams > 0, f"pattern at {torque} N m: no place is passed from one mesh cycle to the next")


def check_summary(folder, pair, te, pairs, lines, at, tangent, h5):
    """The two tables on the screen."""
    text = (folder / "summary.txt").read_text().splitlines()
    rows = [
        [math.nan if word == "-" else float(word.removeprefix("<")) for word in line.split()]
        for line in text
        if re.fullmatch(r"[\s0-9.e+<-]+", line) and line.strip() and "+- " not in line
    ]
    first, second = [row for row in rows if len(row) == 13], [row for row in rows if len(row) == 11]
    check(
        len(first) == len(at) and len(second) == len(at) - 1, f"summary: {len(first)} and {len(second)} rows"
    )
    for row, torque in zip(first, sorted(at)):
        expected = numpy.array(summary_of_errors(torque, at[torque], tangent[torque], te, pair.pinion.base))
        shown, off = ~numpy.isnan(expected), [6e-4] + [6e-5] * 7 + [6e-4, 0.06, 0.06, 6e-3, 6e-3]
        check((numpy.isnan(row) == ~shown).all(), f"summary: dashes where nothing is shown at {torque} N m")
        near(
            numpy.array(row)[shown],
            expected[shown],
            f"summary, first table at {torque} N m",
            absolute=numpy.array(off)[shown],
        )
    for row, torque in zip(second, [torque for torque in sorted(at) if torque > 0]):
        pattern = h5[f"contact_pattern/torque_{sorted(at).index(torque)}/value"][:]
        near(
            row,
            summary_of_loads(torque, pair, te, pairs, lines, pattern),
            f"summary, second table at {torque} N m",
            absolute=[6e-4] + [6e-5] * 5 + [0.06, 6e-5, 0.06, 6e-5, 6e-5],
        )
    check_sharp_edges(text, te)
    check_torques(folder, sorted(at), second, h5)


def check_sharp_edges(text, te):
    """The lines that say what pressure comes to at sharp face ends and tips: the greatest of every power."""
    for edge, column in (("face end", "end"), ("tip edge", "tip")):
        of_edge = rf"sharp {edge} at (\S+) N m: pressure comes to (\S+) MPa .* power (\S+)$"
        shown = [
            [float(word) for word in found.groups()] for line in text if (found := re.match(of_edge, line))
        ]
        expected = {}
        values = te["torque_Nm"], te[f"{column}_intensity_MPa_mm"], te[f"{column}_power"]
        for torque, intensity, power in zip(*values):
            if intensity > 0:
                key = float(f"{torque:.3f}"), -power
                expected[key] = max(expected.get(key, 0), intensity)
        check(len(shown) == len(expected) > 0, f"summary: {len(shown)} lines of a {edge}, {len(expected)}")
        for torque, intensity, power in shown:
            (found,) = [v for key, v in expected.items() if numpy.allclose(key, (torque, power), atol=1e-3)]
            near(intensity, found, f"summary: sharp {edge} at {torque} N m", absolute=6e-5)


def check_torques(folder, torques, second, h5):
    """The group of results.h5 with what the summary says of a torque, against the texts."""
    group, loaded = h5["of_torques"], numpy.array(torques) > 0
    units = {"torque_Nm": "N m", "K_Hbeta": "1", "flank_used_percent": "%", "noise_of_harmonics_um": "um"}
    units |= {f"iso_6336_root_stress_{name}_MPa": "MPa" for name in ("pinion", "gear")}
    found = {name: unit(values) for name, values in group.items()}
    check(found == units, f"results.h5/of_torques: {found}")
    near(group["torque_Nm"][:], torques, "results.h5/of_torques: torques", relative=1e-12)
    for name, column, digits in (("K_Hbeta", 7, 4), ("flank_used_percent", 8, 1)):
        shown = [row[column] for row in second]
        near(group[name][loaded], shown, f"results.h5/of_torques/{name}", absolute=0.51 * 10**-digits)
    check(numpy.isnan(group["K_Hbeta"][~loaded]).all(), "results.h5/of_torques: no K_Hbeta without a load")
    check((group["flank_used_percent"][~loaded] == 0).all(), "results.h5/of_torques: no flank used")
    told = re.findall(r"amplitudes below (\S+) um may be noise", (folder / "harmonics.csv").read_text())
    near(
        group["noise_of_harmonics_um"][:],
        [float(level) for level in told],
        "results.h5/of_torques: noise of harmonics",
        absolute=0.51e-6,
    )
    roots = [group[f"iso_6336_root_stress_{name}_MPa"][loaded] for name in ("pinion", "gear")]
    told = re.findall(
        r"^ ISO 6336-3 .* pinion (\S+) MPa .* gear (\S+) MPa", (folder / "summary.txt").read_text(), re.M
    )
    for body, stress in enumerate(roots):
        check((stress > 0).all(), "results.h5/of_torques: nominal root stress")
        near(
            stress / stress[0],
            numpy.array(torques)[loaded] / numpy.array(torques)[loaded][0],
            "results.h5/of_torques: nominal root stress is proportional to the torque",
            relative=1e-12,
        )
        if told:  # where root stress is asked for
            near(
                stress,
                [float(row[body]) for row in told],
                "results.h5/of_torques: nominal root stress",
                absolute=0.051,
            )


def summary_of_errors(torque, values, tangent, te, base_radius):
    """A row of the first table: transmission error, contacts, pressures, stiffnesses over a mesh cycle."""
    mine = te["torque_Nm"] == torque
    noise = 1e-4 * (values.max() - values.min()) + 1e-5 * abs(values.mean())  # shown for less: "<0.0003"
    amplitudes = [max(a, noise) for a, _ in harmonics(values)] + [math.nan] * 5  # not shown: "-"
    return [
        torque,
        values.mean(),
        values.max() - values.min(),
        *amplitudes[:5],
        te["contacts"][mine].mean(),
        te["max_pressure_MPa"][mine].max(),
        te["tip_edge_load_N_per_mm"][mine].max(),
        tangent.mean(),
        torque * 1e3 / base_radius / values.mean(),
    ]


def summary_of_loads(torque, pair, te, pairs, lines, pattern):
    """A row of the second table: load shares, where pressure is greatest, loads along the face, the part of
    the flank that is ever in contact, shuttling moment.
    """
    mine, line = te["torque_Nm"] == torque, lines["torque_Nm"] == torque
    share = pairs["load_share"][pairs["torque_Nm"] == torque]
    peak = numpy.flatnonzero(mine)[te["max_pressure_MPa"][mine].argmax()]
    by_slice = {}
    loads = lines["load_per_length_N_per_mm"][line] * lines["extent_mm"][line]
    for z, load in zip(lines["z_mm"][line], loads):
        number = round((z - pair.low) / (pair.high - pair.low) * 31 - 0.5)
        by_slice[number] = by_slice.get(number, 0) + load
    moment = te["shuttling_moment_Nm"][mine]
    return [
        torque,
        share.min(),
        share.max(),
        te["max_pressure_pinion_roll_angle_deg"][peak],
        te["max_pressure_z_mm"][peak],
        te["phase"][peak],
        te["max_line_load_N_per_mm"][mine].max(),
        max(by_slice.values()) / (sum(by_slice.values()) / 31),
        100 * (pattern > 0).mean(),
        moment.mean(),
        moment.max() - moment.min(),
    ]


def check_iso_stiffness(summary, pair):
    """ISO 6336-1: its mesh stiffness over the face that both gears have in common."""
    told = re.search(r"c_gamma_alpha (\S+), .* c_gamma_alpha is (\S+) N/um over", summary)
    common = pair.high - pair.low
    near(float(told[2]), float(told[1]) * common, "ISO 6336-1 over the common face", relative=2e-3)


def check_subsurface(folder, pair, te):
    """Against Hertz's line contact at the same greatest pressure, where the contact is one:
    away from edges and knees of reliefs.
    """
    table = Table(folder / "subsurface.csv")
    near(
        table["max_pressure_MPa"],
        te["max_pressure_MPa"][te["torque_Nm"] > 0],
        "subsurface.csv: greatest pressure",
        absolute=1e-4,
    )
    modulus = 1 / sum((1 - body.nu**2) / body.youngs for body in (pair.pinion, pair.gear))
    rows = [(row, te.rows[i]) for row, i in zip(table.rows, numpy.flatnonzero(te["torque_Nm"] > 0))]
    compared = 0
    for row, whole in rows:
        roll, z = math.radians(float(whole["max_pressure_pinion_roll_angle_deg"])), float(
            whole["max_pressure_z_mm"]
        )
        if abs(z) > 1 or not 22 < math.degrees(roll) < 26 or not row["shear_MPa"]:
            continue
        pressure = float(row["max_pressure_MPa"])
        half_width = 2 * pressure * pair.normal_radius(roll) / modulus
        near(float(row["shear_MPa"]), 0.3003 * pressure, "greatest shear of a line contact", relative=0.05)
        near(
            float(row["shear_depth_um"]),
            786 * half_width,
            "its depth (at draft: five cells over the half-width)",
            relative=0.2,
        )
        compared += 1
    # One shape of the pressure, whatever its size: both depths keep their ratio,
    # that of a line contact (0.786 to 0.70 half-widths at nu 0.3). A contact at a corner of the flanks,
    # shorter than it is wide, has a greater shear at another depth.
    both = [
        (float(r["shear_depth_um"]), float(r["von_mises_depth_um"]))
        for r in table.rows
        if r["shear_MPa"]
        and float(r["von_mises_depth_um"]) > 0
        and float(r["shear_MPa"]) < 0.35 * float(r["max_pressure_MPa"])
    ]
    check(
        all(1.0 < a / b < 1.35 for a, b in both) and len(both) > 10,
        "depths of greatest shear and von Mises stress",
    )
    check(compared > 0, "no line contact to compare with")


def check_sidebands(case, folder):
    """A hunting period of 23 and 46 teeth: lines of the spectrum over all its mesh cycles,
    in orders of the mesh, the pinion and the gear.
    """
    torque, positions, cycles = 40.0, 4, 46
    settings = (
        "gear.teeth=46",
        "gear.bore_diameter_mm=45",
        "pair.centre_distance_mm=90.2",
        "mesh_cycle.period=hunting",
        f"mesh_cycle.positions={positions}",
        f"load.pinion_torque_Nm=[{torque}]",
        "contact_grid.slices=11",
        "output.subsurface_stress=no",
        "output.light_load_pattern=no",
    )
    run("run", case, "-o", folder, *(word for setting in settings for word in ("--set", setting)))
    te, table = Table(folder / "te.csv"), Table(folder / "sidebands.csv")
    expected = harmonics(te["te_um"])
    check(len(te.rows) == positions * cycles, f"hunting: {len(te.rows)} positions")
    check(len(table.rows) == len(expected), f"sidebands: {len(table.rows)} lines of {len(expected)}")
    line = numpy.arange(1, len(expected) + 1)
    near(table["mesh_order"], line / cycles, "sidebands: orders of the mesh", relative=1e-8)
    near(table["pinion_order"], line * 23 / cycles, "sidebands: orders of the pinion", relative=1e-8)
    near(table["gear_order"], line * 46 / cycles, "sidebands: orders of the gear", relative=1e-8)
    near(
        table["amplitude_um"],
        [amplitude for amplitude, _ in expected],
        "sidebands: amplitudes",
        absolute=2e-9,
    )
    loud = [i for i, (amplitude, _) in enumerate(expected) if amplitude > 1e-4]
    off = [abs((table["phase_deg"][i] - expected[i][1] + 180) % 360 - 180) for i in loud]
    check(len(loud) > 5 and max(off) < 1e-3, f"sidebands: phases, {max(off)} deg off")
    near(table["aliased"], 4 * line / cycles > positions, "sidebands: aliased")
    of_mesh = {row["harmonic"]: row["bound_um"] for row in Table(folder / "harmonics.csv").rows}
    check("nan" not in (of_mesh["1"], of_mesh["2"]), f"sidebands: bounds to compare with, {of_mesh}")
    for row in table.rows:
        number, beside = divmod(int(row["line"]), cycles)
        expected = "nan" if beside else of_mesh[str(number)]
        check(row["bound_um"] == expected, f"sidebands: bound of line {row['line']}, {row['bound_um']}")
    check_first_cycle(folder, positions, Pair(case))


def check_first_cycle(folder, positions, pair):
    """Load over the face and contact pattern are those of the first mesh cycle, whose single teeth differ
    from those of the others. Slices share the common face equally; a slice may be cut into parts.
    """
    lines, slices = Table(folder / "lines.csv"), 11
    first = lines["position"] < positions
    by_slice = numpy.zeros(slices)
    height = (pair.high - pair.low) / slices
    for z, load, extent in zip(*(lines[c][first] for c in ("z_mm", "load_per_length_N_per_mm", "extent_mm"))):
        by_slice[int((z - pair.low) / height)] += load * extent
    h5 = h5py.File(folder / "results.h5")
    near(h5["of_torques/K_Hbeta"][0], by_slice.max() / by_slice.mean(), "K_Hbeta of the first cycle", 1e-6)
    pattern = numpy.nanmax(h5["contact_pattern/torque_0/value"][:])
    check(pattern <= lines["max_pressure_MPa"][first].max() + 6e-5, "pattern of the first cycle")


def check_root_stress(folder, pair, pairs):
    """Both bodies on their own faces; tension below the loaded flank, where the teeth are bent."""
    table = Table(folder / "root_stress.csv")
    body, fillet = numpy.array(table.text("body")), numpy.array(table.text("fillet"))
    carrying = {
        (torque, position, tooth)
        for torque, position, tooth, share in zip(
            *(pairs[name] for name in ("torque_Nm", "position", "pair", "load_share"))
        )
        if share > 0
    }
    for name in ("pinion", "gear"):
        of = {
            tuple(row)
            for row in numpy.transpose(
                [table[column][body == name] for column in ("torque_Nm", "position", "pair")]
            )
        }
        check(of == carrying, f"root stress of the {name}: of the pairs that carry load")
    for name, middle in (("pinion", 0.0), ("gear", pair.offset)):
        mine, half = body == name, getattr(pair, name).face / 2
        near(
            [table["z_mm"][mine].min(), table["z_mm"][mine].max()],
            [middle - half, middle + half],
            f"root stress: face of the {name}",
            absolute=1e-5,
        )
        loaded, other = (
            table["tensile_stress_MPa"][mine & (fillet == side)].max() for side in ("loaded", "other")
        )
        summary = (folder / "summary.txt").read_text()
        begin = r"^greatest tensile root stress at .*"
        told = re.findall(rf"{begin} {name} (\S+) MPa at z = (\S+) mm", summary, re.M)
        torques = numpy.unique(table["torque_Nm"])
        check(len(told) == len(torques), f"root stress of the {name} in the summary: {len(told)} torques")
        for (stress, z), torque in zip(told, torques):
            here = mine & (table["torque_Nm"] == torque)
            values = table["tensile_stress_MPa"][here]
            near(float(stress), values.max(), "root stress told", absolute=0.051)
            near(float(z), table["z_mm"][here][values.argmax()], "where it is", absolute=6e-4)
        check(
            loaded > 1.2 * other > 0,
            f"root stress of the {name}: {loaded} MPa below the loaded flank, {other} below the other",
        )
