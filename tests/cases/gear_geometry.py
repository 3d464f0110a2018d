# SPDX-License-Identifier: GPL-2.0-or-later
"""Geometry of an involute pair from its case file, by the formulas of ISO 21771 and in other terms than the product's: what result files are
recomputed with. Lengths in mm, angles in rad, deviations in um."""
import math, tomllib


class Body:
    def __init__(self, case, name, pair):
        g = case[name]
        self.teeth, self.face, self.shift = g["teeth"], g["face_width_mm"], g.get("profile_shift", 0.0)
        self.youngs, self.nu = 1e3 * g["youngs_modulus_GPa"], g["poissons_ratio"]
        self.reference = pair.mt * self.teeth / 2
        self.base = self.reference * math.cos(pair.alpha_t)
        self.tip = g.get("tip_diameter_mm", 2 * self.reference + 2 * pair.mn * (1 + self.shift)) / 2
        # Arc at the reference circle; half of the space of a rack that is shifted outwards by x m_n.
        self.thickness = g.get("tooth_thickness_mm", pair.mt * (math.pi / 2 + 2 * self.shift * math.tan(pair.alpha_n)))
        self.tip_roll = math.sqrt((self.tip / self.base) ** 2 - 1)


class Pair:
    def __init__(self, path, **changes):
        with open(path, "rb") as file:
            case = self.case = tomllib.load(file)
        for key, value in changes.items():
            case[key].update(value)
        p = case["pair"]
        beta = math.radians(p.get("helix_angle_deg", 0.0))
        self.mn, self.alpha_n, self.beta = p["normal_module_mm"], math.radians(p["normal_pressure_angle_deg"]), beta
        self.mt, self.alpha_t = self.mn / math.cos(beta), math.atan(math.tan(self.alpha_n) / math.cos(beta))
        self.beta_b = math.asin(math.sin(beta) * math.cos(self.alpha_n))
        self.pinion, self.gear = Body(case, "pinion", self), Body(case, "gear", self)
        self.centre = p["centre_distance_mm"] + 1e-3 * p.get("centre_distance_error_um", 0.0)
        self.offset = p.get("axial_offset_mm", 0.0)
        bases = self.pinion.base + self.gear.base
        self.alpha_wt = math.acos(bases / self.centre)
        self.action = self.centre * math.sin(self.alpha_wt)  # between the points where the line of action touches the base circles
        self.pitch = math.pi * self.mt * math.cos(self.alpha_t)  # transverse base pitch
        self.low = max(-self.pinion.face / 2, self.offset - self.gear.face / 2)
        self.high = min(self.pinion.face / 2, self.offset + self.gear.face / 2)
        # Starts of active profile, from where the mate's tip is.
        self.pinion.start_roll = (self.action - self.gear.base * self.gear.tip_roll) / self.pinion.base
        self.gear.start_roll = (self.action - self.pinion.base * self.pinion.tip_roll) / self.gear.base
        # Along z the contact lines run towards the driving tip or away from it, by hand and by the flank that drives.
        left = p.get("pinion_hand", "right") == "left"
        clockwise = case["load"].get("drive_flank", "counter_clockwise") == "clockwise"
        self.lead_sign = (-1 if left else 1) * (-1 if clockwise else 1)

    def circumferential_backlash(self):
        """At the working pitch circles [mm]."""
        involute = lambda a: math.tan(a) - a
        thickness = lambda b: 2 * (b.base / math.cos(self.alpha_wt)) * (b.thickness / (2 * b.reference) + involute(self.alpha_t) - involute(self.alpha_wt))
        pitch_radius = self.pinion.base / math.cos(self.alpha_wt)
        return 2 * math.pi * pitch_radius / self.pinion.teeth - thickness(self.pinion) - thickness(self.gear)

    # Deviations of the loaded flanks, normal to the flank [um], at a roll angle [rad] and the gear's own z, counted from its mid-face [mm].
    def removed(self, name, roll, z):
        body, data = getattr(self, name), dict(self.case[name])
        clockwise = self.case["load"].get("drive_flank", "counter_clockwise") == "clockwise"
        data.update(data.get("right_flank" if clockwise else "left_flank", {}))
        start, tip, face = body.start_roll, body.tip_roll, body.face
        grown = lambda part, table: max(0.0, part) ** (2 if table.get("shape") == "quadratic" else 1)
        total = 0.0
        if table := data.get("tip_relief"):
            at = math.radians(table["start_roll_angle_deg"])
            total += table["amount_um"] * grown((roll - at) / (tip - at), table)
        if table := data.get("root_relief"):
            at = math.radians(table["start_roll_angle_deg"])
            total += table["amount_um"] * grown((at - roll) / (at - start), table)
        if table := data.get("profile_slope"):
            total += table["amount_um"] * ((roll - start) / (tip - start) - 0.5)  # > 0: less of the tooth is left at its tip
        if table := data.get("profile_crown"):
            total += table["amount_um"] * (2 * (roll - start) / (tip - start) - 1) ** 2
        if table := data.get("lead_crown"):
            total += table["amount_um"] * (2 * z / face) ** 2
        if table := data.get("helix_slope"):
            total += table["amount_um"] * z / face
        if table := data.get("end_relief"):
            for end, towards in (("positive_z", 1), ("negative_z", -1)):
                if table.get("end", "both") in ("both", end):
                    total += table["amount_um"] * grown(1 - (face / 2 - towards * z) / table["length_mm"], table)
        for table in data.get("bias", []):
            at, corner = math.radians(table["start_roll_angle_deg"]), table["corner"]
            # Contact leaves the driving tip (corner 1 of the pinion) where the contact line comes last; the gear's corners meet the pinion's by
            # 3, 4, 1, 2.
            leaving = -self.lead_sign * (1 if name == "pinion" else -1)
            end = leaving if corner in (1, 4) else -leaving
            u = (roll - at) / (tip - at) if corner <= 2 else (at - roll) / (at - start)
            total += table["amount_um"] * grown(u - (face / 2 - end * z) / table["length_mm"], table)
        return total

    def stand_back(self, pair, phase):
        """Of the teeth of a pair in the first mesh cycle [um]; pair k meets k pitches before pair 0, with the k-th tooth before tooth 0."""
        total = 0.0
        for name in ("pinion", "gear"):
            data, teeth = self.case[name], getattr(self, name).teeth
            if errors := data.get("index_errors_um"):
                total += errors[-int(pair) % teeth]
            if table := data.get("runout"):
                turned = 2 * math.pi * phase / teeth - math.radians(table["angle_deg"])
                total += table["amount_um"] / 2 * math.cos(self.beta_b) * math.cos(turned)
        return total

    def misaligned(self, along, z):
        """What the tilt in the plane of action opens at a point of the line of action `along` from the pitch point: the pinion turned as a rigid
        body about the pitch point at mid-face, seen along the normal of the flank [um]."""
        turn = self.case.get("misalignment", {}).get("in_plane_um", 0.0) / (self.high - self.low)
        return turn * (z * math.cos(self.beta_b) + self.lead_sign * along * math.sin(self.beta_b))

    def on_line_of_action(self, roll, z, pair, phase):
        """How far a point of the pinion's flank is from the contact line of a pair [mm]."""
        return self.pinion.base * (roll - math.tan(self.alpha_wt)) - self.pitch * (phase + pair) - self.lead_sign * z * math.tan(self.beta_b)

    def normal_radius(self, roll):
        """Of relative curvature across the contact line [mm]."""
        mate = self.action - self.pinion.base * roll
        return 1 / (math.cos(self.beta_b) * (1 / (self.pinion.base * roll) + 1 / mate))

    def gap(self, roll, z, pair, phase):
        """Normal gap on the contact line, of the surfaces with all their deviations [um]."""
        mate = (self.action - self.pinion.base * roll) / self.gear.base
        along = self.pinion.base * (roll - math.tan(self.alpha_wt))
        return (self.removed("pinion", roll, z) + self.removed("gear", mate, z - self.offset) + self.stand_back(pair, phase) + self.misaligned(along, z))
