# SPDX-License-Identifier: GPL-2.0-or-later
"""How figures look: narrow enough for a phone, colours that stay apart for colour-blind
readers and in grey print.
"""
import textwrap

import matplotlib
import matplotlib.figure
import numpy as np
from matplotlib.patheffects import withStroke

WIDTH_IN = 5.2  # text of 10 points is then still 7 points on a phone
MOST_CURVES = 8  # more cannot be told apart
MOST_TICKS = 40

# Okabe and Ito, "Color universal design" (2008)
BLUE, ORANGE, GREEN, VERMILION, GREY = "#0072b2", "#e69f00", "#009e73", "#d55e00", "#666666"
MAP_COLOURS = "viridis"
LINE_STYLES = ["-", "--", "-.", ":"]

matplotlib.rcdefaults()  # a user's matplotlibrc must not change a report
matplotlib.rcParams.update(
    {
        "font.family": "DejaVu Sans",
        "font.size": 10,
        "axes.titlesize": 10,
        "figure.titlesize": 11,
        "legend.fontsize": 9,
        "legend.frameon": False,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "axes.grid": True,
        "grid.color": "#dddddd",
        "axes.axisbelow": True,
        "image.cmap": MAP_COLOURS,
        "savefig.dpi": 200,
        "svg.hashsalt": "flank",
        "svg.fonttype": "path",
    }
)


def literal(text):
    """To be drawn as it is: dollars begin no formula."""
    return text.replace("$", r"\$")


def panels(rows, columns, height_in, title, **options):
    """A drawing and its axes as an array of rows by columns."""
    drawing = matplotlib.figure.Figure(figsize=(WIDTH_IN, height_in), layout="constrained")
    drawing.get_layout_engine().set(h_pad=0.07)
    drawing.suptitle(
        textwrap.fill(literal(title), 48, break_long_words=False), x=0.01, ha="left", fontweight="bold"
    )
    return drawing, drawing.subplots(rows, columns, squeeze=False, **options)


def curve_styles(count):
    """Colour and line of each curve of a family in the order of a quantity: dark to light, lines in turn."""
    colours = matplotlib.colormaps[MAP_COLOURS](np.linspace(0, 0.78, max(count, 1)))
    return [{"color": colours[i], "linestyle": LINE_STYLES[i % len(LINE_STYLES)]} for i in range(count)]


def legend_above(axes, columns=4):
    axes.legend(
        loc="lower left",
        bbox_to_anchor=(0, 1.01),
        ncol=columns,
        borderaxespad=0,
        handlelength=2.6,
        columnspacing=1.2,
    )


def contour_lines(axes, x, y, values, levels):
    return axes.contour(x, y, values, levels=levels, colors="white", linewidths=0.8)


def label_contours(axes, contours):
    """White, edged in dark to be read on light colours."""
    for label in axes.clabel(contours, fontsize=8, inline_spacing=2):
        label.set_path_effects([withStroke(linewidth=1.5, foreground="#333333")])


def spread(items, most=MOST_CURVES):
    """At most so many of the items, evenly spread, first and last among them."""
    items = list(items)
    if len(items) <= most:
        return items
    return [items[round(i * (len(items) - 1) / (most - 1))] for i in range(most)]
