# SPDX-License-Identifier: GPL-2.0-or-later
"""HDF5 files that are not as Flank writes them, though the manifest fits."""
import io
import os
import random
import tempfile
from pathlib import Path

import h5py
import numpy as np

from checks import SECRET


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
        periods = [name for name in ("period", "order") if name in file]
    attributes = ["study", "case", "case_resolved"] if is_study else ["case_as_given", "case_as_resolved"]
    changes = {
        **changed_numbers(te, torque),
        **changed_links(te),
        **changed_texts(attributes),
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
