#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""run.py REPORT_SCRIPT [FOLDER ...]: `flank report` of damaged, hostile and foreign folders, without memory,
disk, permission or output, and stopped by signals. It must end with one line and the right exit code, and
leave everything as it was. Without folders: of small ones of made-up numbers.
"""
import sys
import tempfile
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.append(str(Path(__file__).resolve().parents[1]))
import result_folders

from checks import COUNT, Cases, accepted
from of_folders import folders, permissions, special_files
from of_manifests import half_in_place, manifests
from of_mutations import mutations
from of_outputs import outputs, renames
from of_own_files import own_files, together
from of_signals import killed, signals
from of_stores import stores
from of_tables import over_positions, tables
from of_texts import texts


def plain(files):
    """Without the tables that a run has where it is asked for them: fewer figures."""
    return {
        name: content
        for name, content in files.items()
        if name in ("te.csv", "harmonics.csv", "pairs.csv", "amplitudes_over_torque.csv", "designs.csv")
        or not name.endswith(".csv")
    }


def main():
    made = [result_folders.read(folder) for folder in sys.argv[2:]]
    made = made or [
        result_folders.gear_run(),
        result_folders.study(),
        result_folders.drive_run(),
        result_folders.gear_run(4, 2),
    ]
    with tempfile.TemporaryDirectory() as name:
        work = Path(name)
        for number, files in enumerate(made[:3]):
            cases = Cases(plain(files), work / str(number), number)
            (work / str(number)).mkdir()
            with cases.folder() as folder:
                accepted("as it is", folder)
            for part in (tables, stores) if number else (tables, stores, manifests, special_files):
                part(cases)
                print(f"{part.__name__}: {COUNT['passed']} passed so far", flush=True)
        cases = Cases(plain(made[0]), work)
        for part in (
            lambda: over_positions(cases),
            lambda: folders(cases, work),
            lambda: permissions(cases, work),
            lambda: half_in_place(cases),
            lambda: own_files(cases),
            lambda: outputs(cases),
            lambda: signals(cases),
            lambda: killed(cases),
            lambda: renames(cases),
            lambda: texts(work),
            lambda: together(cases),
            lambda: mutations([plain(files) for files in made], work),
        ):
            part()
            print(f"{COUNT['passed']} passed so far", flush=True)
    print(f"{COUNT['passed']} passed, 0 failed")


if __name__ == "__main__":
    main()
