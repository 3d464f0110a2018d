# SPDX-License-Identifier: GPL-2.0-or-later
"""What the page says of a drive over a mesh cycle: the sentence under its title, the table at the top."""
import numpy as np

from error_curves import measures
from figure import text
from mesh_figures import curves_of
from study_figures import design_torques

MOST_VARIANTS = 60  # in the table; designs.csv has all


def subject(results, drive):
    te = results.tables["te.csv"]
    kind = (
        f"study of {len(np.unique(results.tables['designs.csv']['variant']))} variants"
        if results.is_study
        else "run"
    )
    return (
        f"{drive}, {kind}: {len(np.unique(te['torque_Nm']))} torques, {len(np.unique(te['position']))} "
        f"positions. Computed with {results.versions.splitlines()[0]}."
    )


def key_figures(results):
    """Heads, rows and a note."""
    return study_table(results) if results.is_study else run_table(results)


def run_table(results):
    curves = curves_of(results)
    head = [
        "torque N m",
        "mean TE um",
        "peak-to-peak um",
        "A1 um",
        "A2 um",
        "greatest pressure MPa",
        "at edges MPa",
        "mean tangent stiffness N/um",
    ]
    rows = []
    for t, torque in enumerate(curves.torques):
        of_period = measures(curves.te[t, : curves.period], curves.cycles) if curves.period else {}
        amplitudes = [f"{of_period[name]:.4f}" if of_period else "" for name in ("A1_um", "A2_um")]
        rows.append(
            [
                text(torque),
                f"{curves.te[t].mean():.4f}",
                f"{np.ptp(curves.te[t]):.4f}",
                *amplitudes,
                f"{curves.of('max_pressure_MPa')[t].max():.0f}",
                f"{curves.of('edge_pressure_MPa')[t].max():.0f}",
                f"{curves.of('mesh_stiffness_N_per_um')[t].mean():.2f}",
            ]
        )
    note = (
        f"Greatest pressure: {results.mesh_cycle.greatest_pressure}. Pressures at edges stand apart: "
        "there is no half-space, and they depend on the grid."
    )
    return head, rows, note


def study_table(results):
    designs = results.tables["designs.csv"]
    variants = np.unique(designs["variant"])
    head = [
        "variant",
        *(axis.keys[0] for axis in results.axes),
        "T_d by A1 N m",
        "T_d by peak-to-peak N m",
        "greatest torque N m",
        "there: A1 um",
        "peak-to-peak um",
        "greatest pressure MPa",
        "status",
    ]
    rows = []
    for variant in variants[:MOST_VARIANTS]:
        of_variant = np.flatnonzero(designs["variant"] == variant)
        last = of_variant[np.argmax(np.nan_to_num(designs["torque_Nm"][of_variant]))]
        status = designs["status"][last]
        minima = [
            ", ".join(f"{torque:.4g}" for torque in design_torques(designs, variant, by))
            for by in ("A1", "peak_to_peak")
        ]
        values = (
            [
                f"{designs[name][last]:.4g}"
                for name in ("torque_Nm", "A1_um", "peak_to_peak_um", "max_pressure_MPa")
            ]
            if status == "ok"
            else [""] * 4
        )
        rows.append(
            [
                int(variant),
                *(axis.labels[axis.point_of[int(variant)]] for axis in results.axes),
                *minima,
                *values,
                status,
            ]
        )
    more = (
        f"The first {MOST_VARIANTS} of {len(variants)} variants; all are in designs.csv."
        if len(variants) > MOST_VARIANTS
        else ""
    )
    return head, rows, more
