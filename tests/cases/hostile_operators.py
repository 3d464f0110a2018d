#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Reduced bodies in the cache that have the right checksum and numbers that no elastic body has: each is
told, computed again, and the results are those of an empty cache. What the program has kept itself it takes
again.

Usage: hostile_operators.py FLANK ROOT
"""
import os, pathlib, struct, subprocess, sys, tempfile, zlib

flank, root = sys.argv[1], pathlib.Path(sys.argv[2])
work = pathlib.Path(tempfile.mkdtemp())
cache = work / "cache"
CASE = [
    root / "cases/parallel_axis/spur_tip_relief_23p6.toml",
    *("--accuracy", "draft", "--set", "mesh_cycle.positions=2", "--set", "pinion.face_width_mm=6"),
    *("--set", "load.pinion_torque_Nm=[20]", "--set", "mesh.flank_rows=3", "--set", "mesh.tooth_columns=2"),
    *("--set", "contact_grid.slices=7", "--set", "output.error_estimate=no"),
]


FEW_TEETH = """
scene = "parallel_axis"
accuracy = "draft"
pair = { centre_distance_mm = 54, transverse_module_mm = 3, transverse_pressure_angle_deg = 20 }
load.pinion_torque_Nm = [7]
mesh_cycle.positions = 2
[pinion]
teeth = 15
face_width_mm = 10
profile_shift = 0.2
bore_diameter_mm = 20
fillet_radius_mm = 0.6
youngs_modulus_GPa = 207
poissons_ratio = 0.3
[gear]
like = "pinion"
teeth = 21
profile_shift = -0.2
bore_diameter_mm = 30
"""


def run(case=CASE):
    """te.csv, and what was said of the cache."""
    folder = work / "out"
    command = [flank, "run", *map(str, case), "-o", str(folder), "--force"]
    environment = {**os.environ, "FLANK_CACHE": str(cache)}
    done = subprocess.run(command, env=environment, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"FAILED: {done.stderr[-300:]}")
    return (folder / "te.csv").read_text(), "cannot be used" in done.stderr


def matrices(payload):
    """Where the numbers of the far field's matrices, of the tables' and of the ends' faces begin, and their
    rows and columns."""
    far, tables, faces, at = [], [], [], 40  # four integers and three numbers, aligned to 8
    at += 8 + 8 * struct.unpack_from("<q", payload, at)[0]

    def matrix(of):
        nonlocal at
        rows, columns = struct.unpack_from("<qq", payload, at)
        at = (at + 16 + 63) // 64 * 64
        of.append((at, rows, columns))
        at += 8 * rows * columns

    count = struct.unpack_from("<i", payload, at)[0]
    at += 4
    for _ in range(count):
        matrix(far)
    at += 4  # no depths
    count = struct.unpack_from("<i", payload, at)[0]
    at += 4
    for _ in range(count):
        at += 48
        for _ in range(2):
            at += 8 + 8 * struct.unpack_from("<q", payload, at)[0]
        matrix(tables)
        matrix(tables)
    count = struct.unpack_from("<i", payload, at)[0]
    at += 4
    for _ in range(count):
        matrix(faces)
    assert at == len(payload), (at, len(payload))
    return far, tables, faces


def scaled(payload, place, factor):
    at, rows, columns = place
    values = struct.unpack_from(f"<{rows * columns}d", payload, at)
    struct.pack_into(f"<{rows * columns}d", payload, at, *(value * factor for value in values))


def alone(payload, place):
    """Every node yields to its own load alone."""
    at, rows, columns = place
    for i in range(rows):
        for j in range(columns):
            if i != j:
                struct.pack_into("<d", payload, at + 8 * (j * rows + i), 0)


CHANGES = {
    "own tooth x 0.3": lambda payload, far, tables, faces: scaled(payload, far[0], 0.3),
    "own tooth x 1e200": lambda payload, far, tables, faces: scaled(payload, far[0], 1e200),
    "own tooth x 1e-300": lambda payload, far, tables, faces: scaled(payload, far[0], 1e-300),
    "own tooth x -1": lambda payload, far, tables, faces: scaled(payload, far[0], -1),
    "nodes alone": lambda payload, far, tables, faces: alone(payload, far[0]),
    "next tooth x 0": lambda payload, far, tables, faces: scaled(payload, far[1], 0),
    "next tooth x 100": lambda payload, far, tables, faces: scaled(payload, far[1], 100),
    "farthest tooth x 50": lambda payload, far, tables, faces: scaled(payload, far[-1], 50),
    "loads of a block x 0": lambda payload, far, tables, faces: scaled(payload, tables[0], 0),
    "loads of a block x 10": lambda payload, far, tables, faces: scaled(payload, tables[0], 10),
    "loads of a block x -1": lambda payload, far, tables, faces: scaled(payload, tables[0], -1),
    "sources x 0": lambda payload, far, tables, faces: scaled(payload, tables[1], 0),
    "face x 0": lambda payload, far, tables, faces: scaled(payload, faces[1], 0),
    "face x -20": lambda payload, far, tables, faces: scaled(payload, faces[0], -20),
    "face x 1e200": lambda payload, far, tables, faces: scaled(payload, faces[0], 1e200),
    "face x nan": lambda payload, far, tables, faces: scaled(payload, faces[0], float("nan")),
    "sources x 1e200": lambda payload, far, tables, faces: scaled(payload, tables[1], 1e200),
}


def main():
    failures = []
    expected, _ = run()
    path = next(cache.glob("*.operator"))
    kept = path.read_bytes()
    key_size = struct.unpack_from("<Q", kept, 8)[0]
    head, key, payload = kept[:8], kept[32 : 32 + key_size], kept[32 + key_size :]
    for name, change in CHANGES.items():
        changed = bytearray(payload)
        change(changed, *matrices(payload))
        checksum = zlib.crc32(bytes(changed), zlib.crc32(key))
        path.write_bytes(head + struct.pack("<QQII", len(key), len(changed), checksum, 0) + key + changed)
        found, told = run()
        if found != expected or not told:
            failures.append(f"{name}: {'told' if told else 'believed'}")
    # Teeth with a straight part below the base circle, a segment, a face of one module, elements of degree 1.
    few_teeth = work / "few_teeth.toml"
    few_teeth.write_text(FEW_TEETH)
    own = [[few_teeth]]
    others = "body.model=segment", "pinion.face_width_mm=3", "mesh.degree=1", "pinion.poissons_ratio=0.49"
    for setting in others:
        own.append([*CASE[:-1], "output.error_estimate=yes", "--set", setting])
    for case in own:
        run(case)
        if run(case)[1]:
            failures.append(f"{case[-1]}: not believed though the program's own")
    for failure in failures:
        print("FAILED:", failure)
    print(f"{len(CHANGES) + 5 - len(failures)} passed, {len(failures)} failed")
    subprocess.run(["rm", "-rf", str(work)])
    sys.exit(bool(failures))


main()
