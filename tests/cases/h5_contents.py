# SPDX-License-Identifier: GPL-2.0-or-later
"""What an HDF5 file of results says, but for the times of its stages: equal results give equal contents.

Usage: h5_contents.py FILE      prints a checksum
"""
import hashlib
import sys

import h5py


def contents(path):
    """Checksum of the names, attributes and values of everything but the group of stages."""
    digest = hashlib.sha256()

    def take(name, item):
        if name == "stages" or name.startswith("stages/"):
            return
        attributes = sorted((key, str(value)) for key, value in item.attrs.items() if "LIST" not in key)
        digest.update(f"{name} {attributes}".encode())
        if isinstance(item, h5py.Dataset):
            digest.update(f"{item.dtype} {item.shape}".encode() + item[()].tobytes())

    with h5py.File(path) as file:
        take("", file)
        file.visititems(take)
    return digest.digest()


if __name__ == "__main__":
    print(contents(sys.argv[1]).hex())
