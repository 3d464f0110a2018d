# SPDX-License-Identifier: GPL-2.0-or-later
"""The results of `flank run` or `flank study` as plain data, after every table was
checked against the others.
"""
import math
import re
import tomllib
from dataclasses import dataclass, field
from types import ModuleType

import numpy as np

from errors import InputError, plain_text
from hdf5_file import Hdf5File
from scenes import scene_report
from tables import MOST

MOST_AXES = 64


@dataclass(frozen=True)
class Axis:
    """One axis of a study."""

    keys: list  # those that vary
    labels: list  # one a point
    # one a point where the points are numbers, else None: names, lists, several keys
    numbers: np.ndarray | None
    point_of: np.ndarray  # of each variant

    @property
    def name(self):
        return self.keys[0] + (f" (with {', '.join(self.keys[1:])})" if len(self.keys) > 1 else "")


@dataclass(frozen=True)
class Source:
    """What a kind of drive reads its part of the results from."""

    files: object  # content(name) and whether a name is in it
    store: Hdf5File
    store_name: str
    is_study: bool
    case: str  # resolved: lines "key = value"
    summary: list  # lines
    axis_keys: list  # keys of all axes of a study


@dataclass(frozen=True)
class ErrorEstimate:
    """By how much the results differ from those of another accuracy level."""

    meaning: str  # a sentence or two
    heads: list
    rows: list


@dataclass(frozen=True)
class SceneResults:
    """What a kind of drive reads."""

    tables: dict  # of columns, by file name
    conventions: list  # lines
    certified: str  # name of the table whose column certificate holds every contact solution
    mesh_cycle: object = None  # a mesh_cycle.MeshCycle, where TE over a mesh cycle is what is computed
    error_estimate: ErrorEstimate | None = None
    estimate_key: str = ""  # with its value: what a case says to have one
    over_positions: dict = field(default_factory=dict)  # mesh_cycle.OverPositions, by file name
    own: object = None  # what the scene's figures want beside it


@dataclass(frozen=True)
class Results(SceneResults):
    folder_name: str = ""
    is_study: bool = False
    scene: str = ""  # value of the key
    report: ModuleType | None = None  # the scene's part of the report
    case_given: str = ""
    case_resolved: str = ""  # lines "key = value"
    versions: str = ""
    summary: list = ()  # lines
    axes: list = ()  # of a study

    @property
    def title(self):
        return self.setting("title") or self.folder_name

    def setting(self, key):
        """Value of a key of the resolved case as text, empty where it was left out."""
        return setting(self.case_resolved, key)

    def number(self, key):
        """0 where it was left out."""
        return number(self.case_resolved, key)


def setting(case, key):
    found = re.search(rf"^{re.escape(key)} = (.*)$", case, re.M)
    text = found.group(1) if found else ""
    if text[:1] not in ("'", '"'):
        return text
    try:
        return plain_text(str(tomllib.loads(f"value = {text}")["value"]))
    except (tomllib.TOMLDecodeError, RecursionError):
        return text.strip("'\"")


def number(case, key):
    try:
        value = float(setting(case, key) or 0)
    except ValueError:
        value = math.nan
    if not abs(value) <= MOST:
        raise InputError(f"its case gives no number for {key}")
    return value


def read(folder_name, files):
    """files: gives command, store(name), content(name) and whether a name is in it. Throws InputError."""
    is_study = files.command == "study"
    store_name = "study.h5" if is_study else "results.h5"
    with files.store(store_name) as file:
        store = Hdf5File(file)
        names = (
            ("case", "case_resolved", "versions")
            if is_study
            else ("case_as_given", "case_as_resolved", "versions")
        )
        given, resolved, versions = (plain_text(store.text(name)) for name in names)
        scene, study = setting(resolved, "scene"), plain_text(store.text("study")) if is_study else ""
        report = scene_report(scene)
        if report is None or not versions.strip():
            raise InputError(f"{store_name} is of another version of Flank")
        keys = [keys.split(", ") for keys in re.findall(r"^study of (.*?): \(", study, re.M)]
        if len(keys) > MOST_AXES:
            raise InputError(f"{store_name} has more than {MOST_AXES} axes")
        try:
            summary = plain_text(files.content("summary.txt").decode("utf-8")).splitlines()
        except UnicodeDecodeError:
            raise InputError("summary.txt is not as Flank writes it") from None
        all_keys = [key for of_axis in keys for key in of_axis]
        found = report.read(Source(files, store, store_name, is_study, resolved, summary, all_keys))
    return Results(
        **vars(found),
        folder_name=plain_text(folder_name),
        is_study=is_study,
        scene=scene,
        report=report,
        case_given=given,
        case_resolved=resolved,
        versions=versions,
        summary=summary,
        axes=study_axes(keys, found.tables["designs.csv"]) if is_study else [],
    )


def rows(table, mask):
    return {name: values[mask] for name, values in table.items()}


def study_axes(axis_keys, designs):
    """Axes with these keys, their points from designs.csv."""
    _, first = np.unique(designs["variant"], return_index=True)
    return [axis(keys, {key: designs[key][first] for key in keys}) for keys in axis_keys]


def axis(keys, values):
    tuples = list(zip(*(values[key] for key in keys)))
    points = {point: number for number, point in enumerate(dict.fromkeys(tuples))}
    varying = [i for i in range(len(keys)) if len({point[i] for point in points}) > 1] or [0]
    numeric = all(values[keys[i]].dtype == float for i in varying) and len(
        {point[varying[0]] for point in points}
    ) == len(points)
    labels = [
        ", ".join(f"{point[i]:g}" if isinstance(point[i], float) else str(point[i]) for i in varying)
        for point in points
    ]
    return Axis(
        [keys[i] for i in varying],
        labels,
        np.array([point[varying[0]] for point in points]) if numeric else None,
        np.array([points[point] for point in tuples]),
    )
