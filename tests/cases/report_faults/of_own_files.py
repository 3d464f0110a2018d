# SPDX-License-Identifier: GPL-2.0-or-later
"""Files of the user beside a report, and what belongs to an earlier one."""
import time
import xml.etree.ElementTree

import result_folders

from checks import COUNT, accepted, manifest_entries, one_line, refused, snapshot, started


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
