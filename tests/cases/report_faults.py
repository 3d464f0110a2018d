#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""report_faults.py REPORT_SCRIPT [FOLDER ...]: `flank report` of damaged, hostile and foreign folders,
without memory, disk, permission or output, and stopped by signals. It must end with one line and the right
exit code, and leave everything as it was. Without folders: of small ones of made-up numbers.
"""
import contextlib
import csv
import fcntl
import io
import os
import random
import resource
import shutil
import signal
import socket
import stat
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree
import zlib
from html import unescape
from pathlib import Path

sys.dont_write_bytecode = True
import h5py
import numpy as np

import result_folders

SECRET = b"root:x:0:0:a foreign file\n"
HOSTILE = "<script>alert(1)</script> & \"q\" 'a' \x1b[31m"
NOBODY = 65534
MUTATIONS = int(os.environ.get("FLANK_MUTATIONS", 20))  # 200 on record
# Each fault of a table or a store is tried on one of three kinds of results, in turn; on record 1: on all.
KINDS = int(os.environ.get("FLANK_REPORT_KINDS", 3))
SCRIPT = os.path.abspath(sys.argv[1])
COUNT = {"passed": 0}


def snapshot(folder):
    """Everything in a folder: kind and permissions, and what it holds or points to."""
    found = {}
    for path in sorted(folder.rglob("*")):
        mode = path.lstat().st_mode
        content = path.read_bytes() if stat.S_ISREG(mode) and path.stat().st_size < 1 << 26 else None
        found[str(path.relative_to(folder))] = (mode, os.readlink(path) if stat.S_ISLNK(mode) else content)
    return found


def started(folder, **options):
    streams = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "stdin": subprocess.DEVNULL}
    own = options.pop("preexec_fn", lambda: None)

    def as_flank_does():  # `flank report` lets signals wait until the script can take them
        signal.pthread_sigmask(signal.SIG_BLOCK, (signal.SIGINT, signal.SIGTERM, signal.SIGHUP))
        own()

    script = options.pop("script", SCRIPT)
    return subprocess.Popen([sys.executable, script, folder], preexec_fn=as_flank_does, **(streams | options))


def report(folder, **options):
    with started(folder, **options) as process:
        try:
            out, said = process.communicate(timeout=120)
        except subprocess.TimeoutExpired:
            process.kill()
            raise AssertionError(f"{folder}: the report hangs") from None
    return process.returncode, out or b"", said or b""


def one_line(said):
    text = said.decode("utf-8")
    return text.endswith("\n") and text[:-1].isprintable() and len(text) > 20 and "Traceback" not in text


def refused(what, folder, codes=(2,), words="", **options):
    """One line, one of these exit codes, nothing changed, nothing of a foreign file said."""
    before = snapshot(folder)
    code, out, said = report(folder, **options)
    assert code in codes, f"{what}: exit code {code}: {said}"
    assert one_line(said) and not out, f"{what}: said {said} {out}"
    assert SECRET[:10] not in said and b"\x1b" not in said, f"{what}: said {said}"
    assert words.encode() in said, f"{what}: said {said}"
    assert snapshot(folder) == before, f"{what}: changed the folder"
    COUNT["passed"] += 1


def accepted(what, folder, **options):
    code, out, said = report(folder, **options)
    assert code == 0 and not said and out.startswith(b"report in "), f"{what}: exit code {code}: {said}"
    check_manifest(folder)
    COUNT["passed"] += 1


def manifest_entries(folder):
    lines = (folder / "manifest.txt").read_text(encoding="utf-8").split("\ncase:\n")[0].split("\n")
    assert lines[3] == f"files: {len(lines) - 4}"
    return {
        path: (checksum, int(size)) for checksum, size, path in (line.split(" ", 2) for line in lines[4:])
    }


def check_manifest(folder):
    for path, (checksum, size) in manifest_entries(folder).items():
        content = (folder / path).read_bytes()
        assert (checksum, size) == (f"{zlib.crc32(content):08x}", len(content)), path
    assert not list(folder.glob(".report-*")), "something stays beside the report"


class Cases:
    """Copies of a result folder, each with its own fault."""

    def __init__(self, files, work, kind=None):
        """kind: which of the faults are tried, of every KINDS the one of this number; none: all of them."""
        self.files, self._work, self._number = files, work, 0
        self._kind, self._asked = kind, 0
        self.tables = [
            name
            for name in files
            if name in ("te.csv", "harmonics.csv", "pairs.csv", "lines.csv", "designs.csv")
        ]
        self.store = "study.h5" if "study.h5" in files else "results.h5"

    @contextlib.contextmanager
    def folder(self, changes=(), name=""):
        """changes: other contents of files, of which the manifest knows; None: not there."""
        self._number += 1
        folder = self._work / (name or f"case_{self._number}")
        files = {
            path: content for path, content in {**self.files, **dict(changes)}.items() if content is not None
        }
        result_folders.write(folder, files)
        yield folder
        shutil.rmtree(folder)

    def refused(self, what, changes, **options):
        self._asked += 1
        if self._kind is not None and self._asked % KINDS != self._kind % KINDS:
            return
        with self.folder(changes) as folder:
            refused(what, folder, **options)


def broken_manifests(good):
    """What can be wrong with a manifest, in its parts or cut off."""
    lines = good.split(b"\n")
    table = lines[4].split(b" ", 2)
    yield "empty", b""
    yield "binary", random.Random(1).randbytes(5000)
    yield "foreign", SECRET
    yield "another format", good.replace(b"format 1.", b"format 2.")
    yield "no case", good.split(b"\ncase:")[0]
    yield "no program", good.replace(b"program:", b"programme:")
    yield "another command", good.replace(b"command: ", b"command: a")
    yield "fewer files", good.replace(lines[3], b"files: 1")
    yield "more files", good.replace(lines[3], b"files: 999999999999")
    yield "a file twice", good.replace(lines[3], lines[3][:-1] + b"9").replace(
        lines[4], lines[4] + b"\n" + lines[4]
    )
    yield "no checksum", good.replace(table[0], b"zzzzzzzz")
    yield "a negative size", good.replace(b" " + table[1] + b" ", b" -1 ")
    no_text = good.replace(b"case:\n", b"case:\n\xff\xfe")
    if no_text != good:
        yield "no text", no_text
    yield "with escape codes", good.replace(table[2], b"\x1b[2Jte.csv")
    for path in (b"../te.csv", b"/etc/passwd", b"a/../../te.csv", b"./te.csv", b"a//b", b"manifest.txt"):
        yield f"with {path.decode()}", good.replace(table[2], path)
    for length in (
        1,
        len(lines[0]),
        good.index(b"files:") + 3,
        good.index(b"\ncase:") - 5,
        good.index(b"\ncase:") + 3,
    ):
        yield f"cut after {length}", good[:length]


def manifests(cases):
    """No manifest, or a damaged one."""
    with cases.folder() as folder:
        manifest = folder / "manifest.txt"
        good = manifest.read_bytes()
        manifest.unlink()
        refused("no manifest", folder, words="holds no finished results of Flank (no manifest.txt)")
        (folder / "unfinished").mkdir()
        refused("unfinished", folder, words="--resume")
        (folder / "unfinished").rmdir()
        for what, content in broken_manifests(good):
            manifest.write_bytes(content)
            refused(f"manifest {what}", folder, words="manifest.txt")
        entry = good.split(b"\n")[4]
        manifest.write_bytes(good.replace(entry, bytes([entry[0] ^ 1]) + entry[1:]))
        refused("manifest with another checksum", folder)
    manifests_of_other_files(cases)
    files_of_other_manifests(cases)


def manifests_of_other_files(cases):
    """A manifest that lists what no result folder has."""
    for path in (
        "figures/sub",
        "figures/sub/a.svg",
        "figures/a.txt",
        "fields/sub",
        "fields/sub/a.vtu",
        "own/a",
    ):
        with cases.folder({path: b""}) as folder:
            refused(f"manifest with {path}", folder, words="manifest.txt")
            if path.endswith("/sub"):
                (folder / path).unlink()
                (folder / path).mkdir()
                refused(f"manifest with {path}, a folder", folder, words="manifest.txt")


def files_of_other_manifests(cases):
    """Files that are not as the manifest has them, or that it does not have."""
    for name in [*cases.tables, cases.store, "summary.txt", "case.toml"]:
        content = cases.files[name]
        with cases.folder() as folder:
            for what, other in {
                "cut": content[:-7],
                "longer": content + b"\n",
                "other": content[:-2] + b"7\n",
                "gone": None,
            }.items():
                (folder / name).unlink(missing_ok=True)
                if other is not None:
                    (folder / name).write_bytes(other)
                refused(f"{name} {what}, manifest as it was", folder, words=name)
            (folder / name).write_bytes(content)
            if name == "case.toml":  # a report does not read it
                continue
            files = {path: content for path, content in cases.files.items() if path != name}
            (folder / "manifest.txt").write_text(
                result_folders.manifest(files, result_folders.command_of(cases.files))
            )
            refused(f"{name} not listed", folder, words=name)


def half_in_place(cases):
    """New results that a killed run had begun to put in place; a folder of somebody's own that looks so."""
    with cases.folder() as folder:
        (folder / "unfinished").mkdir()
        shutil.copy(folder / "manifest.txt", folder / "unfinished")
        accepted("a folder of the user's called unfinished", folder)
        (folder / "unfinished/flank.txt").write_text("Unfinished results of Flank, format 1.\nrun\n")
        refused("results half in place", folder, words="put in place")
        (folder / "manifest.txt").unlink()
        refused("the first results half in place", folder, words="put in place")


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


def changed_store(content, change):
    stream = io.BytesIO(content)
    with h5py.File(stream, "r+") as file:
        change(file)
    return stream.getvalue()


def replaced(name, values, **options):
    def change(file):
        old = file[name][()]
        del file[name]
        file.create_dataset(name, data=values(old), track_times=False, **options)

    return change


def stores(cases):
    """HDF5 files that are not as Flank writes them, though the manifest fits."""
    content, is_study = cases.files[cases.store], cases.store == "study.h5"
    for length in (0, 7, 8, 60, 96, 200, len(content) // 3, len(content) // 2, len(content) - 1):
        cases.refused(f"{cases.store} cut after {length}", {cases.store: content[:length]}, words=cases.store)
    other = {
        "binary": random.Random(3).randbytes(9000),
        "foreign": SECRET,
        "longer": content + b"\0" * 8,
        "no HDF5": b"\x88" + content[1:],
    }
    for what, broken in other.items():
        cases.refused(f"{cases.store} {what}", {cases.store: broken}, words=cases.store)
    with h5py.File(io.BytesIO(content)) as file:
        te = "block_0/te" if is_study else "transmission_error"
        torque = "block_0/torque" if is_study else "torque" if "torque" in file else "pinion_torque"
        of_gears = ("pinion_base_radius", "gear_base_radius", "line_of_action")
        lengths = [name for name in of_gears if name in file]
        periods = [name for name in ("period", "order") if name in file]
    attributes = ["study", "case", "case_resolved"] if is_study else ["case_as_given", "case_as_resolved"]
    changes = {
        **changed_numbers(te, torque),
        **changed_links(te),
        **changed_texts(attributes),
        **changed_lengths(lengths),
        **changed_periods(periods),
    }
    with tempfile.TemporaryDirectory() as outside:
        raw = Path(outside) / "raw"
        raw.write_bytes(SECRET * 100)
        changes["numbers of another file"] = replaced_by_external(te, str(raw))
        os.mkfifo(Path(outside) / "pipe")
        changes["numbers of a pipe"] = replaced_by_external(te, str(Path(outside) / "pipe"))
        for what, change in changes.items():
            cases.refused(f"{cases.store}: {what}", {cases.store: changed_store(content, change)})
    newest = io.BytesIO()
    with h5py.File(io.BytesIO(content)) as old, h5py.File(newest, "w", libver="latest") as file:
        for name in old:
            old.copy(name, file)
        file.attrs.update(dict(old.attrs))
    cases.refused(f"{cases.store} of another version of HDF5", {cases.store: newest.getvalue()}, words="HDF5")


def changed_numbers(te, torque):
    """Changes of a store: transmission errors or torques are not there, other ones, or of other kinds."""
    return {
        "no TE": lambda file: file.__delitem__(te),
        "no torques": lambda file: file.__delitem__(torque),
        "a group in the place of TE": lambda file: (file.__delitem__(te), file.create_group(te)),
        "TE of another shape": replaced(te, lambda old: old.T),
        "TE without an axis": replaced(te, lambda old: old.ravel()),
        "a torque more": replaced(torque, lambda old: np.append(old, 1e3)),
        "a torque twice": replaced(torque, lambda old: old * 0 + 50),
        "TE of other results": replaced(te, lambda old: old + 0.001),
        "not-a-number in it": replaced(te, lambda old: old * np.nan),
        "infinite numbers": replaced(te, lambda old: old + np.inf),
        "huge numbers": replaced(te, lambda old: old * 1e300),
        "single precision": replaced(te, lambda old: old.astype("f4")),
        "big endian": replaced(te, lambda old: old.astype(">f8")),
        "whole numbers": replaced(te, lambda old: old.astype("i8")),
        "texts": replaced(te, lambda old: old.astype("S8")),
        "compressed": replaced(te, lambda old: old, compression="gzip"),
        "a scalar": replaced(te, lambda old: 1.0),
    }


def changed_periods(names):
    """Changes of a store of a drive: how many positions its period has, and how many pitches."""
    changes = {}
    for name in names:
        changes[f"no {name}"] = lambda file, name=name: file.__delitem__(name)
        for value in (-1, 0, 2, 3, 0.5, 1e9):
            changes[f"{name} of {value:g}"] = replaced(name, lambda old, value=value: 0.0 * old + value)
    return changes


def changed_links(te):
    """Changes of a store: links in the place of the transmission errors."""
    return {
        "a soft link": lambda file: (file.move(te, "moved"), file.__setitem__(te, h5py.SoftLink("/moved"))),
        "a link to another file": lambda file: (
            file.__delitem__(te),
            file.__setitem__(te, h5py.ExternalLink("/etc/passwd", "/x")),
        ),
        "a link to itself": lambda file: (
            file.__delitem__(te),
            file.__setitem__(te, h5py.SoftLink(f"/{te}")),
        ),
        "a group that holds itself": lambda file: (file.__delitem__(te), file.__setitem__(te, file["/"])),
    }


def changed_texts(attributes):
    """Changes of a store: its texts, of which the last of `attributes` is the resolved case."""
    changes = {
        "numbers in a text": lambda file: file.attrs.__setitem__("versions", 3.0),
        "a list of texts": lambda file: file.attrs.__setitem__("versions", ["a", "b"]),
        "no versions": lambda file: file.attrs.__setitem__("versions", " \n"),
    }
    for name in [*attributes, "versions"]:
        changes[f"no {name}"] = lambda file, name=name: file.attrs.__delitem__(name)
    case = attributes[-1]
    for what, text in {
        "no case": "",
        "another scene": 'scene = "worm"\n',
        "no number of rollers": 'scene = "double_roller"\ndrive.rollers = 1e999\n',
        "binary case": "\x1b\x01\x02",
    }.items():
        changes[what] = lambda file, text=text: file.attrs.__setitem__(case, text)
    return changes


def changed_lengths(lengths):
    """Changes of a store: a length of the pair's geometry is not there, there twice or no length."""
    changes = {}
    for name in lengths:
        changes[f"no {name}"] = lambda file, name=name: file.__delitem__(name)
        changes[f"two of {name}"] = replaced(name, lambda old: np.append(old, old))
        for factor in (0, -1, 1e300, 1e-300, np.nan):
            changes[f"{name} times {factor:g}"] = replaced(name, lambda old, factor=factor: old * factor)
    return changes


def replaced_by_external(name, path):
    def change(file):
        shape = file[name].shape
        del file[name]
        kind, space, properties = (
            h5py.h5t.IEEE_F64LE,
            h5py.h5s.create_simple(shape),
            h5py.h5p.create(h5py.h5p.DATASET_CREATE),
        )
        properties.set_external(path.encode(), 0, h5py.h5f.UNLIMITED)
        h5py.h5d.create(file.id, name.encode(), kind, space, properties)

    return change


def special_files(cases):
    """Pipes, devices, folders and links in the place of a file: none is opened."""

    def a_socket(path):
        there = os.getcwd()
        os.chdir(path.parent)  # its name may be longer than a socket's
        with socket.socket(socket.AF_UNIX) as unix:
            unix.bind(path.name)
        os.chdir(there)

    def a_device(path):
        os.mknod(path, 0o666 | stat.S_IFCHR, os.makedev(1, 5))

    kinds = {
        "a pipe": os.mkfifo,
        "a folder": os.mkdir,
        "a socket": a_socket,
        "a link to itself": lambda path: path.symlink_to(path.name),
        "a link to nothing": lambda path: path.symlink_to("nowhere"),
        "a link to a device": lambda path: path.symlink_to("/dev/zero"),
        "a link to a foreign file": lambda path: path.symlink_to("../foreign"),
        "a link to another table": lambda path: path.symlink_to("case.toml"),
        "a device": a_device,
    }
    with cases.folder() as folder:
        (folder.parent / "foreign").write_bytes(SECRET)
        for name in ("manifest.txt", "te.csv", cases.store, "summary.txt", "figures", "report.html"):
            for what, make in kinds.items():
                if name == "figures" and what == "a folder":
                    continue
                kept = (folder / name).read_bytes() if (folder / name).exists() else None
                (folder / name).unlink(missing_ok=True)
                try:
                    make(folder / name)
                except PermissionError:
                    continue  # not everyone makes devices
                finally_there = (folder / name).lstat()
                refused(f"{what} in the place of {name}", folder)
                shutil.rmtree(folder / name) if stat.S_ISDIR(finally_there.st_mode) else (
                    folder / name
                ).unlink()
                if kept is not None:
                    (folder / name).write_bytes(kept)
        assert (folder.parent / "foreign").read_bytes() == SECRET


def folders(cases, work):
    """What may be given as the folder."""
    (work / "file").write_bytes(SECRET)
    os.mkfifo(work / "pipe")
    (work / "loop").symlink_to("loop")
    (work / "empty").mkdir()
    names = [
        "nowhere",
        "file",
        "pipe",
        "loop",
        "empty",
        "",
        "\x1b[2J\nname\r",
        "name\x07",
        "/dev/null",
        "/dev/zero",
        "/proc/self/mem",
        "n" * 5000,
    ]
    for name in names:
        code, out, said = report(str(work / name) if name else "")
        assert code == 2 and one_line(said) and not out, f"{name!r}: {code} {said}"
        assert len(said) < 250, f"a line of {len(said)} letters: {said}"
        COUNT["passed"] += 1
    code, out, said = report(os.fsencode(work) + b"/\xff\xfe")
    assert code == 2 and one_line(said), said
    for arguments in ([], ["a", "b"]):
        result = subprocess.run([sys.executable, SCRIPT, *arguments], capture_output=True, check=False)
        assert result.returncode == 2 and one_line(result.stderr), result
    for name in ("\x1b[31mred\nname", "name with $x$ <b>"):
        with cases.folder({"te.csv": b"\n"}, name=name) as folder:
            refused("a folder with a hostile name", folder)
    with cases.folder() as folder:
        (work / "link").symlink_to(folder)
        accepted("a link to a folder", work / "link")
        for name in ("matplotlibrc", "numpy.py", "json.py"):
            (folder / name).write_bytes(b"raise SystemExit(77)\n")
        (folder / "matplotlibrc").unlink()
        os.mkfifo(folder / "matplotlibrc")
        code, _, said = report(".", cwd=folder)
        assert code == 0 and not said, f"started in the folder: {code} {said}"
        assert (folder / "numpy.py").exists() and not (folder / "__pycache__").exists()
        (work / "link").unlink()


def for_everyone(folder):
    """The scripts once more, where everyone may read them: root's checkout may lie where others cannot go."""
    own = Path(SCRIPT).parents[1]
    for path in own.glob("*/*.py"):
        copy = folder / path.relative_to(own)
        copy.parent.mkdir(parents=True, exist_ok=True)
        copy.write_bytes(path.read_bytes())
        copy.chmod(0o644)
    for path in (folder, *folder.iterdir()):
        path.chmod(0o755)
    return folder / "report" / Path(SCRIPT).name


def permissions(cases, work):
    """Files that may not be read, a folder that may not be written, by somebody who is not root."""
    options = {}
    if os.geteuid() == 0:
        work.chmod(0o755)
        script = for_everyone(work / "scripts")
        options = {"user": NOBODY, "group": NOBODY, "extra_groups": (), "cwd": "/", "script": script}
    with cases.folder() as folder:
        refused(
            "a folder that may not be written", folder, words="cannot be written", **options
        ) if options else None
        for path in [folder, *folder.iterdir()]:
            os.chown(path, NOBODY, NOBODY) if options else None
        for name in ("te.csv", cases.store, "manifest.txt"):
            (folder / name).chmod(0)
            code, _, said = report(folder, **options)
            assert code == 2 and one_line(said) and name.encode() in said, said
            (folder / name).chmod(0o644)
            COUNT["passed"] += 1
        folder.chmod(0o555)
        refused("a folder that may not be written", folder, words="cannot be written", **options)
        folder.chmod(0)
        assert report(folder, **options)[0] == 2
        folder.chmod(0o444)  # its names can be read, and nothing in it
        code, _, said = report(folder, **options)
        assert code == 2 and one_line(said), said
        folder.chmod(0o755)
        (folder / "figures").mkdir(mode=0o555)
        os.chown(folder / "figures", NOBODY, NOBODY) if options else None
        refused("figures that may not be written", folder, words="cannot be written", **options)


def own_files(cases):
    """Files of the user, and what belongs to an earlier report."""
    with cases.folder() as folder:
        accepted("the first report", folder)
        first = snapshot(folder)
        accepted("the same again", folder)
        assert snapshot(folder) == first, "the same results give other bytes"
        figures = [path for path in manifest_entries(folder) if path.startswith("figures/")]
        assert len(figures) >= 15 and len(figures) % 3 == 0
        for path in figures:
            if path.endswith(".svg"):
                xml.etree.ElementTree.parse(folder / path)
        (folder / "notes.txt").write_text("mine")
        (folder / "figures" / "mine.svg").write_text("mine")
        (folder / ".report-mine").mkdir()
        stale = {"figures/of_old.csv": b"1", "figures/of_old.svg": b"2", "figures/of_old.png": b"3"}
        for path, content in stale.items():
            (folder / path).write_bytes(content)
        old = {
            path: (folder / path).read_bytes()
            for path in [*manifest_entries(folder), *stale]
            if path != "figures/of_old.png"
        }
        (folder / "manifest.txt").write_text(
            result_folders.manifest(old, result_folders.command_of(cases.files)), encoding="utf-8"
        )
        (folder / figures[0]).write_text("edited")
        (folder / figures[1]).unlink()
        (folder / ".report-mine").rmdir()
        for name in ("mine.svg", "of_old.png"):  # a figure that is not listed belongs to the user
            refused(f"the user's {name} among the figures", folder, words=name)
            (folder / "figures" / name).unlink()
        refused("a figure that was edited", folder, words="not as Flank wrote it")
        assert (folder / figures[0]).read_text() == "edited"
        (folder / figures[0]).unlink()
        accepted("with files of the user", folder)
        now = snapshot(folder)
        expected = {**first, **{path: now[path] for path in ("notes.txt", "manifest.txt")}}
        assert now == expected, "files of the user or of the old report"
    for path in (
        "report.html",
        "figures/harmonics.csv" if "harmonics.csv" in cases.files else "figures/axis_1_map.png",
    ):
        with cases.folder() as folder:
            (folder / path).parent.mkdir(exist_ok=True)
            (folder / path).write_bytes(b"mine")
            refused(f"the user's {path}", folder, words=path)
    with cases.folder() as folder:
        (folder / "figures").write_bytes(b"mine")
        refused("the user's figures", folder, words="figures")
    with cases.folder() as folder:
        (folder / "modifications.csv").write_bytes(b"mine")
        (folder / "unfinished").mkdir()
        listing = {path: content for path, content in cases.files.items() if path != "modifications.csv"}
        (folder / "manifest.txt").write_text(
            result_folders.manifest(listing, result_folders.command_of(cases.files)), encoding="utf-8"
        )
        accepted("a table of the user", folder)
        assert (folder / "modifications.csv").read_bytes() == b"mine"


def limited(which, value):
    return lambda: resource.setrlimit(which, (value, value))


def outputs(cases):
    """No room, no memory, nowhere to speak."""
    with cases.folder() as folder:
        accepted("the old report", folder)
        for size in (0, 10, 1000, 20_000, 60_000, 200_000):
            refused(
                f"files up to {size} bytes", folder, (3,), preexec_fn=limited(resource.RLIMIT_FSIZE, size)
            )
        for count in (8, 9):
            refused(f"{count} open files", folder, (2, 3), preexec_fn=limited(resource.RLIMIT_NOFILE, count))
        for megabytes in (40, 80, 120, 200, 300):
            before = snapshot(folder)
            code, _, said = report(folder, preexec_fn=limited(resource.RLIMIT_AS, megabytes << 20))
            assert (code == 3 and one_line(said) or code == 0) and snapshot(
                folder
            ) == before, f"{megabytes} MB: {code} {said}"
            COUNT["passed"] += 1
        if full_disk(folder.parent / "disk"):
            disk = folder.parent / "disk"
            copied = disk / "results"
            shutil.copytree(folder, copied)
            for left in (4 << 10, 100 << 10, 700 << 10):
                fill(disk / "fill", left)
                refused(f"a disk with {left} bytes left", copied, (3,), words="No space left")
                (disk / "fill").unlink()
            subprocess.run(["umount", disk], check=True)
        else:
            print("left out: a full disk (needs the right to mount one)")
        with open("/dev/full", "wb") as full:
            code, _, said = report(folder, stdout=full)
            assert code == 3 and one_line(said) and b"standard output" in said, said
        reader, writer = os.pipe()
        os.close(reader)
        code, _, said = report(folder, stdout=writer)
        os.close(writer)
        assert code == 3 and one_line(said), said
        for closed, codes in (((1,), (3,)), ((0,), (0,)), ((2,), (0,)), ((0, 1, 2), (3,)), ((0, 2), (0,))):
            code = report(
                folder, preexec_fn=lambda closed=closed: [os.close(descriptor) for descriptor in closed]
            )[0]
            assert code in codes, f"without streams {closed}: {code}"
            COUNT["passed"] += 1
        check_manifest(folder)


def full_disk(place):
    """A small disk in memory; False: not allowed here."""
    place.mkdir()
    command = ["mount", "-t", "tmpfs", "-o", "size=8m", "none", place]
    return os.geteuid() == 0 and subprocess.run(command, capture_output=True, check=False).returncode == 0


def fill(path, left):
    with open(path, "wb", buffering=0) as file, contextlib.suppress(OSError):
        while True:
            file.write(b"\0" * 4096)
    os.truncate(path, max(0, path.stat().st_size - left))


def signals(cases):
    """Stopped at any moment: quietly, and as it was before."""
    with cases.folder() as folder:
        begin = time.monotonic()
        accepted("the old report", folder)
        whole = time.monotonic() - begin
        before = snapshot(folder)
        chance = random.Random(4)
        codes = []
        for kind in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP) * 4:
            with started(folder) as process:
                time.sleep(chance.uniform(0.1, 1.2) * whole)
                for _ in range(chance.randrange(1, 4)):
                    process.send_signal(kind)
                out, said = process.communicate(timeout=60)
            assert process.returncode in (4, 0) and not said, f"{kind}: {process.returncode} {said}"
            assert process.returncode == 0 or not out
            assert snapshot(folder) == before, f"{kind} changed the folder"
            codes.append(process.returncode)
            COUNT["passed"] += 1
        assert codes.count(4) >= 6, codes
        for kind in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):  # after its last word
            with started(folder) as process:
                assert process.stdout.readline().startswith(b"report in")
                for _ in range(20):
                    process.send_signal(kind)
                    time.sleep(0.002)
                _, said = process.communicate(timeout=60)
            assert process.returncode == 0 and not said, f"{kind}: {process.returncode} {said}"
            COUNT["passed"] += 1
        for kind in (signal.SIGKILL, signal.SIGSEGV, signal.SIGXCPU):
            with started(folder) as process:
                children = Path(f"/proc/{process.pid}/task/{process.pid}/children")
                while not (child := children.read_text().split()):
                    time.sleep(0.01)
                time.sleep(0.3)
                os.kill(int(child[0]), kind)
                _, said = process.communicate(timeout=60)
            assert process.returncode == 3 and one_line(said) and snapshot(folder) == before, said
            COUNT["passed"] += 1


def killed(cases):
    """What a killed report leaves beside the results goes with the next one; nothing else does."""
    with cases.folder() as folder:
        begin = time.monotonic()
        accepted("timed", folder)
        whole = time.monotonic() - begin
        for share in (0, 0.2, 0.5):
            with started(folder) as process:
                children = Path(f"/proc/{process.pid}/task/{process.pid}/children")
                while not (child := children.read_text().split()):
                    time.sleep(0.01)
                time.sleep(share * whole)
                os.kill(process.pid, signal.SIGSTOP)  # it sees nothing of what happens to its child
                os.kill(int(child[0]), signal.SIGKILL)
                process.kill()
            assert len(list(folder.glob(".report-*"))) == 1, "the report was not killed while it worked"
            accepted("after a killed report", folder)  # which looks for what stays
        half = {path: b"" for path in ("old/report.html", "old/figures/a.svg", "figures/b.png", "listed")}
        half["before"] = (folder / "manifest.txt").read_bytes()
        foreign = ("notes.txt", "old/notes.txt", "final", "figures/c/d.svg")
        for number, more in enumerate([{}, *({path: b"mine"} for path in foreign)]):
            for path, content in {**half, **more}.items():
                place = folder / f".report-{number:016x}" / path
                place.parent.mkdir(parents=True, exist_ok=True)
                place.write_bytes(content)
        (folder / ".report-mine").mkdir()
        (folder / ".report-0123456789abcdef").write_bytes(b"")
        elsewhere = folder.parent / "elsewhere"
        (elsewhere / "figures").mkdir(parents=True)
        (folder / f".report-{'a' * 16}").symlink_to(elsewhere)
        (folder / f".report-{'b' * 16}").mkdir()
        (folder / f".report-{'b' * 16}" / "figures").symlink_to(elsewhere)
        (folder / f".report-{'c' * 16}").mkdir()
        of_another = os.open(folder / f".report-{'c' * 16}", os.O_RDONLY)
        fcntl.flock(of_another, fcntl.LOCK_EX)
        before = snapshot(folder)
        assert report(folder)[0] == 0
        gone = {path for path in before if path.split("/")[0] == f".report-{0:016x}"}
        assert gone and {path: snapshot(folder).get(path) for path in before} == {
            path: None if path in gone else content for path, content in before.items()
        }, "what is not of a killed report"
        assert (elsewhere / "figures").is_dir()
        os.close(of_another)
        assert report(folder)[0] == 0 and not (folder / f".report-{'c' * 16}").exists()
        COUNT["passed"] += 2


def renames(cases):
    """The swap of the old report for the new one fails at each of its steps."""
    sys.path.insert(0, os.path.dirname(SCRIPT))
    import report as own

    with cases.folder() as folder:
        drawn = own.drawn
        accepted("the old report", folder)
        kept = folder.parent / "drawn"
        shutil.copytree(folder, kept)
        stale = {f"figures/of_old.{ending}": b"old" for ending in ("svg", "png", "csv")}
        files = {path: (folder / path).read_bytes() for path in manifest_entries(folder)} | stale
        own.drawn = other_figures(own, kept)
        for with_old in (True, False):
            shutil.rmtree(folder)
            result_folders.write(folder, files if with_old else cases.files)
            failed = 0
            for name in ("replace", "unlink", "mkdir", "fsync"):
                failed += fail_at_each(own, folder, name)
                check_manifest(folder)
                assert not (folder / "figures/of_old.svg").exists()
                shutil.rmtree(folder)
                result_folders.write(folder, files if with_old else cases.files)
            assert failed > 20, failed
            COUNT["passed"] += failed
        own.drawn = drawn


def other_figures(own, kept):
    """In the place of the drawing: a report's files with other contents, so that a mixture shows."""

    def copied(_, target, *__):
        names = [path for path in manifest_entries(kept) if path.startswith(("figures/", "report.html"))]
        os.mkdir("figures", dir_fd=target)
        for path in names:
            own.write_new(path, target, b"new " + (kept / path).read_bytes())
        return {
            path: own.Entry(zlib.crc32(content := b"new " + (kept / path).read_bytes()), len(content))
            for path in names
        }

    return copied


def fail_at_each(own, folder, name):
    """The first call of os.name fails, then the second, until a report is made; the folder stays as it was.
    Returns how many failed.
    """
    whole, before = getattr(os, name), snapshot(folder)
    failed = 0
    for number in range(1, 60):
        setattr(os, name, failing(whole, number))
        try:
            own.make_report(folder)
            break
        except own.OutputError as error:
            assert "No space left" in str(error)
            failed += 1
        finally:
            setattr(os, name, whole)
            signal.pthread_sigmask(signal.SIG_UNBLOCK, own.STOPS)  # a report leaves that to its process's end
        assert snapshot(folder) == before, f"{name} number {number} failed: the folder was changed"
    return failed


def failing(step, number):
    """`step`, of which one call fails as on a full disk; those that tidy up do not count."""
    calls = iter(range(1, 1000))

    def one_fails(*arguments, **options):
        tidies_up = step.__name__ == "unlink" and not str(arguments[0]).startswith("figures/")
        if not tidies_up and next(calls) == number:
            raise OSError(28, "No space left on device")
        return step(*arguments, **options)

    return one_fails


def texts(work):
    """Texts of a case and of tables on the page and in figures' numbers."""
    case = result_folders.GEAR_CASE
    title = HOSTILE.replace("\\", "").replace('"', '\\"').replace("\x1b", "\\u001b")
    resolved = case.replace("a gear pair", title).replace("scene", f'pinion.like = "{title}"\nscene', 1)

    def change(file):
        file.attrs["case_resolved"] = resolved
        file.attrs["case"] = f"# {HOSTILE}\x01\n{resolved}"
        file.attrs["versions"] = f"flank {HOSTILE}\n"

    files = result_folders.study()
    files["study.h5"] = changed_store(files["study.h5"], change)
    files[
        "summary.txt"
    ] = f"{HOSTILE}\n{files['summary.txt'].decode().splitlines()[1]}\nwarning: {HOSTILE}\n".encode()
    quoted = HOSTILE.replace('"', '""')
    files["designs.csv"] = files["designs.csv"].replace(
        b"failed: @no contact", b'"failed: @' + quoted.encode() + b'"'
    )
    files["designs.csv"] = files["designs.csv"].replace(
        b'"a ""quoted"", $long$ name"', f'"@{quoted} $x$"'.encode()
    )
    files["te.csv"] = f"# {HOSTILE}\n".encode() + files["te.csv"]
    with Cases(files, work).folder() as folder:
        accepted("hostile texts", folder)
        page = (folder / "report.html").read_text(encoding="utf-8")
        assert "<script" not in page and "\x1b" not in page and "\x01" not in page
        assert unescape(page).count("<script>alert(1)</script> & \"q\" 'a'") >= 9
        for path in folder.glob("figures/*.csv"):
            with open(path, newline="", encoding="utf-8") as stream:
                cells = [cell for row in csv.reader(stream) for cell in row]
            formulas = [cell for cell in cells if cell[:1] in tuple("=+-@\t")]
            assert all(
                cell.lstrip("+-").replace(".", "").replace("e-", "").isdigit() for cell in formulas
            ), f"{path.name}: {formulas}"
        assert (
            "'=1+1" in (folder / "figures/axis_2_map.csv").read_text()
            and "'@<script" in (folder / "figures/axis_2_map.csv").read_text()
        )
        for path in folder.glob("figures/*.svg"):
            xml.etree.ElementTree.parse(path)


def together(cases):
    """Two reports of one folder at once, and one while the results are replaced."""
    with cases.folder() as folder:
        with started(folder) as one, started(folder) as two:
            ends = [process.communicate(timeout=120)[1] for process in (one, two)]
        assert (one.returncode, two.returncode) == (0, 0), ends  # they take turns
        accepted("after two at once", folder)
    with cases.folder() as folder:
        with started(folder) as process:
            while not list(folder.glob(".report-*")):
                time.sleep(0.01)
            manifest = folder / "manifest.txt"
            manifest.write_text(manifest.read_text().replace("title", "name"))
            _, said = process.communicate(timeout=120)
        assert process.returncode == 2 and one_line(said) and b"changed" in said, said
        assert {path.name for path in folder.iterdir()} == {*cases.files, "manifest.txt"}
        COUNT["passed"] += 2


def mutated(chance, content):
    """Bytes flipped, a piece cut, lines deleted or exchanged."""
    changed = bytearray(content)
    kind = chance.randrange(4)
    if kind == 0:
        for _ in range(chance.choice((1, 2, 8))):
            changed[chance.randrange(len(changed))] ^= 1 << chance.randrange(8)
        return bytes(changed)
    if kind == 1:
        return content[: chance.randrange(len(content))]
    lines = content.split(b"\n")
    first, second = chance.randrange(len(lines)), chance.randrange(len(lines))
    if kind == 2:
        del lines[first]
    else:
        lines[first], lines[second] = lines[second], lines[first]
    return b"\n".join(lines)


def mutations(all_files, work):
    """Random changes under a manifest that fits: refused, or such that the tables still are tables."""
    chance, codes = random.Random(5), []
    for number in range(MUTATIONS):
        files = dict(chance.choice(all_files))
        name = chance.choice([name for name in files if name not in ("case.toml", "summary.txt")])
        if number % 10 == 0:
            files[name] = chance.choice(all_files).get(name, b"")
        else:
            files[name] = mutated(chance, files[name])
        with Cases(files, work).folder(name=f"mutation_{number}") as folder:
            before = snapshot(folder)
            code, out, said = report(folder)
            assert (
                code == 0 and not said or code == 2 and one_line(said) and not out
            ), f"mutation {number} of {name}: {code} {said}"
            now = snapshot(folder)
            assert code == 0 or now == before, f"mutation {number} changed the folder"
            assert all(now[path] == content for path, content in before.items() if path != "manifest.txt")
            codes.append(code)
    assert codes.count(2) > MUTATIONS / 2, codes.count(2)
    COUNT["passed"] += MUTATIONS


def plain(files):
    """Without the tables that a run has where it is asked for them: fewer figures."""
    return {
        name: content
        for name, content in files.items()
        if name in ("te.csv", "harmonics.csv", "pairs.csv", "amplitudes_over_torque.csv", "designs.csv")
        or not name.endswith(".csv")
    }


def main():
    made = [result_folders.read(folder) for folder in sys.argv[2:]]
    made = made or [
        result_folders.gear_run(),
        result_folders.study(),
        result_folders.drive_run(),
        result_folders.gear_run(4, 2),
    ]
    with tempfile.TemporaryDirectory() as name:
        work = Path(name)
        for number, files in enumerate(made[:3]):
            cases = Cases(plain(files), work / str(number), number)
            (work / str(number)).mkdir()
            with cases.folder() as folder:
                accepted("as it is", folder)
            for part in (tables, stores) if number else (tables, stores, manifests, special_files):
                part(cases)
                print(f"{part.__name__}: {COUNT['passed']} passed so far", flush=True)
        cases = Cases(plain(made[0]), work)
        for part in (
            lambda: folders(cases, work),
            lambda: permissions(cases, work),
            lambda: half_in_place(cases),
            lambda: own_files(cases),
            lambda: outputs(cases),
            lambda: signals(cases),
            lambda: killed(cases),
            lambda: renames(cases),
            lambda: texts(work),
            lambda: together(cases),
            lambda: mutations([plain(files) for files in made], work),
        ):
            part()
            print(f"{COUNT['passed']} passed so far", flush=True)
    print(f"{COUNT['passed']} passed, 0 failed")


if __name__ == "__main__":
    main()
