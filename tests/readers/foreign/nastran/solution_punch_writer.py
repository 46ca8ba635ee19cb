"""Punch files of solution set displacements."""

import numpy as np


def dollar(text, line):
    """A $ line with its number."""
    return f"{text:<72}{line:8d}\n"


def row(first, kind, value):
    """A row of a mode or a time, and its continuation."""
    values = "".join(f"{v:18.6E}" for v in (value, 0.0, 0.0))
    zeros = "".join(f"{v:18.6E}" for v in (0.0, 0.0, 0.0))
    return f"{first:>10}       {kind}{values}       7\n" + f"{'-CONT-':<18}{zeros}       8\n"


def heading(word, subcase):
    """The lines above a block."""
    lines = ["$TITLE   = ride", "$SUBTITLE=", "$LABEL   =", f"${word} - SOLUTION SET", "$REAL OUTPUT"]
    return "".join(dollar(text, k) for k, text in enumerate([*lines, f"$SUBCASE ID = {subcase:12d}"], 1))


def solution_punch(times, q, modes, *, subcase=1, word="DISPLACEMENTS"):
    """SORT1: a block for each time, of the coordinates (m, t)."""
    return "".join(
        heading(word, subcase)
        + dollar(f"$TIME = {t:.7E}", 7)
        + "".join(row(mode, "M", q[k, n]) for k, mode in enumerate(modes))
        for n, t in enumerate(np.asarray(times).tolist())
    )
