#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""check.py REPORT.html [-o DIR]: opens a report in headless Chromium at desktop and phone width.
Exit code 1: console errors, a figure that is missing, empty or without its files,
or a page wider than the screen. With -o: screenshots of both in DIR.
"""
import argparse
import json
import re
import subprocess
import sys
import tempfile
from html import unescape
from pathlib import Path

WIDTHS = {"desktop": 1200, "phone": 390}

# Writes into the page what a browser made of it. The frame gives a phone's width,
# which no window of Chromium is narrow enough for.
MEASURE = """<script>addEventListener("load", () => {
  const images = [...document.querySelectorAll("figure img")];
  const found = {images: images.map(i => [i.alt, i.naturalWidth, i.clientWidth, i.clientHeight]),
                 figures: document.querySelectorAll("figure").length, \
page: document.documentElement.scrollWidth, screen: innerWidth,
                 height: document.documentElement.scrollHeight};
  parent.postMessage(JSON.stringify(found), "*");
});</script>"""
FRAME = """<!DOCTYPE html><html><head><link rel="icon" href="data:,"></head><body style="margin:0">\
<pre id="measured" hidden></pre>
<script>addEventListener("message", e => document.getElementById("measured").textContent = e.data);</script>
<iframe src="measured.html" style="border:0;width:{width}px;height:{height}px"></iframe></body></html>"""


def chromium(page, profile, *flags):
    command = [
        "chromium",
        "--headless",
        "--no-sandbox",
        "--disable-gpu",
        "--enable-logging=stderr",
        "--v=0",
        "--hide-scrollbars",
        "--virtual-time-budget=5000",
        f"--user-data-dir={profile}",
        *flags,
        page.resolve().as_uri(),
    ]
    return subprocess.run(command, capture_output=True, text=True, timeout=120, check=True)


def opened(report, width, screenshot):
    """What the browser measured at this width, and its console."""
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        (folder / "measured.html").write_text(
            report.read_text(encoding="utf-8").replace("</body>", MEASURE + "</body>"), encoding="utf-8"
        )
        frame = folder / "frame.html"
        frame.write_text(FRAME.format(width=width, height=900), encoding="utf-8")
        result = chromium(frame, folder / "profile", "--window-size=1200,900", "--dump-dom")
        measured = json.loads(
            unescape(re.search(r'<pre id="measured" hidden="">(.*?)</pre>', result.stdout, re.S).group(1))
        )
        console = [line for line in result.stderr.splitlines() if "CONSOLE" in line]
        if screenshot:
            frame.write_text(FRAME.format(width=width, height=measured["height"]), encoding="utf-8")
            chromium(
                frame,
                folder / "profile",
                f"--window-size={max(width, 500)},{measured['height']}",
                f"--screenshot={screenshot.resolve()}",
            )
    return measured, console


def problems(report, measured, console):
    text = report.read_text(encoding="utf-8")
    linked = re.findall(r"href='(figures/[^']*)'", text)
    yield from console
    if (
        not measured["images"]
        or len(measured["images"]) != measured["figures"]
        or len(linked) != 3 * measured["figures"]
    ):
        yield f"{measured['figures']} figures, {len(measured['images'])} images, {len(linked)} linked files"
    yield from (
        f"{name}: empty"
        for name, natural, width, height in measured["images"]
        if not (natural and width and height)
    )
    yield from (
        f"{name}: missing or empty"
        for name in linked
        if not (report.parent / name).is_file() or not (report.parent / name).stat().st_size
    )
    if measured["page"] > measured["screen"]:
        yield f"the page is {measured['page']} px wide on a screen of {measured['screen']} px"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("report", type=Path)
    parser.add_argument("-o", dest="screenshots", type=Path, help="folder of the screenshots")
    arguments = parser.parse_args()
    failed = False
    for name, width in WIDTHS.items():
        measured, console = opened(
            arguments.report, width, arguments.screenshots and arguments.screenshots / f"{name}.png"
        )
        found = list(problems(arguments.report, measured, console))
        failed |= bool(found)
        print(
            f"{name}, {measured['screen']} px: {len(measured['images'])} figures, {len(found)} problems",
            *found,
            sep="\n  ",
        )
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
