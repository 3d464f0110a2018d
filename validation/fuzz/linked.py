#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Whether the harnesses link what they call.

They are linked with unresolved symbols, because what extras compute and what reduces a body stays out. So a
source that reading comes to use is not missed by the linker: a harness then crashes where it is called. Here
a symbol of Flank that is nowhere defined may be asked for by those sources alone.
Usage: validation/fuzz/linked.py BUILD_FOLDER
"""
import pathlib, re, subprocess, sys

root = pathlib.Path(__file__).resolve().parent.parent.parent
extras = {f"{source.name}.o" for source in (root / "cases/parallel_axis/extras").glob("*.cpp")}
extras.add("pressure_maps.cpp.o")  # of the drive
reduction = {"body_compliance.cpp.o", "body_elements.cpp.o"}

libraries = sorted(map(str, pathlib.Path(sys.argv[1]).glob("lib*.a")))
listed = subprocess.run(
    ["nm", "-A", "-P", "--demangle", *libraries], capture_output=True, text=True, check=True
)
defined, asked_for = set(), {}
for line in listed.stdout.splitlines():
    found = re.match(r"\S+?\[(\S+?)\]: (.*flank::.*) ([A-Za-z])(?: .*)?\s*$", line)
    if not found:
        continue
    of_object, symbol, kind = found.groups()
    if kind in "Uw":
        asked_for.setdefault(of_object, set()).add(symbol)
    else:
        defined.add(symbol)
if not defined:
    sys.exit("linked.py: no symbol of Flank was found; is this the folder of the harnesses?")
missing = [
    f"{of_object} uses {symbol}"
    for of_object, symbols in sorted(asked_for.items())
    if of_object not in extras | reduction
    for symbol in sorted(symbols - defined)
]
if missing:
    sys.exit(
        "the harnesses do not link what reading uses; add its sources to validation/fuzz/CMakeLists.txt:\n"
        + "\n".join(missing[:20])
    )
