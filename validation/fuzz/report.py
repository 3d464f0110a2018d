#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""report.py [COUNT] [--first SEED] [--draw] [--keep DIR] [FOLDER ...]: changes files of result folders
at random and reads them as `flank report` does. A reader may give results or an InputError with one line;
anything else, or more than ten seconds, is a failure: its seed is said and its folder kept in DIR. A seed
gives the same change again: `--first SEED 1`. Without folders: small ones of made-up numbers.
--draw: figures of what was accepted are drawn too (slow).
"""
import argparse
import collections
import random
import resource
import signal
import struct
import sys
import tempfile
import time
import traceback
from pathlib import Path

sys.dont_write_bytecode = True
ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "cases/report"), str(ROOT / "tests/cases")]

import result_folders
from errors import InputError, one_line
from hdf5_file import Hdf5File
from manifest import Manifest
from mesh_cycle import STUDY
from results import read
from scenes import scene_report
from tables import read_table

SECONDS, MEMORY = 10, 8 << 30
CELLS = [
    "",
    "nan",
    "-nan",
    "inf",
    "1e999",
    "-1",
    "0",
    "1e13",
    "1e-320",
    "1_0",
    " 1",
    "0x10",
    "ok",
    "=1+1",
    "٣",
    "9" * 400,
    '"',
    "\x1b[2J",
]
WORDS = [
    0,
    1,
    2,
    8,
    0xFF,
    0xFFFF,
    1 << 31,
    (1 << 32) - 1,
    1 << 40,
    1 << 62,
    (1 << 63) - 1,
    (1 << 64) - 8,
    (1 << 64) - 1,
]


class TooLong(BaseException):
    """A reader did not end."""


class Memory:
    """Files of a folder as their manifest would give them."""

    def __init__(self, files):
        self._files = files
        self.command = result_folders.command_of(files)

    def __contains__(self, name):
        return name in self._files

    def tables(self):
        return [name for name in self._files if name.endswith(".csv")]

    def content(self, name):
        if name not in self:
            raise InputError(f"no {name}")
        return self._files[name]

    def store(self, name):
        return Opened(name, self.content(name))


class Opened:
    def __init__(self, name, content):
        self.name, self.size, self._content = name, len(content), content

    def read(self, at, count):
        assert 0 <= at and count > 0 and at + count <= self.size, "read outside of the file"
        return self._content[at : at + count]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        pass


def changed_bytes(chance, content):
    """Some bytes, or a piece that is cut, repeated, moved or overwritten."""
    content = bytearray(content)
    for _ in range(chance.choice((1, 1, 1, 2, 4, 16))):
        at, length = chance.randrange(len(content) + 1), chance.choice((1, 2, 8, 64, 1024))
        kind = chance.randrange(7)
        if kind == 0:
            content[at : at + 1] = bytes([chance.randrange(256)])
        elif kind == 1 and content:
            content[at - 1] ^= 1 << chance.randrange(8)
        elif kind == 2:
            del content[at:]
        elif kind == 3:
            del content[at : at + length]
        elif kind == 4:
            content[at:at] = content[at : at + length]
        elif kind == 5:
            content[at : at + length] = chance.randbytes(min(length, 64))
        else:
            other = chance.randrange(len(content) + 1)
            content[at : at + length] = content[other : other + length]
    return bytes(content)


def changed_words(chance, content):
    """Numbers of an HDF5 file's structure, which stand at multiples of two."""
    content = bytearray(content)
    for _ in range(chance.choice((1, 1, 2, 3))):
        at = 2 * chance.randrange(len(content) // 2 - 4)
        kind = chance.choice("BHIQQ")
        value = chance.choice(
            (
                *WORDS,
                chance.randrange(len(content)),
                struct.unpack_from("<Q", content, at)[0] + chance.choice((-8, -1, 1, 8)),
            )
        )
        struct.pack_into(f"<{kind}", content, at, value % (1 << 8 * struct.calcsize(kind)))
    return bytes(content)


def changed_lines(chance, content):
    """Lines and cells of a table."""
    lines = content.split(b"\n")
    for _ in range(chance.choice((1, 1, 2, 5))):
        at, other = chance.randrange(len(lines)), chance.randrange(len(lines))
        cells = lines[at].split(b",")
        kind = chance.randrange(6)
        if kind == 0:
            cells[chance.randrange(len(cells))] = chance.choice(CELLS).encode("utf-8")
        elif kind == 1:
            del cells[chance.randrange(len(cells))]
        elif kind == 2:
            chance.shuffle(cells)
        elif kind == 3:
            lines[at], lines[other] = lines[other], lines[at]
            continue
        elif kind == 4:
            lines.insert(other, lines[at])
            continue
        else:
            cells[chance.randrange(len(cells))] = chance.choice(lines[other].split(b","))
        lines[at] = b",".join(cells)
    return b"\n".join(lines)


def changed(chance, content, name):
    ways = [changed_bytes, changed_words if name.endswith(".h5") else changed_lines]
    return chance.choice(ways)(chance, content) if len(content) > 16 else b""


def changed_folder(chance, folders):
    """One file or two of a folder, or one that is missing or another folder's."""
    files = dict(chance.choice(folders))
    for _ in range(chance.choice((1, 1, 1, 2))):
        name = chance.choice(list(files))
        kind = chance.randrange(12)
        if kind == 0 and len(files) > 1:
            del files[name]
        elif kind == 1:
            files[name] = other(chance, folders, name)
        else:
            files[name] = changed(chance, files[name], name)
    return files


def other(chance, folders, name):
    found = chance.choice(folders)
    return found.get(name) or found[chance.choice(list(found))]


def reads(folders):
    """Readers by name: each makes its change of a seed, and what is then called."""

    def table(chance):
        files = chance.choice(folders)
        scene = scene_report("parallel_axis" if b"phase" in files["te.csv"] else "double_roller")
        known = STUDY if "study.h5" in files else scene.RUN
        name = chance.choice([name for name in files if name in known])
        columns = known[name]
        columns = columns.format(abscissa="phase").split()
        content = changed(chance, files[name], name)
        return {name: content}, lambda: read_table(name, content, columns, scene.KINDS)

    def store(chance):
        files = chance.choice(folders)
        name = "study.h5" if "study.h5" in files else "results.h5"
        content = changed(chance, files[name], name)

        def every_part():
            file = Hdf5File(Opened(name, content))
            file.text("versions")
            for group in file.names():
                if group.startswith("block_"):
                    file.numbers(f"{group}/te", None, None, None)
            return file.names("pressure_maps")

        return {name: content}, every_part

    def listing(chance):
        content = result_folders.manifest(chance.choice(folders), "run").encode("utf-8")
        content = changed(chance, content, "manifest.txt")
        return {"manifest.txt": content}, lambda: Manifest.parsed(content)

    def folder(chance):
        files = changed_folder(chance, folders)
        return files, lambda: read("fuzz", Memory(files))

    return [table, table, store, store, listing, folder]


def too_long(*_):
    raise TooLong


def outcome(call):
    """'accepted', 'refused' or what went wrong; and what was read."""
    signal.alarm(SECONDS)
    try:
        return "accepted", call()
    except InputError as error:
        line = str(error)
        return (
            "refused" if line == one_line(line) and 0 < len(line) < 1000 else f"said: {line[:200]!r}"
        ), None
    except (Exception, TooLong):
        return "".join(traceback.format_exc().splitlines(True)[-3:]), None
    finally:
        signal.alarm(0)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("count", type=int, nargs="?", default=20_000)
    parser.add_argument("folders", nargs="*", help="real result folders")
    parser.add_argument("--first", type=int, default=0, help="seed to begin with")
    parser.add_argument("--draw", action="store_true")
    parser.add_argument("--keep", type=Path, help="where folders that failed are kept (default: a new one)")
    arguments = parser.parse_args()
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, resource.getrlimit(resource.RLIMIT_AS)[1]))
    signal.signal(signal.SIGALRM, too_long)
    made = [
        result_folders.gear_run(),
        result_folders.gear_run(4, 2),
        result_folders.drive_run(),
        result_folders.study(),
    ]
    folders = [result_folders.read(folder) for folder in arguments.folders] or made
    ways, counts, failures, start = reads(folders), collections.Counter(), 0, time.monotonic()
    for seed in range(arguments.first, arguments.first + arguments.count):
        chance = random.Random(seed)
        way = chance.choice(ways)
        files, call = way(chance)
        result, found = outcome(call)
        if result == "accepted" and arguments.draw and way.__name__ == "folder":
            from draw import report_files

            result, _ = outcome(lambda: list(report_files(found)))
        counts[way.__name__, result if result in ("accepted", "refused") else "FAILED"] += 1
        if result not in ("accepted", "refused"):
            failures += 1
            keep = arguments.keep or Path(tempfile.mkdtemp(prefix="fuzz-report-"))
            arguments.keep = keep
            result_folders.write(keep / f"seed_{seed}", files)
            print(f"seed {seed}, {way.__name__}, kept in {keep / f'seed_{seed}'}:\n{result}", flush=True)
    seconds = time.monotonic() - start
    print(
        f"{arguments.count} executions from seed {arguments.first}, "
        f"{arguments.count / seconds:.0f} a second, {failures} failures"
    )
    for (name, result), count in sorted(counts.items()):
        print(f"  {name}: {result} {count}")
    return int(failures > 0)


if __name__ == "__main__":
    sys.exit(main())
