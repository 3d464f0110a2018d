# SPDX-License-Identifier: GPL-2.0-or-later
"""The part of report.py that reads, computes and draws, as a process of its own: report.py stays able to
tidy up and to say one line, whatever becomes of it here. Arguments: a result folder and an empty one as open
descriptors, and the name of the first; standard input: the manifest. Writes the files of the report into the
empty one and says on its standard output, as JSON, how that went.
"""
import contextlib
import errno
import json
import mmap
import os
import resource
import signal
import sys
import traceback

from errors import InputError, OutputError

MOST_CPU_SECONDS = 3600  # then it is stopped: no results that the program writes need as long
NO_MEMORY = "there is not enough memory to draw it"
LEAST_BYTES = 256 << 20  # of memory, to begin with


def report_files(results):
    """Path and content of every file of the report, the page last.
    A figure that the data do not give comes as what was left out and why.
    """
    from figure import LeftOut, files_of
    from page import page

    shown, left_out, pictures = [], [], []
    for figure in results.report.figures(results):
        if isinstance(figure, LeftOut):
            left_out.append(figure)
            continue
        files = dict(files_of(figure))
        yield from ((f"figures/{name}", content) for name, content in files.items())
        shown.append(figure)
        left_out += [figure.lacks] if figure.lacks else []
        pictures.append(files[f"{figure.name}.svg"])
    yield "report.html", page(results, shown, left_out, pictures).encode("utf-8")


def start_libraries():
    """OpenBLAS tries without end where it cannot have its 128 MB: they are looked for before,
    and taken by the first product.
    """
    mmap.mmap(-1, LEAST_BYTES).close()
    import numpy

    numpy.ones((2, 2)) @ numpy.ones((2, 2))


def drawn(folder, target, folder_name, manifest):
    """Size and checksum of every file of the report, by its path."""
    start_libraries()
    from files import write_new
    from manifest import ListedFiles, Manifest, entry_of
    from results import read

    files = ListedFiles(folder, Manifest.parsed(manifest))
    results = read(folder_name, files)
    files.check_others()
    try:
        import matplotlib  # noqa: F401
    except ModuleNotFoundError as error:
        if error.name == "matplotlib":
            raise InputError(
                f"{sys.executable} has no matplotlib; on Debian: apt-get install python3-matplotlib"
            ) from None
        raise
    os.mkdir("figures", dir_fd=target)
    written = {}
    for path, content in report_files(results):
        write_new(path, target, content)
        written[path] = entry_of(content)
    return written


def place_of(error):
    """Where in this program an error was met."""
    own = [
        frame
        for frame in traceback.extract_tb(error.__traceback__)
        if os.path.dirname(os.path.dirname(frame.filename)) == os.path.dirname(os.path.dirname(__file__))
    ]
    return f"{type(error).__name__} in {os.path.basename(own[-1].filename)}:{own[-1].lineno}"


def outcome(folder, target, folder_name, manifest):
    try:
        files = drawn(int(folder), int(target), folder_name, manifest)
        return {"code": 0, "files": {path: [entry.checksum, entry.size] for path, entry in files.items()}}
    except (InputError, OutputError) as error:
        return {"code": error.code, "line": str(error)}
    except MemoryError:
        return {"code": OutputError.code, "line": NO_MEMORY}
    except OSError as error:
        line = NO_MEMORY if error.errno == errno.ENOMEM else f"the report cannot be written: {error.strerror}"
        return {"code": OutputError.code, "line": line}
    except ImportError as error:
        return {
            "code": OutputError.code,
            "line": f"the libraries it is drawn with do not start: {place_of(error)}",
        }
    except Exception as error:  # of numbers that passed every check and still cannot be drawn
        return {"code": InputError.code, "line": f"no report can be drawn from its tables: {place_of(error)}"}


if __name__ == "__main__":
    answer = os.dup(1)
    os.dup2(2, 1)  # whatever the libraries say
    os.environ.pop("MPLBACKEND", None)
    signal.pthread_sigmask(signal.SIG_SETMASK, ())
    with contextlib.suppress(ValueError):  # where less is allowed already
        resource.setrlimit(resource.RLIMIT_CPU, (MOST_CPU_SECONDS, MOST_CPU_SECONDS))
    os.write(answer, json.dumps(outcome(*sys.argv[1:], sys.stdin.buffer.read())).encode("ascii"))
