# SPDX-License-Identifier: GPL-2.0-or-later
"""Exact geometry of a case's gears and of their meshing."""
import cmath
import math

GEARS = ("pinion", "gear")


class Invalid(Exception):
    """A pair that cannot be made or cannot mesh."""


def involute(angle):
    return math.tan(angle) - angle


def inverse_involute(value):
    low, high = 0.0, 1.5
    for _ in range(80):
        middle = (low + high) / 2
        low, high = (middle, high) if involute(middle) < value else (low, middle)
    return low


class Body:
    """One gear of a case; lengths in mm, roll angles in rad."""

    def __init__(self, table, module, normal_module, angle):
        self.teeth, self.face = table["teeth"], table["face_width_mm"]
        r = self.reference = module * self.teeth / 2
        rb = self.base = r * math.cos(angle)
        x = table.get("profile_shift", 0.0)
        self.thickness = table.get(
            "tooth_thickness_mm", module * math.pi / 2 + 2 * x * normal_module * math.tan(angle)
        )
        self.shift = (self.thickness - module * math.pi / 2) / (2 * normal_module * math.tan(angle))
        self.tip = table.get("tip_diameter_mm", 2 * (r + normal_module * (1 + self.shift))) / 2
        self.root = table.get("root_diameter_mm", 2 * (r - normal_module * (1.25 - self.shift))) / 2
        self.fillet, self.bore = table["fillet_radius_mm"], table["bore_diameter_mm"] / 2
        self.pitch = 2 * math.pi / self.teeth
        self.half_at_base = self.thickness / (2 * r) + involute(angle)
        if not 0 < self.thickness < module * math.pi or self.tip <= rb or self.root >= self.tip:
            raise Invalid("no flank")
        tip_roll = self.roll_at(self.tip)
        if 2 * self.tip * (self.half_at_base - tip_roll + math.atan(tip_roll)) <= 0.021 * normal_module:
            raise Invalid("pointed")
        edge, limit = table.get("tip_edge", {}), 0.499 * (self.tip - max(rb, self.root))
        rho, chamfer = edge.get("rounding_radius_mm", 0), edge.get("chamfer_mm", 0)
        if max(rho, chamfer) > limit:
            raise Invalid("tip edge")
        self.sharp = rho == 0  # where the flank ends
        self.end_roll = (
            (math.sqrt((self.tip - rho) ** 2 - rb**2) + rho) / rb
            if rho
            else self.roll_at(self.tip - chamfer)
        )
        if self.root - self.bore < 0.51 * normal_module:
            raise Invalid("rim")
        centre = self.root + self.fillet
        along = math.sqrt(max(0.0, centre**2 - rb**2))
        if along > self.fillet:
            roll = (along - self.fillet) / rb
            self.form_roll, land = roll, self.half_at_base - roll + math.atan(along / rb)
        else:
            self.form_roll, land = 0.0, self.half_at_base + math.asin(self.fillet / centre)
        if land > math.pi / self.teeth * 0.999 or self.radius_at(self.form_roll) >= self.tip:
            raise Invalid("fillet")

    def roll_at(self, radius):
        return math.sqrt(max(0.0, (radius / self.base) ** 2 - 1))

    def radius_at(self, roll):
        return self.base * math.hypot(1, roll)


class Geometry:
    """A pair as its case gives it; raises Invalid for one that the program must refuse."""

    def __init__(self, case):
        pair = case["pair"]
        beta = math.radians(pair.get("helix_angle_deg", 0))
        self.module = (
            pair["transverse_module_mm"]
            if "transverse_module_mm" in pair
            else pair["normal_module_mm"] / math.cos(beta)
        )
        self.normal_module = self.module * math.cos(beta)
        normal_angle = math.radians(pair.get("normal_pressure_angle_deg", 0))
        self.angle = (
            math.radians(pair["transverse_pressure_angle_deg"])
            if "transverse_pressure_angle_deg" in pair
            else math.atan(math.tan(normal_angle) / math.cos(beta))
        )
        self.helix = beta
        self.base_helix = math.atan(math.tan(beta) * math.cos(self.angle))
        p, g = self.bodies = [Body(case[name], self.module, self.normal_module, self.angle) for name in GEARS]
        a = self.centre_distance = pair["centre_distance_mm"] + 1e-3 * pair.get("centre_distance_error_um", 0)
        if a <= p.base + g.base:
            raise Invalid("base circles overlap")
        self.working = math.acos((p.base + g.base) / a)
        self.line = a * math.sin(self.working)
        self.base_pitch = p.base * p.pitch
        self.offset = pair.get("axial_offset_mm", 0.0)
        self.low = max(-p.face / 2, self.offset - g.face / 2)
        self.high = min(p.face / 2, self.offset + g.face / 2)
        self.face = self.high - self.low
        if self.face < 0.2 * min(p.face, g.face):
            raise Invalid("faces beside each other")
        self.contact_ratio = (p.base * p.end_roll + g.base * g.end_roll - self.line) / self.base_pitch
        self.overlap_ratio = self.face * math.tan(self.base_helix) / self.base_pitch
        self.start = [(self.line - mate.base * mate.end_roll) / own.base for own, mate in ((p, g), (g, p))]
        clearance = min(a - p.tip - g.root, a - g.tip - p.root)
        width = lambda b: 2 * a * b.base / (p.base + g.base) * (b.half_at_base - involute(self.working))
        backlash = 2 * math.pi * a / (p.teeth + g.teeth) - width(p) - width(g)
        self.normal_backlash = backlash * math.cos(self.working) * math.cos(self.base_helix)
        if (
            clearance <= 1e-6 * a
            or backlash < 1e-6 * a
            or self.contact_ratio < 0.05
            or self.contact_ratio + self.overlap_ratio < 1.001
        ):
            raise Invalid("mesh")
        if any(start <= body.form_roll + 1e-6 for start, body in zip(self.start, self.bodies)):
            raise Invalid("interference")
        load = case.get("load", {})
        right = beta == 0 or pair.get("pinion_hand", "right") == "right"
        self.z_sign = (
            1 if right == (load.get("drive_flank", "counter_clockwise") == "counter_clockwise") else -1
        )

    def levers(self, phase, pair, z):
        """Moments of a slice's unit normal force about the pinion's and the gear's axis.
        On the path of action r_b cos(beta_b) of each; past it the tip of one gear touches the
        other's involute, along that involute's normal.
        """
        p, g = self.bodies
        roll = (
            math.tan(self.working)
            + (phase + pair) * p.pitch
            + self.z_sign * z * math.tan(self.base_helix) / p.base
        )
        mate = (self.line - p.base * roll) / g.base
        arms = [p.base, g.base]
        for i, (own, own_roll, other) in enumerate(((p, roll, g), (g, mate, p))):
            if own_roll > own.end_roll:  # seen from the own axis, x towards the other one
                tip = (
                    own.base
                    * cmath.rect(1, own_roll - self.working - own.end_roll)
                    * complex(1, own.end_roll)
                )
                to_other = self.centre_distance - tip
                tangent = math.sqrt(max(0.0, abs(to_other) ** 2 - other.base**2))
                radial = (
                    to_other * complex(other.base, -tangent) / abs(to_other) ** 2
                )  # at right angles to the other involute's normal
                arms[i] = (tip.conjugate() * radial).real
                break
        return [arm * math.cos(self.base_helix) for arm in arms]
