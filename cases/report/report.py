#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""report.py DIR: writes DIR/report.html and DIR/figures/NAME.{svg,png,csv} from the results in DIR.
Exit code 2: wrong input, nothing is written."""
import os
import shutil
import signal
import sys
import tempfile
from pathlib import Path


sys.dont_write_bytecode = True  # the folder of the program stays as it is


def figures_of(results):
    """What the page shows, in its order; a figure that the data do not give comes as what was left out and why."""
    import flank_figures as flank
    import mesh_figures as mesh
    import roller_figures as roller
    from study_figures import study_figures

    if results.is_study:
        yield from study_figures(results)
        return
    gear_pair = [
        mesh.harris,
        mesh.harmonics,
        mesh.amplitudes,
        flank.contact_pattern,
        flank.load_share,
        flank.contact_lines,
        flank.modifications,
        mesh.stiffness,
        flank.root_stress,
        flank.hunting_period,
    ]
    double_roller = [
        roller.transmission_error,
        roller.gear_ratio,
        roller.contacts,
        roller.mid_pressure,
        roller.edge_pressure,
        roller.pair_forces,
        roller.pressure_along_rollers,
        mesh.harmonics,
        mesh.amplitudes,
        mesh.stiffness,
    ]
    for figure in gear_pair if results.is_gear_pair else double_roller:
        yield figure(results)


def refuse_foreign(figures):
    """Figures of an earlier report are replaced; anything else in their folder is somebody's own."""
    from results import InputError

    for path in figures.iterdir() if figures.exists() else []:
        if not all(path.with_suffix(ending).is_file() for ending in (".svg", ".png", ".csv")):
            raise InputError(f"{path} is no figure of a report; move it elsewhere")


def write_report(results):
    """All into a hidden folder first, then into place: a report that was stopped leaves the old one as it is."""
    from figure import LeftOut, write
    from page import page

    unfinished = Path(tempfile.mkdtemp(prefix=".report-", dir=results.folder))
    try:
        refuse_foreign(results.folder / "figures")
        (unfinished / "figures").mkdir()
        shown, left_out, pictures = [], [], []
        for figure in figures_of(results):
            if isinstance(figure, LeftOut):
                left_out.append(figure)
                continue
            write(figure, unfinished / "figures")
            shown.append(figure)
            left_out += [figure.lacks] if figure.lacks else []
            pictures.append((unfinished / "figures" / f"{figure.name}.svg").read_bytes())
        (unfinished / "report.html").write_text(page(results, shown, left_out, pictures), encoding="utf-8")
        if (results.folder / "figures").exists():
            os.replace(results.folder / "figures", unfinished / "old")
        os.replace(unfinished / "figures", results.folder / "figures")
        os.replace(unfinished / "report.html", results.folder / "report.html")
    finally:
        shutil.rmtree(unfinished, ignore_errors=True)


def main(arguments):
    if len(arguments) != 1:
        return "usage: flank report DIR"
    try:
        import h5py  # noqa: F401
        import matplotlib  # noqa: F401
    except ImportError as error:
        return f"flank report: {sys.executable} has no {error.name}; on Debian: apt-get install python3-matplotlib python3-h5py"
    from results import InputError, read

    try:
        results = read(arguments[0])
    except (InputError, OSError) as error:
        return f"flank report: {error}"
    try:
        write_report(results)
    except InputError as error:
        return f"flank report: {error}"
    except KeyError as error:
        return f"flank report: {arguments[0]}: its tables have no {error}; they are of another version of flank: compute them anew"
    except OSError as error:
        return f"flank report: cannot write to {arguments[0]}: {error.strerror}"
    print(f"report in {Path(arguments[0]) / 'report.html'}")
    return None


if __name__ == "__main__":
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))  # so that the hidden folder is removed
    if problem := main(sys.argv[1:]):
        print(problem, file=sys.stderr)
        sys.exit(2)
