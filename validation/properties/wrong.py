# SPDX-License-Identifier: GPL-2.0-or-later
"""Cases that are wrong on purpose:
each must be refused with exit code 2 and one line, and nothing written.
"""
import math


def _relief(g, i, roll):
    return {"amount_um": 5.0, "start_roll_angle_deg": math.degrees(roll)}


def _table(change):
    """A table over the whole flank of the pinion, spoilt."""

    def spoil(r, case, g):
        p = g.bodies[0]
        table = {
            "axis": "roll_angle_deg",
            "z": [-p.face / 2, 0.0, p.face / 2],
            "at": [math.degrees(g.start[0] + (p.end_roll - g.start[0]) * i / 3) for i in range(4)],
            "um": [[1.0, 0.0, 1.0] for _ in range(4)],
        }
        change(table)
        case["files"]["spoilt.csv"] = table
        case["pinion"]["topography"] = {"file": "spoilt.csv"}
        for side in ("left_flank", "right_flank"):
            case["pinion"].pop(side, None)

    return spoil


def _set(*path_and_value):
    def change(r, case, g):
        *path, key, value = path_and_value
        table = case
        for name in path:
            table = table.setdefault(name, {})
        table[key] = value(r, case, g) if callable(value) else value

    return change


def _remove(table, key):
    return lambda r, case, g: case[table].pop(key)


def _both(table, first, second):
    def change(r, case, g):
        case[table][first[0]], case[table][second[0]] = first[1], second[1]

    return change


def _segment(teeth):
    return lambda r, case, g: case.update(body={"model": "segment", "segment_teeth": teeth(g)})


CASES = {
    "an unknown key": _set("pinion", "teht", 5),
    "an unknown table": _set("pignon", "teeth", 20),
    "a key in the wrong table": _set("pair", "teeth", 20),
    "no torque key": lambda r, case, g: case.pop("load"),
    "no fillet": _remove("pinion", "fillet_radius_mm"),
    "no teeth": _remove("gear", "teeth"),
    "no centre distance": _remove("pair", "centre_distance_mm"),
    "text for a number": _set("pair", "centre_distance_mm", "wide"),
    "number for a text": _set("title", 5),
    "table for a number": _set("pinion", "teeth", {"count": 20}),
    "number for a table": _set("pinion", "tip_relief", 5.0),
    "list for a table": _set("pinion", "tip_relief", [5.0]),
    "table for a list of tables": _set("pinion", "bias", {"corner": 1}),
    "fractional teeth": _set("pinion", "teeth", 20.5),
    "too few teeth": _set("pinion", "teeth", 5),
    "negative teeth": _set("gear", "teeth", -20),
    "a million teeth": _set("gear", "teeth", 1000000),
    "negative face width": _set("gear", "face_width_mm", -3.0),
    "zero bore": _set("gear", "bore_diameter_mm", 0.0),
    "infinite torque": _set("load", "pinion_torque_Nm", [math.inf]),
    "torque that is not a number": _set("load", "pinion_torque_Nm", [1.0, math.nan]),
    "negative torque": _set("load", "pinion_torque_Nm", [-1.0, 2.0]),
    "no torques": _set("load", "pinion_torque_Nm", []),
    "text among the torques": _set("load", "pinion_torque_Nm", [1.0, "two"]),
    "list in the torques": _set("load", "pinion_torque_Nm", [[1.0], 2.0]),
    "unknown sense": _set("load", "drive_flank", "forward"),
    "unknown hand": _set("pair", "pinion_hand", "RIGHT"),
    "unknown scene": _set("scene", "planetary"),
    "the other scene": _set("scene", "double_roller"),
    "a key of the other scene": _set("drive", "rollers", 18),
    "unknown accuracy": _set("accuracy", "best"),
    "helix too steep": _set("pair", "helix_angle_deg", 60.0),
    "negative helix": _set("pair", "helix_angle_deg", -10.0),
    "jammed": lambda r, case, g: case["pair"].update(
        centre_distance_mm=case["pair"]["centre_distance_mm"] - g.module * r.uniform(0.8, 1)
    ),
    "overlapping base circles": _set(
        "pair", "centre_distance_mm", lambda r, case, g: 0.9 * (g.bodies[0].base + g.bodies[1].base)
    ),
    "out of reach": lambda r, case, g: case["pair"].update(
        centre_distance_mm=g.bodies[0].tip + g.bodies[1].tip + r.uniform(0, 5)
    ),
    "faces beside each other": _set(
        "pair",
        "axial_offset_mm",
        lambda r, case, g: r.choice([-1, 1]) * (g.bodies[0].face + g.bodies[1].face) * r.uniform(0.5, 2),
    ),
    "two modules": _both("pair", ("normal_module_mm", 2.0), ("transverse_module_mm", 2.0)),
    "two pressure angles": _both(
        "pair", ("normal_pressure_angle_deg", 20.0), ("transverse_pressure_angle_deg", 20.0)
    ),
    "no module": lambda r, case, g: [
        case["pair"].pop(key, None) for key in ("normal_module_mm", "transverse_module_mm")
    ],
    "thickness and shift": _both("gear", ("tooth_thickness_mm", 3.0), ("profile_shift", 0.1)),
    "tooth as thick as the pitch": lambda r, case, g: (
        case["gear"].pop("profile_shift", None),
        case["gear"].update(tooth_thickness_mm=g.module * math.pi),
    ),
    "bore through the teeth": _set(
        "pinion", "bore_diameter_mm", lambda r, case, g: 2 * g.bodies[0].root * r.uniform(1, 1.1)
    ),
    "no rim": _set(
        "gear", "bore_diameter_mm", lambda r, case, g: 2 * (g.bodies[1].root - 0.4 * g.normal_module)
    ),
    "fillets that overlap": _set("gear", "fillet_radius_mm", lambda r, case, g: 2 * g.module),
    "pointed teeth": _set("pinion", "tip_diameter_mm", lambda r, case, g: 2 * g.bodies[0].tip + 6 * g.module),
    "tip below the base circle": _set(
        "pinion", "tip_diameter_mm", lambda r, case, g: 1.99 * g.bodies[0].base
    ),
    "root above the tip": _set(
        "gear", "root_diameter_mm", lambda r, case, g: 2 * g.bodies[1].tip * r.uniform(1, 1.1)
    ),
    "chamfer and rounding": _set(
        "gear",
        "tip_edge",
        lambda r, case, g: {"chamfer_mm": 0.01 * g.module, "rounding_radius_mm": 0.01 * g.module},
    ),
    "chamfer of the whole flank": _set("gear", "tip_edge", lambda r, case, g: {"chamfer_mm": 3 * g.module}),
    "incompressible": _set("pinion", "poissons_ratio", 0.5),
    "relief from below the flank": _set(
        "pinion", "tip_relief", lambda r, case, g: _relief(g, 0, g.start[0] * 0.9)
    ),
    "relief from above the tip": _set(
        "gear", "tip_relief", lambda r, case, g: _relief(g, 1, g.bodies[1].end_roll * 1.01)
    ),
    "relief without a start": _set("pinion", "root_relief", {"amount_um": 4.0}),
    "relief without an amount": _set(
        "pinion",
        "root_relief",
        lambda r, case, g: {
            "start_roll_angle_deg": math.degrees(g.start[0] * 0.5 + g.bodies[0].end_roll * 0.5)
        },
    ),
    "relief with two starts": _set(
        "pinion",
        "tip_relief",
        lambda r, case, g: {
            **_relief(g, 0, 0.5 * (g.start[0] + g.bodies[0].end_roll)),
            "start_diameter_mm": 2 * g.bodies[0].reference,
        },
    ),
    "negative relief": _set(
        "gear",
        "tip_relief",
        lambda r, case, g: {**_relief(g, 1, 0.5 * (g.start[1] + g.bodies[1].end_roll)), "amount_um": -1.0},
    ),
    "unknown shape": _set(
        "gear",
        "tip_relief",
        lambda r, case, g: {**_relief(g, 1, 0.5 * (g.start[1] + g.bodies[1].end_roll)), "shape": "cubic"},
    ),
    "end relief longer than the face": _set(
        "gear", "end_relief", lambda r, case, g: {"amount_um": 3.0, "length_mm": 1.01 * g.bodies[1].face}
    ),
    "end relief without a length": _set("gear", "end_relief", {"amount_um": 3.0}),
    "unknown face end": _set("gear", "end_relief", {"amount_um": 3.0, "length_mm": 0.1, "end": "left"}),
    "bias at corner 5": _set(
        "pinion",
        "bias",
        lambda r, case, g: [
            {"corner": 5, "length_mm": 3.0, **_relief(g, 0, 0.5 * (g.start[0] + g.bodies[0].end_roll))}
        ],
    ),
    "bias without a length": _set(
        "pinion",
        "bias",
        lambda r, case, g: [{"corner": 1, **_relief(g, 0, 0.5 * (g.start[0] + g.bodies[0].end_roll))}],
    ),
    "bias of nothing": _set("pinion", "bias", [{}]),
    "index errors for fewer teeth": _set(
        "pinion", "index_errors_um", lambda r, case, g: [0.0] * (g.bodies[0].teeth - 1)
    ),
    "index errors for no teeth": _set("pinion", "index_errors_um", []),
    "negative runout": _set("gear", "runout", {"amount_um": -3.0}),
    "a table that is not there": _set("pinion", "topography", {"file": "nowhere.csv"}),
    "a folder for a table": _set("pinion", "topography", {"file": "."}),
    "a table with a hole": _table(lambda t: t["um"][1].__setitem__(1, math.nan)),
    "a table with a short row": _table(lambda t: t["um"][2].pop()),
    "a table that ends below the tip": _table(lambda t: (t["at"].pop(), t["um"].pop())),
    "a table narrower than the face": _table(lambda t: t.update(z=[z * 0.1 for z in t["z"]])),
    "a table out of order": _table(lambda t: t["at"].reverse()),
    "a table of two equal rows": _table(lambda t: t["at"].__setitem__(1, t["at"][0])),
    "a table of unknown axes": _table(lambda t: t.update(axis="radius_mm")),
    "a table of one row": _table(lambda t: (t.update(at=t["at"][:1], um=t["um"][:1]))),
    "an empty table": _table(lambda t: t.update(at=[], um=[], z=[])),
    "a table in metres": _table(lambda t: t["um"][0].__setitem__(0, 2e4)),
    "two misalignments": _set("misalignment", {"in_plane_um": 1.0, "in_plane_mrad": 0.1}),
    "spring of no stiffness": _set("mounting", {"pinion_torsion_Nm_per_mrad": 0.0}),
    "a segment of an even number of teeth": _segment(lambda g: 6),
    "a segment of more teeth than the gear": _segment(
        lambda g: 2 * (min(b.teeth for b in g.bodies) // 2) + 1
    ),
    "cut faces of a ring": _set("body", {"model": "ring", "cut_faces": "clamped"}),
    "no middle cell": _set("contact_grid", "profile_cells", 8),
    "no slices": _set("contact_grid", "slices", 0),
    "elements of degree 4": _set("mesh", "degree", 4),
    "an odd number of columns": _set("mesh", "tooth_columns", 3),
    "one position": _set("mesh_cycle", "positions", 1),
    "unknown period": _set("mesh_cycle", "period", "week"),
    "unknown output": _set("output", {"fields": ["temperature"]}),
    "a field of no position": _set("output", {"fields": ["contact"], "field_positions": [4]}),
    "a field of no torque": _set("output", {"fields": ["contact"], "field_torques_Nm": [123456.0]}),
    "fields of an even number of teeth": _set("output", {"fields": ["stress"], "field_teeth": 4}),
    "direct reduction for the classical split": lambda r, case, g: (
        case.update(contact={"split": "classical"}),
        case.setdefault("body", {}).update(reduction="direct"),
    ),
    "like another gear": _set("gear", "like", "gear"),
}

TEXTS = {  # what happens to the text of a case file
    "an unclosed string": lambda r, text: text.replace('"parallel_axis"', '"parallel_axis', 1),
    "an unclosed list": lambda r, text: text.replace("]", "", 1) if r.random() < 0.5 else text + "\nx = [1,",
    "cut in the middle of a line": lambda r, text: text[
        : text.index("centre_distance_mm") + r.randint(3, 20)
    ],
    "a key twice": lambda r, text: text.replace("[pinion]\n", "[pinion]\nteeth = 20\n", 1),
    "a table twice": lambda r, text: text + "\n[pinion]\n",
    "an integer too long": lambda r, text: text.replace(
        "[mesh_cycle]\npositions = 4", "[mesh_cycle]\npositions = 99999999999999999999", 1
    ),
    "an empty file": lambda r, text: "",
    "another language": lambda r, text: '{"scene": "parallel_axis"}',
    "zero bytes": lambda r, text: text[:100] + "\0\0\0" + text[100:],
    "no encoding": lambda r, text: text.replace("properties", "propert\udcff\udcfes", 1),
}
