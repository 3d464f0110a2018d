# SPDX-License-Identifier: GPL-2.0-or-later
"""Tables that are not as Flank writes them, though the manifest fits."""
import os
import random

import result_folders

from checks import SECRET, accepted, refused


def broken_tables(content):
    """What can be wrong with a table whose manifest fits."""
    lines = content.split(b"\n")
    head = next(i for i, line in enumerate(lines) if not line.startswith(b"#"))
    columns = lines[head].split(b",")
    torque, last = columns.index(b"torque_Nm"), len(lines) - 2

    def with_line(number, line):
        return b"\n".join([*lines[:number], line, *lines[number + 1 :]])

    def with_cell(number, column, cell):
        cells = lines[number].split(b",")
        return with_line(number, b",".join([*cells[:column], cell, *cells[column + 1 :]]))

    def without(line, column):
        cells = line.split(b",")
        return b",".join([*cells[:column], *cells[column + 1 :]])

    yield "empty", b""
    yield "comments alone", b"\n".join(lines[:head]) + b"\n"
    yield "head alone", b"\n".join(lines[: head + 1]) + b"\n"
    yield "binary", random.Random(2).randbytes(3000)
    yield "foreign", SECRET * 20
    yield "cut in a row", content[: len(content) * 2 // 3]
    yield "cut in a row, line ended", content[: content.rindex(b",")] + b"\n"
    yield "cut in its head", content[: content.index(lines[head]) + 20]
    yield "the last line less", b"\n".join(lines[:last]) + b"\n"
    yield "a line twice", b"\n".join([*lines[: head + 2], *lines[head + 1 :]])
    yield "a line missing", b"\n".join([*lines[: head + 1], *lines[head + 2 :]])
    yield "column missing", b"\n".join(
        lines[:head] + [without(line, torque) for line in lines[head:-1]] + [b""]
    )
    yield "column renamed", with_line(head, lines[head].replace(b"torque_Nm", b"torque_lbft"))
    yield "column twice", with_line(head, lines[head].replace(b"variant,", b"torque_Nm,"))
    yield "head empty", with_line(head, b"")
    yield "no text", with_line(last, b"\xff\xfe" + lines[last])
    yield "a quote that does not end", with_line(last, b'"' + lines[last])
    yield "a cell too long", with_cell(head + 1, torque, b"1" * 200_000)
    yield "an empty line", with_line(last, lines[last] + b"\n")
    for cell in (
        b"nan",
        b"-nan",
        b"inf",
        b"-inf",
        b"1e999",
        b"1e300",
        b"-3",
        b"0x10",
        b"ten",
        b"\x00",
        b"\x1b[2J",
        b"",
        b"=1+1",
        SECRET.strip(),
    ):
        yield f"a torque of {cell}", with_cell(head + 1, torque, cell)
    if b"position" in columns:
        for cell in (b"-1", b"0.5", b"9999999", b"1e18", b"nan"):
            yield f"a position of {cell}", with_cell(head + 1, columns.index(b"position"), cell)


def tables(cases):
    """Tables that are not as Flank writes them, though the manifest fits."""
    for name in cases.tables:
        for what, content in broken_tables(cases.files[name]):
            if content != cases.files[name]:
                cases.refused(f"{name} {what}", {name: content}, words="")
        cases.refused(f"{name} is missing", {name: None}) if name != "lines.csv" else None
        with cases.folder() as folder:
            os.truncate(folder / name, (1 << 30) + 1)
            listing = (
                (folder / "manifest.txt")
                .read_text()
                .replace(f" {len(cases.files[name])} {name}", f" {(1 << 30) + 1} {name}")
            )
            (folder / "manifest.txt").write_text(listing)
            refused(f"{name} of more than 1 GiB", folder, words="bytes")
    other = "harmonics.csv" if "harmonics.csv" in cases.files else "designs.csv"
    cases.refused(
        "tables in each other's place", {"te.csv": cases.files[other], other: cases.files["te.csv"]}
    )
    cases.refused("a binary summary", {"summary.txt": b"\xff\x00\xfe"})
    te = cases.files["te.csv"]
    last = te.rstrip(b"\n").split(b"\n")[-1].split(b",")
    place = te[: te.index(b"\n0,")].split(b"\n")[-1].split(b",").index(b"te_um")
    row = b",".join([*last[:place], str(float(last[place]) + 0.001).encode(), *last[place + 1 :]])
    cases.refused(
        "te.csv of another run", {"te.csv": te.replace(b",".join(last), row)}, words="not of one computation"
    )


def over_positions(cases):
    """A table that no list names: of other torques or positions it is refused; its numbers are drawn, and
    what else may stand in it is left alone.
    """
    own, name = result_folders.gear_run()["subsurface.csv"], "of_its_own.csv"
    last = own.rstrip(b"\n").split(b"\n")[-1] + b"\n"
    for what, old, new in (
        ("of another torque", b"\n0,50,", b"\n0,51,"),
        ("of another position", b",3,0.75,", b",7,0.75,"),
        ("of another phase", b",0.75,", b",0.7,"),
        ("with a torque that is no number", b"\n0,50,", b"\n0,nan,"),
        ("with a column twice", b",shear_MPa,", b",shear_depth_um,"),
        ("cut in a row", last, last[:-9]),
    ):
        assert old in own, what
        cases.refused(f"{name} {what}", {name: own.replace(old, new)}, words=name)
    for what, content, drawn in (
        ("as it is", own, "shear_MPa,shear_depth_um,von_mises_MPa,von_mises_depth_um"),
        ("with words", own.replace(b"270.1", b"<b>"), "shear_depth_um,von_mises_MPa,von_mises_depth_um"),
        ("with a number beyond all", own.replace(b"40.5", b"1e300"), "shear_MPa,von_mises_MPa,von_mises_dep"),
        ("with a row twice", own + last, ""),
        ("with other columns", own.replace(b"position", b"place"), ""),
        ("binary", SECRET, ""),
    ):
        with cases.folder({name: content}) as folder:
            accepted(f"{name} {what}", folder)
            figure = folder / "figures" / "of_its_own_over_phase.csv"
            heads = figure.read_text().split("\n")[1] if figure.exists() else ""
            assert (f"torque_Nm,phase,{drawn}" in heads) if drawn else not heads, f"{what}: {heads}"
