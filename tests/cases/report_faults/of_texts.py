# SPDX-License-Identifier: GPL-2.0-or-later
"""Texts that would be markup, formulas or escape codes elsewhere."""
import csv
import xml.etree.ElementTree
from html import unescape

import result_folders

from checks import Cases, HOSTILE, accepted
from of_stores import changed_store


def texts(work):
    """Texts of a case and of tables on the page and in figures' numbers."""
    case = result_folders.GEAR_CASE
    title = HOSTILE.replace("\\", "").replace('"', '\\"').replace("\x1b", "\\u001b")
    resolved = case.replace("a gear pair", title).replace("scene", f'pinion.like = "{title}"\nscene', 1)

    def change(file):
        file.attrs["case_resolved"] = resolved
        file.attrs["case"] = f"# {HOSTILE}\x01\n{resolved}"
        file.attrs["versions"] = f"flank {HOSTILE}\n"

    files = result_folders.study()
    files["study.h5"] = changed_store(files["study.h5"], change)
    files[
        "summary.txt"
    ] = f"{HOSTILE}\n{files['summary.txt'].decode().splitlines()[1]}\nwarning: {HOSTILE}\n".encode()
    quoted = HOSTILE.replace('"', '""')
    files["designs.csv"] = files["designs.csv"].replace(
        b"failed: @no contact", b'"failed: @' + quoted.encode() + b'"'
    )
    files["designs.csv"] = files["designs.csv"].replace(
        b'"a ""quoted"", $long$ name"', f'"@{quoted} $x$"'.encode()
    )
    files["te.csv"] = f"# {HOSTILE}\n".encode() + files["te.csv"]
    with Cases(files, work).folder() as folder:
        accepted("hostile texts", folder)
        page = (folder / "report.html").read_text(encoding="utf-8")
        assert "<script" not in page and "\x1b" not in page and "\x01" not in page
        assert unescape(page).count("<script>alert(1)</script> & \"q\" 'a'") >= 9
        for path in folder.glob("figures/*.csv"):
            with open(path, newline="", encoding="utf-8") as stream:
                cells = [cell for row in csv.reader(stream) for cell in row]
            formulas = [cell for cell in cells if cell[:1] in tuple("=+-@\t")]
            assert all(
                cell.lstrip("+-").replace(".", "").replace("e-", "").isdigit() for cell in formulas
            ), f"{path.name}: {formulas}"
        assert (
            "'=1+1" in (folder / "figures/axis_2_map.csv").read_text()
            and "'@<script" in (folder / "figures/axis_2_map.csv").read_text()
        )
        for path in folder.glob("figures/*.svg"):
            xml.etree.ElementTree.parse(path)
