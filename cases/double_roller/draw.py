#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Draws a double-roller drive from the geometry of its case file at crank angle 0:
draw.py CASE.toml > drive.svg
"""
import math
import re
import sys

text = open(sys.argv[1]).read()
value = lambda key: float(re.search(rf"^{key}\s*=\s*([0-9.]+)", text, re.M).group(1))
n, R, rr = int(value("rollers")), value("roller_circle_radius_mm"), value("roller_radius_mm")
R1, rs, e = value("sleeve_circle_radius_mm"), value("sleeve_radius_mm"), value("eccentricity_mm")
half = R + 2 * rr
circle = lambda x, y, r, style: f'<circle cx="{x:.4f}" cy="{-y:.4f}" r="{r:.4f}" {style}/>'
out = [
    f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{-half:.2f} {-half:.2f} '
    f'{2 * half:.2f} {2 * half:.2f}" width="520" font-family="sans-serif" font-size="1.6">'
]
out.append(circle(0, 0, R, 'fill="none" stroke="#999" stroke-width="0.1" stroke-dasharray="0.8 0.5"'))
out.append(circle(e, 0, R1, 'fill="none" stroke="#999" stroke-width="0.1" stroke-dasharray="0.8 0.5"'))
points = []
for i in range(3601):  # the exactly conjugate profile: inner parallel of the rollers' trochoid in the carrier
    t = 2 * math.pi * i / 3600
    dx, dy = -R * math.sin(t) + e * n * math.sin(n * t), R * math.cos(t) - e * n * math.cos(n * t)
    s = math.hypot(dx, dy)
    points.append(
        f"{R * math.cos(t) - e * math.cos(n * t) - rr * dy / s + e:.4f},"
        f"{-(R * math.sin(t) - e * math.sin(n * t) + rr * dx / s):.4f}"
    )
for k in range(1, n + 1):
    a = 2 * math.pi * k / n
    out.append(
        circle(
            R * math.cos(a),
            R * math.sin(a),
            rr,
            'fill="#0072b2" fill-opacity="0.55" stroke="#003d66" stroke-width="0.12"',
        )
    )
for k in range(1, n):
    a = 2 * math.pi * (k - 0.5) / (n - 1)
    out.append(
        circle(
            e + R1 * math.cos(a),
            R1 * math.sin(a),
            rs,
            'fill="#e69f00" fill-opacity="0.55" stroke="#7a5300" stroke-width="0.12"',
        )
    )
out.append(f'<polyline points="{" ".join(points)}" fill="none" stroke="#d55e00" stroke-width="0.12"/>')
out.append(f'<line x1="0" y1="0" x2="{e}" y2="0" stroke="#000" stroke-width="0.35"/>')
for y, line in (
    (-4, f"{n} rollers (blue), fixed"),
    (-1.8, f"{n - 1} sleeves (orange) on the carrier"),
    (3.2, "crank, eccentricity (black)"),
    (5.4, "conjugate profile (red)"),
):
    out.append(f'<text x="0" y="{y}" text-anchor="middle">{line}</text>')
print("\n".join(out + ["</svg>"]))
