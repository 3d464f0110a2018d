#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
# Where one helical tooth pair carries along its face, ends included, against CalculiX's own contact: both
# teeth meshed again from the case file (quadratic bricks of another layout, fine at the flanks and towards
# their ends), placed by the law of gearing and turned by Flank's transmission error. CalculiX finds what
# presses where.
# contact.py CASE.toml FOLDER POSITION WORK [--share PERCENT] [--force PERCENT]: FOLDER of a run of segments
# of three teeth with clamped cut faces, one torque, the field of the contact at POSITION, and one tooth pair
# in contact, without modifications where it touches. Strips along the face overlap (hats between planes of
# the mesh), so that either program's forces belong to them without cutting an element. Exit code 1 if a
# strip's part of the force, or the whole force, differs by more. Needs numpy and ccx.
import argparse
import csv
import glob
import os
import sys
import tomllib

import numpy as np

import calculix
import vtu
from tooth_mesh import Mesh, Tooth

PENALTY = 5e7  # MPa per mm of overlap: 0.01 um at 500 MPa
STRIP = 0.7  # mm, from the middle of a strip to the next, at least
# mm: along the profile, first layer, others; elements below the surface and in the rim
SIZES = {"coarse": (0.30, 0.35, 1.8, 0.75), "fine": (0.18, 0.20, 1.2, 1)}


def strip_middles(planes):
    """Where strips have their middles: planes between layers, so that hats between them are the elements'
    own, at least STRIP apart.
    """
    half = [planes[0]]
    for plane in planes[planes <= 0]:
        if plane - half[-1] > STRIP:
            half.append(plane)
    return np.array(half + [-plane for plane in half[::-1] if plane < -1e-6])


def strips(middles, z, force):
    """Forces weighted by the hats over these places along the face."""
    return np.array([np.sum(force * np.interp(z, middles, unit)) for unit in np.eye(len(middles))])


def growing(length, first, greatest):
    """Ends of elements over a length, each longer than the one before by two fifths, up to a greatest."""
    steps = [first]
    while sum(steps) < length:
        steps.append(min(1.4 * steps[-1], greatest))
    steps = np.array(steps[:-1] if len(steps) > 1 else steps)
    return np.cumsum(steps) * length / sum(steps)


def layers(width, first, greatest):
    """Where layers end along the face, as fractions: thin at both ends."""
    half = np.concatenate([[0], growing(width / 2, first, greatest)])
    return np.concatenate([half, width - half[-2::-1]]) / width


def rows(tooth, low, high, size):
    """Where elements end along the involute, as fractions of the squares of roll angles (of arc length): of
    one size between two roll angles, growing away from them.
    """
    arc = lambda roll: tooth.base * roll**2 / 2
    start, end = arc(tooth.form_roll), arc(tooth.tip_roll)
    low, high = max(arc(low), start + size), min(arc(high), end - size)
    places = [
        low - growing(low - start, size, 6 * size)[::-1],
        np.linspace(low, high, round((high - low) / size) + 1),
        high + growing(end - high, size, 6 * size),
    ]
    return (np.concatenate(places) - start) / (end - start)


class Placed:
    """A body's mesh, turned about its axis and put in its place; its nodes' and elements' numbers go on from
    others'.
    """

    def __init__(self, name, mesh, after, angle, shift):
        self.name, self.tooth = name, mesh.tooth
        self.first_node, self.first_element = after
        c, s = np.cos(angle), np.sin(angle)
        x, y, z = mesh.nodes.T
        self.nodes = np.column_stack([c * x - s * y + shift, s * x + c * y, z])
        self.hexes = np.array(mesh.hexes) + self.first_node
        self.planes = mesh.z[::2]
        held = np.unique(np.concatenate([mesh.bore.ravel(), mesh.cuts.ravel()]))
        self.held = held[held > 0] + self.first_node
        flank = {n + self.first_node for face in mesh.flank_faces for n in mesh.id[:, face].ravel() if n > 0}
        self.flank = np.array(sorted(flank))
        on = np.isin(self.hexes, self.flank)
        sides = {"S3": [0, 1, 5, 4], "S4": [1, 2, 6, 5], "S5": [2, 3, 7, 6], "S6": [3, 0, 4, 7]}
        self.faces = [(e, side) for side, at in sides.items() for e in np.where(on[:, at].all(1))[0]]
        self.at_flank = self.hexes[on.any(1)]

    def place(self, nodes):
        return self.nodes[np.asarray(nodes) - self.first_node - 1]

    def following(self):
        return self.first_node + len(self.nodes), self.first_element + len(self.hexes)


def write_body(file, body):
    file.write("*NODE, NSET=ALL\n")
    for i, (x, y, z) in enumerate(body.nodes, body.first_node + 1):
        file.write(f"{i}, {x:.12g}, {y:.12g}, {z:.12g}\n")
    file.write(f"*ELEMENT, TYPE=C3D20, ELSET={body.name}\n")
    for i, nodes in enumerate(body.hexes, body.first_element + 1):
        file.write(f"{i}, {', '.join(map(str, nodes[:10]))},\n{', '.join(map(str, nodes[10:]))}\n")
    file.write(
        f"*MATERIAL, NAME=OF_{body.name}\n*ELASTIC\n{body.tooth.young:.9g}, {body.tooth.poisson:.9g}\n"
        f"*SOLID SECTION, ELSET={body.name}, MATERIAL=OF_{body.name}\n"
        f"*SURFACE, NAME=FLANK_{body.name}, TYPE=ELEMENT\n"
    )
    for element, side in body.faces:
        file.write(f"{element + body.first_element + 1}, {side}\n")
    file.write(f"*NSET, NSET=NEAR_{body.name}\n")
    calculix.write_list(file, np.unique(body.at_flank))


def write(path, pinion, gear, turn):
    """One step: the gear held, the pinion's bore and cuts turned by an angle [rad], frictionless contact."""
    with open(path + ".inp", "w") as file:
        for body in (pinion, gear):
            write_body(file, body)
        file.write(
            "*SURFACE INTERACTION, NAME=TOUCH\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n"
            f"{PENALTY:g}\n"
            "*CONTACT PAIR, INTERACTION=TOUCH, TYPE=SURFACE TO SURFACE\nFLANK_PINION, FLANK_GEAR\n"
            "*STEP, INC=100\n*STATIC\n1., 1.\n*BOUNDARY\n"
        )
        for node in gear.held:
            file.write(f"{node}, 1, 3, 0.\n")
        for node, (x, y, z) in zip(pinion.held, pinion.place(pinion.held)):
            file.write(f"{node}, 1, 1, {-turn * y:.12e}\n{node}, 2, 2, {turn * x:.12e}\n{node}, 3, 3, 0.\n")
        for body in (pinion, gear):
            file.write(f"*NODE PRINT, NSET=NEAR_{body.name}\nU\n")
        file.write("*END STEP\n")


def pair_of_meshes(case, phase, sizes):
    """Both bodies, in contact without load: the pinion's middle tooth's left flank on the gear's, a
    transverse pitch times the phase beyond the pitch point at mid-face.
    """
    size, first, greatest, refined = sizes
    teeth = {name: Tooth(case, name) for name in ("pinion", "gear")}
    pinion, gear = teeth["pinion"], teeth["gear"]
    distance = case["pair"]["centre_distance_mm"]
    assert abs(pinion.twist * pinion.base + gear.twist * gear.base) < 1e-9
    pressure_angle = np.arccos((pinion.base + gear.base) / distance)
    angles, bodies, after = {}, [], (0, 0)
    for name, tooth in teeth.items():
        sign = 1 if name == "pinion" else -1
        roll = np.tan(pressure_angle) + sign * phase * pinion.pitch * pinion.base / tooth.base
        # A flank's roll angle where it meets the line of action: its half angle at the base circle, the
        # tooth's turn, the twist, and the pressure angle together.
        angle = roll - tooth.half_at_base - pressure_angle
        reach = abs(tooth.twist) * tooth.width / 2 + 1.5 * size / (tooth.base * roll)
        low, high = np.degrees(roll - reach), np.degrees(roll + reach)
        print(f"  {name}: turned by {np.degrees(angle):.4f} deg, rolls {low:.2f} to {high:.2f}")
        numbers = [1, 4, rows(tooth, roll - reach, roll + reach, size), 4], [1, 2, 2, 4]
        mesh = Mesh(tooth, layers(tooth.width, first, greatest), *numbers, refined)
        bodies.append(Placed(name.upper(), mesh, after, angle + (sign < 0) * np.pi, (sign < 0) * distance))
        after = bodies[-1].following()
    return bodies


def calculix_forces(path, bodies):
    """Normal forces at the nodes of each flank: z, force along the common normal [N]."""
    moved = calculix.displacements(path + ".dat")
    moved = {node: u for part in moved for node, u in part.items()}
    result = []
    for body in bodies:
        forces = calculix.node_forces(body.place, body.at_flank, moved, body.tooth.young, body.tooth.poisson)
        vectors = np.array([forces[n] for n in body.flank])
        total = vectors.sum(0)
        result.append((body.place(body.flank)[:, 2], vectors @ total / np.linalg.norm(total)))
    return result


def flank_run(folder, position):
    """Transmission error [mm], phase; z and force of points of the cells on the pinion's flank."""
    lines = (line for line in open(os.path.join(folder, "te.csv")) if not line.startswith("#"))
    row = next(row for row in csv.DictReader(lines) if int(row["position"]) == position)
    assert row["contacts"] == "1", "more than one tooth pair carries"
    (path,) = glob.glob(os.path.join(folder, f"fields/contact_*Nm_position_{position:04d}.vtu"))
    contact = vtu.read(path)
    on = contact["body_1_pinion_2_gear"] == 1
    z = contact["points"][on, 2].reshape(-1, 4).astype(float)
    force = contact["force_N"][on].reshape(-1, 4)[:, 0].astype(float)
    steps = (np.arange(8) + 0.5) / 8  # a cell's force spread evenly from end to end
    low, high = z.min(1), z.max(1)
    places = low[:, None] + (high - low)[:, None] * steps
    spread = np.repeat(force[:, None] / len(steps), len(steps), 1)
    return float(row["te_um"]) / 1000, float(row["phase"]), places.ravel(), spread.ravel()


def main():
    arguments = argparse.ArgumentParser()
    for name, kind in (("case", str), ("folder", str), ("position", int), ("work", str)):
        arguments.add_argument(name, type=kind)
    arguments.add_argument("--mesh", choices=SIZES, default="fine")
    arguments.add_argument("--solved", action="store_true", help="compare again what CalculiX found in WORK")
    arguments.add_argument("--share", type=float, default=2, help="percent of a strip's part of the force")
    arguments.add_argument("--force", type=float, default=1, help="percent of the whole force")
    given = arguments.parse_args()
    case = tomllib.load(open(given.case, "rb"))
    error, phase, z, force = flank_run(given.folder, given.position)
    bodies = pair_of_meshes(case, phase, SIZES[given.mesh])
    path = os.path.abspath(os.path.join(given.work, f"contact_{given.mesh}"))
    if not given.solved:
        write(path, *bodies, error / bodies[0].tooth.base)
    elements, unknowns = (sum(len(of(b)) for b in bodies) for of in (lambda b: b.hexes, lambda b: b.nodes))
    print(f"  {elements} C3D20, {3 * unknowns} unknowns", flush=True)
    seconds = 0 if given.solved else calculix.run(path)
    middles = strip_middles(bodies[0].planes)
    (z_pinion, f_pinion), (z_gear, f_gear) = calculix_forces(path, bodies)
    ours, theirs, gear = (
        strips(middles, *of) for of in ((z, force), (z_pinion, f_pinion), (z_gear, f_gear))
    )
    print(
        f"  CalculiX: {seconds:.0f} s; {theirs.sum():.1f} N on the pinion, {gear.sum():.1f} N on the gear; "
        f"ours {ours.sum():.1f} N"
    )
    print(f"  {'z mm':>8} {'CalculiX N':>11} {'on the gear':>11} {'ours N':>9} {'part differs by':>17}")
    worst = 0
    for place, a, b, c in zip(middles, theirs, gear, ours):
        percent = 100 * (c / ours.sum() / (a / theirs.sum()) - 1)
        worst = max(worst, abs(percent))
        print(f"  {place:8.3f} {a:11.3f} {b:11.3f} {c:9.3f} {percent:15.2f} %")
    whole = 100 * (ours.sum() / theirs.sum() - 1)
    print(
        f"  whole force {whole:+.2f} % (allowed {given.force} %), parts at most {worst:.2f} % "
        f"(allowed {given.share} %)"
    )
    sys.exit(1 if worst > given.share or abs(whole) > given.force else 0)


main()
