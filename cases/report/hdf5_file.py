# SPDX-License-Identifier: GPL-2.0-or-later
"""Reads the HDF5 files that cases/results/hdf5_file.cpp writes, and no others: groups by symbol tables,
doubles and whole numbers in one piece, texts as attributes of the root. The HDF5 library itself crashes,
or does not end, on one damaged file in two hundred; here every place and every size that the file gives is
checked before it is used. Chapters: of the "HDF5 File Format Specification", version 3.
"""
import math
import struct

import numpy as np

from errors import InputError

SIGNATURE = b"\x89HDF\r\n\x1a\n"
VERSIONS = bytes(
    [0, 0, 0, 0, 0, 8, 8, 0]
)  # of the superblock and its parts; addresses and sizes have 8 bytes
DOUBLE = bytes.fromhex(
    "11203f00 08000000 00004000 340b0034 ff030000"
)  # datatype message of an IEEE double, low byte first
WHOLE = bytes.fromhex("10080000 04000000 00002000")  # of a whole number of 4 bytes, with sign
DATASPACE, DATATYPE, LAYOUT, ATTRIBUTE, CONTINUATION, SYMBOL_TABLE = 0x01, 0x03, 0x08, 0x0C, 0x10, 0x11
MOST_BYTES = 1 << 26  # of a heap of names or a text
MOST_HEADER_BYTES, MOST_HEADER_BLOCKS = 1 << 20, 64
MOST_DEPTH, MOST_NODES, MOST_CHILDREN = 16, 1 << 20, 1 << 10  # of a tree of links
MOST_NAME = 256
MOST_OBJECTS = 1 << 16  # of a global heap: their numbers have 16 bits


def padded(size):
    return (size + 7) // 8 * 8


class Hdf5File:
    """Throws InputError where the file is not as Flank writes it."""

    def __init__(self, file):
        """file: gives read(at, count), size and name."""
        self._file = file
        head = self._bytes(0, 96)
        base, end = struct.unpack_from("<Q8xQ", head, 24)
        self._require(head[:8] == SIGNATURE, "no HDF5 file")
        self._require(head[8:16] == VERSIONS and base == 0, "of another version of HDF5")
        self._require(end == file.size, "cut short or longer than it says")
        self._root = self._messages(struct.unpack_from("<Q", head, 64)[0])
        self._groups = {}  # links by their tree's address

    def text(self, name):
        """A text attribute of the root."""
        for kind, body in self._root:
            if kind == ATTRIBUTE:
                found, datatype, dataspace, data = self._attribute(body)
                if found == name.encode("ascii"):
                    is_text = datatype[0] & 0x0F == 9 and datatype[1] & 0x0F == 1 and dataspace[1] == 0
                    self._require(is_text and len(data) >= 16, f"attribute {name} is no text")
                    return self._heap_text(name, *struct.unpack_from("<IQI", data))
        raise self._error(f"attribute {name} is missing")

    def names(self, group=""):
        """What a group holds, the root where none is given; nothing where there is no such group."""
        header = self._find(group) if group else None
        if group and header is None:
            return []
        return list(self._links(self._messages(header) if group else self._root))

    def numbers(self, path, *shape):
        """A dataset of finite numbers; None in its shape: any length."""
        header = self._find(path)
        self._require(header is not None, f"{path} is missing")
        parts = dict(self._messages(header))
        self._require({DATASPACE, DATATYPE, LAYOUT} <= parts.keys(), f"{path} is no dataset")
        lengths = self._dimensions(parts[DATASPACE])
        fits = len(lengths) == len(shape) and all(
            want in (None, found) for want, found in zip(shape, lengths)
        )
        self._require(fits, f"{path} has another shape than the tables")
        is_whole = parts[DATATYPE][: len(WHOLE)] == WHOLE
        self._require(
            is_whole or parts[DATATYPE][: len(DOUBLE)] == DOUBLE,
            f"{path} does not hold doubles or whole numbers",
        )
        bytes_each = 4 if is_whole else 8
        layout, count = parts[LAYOUT], math.prod(lengths)
        self._require(len(layout) >= 18 and layout[:2] == b"\x03\x01", f"{path} does not lie in one piece")
        at, size = struct.unpack_from("<QQ", layout, 2)
        self._require(size == bytes_each * count, f"{path} has another size than its shape")
        content = self._bytes(at, size, size) if size else b""
        values = np.frombuffer(content, "<i4" if is_whole else "<f8").astype(float).reshape(lengths)
        self._require(np.all(np.isfinite(values)), f"{path} holds what is no number")
        return values

    def _error(self, what):
        return InputError(f"{self._file.name} is not as Flank writes it: {what}")

    def _require(self, condition, what):
        if not condition:
            raise self._error(what)

    def _bytes(self, at, count, most=MOST_BYTES):
        self._require(count <= most and at + count <= self._file.size, "a part of it lies outside")
        return self._file.read(at, count) if count else b""

    def _messages(self, at):
        """Kind and content of the messages of an object header, version 1 (chapter IV.A.1.a)."""
        version, count, size = struct.unpack("<BxHxxxxI", self._bytes(at, 12))
        self._require(version == 1, "an object is of another version of HDF5")
        blocks, messages = [(at + 16, size)], []
        for block in blocks:
            self._require(len(blocks) <= MOST_HEADER_BLOCKS, "an object's header is damaged")
            content, place = self._bytes(*block, MOST_HEADER_BYTES), 0
            while place + 8 <= len(content) and len(messages) < count:
                kind, length, flags = struct.unpack_from("<HHB", content, place)
                body = content[place + 8 : place + 8 + length]
                self._require(len(body) == length and not flags & 2, "an object's header is damaged")
                if kind == CONTINUATION and length >= 16:
                    blocks.append(struct.unpack_from("<QQ", body))
                messages.append((kind, body))
                place += 8 + length
        return messages

    def _attribute(self, body):
        """Name, datatype, dataspace and data (chapter IV.A.2.m, version 1: each is padded)."""
        self._require(len(body) >= 8 and body[0] == 1, "an attribute is of another version of HDF5")
        parts, at = [], 8
        for size in struct.unpack_from("<HHH", body, 2):
            parts.append(body[at : at + size])
            at += padded(size)
        self._require(
            at <= len(body) and len(parts[1]) >= 8 and len(parts[2]) >= 4, "an attribute is damaged"
        )
        return parts[0].rstrip(b"\0"), parts[1], parts[2], body[at:]

    def _heap_text(self, name, length, heap, number):
        """A text of the global heap (chapter III.E)."""
        if length == 0:
            return ""
        signature, version, size = struct.unpack("<4sB3xQ", self._bytes(heap, 16))
        self._require(signature == b"GCOL" and version == 1, "its heap is damaged")
        at = heap + 16
        for _ in range(MOST_OBJECTS):
            found, object_size = struct.unpack("<H6xQ", self._bytes(at, 16))
            if found in (0, number) or at > heap + size:
                break
            at += 16 + padded(object_size)
        self._require(found == number != 0 and length <= object_size, f"attribute {name} is damaged")
        try:
            return self._bytes(at + 16, length).rstrip(b"\0").decode("utf-8")
        except UnicodeDecodeError:
            raise self._error(f"attribute {name} is no text") from None

    def _dimensions(self, body):
        """Of a dataspace message (chapter IV.A.2.b, version 1)."""
        self._require(
            len(body) >= 8 and body[0] == 1 and len(body) >= 8 + 8 * body[1], "a dataspace is damaged"
        )
        return struct.unpack_from(f"<{body[1]}Q", body, 8)

    def _find(self, path):
        """Address of the object header at a path from the root; None: it is not there."""
        messages, address = self._root, None
        for name in path.split("/"):
            messages = self._messages(address) if address is not None else messages
            address = self._links(messages).get(name)
            if address is None:
                return None
        return address

    def _links(self, messages):
        """Addresses of a group's objects by their names (chapters III.A.1, III.B, III.D)."""
        table = dict(messages).get(SYMBOL_TABLE, b"")
        self._require(len(table) >= 16, "a group is damaged")
        tree, heap = struct.unpack_from("<QQ", table)
        if (tree, heap) not in self._groups:
            signature, version, size, at = struct.unpack("<4sB3xQ8xQ", self._bytes(heap, 32))
            self._require(signature == b"HEAP" and version == 0, "the names of a group are damaged")
            names, links = self._bytes(at, size), {}
            for name, header in self._entries(tree):
                end = names.find(b"\0", name, name + MOST_NAME)
                self._require(end > name, "the names of a group are damaged")
                links[names[name:end].decode("utf-8", "replace")] = header
            self._groups[tree, heap] = links
        return self._groups[tree, heap]

    def _entries(self, tree):
        """Places of the names and addresses of the headers below a tree's node. No node is met twice."""
        nodes, met = [(tree, MOST_DEPTH)], set()
        while nodes:
            at, depth = nodes.pop()
            self._require(at not in met and len(met) < MOST_NODES, "the links of a group are damaged")
            met.add(at)
            if self._bytes(at, 4) == b"SNOD":
                count = struct.unpack("<H", self._bytes(at + 6, 2))[0]
                self._require(count <= MOST_CHILDREN, "the links of a group are damaged")
                for name, header, cached in struct.iter_unpack("<QQI20x", self._bytes(at + 8, 40 * count)):
                    self._require(cached in (0, 1), "a link leads out of it")
                    yield name, header
                continue
            signature, kind, _, count = struct.unpack("<4sBBH", self._bytes(at, 8))
            fits = signature == b"TREE" and kind == 0 and count <= MOST_CHILDREN and depth > 0
            self._require(fits, "the links of a group are damaged")
            keys_and_nodes = struct.unpack(f"<{2 * count}Q", self._bytes(at + 24, 16 * count))
            nodes += [(node, depth - 1) for node in reversed(keys_and_nodes[1::2])]
