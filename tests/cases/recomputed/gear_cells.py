# SPDX-License-Identifier: GPL-2.0-or-later
"""The cells of a run of a gear pair: forces, moments, tilts and gaps, the gaps and levers from the case."""
import math

import numpy
from checks import check, near

positions = 8


def check_cells(pair, h5, te, pairs, lines):
    """Cells: the raw state that all of it follows from."""
    pb, gb, cosine = pair.pinion.base, pair.gear.base, math.cos(pair.beta_b)
    c = h5["cells"]
    gaps = edge_gaps = 0
    for t, torque in enumerate(h5["pinion_torque"]):
        for k in range(positions):
            n, first, start = (int(c[name][t, k]) for name in ("count", "first_cell", "first_pressure"))
            if n == 0:
                continue
            cell = {
                name: c[name][first : first + n]
                for name in (
                    "pair",
                    "z",
                    "pinion_roll_angle",
                    "gear_roll_angle",
                    "area",
                    "unloaded_gap",
                    "place",
                )
            }
            pressure = c["pressure"][start : start + n]
            force, where, row = pressure * cell["area"], f"at {torque} N m, position {k}", t * positions + k
            mine = (pairs["torque_Nm"] == torque) & (pairs["position"] == k)
            for number, share in zip(pairs["pair"][mine], pairs["normal_force_N"][mine]):
                near(
                    force[cell["pair"] == number].sum(),
                    share,
                    f"force of pair {int(number)} {where}",
                    absolute=2e-6,
                )
            near(
                te["load_centre_z_mm"][row],
                (force * cell["z"]).sum() / force.sum(),
                f"load centre {where}",
                absolute=1e-6,
            )
            inside = cell["place"] == 0
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
            # Lines: the force of a slice over the length of contact line in it.
            mine = (lines["torque_Nm"] == torque) & (lines["position"] == k)
            columns = ("pair", "z_mm", "load_per_length_N_per_mm", "pinion_roll_angle_deg", "extent_mm")

            def slice_with(number, z, mine=mine):
                """Middle and extent along the axis of the slice that a cell of a tooth pair is on. [mm]"""
                middle, extent = lines["z_mm"][mine], lines["extent_mm"][mine]
                found = (lines["pair"][mine] == number) & (numpy.abs(middle - z) < extent / 2)
                check(found.sum() == 1, f"{found.sum()} slices of pair {number} are at z = {z:.3f}")
                return middle[found][0], extent[found][0]

            for number, z, load, at_roll, extent in zip(*(lines[column][mine] for column in columns)):
                here = (cell["pair"] == number) & (numpy.abs(cell["z"] - z) < extent / 2) & inside
                if here.sum() == ((cell["pair"] == number) & (numpy.abs(cell["z"] - z) < extent / 2)).sum():
                    if (
                        load > 0
                    ):  # the centre of its load along the profile, arcs going as the roll angle's square
                        squares = (force * cell["pinion_roll_angle"] ** 2)[here].sum() / force[here].sum()
                        near(
                            at_roll,
                            math.sqrt(squares),
                            f"roll angle of the line at z = {z} {where}",
                            absolute=2e-3,
                        )
                    near(
                        load,
                        force[here].sum() / (extent / cosine),
                        f"load per length of contact line at z = {z} {where}",
                        absolute=1e-5,
                        relative=2e-3,
                    )
            # Moments: a force normal to an involute has its base radius as lever about its gear;
            # tip edges have the mate's normal.
            entering = cell["pinion_roll_angle"] < math.degrees(
                math.tan(pair.alpha_wt)
            )  # there it is the gear's tip that is an edge
            edges = numpy.flatnonzero(((cell["place"] == 1) | (cell["place"] == 3)) & (force > 0))
            pinion_levers, gear_levers = numpy.full(n, pb * cosine), numpy.full(n, gb * cosine)
            for i in edges:
                tip, at_roll, z, number = (
                    "gear" if entering[i] else "pinion",
                    math.radians(cell["pinion_roll_angle"][i]),
                    cell["z"][i],
                    int(cell["pair"][i]),
                )
                apart, mate, _, _, opened = pair.edge_contact(at_roll, z, number, k / positions, tip)
                # Of the slice: a cell that is cut at the edge has another middle.
                middle, _ = slice_with(number, z)
                pinion_levers[i], gear_levers[i] = pair.levers(middle, number, k / positions)
                expected = (
                    1e3 * apart
                    + pair.removed("pinion", at_roll, z)
                    + pair.removed("gear", mate, z - pair.offset)
                    + pair.stand_back(number, k / positions)
                    + opened
                )
                near(
                    cell["unloaded_gap"][i],
                    expected,
                    f"gap at the {tip}'s tip edge, pair {number}, z = {z:.3f} {where}",
                    absolute=0.1,
                )
                edge_gaps += 1
            near((force * pinion_levers).sum() / 1e3, torque, f"torque of the pinion {where}", relative=1e-7)
            near(
                te["gear_torque_Nm"][row],
                (force * gear_levers).sum() / 1e3,
                f"torque of the gear {where}",
                relative=1e-7,
            )
            # Tilts of the axes: springs under the moments of the normal forces about each gear's middle.
            # 0.4 %: beside the contact line the lever is another; at tip edges the normal is turned, by less
            # than a tenth of a radian.
            sine = math.sin(pair.beta_b)
            for name, side, moments, across in (
                (
                    "pinion",
                    -1,
                    cell["z"] * cosine
                    + pair.lead_sign * pb * numpy.radians(cell["pinion_roll_angle"]) * sine,
                    pb * sine,
                ),
                (
                    "gear",
                    1,
                    (cell["z"] - pair.offset) * cosine
                    - pair.lead_sign * gb * numpy.radians(cell["gear_roll_angle"]) * sine,
                    gb * sine,
                ),
            ):
                stiffness = [
                    pair.case["mounting"][f"{name}_tilt_{plane}_Nm_per_mrad"]
                    for plane in ("in_plane", "across_plane")
                ]
                turned = 1e-4 * (force[edges] * numpy.abs(moments[edges])).sum()
                near(
                    h5[f"tilt_{name}_in_plane"][t, k] * stiffness[0],
                    side * 1e-3 * (force * moments).sum(),
                    f"tilt of the {name} in the plane of action {where}",
                    relative=0.004,
                    absolute=turned,
                )
                near(
                    h5[f"tilt_{name}_across_plane"][t, k] * stiffness[1],
                    1e-3 * force.sum() * across * pair.lead_sign,  # of the axial force
                    f"tilt of the {name} across the plane of action {where}",
                    relative=0.005,
                )
            # Gaps on the contact lines, from the case: 0.1 um is what a relief's knee or a quadratic relief
            # averages to over a cell.
            roll = numpy.radians(cell["pinion_roll_angle"])
            on_line = inside & (
                numpy.abs(pb * roll + gb * numpy.radians(cell["gear_roll_angle"]) - pair.action) < 1e-9
            )
            for i in numpy.flatnonzero(on_line):
                number, z = int(cell["pair"][i]), cell["z"][i]
                off = pair.on_line_of_action(roll[i], z, number, k / positions)
                check(
                    abs(off) < 1e-6,
                    f"a cell of pair {number} at z = {z:.3f} is {off:.6f} mm off its contact line {where}",
                )
                if force[i] == 0:
                    continue  # lines.csv has loaded slices alone: how wide the cell is it does not say
                half = cell["area"][i] / (2 * slice_with(number, z)[1] / cosine)
                near(
                    cell["unloaded_gap"][i],
                    pair.gap(roll[i], z, number, k / positions)
                    + 1e3 * half**2 / 6 / pair.normal_radius(roll[i]),
                    f"gap of pair {number} at z = {z:.3f} {where}",
                    absolute=0.1,
                )
                gaps += 1
    check(gaps > 300 and edge_gaps > 50, f"{gaps} gaps on contact lines, {edge_gaps} at tip edges")
