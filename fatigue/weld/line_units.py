"""Lengths of weld lines that cannot be mm (refusals), and thicknesses that are hardly mm (warnings).

A wrong unit goes through every formula without a trace: with a plate of 3 mm given as 0.003, stresses are a thousand
times too large, or more, and every weld misses its target. So plates are compared with what is welded at all (sheet of
0.5 mm, extrusions of 1.5 to 40 mm, bogie plates of up to 100 mm), and with the line they stand along: edges of shells
are 0.1 to 20 times as long as the plate is thick, but 100 times and more where the thickness alone is in m.
"""

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import Problem
from fatigue.weld.line import LineStack, line_of_node
from fatigue.weld.line_geometry import edge_nodes, length, lengths

FOIL = 0.015  # [mm] below: household foil, or plates of up to 15 mm in m; sheet of 0.5 mm in inches, 0.02, is above
THIN, EDGE_RATIO = 0.1, 100.0  # [mm], [-] plates of up to 100 mm in m, where also the edges are that many times as long
BLOCK = 500.0  # [mm] five times the thickest plate, and a thousand times the thinnest sheet
USUAL = 0.5, 200.0  # [mm] what lies outside may be right (a coupon of foil, a forged block), or in inches


def unit_problems(lines: LineStack, file: str) -> list[Problem]:
    """Problems of thicknesses and coordinates that cannot be mm; ``file`` holds them, or is its path in the case.

    With a wrong thickness nothing is said about the coordinates, which are judged by it.
    """
    thickness = _too_thin(lines, file) + _too_thick(lines, file)
    return thickness or _coordinates(lines, file)


def unit_warnings(lines: LineStack, file: str) -> list[Problem]:
    """Warnings of thicknesses that few plates have, of lines that ``unit_problems`` lets pass."""
    at = (lines.thickness < USUAL[0]) | (lines.thickness > USUAL[1])
    if not at.any():
        return []
    what = f"thickness_mm is {_first(lines, at):g}, welded plates have {USUAL[0]:g} to {USUAL[1]:g} mm as a rule"
    return [Problem("unusual_thickness", _place(lines, at, file), what, "Check that it is in mm, not in inches or m")]


def _too_thin(lines: LineStack, file: str) -> list[Problem]:
    """Problem of thicknesses in m: nothing is welded so thin, or not along such long edges."""
    thin = lines.thickness <= THIN
    if not thin.any():
        return []
    owner = line_of_node(lines)
    edges_of_line = np.bincount(owner[edge_nodes(lines)[:, 0]], minlength=len(lines))
    edge = (lengths(lines) / edges_of_line)[owner]
    along_mm = thin & (edge > EDGE_RATIO * lines.thickness)
    at = along_mm | (lines.thickness < FOIL)
    if not at.any():
        return []
    first = int(at.argmax())
    columns, look = ("thickness_mm", "this looks") if along_mm[first] else ("thickness_mm and coordinates", "both look")
    return [
        Problem(
            "unit",
            _place(lines, at, file),
            f"thickness_mm is {lines.thickness[first]:g} on edges of {edge[first]:.3g} mm, no plate is welded so thin",
            f"Give {columns} in mm; {look} like m",
        )
    ]


def _too_thick(lines: LineStack, file: str) -> list[Problem]:
    """Problem of thicknesses that a factor of 1000 has come into."""
    at = lines.thickness >= BLOCK
    if not at.any():
        return []
    what = f"thickness_mm is {_first(lines, at):g}, no plate is welded so thick"
    return [Problem("unit", _place(lines, at, file), what, "Give thickness_mm in mm; this looks like micrometres")]


def _coordinates(lines: LineStack, file: str) -> list[Problem]:
    """Problem of coordinates in m: every weld line is shorter than its plate is thick."""
    if any(length(line) >= line.thickness.min() for line in lines):
        return []
    longest = max(lines, key=length)
    return [
        Problem(
            "unit",
            f"{file}: x_mm, y_mm, z_mm",
            f"no weld line is as long as its plate is thick; the longest, of weld {longest.weld}, has "
            f"{length(longest):.3g} mm on a plate of {longest.thickness.min():g} mm",
            "Give coordinates in mm; these look like m",
        )
    ]


def _first(lines: LineStack, at: NDArray[np.bool_]) -> float:
    """First thickness that is marked."""
    return float(lines.thickness[at.argmax()])


def _place(lines: LineStack, at: NDArray[np.bool_], file: str) -> str:
    """Place of the first node that is marked, and how many others."""
    first, others = int(at.argmax()), np.count_nonzero(at) - 1
    weld = lines.weld[line_of_node(lines)[first]]
    place = f"{file}: weld {weld}, node {lines.node[first]} (order {lines.order[first]})"
    return f"{place} and {others} more" if others else place
