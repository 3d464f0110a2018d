#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""report.py DIR: writes DIR/report.html and DIR/figures/NAME.{svg,png,csv} from the results in DIR.
Exit code 2: wrong input; 3: it could not be drawn or written; 4: stopped by a signal.
Each but the last says one line, and leaves the folder as it was.
"""
import os
import signal
import sys

STOPS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


class Stopped(BaseException):
    """A signal asked for the end."""


def stop(*_):
    signal.pthread_sigmask(signal.SIG_BLOCK, STOPS)  # for good: one is enough
    raise Stopped


if __name__ == "__main__":  # signals wait until all is loaded, as `flank report` lets them from its start
    signal.pthread_sigmask(signal.SIG_BLOCK, STOPS)
    for stopping in STOPS:
        if signal.getsignal(stopping) is not signal.SIG_IGN:  # as nohup asks
            signal.signal(stopping, stop)
sys.dont_write_bytecode = True  # the folder of the program stays as it is

import contextlib
import errno
import fcntl
import json
import re
import secrets
import shutil
import stat
import subprocess
import time

from errors import InputError, OutputError, one_line, shortened
from files import FOLDER, RegularFile, status, write_new
from manifest import FIRST_LINE, MOST_BYTES, NAME, REPORT_FILE, Entry, Manifest, entry_of

MOST_OLD_BYTES = 1 << 30  # of a file of the report before this one, kept until the new one is in place
PATIENCE = 60  # for another report of the same folder to be put in place [s]
SPARE_FILES = 12  # that must be left to be opened, so that what was begun can be tidied up
OWN_FOLDER = re.compile(r"\.report-[0-9a-f]{16}")  # in which a report works, locked as long as it does
OWN_FOLDERS = ("figures", "old", "old/figures")  # in that
OWN_LISTS = ("listed", "final", "before")  # manifests there
UNFINISHED = "unfinished"  # the folder in which a run or a study works
UNFINISHED_HEAD = b"Unfinished results of Flank, format 1."  # of the file there that says whose it is
NOT_ALLOWED = (errno.EACCES, errno.EPERM, errno.EROFS)


@contextlib.contextmanager
def undisturbed():
    """Signals wait until this is done."""
    before = signal.pthread_sigmask(signal.SIG_BLOCK, STOPS)
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def opened_folder(path):
    try:
        return os.open(path, FOLDER)
    except (FileNotFoundError, NotADirectoryError):
        raise InputError("no such folder") from None
    except OSError as error:
        raise InputError(f"cannot be opened: {error.strerror}") from None


def is_being_replaced(folder):
    """Whether new results stand ready in the folder of unfinished work, to be put in place of those there."""
    work = status(UNFINISHED, folder)
    if not work or not stat.S_ISDIR(work.st_mode) or status(f"{UNFINISHED}/{NAME}", folder) is None:
        return False
    with contextlib.suppress(InputError), RegularFile(f"{UNFINISHED}/flank.txt", folder, MOST_BYTES) as file:
        return file.read(0, min(file.size, len(UNFINISHED_HEAD))) == UNFINISHED_HEAD
    return False  # somebody's own


def is_of_report(path, own):
    """Whether what has this path in an opened folder is what a report makes in its own, complete or not."""
    kind = status(path, own).st_mode
    if stat.S_ISDIR(kind):
        return path in OWN_FOLDERS
    if not stat.S_ISREG(kind) or path not in OWN_LISTS:
        return stat.S_ISREG(kind) and REPORT_FILE.fullmatch(path.removeprefix("old/")) is not None
    with RegularFile(path, own, MOST_BYTES) as file:
        head = FIRST_LINE.encode("ascii")
        return head.startswith(file.read(0, min(file.size, len(head))))


def remove_abandoned(name, folder):
    """The own folder of a report that was killed, if it holds nothing else. Throws OSError and InputError."""
    own = os.open(name, FOLDER | os.O_NOFOLLOW, dir_fd=folder)
    try:
        fcntl.flock(own, fcntl.LOCK_EX | fcntl.LOCK_NB)  # cannot while its report works
        paths = [  # of a folder after those in it
            os.path.normpath(os.path.join(place, path))
            for place, folders, files, _ in os.fwalk(".", topdown=False, dir_fd=own)
            for path in files + folders
        ]
        if not all(is_of_report(path, own) for path in paths):
            return
        for path in paths:
            (os.rmdir if path in OWN_FOLDERS else os.unlink)(path, dir_fd=own)
        os.rmdir(name, dir_fd=folder)
    finally:
        os.close(own)


def remove_all_abandoned(folder):
    """What may not be removed stays."""
    with contextlib.suppress(OSError):
        for name in filter(OWN_FOLDER.fullmatch, os.listdir(folder)):
            with contextlib.suppress(OSError, InputError):
                remove_abandoned(name, folder)


def new_own_folder(folder):
    """Name and descriptor of a new folder in it, locked so that no other report takes it for abandoned. Where
    the file system locks no folders none is ever taken for abandoned.
    """
    while True:
        name = f".report-{secrets.token_hex(8)}"
        os.mkdir(name, 0o700, dir_fd=folder)
        try:
            own = os.open(name, FOLDER | os.O_NOFOLLOW, dir_fd=folder)
        except FileNotFoundError:  # another report came between
            continue
        except OSError:
            with contextlib.suppress(OSError):
                os.rmdir(name, dir_fd=folder)
            raise
        with contextlib.suppress(OSError):
            fcntl.flock(own, fcntl.LOCK_EX)
        there = status(name, folder)
        if there and os.path.samestat(there, os.fstat(own)):
            return name, own
        os.close(own)


def manifest_content(folder):
    if is_being_replaced(folder):
        raise InputError(
            "new results are being put in place; go on with their computation first: the same command and "
            "--resume"
        )
    if status(NAME, folder) is None:
        unfinished = status(UNFINISHED, folder)
        if unfinished and stat.S_ISDIR(unfinished.st_mode):
            raise InputError("its computation is not finished; go on with it: the same command and --resume")
        raise InputError(
            f"holds no finished results of Flank (no {NAME}); "
            "give the folder of a `flank run` or `flank study`"
        )
    with RegularFile(NAME, folder, MOST_BYTES) as file:
        return file.read(0, file.size)


def drawn(folder, target, folder_name, manifest):
    """The files of the report that draw.py made in the target, as entries of the manifest by their paths."""
    command = [
        sys.executable,
        "-E",
        "-s",
        "-B",
        os.path.join(os.path.dirname(os.path.abspath(__file__)), "draw.py"),
    ]
    with undisturbed():
        process = subprocess.Popen(
            [*command, str(folder), str(target), folder_name],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            pass_fds=(folder, target),
            cwd="/",  # matplotlib would read a file of settings where it starts
            env={**os.environ, "OPENBLAS_NUM_THREADS": "1"},
            start_new_session=True,
        )
    with process:
        try:
            answer = process.communicate(manifest)[0]
        except BaseException:
            process.kill()
            raise
    try:
        answer = json.loads(answer)
    except ValueError:
        reason = (
            f"by signal {-process.returncode}"
            if process.returncode < 0
            else f"with exit code {process.returncode}"
        )
        raise OutputError(f"its drawing ended {reason}; is there too little memory?") from None
    if answer["code"]:
        raise {2: InputError, 3: OutputError}[answer["code"]](answer["line"])
    return {path: Entry(*entry) for path, entry in answer["files"].items()}


def refuse_foreign(folder, manifest, files):
    """What is in the way and not listed as Flank's is somebody's own."""
    figures = status("figures", folder)
    if figures and not stat.S_ISDIR(figures.st_mode):
        raise InputError("figures in it is no folder; move it elsewhere")
    if figures:
        opened = os.open("figures", os.O_RDONLY | os.O_DIRECTORY, dir_fd=folder)
        try:
            names = sorted(os.listdir(opened))
        finally:
            os.close(opened)
        for name in names:
            if f"figures/{name}" not in manifest.files:
                raise InputError(
                    f"figures/{one_line(name)} in it is not Flank's ({NAME} does not list it); "
                    "move it elsewhere"
                )
    for path in files:
        found = status(path, folder)
        if found and path not in manifest.files:
            raise InputError(f"{path} in it is not Flank's ({NAME} does not list it); move it elsewhere")
        if found and not stat.S_ISREG(found.st_mode):
            raise InputError(f"{path} in it is no regular file; move it elsewhere")
    for path in {*files, *manifest.of_report()}:
        if status(path, folder):
            with RegularFile(path, folder, MOST_OLD_BYTES) as file:
                there = entry_of(file.read(0, file.size))
            # A killed report may have listed what it had not put in place yet: the same as is drawn now.
            if there not in (manifest.files.get(path), files.get(path)):
                raise InputError(
                    f"{path} in it is not as Flank wrote it; it is not touched: move it elsewhere"
                )


def wait_for_turn(folder):
    """Until no other report is being put in place; it is this one's turn then until the folder is closed."""
    for _ in range(PATIENCE * 10):
        try:
            return fcntl.flock(folder, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            time.sleep(0.1)
        except OSError:
            return None  # some file systems have no locks
    raise InputError("another process holds it, such as a report that is stopped; end that one first")


def put_in_place(folder, target, before, files):
    """The drawn files and a manifest with them, in place of those of an earlier report.
    All is written beside first, the old ones too: what is left are renames, and on failure those back.
    A file is listed before it is there, so one that a killed report left is no stranger to the next.
    Reports of one folder take turns, and each begins with the manifest that it finds then.
    """
    wait_for_turn(folder)
    drawn_of, before = Manifest.parsed(before), manifest_content(folder)
    manifest = Manifest.parsed(before)
    if manifest.of_results() != drawn_of.of_results():
        raise InputError("its results changed while the report was drawn; make it again")
    refuse_foreign(folder, manifest, files)
    stale = [path for path in manifest.of_report() if path not in files]
    listed = manifest.with_files(files)
    for name, content in (
        ("listed", listed.content()),
        ("final", listed.without_files(stale).content()),
        ("before", before),
    ):
        write_new(name, target, content)
    had_figures = status("figures", folder) is not None
    for name in ("old", "old/figures"):
        os.mkdir(name, dir_fd=target)
    old = [path for path in [*files, *stale] if status(path, folder)]
    for path in old:
        with RegularFile(path, folder, MOST_OLD_BYTES) as file:
            write_new(f"old/{path}", target, file.read(0, file.size))
    if manifest_content(folder) != before:
        raise InputError("its results changed while the report was drawn; make it again")

    def move(name, path):
        os.replace(name, path, src_dir_fd=target, dst_dir_fd=folder)

    signal.pthread_sigmask(signal.SIG_BLOCK, STOPS)  # for good: it succeeds or fails from here on
    try:
        if not had_figures:
            os.mkdir("figures", dir_fd=folder)
        move("listed", NAME)
        synchronise(folder)
        for path in files:
            move(path, path)
        for path in set(stale) & set(old):
            os.unlink(path, dir_fd=folder)
        move("final", NAME)
        synchronise(folder)
    except OSError:
        for path in files:
            with contextlib.suppress(OSError):
                move(f"old/{path}", path) if path in old else os.unlink(path, dir_fd=folder)
        for path in set(stale) & set(old):
            with contextlib.suppress(OSError):
                move(f"old/{path}", path)
        with contextlib.suppress(OSError):
            move("before", NAME)
        if not had_figures:
            with contextlib.suppress(OSError):
                os.rmdir("figures", dir_fd=folder)
        raise


def synchronise(folder):
    """Some file systems cannot, for folders."""
    with contextlib.suppress(OSError):
        os.fsync(folder)


def make_report(path):
    folder = opened_folder(path)
    beside = None
    try:
        manifest = manifest_content(folder)
        Manifest.parsed(manifest)
        remove_all_abandoned(folder)
        for spare in [os.dup(folder) for _ in range(SPARE_FILES)]:
            os.close(spare)
        with undisturbed():
            beside, target = new_own_folder(folder)
        files = drawn(folder, target, one_line(os.path.basename(os.path.realpath(path))), manifest)
        put_in_place(folder, target, manifest, files)
    except OSError as error:
        kind = InputError if error.errno in NOT_ALLOWED else OutputError
        raise kind(f"the report cannot be written: {error.strerror}") from None
    finally:
        if beside:
            with undisturbed():
                shutil.rmtree(beside, ignore_errors=True, dir_fd=folder)
        os.close(folder)  # and the lock with it


def say(descriptor, text):
    """Throws OSError."""
    content = (one_line(text) + "\n").encode("utf-8")
    while content:
        content = content[os.write(descriptor, content) :]


def open_standard_streams():
    """No table may be opened in the place of one; is standard output there?"""
    there = []
    for descriptor in (0, 1, 2):
        try:
            os.fstat(descriptor)
            there.append(descriptor)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # takes the lowest number that is free
    return 1 in there


def main(arguments):
    has_output = open_standard_streams()
    if len(arguments) != 1:
        return "usage: flank report DIR", InputError.code
    path = arguments[0]
    try:
        make_report(path)
        if not has_output:
            raise OutputError("the report is there, but standard output is closed")
        try:
            say(1, f"report in {os.path.join(path, 'report.html')}")
        except OSError as error:
            raise OutputError(
                f"the report is there, but standard output cannot be written: {error.strerror}"
            ) from None
    except (InputError, OutputError) as error:
        return f"flank report: {shortened(path)}: {error}", error.code
    except MemoryError:
        return f"flank report: {shortened(path)}: there is not enough memory", OutputError.code
    return "", 0


if __name__ == "__main__":
    try:
        signal.pthread_sigmask(signal.SIG_UNBLOCK, STOPS)
        problem, code = main(sys.argv[1:])
        signal.pthread_sigmask(signal.SIG_BLOCK, STOPS)  # what is said now is the end
        if problem:
            with contextlib.suppress(OSError):
                say(2, problem)
    except Stopped:
        code = 4
    sys.exit(code)
