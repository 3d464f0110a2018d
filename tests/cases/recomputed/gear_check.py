# SPDX-License-Identifier: GPL-2.0-or-later
"""What `flank check` says of a gear pair against ISO 21771, written out: both gears apart,
by a pinion whose tip is shortened.
"""
import math, re

from checks import check, near, run
from gear_geometry import Pair


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
