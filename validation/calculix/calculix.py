# SPDX-License-Identifier: GPL-2.0-or-later
"""CalculiX (ccx) as a program: its input, its results, and what follows from displacements of its quadratic
bricks (C3D20).
"""
import os
import subprocess
import sys
import time

import numpy as np


def write_list(file, ids):
    ids = list(ids)
    for k in range(0, len(ids), 12):
        file.write(", ".join(str(i) for i in ids[k : k + 12]) + ",\n")


def run(path):
    """Solves path.inp, returns the seconds that it took."""
    start = time.time()
    done = subprocess.run(
        ["ccx", "-i", os.path.basename(path)], cwd=os.path.dirname(path), capture_output=True, text=True
    )
    if done.returncode or "ERROR" in done.stdout or not os.path.exists(path + ".frd"):
        sys.exit(f"CalculiX failed:\n{done.stdout[-3000:]}{done.stderr[-1000:]}")
    return time.time() - start


def frd(path):
    """Stress tensor by step and node, as CalculiX extrapolates and averages it."""
    steps, kind = [], None
    for line in open(path):
        if line.startswith(" -4"):
            kind = line[5:13].strip()
            if kind == "STRESS":
                steps.append({})
        elif line.startswith(" -3"):
            kind = None
        elif line.startswith(" -1") and kind == "STRESS":
            steps[-1][int(line[3:13])] = [float(line[k : k + 12]) for k in range(13, len(line.rstrip()), 12)]
    return steps


def displacements(path):
    steps = []
    for line in open(path):
        words = line.split()
        if words and words[0] == "displacements":
            steps.append({})
        elif len(words) == 4:
            steps[-1][int(words[0])] = [float(w) for w in words[1:]]
    return steps


CORNERS = np.array(
    [
        (-1, -1, -1),
        (1, -1, -1),
        (1, 1, -1),
        (-1, 1, -1),
        (-1, -1, 1),
        (1, -1, 1),
        (1, 1, 1),
        (-1, 1, 1),
        (0, -1, -1),
        (1, 0, -1),
        (0, 1, -1),
        (-1, 0, -1),
        (0, -1, 1),
        (1, 0, 1),
        (0, 1, 1),
        (-1, 0, 1),
        (-1, -1, 0),
        (1, -1, 0),
        (1, 1, 0),
        (-1, 1, 0),
    ],
    float,
)


def shape_gradients(x):
    """Of the 20-node brick's shape functions at one reference point."""
    result = np.zeros((20, 3))
    for n, c in enumerate(CORNERS):
        factor = 1 + c * x
        if n < 8:
            for d in range(3):
                others = factor[(d + 1) % 3] * factor[(d + 2) % 3]
                result[n, d] = c[d] * others * (c @ x - 2 + factor[d]) / 8
        else:
            zero = np.argmin(abs(c))
            a, b = (zero + 1) % 3, (zero + 2) % 3
            result[n, zero] = -2 * x[zero] * factor[a] * factor[b] / 4
            result[n, a] = (1 - x[zero] ** 2) * c[a] * factor[b] / 4
            result[n, b] = (1 - x[zero] ** 2) * c[b] * factor[a] / 4
    return result


def stress(x, u, points, young, poisson):
    """Of a brick with corners x and displacements u at reference points: stress tensors, and the shape
    functions' gradients there with the volume that a unit of the reference brick has.
    """
    gradients = np.array([shape_gradients(point) for point in points])
    mu, lam = young / (2 * (1 + poisson)), young * poisson / ((1 + poisson) * (1 - 2 * poisson))
    jacobian = np.einsum("qnk,ni->qik", gradients, x)
    of_place = gradients @ np.linalg.inv(jacobian)
    derivative = np.einsum("qnk,ni->qik", of_place, u)
    strain = (derivative + derivative.transpose(0, 2, 1)) / 2
    found = 2 * mu * strain + lam * np.trace(strain, axis1=1, axis2=2)[:, None, None] * np.eye(3)
    return found, (of_place, np.linalg.det(jacobian))


def node_forces(nodes, hexes, moved, young, poisson):
    """Forces that elements put on their nodes: what holds them in balance from outside, by node, summed over
    the given elements (27 points each, as C3D20 has).
    """
    point, weight = np.polynomial.legendre.leggauss(3)
    grid = np.array([(a, b, c) for a in point for b in point for c in point])
    weights = np.array([a * b * c for a in weight for b in weight for c in weight])
    forces = {}
    for hexa in hexes:
        u = np.array([moved[n] for n in hexa])
        found, (of_place, volume) = stress(nodes(hexa), u, grid, young, poisson)
        for n, force in zip(hexa, np.einsum("q,qni,qij->nj", weights * volume, of_place, found)):
            forces[n] = forces.get(n, 0) + force
    return forces
