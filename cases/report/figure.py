# SPDX-License-Identifier: GPL-2.0-or-later
"""A figure with the numbers it shows, and how it is written: NAME.svg, NAME.png, NAME.csv."""
import csv
from dataclasses import dataclass

import matplotlib.figure
import numpy as np


@dataclass(frozen=True)
class LeftOut:
    title: str
    reason: str


@dataclass(frozen=True)
class Figure:
    name: str  # of its files
    title: str
    caption: str
    table: dict  # columns of equal length, units in their names: exactly what is drawn
    drawing: matplotlib.figure.Figure
    lacks: LeftOut | None = None  # a part of it


def text(value):
    return f"{value:.9g}" if isinstance(value, (float, np.floating)) else str(value)


def write(figure, folder):
    """Without dates and versions: the same numbers give the same bytes."""
    figure.drawing.savefig(folder / f"{figure.name}.svg", metadata={"Date": None, "Creator": None})
    figure.drawing.savefig(folder / f"{figure.name}.png", metadata={"Software": None})
    with open(folder / f"{figure.name}.csv", "w", newline="", encoding="utf-8") as stream:
        stream.write(f"# {figure.title}\n")
        rows = csv.writer(stream, lineterminator="\n")
        rows.writerow(figure.table)
        rows.writerows([text(value) for value in row] for row in zip(*figure.table.values(), strict=True))


def joined(tables):
    """Tables of the same columns, one under the other."""
    return {name: np.concatenate([np.asarray(table[name]) for table in tables]) for name in tables[0]}
