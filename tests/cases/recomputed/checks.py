# SPDX-License-Identifier: GPL-2.0-or-later
"""What the recomputations share: comparisons that are counted, tables by column names,
the program under test.
"""
import csv, math, os, pathlib, subprocess, sys

import numpy

flank = pathlib.Path(sys.argv[1]).resolve()
arcsec = math.pi / 180 / 3600
failures, checks = [], 0
first_is_enough = os.environ.get("GTEST_FAIL_FAST") == "1"  # as for the other tests


def check(holds, what):
    global checks
    checks += 1
    if not holds and len(failures) < 40:
        failures.append(what)
        if first_is_enough:
            sys.exit(f"FAILED: {what}")


def near(one, other, what, relative=0.0, absolute=0.0):
    """Both may be arrays.
    Tolerances: `absolute` is half a unit of the last digit that a column prints (twice,
    where both are printed).
    """
    one, other = numpy.asarray(one, dtype=float), numpy.asarray(other, dtype=float)
    if one.shape != other.shape:
        return check(False, f"{what}: {one.shape} against {other.shape} numbers")
    off = numpy.abs(one - other) - absolute - relative * numpy.abs(other)
    worst = int(numpy.argmax(off)) if off.size else 0
    check(
        off.size > 0 and not off.flat[worst] > 0 and not numpy.isnan(off).any(),
        f"{what}: {one.flat[worst] if one.size else None!r}, recomputed "
        f"{other.flat[worst] if one.size else None!r} (number {worst})",
    )


class Table:
    """Columns of a CSV file by name."""

    def __init__(self, path):
        with open(path) as file:
            reader = csv.DictReader(line for line in file if not line.startswith("#"))
            self.rows, self.names = list(reader), list(reader.fieldnames)

    def __getitem__(self, name):
        return numpy.array([float(row[name]) if row[name] else math.nan for row in self.rows])

    def text(self, name):
        return [row[name] for row in self.rows]


def run(*arguments, code=0):
    ended = subprocess.run([str(flank), *map(str, arguments)], capture_output=True, text=True)
    if ended.returncode != code:
        sys.exit(
            f"FAILED: flank {' '.join(map(str, arguments))}: exit code {ended.returncode}\n{ended.stderr}"
        )
    return ended.stdout


def harmonics(values):
    """Amplitudes and phases [deg] of value = mean + sum A_i cos(2 pi i k/n + phase_i)."""
    n = len(values)
    c = numpy.fft.fft(values) / n
    return [
        (abs(c[i]) * (1 if 2 * i == n else 2), math.degrees(numpy.angle(c[i]))) for i in range(1, n // 2 + 1)
    ]


def same_phase(one, other):
    return abs((one - other + 180) % 360 - 180)


def check_harmonics(table, te_by_torque, what):
    for torque, te in te_by_torque.items():
        rows = [row for row in table.rows if float(row["torque_Nm"]) == torque]
        expected = harmonics(te)
        check(
            len(rows) == len(expected),
            f"{what}: {len(rows)} harmonics at {torque} N m, of {len(te)} positions {len(expected)}",
        )
        for row, (amplitude, phase) in zip(rows, expected):
            near(
                float(row["amplitude_um"]),
                amplitude,
                f"{what}: A{row['harmonic']} at {torque} N m",
                absolute=3e-9,
            )
            if amplitude > 1e-4:
                check(
                    same_phase(float(row["phase_deg"]), phase) < 1e-3,
                    f"{what}: phase of A{row['harmonic']} at {torque} N m",
                )
            check(
                int(row["aliased"]) == int(4 * int(row["harmonic"]) > len(te)),
                f"{what}: aliased, A{row['harmonic']}",
            )


def unit(dataset):
    value = dataset.attrs.get("unit", dataset.attrs.get("units"))
    return value.decode() if isinstance(value, bytes) else value
