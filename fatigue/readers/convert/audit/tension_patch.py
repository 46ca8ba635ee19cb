"""One shell in tension: a run of a second that shows with which sign a solver writes its grid point forces."""

import numpy as np

from fatigue.errors import DataError, Problem
from fatigue.readers.foreign.fe.results import FeResults
from fatigue.readers.neutral.forces.convention import Convention

LOAD_N = 100.0
_LOADED = (2, 3)

DECK = """\
SOL 101
CEND
TITLE = One-element tension patch
GPFORCE(PLOT) = ALL
SPC = 1
LOAD = 1
BEGIN BULK
PARAM,POST,-1
GRID,1,,0.,0.,0.
GRID,2,,10.,0.,0.
GRID,3,,10.,10.,0.
GRID,4,,0.,10.,0.
CQUAD4,1,1,1,2,3,4
PSHELL,1,1,1.,1,,1
MAT1,1,70000.,,.3
SPC1,1,123456,1
SPC1,1,13456,4
SPC1,1,3456,2,3
FORCE,1,2,,50.,1.,0.,0.
FORCE,1,3,,50.,1.,0.,0.
ENDDATA
"""
"""A plate of 10 x 10 x 1 mm, pulled in x by 50 N at each of the grids 2 and 3."""


def convention_of(patch: FeResults) -> Convention:
    """Read the sign convention off the results of the deck: on the element, the pulled grids carry +100 N together.

    Raises
    ------
    DataError : the forces of element 1 at the pulled grids are not 100 N of either sign
    """
    rows = (patch.element == 1) & patch.of_element & np.isin(patch.node, _LOADED)
    total = float(patch.force[0, rows, 0].sum())
    if int(rows.sum()) != len(_LOADED) or abs(abs(total) - LOAD_N) > 1e-3 * LOAD_N:
        raise DataError(
            Problem(
                "tension_patch",
                patch.source,
                f"element 1 carries {total:g} N at the pulled grids, not +100 or -100 N",
                "Run the tension patch as it is and give its grid point forces",
            )
        )
    return "on_element" if total > 0 else "on_node"
