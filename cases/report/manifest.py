# SPDX-License-Identifier: GPL-2.0-or-later
"""manifest.txt of a result folder: which files Flank wrote there, with their sizes and checksums."""
import re
import zlib
from dataclasses import dataclass, replace

from errors import InputError
from files import PIECE, RegularFile

NAME = "manifest.txt"
FIRST_LINE = "Flank results, format 1. Only the files listed here are ever replaced or removed by Flank."
FAILED = "failed: "
MOST_BYTES = 1 << 26
MOST_TABLE_BYTES = 1 << 30
MOST_STORE_BYTES = 1 << 36  # of results.h5 and study.h5, which are read in parts
REPORT_FILE = re.compile(r"report\.html|figures/[A-Za-z0-9_]+\.(svg|png|csv)")
FIELD_FILE = re.compile(r"fields/[^/]+\.(vtu|pvtu|pvd)|fields/view\.py")


@dataclass(frozen=True)
class Entry:
    checksum: int  # CRC-32
    size: int  # [byte]


def entry_of(content):
    return Entry(zlib.crc32(content), len(content))


@dataclass(frozen=True)
class Manifest:
    program: str
    command: str  # run or study
    files: dict  # entries by path, in the order of the file
    failures: tuple  # lines of what was asked for and not found, from "failed: " on
    case: str  # resolved, to the end of the file

    @classmethod
    def parsed(cls, content):
        """Throws InputError where it is not as Flank writes it."""
        try:
            head, found, case = content.decode("utf-8").partition("\ncase:\n")
        except UnicodeDecodeError:
            raise damaged() from None
        lines = head.split("\n")
        fields = dict(line.split(": ", 1) for line in lines[1:4] if ": " in line)
        if not found or lines[0] != FIRST_LINE or list(fields) != ["program", "command", "files"]:
            raise damaged()
        failures = tuple(line for line in lines[4:] if line.startswith(FAILED))
        of_files = lines[4 : len(lines) - len(failures)]  # failures stand last
        if fields["command"] not in ("run", "study") or fields["files"] != str(len(of_files)):
            raise damaged()
        files = dict(listed(line) for line in of_files)
        if len(files) != len(of_files):
            raise damaged()
        return cls(fields["program"], fields["command"], files, failures, case)

    def content(self):
        lines = [f"{entry.checksum:08x} {entry.size} {path}" for path, entry in self.files.items()]
        head = [FIRST_LINE, f"program: {self.program}", f"command: {self.command}", f"files: {len(lines)}"]
        return "\n".join([*head, *lines, *self.failures, "case:", self.case]).encode("utf-8")

    def of_report(self):
        """Paths of the report that it lists."""
        return [path for path in self.files if REPORT_FILE.fullmatch(path)]

    def of_results(self):
        """What it says of the results, without the report."""
        return self.without_files(self.of_report())

    def with_files(self, files):
        """These entries beside its own: in their old places, else at the end."""
        return replace(self, files={**self.files, **files})

    def without_files(self, paths):
        return replace(self, files={path: entry for path, entry in self.files.items() if path not in paths})


def damaged():
    return InputError(f"its {NAME} is damaged or of another version of Flank; compute the results anew")


def listed(line):
    """Path and entry of a line. A path is a name in the folder, or that of a figure or a field in its own."""
    match = re.fullmatch(r"([0-9a-f]{8}) (0|[1-9][0-9]{0,18}) (.+)", line, re.ASCII)
    path = match.group(3) if match else ""
    is_name = "/" not in path and path not in ("", ".", "..", NAME)
    if not path.isprintable() or not (is_name or REPORT_FILE.fullmatch(path) or FIELD_FILE.fullmatch(path)):
        raise damaged()
    return path, Entry(int(match.group(1), 16), int(match.group(2)))


class ListedFiles:
    """The files of a result folder, each as its manifest has it. Throws InputError where one is not."""

    def __init__(self, folder, manifest):
        self._folder = folder
        self._manifest = manifest
        self._checked = set()

    @property
    def command(self):
        return self._manifest.command

    def __contains__(self, name):
        return name in self._manifest.files

    def tables(self):
        """Names of all CSV files but those of a report."""
        return [name for name in self._manifest.files if name.endswith(".csv") and "/" not in name]

    def store(self, name):
        """Opened, to be read at places; the caller closes it."""
        file = self._opened(name, MOST_STORE_BYTES)
        try:
            checksum = 0
            for at in range(0, file.size, PIECE):
                checksum = zlib.crc32(file.read(at, min(PIECE, file.size - at)), checksum)
            self._check(name, checksum)
        except BaseException:
            file.close()
            raise
        return file

    def content(self, name):
        """Its bytes: what is checked is what is used."""
        with self._opened(name, MOST_TABLE_BYTES) as file:
            content = file.read(0, file.size) if file.size else b""
        self._check(name, zlib.crc32(content))
        return content

    def _opened(self, name, most):
        if name not in self:
            raise InputError(f"{NAME} lists no {name}; compute the results anew")
        file = RegularFile(name, self._folder, most)
        if file.size != self._manifest.files[name].size:
            file.close()
            raise changed(name)
        return file

    def _check(self, name, checksum):
        if checksum != self._manifest.files[name].checksum:
            raise changed(name)
        self._checked.add(name)

    def check_others(self):
        """Those that were not read yet, but for an earlier report's."""
        for name in self._manifest.files:
            if name not in self._checked and not REPORT_FILE.fullmatch(name):
                self.store(name).close()


def changed(name):
    return InputError(
        f"{name} is not as Flank wrote it: {NAME} has another size or checksum; compute the results anew"
    )
