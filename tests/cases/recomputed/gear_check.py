# SPDX-License-Identifier: GPL-2.0-or-later
"""What `flank check` says of a gear pair against ISO 21771, written out: both gears apart,
by a pinion whose tip is shortened.
"""
import math, re

from checks import check, near, run
from gear_geometry import Pair


def check_flanks(case, said):
    """The flanks as the case gives them: the loaded one (here the right one, of a clockwise drive) has its
    own tip relief. The table of what is removed: rows by roll angle, the greatest first.
    """
    flanks = re.findall(r"^  pinion, (left|right) flank \((.*)\)\n((?:    .*\n)+)", said, re.M)
    sides = [flank[:2] for flank in flanks]
    check(sides == [("right", "loaded"), ("left", "not loaded")], f"flanks: {flanks}")
    for (side, _, text), amount, slope in zip(flanks, ("7.0", "9.0"), (True, False)):
        check(f"tip relief {amount}" in text, f"check, tip relief of the {side} flank: {text}")
        check(("profile slope" in text) == slope, f"check, profile slope of the {side} flank: {text}")
    table = said[said.index("Removed from both loaded flanks") :].split("\n")[1:]
    lines = [line for line in table[1:] if re.match(r"^ +[-0-9.]+ +[-0-9.]+ ", line)]
    rows = [[float(cell) for cell in line.split()] for line in lines]
    falling = all(a[0] > b[0] for a, b in zip(rows, rows[1:]))
    check(len(rows) >= 12 and falling, "check: rows of roll angles")
    # The pinion's tip relief of 7 um and profile slope act where its roll angle is greatest.
    middle = len(rows[0]) // 2
    check(rows[0][middle] > 5 + rows[len(rows) // 2][middle], f"check: removed at the tip, {rows[0]}")


def check_geometry(case):
    shortened = 65.5
    said = run("check", case, "--set", f"pinion.tip_diameter_mm={shortened}")
    pair = Pair(case, pinion={"tip_diameter_mm": shortened})
    begins = [said.index(name) for name in ("pinion (", "gear (", "Flanks (")]
    of_gear = {"pinion": said[begins[0] : begins[1]], "gear": said[begins[1] : begins[2]]}

    def shown(text, label):
        found = re.search(rf"^ +{re.escape(label)} +(\S+)", text, re.M)
        check(found is not None, f"check: no line of {label}")
        return float(found[1]) if found else math.nan

    root = {
        name: body.reference - pair.mn * (1.25 - body.shift)
        for name, body in (("pinion", pair.pinion), ("gear", pair.gear))
    }
    for name, mate in (("pinion", "gear"), ("gear", "pinion")):
        body, text = getattr(pair, name), of_gear[name]
        for label, value in (
            ("reference diameter", 2 * body.reference),
            ("base radius", body.base),
            ("tip diameter", 2 * body.tip),
            ("root diameter", 2 * root[name]),
            ("tooth thickness at the reference circle", body.thickness),
            ("tip clearance", pair.centre - body.tip - root[mate]),
            ("roll angle: start of active profile", math.degrees(body.start_roll)),
            ("roll angle: pitch point", math.degrees(math.tan(pair.alpha_wt))),
            ("roll angle: end of the involute at the tip", math.degrees(body.tip_roll)),
        ):
            near(shown(text, label), value, f"check, {name}: {label}", absolute=1e-6)
        form = shown(text, "form diameter (end of fillet)")
        active = 2 * body.base * math.hypot(1, body.start_roll)
        check(
            2 * root[name] + 0.1 < form <= active,
            f"check, {name}: form diameter {form}, active from {active}",
        )
    check_flanks(case, said)
    check(said.count("repeat with the revolutions") == 1, "check: one mesh cycle of teeth that differ")
    hunting = run("check", case, "--set", "mesh_cycle.period=hunting")
    check("repeat with the revolutions" not in hunting, "check: of a hunting period nothing is left out")
    deviations = pair.case["misalignment"]
    over_face = re.findall(r"^ +\.\.\. over the common face width +(\S+)", said, re.M)
    expected = [deviations["in_plane_um"], deviations["across_plane_um"]]
    near(
        [float(value) for value in over_face],
        expected,
        "check: misalignments over the common face",
        absolute=1e-6,
    )
    for label, value in (
        ("backlash at the pitch circles", pair.circumferential_backlash()),
        (
            "length of action",
            (pair.pinion.base * pair.pinion.tip_roll + pair.gear.base * pair.gear.tip_roll) - pair.action,
        ),
        ("axial offset of the gear", pair.offset),
    ):
        near(shown(said, label), value, f"check: {label}", absolute=1e-6)
