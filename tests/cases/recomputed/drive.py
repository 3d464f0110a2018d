# SPDX-License-Identifier: GPL-2.0-or-later
"""A run of a drive: rotations, gaps, levers and balances from the case's own kinematics."""
import math, re

import h5py, numpy
from checks import Table, arcsec, check, check_harmonics, near, run, unit


class Drive:
    """Kinematics of the drive from its case: crank counter-clockwise, carrier clockwise by psi [rad]."""

    def __init__(self, path):
        import tomllib

        with open(path, "rb") as file:
            self.case = tomllib.load(file)
        d = self.d = self.case["drive"]
        self.n = d["rollers"]
        self.radius = d["sleeve_circle_radius_mm"]

    def centre(self, part, radius, count, number):
        angle = 2 * math.pi / count * (number if part == "roller" else number - 0.5)
        outwards, along = numpy.array([math.cos(angle), math.sin(angle)]), numpy.array(
            [-math.sin(angle), math.cos(angle)]
        )
        errors = [
            1e-3 * self.d.get(f"{part}_{way}_errors_um", [0] * count)[number - 1]
            for way in ("radial", "tangential")
        ]
        return (radius + errors[0]) * outwards + errors[1] * along

    def apart(self, roller, sleeve, phi, psi):
        """From the axis of the sleeve to that of the roller."""
        turn = numpy.array([[math.cos(psi), math.sin(psi)], [-math.sin(psi), math.cos(psi)]])
        axis = self.d["eccentricity_mm"] * numpy.array([math.cos(phi), math.sin(phi)])
        arm = turn @ self.centre("sleeve", self.radius, self.n - 1, sleeve)
        return (
            self.centre("roller", self.d["roller_circle_radius_mm"], self.n, roller) - axis - arm,
            arm,
            axis,
        )

    def contact_distance(self, roller, sleeve):
        radii = (
            self.d["roller_radius_mm"]
            + self.d["sleeve_radius_mm"]
            - 1e-3 * self.d.get("uniform_clearance_um", 0)
        )
        for part, number in (("roller", roller), ("sleeve", sleeve)):
            radii += 1e-3 * self.d.get(f"{part}_radius_errors_um", [0] * self.n)[number - 1]
        return radii

    def gap(self, roller, sleeve, phi, psi):
        return math.hypot(*self.apart(roller, sleeve, phi, psi)[0]) - self.contact_distance(roller, sleeve)

    def levers(self, roller, sleeve, phi, psi):
        """Of a unit force: about the carrier's axis, turning it on, and for the crank [mm]."""
        d, arm, axis = self.apart(roller, sleeve, phi, psi)
        t = -d / math.hypot(*d)  # of the roller's force on the sleeve
        return -(arm[0] * t[1] - arm[1] * t[0]), -(axis[0] * t[1] - axis[1] * t[0])


def check_least_gap(case):
    """`flank check`: the least gap at the nominal rotation on each flank, over all turns of the carrier;
    all rollers with all sleeves.
    """
    drive, n = Drive(case), Drive(case).n - 1
    phi = numpy.radians(numpy.arange(0, 360 * n, 0.5))
    psi, least = phi / n, {"drive": math.inf, "coast": math.inf}
    axis = drive.d["eccentricity_mm"] * numpy.array([numpy.cos(phi), numpy.sin(phi)])
    for sleeve in range(1, n + 1):
        x, y = drive.centre("sleeve", drive.radius, n, sleeve)
        arm = numpy.array([numpy.cos(psi) * x + numpy.sin(psi) * y, numpy.cos(psi) * y - numpy.sin(psi) * x])
        for roller in range(1, drive.n + 1):
            apart = (
                drive.centre("roller", drive.d["roller_circle_radius_mm"], drive.n, roller)[:, None]
                - axis
                - arm
            )
            gap = numpy.hypot(*apart) - drive.contact_distance(roller, sleeve)
            drives = (
                arm[0] * apart[1] - arm[1] * apart[0] > 0
            )  # the roller's force on the sleeve, along -apart, turns it clockwise
            for flank, there in (("drive", drives), ("coast", ~drives)):
                least[flank] = min(least[flank], gap[there].min(initial=math.inf))
    said = run("check", case)
    for flank, value in least.items():
        shown = float(re.search(rf"least gap over the cycle, {flank} flank\s+(\S+) um", said)[1])
        near(
            shown, 1e3 * value, f"least gap on the {flank} flank", absolute=0.01
        )  # um: both look every half degree


def drive_run(case, folder, *settings):
    run("run", case, "-o", folder, *(word for setting in settings for word in ("--set", setting)))
    drive, h5 = Drive(case), h5py.File(folder / "results.h5")
    check(h5["stages/seconds"][:].sum() > 0, "results.h5: times of its stages")
    te, pairs, unloaded = (
        Table(folder / "te.csv"),
        Table(folder / "pairs.csv"),
        Table(folder / "unloaded.csv"),
    )
    on_input = "model.torque_on=input" in settings
    n = drive.n - 1
    phi, psi, T = (
        numpy.radians(te["crank_angle_deg"]),
        numpy.radians(te["carrier_rotation_deg"]),
        te["torque_Nm"],
    )
    near(te["te_arcsec"], (phi / n - psi) / arcsec, "te_arcsec: lag of the carrier", absolute=2e-6)
    near(
        te["te_um"],
        te["te_arcsec"] * arcsec * drive.radius * 1e3,
        "te_um at R1",
        absolute=2e-9,
        relative=1e-8,
    )
    torques = sorted(set(T))
    loads = numpy.zeros(len(T))
    for row in range(len(te.rows)):
        mine = numpy.flatnonzero((pairs["torque_Nm"] == T[row]) & (pairs["position"] == te["position"][row]))
        where, moments = f"at {T[row]} N m, crank angle {te['crank_angle_deg'][row]}", []
        check(int(te["contacts"][row]) == len(mine), f"contacts {where}")
        near(
            te["max_pressure_MPa"][row],
            pairs["mid_pressure_MPa"][mine].max(initial=0),
            f"greatest pressure {where}",
            absolute=1e-4,
        )
        near(
            te["edge_pressure_MPa"][row],
            pairs["edge_pressure_MPa"][mine].max(initial=0),
            f"edge pressure {where}",
            absolute=1e-4,
        )
        for i in mine:
            roller, sleeve = int(pairs["roller"][i]), int(pairs["sleeve"][i])
            near(
                pairs["approach_um"][i],
                -1e3 * drive.gap(roller, sleeve, phi[row], psi[row]),
                f"approach of {roller}, {sleeve} {where}",
                absolute=2e-6,
            )
            lever, crank = drive.levers(roller, sleeve, phi[row], psi[row])
            near(pairs["lever_mm"][i], lever, f"lever of {roller}, {sleeve} {where}", absolute=1e-8)
            check((pairs.text("flank")[i] == "drive") == (lever > 0), f"flank of {roller}, {sleeve} {where}")
            moments.append(pairs["normal_force_N"][i] * (crank if on_input else lever) / 1e3)
        if T[row] > 0:
            near(
                sum(moments),
                T[row],
                f"torque on the {'crank' if on_input else 'carrier'} {where}",
                relative=1e-6,
            )
    at = {torque: T == torque for torque in torques}
    count = int(at[torques[0]].sum())
    lag = {torque: (phi / n - psi)[at[torque]] for torque in torques}
    # Ratios: of the crank over a degree, and at a point, of its own column of rotations:
    # central differences over two degrees are good to 1 %.
    for torque in torques:
        secant = numpy.radians(1.0) / numpy.diff(psi[at[torque]])
        near(
            te["gear_ratio_secant"][at[torque]][:-1],
            secant,
            f"gear_ratio_secant at {torque} N m",
            relative=1e-7,
        )
    near(te["gear_ratio"], te["gear_ratio_instantaneous"], "gear_ratio: instantaneous by default")
    if not on_input:
        quotient = 1.0 / (
            (lag[10.001] - lag[10.0]) / arcsec / 60
        )  # 1e-3 N m over what it winds up, in arcmin: [1e-3 N m/arcmin]
        near(
            te["torsional_stiffness_Nm_per_arcmin"][at[10.0]],
            1e-3 * quotient,
            "torsional stiffness: difference quotient",
            relative=1e-3,
        )
        near(
            te["torsional_stiffness_secant_Nm_per_arcmin"][at[30.0]],
            30.0 / ((lag[30.0] - lag[0.0]) / arcsec / 60),
            "secant torsional stiffness",
            relative=1e-6,
        )
        near(
            te["mesh_stiffness_N_per_um"],
            te["torsional_stiffness_Nm_per_arcmin"] * 1e3 / (60 * arcsec) / drive.radius**2 / 1e3,
            "mesh stiffness: torsional over R1^2",
            relative=1e-6,
            absolute=1e-6,
        )
    for name, column, absolute in (
        ("transmission_error", "te_um", 6e-10),
        ("transmission_error_rotation", "te_arcsec", 6e-10),
        ("gear_ratio_instantaneous", "gear_ratio_instantaneous", 6e-10),
        ("gear_ratio_secant", "gear_ratio_secant", 6e-10),
        ("contacts", "contacts", 0),
        ("max_pressure", "max_pressure_MPa", 6e-5),
        ("edge_pressure", "edge_pressure_MPa", 6e-5),
        ("torsional_stiffness", "torsional_stiffness_Nm_per_arcmin", 6e-10),
    ):
        near(h5[name][:].ravel(), te[column], f"drive's results.h5, {name}", absolute=absolute)
    for name, expected in (
        ("torque", "N m"),
        ("crank_angle", "deg"),
        ("transmission_error", "um"),
        ("transmission_error_rotation", "arcsec"),
        ("max_pressure", "MPa"),
        ("torsional_stiffness", "N m/arcmin"),
        ("preload", "N"),
    ):
        check(unit(h5[name]) == expected, f"drive's unit of {name}: {unit(h5[name])!r}")
    check_harmonics(
        Table(folder / "harmonics.csv"),
        {torque: te["te_um"][at[torque]][:20] for torque in torques},
        "drive's harmonics.csv",
    )
    # Unloaded: the gap at the nominal rotation, none at the contact rotation;
    # the backlash from the first pair to touch.
    for row in unloaded.rows:
        angle, roller, sleeve = (
            math.radians(float(row["crank_angle_deg"])),
            int(row["roller"]),
            int(row["sleeve"]),
        )
        touching, where = (
            math.radians(float(row["contact_rotation_deg"])),
            f"of {row['roller']}, {row['sleeve']} at crank angle {row['crank_angle_deg']}",
        )
        near(
            float(row["gap_um"]),
            1e3 * drive.gap(roller, sleeve, angle, angle / n),
            f"nominal gap {where}",
            absolute=2e-6,
        )
        near(
            drive.gap(roller, sleeve, angle, touching),
            0,
            f"gap at the contact rotation {where}",
            absolute=1e-9,
        )
        near(
            float(row["lever_mm"]),
            drive.levers(roller, sleeve, angle, touching)[0],
            f"lever at the contact rotation {where}",
            absolute=1e-8,
        )
        mine = [
            float(r["contact_rotation_deg"])
            for r in unloaded.rows
            if r["crank_angle_deg"] == row["crank_angle_deg"] and r["flank"] == row["flank"]
        ]
        first = max(mine) if row["flank"] == "drive" else min(mine)
        near(float(row["phi_d_deg"]), first, f"first contact rotation {where}", absolute=1e-9)
        near(
            float(row["backlash_arcsec"]),
            abs(first - float(row["contact_rotation_deg"])) * 3600,
            f"backlash {where}",
            absolute=1e-5,
        )
    # Pressure maps, a quarter of the contact: four times their sum is the pair's force;
    # along the roller a light load stays on the straight part and what the crown leaves of it.
    maps = 0
    for name, position in h5["pressure_maps"].items():
        t, k = (int(word) for word in re.fullmatch(r"torque_(\d+)_position_(\d+)", name).groups())
        for pair, columns in position.items():
            roller, sleeve = (int(word) for word in re.fullmatch(r"roller_(\d+)_sleeve_(\d+)", pair).groups())
            force = next(
                float(r["normal_force_N"])
                for r in pairs.rows
                if float(r["torque_Nm"]) == h5["torque"][t]
                and int(r["position"]) == k
                and int(r["roller"]) == roller
                and int(r["sleeve"]) == sleeve
            )
            p, y = columns["pressure"][:], columns["y"][:]
            near(
                4 * (p * 4 * columns["half_x"][:] * columns["half_y"][:]).sum(),
                force,
                f"force of the pressure map {name}/{pair}",
                relative=1e-6,
            )
            crown = drive.d["crown"]
            reach = numpy.abs(y[p > 0]).max()
            approach = next(
                float(r["approach_um"])
                for r in pairs.rows
                if float(r["torque_Nm"]) == h5["torque"][t]
                and int(r["position"]) == k
                and int(r["roller"]) == roller
                and int(r["sleeve"]) == sleeve
            )
            most = crown["straight_length_mm"] / 2 + math.sqrt(2 * crown["radius_mm"] * 1e-3 * approach)
            half_cell = columns["half_y"][:].max()
            check(
                crown["straight_length_mm"] / 2 - half_cell
                < reach
                < min(most, drive.d["width_mm"] / 2) + half_cell,
                f"loaded length of {name}/{pair}: {reach:.3f} mm, straight to "
                f"{crown['straight_length_mm'] / 2}, the crown has dropped by the approach at {most:.3f}",
            )
            maps += 1
    check(maps > 2, f"{maps} pressure maps")
