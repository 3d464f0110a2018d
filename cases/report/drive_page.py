# SPDX-License-Identifier: GPL-2.0-or-later
"""What the page says of a drive over a mesh cycle: the sentence under its title, the table at the top."""
import numpy as np

from figure import text
from mesh_figures import curves_of
from results import rows
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


def shown_harmonics(results, curves, torque):
    """A1 and A2 [um] of a torque from harmonics.csv, as the table at the top shows them: a dash where there
    are too few positions for the harmonic, nothing where the error does not repeat.
    """
    if not curves.period:
        return ["", ""]
    of_torque = rows(results.tables["harmonics.csv"], results.tables["harmonics.csv"]["torque_Nm"] == torque)
    amplitude = dict(zip(of_torque["harmonic"], of_torque["amplitude_um"]))
    return [f"{amplitude[harmonic]:.4f}" if harmonic in amplitude else "-" for harmonic in (1, 2)]


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
    table = []
    mean_te, mean_stiffness = curves.mean(curves.te), curves.mean(curves.of("mesh_stiffness_N_per_um"))
    for t, torque in enumerate(curves.torques):
        table.append(
            [
                text(torque),
                f"{mean_te[t]:.4f}",
                f"{np.ptp(curves.te[t]):.4f}",
                *shown_harmonics(results, curves, torque),
                f"{curves.of('max_pressure_MPa')[t].max():.0f}",
                f"{curves.of('edge_pressure_MPa')[t].max():.0f}",
                f"{mean_stiffness[t]:.2f}",
            ]
        )
    note = (
        f"Greatest pressure: {results.mesh_cycle.greatest_pressure}. Pressures at edges stand apart: "
        "there is no half-space, and they depend on the grid."
    )
    return head, table, note


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
    table = []
    for variant in variants[:MOST_VARIANTS]:
        of_variant = np.flatnonzero(designs["variant"] == variant)
        computed = of_variant[designs["status"][of_variant] == "ok"]
        failed = of_variant[designs["status"][of_variant] != "ok"]
        last = computed[np.argmax(designs["torque_Nm"][computed])] if len(computed) else failed[0]
        minima = [
            ", ".join(f"{torque:.4g}" for torque in design_torques(designs, variant, by))
            for by in ("A1", "peak_to_peak")
        ]
        values = (
            [
                f"{designs[name][last]:.4g}"
                for name in ("torque_Nm", "A1_um", "peak_to_peak_um", "max_pressure_MPa")
            ]
            if len(computed)
            else [""] * 4
        )
        table.append(
            [
                int(variant),
                *(axis.labels[axis.point_of[int(variant)]] for axis in results.axes),
                *minima,
                *values,
                "; ".join(sorted({*designs["status"][failed]})) or "ok",
            ]
        )
    more = (
        f"The first {MOST_VARIANTS} of {len(variants)} variants; all are in designs.csv."
        if len(variants) > MOST_VARIANTS
        else ""
    )
    return head, table, more
