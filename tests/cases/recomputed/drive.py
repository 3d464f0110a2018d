# SPDX-License-Identifier: GPL-2.0-or-later
"""A run of a drive: rotations, gaps, levers and balances from the case's own kinematics."""
import math, re

import h5py, numpy
from checks import Table, arcsec, check, near, run, unit


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
    overlaps = min(least.values()) < 0
    check(("rollers and sleeves overlap: least gap" in said) == overlaps, f"overlap told: {least}")
    for flank, value in least.items():
        shown = float(re.search(rf"least gap over the cycle, {flank} flank\s+(\S+) um", said)[1])
        near(
            shown, 1e3 * value, f"least gap on the {flank} flank", absolute=0.01
        )  # um: both look every half degree


def drive_run(case, folder, *settings):
    """A run's tables and HDF5 file against the kinematics of its case."""
    run("run", case, "-o", folder, *(word for setting in settings for word in ("--set", setting)))
    drive, h5 = Drive(case), h5py.File(folder / "results.h5")
    check(h5["stages/seconds"][:].sum() > 0, "results.h5: times of its stages")
    te, pairs = Table(folder / "te.csv"), Table(folder / "pairs.csv")
    on_input = "model.torque_on=input" in settings
    check_lag(drive, te)
    for row in range(len(te.rows)):
        check_position(drive, te, pairs, row, on_input)
    check_ratios(te)
    if not on_input:
        check_stiffnesses(drive, te)
    check_hdf5(h5, te)
    # Over one pitch of the rollers errors of single parts do not come round (drive_period.py: where they do).
    check(not Table(folder / "harmonics.csv").rows, "drive's harmonics.csv: there is no period")
    check_unloaded(drive, Table(folder / "unloaded.csv"))
    check_pressure_maps(drive, h5, pairs)


def lag(drive, te):
    """By how much the carrier is behind its nominal rotation in each row of te.csv [rad]."""
    phi, psi = numpy.radians(te["crank_angle_deg"]), numpy.radians(te["carrier_rotation_deg"])
    return phi / (drive.n - 1) - psi


def check_lag(drive, te):
    """The transmission error is the carrier's lag, as an angle and at the sleeves' circle."""
    near(te["te_arcsec"], lag(drive, te) / arcsec, "te_arcsec: lag of the carrier", absolute=2e-6)
    near(
        te["te_um"],
        te["te_arcsec"] * arcsec * drive.radius * 1e3,
        "te_um at R1",
        absolute=2e-9,
        relative=1e-8,
    )


def check_position(drive, te, pairs, row, on_input):
    """One torque at one crank angle: its contacts and pressures, and the moments that balance the torque."""
    torque = te["torque_Nm"][row]
    mine = numpy.flatnonzero((pairs["torque_Nm"] == torque) & (pairs["position"] == te["position"][row]))
    where = f"at {torque} N m, crank angle {te['crank_angle_deg'][row]}"
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
    phi, psi = math.radians(te["crank_angle_deg"][row]), math.radians(te["carrier_rotation_deg"][row])
    moments = [check_contact(drive, pairs, i, phi, psi, on_input, where) for i in mine]
    if torque > 0:
        near(
            sum(moments),
            torque,
            f"torque on the {'crank' if on_input else 'carrier'} {where}",
            relative=1e-6,
        )


def check_contact(drive, pairs, i, phi, psi, on_input, where):
    """Approach, lever and flank of one contact; returns its moment on what the torque acts on [N m]."""
    roller, sleeve = int(pairs["roller"][i]), int(pairs["sleeve"][i])
    near(
        pairs["approach_um"][i],
        -1e3 * drive.gap(roller, sleeve, phi, psi),
        f"approach of {roller}, {sleeve} {where}",
        absolute=2e-6,
    )
    lever, crank = drive.levers(roller, sleeve, phi, psi)
    near(pairs["lever_mm"][i], lever, f"lever of {roller}, {sleeve} {where}", absolute=1e-8)
    check((pairs.text("flank")[i] == "drive") == (lever > 0), f"flank of {roller}, {sleeve} {where}")
    return pairs["normal_force_N"][i] * (crank if on_input else lever) / 1e3


def check_ratios(te):
    """Ratios: of the crank over a degree, and at a point, of its own column of rotations:
    central differences over two degrees are good to 1 %.
    """
    T, psi = te["torque_Nm"], numpy.radians(te["carrier_rotation_deg"])
    for torque in sorted(set(T)):
        secant = numpy.radians(1.0) / numpy.diff(psi[T == torque])
        near(
            te["gear_ratio_secant"][T == torque][:-1],
            secant,
            f"gear_ratio_secant at {torque} N m",
            relative=1e-7,
        )
    near(te["gear_ratio"], te["gear_ratio_instantaneous"], "gear_ratio: instantaneous by default")


def check_stiffnesses(drive, te):
    """Stiffnesses from how the lag grows with the torque; the mesh's at the sleeves' circle."""
    T, behind = te["torque_Nm"], lag(drive, te)

    def wound_up(torque, more):  # [arcmin]
        return (behind[T == more] - behind[T == torque]) / arcsec / 60

    quotient = 1.0 / wound_up(10.0, 10.001)  # [1e-3 N m/arcmin]
    near(
        te["torsional_stiffness_Nm_per_arcmin"][T == 10.0],
        1e-3 * quotient,
        "torsional stiffness: difference quotient",
        relative=1e-3,
    )
    near(
        te["torsional_stiffness_secant_Nm_per_arcmin"][T == 30.0],
        30.0 / wound_up(0.0, 30.0),
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


def check_hdf5(h5, te):
    """results.h5 = te.csv; units."""
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


def check_unloaded(drive, unloaded):
    """Unloaded: the gap at the nominal rotation, none at the contact rotation;
    the backlash from the first pair to touch.
    """
    for row in unloaded.rows:
        angle = math.radians(float(row["crank_angle_deg"]))
        touching = math.radians(float(row["contact_rotation_deg"]))
        roller, sleeve = int(row["roller"]), int(row["sleeve"])
        where = f"of {row['roller']}, {row['sleeve']} at crank angle {row['crank_angle_deg']}"
        near(
            float(row["gap_um"]),
            1e3 * drive.gap(roller, sleeve, angle, angle / (drive.n - 1)),
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
        first = first_contact(unloaded, row["crank_angle_deg"], row["flank"])
        near(float(row["phi_d_deg"]), first, f"first contact rotation {where}", absolute=1e-9)
        near(
            float(row["backlash_arcsec"]),
            abs(first - float(row["contact_rotation_deg"])) * 3600,
            f"backlash {where}",
            absolute=1e-5,
        )


def first_contact(unloaded, crank_angle, flank):
    """Rotation at which the first pair of a flank touches at a crank angle, both as the table says [deg]."""
    rotations = [
        float(row["contact_rotation_deg"])
        for row in unloaded.rows
        if row["crank_angle_deg"] == crank_angle and row["flank"] == flank
    ]
    return max(rotations) if flank == "drive" else min(rotations)


def check_pressure_maps(drive, h5, pairs):
    """Every pressure map against the row of its pair in pairs.csv."""
    maps = 0
    for name, position in h5["pressure_maps"].items():
        t, k = (int(word) for word in re.fullmatch(r"torque_(\d+)_position_(\d+)", name).groups())
        for pair, columns in position.items():
            roller, sleeve = (int(word) for word in re.fullmatch(r"roller_(\d+)_sleeve_(\d+)", pair).groups())
            row = next(
                r
                for r in pairs.rows
                if float(r["torque_Nm"]) == h5["torque"][t]
                and int(r["position"]) == k
                and int(r["roller"]) == roller
                and int(r["sleeve"]) == sleeve
            )
            check_pressure_map(drive, columns, row, f"{name}/{pair}")
            maps += 1
    check(maps > 2, f"{maps} pressure maps")


def check_pressure_map(drive, columns, row, where):
    """A quarter of the contact: four times its sum is the pair's force;
    along the roller a light load stays on the straight part and what the crown leaves of it.
    """
    p, y = columns["pressure"][:], columns["y"][:]
    near(
        4 * (p * 4 * columns["half_x"][:] * columns["half_y"][:]).sum(),
        float(row["normal_force_N"]),
        f"force of the pressure map {where}",
        relative=1e-6,
    )
    crown = drive.d["crown"]
    reach = numpy.abs(y[p > 0]).max()
    dropped = math.sqrt(2 * crown["radius_mm"] * 1e-3 * float(row["approach_um"]))
    most = crown["straight_length_mm"] / 2 + dropped
    half_cell = columns["half_y"][:].max()
    check(
        crown["straight_length_mm"] / 2 - half_cell
        < reach
        < min(most, drive.d["width_mm"] / 2) + half_cell,
        f"loaded length of {where}: {reach:.3f} mm, straight to "
        f"{crown['straight_length_mm'] / 2}, the crown has dropped by the approach at {most:.3f}",
    )
