"""Springs with dampers between two bodies, or between a body and the rail, as rows of elongation.

An element has a direction d, a stiffness k, a damping c and two points A and B. Its elongation is
``e = u_A.d - u_B.d``, u the displacement of a body at its own point. It stores ``k e^2/2`` and dissipates ``c e'^2``.
With e as a row r over the coordinates, ``e = r q``, it adds ``k r'r`` to K and ``c r'r`` to C.

Where the two points lie apart the force still acts along d at each of them, which leaves a small moment unbalanced.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

X, Y, Z = range(3)


@dataclass(frozen=True, slots=True, eq=False)
class Spring:
    """One element: ``row`` r (n,) and ``rail`` t of ``e = r q - t w``, stiffness k [N/m], damping c [N s/m].

    ``rail`` (s,) is how the signals w of the track move the rail under it; empty where it does not stand on the rail.
    An element that turns has e in rad, k in N m/rad.
    """

    name: str
    row: Floats
    stiffness: float
    damping: float = 0.0
    rail: Floats = field(default_factory=lambda: np.zeros(0))


@dataclass(frozen=True, slots=True, eq=False)
class Maxwell:
    """A damper c [N s/m] behind a spring k [N/m], elongation ``e = r q``.

    Its state d is the elongation of the damper: ``c d' = k (e - d)``, its force ``k (e - d)``.
    """

    name: str
    row: Floats
    stiffness: float
    damping: float


def elongation(direction: int, a: Floats, b: Floats) -> Floats:
    """Row (n,) of ``e = u_A.d - u_B.d`` from the motions (3, n) of two points."""
    return np.asarray(a[direction] - b[direction])


def stacked(springs: Sequence[Spring]) -> Floats:
    """The rows R (m, n) of springs."""
    return np.stack([spring.row for spring in springs])


def stiffness(springs: Sequence[Spring]) -> Floats:
    """``K = sum of k r'r`` (n, n)."""
    R, k = stacked(springs), np.array([spring.stiffness for spring in springs])
    return np.asarray(R.T @ (k[:, None] * R))


def damping(springs: Sequence[Spring]) -> Floats:
    """``C = sum of c r'r`` (n, n)."""
    R, c = stacked(springs), np.array([spring.damping for spring in springs])
    return np.asarray(R.T @ (c[:, None] * R))


def from_rail(springs: Sequence[Spring], signals: int) -> tuple[Floats, Floats]:
    """Forces (n, s) that signals of the track and their rates exert, ``sum of k r't`` and ``sum of c r't``."""
    standing = [spring for spring in springs if spring.rail.size]
    n = springs[0].row.size
    of_value, of_rate = np.zeros((n, signals)), np.zeros((n, signals))
    for spring in standing:
        of_value += spring.stiffness * np.outer(spring.row, spring.rail)
        of_rate += spring.damping * np.outer(spring.row, spring.rail)
    return of_value, of_rate
