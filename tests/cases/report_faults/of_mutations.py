# SPDX-License-Identifier: GPL-2.0-or-later
"""Random changes under a manifest that fits."""
import os
import random

from checks import COUNT, Cases, one_line, report, snapshot

MUTATIONS = int(os.environ.get("FLANK_MUTATIONS", 20))  # 200 on record


def mutated(chance, content):
    """Bytes flipped, a piece cut, lines deleted or exchanged."""
    changed = bytearray(content)
    kind = chance.randrange(4)
    if kind == 0:
        for _ in range(chance.choice((1, 2, 8))):
            changed[chance.randrange(len(changed))] ^= 1 << chance.randrange(8)
        return bytes(changed)
    if kind == 1:
        return content[: chance.randrange(len(content))]
    lines = content.split(b"\n")
    first, second = chance.randrange(len(lines)), chance.randrange(len(lines))
    if kind == 2:
        del lines[first]
    else:
        lines[first], lines[second] = lines[second], lines[first]
    return b"\n".join(lines)


def mutations(all_files, work):
    """Random changes under a manifest that fits: refused, or such that the tables still are tables."""
    chance, codes = random.Random(5), []
    for number in range(MUTATIONS):
        files = dict(chance.choice(all_files))
        name = chance.choice([name for name in files if name not in ("case.toml", "summary.txt")])
        if number % 10 == 0:
            files[name] = chance.choice(all_files).get(name, b"")
        else:
            files[name] = mutated(chance, files[name])
        with Cases(files, work).folder(name=f"mutation_{number}") as folder:
            before = snapshot(folder)
            code, out, said = report(folder)
            assert (
                code == 0 and not said or code == 2 and one_line(said) and not out
            ), f"mutation {number} of {name}: {code} {said}"
            now = snapshot(folder)
            assert code == 0 or now == before, f"mutation {number} changed the folder"
            assert all(now[path] == content for path, content in before.items() if path != "manifest.txt")
            codes.append(code)
    assert codes.count(2) > MUTATIONS / 2, codes.count(2)
    COUNT["passed"] += MUTATIONS
