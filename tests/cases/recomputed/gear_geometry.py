# SPDX-License-Identifier: GPL-2.0-or-later
"""Geometry of an involute pair from its case file, by the formulas of ISO 21771 and in other terms than the
product's: what result files are recomputed with. Lengths in mm, angles in rad, deviations in um.
"""
import math, tomllib


def grown(part, table, gradient):
    """Share of a relief's amount, at a share of its length, which grows by `gradient` along the flank [1/mm].
    The start of a linear one may be an arc that turns from no slope into amount times gradient.
    """
    if table.get("shape") == "quadratic":
        return max(0.0, part) ** 2
    half_arc = table.get("blend_radius_mm", 0) * (1e-3 * table["amount_um"] * gradient) / 2  # [mm]
    share = half_arc * gradient
    if abs(part) >= share:
        return max(0.0, part)
    return (part + share) ** 2 / (4 * share)


def cross(u, v):
    return u[0] * v[1] - u[1] * v[0]


class Body:
    def __init__(self, case, name, pair):
        g = case[name]
        self.teeth, self.face, self.shift = g["teeth"], g["face_width_mm"], g.get("profile_shift", 0.0)
        self.youngs, self.nu = 1e3 * g["youngs_modulus_GPa"], g["poissons_ratio"]
        self.reference = pair.mt * self.teeth / 2
        self.base = self.reference * math.cos(pair.alpha_t)
        self.tip = g.get("tip_diameter_mm", 2 * self.reference + 2 * pair.mn * (1 + self.shift)) / 2
        # Arc at the reference circle; half of the space of a rack that is shifted outwards by x m_n.
        self.thickness = g.get(
            "tooth_thickness_mm", pair.mt * (math.pi / 2 + 2 * self.shift * math.tan(pair.alpha_n))
        )
        self.tip_roll = math.sqrt((self.tip / self.base) ** 2 - 1)


class Pair:
    def __init__(self, path, **changes):
        with open(path, "rb") as file:
            case = self.case = tomllib.load(file)
        for gear in ("pinion", "gear"):
            if "like" in case[gear]:
                case[gear] = {**case[case[gear]["like"]], **case[gear]}
        for key, value in changes.items():
            case[key].update(value)
        p = case["pair"]
        beta = math.radians(p.get("helix_angle_deg", 0.0))
        self.beta = beta
        if "normal_module_mm" in p:
            self.mn, self.alpha_n = p["normal_module_mm"], math.radians(p["normal_pressure_angle_deg"])
            self.mt, self.alpha_t = self.mn / math.cos(beta), math.atan(
                math.tan(self.alpha_n) / math.cos(beta)
            )
        else:
            self.mt, self.alpha_t = p["transverse_module_mm"], math.radians(
                p["transverse_pressure_angle_deg"]
            )
            self.mn, self.alpha_n = self.mt * math.cos(beta), math.atan(
                math.tan(self.alpha_t) * math.cos(beta)
            )
        self.beta_b = math.asin(math.sin(beta) * math.cos(self.alpha_n))
        self.pinion, self.gear = Body(case, "pinion", self), Body(case, "gear", self)
        self.centre = p["centre_distance_mm"] + 1e-3 * p.get("centre_distance_error_um", 0.0)
        self.offset = p.get("axial_offset_mm", 0.0)
        bases = self.pinion.base + self.gear.base
        self.alpha_wt = math.acos(bases / self.centre)
        # Between the points where the line of action touches the base circles.
        self.action = self.centre * math.sin(self.alpha_wt)
        self.pitch = math.pi * self.mt * math.cos(self.alpha_t)  # transverse base pitch
        self.low = max(-self.pinion.face / 2, self.offset - self.gear.face / 2)
        self.high = min(self.pinion.face / 2, self.offset + self.gear.face / 2)
        # Starts of active profile, from where the mate's tip is.
        self.pinion.start_roll = (self.action - self.gear.base * self.gear.tip_roll) / self.pinion.base
        self.gear.start_roll = (self.action - self.pinion.base * self.pinion.tip_roll) / self.gear.base
        # Along z the contact lines run towards the driving tip or away from it,
        # by hand and by the flank that drives.
        left = p.get("pinion_hand", "right") == "left"
        clockwise = case["load"].get("drive_flank", "counter_clockwise") == "clockwise"
        self.lead_sign = (-1 if left else 1) * (-1 if clockwise else 1)

    def circumferential_backlash(self):
        """At the working pitch circles [mm]."""
        involute = lambda a: math.tan(a) - a
        thickness = (
            lambda b: 2
            * (b.base / math.cos(self.alpha_wt))
            * (b.thickness / (2 * b.reference) + involute(self.alpha_t) - involute(self.alpha_wt))
        )
        pitch_radius = self.pinion.base / math.cos(self.alpha_wt)
        return 2 * math.pi * pitch_radius / self.pinion.teeth - thickness(self.pinion) - thickness(self.gear)

    # Deviations of the loaded flanks, normal to the flank [um], at a roll angle [rad] and the gear's own z,
    # counted from its mid-face [mm].
    def removed(self, name, roll, z):
        body, data = getattr(self, name), dict(self.case[name])
        clockwise = self.case["load"].get("drive_flank", "counter_clockwise") == "clockwise"
        data.update(data.get("right_flank" if clockwise else "left_flank", {}))
        start, tip, face = body.start_roll, body.tip_roll, body.face
        along = lambda at, length: 1 / (body.base * at * length)  # how fast a relief's s grows [1/mm]
        total = 0.0
        if table := data.get("tip_relief"):
            at = math.radians(table["start_roll_angle_deg"])
            total += table["amount_um"] * grown((roll - at) / (tip - at), table, along(at, tip - at))
        if table := data.get("root_relief"):
            at = math.radians(table["start_roll_angle_deg"])
            total += table["amount_um"] * grown((at - roll) / (at - start), table, along(at, at - start))
        if table := data.get("profile_slope"):
            total += table["amount_um"] * (
                (roll - start) / (tip - start) - 0.5
            )  # > 0: less of the tooth is left at its tip
        if table := data.get("profile_crown"):
            total += table["amount_um"] * (2 * (roll - start) / (tip - start) - 1) ** 2
        if table := data.get("lead_crown"):
            total += table["amount_um"] * (2 * z / face) ** 2
        if table := data.get("helix_slope"):
            total += table["amount_um"] * z / face
        if table := data.get("end_relief"):
            for end, towards in (("positive_z", 1), ("negative_z", -1)):
                if table.get("end", "both") in ("both", end):
                    total += table["amount_um"] * grown(
                        1 - (face / 2 - towards * z) / table["length_mm"], table, 1 / table["length_mm"]
                    )
        for table in data.get("bias", []):
            at, corner = math.radians(table["start_roll_angle_deg"]), table["corner"]
            # Contact leaves the driving tip (corner 1 of the pinion) where the contact line comes last;
            # the gear's corners meet the pinion's by 3, 4, 1, 2.
            leaving = -self.lead_sign * (1 if name == "pinion" else -1)
            end = leaving if corner in (1, 4) else -leaving
            u = (roll - at) / (tip - at) if corner <= 2 else (at - roll) / (at - start)
            steepest = math.hypot(along(at, (tip if corner <= 2 else start) - at), 1 / table["length_mm"])
            total += table["amount_um"] * grown(
                u - (face / 2 - end * z) / table["length_mm"], table, steepest
            )
        return total

    def stand_back(self, pair, phase, levers=None):
        """What the teeth of a pair that stand back open in the first mesh cycle [um]; pair k meets k pitches
        before pair 0, with the k-th tooth before tooth 0. A tooth stands back by a turn about its gear's
        axis: beside the path of action its levers tell by how much [mm].
        """
        total = 0.0
        for number, name in enumerate(("pinion", "gear")):
            data, gear = self.case[name], getattr(self, name)
            back = 0.0
            if errors := data.get("index_errors_um"):
                back += errors[-int(pair) % gear.teeth]
            if table := data.get("runout"):
                turned = 2 * math.pi * phase / gear.teeth - math.radians(table["angle_deg"])
                back += table["amount_um"] / 2 * math.cos(self.beta_b) * math.cos(turned)
            total += back * (levers[number] / (gear.base * math.cos(self.beta_b)) if levers else 1)
        return total

    def misaligned(self, along, z):
        """What the tilt in the plane of action opens at a point of the line of action `along` from the
        pitch point: the pinion turned as a rigid body about the pitch point at mid-face, seen along the
        normal of the flank [um].
        """
        turn = self.case.get("misalignment", {}).get("in_plane_um", 0.0) / (self.high - self.low)
        return turn * (z * math.cos(self.beta_b) + self.lead_sign * along * math.sin(self.beta_b))

    def on_line_of_action(self, roll, z, pair, phase):
        """How far a point of the pinion's flank is from the contact line of a pair [mm]."""
        return (
            self.pinion.base * (roll - math.tan(self.alpha_wt))
            - self.pitch * (phase + pair)
            - self.lead_sign * z * math.tan(self.beta_b)
        )

    def normal_radius(self, roll):
        """Of relative curvature across the contact line [mm]."""
        mate = self.action - self.pinion.base * roll
        return 1 / (math.cos(self.beta_b) * (1 / (self.pinion.base * roll) + 1 / mate))

    def gap(self, roll, z, pair, phase):
        """Normal gap on the contact line, of the surfaces with all their deviations [um]."""
        mate = (self.action - self.pinion.base * roll) / self.gear.base
        along = self.pinion.base * (roll - math.tan(self.alpha_wt))
        return (
            self.removed("pinion", roll, z)
            + self.removed("gear", mate, z - self.offset)
            + self.stand_back(pair, phase)
            + self.misaligned(along, z)
        )

    def contact_roll(self, z, pair, phase):
        """Roll angle of the pinion where a tooth pair's contact line is, on its flank or beyond it [rad]."""
        along = self.pitch * (phase + pair) + self.lead_sign * z * math.tan(self.beta_b)
        return math.tan(self.alpha_wt) + along / self.pinion.base

    # Off the line of action: tip edges. In the transverse plane through the pinion's axis, x towards the
    # gear; the flanks as they touch on the line of action from (r_b cos, -r_b sin) of the working pressure
    # angle on; the user's z. [mm] q and r are a point seen from the pinion's and from the gear's axis, u is a
    # direction, `touching` the pinion's roll angle where the contact line is.
    def edge_contact(self, roll, z, pair, phase, tip_of):
        """Where a flank point of the pinion faces the gear: unmodified normal distance, the gear's roll
        angle, levers of a unit normal force about the pinion and the gear [mm, rad, mm, mm], what a tilt of
        the pinion opens there [um], along the normal of the mate of `tip_of`.
        """
        cosine, touching = math.cos(self.beta_b), self.contact_roll(z, pair, phase)
        angle = touching - roll + math.atan(roll) - self.alpha_wt  # of the point about the pinion
        radius = self.pinion.base * math.hypot(1, roll)
        q = (radius * math.cos(angle), radius * math.sin(angle))
        r = (q[0] - self.centre, q[1])
        if tip_of == "pinion":
            distance, mate, u = self.along_normal_of_gear(r, touching)
        else:
            distance, mate, u = self.along_normal_of_pinion(r, touching, roll)
        opened = self.opened_by_tilt(q, z, u)
        return distance * cosine, mate, abs(cross(q, u)) * cosine, abs(cross(r, u)) * cosine, opened

    def along_normal_of_gear(self, r, touching):
        """From a point along the normal of the gear's involute: distance, the gear's roll angle, the normal's
        direction.
        """
        w, pb, gb = self.alpha_wt, self.pinion.base, self.gear.base
        forward = (math.sin(w), math.cos(w))
        moment = cross(
            (pb * math.cos(w) - self.centre, -pb * math.sin(w)), forward
        )  # the same for every tangent of its base circle
        around, reach = math.atan2(r[1], r[0]), math.hypot(*r)
        choices = [around + math.asin(moment / reach), around + math.pi - math.asin(moment / reach)]
        direction = min(choices, key=lambda c: abs(math.remainder(c - (math.pi / 2 - w), 2 * math.pi)))
        turned = math.remainder(direction - (math.pi / 2 - w), 2 * math.pi)
        # On that tangent, counted from its own base circle.
        mate = (self.action - pb * touching) / gb - turned
        along = math.sqrt(reach**2 - gb**2)
        return along - gb * mate, mate, (math.cos(direction), math.sin(direction))

    def along_normal_of_pinion(self, r, touching, roll):
        """From a point of the pinion's flank along its own normal, from its base circle outwards, until the
        gear's involute, solved by its polar equation: distance, gear's roll angle, the normal's direction.
        """
        direction = math.pi / 2 - self.alpha_wt + (touching - roll)
        u = (math.cos(direction), math.sin(direction))
        inside = lambda length: self.inside_gear((r[0] + length * u[0], r[1] + length * u[1]), touching)
        low, high = -1.0, 1.0
        sign = inside(low)[0]
        for _ in range(60):
            middle = (low + high) / 2
            if (inside(middle)[0] > 0) == (sign > 0):
                low = middle
            else:
                high = middle
        return low, inside(low)[1], u

    def inside_gear(self, p, touching):
        """Angle about the gear's axis from its involute to a point p, seen from that axis; and the involute's
        roll angle at the point's radius.
        """
        w, pb, gb = self.alpha_wt, self.pinion.base, self.gear.base
        reach = math.hypot(*p)
        alpha = math.sqrt(max((reach / gb) ** 2 - 1, 0))
        # The gear's involute through the contact point on the line of action, turned about its axis.
        contact = (
            pb * math.cos(w) + pb * touching * math.sin(w) - self.centre,
            -pb * math.sin(w) + pb * touching * math.cos(w),
        )
        there = (self.action - pb * touching) / gb
        origin = math.atan2(contact[1], contact[0]) + (there - math.atan(there))
        return (
            math.remainder(math.atan2(p[1], p[0]) - (origin - (alpha - math.atan(alpha))), 2 * math.pi),
            alpha,
        )

    def opened_by_tilt(self, q, z, u):
        """What the tilt opens at a point along a transverse direction [um]: the pinion turned about the pitch
        point at z = 0.
        """
        w, cosine = self.alpha_wt, math.cos(self.beta_b)
        forward = (math.sin(w), math.cos(w))
        e2 = (math.cos(w), -math.sin(w))  # at right angles to the line of action, towards the gear
        pitch = (self.pinion.base / math.cos(w), 0.0)
        s, y = ((q[0] - pitch[0]) * e[0] + (q[1] - pitch[1]) * e[1] for e in (forward, e2))
        n = (
            cosine * (u[0] * forward[0] + u[1] * forward[1]),
            cosine * (u[0] * e2[0] + u[1] * e2[1]),
            -self.lead_sign * math.sin(self.beta_b),
        )
        data, width = self.case.get("misalignment", {}), self.high - self.low
        within, across = data.get("in_plane_um", 0.0) / width, data.get("across_plane_um", 0.0) / width
        return within * (z * n[0] - s * n[2]) + across * (-z * n[1] + y * n[2])

    def levers(self, z, pair, phase):
        """Of a unit normal force at the closest points of a tooth pair at z: the base radii on the line of
        action, less or more at a tip edge [mm].
        """
        cosine = math.cos(self.beta_b)
        roll = self.contact_roll(z, pair, phase)
        if roll > self.pinion.tip_roll:
            return self.edge_contact(self.pinion.tip_roll, z, pair, phase, "pinion")[2:4]
        if roll < self.pinion.start_roll:  # the pinion's point that faces the gear's tip
            low, high = roll, self.pinion.start_roll + 0.2
            for _ in range(60):
                middle = (low + high) / 2
                if self.edge_contact(middle, z, pair, phase, "gear")[1] > self.gear.tip_roll:
                    low = middle
                else:
                    high = middle
            return self.edge_contact(low, z, pair, phase, "gear")[2:4]
        return self.pinion.base * cosine, self.gear.base * cosine
