# SPDX-License-Identifier: GPL-2.0-or-later
"""A figure with the numbers it shows, and its files: NAME.svg, NAME.png, NAME.csv."""
import csv
import io
import re
from dataclasses import dataclass

import matplotlib.figure
import numpy as np

from errors import one_line
from tables import NUMBER


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


def cell(value):
    """A text that a spreadsheet would take for a formula gets an apostrophe."""
    if (
        isinstance(value, str)
        and value.startswith(("=", "+", "-", "@", "\t", "\r"))
        and not re.fullmatch(NUMBER, value, re.ASCII)
    ):
        return f"'{value}"
    return text(value)


def files_of(figure):
    """Name and content of its files, without dates and versions: the same numbers give the same bytes."""
    for kind, metadata in (("svg", {"Date": None, "Creator": None}), ("png", {"Software": None})):
        picture = io.BytesIO()
        figure.drawing.savefig(picture, format=kind, metadata=metadata)
        figure.drawing.set_layout_engine(None)  # it is laid out once
        yield f"{figure.name}.{kind}", picture.getvalue()
    stream = io.StringIO()
    stream.write(f"# {one_line(figure.title)}\n")
    rows = csv.writer(stream, lineterminator="\n")
    rows.writerow(map(cell, figure.table))
    rows.writerows(map(cell, row) for row in zip(*figure.table.values(), strict=True))
    yield f"{figure.name}.csv", stream.getvalue().encode("utf-8")


def joined(tables):
    """Tables of the same columns, one under the other."""
    return {name: np.concatenate([np.asarray(table[name]) for table in tables]) for name in tables[0]}
