# SPDX-License-Identifier: GPL-2.0-or-later
"""Reports stopped at any moment, and what a killed one leaves."""
import fcntl
import os
import random
import signal
import time
from pathlib import Path

from checks import COUNT, accepted, one_line, report, snapshot, started


def child_of(process):
    """The number of a process's first child, as soon as there is one."""
    children = Path(f"/proc/{process.pid}/task/{process.pid}/children")
    while not (numbers := children.read_text().split()):
        time.sleep(0.01)
    return int(numbers[0])


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
                child = child_of(process)
                time.sleep(0.3)
                os.kill(child, kind)
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
                child = child_of(process)
                time.sleep(share * whole)
                os.kill(process.pid, signal.SIGSTOP)  # it sees nothing of what happens to its child
                os.kill(child, signal.SIGKILL)
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
