"""Shell stresses of one FE run as a file holds them, the same for every solver and file format.

The tensors are in the axes of their elements, at two fibres of the centre and, where the run was asked for them, of the
corners.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import Problem

CENTRE = 0
"""Stands for the id of a node at the centre of an element."""

REQUEST = "Request STRESS(PLOT,CORNER)=ALL, or a set that covers the plates at the stress points, SORT1, REAL"


@dataclass(frozen=True, slots=True, eq=False)
class StressBlock:
    """Stresses of the elements of one kind in one mode or static subcase.

    Attributes
    ----------
    where : place in the file
    subcase, mode : as in the file; mode 0 in a static subcase
    eigenvalue : of the mode, NaN if the block does not state it
    kind : name of the elements ("QUAD4", "TRIA3", ...)
    element : (e,) element ids
    node : (e, p) node of every point, ``CENTRE`` first
    fibre : (e, p, 2) distances of the two fibres from the mid-surface, along the element normal
    stress : (e, p, 2, 3) sx, sy and txy at the fibres, in the element's axes
    """

    where: str
    subcase: int
    mode: int
    eigenvalue: float
    kind: str
    element: NDArray[np.int64]
    node: NDArray[np.int64]
    fibre: NDArray[np.floating]
    stress: NDArray[np.floating]

    @property
    def has_corners(self) -> bool:
        """Whether there are stresses at the corners."""
        return bool(self.node.shape[1] > 1)


@dataclass(frozen=True, slots=True, eq=False)
class ShellStresses:
    """All shell stresses of a file.

    Attributes
    ----------
    source : file
    blocks : of all modes and static subcases of real runs
    unread : why the stresses of an element are not used, by element id
    problems : why blocks are not used
    """

    source: str
    blocks: tuple[StressBlock, ...]
    unread: Mapping[int, str] = field(default_factory=dict)
    problems: tuple[Problem, ...] = ()
