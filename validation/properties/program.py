# SPDX-License-Identifier: GPL-2.0-or-later
"""Cases as files, the program that is given them, and the tables it writes."""
import csv
import math
import re
import subprocess


class Broken(Exception):
    """A property does not hold."""


class Refused(Exception):
    """The program says in one line that it does not compute this."""


def require(holds, message):
    if not holds:
        raise Broken(message)


def toml(value):
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{k} = {toml(v)}" for k, v in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml, value)) + "]"
    return f'"{value}"' if isinstance(value, str) else repr(value)


def write(case, path):
    """The case file, and beside it the tables it names."""
    lines, tables = [], []
    for key, value in case.items():
        if key in ("files", "hunting"):
            continue
        if isinstance(value, dict):
            tables += ["", f"[{key}]"] + [f"{k} = {toml(v)}" for k, v in value.items()]
        else:
            lines.append(f"{key} = {toml(value)}")
    path.write_text("\n".join(lines + tables) + "\n")
    for name, table in case.get("files", {}).items():
        rows = [",".join([f"removed_um({table['axis']},z_mm)"] + [repr(z) for z in table["z"]])]
        rows += [",".join(map(repr, [at] + row)) for at, row in zip(table["at"], table["um"])]
        (path.parent / name).write_text("\n".join(rows) + "\n")


class Result:
    """Tables of a run: at[torque][position] is a row of te.csv, in the case's order of torques."""

    def __init__(self, folder, case):
        self.torques = case["load"]["pinion_torque_Nm"]
        rows = self._read(folder / "te.csv")
        n = len(rows) // len(self.torques)
        self.at = [rows[i * n : (i + 1) * n] for i in range(len(self.torques))]
        self.pairs, self.lines, self.harmonics = (
            self._read(folder / f"{name}.csv") for name in ("pairs", "lines", "harmonics")
        )
        self.summary = (folder / "summary.txt").read_text()
        loaded_slices = {}
        for row in self.lines:
            key = row["torque_Nm"], row["position"]
            loaded_slices[key] = loaded_slices.get(key, 0) + 1
        self.on_one_slice = {key for key, count in loaded_slices.items() if count == 1}
        self.other = [
            self._read(path)
            for path in sorted(folder.glob("*.csv"))
            if path.name in ("subsurface.csv", "root_stress.csv", "sidebands.csv", "pattern.csv")
        ]

    @staticmethod
    def _read(path):
        with open(path) as file:
            rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
        for row in rows:
            for key, text in row.items():
                if (
                    text == "" and path.name == "subsurface.csv"
                ):  # loaded at edges alone: nothing below the inside
                    continue
                try:
                    row[key] = float(text)
                except ValueError:
                    if key not in ("body", "fillet", "pressure_kind"):
                        raise Broken(f"{path.name}: {key} is {text!r}")
                known = "bound" not in key or not math.isnan(row[key])
                if known and isinstance(row[key], float) and not math.isfinite(row[key]):
                    raise Broken(f"{path.name}: {key} is {text}")
        return rows

    def te(self, torque):
        return [row["te_um"] for row in self.at[torque]]


class Program:
    """Runs cases in a folder, with an operator cache of its own."""

    def __init__(self, flank, folder, environment, seconds=300):
        self.flank, self.folder, self.environment, self.seconds, self.log = (
            flank,
            folder,
            environment,
            seconds,
            [],
        )

    def without_result(self, name, lines, left):
        """Why a run ended with exit code 3, in its words: of all torques, and nothing is written, or of some,
        and the others' results are there.
        """
        results = {"te.csv", "results.h5", "summary.txt"}
        of_all = [line for line in lines if line.startswith("the computation failed, nothing was written: ")]
        of_some = [line for line in lines if re.match(r"failed: \S+ N m has no results: ", line)]
        why, written = (of_all, set()) if of_all else (of_some, results)
        require(
            len(of_all) <= 1 and why and why[-1] == lines[-1] and all(len(line) > 60 for line in why),
            f"{name}: no result, and says {lines[-3:]}",
        )
        require(results & set(left) == written, f"{name}: {why[0]}, and wrote {left}")
        return why[0]

    def __call__(self, case, name, text=None):
        """The result of a case; Refused or Broken where there is none.
        `text`: what becomes of the case file before it is read.
        """
        place = self.folder / name
        place.mkdir(parents=True)
        write(case, place / "case.toml")
        if text:
            path = place / "case.toml"
            path.write_bytes(text(path.read_text()).encode(errors="surrogateescape"))
        command = [str(self.flank), "run", str(place / "case.toml"), "-o", str(place / "out")]
        self.log.append(name)
        try:
            ran = subprocess.run(
                command,
                capture_output=True,
                text=True,
                errors="replace",
                env=self.environment,
                timeout=self.seconds,
            )
        except subprocess.TimeoutExpired:
            raise Broken(f"{name}: no end after {self.seconds} s")
        (place / "messages").write_text(ran.stderr)
        lines = [line for line in ran.stderr.splitlines() if line.strip()]
        bad = [
            line
            for line in lines
            if re.search(r"internal error|[Aa]ssert|terminate called|Traceback|what\(\)|std::", line)
        ]
        require(ran.returncode >= 0, f"{name}: ended by signal {-ran.returncode}: {lines[-1:]}")
        require(not bad, f"{name}: {bad[:1]}")
        left = [path.name for path in (place / "out").iterdir()] if (place / "out").exists() else []
        if ran.returncode == 2:
            require(len(lines) == 1, f"{name}: refused in {len(lines)} lines: {lines}")
            require(not left, f"{name}: refused, and wrote {left}")
            raise Refused(lines[0])
        if ran.returncode == 3:
            raise Refused(self.without_result(name, lines, left))
        require(
            ran.returncode == 0 and "certificate: holds for all" in ran.stdout,
            f"{name}: exit code {ran.returncode}, {lines[-2:]}",
        )
        return Result(place / "out", case)
