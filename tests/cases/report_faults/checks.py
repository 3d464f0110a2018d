# SPDX-License-Identifier: GPL-2.0-or-later
"""How a report is started, and what must hold whatever it is given: one line, the right exit code, a
folder as it was.
"""
import contextlib
import os
import shutil
import signal
import stat
import subprocess
import sys
import zlib

import result_folders

SECRET = b"root:x:0:0:a foreign file\n"
HOSTILE = "<script>alert(1)</script> & \"q\" 'a' \x1b[31m"
NOBODY = 65534
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
