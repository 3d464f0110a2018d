# SPDX-License-Identifier: GPL-2.0-or-later
"""No room, no memory, nowhere to speak, and a swap that fails at each of its steps."""
import contextlib
import os
import resource
import shutil
import signal
import subprocess
import sys
import zlib

import result_folders

from checks import COUNT, SCRIPT, accepted, check_manifest, manifest_entries, one_line, refused, report
from checks import snapshot


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
