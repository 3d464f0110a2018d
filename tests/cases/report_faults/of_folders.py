# SPDX-License-Identifier: GPL-2.0-or-later
"""What may be given as the folder, what may stand in the place of a file, and who may read and write it."""
import os
import shutil
import socket
import stat
import subprocess
import sys
from pathlib import Path

from checks import COUNT, NOBODY, SCRIPT, SECRET, accepted, one_line, refused, report


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
