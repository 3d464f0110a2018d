#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
# Root stress of Flank against CalculiX: the tooth of the case file, meshed again (quadratic hexahedra of
# another layout, finer in the fillets), under the contact forces that Flank solved for.
# root_stress.py CASE.toml WORK POSITION free|clamped NAME LEVEL=FOLDER...: folders of results, of which the
# last gives the forces; segments of three teeth. CalculiX solves on finer and finer meshes, in every
# direction of the section, until its own greatest stress in every loaded fillet that it resolves changes by
# less than 0.3 %; where it never does, nothing is judged and the exit code is 1. It is 1, too, if the
# greatest stress over the face of such a fillet differs by more than a level claims; a fillet that
# CalculiX's mesh does not resolve (its own nodal stress and that of its displacements differ by 3 %) is
# shown and not judged. Needs numpy and ccx.
import argparse
import csv
import os
import sys
import tomllib
from collections import defaultdict

import numpy as np

import calculix
import vtu
from tooth_mesh import Mesh, Tooth

RESOLVED = 3.0  # percent, of CalculiX's two evaluations
CONVERGED = 0.3  # percent, from a mesh of CalculiX to the next
NODAL = "(its nodal stress)"  # beside the results of the runs: CalculiX's other evaluation


def node_stress(mesh, moved):
    """Stress from the displacements, in the elements' nodes, averaged over the
    fillet's elements that share a node.
    """
    sums, counts = defaultdict(lambda: np.zeros(6)), defaultdict(int)
    for hexa in mesh.fillet_hexes():
        x, u = mesh.nodes[np.array(hexa) - 1], np.array([moved[n] for n in hexa])
        stress, _ = calculix.stress(x, u, calculix.CORNERS, mesh.tooth.young, mesh.tooth.poisson)
        for n, t in zip(hexa, stress):
            sums[n] += [t[0, 0], t[1, 1], t[2, 2], t[0, 1], t[1, 2], t[0, 2]]
            counts[n] += 1
    return {n: sums[n] / counts[n] for n in sums}


def solved(mesh, loads, clamped_cuts, path, wanted):
    with open(path + ".inp", "w") as file:
        file.write("*NODE, NSET=ALL\n")
        for i, (x, y, z) in enumerate(mesh.nodes, 1):
            file.write(f"{i}, {x:.12g}, {y:.12g}, {z:.12g}\n")
        file.write("*ELEMENT, TYPE=C3D20, ELSET=ALL\n")
        for i, nodes in enumerate(mesh.hexes, 1):
            file.write(
                f"{i}, " + ", ".join(map(str, nodes[:10])) + ",\n" + ", ".join(map(str, nodes[10:])) + "\n"
            )
        held = np.unique(np.concatenate([mesh.bore.ravel()] + ([mesh.cuts.ravel()] if clamped_cuts else [])))
        for name, ids in (("HELD", held[held > 0]), ("WANTED", sorted(wanted))):
            file.write(f"*NSET, NSET={name}\n")
            calculix.write_list(file, ids)
        file.write(
            f"*MATERIAL, NAME=STEEL\n*ELASTIC\n{mesh.tooth.young:.9g}, {mesh.tooth.poisson:.9g}\n"
            "*SOLID SECTION, ELSET=ALL, MATERIAL=STEEL\n"
        )
        file.write("*BOUNDARY\nHELD, 1, 3\n")
        for load in loads:
            file.write("*STEP\n*STATIC\n*CLOAD, OP=NEW\n")
            for node, force in load.items():
                for k in range(3):
                    file.write(f"{node}, {k + 1}, {force[k]:.9e}\n")
            file.write("*NODE PRINT, NSET=WANTED\nU\n*EL FILE, NSET=WANTED\nS\n*END STEP\n")
    seconds = calculix.run(path)
    own = [node_stress(mesh, moved) for moved in calculix.displacements(path + ".dat")]
    return own, calculix.frd(path + ".frd"), seconds


def greatest(tensors):
    xx, yy, zz, xy, yz, zx = np.array(tensors).T
    return np.linalg.eigvalsh(np.array([[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]]).transpose(2, 0, 1))[:, 2]


def turn(tensors, angle):
    """About z, in CalculiX's order xx, yy, zz, xy, yz, zx."""
    xx, yy, zz, xy, yz, zx = np.array(tensors).T
    c, s = np.cos(angle), np.sin(angle)
    return np.column_stack(
        [
            c * c * xx + s * s * yy - 2 * c * s * xy,
            s * s * xx + c * c * yy + 2 * c * s * xy,
            zz,
            c * s * (xx - yy) + (c * c - s * s) * xy,
            s * zx + c * yz,
            c * zx - s * yz,
        ]
    )


def superposed(mesh, teeth, steps):
    """Greatest principal stress over the arc by tooth and fillet.
    A segment of Flank stands around the loaded tooth: one load case a loaded tooth,
    and what it does to its neighbours is turned and added.
    """
    result, arc_to = {}, np.linspace(0, 1, max(len(sides[0]) for sides in mesh.fillet_nodes.values()))
    for number in teeth:
        for side, fillet in enumerate(("loaded", "other")):
            along = []
            for k in range(len(mesh.z)):
                total = 0
                for loaded, step in zip(teeth, steps):
                    if abs(at := number - loaded) > 1:
                        continue
                    ids = mesh.id[k, mesh.fillet_nodes[at][side]]
                    there = ids > 0
                    local = turn([step[n] for n in ids[there]], -at * mesh.tooth.pitch)
                    # Neighbours have other nodes: linear along the arc between them.
                    if at:
                        to = arc_to if k % 2 == 0 else arc_to[::2]
                        local = np.column_stack(
                            [np.interp(to, np.linspace(0, 1, len(ids))[there], c) for c in local.T]
                        )
                    total = total + local
                along.append(greatest(total).max())
            result[number, fillet] = np.column_stack([mesh.z, along])
    return result


def root_stress(folder, position):
    """Profiles (z, MPa) by tooth and fillet, and the torque."""
    result = defaultdict(list)
    lines = (line for line in open(os.path.join(folder, "root_stress.csv")) if not line.startswith("#"))
    for row in csv.DictReader(lines):
        if row["body"] == "pinion" and int(row["position"]) == position:
            result[int(row["pair"]), row["fillet"]].append(
                (float(row["z_mm"]), float(row["tensile_stress_MPa"]))
            )
            torque = row["torque_Nm"]
    return {key: np.array(value) for key, value in result.items()}, torque


def options():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("case"), arguments.add_argument("work"), arguments.add_argument(
        "position", type=int
    )
    arguments.add_argument("cuts", choices=("free", "clamped")), arguments.add_argument("name")
    arguments.add_argument("runs", nargs="+", help="NAME=FOLDER")
    arguments.add_argument("--layers", type=int, default=16)
    arguments.add_argument(
        "--fine", default="2,12,6,6", help="elements: half root land, fillet, involute, across"
    )
    arguments.add_argument("--coarse", default="1,4,2,6", help="the same of the teeth beside")
    arguments.add_argument("--refined", default="1,1.5,2", help="as many times these, mesh by mesh")
    arguments.add_argument("--bound", action="append", default=[], help="LEVEL=PERCENT: what it claims")
    return arguments.parse_args()


def contact_forces(tooth, path, torque):
    """The loaded cells on the pinion: roll angles and z of their corners, forces, numbers of their teeth."""
    contact = vtu.read(path)
    of_pinion = (contact["body_1_pinion_2_gear"] == 1) & (contact["force_N"] > 0)
    corners = contact["points"][of_pinion].astype(float).reshape(-1, 4, 3)
    force = contact["force_N"][of_pinion].reshape(-1, 4)[:, 0].astype(float)
    pair = contact["tooth_pair"][of_pinion].reshape(-1, 4)[:, 0].round().astype(int)
    own, roll = tooth.spread(corners.reshape(-1, 3))
    own, roll = own.reshape(-1, 4), roll.reshape(-1, 4)
    place = own - pair[:, None] * tooth.pitch
    place = (place + np.pi) % (2 * np.pi) - np.pi
    print(
        f"  corners of {len(force)} loaded cells lie on the flank within "
        f"{1e3 * tooth.base * np.ptp(place):.3f} um"
    )
    assert np.ptp(place) * tooth.base < 1e-3
    moment = sum(force) * tooth.base / np.sqrt(1 + (tooth.twist * tooth.base) ** 2) / 1000
    print(f"  their forces make {moment:.4f} N m of {torque}")
    return roll, corners[:, :, 2], force, pair


def load_of(mesh, roll, z, force):
    """The load case of one tooth: each cell's force spread over 3 by 3 points of it."""
    gauss, weight = np.polynomial.legendre.leggauss(3)
    q = roll**2
    points = []
    for a, wa in zip(gauss, weight):
        for b, wb in zip(gauss, weight):
            shape = (
                np.array([(1 - a) * (1 - b), (1 + a) * (1 - b), (1 - a) * (1 + b), (1 + a) * (1 + b)]) / 4
            )
            points.append((np.sqrt(q @ shape), z @ shape, force * wa * wb / 4))
    return mesh.load(*(np.concatenate(k) for k in zip(*points)))


def resolved(solution, nodal, key):
    """Whether CalculiX's two evaluations agree: its mesh can judge."""
    return abs(nodal[key][:, 1].max() / solution[key][:, 1].max() - 1) < RESOLVED / 100


def judged(solution, nodal):
    return [key for key in sorted(solution) if key[1] == "loaded" and resolved(solution, nodal, key)]


def show_greatest(solution, nodal, profiles):
    """A line a fillet: the greatest stress over the face of CalculiX and of each run.
    Returns the greatest difference of each run in a loaded fillet that CalculiX's mesh resolves, in percent.
    """
    print(f"  {'tooth fillet':14} {'CalculiX':>10}  " + "  ".join(f"{name:>18}" for name in profiles))
    worst = dict.fromkeys(profiles, 0.0)
    for key in sorted(solution):
        reference = solution[key][:, 1].max()
        cells = []
        for name in profiles:
            value = profiles[name][key][:, 1].max()
            percent = 100 * (value - reference) / reference
            cells.append(f"{value:9.2f} {percent:+6.2f} %")
            if key in judged(solution, nodal):
                worst[name] = max(worst[name], abs(percent))
        print(
            f"  {key[0]:5d} {key[1]:8} {reference:10.2f}  "
            + "  ".join(f"{c:>18}" for c in cells)
            + ("" if key[1] == "other" or resolved(solution, nodal, key) else "  (not resolved by CalculiX)")
        )
    return worst


def write_profiles(path, solution, profiles, names):
    """The stress along the face of every fillet, where CalculiX's mesh has nodes."""
    with open(path, "w") as file:
        file.write("tooth,fillet,z_mm," + ",".join(["CalculiX_MPa"] + [n + "_MPa" for n in names]) + "\n")
        for key in sorted(solution):
            for z, value in solution[key]:
                row = [np.interp(z, *profiles[n][key].T) for n in names]
                file.write(
                    f"{key[0]},{key[1]},{z:.4f},{value:.3f}," + ",".join(f"{r:.3f}" for r in row) + "\n"
                )


def converged(given, tooth, roll, z, force, pair):
    """CalculiX's stress by tooth and fillet, and its nodal evaluation, on the first mesh from which on the
    greatest one keeps still.
    """
    fine, coarse = (tuple(map(int, numbers.split(","))) for numbers in (given.fine, given.coarse))
    teeth, before, change = sorted(set(pair)), None, np.inf
    for refined in map(float, given.refined.split(",")):
        finer = lambda n: round(refined * n) if n % 2 else 2 * round(refined * n / 2)  # even stays even
        numbers = [[finer(n) for n in of] for of in (fine, coarse)]
        mesh = Mesh(tooth, given.layers, *numbers, refined)
        loads = [load_of(mesh, roll[pair == one], z[pair == one], force[pair == one]) for one in teeth]
        wanted = set(np.unique(mesh.fillet_hexes()).tolist())
        path = os.path.abspath(os.path.join(given.work, f"{given.name}_{refined:g}"))
        steps, nodal_steps, seconds = solved(mesh, loads, given.cuts == "clamped", path, wanted)
        solution, nodal = superposed(mesh, teeth, steps), superposed(mesh, teeth, nodal_steps)
        greatest_of = {key: solution[key][:, 1].max() for key in judged(solution, nodal)}
        print(
            f"  CalculiX, {'x'.join(map(str, numbers[0]))}: {len(mesh.hexes)} C3D20, "
            f"{3 * len(mesh.nodes)} unknowns, {len(steps)} load cases, {seconds:.0f} s: "
            + ", ".join(f"{value:.2f}" for value in greatest_of.values()),
            flush=True,
        )
        if before:
            change = max(abs(100 * (value / before[key] - 1)) for key, value in greatest_of.items())
            if change < CONVERGED:
                return solution, nodal
        before = {key: solution[key][:, 1].max() for key in solution}
    sys.exit(f"  CalculiX's own stress still changes by {change:.2f} %: it cannot judge")


def main():
    given = options()
    tooth = Tooth(tomllib.load(open(given.case, "rb")))
    runs = [run.split("=", 1) for run in given.runs]
    profiles = {name: root_stress(folder, given.position)[0] for name, folder in runs}
    last = runs[-1][1]
    torque = root_stress(last, given.position)[1]
    fields = os.path.join(last, f"fields/contact_{torque}Nm_position_{given.position:04d}.vtu")
    solution, nodal = converged(given, tooth, *contact_forces(tooth, fields, torque))
    profiles[NODAL] = nodal
    worst = show_greatest(solution, nodal, profiles)
    names = list(profiles)
    write_profiles(os.path.join(given.work, f"{given.name}_profiles.csv"), solution, profiles, names)
    failed = False
    for level, bound in (text.split("=") for text in given.bound):
        print(f"  {level}: greatest difference {worst[level]:.2f} % (it claims {bound} %)")
        failed = failed or worst[level] > float(bound)
    sys.exit(1 if failed else 0)


main()
