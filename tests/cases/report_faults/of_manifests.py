# SPDX-License-Identifier: GPL-2.0-or-later
"""Manifests that are not there, damaged, or not of these files."""
import random
import shutil

import result_folders

from checks import SECRET, accepted, refused


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
