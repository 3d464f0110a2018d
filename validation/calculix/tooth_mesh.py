# SPDX-License-Identifier: GPL-2.0-or-later
"""The tooth of a case file and a mesh of its own: quadratic hexahedra of another layout than Flank's,
finer in the fillets.
"""
from collections import defaultdict

import numpy as np


class Tooth:
    """Transverse profile of a tooth centred on +x, from the case file: involute,
    circular fillet, root circle.
    """

    def __init__(self, case, body="pinion"):
        pair, gear = case["pair"], case[body]
        if "like" in gear:
            gear = case[gear["like"]] | gear
        self.teeth, self.width = gear["teeth"], gear["face_width_mm"]
        reference = pair["transverse_module_mm"] * self.teeth / 2
        alpha = np.radians(pair["transverse_pressure_angle_deg"])
        beta = np.radians(pair.get("helix_angle_deg", 0))
        self.base = reference * np.cos(alpha)
        self.tip, self.root, self.bore = (gear[k + "_diameter_mm"] / 2 for k in ("tip", "root", "bore"))
        self.rho = gear["fillet_radius_mm"]
        self.pitch = 2 * np.pi / self.teeth
        self.twist = np.tan(beta) / reference * (
            1 if (pair.get("pinion_hand", "right") == "right") == (body == "pinion") else -1
        )
        self.young, self.poisson = 1000 * gear["youngs_modulus_GPa"], gear["poissons_ratio"]
        self.half_at_base = gear["tooth_thickness_mm"] / (2 * reference) + np.tan(alpha) - alpha
        # A circle of radius rho that touches the involute from outside and the root circle:
        # its centre lies on the involute's normal.
        tangent = np.sqrt((self.root + self.rho) ** 2 - self.base**2)
        self.form_roll = (tangent - self.rho) / self.base
        assert self.form_roll > 0, "fillet does not reach the involute: not a profile of this check"
        self.tip_roll = np.sqrt((self.tip / self.base) ** 2 - 1)
        self.gap_angle = self.half_at_base - self.form_roll + np.arctan(tangent / self.base)
        assert self.gap_angle < self.pitch / 2, "fillets overlap"
        self.centre = (self.root + self.rho) * np.array([np.cos(self.gap_angle), np.sin(self.gap_angle)])
        start = self.involute(self.form_roll) - self.centre
        self.arc_from = np.arctan2(start[1], start[0])
        self.arc_to = self.gap_angle + np.pi  # towards the axis
        self.arc_to = self.arc_from + (self.arc_to - self.arc_from + np.pi) % (2 * np.pi) - np.pi

    def flank_angle(self, roll):
        return self.half_at_base - roll + np.arctan(roll)

    def involute(self, roll):
        angle, radius = self.flank_angle(roll), self.base * np.sqrt(1 + roll**2)
        return radius * np.array([np.cos(angle), np.sin(angle)])

    def normal(self, roll):
        """Into the tooth, in the transverse plane: the line of action's direction there."""
        angle = self.flank_angle(roll) - np.arctan(roll)
        return np.array(
            [np.sin(angle), -np.cos(angle)]
        )  # at the base circle the tangent, seen from the flank inwards

    def fillet(self, fraction):
        angle = self.arc_from + fraction * (self.arc_to - self.arc_from)
        out = np.array([np.cos(angle), np.sin(angle)])
        return self.centre + self.rho * out, out

    def spread(self, xyz):
        """What is left of points on left flanks after untwisting and taking off the involute's angle:
        the tooth's own angle.
        """
        radius = np.hypot(xyz[:, 0], xyz[:, 1])
        roll = np.sqrt(np.maximum(radius**2 / self.base**2 - 1, 0))
        return np.arctan2(xyz[:, 1], xyz[:, 0]) - self.twist * xyz[:, 2] - self.flank_angle(roll), roll


def halved(ends):
    """Where elements end, or how many equal ones there are from 0 to 1, and their middles between."""
    ends = np.linspace(0, 1, ends + 1) if np.ndim(ends) == 0 else np.asarray(ends)
    return np.interp(np.arange(2 * len(ends) - 1) / 2, np.arange(len(ends)), ends)


class Mesh:
    """A segment of three teeth in C3D20 (fully integrated: C3D20R swings under line loads here):
    a layer of equal thickness along the whole outline, a core of the tooth, a rim.
    """

    def __init__(self, tooth, layers_z, fine, coarse, refined=1.0):
        """layers_z: along the face, or where they end, from 0 to 1; fine, coarse: elements of the middle
        tooth and those beside over half the root land, the fillet, the involute (or where its elements
        end, as fractions of the square of the roll angle) and across the core; refined: as many times the
        elements below the surface and in the rim.
        """
        self.tooth = tooth
        depth = np.array([0, 0.06, 0.14, 0.26, 0.44, 0.7])
        below = np.linspace(0, len(depth) - 1, round(refined * (len(depth) - 1)) + 1)
        self.depth = np.interp(below, np.arange(len(depth)), depth) * tooth.rho * 0.85  # below the surface
        remaining, first = tooth.root - tooth.bore - self.depth[-1], 0.45 * tooth.rho / refined
        ratio = np.linspace(1.01, 3, 2000)
        count = round(8 * refined)
        ratio = ratio[np.argmin(abs(first * (ratio**count - 1) / (ratio - 1) - remaining))]
        self.rim = np.concatenate([[0], np.cumsum(ratio ** np.arange(count))])
        self.rim /= self.rim[-1]
        self.points, self.index, self.quads, self.fillet_nodes = [], {}, [], {}
        self.fillet_quads = []
        for place, numbers in ((-1, coarse), (0, fine), (1, coarse)):
            self.sector(place, *numbers)
        self.extrude(layers_z)

    def node(self, point):
        key = (round(point[0] * 1e6), round(point[1] * 1e6))
        for dx in (0, -1, 1):
            for dy in (0, -1, 1):
                if (key[0] + dx, key[1] + dy) in self.index:
                    return self.index[key[0] + dx, key[1] + dy]
        self.index[key] = len(self.points)
        self.points.append(point)
        return self.index[key]

    def outline(self, land, fillet, involute):
        """Half the outline from the gap's middle to the tip, at half steps: points,
        inward vectors of unit depth, kinds.
        """
        tooth, points, inward = self.tooth, [], []
        for i in range(2 * land):
            angle = tooth.pitch / 2 + (tooth.gap_angle - tooth.pitch / 2) * i / (2 * land)
            out = np.array([np.cos(angle), np.sin(angle)])
            points.append(tooth.root * out), inward.append(-out)
        for i in range(2 * fillet):
            point, into = tooth.fillet(1 - i / (2 * fillet))
            points.append(point), inward.append(into)
        q = tooth.form_roll**2 + (tooth.tip_roll**2 - tooth.form_roll**2) * halved(involute)
        for k, r in enumerate(np.sqrt(q)):
            # Leans from the normal at the fillet to the circle's tangent at the tip,
            # with as much depth below the surface.
            lean = np.arctan(r) * k / (len(q) - 1)
            n = tooth.normal(r)
            c, s = np.cos(lean), np.sin(lean)
            points.append(tooth.involute(r)), inward.append(
                np.array([c * n[0] - s * n[1], s * n[0] + c * n[1]]) / c
            )
        self.rolls = np.sqrt(q)
        return np.array(points), np.array(inward)

    def block(self, lattice, place, remember=None):
        """lattice[i, j]: points at half steps.
        Adds its quadrilaterals with eight nodes each, counter-clockwise.
        """
        c, s = np.cos(place * self.tooth.pitch), np.sin(place * self.tooth.pitch)
        turned = lattice @ np.array([[c, s], [-s, c]])
        ids = np.array(
            [
                [self.node(p) if not (i % 2 and j % 2) else -1 for j, p in enumerate(row)]
                for i, row in enumerate(turned)
            ]
        )
        for i in range(0, len(ids) - 1, 2):
            for j in range(0, ids.shape[1] - 1, 2):
                corners = [(i, j), (i + 2, j), (i + 2, j + 2), (i, j + 2)]
                x = np.array([turned[k] for k in corners])
                if np.dot(x[:, 0], np.roll(x[:, 1], -1)) - np.dot(x[:, 1], np.roll(x[:, 0], -1)) < 0:
                    corners = [corners[0], corners[3], corners[2], corners[1]]
                middles = [
                    ((a[0] + b[0]) // 2, (a[1] + b[1]) // 2)
                    for a, b in zip(corners, corners[1:] + corners[:1])
                ]
                if remember is not None and j == 0:
                    remember[i // 2] = len(self.quads)
                self.quads.append([ids[k] for k in corners + middles])
        return ids

    def sector(self, place, land, fillet, involute, columns):
        tooth = self.tooth
        points, inward = self.outline(land, fillet, involute)
        mirror = np.array([1, -1])
        depth = halved(self.depth)
        layer = points[:, None] + depth[None, :, None] * inward[:, None]
        # Core and rim begin on the layer's inner side, they meet in the middle of the fillet.
        inner, middle = layer[:, -1], 2 * land + fillet
        assert fillet % 2 == 0
        across = 1 - np.arange(2 * columns + 1) / columns
        angle, radius = np.arctan2(inner[middle:, 1], inner[middle:, 0]), np.hypot(
            inner[middle:, 0], inner[middle:, 1]
        )
        core = np.stack(
            [
                radius[:, None] * np.cos(angle[:, None] * across),
                radius[:, None] * np.sin(angle[:, None] * across),
            ],
            axis=2,
        )
        # The layer's end at the tip leaves the tip circle by little: put it back.
        for lattice, row in ((layer, -1), (core, -1)):
            lattice[row] *= (tooth.tip / np.hypot(lattice[row, :, 0], lattice[row, :, 1]))[:, None]
        core[-1, [0, -1]] = layer[-1, -1], layer[-1, -1] * mirror
        top = np.concatenate([inner[: middle + 1], core[0, 1:-1], (inner[: middle + 1] * mirror)[::-1]])
        bore_angle = tooth.pitch / 2 * np.linspace(1, -1, len(top))
        bottom = tooth.bore * np.column_stack([np.cos(bore_angle), np.sin(bore_angle)])
        rim = top[:, None] + halved(self.rim)[None, :, None] * (bottom - top)[:, None]

        quads = {}, {}
        left, right = self.block(layer, place, quads[0]), self.block(layer * mirror, place, quads[1])
        self.block(core, place)
        self.block(rim, place)
        arc = slice(2 * land, 2 * land + 2 * fillet + 1)
        self.fillet_nodes[place] = (left[arc, 0], right[arc, 0])
        self.fillet_quads += [side[k] for side in quads for k in range(land, land + fillet)]
        first = (2 * land + 2 * fillet) // 2
        if place == 0:
            self.flank_rolls = self.rolls
            self.flank_faces = [
                [left[k, 0] for k in (2 * (first + r), 2 * (first + r) + 1, 2 * (first + r) + 2)]
                for r in range(len(self.rolls) // 2)
            ]

    def extrude(self, layers):
        flat, self.z = np.array(self.points), self.tooth.width * (halved(layers) - 0.5)
        planes = len(self.z)
        corner = np.zeros(len(flat), bool)
        for quad in self.quads:
            corner[quad[:4]] = True
        self.id = np.zeros((planes, len(flat)), int)
        nodes = []
        for k, z in enumerate(self.z):
            c, s = np.cos(self.tooth.twist * z), np.sin(self.tooth.twist * z)
            for n, (x, y) in enumerate(flat):
                if k % 2 == 0 or corner[n]:
                    nodes.append((c * x - s * y, s * x + c * y, z))
                    self.id[k, n] = len(nodes)
        self.nodes = np.array(nodes)
        self.hexes = []
        for k in range(0, planes - 1, 2):
            for quad in self.quads:
                low, mid, up = self.id[k], self.id[k + 1], self.id[k + 2]
                self.hexes.append(
                    [*low[quad[:4]], *up[quad[:4]], *low[quad[4:]], *up[quad[4:]], *mid[quad[:4]]]
                )
        radius, angle = np.hypot(*flat.T), np.arctan2(flat[:, 1], flat[:, 0])
        self.bore = self.id[:, radius < self.tooth.bore + 1e-6]
        self.cuts = self.id[:, abs(abs(angle) - 1.5 * self.tooth.pitch) < 1e-9]

    def fillet_hexes(self):
        return [
            self.hexes[k * len(self.quads) + q] for k in range(len(self.z) // 2) for q in self.fillet_quads
        ]

    def load(self, roll, z, force):
        """Nodal forces of point forces on the middle tooth's left flank along its inward normal."""
        tooth, result = self.tooth, defaultdict(lambda: np.zeros(3))
        q, qs = roll**2, self.flank_rolls**2
        row = np.clip(np.searchsorted(qs[::2], q) - 1, 0, len(self.flank_faces) - 1)
        layer = np.clip(np.searchsorted(self.z[::2], z) - 1, 0, len(self.z) // 2 - 1)
        for i in range(len(roll)):
            u = 2 * (q[i] - qs[2 * row[i]]) / (qs[2 * row[i] + 2] - qs[2 * row[i]]) - 1
            v = 2 * (z[i] - self.z[2 * layer[i]]) / (self.z[2 * layer[i] + 2] - self.z[2 * layer[i]]) - 1
            face = self.flank_faces[row[i]]
            low, mid, up = (self.id[2 * layer[i] + k] for k in range(3))
            corners = [
                (-1, -1, low[face[0]]),
                (1, -1, low[face[2]]),
                (1, 1, up[face[2]]),
                (-1, 1, up[face[0]]),
            ]
            shapes = [((1 + a * u) * (1 + b * v) * (a * u + b * v - 1) / 4, n) for a, b, n in corners]
            shapes += [((1 - u * u) * (1 + b * v) / 2, n) for b, n in ((-1, low[face[1]]), (1, up[face[1]]))]
            shapes += [((1 - v * v) * (1 + a * u) / 2, n) for a, n in ((-1, mid[face[0]]), (1, mid[face[2]]))]
            # The surface x(roll, z) turned by the twist; its normal from the two tangents.
            r, turn = tooth.base * np.sqrt(1 + roll[i] ** 2), tooth.twist * z[i]
            n = tooth.normal(roll[i])
            c, s = np.cos(turn), np.sin(turn)
            n = np.array([c * n[0] - s * n[1], s * n[0] + c * n[1]])
            a = tooth.flank_angle(roll[i]) + turn
            along_z = tooth.twist * r * np.array([-np.sin(a), np.cos(a)])
            normal = np.array([*n, -n @ along_z])
            normal *= force[i] / np.linalg.norm(normal)
            for weight, node in shapes:
                result[node] += weight * normal
        return result
