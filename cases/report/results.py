# SPDX-License-Identifier: GPL-2.0-or-later
"""The results of `flank run` or `flank study` as plain data, after every table was checked against the others."""
import math
import re
import tomllib
from dataclasses import dataclass

import numpy as np

import roller_pair
from error_curves import amplitudes, period_of
from errors import InputError, plain_text
from hdf5_file import Hdf5File
from tables import DRIVE_RUN, GEAR_RUN, MOST, NEEDED, STUDY, read_table

MOST_ROLLERS = 1000
MOST_AXES = 64
ROUNDING = 1e-8  # of numbers in tables, relative and absolute


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
class Block:
    """Transmission errors of variants over the same torques and positions, from the store."""

    variants: np.ndarray
    torques: np.ndarray  # [N m]
    abscissa: np.ndarray  # mesh phase [mesh cycles] or crank angle [deg]
    te: np.ndarray  # [um], variants by torques by positions


@dataclass(frozen=True)
class Results:
    folder_name: str
    is_study: bool
    scene: str  # value of the key
    rollers: int  # N_r of the double-roller drive, 0 of a gear pair
    case_given: str
    case_resolved: str  # lines "key = value"
    versions: str
    conventions: list  # lines
    summary: list  # lines
    tables: dict  # of columns, by file name
    pressure_maps: list
    axes: list  # of a study
    slopes: np.ndarray | None = (
        None  # of a run: d TE / d torque [um/(N m)], ascending torques by positions; 0: not known
    )
    base_radii: tuple = ()  # of a run of a gear pair: of the pinion and of the gear [mm]

    @property
    def is_gear_pair(self):
        return self.scene == "parallel_axis"

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
        if scene not in ("parallel_axis", "double_roller", "roller_pair") or not versions.strip():
            raise InputError(f"{store_name} is of another version of Flank")
        axis_keys = [keys.split(", ") for keys in re.findall(r"^study of (.*?): \(", study, re.M)]
        if len(axis_keys) > MOST_AXES:
            raise InputError(f"{store_name} has more than {MOST_AXES} axes")
        all_keys = [key for keys in axis_keys for key in keys]
        if scene == "roller_pair":
            rollers, blocks, slopes, base_radii = 0, [], None, ()
            tables, conventions, maps = roller_pair.read(files, store, is_study, all_keys)
        else:
            is_gear_pair = scene == "parallel_axis"
            rollers = 0 if is_gear_pair else number(resolved, "drive.rollers")
            if not is_gear_pair and rollers not in range(3, MOST_ROLLERS + 1):
                raise InputError(f"its case has no number of rollers from 3 to {MOST_ROLLERS}")
            blocks = study_blocks(store, is_gear_pair) if is_study else [run_block(store, is_gear_pair)]
            maps = [] if is_study or is_gear_pair else pressure_maps(store, blocks[0], rollers)
            slopes, base_radii = (None, ()) if is_study else run_slopes(store, blocks[0], is_gear_pair)
            tables, conventions = read_tables(files, is_study, is_gear_pair, all_keys)
    try:
        summary = plain_text(files.content("summary.txt").decode("utf-8")).splitlines()
    except UnicodeDecodeError:
        raise InputError("summary.txt is not as Flank writes it") from None
    abscissa = "phase" if scene == "parallel_axis" else "crank_angle_deg"
    if scene != "roller_pair":
        check_errors(tables["te.csv"], blocks, abscissa, store_name)
    if is_study and scene != "roller_pair":
        check_variants(tables, blocks, summary)
    axes = study_axes(axis_keys, tables["designs.csv"]) if is_study else []
    results = Results(
        plain_text(folder_name),
        is_study,
        scene,
        int(rollers),
        given,
        resolved,
        versions,
        conventions,
        summary,
        tables,
        maps,
        axes,
        slopes,
        base_radii,
    )
    if not is_study and blocks:
        check_run(results, blocks[0], abscissa)
    return results


def read_tables(files, is_study, is_gear_pair, axis_keys):
    """Those that are needed and those that are there, with the comments of te.csv."""
    known, tables, conventions = STUDY if is_study else GEAR_RUN if is_gear_pair else DRIVE_RUN, {}, []
    for name, columns in known.items():
        if name in NEEDED or name in files:
            columns = columns.format(abscissa="phase" if is_gear_pair else "crank_angle_deg").split()
            keys = axis_keys if name == "designs.csv" else ()
            tables[name], comments = read_table(name, files.content(name), columns, keys)
            conventions = comments if name == "te.csv" else conventions
    return tables, conventions


def rows(table, mask):
    return {name: values[mask] for name, values in table.items()}


def run_block(store, is_gear_pair):
    torques = store.numbers("pinion_torque" if is_gear_pair else "torque", None)
    abscissa = store.numbers("phase" if is_gear_pair else "crank_angle", None)
    te = store.numbers("transmission_error", len(torques), len(abscissa))
    if not te.size:
        raise InputError("results.h5 holds no transmission errors")
    return Block(np.zeros(1), torques, abscissa, te[None])


def run_slopes(store, block, is_gear_pair):
    """Slopes over torque in the order of the torques, and the base radii of a gear pair."""
    slopes = store.numbers("transmission_error_slope", len(block.torques), len(block.abscissa))
    radii = (
        tuple(float(store.numbers(f"{name}_base_radius", 1)[0]) for name in ("pinion", "gear"))
        if is_gear_pair
        else ()
    )
    if not np.all(slopes >= 0) or not all(radius > 0 for radius in radii):
        raise InputError("results.h5 holds a falling transmission error or no base radius")
    return slopes[np.argsort(block.torques)], radii


def study_blocks(store, is_gear_pair):
    blocks = []
    for name in store.names():
        variants, torques, abscissa = (
            store.numbers(f"{name}/{key}", None)
            for key in ("variant", "torque", "phase" if is_gear_pair else "crank_angle_deg")
        )
        te = store.numbers(f"{name}/te", len(variants), len(torques), len(abscissa))
        blocks.append(Block(variants, torques, abscissa, te))
    return blocks


def check_errors(te_table, blocks, abscissa, store_name):
    """te.csv must be the transmission errors of the store, in the order of the variants."""
    columns = {"variant": [], "torque_Nm": [], "position": [], abscissa: [], "te_um": []}
    for block in blocks:
        if len({*block.torques}) < len(block.torques):
            raise InputError(
                "one torque was computed twice; give every torque of the case once and compute it anew"
            )
        n, torques, positions = block.te.shape
        columns["variant"].append(np.repeat(block.variants, torques * positions))
        columns["torque_Nm"].append(np.tile(np.repeat(block.torques, positions), n))
        columns["position"].append(np.tile(np.arange(positions), n * torques))
        columns[abscissa].append(np.tile(block.abscissa, n * torques))
        columns["te_um"].append(block.te.ravel())
    expected = {name: np.concatenate(parts) if parts else np.zeros(0) for name, parts in columns.items()}
    order = np.argsort(expected["variant"], kind="stable")
    for name, values in expected.items():
        if not close(values[order], te_table[name]):
            raise InputError(f"te.csv and {store_name} are not of one computation")


def close(a, b):
    return a.shape == b.shape and np.allclose(a, b, rtol=ROUNDING, atol=ROUNDING)


def check_variants(tables, blocks, summary):
    """Every variant must stand in designs.csv; in te.csv and once in study.h5 where it was computed."""
    designs = tables["designs.csv"]
    asked = next(
        (int(found[1]) for line in summary[1:] if (found := re.match(r"study: (\d{1,9}) variants, ", line))),
        -1,
    )
    is_ok = designs["status"] == "ok"
    computed = np.sort(np.concatenate([block.variants for block in blocks])) if blocks else np.zeros(0)
    if not np.array_equal(np.unique(designs["variant"]), np.arange(asked)) or not np.array_equal(
        np.unique(designs["variant"][is_ok]), computed
    ):
        raise InputError("designs.csv, summary.txt and study.h5 are not of one computation, or not complete")
    measured = (
        "torque_Nm",
        "peak_to_peak_um",
        "max_pressure_MPa",
        "edge_pressure_MPa",
        "mean_mesh_stiffness_N_per_um",
    )
    for block in blocks:
        own = is_ok & np.isin(designs["variant"], block.variants)
        if any(np.any(np.isnan(designs[name][own])) for name in measured) or not close(
            designs["torque_Nm"][own], np.tile(block.torques, len(block.variants))
        ):
            raise InputError("designs.csv and study.h5 are not of one computation")


def check_run(results, block, abscissa):
    """The tables beside te.csv must be of its torques, positions and errors."""
    te, positions = results.tables["te.csv"], len(block.abscissa)
    for name, table in results.tables.items():
        if name in ("te.csv", "modifications.csv"):
            continue
        if name == "design_torques.csv":  # of torques in between
            within = (table["torque_Nm"] >= np.min(block.torques)) & (
                table["torque_Nm"] <= np.max(block.torques)
            )
            if not np.all(within):
                raise InputError(f"te.csv and {name} are not of one computation")
            continue
        light = name == "pattern.csv"  # which may be of 1 % of a torque too
        torques = np.concatenate([block.torques, 0.01 * block.torques]) if light else block.torques
        order = np.argsort(torques)
        at = np.searchsorted(torques[order], table["torque_Nm"] * (1 - ROUNDING))
        number = order[np.minimum(at, len(order) - 1)]  # of each row's torque
        fits = close(torques[number], table["torque_Nm"])
        if name == "error_estimate.csv":
            fits = close(block.torques, table["torque_Nm"])
        if fits and "position" in table:
            position = table["position"].astype(int)
            fits = np.all(position < positions) and close(block.abscissa[position], table[abscissa])
            if fits and name == "pairs.csv":
                pairs = np.bincount(number * positions + position, minlength=len(te["contacts"]))
                fits = np.array_equal(pairs, te["contacts"])
        if not fits:
            raise InputError(f"te.csv and {name} are not of one computation")
    if not results.is_gear_pair:
        pairs = results.tables["pairs.csv"]
        check_pairs(pairs["roller"], pairs["sleeve"], results.rollers)
    check_spectra(results, block)


def check_pairs(roller, sleeve, rollers):
    if not np.all(
        (1 <= np.asarray(roller)) & (roller <= rollers) & (1 <= np.asarray(sleeve)) & (sleeve < rollers)
    ):
        raise InputError("its tables hold rollers or sleeves that the drive of its case does not have")


def check_spectra(results, block):
    """Amplitudes in harmonics.csv and sidebands.csv must be those of the errors."""
    period, cycles = period_of(block.abscissa, results.rollers)
    spectra = {"harmonics.csv": ("harmonic", cycles)} | (
        {"sidebands.csv": ("line", 1)} if "sidebands.csv" in results.tables else {}
    )
    for name, (number, step) in spectra.items():
        table = results.tables[name]
        expected = (
            amplitudes(block.te[0, :, :period])[:, step::step]
            if period
            else np.zeros((len(block.torques), 0))
        )
        if (
            len(table["torque_Nm"]) != expected.size
            or not close(table["torque_Nm"], np.repeat(block.torques, expected.shape[1]))
            or not close(table[number], np.tile(1 + np.arange(expected.shape[1]), len(block.torques)))
            or not close(table["amplitude_um"], expected.ravel())
        ):
            raise InputError(f"te.csv and {name} are not of one computation")


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


def pressure_maps(store, block, rollers):
    """Groups torque_T_position_P / roller_R_sleeve_S of a double-roller run, where the case asks for them."""
    result = []
    for position_name in store.names("pressure_maps"):
        torque, position = numbers_in(r"torque_(\d{1,9})_position_(\d{1,9})", position_name)
        pair_names = store.names(f"pressure_maps/{position_name}")
        if torque >= len(block.torques) or position >= len(block.abscissa) or len(pair_names) > 2 * rollers:
            raise InputError("results.h5 holds pressures of what was not computed")
        for pair_name in pair_names:
            roller, sleeve = numbers_in(r"roller_(\d{1,4})_sleeve_(\d{1,4})", pair_name)
            check_pairs(roller, sleeve, rollers)
            pressure = store.numbers(f"pressure_maps/{position_name}/{pair_name}/pressure", None)
            along, half_length = (
                store.numbers(f"pressure_maps/{position_name}/{pair_name}/{name}", len(pressure))
                for name in ("y", "half_y")
            )
            result.append(
                PressureMap(
                    float(block.torques[torque]),
                    float(block.abscissa[position]),
                    roller,
                    sleeve,
                    along,
                    half_length,
                    pressure,
                )
            )
    return sorted(result, key=lambda map: (map.torque, map.crank_angle, map.sleeve, map.roller))


def numbers_in(pattern, name):
    found = re.fullmatch(pattern, name, re.ASCII)
    if not found:
        raise InputError("results.h5 holds pressures under a name that Flank does not give")
    return [int(number) for number in found.groups()]
