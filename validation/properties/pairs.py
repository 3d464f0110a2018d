# SPDX-License-Identifier: GPL-2.0-or-later
"""Random parallel-axis cases, as dictionaries of the case file's tables."""
import collections
import copy
import math
import random

from geometry import Body, GEARS, Geometry, Invalid, inverse_involute, involute


def digits(value, n=6):
    """Rounded to significant digits: case files that can be read."""
    return float(f"{value:.{n}g}")


def between(r, low, high):
    return digits(r.uniform(low, high))


def log_between(r, low, high):
    return digits(math.exp(r.uniform(math.log(low), math.log(high))))


def random_teeth(r, hunting):
    if hunting:  # few mesh cycles until the same teeth meet again
        while True:
            common, a, b = r.randint(4, 40), r.randint(1, 5), r.randint(1, 5)
            if 12 <= common * a <= 100 and 12 <= common * b <= 100 and math.lcm(common * a, common * b) <= 72:
                return common * a, common * b
    return [round(math.exp(r.uniform(math.log(12), math.log(100)))) for _ in GEARS]


Rack = collections.namedtuple("Rack", "module normal_module angle")  # transverse module and pressure angle


def random_pair(r, hunting):
    """Geometry alone: drawn until the program must take it."""
    while True:
        pair, rack = random_rack(r)
        case = {"pair": pair}
        teeth, shifts = random_teeth(r, hunting), [0.0, 0.0] if r.random() < 0.3 else [
            digits(max(-0.8, min(1.2, r.gauss(0.2, 0.35)))) for _ in GEARS
        ]
        width = rack.normal_module * math.exp(r.uniform(math.log(3), math.log(20)))
        twins = r.random() < 0.15  # one body, or its mirror image
        for i, name in enumerate(GEARS):
            face = digits(width * (1 if i == 0 or r.random() < 0.4 else r.uniform(0.7, 1.4)))
            case[name] = random_gear(r, rack, teeth[i], shifts[i], face)
        if twins:
            case["gear"] = copy.deepcopy(case["pinion"])
        if r.random() < 0.3:
            pair["axial_offset_mm"] = digits(width * r.uniform(-0.3, 0.3))
        if r.random() < 0.25:
            pair["centre_distance_error_um"] = digits(rack.normal_module * r.uniform(-4, 25), 4)
        try:
            draw_centre_distance(r, case, rack, sum(teeth))
            Geometry(case)
            return case
        except Invalid:
            continue


def random_rack(r):
    """Helix, module and pressure angle: the table of the pair, each in one of its two keys, and the rack."""
    beta = 0.0 if r.random() < 0.35 else between(r, 1, 40)
    normal_module = log_between(r, 0.5, 20)
    normal_angle = r.choice([20.0, 20.0, 20.0, 14.5, 25.0, between(r, 14, 28)])
    cos_beta = math.cos(math.radians(beta))
    module, angle = normal_module / cos_beta, math.atan(math.tan(math.radians(normal_angle)) / cos_beta)
    pair = {"helix_angle_deg": beta, "pinion_hand": r.choice(["right", "left"])}
    pair.update(
        {"normal_module_mm": normal_module}
        if r.random() < 0.6
        else {"transverse_module_mm": digits(module, 12)}
    )
    pair.update(
        {"normal_pressure_angle_deg": normal_angle}
        if r.random() < 0.6
        else {"transverse_pressure_angle_deg": digits(math.degrees(angle), 12)}
    )
    return pair, Rack(module, normal_module, angle)


def random_gear(r, rack, z, x, face):
    """The table of one gear of z teeth, profile shift x and this face width: blank, material, tip edge."""
    module, normal_module, angle = rack
    root = module * z / 2 - normal_module * (1.25 - x)
    gear = {"teeth": z, "face_width_mm": face}
    if r.random() < 0.25:
        gear["tooth_thickness_mm"] = digits(
            module * math.pi / 2
            + 2 * x * normal_module * math.tan(angle)
            - normal_module * r.uniform(0, 0.05)
        )
    else:
        gear["profile_shift"] = x
    if r.random() < 0.3:
        gear["tip_diameter_mm"] = digits(module * z + 2 * normal_module * (1 + x + r.uniform(-0.12, 0.06)))
    if r.random() < 0.3:
        gear["root_diameter_mm"] = digits(2 * root + 2 * normal_module * r.uniform(-0.1, 0.05))
    gear["bore_diameter_mm"] = digits(
        2 * min(root * r.uniform(0.25, 0.9), root - normal_module * 0.7) if root > normal_module else root
    )
    gear["fillet_radius_mm"] = digits(normal_module * r.uniform(0.08, 0.38))
    gear["youngs_modulus_GPa"] = r.choice([206.0, 206.0, 210.0, between(r, 1, 420)])
    gear["poissons_ratio"] = r.choice([0.3, 0.3, 0.3, 0.0, between(r, 0, 0.4999)])
    if r.random() < 0.25:
        gear["tip_edge"] = {
            r.choice(["chamfer_mm", "rounding_radius_mm"]): digits(normal_module * r.uniform(0.02, 0.15))
        }
    return gear


def draw_centre_distance(r, case, rack, teeth):
    """A little more than where both flanks touch; Invalid if they do at any distance.
    `teeth`: of both gears as they were drawn, before one became the other's twin.
    """
    pair, bodies = case["pair"], [Body(case[name], *rack) for name in GEARS]
    cos_beta = math.cos(math.radians(pair["helix_angle_deg"]))
    shift = bodies[0].shift + bodies[1].shift
    jammed = involute(rack.angle) + 2 * shift * math.tan(rack.angle) * cos_beta / teeth
    if jammed <= 0.001:
        raise Invalid("jammed")
    tight = (bodies[0].base + bodies[1].base) / math.cos(inverse_involute(jammed))
    pair["centre_distance_mm"] = digits(tight + rack.normal_module * r.uniform(0.002, 0.15), 8)
    if pair.get("centre_distance_error_um"):
        pair["centre_distance_mm"] = digits(
            pair["centre_distance_mm"] - 1e-3 * pair["centre_distance_error_um"], 8
        )


def start_of(r, body, low, high):
    """Where a relief starts, in one of the three ways drawings give it."""
    roll = r.uniform(low, high)
    key, value = r.choice(
        [
            ("start_roll_angle_deg", math.degrees(roll)),
            ("start_diameter_mm", 2 * body.radius_at(roll)),
            ("start_length_of_roll_mm", body.base * roll),
        ]
    )
    return {key: digits(value, 9)}


def blend_starts(flank, body, start):
    """Rounds the starts of some linear reliefs given by roll angles, up to a tenth of the longest arc."""
    r = random.Random(repr(flank))  # of its own: what else is drawn stays what it was
    for name, end in (("tip_relief", body.end_roll), ("root_relief", start)):
        table = flank.get(name, {})
        at = math.radians(table.get("start_roll_angle_deg", 0))
        if at > 0 and table["amount_um"] > 0 and table.get("shape") != "quadratic" and r.random() < 0.3:
            longest = 2 / (1e-3 * table["amount_um"]) * (body.base * at * (end - at)) ** 2
            table["blend_radius_mm"] = digits(min(1e6, longest * r.uniform(0, 0.1)))


def random_flank(r, body, start, size, tables, name, spare):
    """Modifications of one flank; amounts up to about `size` um.
    `spare`: how far tables reach beyond the face, mm.
    """
    flank = {}
    tip, range_ = body.end_roll, body.end_roll - start
    some = lambda p=0.3: r.random() < p
    amount = lambda: digits(size * r.random(), 4)
    shape = lambda: {"shape": r.choice(["linear", "quadratic"])} if some(0.7) else {}
    inside = lambda: start_of(r, body, start + 0.02 * range_, tip - 0.05 * range_)
    if some(0.4):
        flank["tip_relief"] = {"amount_um": amount(), **inside(), **shape()}
    if some(0.25):
        flank["root_relief"] = {"amount_um": amount(), **inside(), **shape()}
    if some(0.2):
        flank["profile_slope"] = {"amount_um": digits(size * r.uniform(-0.5, 0.5), 4)}
    if some(0.2):
        flank["profile_crown"] = {"amount_um": digits(size * r.uniform(-0.1, 0.5), 4)}
    if some(0.3):
        flank["lead_crown"] = {"amount_um": digits(size * r.uniform(-0.1, 1), 4)}
    if some(0.25):
        flank["helix_slope"] = {"amount_um": digits(size * r.uniform(-1, 1), 4)}
    if some(0.25):
        flank["end_relief"] = {
            "amount_um": amount(),
            "length_mm": digits(body.face * r.uniform(0.05, 0.5)),
            **shape(),
        }
        if some(0.7):
            flank["end_relief"]["end"] = r.choice(["both", "negative_z", "positive_z"])
    if some(0.3):
        flank["bias"] = [
            {
                "corner": r.randint(1, 4),
                "amount_um": amount(),
                **inside(),
                "length_mm": digits(body.face * r.uniform(0.1, 1.5)),
                **shape(),
            }
            for _ in range(r.randint(1, 3))
        ]
    blend_starts(flank, body, start)
    if some(0.15):
        table = f"{name}.csv"
        tables[table] = random_topography(r, body, start, size, spare)
        flank["topography"] = {"file": table}
    return flank


def random_topography(r, body, start, size, spare):
    """What is removed at five rolls by four places along z, over the whole flank and a little more."""
    axis, of_roll = r.choice(
        [
            ("roll_angle_deg", math.degrees),
            ("diameter_mm", lambda a: 2 * body.radius_at(a)),
            ("length_of_roll_mm", lambda a: body.base * a),
        ]
    )
    tip, range_ = body.end_roll, body.end_roll - start
    low = max(0.0, start - 0.02 * range_)
    rolls = [low + (tip + 0.02 * range_ - low) * i / 4 for i in range(5)]
    half = body.face / 2 + spare
    zs = [digits(half * (-1 + 2 * j / 3), 9) for j in range(4)]
    return {
        "axis": axis,
        "at": [digits(of_roll(a), 9) for a in rolls],
        "z": zs,
        "um": [[digits(size * r.uniform(-0.3, 0.5), 4) for _ in zs] for _ in rolls],
    }


def random_case(seed):
    """A case that must be taken, with its tables (file name: contents) under "files";
    the same for the same seed: all is drawn in one order from one generator.
    """
    r = random.Random(f"valid {seed}")
    hunting = r.random() < 0.12
    case = random_pair(r, hunting)
    case = {"title": f"properties, seed {seed}", "scene": "parallel_axis", "accuracy": "draft", **case}
    g = Geometry(case)
    case["files"] = {}
    size = r.choice([0.3, 1, 1, 3]) * (3 + 4 * g.module)  # um
    for body, start, name in zip(g.bodies, g.start, GEARS):
        draw_flanks(r, case, body, start, name, size)
        if r.random() < (0.5 if hunting else 0.1):
            draw_single_teeth(r, case[name], size)
    if r.random() < 0.3:
        case["misalignment"] = random_misalignment(r, g, size)
    modulus = (
        1 / sum(1 / case[name]["youngs_modulus_GPa"] for name in GEARS) / 103e3
    )  # of the pair, over steel's [1/1000 for um]
    steel = modulus * 1e3
    per_face = 14e3 * steel  # stiffness of a mesh, N/mm/mm
    if r.random() < 0.25:
        case["mounting"] = random_mounting(r, g, per_face)
    if r.random() < 0.2:
        most = min(b.teeth for b in g.bodies) - 1
        case["body"] = {
            "model": "segment",
            "segment_teeth": min(r.choice([5, 7, 7, 9, 11]), most - (most + 1) % 2),
            "cut_faces": r.choice(["free", "clamped"]),
        }
    torques = random_torques(r, g, per_face)
    case["load"] = {"pinion_torque_Nm": torques, "drive_flank": r.choice(["counter_clockwise", "clockwise"])}
    case["mesh_cycle"] = {"positions": 4}
    draw_discretization(r, case, hunting)
    output = {
        key: "yes"
        for key, share in (("subsurface_stress", 0.1), ("root_stress", 0.05), ("light_load_pattern", 0.1))
        if r.random() < share
    }
    if output:
        case["output"] = output
    case["hunting"] = hunting  # few teeth until the same meet again; not a key of the case file
    return case


def draw_flanks(r, case, body, start, name, size):
    """Modifications of both flanks of most gears, others for one of them at times."""
    if r.random() < 0.75:
        case[name].update(random_flank(r, body, start, size, case["files"], name, 0.0))
        if r.random() < 0.25:
            side = r.choice(["left_flank", "right_flank"])
            own = random_flank(r, body, start, size, case["files"], f"{name}_{side}", 0.0)
            case[name].update({side: own} if own else {})


def draw_single_teeth(r, gear, size):
    """What teeth of one gear differ by: index errors, runout, both or neither."""
    if r.random() < 0.6:
        gear["index_errors_um"] = [digits(size * r.uniform(-0.5, 0.5), 4) for _ in range(gear["teeth"])]
    if r.random() < 0.6:
        gear["runout"] = {"amount_um": digits(size * r.uniform(0, 4), 4), "angle_deg": between(r, -180, 180)}


def random_misalignment(r, g, size):
    """Tilts in the plane of action and across it, as a deviation over the face or as an angle."""
    tilt = {}
    for key in ("in_plane", "across_plane"):
        if r.random() < 0.7:
            um = size * r.uniform(-1, 1)
            tilt.update(
                {key + "_um": digits(um, 4)}
                if r.random() < 0.5
                else {key + "_mrad": digits(um / g.face, 4)}
            )
    return tilt


def random_mounting(r, g, per_face):
    """Springs of some of the axes' rotations, from half as stiff as the mesh to a hundred times."""
    springs = {}
    for name, body in zip(GEARS, g.bodies):
        for key, lever in (
            ("torsion", body.base),
            ("tilt_in_plane", g.face / 3 + 0.1 * body.base),
            ("tilt_across_plane", g.face / 3 + 0.1 * body.base),
        ):
            if r.random() < 0.4:
                springs[f"{name}_{key}_Nm_per_mrad"] = digits(
                    per_face * g.face * lever**2 * 1e-6 * math.exp(r.uniform(math.log(0.5), math.log(100))),
                    4,
                )
    return springs


def random_torques(r, g, per_face):
    """Three, from a millionth of the module as deflection to where linear elasticity ends; far enough apart
    to tell, near enough to share grids at times.
    """
    deflection = g.module * math.exp(
        r.choice(
            [
                r.uniform(math.log(1e-6), math.log(1e-4)),
                r.uniform(math.log(1e-4), math.log(5e-3)),
                r.uniform(math.log(3e-4), math.log(5e-3)),
                r.uniform(math.log(5e-3), math.log(2e-2)),
            ]
        )
    )
    torque = per_face * deflection * g.face * g.bodies[0].base * 1e-3
    torques = [digits(torque)]
    for _ in range(2):
        torques.append(digits(torques[-1] / math.exp(r.uniform(math.log(1.25), math.log(5)))))
    if r.random() < 0.15:
        torques[2] = 0.0
    r.shuffle(torques)
    return torques


def draw_discretization(r, case, hunting):
    """A coarse mesh, as no property depends on how fine it is; the contact grid; how compliance is split."""
    case["mesh"] = {
        "degree": 2 if r.random() < 0.04 else 1,
        "flank_rows": r.choice([3, 4]),
        "tooth_columns": 2,
        "face_layers": r.choice([2, 2, 3]),
        "fillet_rows": 1,
        "fillet_columns": 1,
        "rim_layers": r.choice([2, 3]),
    }
    # The draft level's contact grid, on which what two grids of one contact differ is known; a hunting
    # period compares on one grid.
    case["contact_grid"] = (
        {"slices": r.choice([9, 12]), "profile_cells": 11}
        if hunting
        else {"slices": r.choice([31, 31, 32]), "profile_cells": 11}
    )
    if r.random() < 0.04:
        case["contact"] = {"split": "classical", "classical_depth": r.choice(["half_element", "line_fit"])}
