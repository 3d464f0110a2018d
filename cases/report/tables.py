# SPDX-License-Identifier: GPL-2.0-or-later
"""Tables of a result folder: which columns the figures use, and what may stand in them."""
import csv
import io
import itertools
import re

import numpy as np

from errors import InputError, plain_text

MOST = 1e12  # no quantity of a drive is greater, in any unit of the tables
ROWS_AT_ONCE = 20_000
NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{1,3})?"
TORQUES = re.compile(rf"(?:{NUMBER}(?:;{NUMBER})*)?", re.ASCII)


def numbers(cells):
    values = np.array([float(cell) for cell in cells])
    if not np.all(np.abs(values) <= MOST):  # not-a-number is not either
        raise ValueError
    return values


def numbers_or_empty(cells):
    values = np.array([float(cell) if cell else np.nan for cell in cells])
    if not all(abs(value) <= MOST or not cell for cell, value in zip(cells, values)):
        raise ValueError
    return values


def numbers_or_unknown(cells):
    """Where nothing was estimated stands nan."""
    values = np.array([float(cell or "nan") for cell in cells])
    if not all(abs(value) <= MOST or cell in ("", "nan") for cell, value in zip(cells, values)):
        raise ValueError
    return values


def numbers_or_texts(cells):
    """Of a column that nothing is known of."""
    try:
        return numbers_or_unknown(cells)
    except ValueError:
        return texts(cells)


def whole_numbers(cells):
    values = numbers(cells)
    if np.any(values != np.round(values)):
        raise ValueError
    return values


def counts(cells):
    values = whole_numbers(cells)
    if np.any(values < 0):
        raise ValueError
    return values


def texts(cells):
    known = {cell: plain_text(cell) for cell in set(cells)}
    return np.array([known[cell] for cell in cells], dtype=object)


def lists_of_torques(cells):
    if not all(TORQUES.fullmatch(cell) for cell in set(cells)):
        raise ValueError
    return texts(cells)


def choice(*allowed):
    def kind(cells):
        if not set(cells) <= set(allowed):
            raise ValueError
        return np.array(cells, dtype=object)

    return kind


KINDS = {  # of columns that several scenes have
    **dict.fromkeys("variant position contacts harmonic aliased computed".split(), counts),
    "by": choice("A1", "peak_to_peak"),
    **dict.fromkeys("A1_um A2_um".split(), numbers_or_unknown),  # too few positions may not show them
    "status": texts,
    **dict.fromkeys("T_d_by_A1_Nm T_d_by_peak_to_peak_Nm".split(), lists_of_torques),
}


def read_table(name, content, columns, own_kinds={}, others=numbers, keys=()):
    """Columns by name, and the comments at the head of the table.
    own_kinds: of the scene's columns; others: kind of the columns that are in neither list;
    keys: columns of a study's axes, numbers or texts.
    """
    kinds = {column: {**KINDS, **own_kinds}.get(column, others) for column in columns}
    kinds.update(dict.fromkeys(keys, texts))
    if not content.endswith(b"\n"):
        raise InputError(f"{name} ends in the middle of a line")
    stream = io.TextIOWrapper(io.BytesIO(content), encoding="utf-8", newline="\n")
    try:
        return columns_of(name, stream, kinds, keys)
    except (UnicodeDecodeError, csv.Error):
        raise InputError(f"{name} is not a table as Flank writes it") from None


def heads_of(content):
    """The columns of a table by its first line; none where there is no such line."""
    for line in io.BytesIO(content):
        if not line.startswith(b"#"):
            return plain_text(line.decode("utf-8", "replace").strip()).split(",")
    return []


def columns_of(name, stream, kinds, keys):
    line, comments = next(stream), []
    while line.startswith("#"):
        comments.append(plain_text(line[1:].strip()))
        line = next(stream, "")
    head = next(csv.reader([line], strict=True), [])
    lacking = [column for column in kinds if head.count(column) != 1]
    if lacking:
        raise InputError(
            f"{name} has no column {', '.join(map(plain_text, lacking))}; it is of another version of Flank"
        )
    places = {column: head.index(column) for column in kinds}
    parts, first = {column: [] for column in kinds}, len(comments) + 2
    rows = csv.reader(stream, strict=True)
    while part := list(itertools.islice(rows, ROWS_AT_ONCE)):
        for number, row in enumerate(part, first):
            if len(row) != len(head):
                raise InputError(f"{name}, line {number}: {len(row)} cells for {len(head)} columns")
        cells = list(zip(*part))
        for column, kind in kinds.items():
            parts[column].append(converted(name, column, kind, cells[places[column]], first))
        first += len(part)
    table = {column: np.concatenate(found) if found else kinds[column](()) for column, found in parts.items()}
    return {**table, **{key: numbers_where_all(table[key]) for key in keys}}, comments


def converted(name, column, kind, cells, first):
    """A column's cells; the line that is wrong is looked for only where one is."""
    try:
        return kind(cells)
    except ValueError:
        pass
    for number, cell in enumerate(cells, first):
        try:
            kind((cell,))
        except ValueError:
            raise InputError(
                f"{name}, line {number}: what stands in column {column} is not allowed there"
            ) from None
    raise AssertionError(column)


def numbers_where_all(values):
    """Numbers where every cell is one, else the texts."""
    known = set(values)
    if not all(re.fullmatch(NUMBER, cell, re.ASCII) and abs(float(cell)) <= MOST for cell in known):
        return values
    return np.array([float(cell) for cell in values])
