# SPDX-License-Identifier: GPL-2.0-or-later
"""Files of fields as deal.II writes them."""
import base64
import re
import zlib

import numpy as np


def read(path):
    """Points, cells and point data of a file written by deal.II."""
    text = open(path).read()

    kinds = {
        "Float32": "<f4",
        "Float64": "<f8",
        "Int32": "<i4",
        "Int64": "<i8",
        "UInt8": "u1",
        "UInt32": "<u4",
        "UInt64": "<u8",
    }

    def content(body):
        """Header (blocks, their size, the last one's, their compressed sizes) and blocks,
        each of both in base64.
        """
        blocks = int(np.frombuffer(base64.b64decode(body[:8])[:4], "<u4")[0])
        size = 4 * (3 + blocks)
        characters = 4 * ((size + 2) // 3)
        raw, at, result = base64.b64decode(body[characters:]), 0, b""
        for length in np.frombuffer(base64.b64decode(body[:characters])[:size], "<u4")[3:]:
            result += zlib.decompress(raw[at : at + int(length)])
            at += int(length)
        return result

    found = {}
    for attributes, body in re.findall(r"<DataArray([^>]*)>([^<]*)</DataArray>", text):
        get = dict(re.findall(r'(\w+)="([^"]*)"', attributes))
        values = np.frombuffer(content(body.strip()), kinds[get["type"]])
        count = int(get.get("NumberOfComponents", 1))
        found[get.get("Name", "points")] = values.reshape(-1, count) if count > 1 else values
    return found
