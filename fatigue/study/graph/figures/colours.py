"""Colours of the loci of a line, and which of them are worth one: those that the line moves."""

import itertools
from collections.abc import Sequence

import numpy as np

from fatigue.report.figures.style import SERIES
from fatigue.study.graph.line import Line
from fatigue.vehicle.stability.loci import Locus

UPTO_HZ = 14.0  # shown: hunting and what it meets
MOVED = 0.02  # of damping, from its least to its greatest along the line
DAMPED = 0.6  # least damping from which a root is of no interest to hunting
COLOURS = (*SERIES[:-1], "#7a4fbf", "#8a3a1c", "#00574b", "#a8005f")
OF_GROUP = {
    "car": "#0072b2",
    "flex": "#56b4e9",
    "conv": "#d55e00",
    "trafo": "#e69f00",
    "bogies": "#009e73",
    "wheelsets": "#cc79a7",
}
WORDS = {
    "car": "car body, rigid",
    "flex": "car body, elastic",
    "conv": "converter",
    "trafo": "transformer",
    "bogies": "bogie frames",
    "wheelsets": "wheelsets",
}


def moved(line: Line, upto_hz: float = UPTO_HZ) -> list[Locus]:
    """Loci that the line moves, the least damped first; as many as there are colours."""
    found = [locus for locus in line.loci if _moves(locus) and np.nanmin(locus.frequency_hz) < upto_hz]
    return sorted(found, key=lambda locus: float(np.nanmin(locus.damping)))[: len(SERIES) - 1]


def palette(lines: Sequence[Line], upto_hz: float = UPTO_HZ) -> dict[str, str]:
    """Colour of every name that a moved locus of some lines has, the same in all figures."""
    names = dict.fromkeys(locus.name for line in lines for locus in moved(line, upto_hz))
    return dict(zip(names, itertools.cycle(COLOURS), strict=False))


def _moves(locus: Locus) -> bool:
    damping = locus.damping[np.isfinite(locus.damping)]
    return damping.size > 1 and bool(np.ptp(damping) > MOVED) and bool(damping.min() < DAMPED)
