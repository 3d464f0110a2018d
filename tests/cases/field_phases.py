# SPDX-License-Identifier: GPL-2.0-or-later
"""Bodies in ParaView files stand as far round as the mesh has come: field_phases.py FOLDER.
FOLDER/fields has positions 0 and 3 of 4 of the helical example: both gears of 50 teeth, 150 mm apart.
"""
import base64
import pathlib
import re
import struct
import sys
import zlib

import numpy


def points(path):
    """The nodes of a VTU file, zlib blocks behind the sizes of them. [mm]"""
    data = re.search(r'<Points>.*?format="binary">\s*(.*?)\s*</DataArray>', path.read_text(), re.S)[1]
    count = struct.unpack("<I", base64.b64decode(data[:8])[:4])[0]
    head = len(base64.b64encode(bytes(4 * (3 + count))))
    sizes = struct.unpack(f"<{3 + count}I", base64.b64decode(data[:head]))[3:]
    blocks, at, content = base64.b64decode(data[head:]), 0, b""
    for size in sizes:
        content += zlib.decompress(blocks[at : at + size])
        at += size
    return numpy.frombuffer(content, "<f4").reshape(-1, 3).astype(float)


for body, towards in (("pinion", 0), ("gear", 150)):
    ends = []
    for position in (0, 3):
        (path,) = (pathlib.Path(sys.argv[1]) / "fields").glob(f"{body}_*_position_{position:04}.vtu")
        x, y, _ = points(path).T
        angle = numpy.degrees(numpy.arctan2(y, abs(x - towards)))
        ends.append((angle.min(), angle.max()))
    turned = numpy.subtract(ends[1], ends[0])
    # Both go up where they mesh, the pinion about its own axis, the gear about one on the other side.
    assert abs(turned - 0.75 * 360 / 50).max() < 1e-4, (body, turned)  # degrees; files have 4 bytes a number
