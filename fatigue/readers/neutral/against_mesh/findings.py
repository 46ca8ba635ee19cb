"""What contradicts the mesh, as warnings: one for each weld, its worst node named, the worst weld first."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import Problem
from fatigue.weld.line import LineStack, line_of_node

Words = Callable[[int, NDArray[np.int64]], tuple[str, str]]
"""What is found, and what to do, of the worst node of a weld and all its nodes at fault, by their positions."""

SAME_FACTOR = 5e-3  # relative: factors so near to each other are one
UNITS = {1e-3: "m", 1e-2: "dm", 0.1: "cm", 1 / 25.4: "inches", 1 / 304.8: "feet"}
"""Units of a length, by the factor that a number in it has to the same in mm."""


@dataclass(frozen=True, slots=True)
class Finding:
    """A warning and how bad it is, in a measure that warnings of its code share."""

    severity: float
    problem: Problem


def warnings_of(
    lines: LineStack, wrong: NDArray[np.bool_], bad: NDArray[np.float64], code: str, words: Words, file: str
) -> list[Finding]:
    """One warning for each line with wrong nodes, (n,); ``bad``, (n,), says how wrong each is."""
    at = np.flatnonzero(wrong)
    line, first = np.unique(line_of_node(lines)[at], return_index=True)
    found = []
    for number, nodes in zip(line.tolist(), np.split(at, first[1:]), strict=False):
        worst = int(nodes[bad[nodes].argmax()])
        what, remedy = words(worst, nodes)
        more = f" and {nodes.size - 1} more" if nodes.size > 1 else ""
        where = f"{file}: weld {lines.weld[number]}, node {lines.node[worst]} (order {lines.order[worst]}){more}"
        found.append(Finding(float(bad[worst]), Problem(code, where, what, remedy)))
    return found


def worst_first(found: Iterable[Finding]) -> list[Problem]:
    """Warnings by their code, in the order in which the codes come first, of each code the worst first."""
    kinds: dict[str, list[Finding]] = {}
    for finding in found:
        kinds.setdefault(finding.problem.code, []).append(finding)
    return [one.problem for some in kinds.values() for one in sorted(some, key=lambda finding: -finding.severity)]


def one_factor(factor: NDArray[np.float64]) -> float | None:
    """The factor that all of these are, within ``SAME_FACTOR``; None where they differ."""
    middle = float(np.median(factor))
    return middle if factor.size and np.all(np.abs(factor - middle) <= SAME_FACTOR * abs(middle)) else None


def unit_of(factor: float, table: str, mesh: str) -> str:
    """Say which of two tables looks like which unit, numbers in the first being ``factor`` times those in the other."""
    for in_mm, unit in UNITS.items():
        if abs(factor / in_mm - 1) <= SAME_FACTOR:
            return f"; {table} looks like {unit}"
        if abs(factor * in_mm - 1) <= SAME_FACTOR:
            return f"; {mesh} looks like {unit}"
    return ""
