# SPDX-License-Identifier: GPL-2.0-or-later
"""The page: one HTML file with everything in it, no script."""
import base64
import re
from html import escape

import numpy as np

STYLE = """
:root { color-scheme: light; }
body { font: 16px/1.5 system-ui, sans-serif; color: #111; background: #fff; \
max-width: 46rem; margin: 0 auto; padding: 0 1rem 3rem; }
h1 { font-size: 1.5rem; line-height: 1.25; } \
h2 { font-size: 1.2rem; margin-top: 2.2rem; border-bottom: 1px solid #ccc; }
figure { margin: 1.6rem 0; break-inside: avoid; } img { width: 100%; height: auto; display: block; }
figcaption { font-size: 0.92rem; margin-top: 0.3rem; } a { color: #00527f; }
.wide { overflow-x: auto; } \
table { border-collapse: collapse; font-size: 0.85rem; font-variant-numeric: tabular-nums; }
th, td { padding: 0.15rem 0.55rem; text-align: right; border-bottom: 1px solid #ddd; }
td { white-space: nowrap; } th { vertical-align: bottom; }
pre { font-size: 0.75rem; line-height: 1.35; overflow-x: auto; background: #f5f5f5; padding: 0.6rem; }
.warning { border-left: 4px solid #d55e00; padding-left: 0.7rem; overflow-wrap: anywhere; }
li, p, figcaption { overflow-wrap: anywhere; }
@media print { body { max-width: none; padding: 0; font-size: 11pt; } \
figure img { width: auto; max-width: 13cm; max-height: 19cm; }
  pre { font-size: 6pt; white-space: pre-wrap; background: none; padding: 0; }
  .wide { overflow: visible; } table { font-size: 7pt; } th, td { padding: 0 0.3em; } nav { display: none; } }
"""


def page(results, figures, left_out, pictures):
    """Figures in their order, with the bytes of their SVG."""
    parts = [
        f"<h1>{escape(results.title)}</h1>",
        f"<p>{escape(results.report.subject(results))}</p>",
        *warnings(results),
        contents(figures),
        "<h2 id='key-figures'>Key figures</h2>",
        key_figures(results),
        "<h2 id='figures'>Figures</h2>",
        "<p>The folder <code>figures</code> beside this page has each as SVG and PNG, "
        "and the numbers drawn as CSV.</p>",
        *(
            figure_block(number, figure, picture)
            for number, (figure, picture) in enumerate(zip(figures, pictures), 1)
        ),
        certificate(results),
        stage_times(results),
        left_out_list(left_out),
        conventions(results),
        "<h2 id='summary'>Summary of the program</h2>",
        preformatted("\n".join(results.summary)),
        "<h2 id='case'>Case</h2><p>As given:</p>",
        preformatted(results.case_given),
        "<p>As resolved, with every key that was set:</p>",
        preformatted(results.case_resolved),
        "<h2 id='versions'>Versions</h2>",
        preformatted(results.versions),
    ]
    return (
        "<!DOCTYPE html>\n<html lang='en'>\n<head>\n<meta charset='utf-8'>\n"
        "<meta name='viewport' content='width=device-width, initial-scale=1'>\n"
        f"<title>{escape(results.title)}</title>\n<link rel='icon' href='data:,'>\n"
        f"<style>{STYLE}</style>\n</head>\n<body>\n" + "\n".join(parts) + "\n</body>\n</html>\n"
    )


def preformatted(content):
    return f"<pre>{escape(content.strip())}</pre>"


def table(head, rows):
    line = (
        lambda cells, tag: "<tr>" + "".join(f"<{tag}>{escape(str(cell))}</{tag}>" for cell in cells) + "</tr>"
    )
    return (
        f"<div class='wide'><table>{line(head, 'th')}{''.join(line(row, 'td') for row in rows)}</table></div>"
    )


def key_figures(results):
    head, rows, note = results.report.key_figures(results)
    return table(head, rows) + (f"<p>{escape(note)}</p>" if note else "")


def warnings(results):
    return [
        f"<p class='warning'>{escape(line)}</p>" for line in results.summary if line.startswith("warning:")
    ]


def contents(figures):
    figure_links = "".join(
        f"<li><a href='#{figure.name}'>{escape(figure.title)}</a></li>" for figure in figures
    )
    sections = {
        "key-figures": "Key figures",
        "certificate": "Certificate and errors",
        "times": "Stage times",
        "left-out": "What was left out",
        "conventions": "Conventions",
        "summary": "Summary of the program",
        "case": "Case",
        "versions": "Versions",
    }
    section_links = ", ".join(f"<a href='#{name}'>{title}</a>" for name, title in sections.items())
    return f"<nav><p>{section_links}</p><ol>{figure_links}</ol></nav>"


def figure_block(number, figure, picture):
    source = base64.b64encode(picture).decode()
    files = ", ".join(
        f"<a href='figures/{figure.name}.{kind}'>{kind.upper()}</a>" for kind in ("csv", "svg", "png")
    )
    return (
        f"<figure id='{figure.name}'><img alt='{escape(figure.title, quote=True)}' "
        f"src='data:image/svg+xml;base64,{source}'>"
        f"<figcaption><b>Figure {number}.</b> {escape(figure.caption)} [{files}]</figcaption></figure>"
    )


def certificate(results):
    of_all = results.tables[results.certified]["certificate"]
    of_all = of_all[~np.isnan(of_all)]
    lines = [line for line in results.summary if re.match(r"certificate|study:", line)]
    worst = f"{of_all.max():.2e}" if len(of_all) else "none"
    parts = [
        "<h2 id='certificate'>Certificate and errors</h2>",
        "<p>Every contact solution was checked by separate code: equilibrium, no tension, no overlap. "
        f"Greatest relative violation in {results.certified}, over {len(of_all)} solutions: {worst} "
        "(allowed: 1e-10). This says that the contact problem was solved, "
        "not how well elements and contact grid describe the bodies.</p><ul>",
        *(f"<li>{escape(line)}</li>" for line in lines),
        "</ul>",
        estimate(results),
    ]
    return "".join(parts)


def estimate(results):
    """Differences from another accuracy level, where the results have them."""
    found, asked = results.error_estimate, results.estimate_key
    if found is None:
        ask = f", or ask for <code>{escape(asked)}</code>" if asked else ""
        return (
            "<p>These results carry no estimate of the error of elements and contact grid. "
            f"Compare with a finer computation of the same case (<code>{results.report.FINER}</code>){ask}; "
            "validation/README.md has measured errors.</p>"
        )
    return f"<h3>Error estimate</h3><p>{escape(found.meaning)}</p>{table(found.heads, found.rows)}"


def stage_times(results):
    found = [re.fullmatch(r"(\S.*?)\s{2,}([0-9.]+) s", line) for line in results.summary]
    rows = [match.groups() for match in found if match]
    content = table(["stage", "time s"], rows) if rows else "<p>The summary of this folder has none.</p>"
    return f"<h2 id='times'>Stage times</h2>{content}"


def left_out_list(left_out):
    items = "".join(f"<li>{escape(entry.title)}: {escape(entry.reason)}.</li>" for entry in left_out)
    return f"<h2 id='left-out'>What was left out</h2><ul>{items or '<li>Nothing.</li>'}</ul>"


def conventions(results):
    return (
        "<h2 id='conventions'>Conventions</h2><p>Lengths in mm, forces in N, pressures in MPa (compression "
        f"positive); units stand in every label and column.</p><p>{escape(' '.join(results.conventions))}</p>"
    )
