"""Corners of a weld line whose nodal forces come summed over both legs: what is read there, and why no bound exists.

At a corner the traction has one value f- at the end of one leg and another, f+, at the beginning of the next, in
different directions. Only the sum of the nodal forces of both legs is known there. With the inner nodes eliminated, the
equations of the two legs leave ``s- f- + s+ f+ = G`` with known weights s > 0 (l / (2 sqrt 3) on a long leg of even
edges l) and a known vector G: one equation for two vectors. Any ``f- + s+ d``, ``f+ - s- d`` fits it, whatever the
vector d, with loads along the legs that alternate and decay by 0.268 from node to node. So the sums bound neither of
the two, and the single value that is solved for, G / (s- + s+), is their mean. Where both legs carry the same stress
across them, that mean has cos(turn / 2) of it; the nodes beside the corner then read 0.134 (1 - cos turn) too much.
Element forces, summed leg by leg, have no such gap.
"""

from collections.abc import Sequence

import numpy as np

from fatigue.errors import Problem
from fatigue.weld.line import LineStack, line_of_node
from fatigue.weld.line_geometry import KINK_LIMIT, corners, kink_angles

NAMED = 3  # corners of a weld, the sharpest first

REMEDY = "Give element_forces with weld_elements instead of nodal_forces: they are summed leg by leg"


def corner_share(turn: float) -> float:
    """Share of a stress, the same on both legs, that is read at a corner at which the line turns by so much [deg]."""
    return float(np.cos(np.radians(turn) / 2))


def summed_corners(lines: LineStack, slopes: Sequence[float], file: str) -> list[Problem]:
    """Warning of each line with corners, of lines whose nodal forces are summed over both legs; the sharpest first.

    Parameters
    ----------
    slopes : of the S-N curve of each line, by which a stress makes a life [-]
    file : holds the lines
    """
    at = np.flatnonzero(corners(lines))
    angle = kink_angles(lines).round(3)
    number, first = np.unique(line_of_node(lines)[at], return_index=True)
    found = []
    for i, corner in zip(number.tolist(), np.split(at, first[1:]), strict=False):  # without corners there is one piece
        sharpest = corner[np.argsort(-angle[corner], kind="stable")]
        turn, node = angle[sharpest].tolist(), lines.node[sharpest].tolist()
        found.append((turn[0], _problem(lines.weld[i], node, turn, slopes[i], file)))
    return [problem for _, problem in sorted(found, key=lambda one: -one[0])]


def _problem(weld: str, node: Sequence[int], turn: Sequence[float], slope: float, file: str) -> Problem:
    """Warning of one line with its corners, the sharpest first."""
    named = ", ".join(f"{n} ({t:.0f} degrees)" for n, t in zip(node[:NAMED], turn[:NAMED], strict=True))
    more = f" and {len(node) - NAMED} more" if len(node) > NAMED else ""
    share = corner_share(turn[0])
    return Problem(
        "summed_corner",
        f"{file}: weld {weld}, node {named}{more}",
        f"the line turns by more than {KINK_LIMIT:g} degrees where its nodal forces are summed over both legs: stress "
        f"that is equal in both is read as {share:.2g} of it (life x {share**-slope:.3g}), and the sum sets no bound",
        REMEDY,
    )
