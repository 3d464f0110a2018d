# SPDX-License-Identifier: GPL-2.0-or-later
"""Reads a result folder of `flank run` or `flank study` into plain data."""
import csv
import re
from dataclasses import dataclass
from pathlib import Path

import h5py
import numpy as np


# Columns of numbers that the figures read.
COLUMNS = {
    "designs.csv": "variant torque_Nm peak_to_peak_um A1_um A2_um max_pressure_MPa edge_pressure_MPa mean_mesh_stiffness_N_per_um",
    "te.csv": "variant torque_Nm position te_um max_pressure_MPa edge_pressure_MPa mesh_stiffness_N_per_um certificate",
    "harmonics.csv": "torque_Nm harmonic amplitude_um aliased",
    "pairs.csv": "torque_Nm position normal_force_N",
    "lines.csv": "torque_Nm position phase pair z_mm pinion_roll_angle_deg load_per_length_N_per_mm",
    "pattern.csv": "torque_Nm pinion_roll_angle_deg z_mm pressure_MPa",
    "modifications.csv": "roll_angle_deg z_mm removed_um",
    "sidebands.csv": "torque_Nm mesh_order amplitude_um",
    "root_stress.csv": "torque_Nm phase pair z_mm tensile_stress_MPa",
    "error_estimate.csv": "torque_Nm mean_te_um te_rms_um peak_to_peak_te_um A1_um max_pressure_percent",
}
OPTIONAL = ["lines.csv", "pattern.csv", "modifications.csv", "sidebands.csv", "root_stress.csv", "error_estimate.csv"]


class InputError(Exception):
    """What the user gave cannot be used; one line says why."""


@dataclass(frozen=True)
class PressureMap:
    """Cells of one pair of roller and sleeve, a quarter of the contact: it is symmetric."""

    torque: float  # [N m]
    crank_angle: float  # [deg]
    roller: int
    sleeve: int
    along: np.ndarray  # distance of the centres from mid-roller [mm]
    half_length: np.ndarray  # of the cells, along the roller [mm]
    pressure: np.ndarray  # [MPa]


@dataclass(frozen=True)
class Axis:
    """One axis of a study."""

    keys: list  # those that vary
    labels: list  # one a point
    numbers: np.ndarray | None  # one a point where the points are numbers, else None: names, lists, several keys
    point_of: np.ndarray  # of each variant

    @property
    def name(self):
        return self.keys[0] + (f" (with {', '.join(self.keys[1:])})" if len(self.keys) > 1 else "")


@dataclass(frozen=True)
class Results:
    folder: Path
    is_study: bool
    case_given: str
    case_resolved: str  # lines "key = value"
    versions: str
    conventions: list  # lines
    summary: list  # lines
    tables: dict  # of columns, by file name
    pressure_maps: list
    axes: list  # of a study

    @property
    def title(self):
        return self.setting("title") or self.folder.name

    @property
    def is_gear_pair(self):
        return self.setting("scene") == "parallel_axis"

    def setting(self, key):
        """Value of a key of the resolved case as text, empty where it was left out."""
        found = re.search(rf"^{re.escape(key)} = (.*)$", self.case_resolved, re.M)
        return found.group(1).strip('"') if found else ""

    def number(self, key, default=0.0):
        return float(self.setting(key) or default)


def read(folder):
    folder = Path(folder)
    if not folder.is_dir():
        raise InputError(f"{folder}: no such folder")
    is_study = (folder / "designs.csv").exists() or (folder / "study.h5").exists()
    tables = ["designs.csv", "te.csv"] if is_study else ["te.csv", "harmonics.csv", "pairs.csv"]
    store = "study.h5" if is_study else "results.h5"
    missing = [name for name in tables + [store, "summary.txt"] if not (folder / name).exists()]
    if missing:
        raise InputError(f"{folder}: no finished results of `flank run` or `flank study`: {', '.join(missing)} missing")
    conventions = comments(folder / "te.csv")
    tables = {name: read_table(folder / name) for name in tables + [name for name in OPTIONAL if (folder / name).exists()]}
    try:
        with h5py.File(folder / store) as file:
            given, resolved = ("case", "case_resolved") if is_study else ("case_as_given", "case_as_resolved")
            attributes = [file.attrs[name] for name in (given, resolved, "versions")]
            study = file.attrs["study"] if is_study else ""
            maps = pressure_maps(file)
        summary = (folder / "summary.txt").read_text(encoding="utf-8").splitlines()
    except (OSError, KeyError, UnicodeDecodeError) as error:
        raise InputError(f"{folder}: cannot read {store} or summary.txt: {error}") from error
    if is_study:
        check_variants(folder, study, tables)
    axes = study_axes(study, tables["designs.csv"]) if is_study else []
    return Results(folder, is_study, *attributes, conventions, summary, tables, maps, axes)


def comments(path):
    """Lines of a table that begin with #: its conventions."""
    with open(path, encoding="utf-8", errors="replace") as stream:
        return [line[1:].strip() for line in stream if line.startswith("#")]


def read_table(path):
    """Columns by name: numbers (not-a-number where empty), or text where any entry is no number."""
    try:
        with open(path, newline="", encoding="utf-8") as stream:
            rows = list(csv.reader(line for line in stream if not line.startswith("#")))
        if any(len(row) != len(rows[0]) for row in rows):
            raise ValueError("its lines have different numbers of columns")
        columns = {name: [row[i] for row in rows[1:]] for i, name in enumerate(rows[0])}
    except (OSError, UnicodeDecodeError, ValueError, IndexError, csv.Error) as error:
        raise InputError(f"{path}: not a table as flank writes it: {error}") from error
    table = {name: column(values) for name, values in columns.items()}
    wrong = [name for name in COLUMNS[path.name].split() if name not in table or table[name].dtype != float]
    if wrong:
        raise InputError(f"{path}: no numbers in column {', '.join(wrong)}")
    return table


def column(values):
    try:
        return np.array([float(value) if value else np.nan for value in values])
    except ValueError:
        return np.array(values, dtype=object)


def rows(table, mask):
    return {name: values[mask] for name, values in table.items()}


def check_variants(folder, study_text, tables):
    """Every variant must stand in designs.csv, and in te.csv where it was computed."""
    designs, expected = tables["designs.csv"], np.prod(
        [line.count(" (") for line in study_text.splitlines() if line.startswith("study of")]
    )
    computed = {*designs["variant"][designs["status"] == "ok"]} if "status" in designs else None
    if len({*designs["variant"]}) != expected or computed != {*tables["te.csv"]["variant"]}:
        raise InputError(f"{folder}: designs.csv and te.csv are not complete: {expected:g} variants were asked for")


def study_axes(study_text, designs):
    """Keys of the axes from the lines "study of KEY, KEY: (VALUE, VALUE) ..." of study.h5, their points from designs.csv."""
    _, first = np.unique(designs["variant"], return_index=True)
    groups = [keys.split(", ") for keys in re.findall(r"^study of (.*?): \(", study_text, re.M)]
    return [axis(keys, {key: designs[key][first] for key in keys}) for keys in groups]


def axis(keys, values):
    tuples = list(zip(*(values[key] for key in keys)))
    points = list(dict.fromkeys(tuples))
    varying = [i for i in range(len(keys)) if len({point[i] for point in points}) > 1] or [0]
    numeric = all(values[keys[i]].dtype == float for i in varying) and len({point[varying[0]] for point in points}) == len(points)
    labels = [", ".join(f"{point[i]:g}" if isinstance(point[i], float) else str(point[i]) for i in varying) for point in points]
    return Axis(
        [keys[i] for i in varying],
        labels,
        np.array([point[varying[0]] for point in points]) if numeric else None,
        np.array([points.index(point) for point in tuples]),
    )


def pressure_maps(file):
    """Groups torque_T_position_P / roller_R_sleeve_S of a double-roller run, where the case asks for them."""
    result = []
    for position_name, pairs in file.get("pressure_maps", {}).items():
        torque, position = (int(number) for number in re.findall(r"\d+", position_name))
        for pair_name, cells in pairs.items():
            roller, sleeve = (int(number) for number in re.findall(r"\d+", pair_name))
            result.append(
                PressureMap(
                    float(file["torque"][torque]),
                    float(file["crank_angle"][position]),
                    roller,
                    sleeve,
                    cells["y"][:],
                    cells["half_y"][:],
                    cells["pressure"][:],
                )
            )
    return sorted(result, key=lambda map: (map.torque, map.crank_angle, map.sleeve, map.roller))
