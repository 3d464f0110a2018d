# SPDX-License-Identifier: GPL-2.0-or-later
"""The report's part of a kind of drive, which lies in the drive's own folder as scene_report.py:

read(source)         -> results.SceneResults, checked; throws InputError. Its fields hand up what the page
                        says of this drive alone; a drive with a transmission error over a mesh cycle fills in
                        a mesh_cycle.MeshCycle, which mesh_cycle.read_drive reads and checks its tables by,
                        and from which drive_page, mesh_figures and study_figures draw them
subject(results)     -> the sentence under the title
key_figures(results) -> the table at the top: heads, rows, a note
figures(results)     -> figures in the order of the page, each a figure.Figure or a figure.LeftOut
FINER                   how the same case is computed with smaller errors

Shared code asks no drive for its name and knows the files of none.
"""
import importlib.util
import re
import sys
from pathlib import Path

CASES = Path(__file__).resolve().parents[1]


def scene_report(scene):
    """The module of a scene's name; None where there is no such scene."""
    name = f"{scene}_report"
    if name in sys.modules:
        return sys.modules[name]
    path = CASES / scene / "scene_report.py"
    if not re.fullmatch("[a-z][a-z_]{0,40}", scene, re.ASCII) or not path.is_file():
        return None
    sys.path.append(str(path.parent))  # what it has beside itself
    spec = importlib.util.spec_from_file_location(name, path)
    sys.modules[name] = module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module
