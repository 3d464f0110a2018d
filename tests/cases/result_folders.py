# SPDX-License-Identifier: GPL-2.0-or-later
"""Small result folders of made-up numbers that fit each other, as `flank run` and `flank study` lay them out;
and manifests of folders.
"""
import csv
import io
import zlib
from pathlib import Path

import h5py
import numpy as np

FIRST_LINE = "Flank results, format 1. Only the files listed here are ever replaced or removed by Flank."
VERSIONS = "flank 0123456789 (Release)\ncompiler of a test\n"
GEAR_CASE = """title = "a gear pair"
scene = "parallel_axis"
pair.centre_distance_mm = 150
pinion.teeth = 50
gear.teeth = 50
"""
DRIVE_CASE = """title = "a drive"
scene = "double_roller"
drive.rollers = 6
drive.sleeve_circle_radius_mm = 30
model.preset = "exact"
"""
TORQUES, BASE_RADIUS_MM = (50.0, 100.0), 70.0
OVER_TORQUE = "variant,torque_Nm,A1_um,A2_um,peak_to_peak_um,computed"
AMPLITUDES = [[0, 50, 0.3, 0.1, 0.7, 1], [0, 75, 0.3, 0.15, 0.8, 0], [0, 100, 0.3, 0.2, 0.9, 1]]
BOUNDS_OVER_TORQUE = [[0.01, 0.02, 0.03], [0.1, "nan", 0.3], [0.01, 0.02, 0.03]]
DESIGN_TORQUES = [[0, "A1", 75.25, 0.011], [0, "peak_to_peak", 80, 0.5]]


def table(head, rows, comments="# conventions of a test\n"):
    stream = io.StringIO()
    csv.writer(stream, lineterminator="\n").writerows([head.split(","), *rows])
    return (comments + stream.getvalue()).encode("utf-8")


def number(value):
    return f"{value:.9g}"


def store(attributes, datasets):
    """As cases/results/hdf5_file.cpp writes it."""
    stream = io.BytesIO()
    with h5py.File(stream, "w") as file:
        for name, text in attributes.items():
            file.attrs[name] = text
        for name, values in datasets.items():
            kind = np.int32 if name.endswith("variant") else float
            data = file.create_dataset(name, data=np.asarray(values, dtype=kind), track_times=False)
            data.attrs["unit"] = "1"
    return stream.getvalue()


def amplitudes(te):
    """Of the mesh harmonics from the first on, 2|c_i|; the last of an even number is its own mirror."""
    lines = 2 * np.abs(np.fft.rfft(te)) / len(te)
    if len(te) % 2 == 0:
        lines[-1] /= 2
    return lines[1:]


def errors(torque, at):
    """Transmission error [um] at fractions of a period."""
    return 0.1 * torque + 0.3 * np.cos(2 * np.pi * at) + 0.002 * torque * np.cos(4 * np.pi * at + 0.4)


GEAR_START = "variant,torque_Nm,position,phase"
GEAR_TABLES = {  # of a run of a gear pair: their columns
    "te": f"{GEAR_START},te_um,contacts,max_pressure_MPa,edge_pressure_MPa,mesh_stiffness_N_per_um,"
    "secant_stiffness_N_per_um,certificate,te_bound_um,max_pressure_bound_MPa",
    "harmonics": "variant,torque_Nm,harmonic,amplitude_um,phase_deg,aliased,bound_um",
    "pairs": f"{GEAR_START},pair,normal_force_N,load_share,max_pressure_MPa,load_share_bound",
    "lines": f"{GEAR_START},pair,z_mm,pinion_roll_angle_deg,load_per_length_N_per_mm,max_pressure_MPa,"
    "extent_mm,tip_edge_load_N_per_mm",
    "pattern": "variant,torque_Nm,pinion_roll_angle_deg,z_mm,pressure_MPa,gear_roll_angle_deg",
    "modifications": "flank,roll_angle_deg,z_mm,removed_um",
    "root_stress": f"{GEAR_START},body,pair,fillet,z_mm,tensile_stress_MPa,tensile_stress_bound_MPa",
    "subsurface": f"{GEAR_START},max_pressure_MPa,shear_MPa,shear_depth_um,von_mises_MPa,von_mises_depth_um",
    "design_torques": "variant,by,torque_Nm,least_um,least_bound_um",
    "amplitudes_over_torque": f"{OVER_TORQUE},A1_bound_um,A2_bound_um,peak_to_peak_bound_um",
    "error_estimate": "variant,torque_Nm,level,compared_with,mean_te_um,te_rms_um,peak_to_peak_te_um,A1_um,"
    "max_pressure_percent,A2_um,A3_um,load_share,mean_te_shift_um,mean_te_by_bodies_um,"
    "mean_te_by_grid_um,mean_te_by_positions_um,pressure_kind,root_stress_pinion_percent,"
    "root_stress_gear_percent,regular_pressure_MPa,regular_pressure_percent",
    "sidebands": "variant,torque_Nm,line,mesh_order,amplitude_um,phase_deg",
}


def gear_run(positions=4, cycles=1):
    """Every table that a run of a gear pair can have."""
    phases = np.arange(positions * cycles) / positions
    te = np.array([errors(torque, phases / cycles) for torque in TORQUES])
    rows = {name: [] for name in GEAR_TABLES}
    for t, torque in enumerate(TORQUES):
        for k, phase in enumerate(phases):
            add_gear_position(rows, torque, k, phase, te[t, k])
        add_gear_torque(rows, torque, te[t], positions, cycles)
    rows["modifications"] = [
        [flank, roll, z, roll / 5 + z]
        for flank in ("pinion", "gear", "sum")
        for roll in (15, 25)
        for z in (-1, 1)
    ]
    rows["design_torques"] = [[*row, 0.02] for row in DESIGN_TORQUES]
    rows["amplitudes_over_torque"] = [row + bounds for row, bounds in zip(AMPLITUDES, BOUNDS_OVER_TORQUE)]
    if cycles == 1:
        del rows["sidebands"]
    files = {f"{name}.csv": table(GEAR_TABLES[name], rows[name]) for name in rows}
    datasets = {
        "pinion_torque": TORQUES,
        "phase": phases,
        "transmission_error": te,
    }
    return with_store("results.h5", GEAR_CASE, {}, datasets, files)


def add_gear_position(rows, torque, k, phase, te):
    """Rows of one position: one tooth pair and two in turn, their lines; root stress in the first cycle."""
    pairs = (0, -1) if k % 2 else (0,)
    secant = 1000 * torque / BASE_RADIUS_MM / te
    head = [0, number(torque), k, number(phase)]
    depths = [270.1, 40.5, 490.2, 37.5] if k else ["nan"] * 4  # loaded at edges alone
    rows["subsurface"].append([*head, 900.5, *depths])
    of_contact = [f"{te:.9f}", len(pairs), 900.5, 80.25]
    bounds = [0.011, 4 if k else "nan"]
    rows["te"].append([*head, *of_contact, f"{1.2 * secant:.6f}", f"{secant:.6f}", "1.5e-16", *bounds])
    for pair in pairs:
        force = f"{1000 * torque / BASE_RADIUS_MM / len(pairs):.6f}"
        rows["pairs"].append([*head, pair, force, 1 / len(pairs), 900.5, 0.002])
        rows["lines"] += [
            [*head, pair, z, f"{20 + phase + pair + z / 10:.6f}", f"{torque + z:.6f}", 900.5, 1, 0]
            for z in (-1, 0, 1)
        ]
        if phase < 1:
            rows["root_stress"] += [
                [*head, body, pair, fillet, z, f"{torque + k + z:.4f}", "nan"]
                for body in ("pinion", "gear")
                for fillet in ("loaded", "other")
                for z in (-1, 1)
            ]


def add_gear_torque(rows, torque, te, positions, cycles):
    """Rows of all positions of a torque together: spectra, pattern, error estimate."""
    lines = amplitudes(te)
    rows["harmonics"] += [
        [0, number(torque), i, f"{a:.9f}", 0, int(4 * i > positions), 0.001 if i <= 3 else "nan"]
        for i, a in enumerate(lines[cycles - 1 :: cycles], 1)
    ]
    rows["sidebands"] += [
        [0, number(torque), i, number(i / cycles), f"{a:.9f}", 0] for i, a in enumerate(lines, 1)
    ]
    rows["pattern"] += [
        [0, number(torque), roll, z, 10 * roll + z, 44 - roll] for roll in (15, 20, 25) for z in (-1, 0, 1)
    ]
    rows["error_estimate"].append(
        [0, number(torque), "draft", "coarser", 0.01, 0.001, 0.003, 0.0007, 0.05]
        + [0.001, "nan", 0.0002, -0.004, 0.006, 0.003, 0.001, "regular", 2, "nan", 700, 0.05]
    )


DRIVE_START = "variant,torque_Nm,position,crank_angle_deg"
DRIVE_TABLES = {  # of a run of a drive: their columns
    "te": f"{DRIVE_START},te_um,te_arcsec,gear_ratio,contacts,max_pressure_MPa,"
    "edge_pressure_MPa,mesh_stiffness_N_per_um,torsional_stiffness_Nm_per_arcmin,"
    "torsional_stiffness_secant_Nm_per_arcmin,certificate",
    "harmonics": "variant,torque_Nm,harmonic,amplitude_um,phase_deg,aliased",
    "pairs": f"{DRIVE_START},roller,sleeve,flank,normal_force_N,approach_um,lever_mm,mid_pressure_MPa,"
    "edge_pressure_MPa,greatest_cell_pressure_MPa",
    "design_torques": "variant,by,torque_Nm,least_um",
    "amplitudes_over_torque": OVER_TORQUE,
}


def drive_run():
    """Crank angles of one period, with pressure maps at the first."""
    angles = 15.0 * np.arange(4)
    te = np.array([errors(torque, angles / 60) for torque in TORQUES])
    rows = {name: [] for name in DRIVE_TABLES}
    rows["design_torques"], rows["amplitudes_over_torque"] = DESIGN_TORQUES, AMPLITUDES
    datasets = {"torque": TORQUES, "crank_angle": angles, "transmission_error": te}
    datasets |= {"period": [4], "order": [1]}
    for t, torque in enumerate(TORQUES):
        for k, angle in enumerate(angles):
            head, of_te = [0, number(torque), k, number(angle)], [f"{te[t, k]:.9f}", f"{7 * te[t, k]:.9f}"]
            rows["te"].append([*head, *of_te, 5.1, 2, 900.5, 1200.25, 300, 80, 75, "2e-13"])
            rows["pairs"] += [
                [*head, n, n, "drive", f"{10 * torque + n:.6f}", 0.3, 18, 900.5, 1200.25, 1200.25]
                for n in (1, 2)
            ]
        rows["harmonics"] += [
            [0, number(torque), i, f"{a:.9f}", 0, int(i > 1)] for i, a in enumerate(amplitudes(te[t]), 1)
        ]
        for n in (1, 2):
            group = f"pressure_maps/torque_{t}_position_0/roller_{n}_sleeve_{n}"
            columns = {
                "y": [0.5, 1.5, 0.5, 1.5],
                "half_y": [0.5] * 4,
                "pressure": [torque, torque, torque / 2, torque / 3],
            }
            datasets.update({f"{group}/{name}": values for name, values in columns.items()})
    files = {f"{name}.csv": table(columns, rows[name]) for name, columns in DRIVE_TABLES.items()}
    return with_store("results.h5", DRIVE_CASE, {}, datasets, files)


def study():
    """Two axes of two points, of numbers and of texts; the last variant failed. The first one has root stress
    and stress below the surface.
    """
    points = [(amount, shape) for amount in (0, 5) for shape in ("=1+1", 'a "quoted", $long$ name')]
    phases, computed = np.arange(4) / 4, range(len(points) - 1)
    te = np.array([[errors(torque, phases) + v for torque in TORQUES] for v in computed])
    rows, designs = [], []
    for v, (amount, shape) in enumerate(points):
        if v not in computed:
            designs.append([v, amount, shape, "failed: @no contact", *[""] * 12])
            continue
        for t, torque in enumerate(TORQUES):
            rows += [
                [v, number(torque), k, number(p), f"{te[v, t, k]:.9f}", 1, 900.5, 80, 150, "1e-16"]
                for k, p in enumerate(phases)
            ]
            a1, a2 = amplitudes(te[v, t])
            measured = [f"{value:.9f}" for value in (te[v, t].mean(), np.ptp(te[v, t]), a1, a2)]
            designs.append(
                [v, amount, shape, "ok", number(torque), *measured, "75.25;80", "", 900.5, 80, 150]
                + (["", ""] if v else [0.01, 4.5])
            )
    files = {
        "te.csv": table(
            "variant,torque_Nm,position,phase,te_um,contacts,max_pressure_MPa,edge_pressure_MPa,"
            "mesh_stiffness_N_per_um,certificate",
            rows,
        ),
        "designs.csv": table(
            "variant,pinion.tip_relief.amount_um,title,status,torque_Nm,mean_te_um,peak_to_peak_um,"
            "A1_um,A2_um,T_d_by_A1_Nm,T_d_by_peak_to_peak_Nm,max_pressure_MPa,edge_pressure_MPa,"
            "mean_mesh_stiffness_N_per_um,mean_te_bound_um,max_pressure_bound_MPa",
            designs,
        ),
    }
    of_first = gear_run(len(phases))
    files |= {name: of_first[name] for name in ("root_stress.csv", "subsurface.csv", "error_estimate.csv")}
    datasets = {"variant": computed, "torque": TORQUES, "phase": phases, "te": te}
    axes = (
        "study of pinion.tip_relief.amount_um: (0) (5)\n"
        'study of title: ("=1+1") (\'a "quoted", $long$ name\')\n'
    )
    summary = (
        f"a study\nstudy: {len(points)} variants, 1 failed; certificate: worst relative violation 1.00e-16\n"
    )
    datasets = {f"block_0/{name}": values for name, values in datasets.items()}
    return with_store("study.h5", GEAR_CASE, {"study": axes}, datasets, files, summary)


def with_store(name, case, attributes, datasets, files, summary="a run\ncertificate: holds\n"):
    given, resolved = (
        ("case", "case_resolved") if name == "study.h5" else ("case_as_given", "case_as_resolved")
    )
    attributes = {given: f"# as given\n{case}", resolved: case, "versions": VERSIONS, **attributes}
    return {
        **files,
        name: store(attributes, datasets),
        "summary.txt": summary.encode(),
        "case.toml": case.encode(),
    }


def manifest(files, command, case=GEAR_CASE):
    """Text of manifest.txt, of files by their paths."""
    lines = [f"{zlib.crc32(content):08x} {len(content)} {path}" for path, content in sorted(files.items())]
    return "\n".join(
        [
            FIRST_LINE,
            "program: flank 0123456789",
            f"command: {command}",
            f"files: {len(lines)}",
            *lines,
            "case:",
            case,
        ]
    )


def command_of(files):
    return "study" if "study.h5" in files else "run"


def write(folder, files):
    """A finished result folder."""
    for path, content in files.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_bytes(content)
    (folder / "manifest.txt").write_text(manifest(files, command_of(files)), encoding="utf-8")


def read(folder):
    """The files of a real result folder that a report may read, without an earlier report."""
    folder = Path(folder)
    own = [
        path
        for path in folder.iterdir()
        if path.is_file() and path.name not in ("manifest.txt", "report.html")
    ]
    return {path.name: path.read_bytes() for path in own}
