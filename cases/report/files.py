# SPDX-License-Identifier: GPL-2.0-or-later
"""Files as a report reads and writes them: nothing but regular files is opened,
nothing that exists is written to.
"""
import os
import stat

from errors import InputError, OutputError

READING = os.O_RDONLY | os.O_NONBLOCK | os.O_NOFOLLOW | os.O_NOCTTY | os.O_CLOEXEC
FOLDER = os.O_RDONLY | os.O_DIRECTORY | os.O_NONBLOCK | os.O_CLOEXEC
NEW = os.O_RDWR | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW | os.O_CLOEXEC
PIECE = 1 << 20  # bytes that are written or checked at once


def status(name, folder):
    """What is at this place of a folder, links not followed; None: nothing."""
    try:
        return os.stat(name, dir_fd=folder, follow_symlinks=False)
    except FileNotFoundError:
        return None


class RegularFile:
    """A regular file of a folder, read at any place. A pipe, a device or a link is not even opened."""

    def __init__(self, name, folder, most):
        self.name = name
        try:
            found = os.stat(name, dir_fd=folder, follow_symlinks=False)
            if not stat.S_ISREG(found.st_mode):
                raise InputError(f"{name} is no regular file")
            self._descriptor = os.open(name, READING, dir_fd=folder)
        except OSError as error:
            raise InputError(f"{name} cannot be read: {error.strerror}") from error
        opened = os.fstat(self._descriptor)
        self.size = opened.st_size
        problem = None
        if not os.path.samestat(found, opened):
            problem = "was replaced while it was opened"
        elif self.size > most:
            problem = f"has {self.size} bytes; a report reads at most {most}"
        if problem:
            self.close()
            raise InputError(f"{name} {problem}")

    def read(self, at, count):
        """So many bytes from there."""
        pieces = []
        while count > 0:
            try:
                piece = os.pread(self._descriptor, min(count, 1 << 30), at)
            except OSError as error:
                raise InputError(f"{self.name} cannot be read: {error.strerror}") from error
            if not piece:
                raise InputError(f"{self.name} ends early")
            pieces.append(piece)
            at, count = at + len(piece), count - len(piece)
        return pieces[0] if len(pieces) == 1 else b"".join(pieces)

    def close(self):
        os.close(self._descriptor)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()


def write_new(name, folder, content):
    """Writes a file that is not there yet, and reads it back from where it was written."""
    descriptor = os.open(name, NEW, 0o666, dir_fd=folder)
    try:
        rest = memoryview(content)
        while rest:
            rest = rest[os.write(descriptor, rest[:PIECE]) :]
        os.fsync(descriptor)
        pieces = range(0, len(content) + 1, PIECE)
        if any(os.pread(descriptor, PIECE, at) != content[at : at + PIECE] for at in pieces):
            raise OutputError(f"{name} reads otherwise than it was written")
    finally:
        os.close(descriptor)
