#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Result files, recomputed from their own raw columns, by name, and from the case: a run of the second
standing example, a study of it, a drive and a pair of rollers. Nothing here is the product's: geometry by ISO
21771 (gear_geometry.py), sums, quotients and numpy's Fourier transform.

Usage: recomputed.py FLANK ROOT
"""
import math, os, pathlib, sys, tempfile

sys.dont_write_bytecode = True
import checks
from drive import check_least_gap, drive_run
from gear_check import check_geometry
from gear_geometry import Pair
from gear_run import gear_run
from gear_tables import check_sidebands
from roller_pair import roller_pair
from study import derivatives, design_torques_of_run, study

root = pathlib.Path(sys.argv[2]).resolve()


def main():
    with tempfile.TemporaryDirectory() as work:
        work = pathlib.Path(work)
        os.environ.update(
            {
                "FLANK_CACHE": str(work / "cache"),
                "OMPI_ALLOW_RUN_AS_ROOT": "1",
                "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
            }
        )
        pair_case = root / "tests/cases/recomputed/standing_pair.toml"
        check_geometry(pair_case)
        gear_run(pair_case, work / "run", "clockwise")
        gear_run(pair_case, work / "other_sense", "counter_clockwise")  # of a left hand: mirrored in z
        check_sidebands(pair_case, work / "hunting")
        text = pair_case.read_text()
        text = text[: text.index("[output]")] + '[output]\nderivatives = "yes"\n'
        keys = [
            ("pinion.lead_crown.amount_um", 4.0, 0.3),
            ("gear.root_relief.amount_um", 4.0, 0.3),
            ("pinion.right_flank.tip_relief.amount_um", 7.0, 0.3),
        ]
        text += (
            "[[study]]\nset = ["
            + ", ".join(f'"{key}"' for key, _, _ in keys)
            + "]\nrows = ["
            + ", ".join(
                "["
                + ", ".join(
                    str(value + side * step * (i == changed)) for i, (_, value, step) in enumerate(keys)
                )
                + "]"
                for changed, side in [(-1, 0), *((i, side) for i in range(len(keys)) for side in (1, -1))]
            )
            + "]\n"
        )
        (work / "study.toml").write_text(text)
        designs = study(work / "study.toml", work / "study", Pair(pair_case).pinion.base, work / "run")
        derivatives(designs, [(key, step) for key, _, step in keys], work / "study")
        spur = (
            (root / "cases/parallel_axis/spur_tip_relief_23p6.toml")
            .read_text()
            .replace("[50, 100, 200, 300]", "[20, 60, 100, 140, 180, 220, 260, 300]")
        )
        (work / "spur.toml").write_text(
            'accuracy = "draft"\n'
            + spur
            + '[[study]]\nset = "pinion.tip_relief.amount_um"\nvalues = [10, 14]\n'
        )
        study(work / "spur.toml", work / "spur", 75 * math.cos(math.radians(20)))
        design_torques_of_run(work / "spur.toml", work / "spur_run")
        drive_case = root / "tests/cases/recomputed/standing_drive.toml"
        check_least_gap(drive_case)
        drive_run(drive_case, work / "drive")
        drive_run(drive_case, work / "crank", "model.torque_on=input", "load.output_torque_Nm=[0.5, 1, 2]")
        roller_pair(root / "cases/roller_pair", work)
    for failure in checks.failures:
        print("FAILED:", failure)
    print(f"{checks.checks} checks, {len(checks.failures)} failed")
    sys.exit(bool(checks.failures))


if __name__ == "__main__":
    main()
