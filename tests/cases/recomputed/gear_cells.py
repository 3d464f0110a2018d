# SPDX-License-Identifier: GPL-2.0-or-later
"""The cells of a run of a gear pair: forces, moments, tilts and gaps, the gaps and levers from the case."""
import math

import numpy
from checks import check, near

positions = 8


def check_cells(pair, h5, te, pairs, lines):
    """Cells: the raw state that all of it follows from."""
    gaps = edge_gaps = of_lines = at_tips = at_ends = 0
    for t, torque in enumerate(h5["pinion_torque"]):
        for k in range(positions):
            if h5["cells/count"][t, k] == 0:
                continue
            at = Position(h5, lines, t, k)
            mine = (pairs["torque_Nm"] == torque) & (pairs["position"] == k)
            check_forces(at, pairs["pair"][mine], pairs["normal_force_N"][mine], te)
            scaled = at.pressure * scales_of_line_contacts(at, pair)
            of_lines += (scaled != at.pressure).any()
            check_greatest_pressures(at, scaled, te)
            check_pressures_of_pairs(at, scaled, pairs["pair"][mine], pairs["max_pressure_MPa"][mine])
            check_lines(at, math.cos(pair.beta_b))
            at_tips += check_tip_edges(at, pair, te)
            check_tip_intensities(at, pair, scaled, te)
            at_ends += check_intensity(at, pair, scaled, te)
            edges = at.loaded_edges()
            check_moments(at, pair, te, edges)
            edge_gaps += len(edges)
            check_tilts(at, pair, h5, edges)
            gaps += check_gaps(at, pair)
    check(of_lines > 20, f"positions with Hertz's line contacts: {of_lines}")
    check(at_tips > 50, f"slices that carry at tip edges: {at_tips}")
    check(at_ends > 5, f"positions that carry at sharp face ends: {at_ends}")
    check(gaps > 300 and edge_gaps > 50, f"{gaps} gaps on contact lines, {edge_gaps} at tip edges")


class Position:
    """The cells at one torque and position of the mesh cycle, and the rows of lines.csv there."""

    def __init__(self, h5, lines, t, k):
        c = h5["cells"]
        self.t, self.k, self.torque, self.row = t, k, h5["pinion_torque"][t], t * positions + k
        self.phase, self.where = k / positions, f"at {self.torque} N m, position {k}"
        n, first, start = (int(c[name][t, k]) for name in ("count", "first_cell", "first_pressure"))
        self.count = n
        names = ("pair", "z", "pinion_roll_angle", "gear_roll_angle", "area", "unloaded_gap", "place")
        self.cell = {name: c[name][first : first + n] for name in names}
        self.pressure = c["pressure"][start : start + n]
        self.force = self.pressure * self.cell["area"]
        self.inside = numpy.isin(self.cell["place"], (0, 4, 5))
        mine = (lines["torque_Nm"] == self.torque) & (lines["position"] == k)
        columns = ("pair", "z_mm", "load_per_length_N_per_mm", "pinion_roll_angle_deg", "extent_mm")
        self.line = {column: lines[column][mine] for column in columns}
        self.tip_edge_load = lines["tip_edge_load_N_per_mm"][mine]
        self.tip_intensity = lines["tip_intensity_MPa_mm"][mine]
        self.tip_power = lines["tip_power"][mine]
        self.line_pressure = lines["max_pressure_MPa"][mine]

    def loaded_edges(self):
        """Numbers of the loaded cells at tip edges."""
        place = self.cell["place"]
        return numpy.flatnonzero(((place == 1) | (place == 3)) & (self.force > 0))

    def slice_with(self, number, z):
        """Middle and extent along the axis of the slice that a cell of a tooth pair is on. [mm]"""
        middle, extent = self.line["z_mm"], self.line["extent_mm"]
        found = (self.line["pair"] == number) & (numpy.abs(middle - z) < extent / 2)
        check(found.sum() == 1, f"{found.sum()} slices of pair {number} are at z = {z:.3f}")
        return middle[found][0], extent[found][0]


def check_forces(at, numbers, shares, te):
    """The force of every tooth pair, and the centre of all of them."""
    for number, share in zip(numbers, shares):
        near(
            at.force[at.cell["pair"] == number].sum(),
            share,
            f"force of pair {int(number)} {at.where}",
            absolute=2e-6,
        )
    near(
        te["load_centre_z_mm"][at.row],
        (at.force * at.cell["z"]).sum() / at.force.sum(),
        f"load centre {at.where}",
        absolute=1e-6,
    )


def scales_of_line_contacts(at, pair):
    """Hertz's greatest pressure over that of the cells, where a slice is such a line contact; a cell each."""
    scales = numpy.ones(at.count)
    half_spaces = ((1 - g["poissons_ratio"] ** 2) / (1e3 * g["youngs_modulus_GPa"]) for g in both(pair.case))
    modulus = 1 / sum(half_spaces)
    for number, z, _, _, extent in zip(*at.line.values()):
        of_slice = (at.cell["pair"] == number) & (numpy.abs(at.cell["z"] - z) < extent / 2)
        loaded = numpy.flatnonzero(of_slice & (at.force > 0))
        if len(loaded) < 3 or numpy.isin(at.cell["place"][loaded], (1, 3)).any():
            continue
        length = extent / math.cos(pair.beta_b)
        arc = pair.pinion.base * numpy.radians(at.cell["pinion_roll_angle"][loaded]) ** 2 / 2
        order = arc.argsort()
        half = at.cell["area"][loaded][order] / (2 * length)
        load, x = at.force[loaded][order] / length, arc[order] - arc.mean()
        sure, greatest = hertz_of_strips(x, half, load, modulus)
        scales[of_slice] = 1 + sure * (greatest / at.pressure[loaded].max() - 1)
    return scales


def both(case):
    return (case[gear] for gear in ("pinion", "gear"))


def hertz_of_strips(x, half, load, modulus):
    """How surely strips of uniform pressure are a Hertzian contact, and its greatest pressure [MPa]. Their
    deflections by quadrature of the line load's ln|x|; the gap's parabola through what is left.
    """
    point, weight = numpy.polynomial.legendre.leggauss(400)
    inside = x[:, None] + half[:, None] * point
    deflected = numpy.zeros(len(x))
    for at, wide, q in zip(x, half, load):
        high, low = inside - at + wide, inside - at - wide
        logs = high * numpy.log(numpy.abs(high)) - low * numpy.log(numpy.abs(low)) - 2 * wide
        deflected -= q / (numpy.pi * modulus * wide) * (logs @ weight) / 2
    means = numpy.stack([numpy.ones(len(x)), x, ((inside**2) @ weight) / 2], axis=1)
    weights = numpy.sqrt(load)
    parabola, *_ = numpy.linalg.lstsq(means * weights[:, None], deflected * weights, rcond=None)
    if parabola[2] >= 0:
        return 0, 0
    radius, middle, total = -0.5 / parabola[2], -parabola[1] / (2 * parabola[2]), load.sum()
    width = math.sqrt(4 * total * radius / (numpy.pi * modulus))
    off = numpy.sqrt(load @ (deflected - means @ parabola) ** 2 / total) / (width**2 / (2 * radius))
    centre = load @ x / total
    gyration = math.sqrt(load @ ((x - centre) ** 2 + half**2 / 3) / total)
    strip = (x[-1] + half[-1] - x[0] + half[0]) / len(x)
    place = math.hypot(centre - middle, 2 * gyration - width) / strip
    sure = 1
    for distance, none, certain in ((off, 0.006, 0.0012), (place, 0.5, 0.25)):
        t = min(1, max(0, (none - distance) / (none - certain)))
        sure *= t * t * (3 - 2 * t)
    return sure, 2 * total / (numpy.pi * width)


def check_greatest_pressures(at, pressure, te):
    """The greatest pressures inside and at edges, and where the one inside is."""
    cell, inside, where, row = at.cell, at.inside, at.where, at.row
    near(
        te["max_pressure_MPa"][row],
        pressure[inside].max(initial=0),
        f"greatest pressure inside {where}",
        absolute=1e-4,
    )
    near(
        te["edge_pressure_MPa"][row],
        pressure[~inside].max(initial=0),
        f"greatest pressure at edges {where}",
        absolute=1e-4,
    )
    if pressure[inside].max(initial=0) > 0:
        peak = numpy.flatnonzero(inside)[pressure[inside].argmax()]
        near(
            te["max_pressure_pinion_roll_angle_deg"][row],
            cell["pinion_roll_angle"][peak],
            f"roll angle of the greatest pressure {where}",
            absolute=1e-6,
        )
        near(
            te["max_pressure_z_mm"][row],
            cell["z"][peak],
            f"z of the greatest pressure {where}",
            absolute=1e-6,
        )


def check_pressures_of_pairs(at, pressures, numbers, told):
    """The greatest pressure of every tooth pair, edges among them, and of its contact line."""
    for number, pressure in zip(numbers, told):
        greatest = pressures[at.cell["pair"] == number].max()
        what = f"greatest pressure of pair {int(number)} {at.where}"
        near(pressure, greatest, what, absolute=1e-4)
        on_line = at.line_pressure[at.line["pair"] == number].max()
        near(on_line, greatest, f"{what}, on its contact line", absolute=1e-4)


def check_lines(at, cosine):
    """Lines: the force of a slice over the length of contact line in it."""
    cell, force = at.cell, at.force
    for number, z, load, at_roll, extent in zip(*at.line.values()):
        all_cells = (cell["pair"] == number) & (numpy.abs(cell["z"] - z) < extent / 2)
        here = all_cells & at.inside
        if here.sum() < all_cells.sum():
            continue
        if load > 0:  # the centre of its load along the profile, arcs going as the roll angle's square
            squares = (force * cell["pinion_roll_angle"] ** 2)[here].sum() / force[here].sum()
            near(
                at_roll,
                math.sqrt(squares),
                f"roll angle of the line at z = {z} {at.where}",
                absolute=2e-3,
            )
        near(
            load,
            force[here].sum() / (extent / cosine),
            f"load per length of contact line at z = {z} {at.where}",
            absolute=1e-5,
            relative=2e-3,
        )


def check_tip_edges(at, pair, te):
    """Force per length of tip edge, of the slices whose line of contact lies beyond an end of the path of
    action; the greatest 5 % of the face from its ends. Returns how many carry.
    """
    greatest = carrying = 0
    for stated, number, z, load, _, extent in zip(at.tip_edge_load, *at.line.values()):
        roll = -pair.on_line_of_action(0, z, number, at.phase) / pair.pinion.base
        mate = (pair.action - pair.pinion.base * roll) / pair.gear.base
        at_rolls = (pair.pinion, roll), (pair.gear, mate)
        beyond = [body for body, at_roll in at_rolls if at_roll > body.tip_roll]
        expected = 0
        if beyond:
            helix = math.atan(math.tan(pair.beta_b) * beyond[0].tip / beyond[0].base)
            expected = load / math.cos(pair.beta_b) * math.cos(helix)
        near(stated, expected, f"force per length of tip edge at z = {z} {at.where}", absolute=2e-6)
        carrying += expected > 0
        if abs(z - (pair.low + pair.high) / 2) + extent / 2 < 0.45 * (pair.high - pair.low):
            greatest = max(greatest, stated)
    near(te["tip_edge_load_N_per_mm"][at.row], greatest, f"greatest at tip edges {at.where}", absolute=2e-6)
    return carrying


def check_tip_intensities(at, pair, pressures, te):
    """At sharp tips: the power solves Dundurs and Lee's equation of the tooth's corner on the mate's
    flank; of a spur gear the outermost cell's pressure is the mean of K s^power over it. The greatest 5
    % of the face from its ends.
    """
    powers = {}
    for body, geometry in (("pinion", pair.pinion), ("gear", pair.gear)):
        normal = math.cos(pair.beta_b) * math.sin(math.atan(geometry.tip_roll))  # its part along the radius
        powers[body] = singular_power(pair, {body: math.pi / 2 + math.asin(normal)})
    greatest, power_there = 0, 0
    lines = zip(at.tip_intensity, at.tip_power, *list(at.line.values())[:2], at.line["extent_mm"])
    for stated, power, number, z, extent in lines:
        if stated > 0:
            body = min(powers, key=lambda name: abs(powers[name] - power))
            near(power, powers[body], f"power at the tip edge, z = {z} {at.where}", absolute=1e-5)
        if stated > 0 and pair.beta_b == 0:
            at_slice = (at.cell["pair"] == number) & (numpy.abs(at.cell["z"] - z) < extent / 2)
            cells = numpy.flatnonzero(at_slice & (at.cell["place"] == 1) & (pressures > 0))
            outermost = cells[at.cell[f"{body}_roll_angle"][cells].argmax()]
            width = at.cell["area"][outermost] / extent
            expected = pressures[outermost] * (1 + power) * width**-power
            near(stated, expected, f"intensity at the tip edge, z = {z} {at.where}", relative=1e-4)
        if abs(z - (pair.low + pair.high) / 2) + extent / 2 < 0.45 * (pair.high - pair.low):
            greatest, power_there = max((greatest, power_there), (stated, power))
    stated = te["tip_intensity_MPa_mm"][at.row]
    near(stated, greatest, f"greatest intensity at tips {at.where}", absolute=6e-5)
    near(te["tip_power"][at.row], power_there, f"power of that {at.where}", absolute=2e-6)


def check_intensity(at, pair, pressures, te):
    """At the sharp face end that presses most, away from tip edges: the mean over a cell of K s^power, s the
    distance from the end along the generator; the power solves Dundurs and Lee's equation. Returns whether
    one carries.
    """
    middle, extent = at.line["z_mm"], at.line["extent_mm"]
    last = (middle - extent / 2 < pair.low + 1e-6) | (middle + extent / 2 > pair.high - 1e-6)
    at_end = sum(
        (at.cell["pair"] == number) & (numpy.abs(at.cell["z"] - z) < height / 2)
        for number, z, height in zip(at.line["pair"][last], middle[last], extent[last])
    )
    ends = numpy.flatnonzero((at.cell["place"] == 2) & (pressures > 0) & (at_end > 0))
    if len(ends) == 0:
        near(te["end_intensity_MPa_mm"][at.row], 0, f"intensity where no sharp end carries {at.where}")
        return False
    most = ends[pressures[ends].argmax()]
    z = at.cell["z"][most]
    _, extent = at.slice_with(at.cell["pair"][most], z)
    power = power_at_end(pair, z > (pair.low + pair.high) / 2)
    near(te["end_power"][at.row], power, f"power at the end {at.where}", absolute=1e-5)
    expected = pressures[most] * (1 + power) * (extent / math.cos(pair.beta_b)) ** -power
    near(te["end_intensity_MPa_mm"][at.row], expected, f"intensity at the end {at.where}", relative=1e-4)
    return True


def power_at_end(pair, high):
    """Power of the pressure at an end of the common face, from the angles of both bodies there."""
    # The pinion's flank leans by its base helix angle; which end is acute follows from hand and drive.
    sign = pair.lead_sign * (1 if high else -1)
    pinion = math.pi / 2 - sign * pair.beta_b
    end = pair.high if high else pair.low
    openings = {}
    for body, middle, opening in (("pinion", 0.0, pinion), ("gear", pair.offset, math.pi - pinion)):
        if abs(middle + (1 if high else -1) * pair.case[body]["face_width_mm"] / 2 - end) < 1e-6:
            openings[body] = opening
    return singular_power(pair, openings)


def singular_power(pair, openings):
    """Power of the pressure where the bodies are wedges of these openings; one that is not named goes on."""
    wedges = []
    for body in ("pinion", "gear"):
        data = pair.case[body]
        modulus = data["youngs_modulus_GPa"] / (1 - data["poissons_ratio"] ** 2)
        wedges.append((openings.get(body, math.pi), modulus))
    n = lambda x, a: math.sin(2 * x * a) + x * math.sin(2 * a)
    q = lambda x, a: (x * math.sin(a)) ** 2 - math.sin(x * a) ** 2
    (a, of_a), (b, of_b) = wedges
    misfit = lambda x: n(x, a) * q(x, b) / of_a + n(x, b) * q(x, a) / of_b
    steps = numpy.linspace(0.05, 0.995, 400)
    for low, above in zip(steps, steps[1:]):
        if misfit(low) * misfit(above) <= 0:
            for _ in range(60):
                half = (low + above) / 2
                low, above = (low, half) if misfit(low) * misfit(half) <= 0 else (half, above)
            return low - 1
    return 0.0


def check_moments(at, pair, te, edges):
    """Moments: a force normal to an involute has its base radius as lever about its gear;
    tip edges have the mate's normal.
    """
    cosine = math.cos(pair.beta_b)
    pinion_levers = numpy.full(at.count, pair.pinion.base * cosine)
    gear_levers = numpy.full(at.count, pair.gear.base * cosine)
    for i in edges:
        number = int(at.cell["pair"][i])
        # Of the slice: a cell that is cut at the edge has another middle.
        middle, _ = at.slice_with(number, at.cell["z"][i])
        pinion_levers[i], gear_levers[i] = pair.levers(middle, number, at.phase)
        check_edge_gap(at, pair, i, (pinion_levers[i], gear_levers[i]))
    near(
        (at.force * pinion_levers).sum() / 1e3, at.torque, f"torque of the pinion {at.where}", relative=1e-7
    )
    near(
        te["gear_torque_Nm"][at.row],
        (at.force * gear_levers).sum() / 1e3,
        f"torque of the gear {at.where}",
        relative=1e-7,
    )


def check_edge_gap(at, pair, i, levers):
    """Gap of a cell at a tip edge, along the mate's normal; levers: those of its slice."""
    roll_angle, z, number = at.cell["pinion_roll_angle"][i], at.cell["z"][i], int(at.cell["pair"][i])
    at_roll, entering = math.radians(roll_angle), roll_angle < math.degrees(math.tan(pair.alpha_wt))
    tip = "gear" if entering else "pinion"  # that is an edge there
    apart, mate, _, _, opened = pair.edge_contact(at_roll, z, number, at.phase, tip)
    expected = (
        1e3 * apart
        + pair.removed("pinion", at_roll, z)
        + pair.removed("gear", mate, z - pair.offset)
        + pair.stand_back(number, at.phase, levers)
        + opened
    )
    near(
        at.cell["unloaded_gap"][i],
        expected,
        f"gap at the {tip}'s tip edge, pair {number}, z = {z:.3f} {at.where}",
        absolute=0.1,
    )


def check_tilts(at, pair, h5, edges):
    """Tilts of the axes: springs under the moments of the normal forces about each gear's middle.
    0.4 %: beside the contact line the lever is another; at tip edges the normal is turned, by less
    than a tenth of a radian.
    """
    cell, force, cosine, sine = at.cell, at.force, math.cos(pair.beta_b), math.sin(pair.beta_b)
    pb, gb = pair.pinion.base, pair.gear.base
    pinion_moments = (
        cell["z"] * cosine + pair.lead_sign * pb * numpy.radians(cell["pinion_roll_angle"]) * sine
    )
    gear_moments = (cell["z"] - pair.offset) * cosine - pair.lead_sign * gb * numpy.radians(
        cell["gear_roll_angle"]
    ) * sine
    for name, side, moments, across in (
        ("pinion", -1, pinion_moments, pb * sine),
        ("gear", 1, gear_moments, gb * sine),
    ):
        stiffness = [
            pair.case["mounting"][f"{name}_tilt_{plane}_Nm_per_mrad"]
            for plane in ("in_plane", "across_plane")
        ]
        turned = 1e-4 * (force[edges] * numpy.abs(moments[edges])).sum()
        near(
            h5[f"tilt_{name}_in_plane"][at.t, at.k] * stiffness[0],
            side * 1e-3 * (force * moments).sum(),
            f"tilt of the {name} in the plane of action {at.where}",
            relative=0.004,
            absolute=turned,
        )
        near(
            h5[f"tilt_{name}_across_plane"][at.t, at.k] * stiffness[1],
            1e-3 * force.sum() * across * pair.lead_sign,  # of the axial force
            f"tilt of the {name} across the plane of action {at.where}",
            relative=0.005,
        )


def check_gaps(at, pair):
    """Gaps on the contact lines, from the case: 0.1 um is what a relief's knee or a quadratic relief
    averages to over a cell. Returns how many.
    """
    cell, roll = at.cell, numpy.radians(at.cell["pinion_roll_angle"])
    on_path = pair.pinion.base * roll + pair.gear.base * numpy.radians(cell["gear_roll_angle"]) - pair.action
    gaps = 0
    for i in numpy.flatnonzero(at.inside & (numpy.abs(on_path) < 1e-9)):
        number, z = int(cell["pair"][i]), cell["z"][i]
        off = pair.on_line_of_action(roll[i], z, number, at.phase)
        check(
            abs(off) < 1e-6,
            f"a cell of pair {number} at z = {z:.3f} is {off:.6f} mm off its contact line {at.where}",
        )
        if at.force[i] == 0:
            continue  # lines.csv has loaded slices alone: how wide the cell is it does not say
        half = cell["area"][i] / (2 * at.slice_with(number, z)[1] / math.cos(pair.beta_b))
        near(
            cell["unloaded_gap"][i],
            pair.gap(roll[i], z, number, at.phase) + 1e3 * half**2 / 6 / pair.normal_radius(roll[i]),
            f"gap of pair {number} at z = {z:.3f} {at.where}",
            absolute=0.1,
        )
        gaps += 1
    return gaps
