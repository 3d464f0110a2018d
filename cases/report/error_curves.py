# SPDX-License-Identifier: GPL-2.0-or-later
"""Transmission error over mesh cycle and torque: harmonics, and the torques at which it varies least."""
from dataclasses import dataclass

import numpy as np

from errors import InputError


@dataclass(frozen=True)
class ErrorCurves:
    """Of one variant; T torques by K positions."""

    torques: np.ndarray  # [N m], ascending
    abscissa: np.ndarray  # of the positions, in the unit of the drive
    te: np.ndarray  # [um], T by K
    table: dict  # every other column of te.csv, T by K
    period: int  # positions after which it repeats, 0: it does not
    cycles: int  # mesh cycles in a period

    def of(self, name):
        return self.table[name]

    def mean(self, values):
        """Mean of values (T by K) at every torque, in their unit: over the period, of which no position
        counts twice, or over all positions where it is not known.
        """
        return values[:, : self.period or None].mean(axis=1)

    def at(self, torque):
        return int(np.argmin(np.abs(self.torques - torque)))


def error_curves(te_table, mesh_cycle):
    """From te.csv of a run or of one variant of a study."""
    torques = np.unique(te_table["torque_Nm"])
    order = np.lexsort((te_table["position"], te_table["torque_Nm"]))
    table = {name: values[order].reshape(len(torques), -1) for name, values in te_table.items()}
    abscissa = table[mesh_cycle.abscissa.column][0]
    period = mesh_cycle.abscissa.period(abscissa, te_table["variant"][0])
    return ErrorCurves(torques, abscissa, table["te_um"], table, *period)


def step_of(abscissa):
    return abscissa[1] - abscissa[0] if len(abscissa) > 1 else 0


def period_of_phases(abscissa, _variant):
    """All positions: phases count mesh cycles from 0, and are those of whole ones;
    and how many mesh cycles these are.
    """
    positions = len(abscissa)
    cycles = round(positions * step_of(abscissa))
    if cycles < 1 or not np.allclose(
        abscissa, np.arange(positions) * cycles / positions, rtol=1e-8, atol=1e-8
    ):
        raise InputError("the phases of te.csv are not those of whole mesh cycles")
    return positions, cycles


def as_computed(curves, values):
    """Abscissa and values (T by K) as they are."""
    return curves.abscissa, values


def two_cycles(curves, values):
    """Phase and values (T by K) over two mesh cycles: repeated, or the first two of a hunting period."""
    if curves.cycles > 1:
        shown = curves.abscissa <= 2 + 1e-9
        return curves.abscissa[shown], values[:, shown]
    return np.concatenate([curves.abscissa, 1 + curves.abscissa, [2]]), np.concatenate(
        [values, values, values[:, :1]], axis=1
    )


def amplitudes(te):
    """A_i = 2|c_i|, peak amplitudes of the lines of the spectrum from i = 0 on; the last axis of te is one
    period. Figures show the program's own harmonics.csv: this is what the table is checked by, against te.csv
    (mesh_cycle.check_spectra).
    """
    positions = te.shape[-1]
    result = 2 * np.abs(np.fft.rfft(te)) / positions
    if positions % 2 == 0:
        result[..., -1] /= 2  # the last line is its own mirror
    return result
