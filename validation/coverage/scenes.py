# SPDX-License-Identifier: GPL-2.0-or-later
"""Scenes that an engineer would compute, by seed: spur and helical pairs of 12 to 100 teeth and module 0.5
to 20, light and heavy loads, with and without modifications. Seeds from SMOOTH on: with relief and crown that
keep the load off kinks and edges, so that the greatest pressure has a limit."""
import math
import pathlib
import random
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "properties"))
from pairs import GEARS, Body, Geometry, Invalid, digits, inverse_involute, involute

SMOOTH = 2000


def scene(seed):
    draw = random.Random(f"coverage {seed}")
    while True:
        case = pair_of(draw)
        try:
            geometry = at_centre_distance(case, draw)
        except (Invalid, ValueError):
            continue
        if geometry and geometry.contact_ratio > 1.1:
            break
    torque, deflection = load(case, geometry, draw)
    if seed >= SMOOTH:
        smooth(case, geometry, deflection, draw)
    elif draw.random() < 0.75:
        modify(case, geometry, deflection, draw)
    case["load"] = {"pinion_torque_Nm": [torque]}
    case["mesh_cycle"] = {"positions": 16}
    return {"title": f"coverage {seed}", "scene": "parallel_axis", **case}


def pair_of(draw):
    beta = 0.0 if draw.random() < 0.4 else digits(draw.uniform(8, 33), 4)
    module = digits(math.exp(draw.uniform(math.log(0.5), math.log(20))), 3)
    width = digits(module * math.exp(draw.uniform(math.log(5), math.log(12))), 4)
    case = {
        "pair": {
            "normal_module_mm": module,
            "normal_pressure_angle_deg": draw.choice([20.0, 20.0, 20.0, 17.5, 25.0]),
            "helix_angle_deg": beta,
            "pinion_hand": draw.choice(["right", "left"]),
        }
    }
    for name in GEARS:
        teeth = round(math.exp(draw.uniform(math.log(12), math.log(100))))
        shift = digits(max(0.02 * (17 - teeth), 0) + draw.uniform(-0.1, 0.3), 3)
        root = module / math.cos(math.radians(beta)) * teeth / 2 - module * (1.25 - shift)
        case[name] = {
            "teeth": teeth,
            "face_width_mm": width,
            "profile_shift": shift,
            "bore_diameter_mm": digits(2 * min(root * draw.uniform(0.3, 0.75), root - 1.2 * module)),
            "fillet_radius_mm": digits(module * draw.uniform(0.2, 0.35), 4),
            "youngs_modulus_GPa": 206.0,
            "poissons_ratio": 0.3,
        }
    if draw.random() < 0.4:
        case["gear"]["face_width_mm"] = digits(width * draw.uniform(0.8, 1.2), 4)
    if draw.random() < 0.15:
        case["gear"]["youngs_modulus_GPa"] = draw.choice([110.0, 170.0, 3.0])
        case["gear"]["poissons_ratio"] = draw.choice([0.28, 0.34])
    return case


def at_centre_distance(case, draw):
    """With a little backlash; None where the sum of profile shifts leaves none."""
    pair = case["pair"]
    cos_beta = math.cos(math.radians(pair["helix_angle_deg"]))
    module = pair["normal_module_mm"] / cos_beta
    angle = math.atan(math.tan(math.radians(pair["normal_pressure_angle_deg"])) / cos_beta)
    bodies = [Body(case[name], module, pair["normal_module_mm"], angle) for name in GEARS]
    shifts, teeth = (sum(case[name][key] for name in GEARS) for key in ("profile_shift", "teeth"))
    without_backlash = involute(angle) + 2 * shifts * math.tan(angle) * cos_beta / teeth
    if without_backlash <= 0.002:
        return None
    working = inverse_involute(without_backlash)
    pair["centre_distance_mm"] = digits(
        sum(body.base for body in bodies) / math.cos(working)
        + pair["normal_module_mm"] * draw.uniform(0.02, 0.08),
        8,
    )
    return Geometry(case)


def load(case, geometry, draw):
    """Pinion torque [N m] of 0.3 to 30 N per mm of face and mm of module for steel, and about how far the
    teeth give way [um]."""
    stiffness = 2 / sum(206 / case[name]["youngs_modulus_GPa"] for name in GEARS)
    specific = math.exp(draw.uniform(math.log(0.3), math.log(30))) * stiffness
    module, width = case["pair"]["normal_module_mm"], case["pinion"]["face_width_mm"]
    torque = digits(specific * width * module * geometry.bodies[0].base * 1e-3, 4)
    return torque, specific * module / 14.0 / stiffness


def modify(case, geometry, deflection, draw):
    for name, body, start in zip(GEARS, geometry.bodies, geometry.start):
        amount = lambda least, most: digits(deflection * draw.uniform(least, most), 3)
        if draw.random() < 0.6:
            begin = start + (body.end_roll - start) * draw.uniform(0.5, 0.85)
            case[name]["tip_relief"] = {
                "amount_um": amount(0.2, 1.2),
                "start_roll_angle_deg": digits(math.degrees(begin), 6),
                "shape": draw.choice(["linear", "quadratic"]),
            }
        if draw.random() < 0.4:
            case[name]["lead_crown"] = {"amount_um": amount(0.1, 0.8)}
        if draw.random() < 0.15:
            case[name]["profile_crown"] = {"amount_um": amount(0.1, 0.5)}
        if draw.random() < 0.15:
            case[name]["helix_slope"] = {"amount_um": amount(-0.5, 0.5)}


def smooth(case, geometry, deflection, draw):
    for name, body, start in zip(GEARS, geometry.bodies, geometry.start):
        begin = start + (body.end_roll - start) * draw.uniform(0.4, 0.7)
        case[name]["tip_relief"] = {
            "amount_um": digits(deflection * draw.uniform(1.5, 3), 3),
            "start_roll_angle_deg": digits(math.degrees(begin), 6),
            "shape": "quadratic",
        }
    case["pinion"]["lead_crown"] = {"amount_um": digits(deflection * draw.uniform(0.7, 2), 3)}


def toml(case, name=""):
    plain = [f"{key} = {text(value)}" for key, value in case.items() if not isinstance(value, dict)]
    lines = ([f"[{name}]"] if name else []) + plain
    for key, value in case.items():
        if isinstance(value, dict):
            lines.append(toml(value, f"{name}.{key}" if name else key))
    return "\n".join(lines)


def text(value):
    return f'"{value}"' if isinstance(value, str) else str(value)
