# SPDX-License-Identifier: GPL-2.0-or-later
"""What ends a report early: each is one line on the standard error, and an exit code."""


class InputError(Exception):
    """The folder cannot be used as it is; nothing was changed."""

    code = 2


class OutputError(Exception):
    """The report cannot be computed or written here; the folder is as it was before."""

    code = 3


def one_line(text):
    """Without line ends, escape codes and anything else that a terminal obeys."""
    return "".join(character if character.isprintable() else "?" for character in text)


def shortened(path):
    """A path as a line can bear it."""
    most_letters = 80
    return path if len(path) <= most_letters else f"{path[:most_letters]}... ({len(path)} letters)"


def plain_text(text):
    """For a page and a table: line ends and tabs stay, what no XML may hold does not."""
    return "".join(c if c.isprintable() or c in "\n\t" else "\N{REPLACEMENT CHARACTER}" for c in text)
