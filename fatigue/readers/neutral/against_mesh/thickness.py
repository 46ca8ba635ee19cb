"""Whether the thickness of weld lines is that of a shell they touch."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from fatigue.readers.neutral.against_mesh.findings import Finding, one_factor, unit_of, warnings_of
from fatigue.readers.neutral.against_mesh.shells import TouchingShells
from fatigue.weld.line import LineStack, line_of_node

Floats = NDArray[np.float64]

ROUNDED = 1e-3  # relative: as somebody may write a thickness down


def other_thickness(
    lines: LineStack, shells: TouchingShells, confirmed: Mapping[str, Sequence[float]], file: str, elements_file: str
) -> list[Finding]:
    """Warning of each weld whose thickness no shell at the node has, nor the mean of two, and nobody has confirmed.

    A node between two shells of one plate side has the mean of both in converted tables. ``confirmed`` are thicknesses
    by weld [mm].
    """
    at, shell = shells.pairs(lines.node)
    has_one = np.isfinite(shells.thickness[shell])
    at, shell = at[has_one], shell[has_one]
    given, there = lines.thickness[at], shells.thickness[shell]
    away = np.full(lines.node.size, np.inf)
    np.minimum.at(away, at, np.abs(np.log(given / there)))
    known = np.isfinite(away)
    wrong = known & (away > ROUNDED)
    begin = np.searchsorted(at, np.arange(lines.node.size + 1))
    weld = line_of_node(lines)
    for i in np.flatnonzero(wrong).tolist():
        own = there[begin[i] : begin[i + 1]]
        means = (own[:, np.newaxis] + own) / 2
        agreed = np.concatenate([means.ravel(), confirmed.get(lines.weld[weld[i]], ())])
        wrong[i] = not np.any(np.abs(lines.thickness[i] - agreed) <= ROUNDED * agreed)

    def words(worst: int, nodes: NDArray[np.int64]) -> tuple[str, str]:
        own = np.unique(there[begin[worst] : begin[worst + 1]])
        element = shells.element[shell[begin[worst]]]
        times = _times(lines.thickness[nodes], [there[begin[i] : begin[i + 1]] for i in nodes.tolist()], elements_file)
        several = " and ".join(f"{t:g}" for t in own[:3].tolist()) + (" and others" if own.size > 3 else "")
        what = (
            f"thickness_mm is {lines.thickness[worst]:g}, and {several} in {elements_file} where shells touch the node "
            f"(element {element}){times}"
        )
        return what, "Correct one of them, or confirm the thickness in the weld register"

    return warnings_of(lines, wrong, np.where(known, away, 0.0), "other_thickness", words, file)


def _times(given: Floats, there: Sequence[Floats], elements_file: str) -> str:
    """Say how many times as thick all nodes at fault are, where shells of one thickness touch each, or a unit fits."""
    thinnest, thickest = (np.array([extreme(own) for own in there]) for extreme in (np.min, np.max))
    for own in (thinnest, thickest):
        factor = one_factor(given / own)
        unit = "" if factor is None else unit_of(factor, "thickness_mm", elements_file)
        if factor is not None and (unit or np.array_equal(thinnest, thickest)):
            return f", {factor:.4g} times as much{unit}"
    return ""
