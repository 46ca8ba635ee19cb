"""Loci of roots: each root followed over speed or conicity, whatever it meets on its way.

From one point of a grid to the next the roots are matched so that the sum of their distances is smallest: how far s
moves, and how little the shapes agree (MAC, weighed by mass). Where a match stays in doubt the step is halved.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from fatigue.vehicle.assembly import LinearVehicle, SuspendedVehicle
from fatigue.vehicle.roots import Root, roots

Floats = NDArray[np.float64]
Complex = NDArray[np.complex128]

DOUBT = 0.3  # distance from which a match is looked at again, half a step at a time
HALVINGS = 5
GONE = 1.5  # distance from which two roots are two: one ends, another begins
REACH = 1.3  # beyond the highest frequency that is shown, so that roots do not end where they leave for a while


@dataclass(frozen=True, slots=True, eq=False)
class Locus:
    """One root over a grid of conicities or speeds: ``s`` (k,) [1/s], NaN where it does not swing or is too fast.

    ``roots`` (k,) are the roots themselves, None there. ``name`` is what it is called most often.
    """

    name: str
    s: Complex
    roots: tuple[Root | None, ...]

    @property
    def frequency_hz(self) -> Floats:
        """``|s|/2 pi`` (k,) [Hz]."""
        return np.asarray(np.abs(self.s) / (2.0 * np.pi))

    @property
    def damping(self) -> Floats:
        """Damping ratio (k,) ``-Re s/|s|``."""
        return np.asarray(-self.s.real / np.abs(self.s))


def loci_over_conicity(
    of: SuspendedVehicle, speed_km_h: float, conicities: Floats, upto_hz: float = 25.0
) -> list[Locus]:
    """Loci of the roots up to a frequency over conicities (k,), ascending or not, at a speed.

    Raises
    ------
    CaseError : no speed, or a conicity that no wheel has
    """
    return followed(lambda conicity: of.at(speed_km_h, conicity), conicities, upto_hz)


def loci_over_speed(of: SuspendedVehicle, conicity: float, speeds_km_h: Floats, upto_hz: float = 25.0) -> list[Locus]:
    """Loci of the roots up to a frequency over speeds (k,) [km/h] at a conicity.

    Raises
    ------
    CaseError : no speed, or a conicity that no wheel has
    """
    return followed(lambda speed: of.at(speed, conicity), speeds_km_h, upto_hz)


def followed(at: Callable[[float], LinearVehicle], grid: Floats, upto_hz: float = 25.0) -> list[Locus]:
    """Loci of the roots up to a frequency over a grid (k,), in ascending order of their first frequency."""
    found: list[list[Root | None]] = []
    open_loci: dict[int, int] = {}  # root at the point before: its locus
    before: list[Root] = []
    for k, value in enumerate(grid):
        vehicle = at(float(value))
        here = roots(vehicle, REACH * upto_hz)
        matched = _matched(at, (float(grid[k - 1]), before), (float(value), here), vehicle.M, HALVINGS) if k else {}
        continued = {to: open_loci[old] for old, to in matched.items()}
        for index, root in enumerate(here):
            if index not in continued:
                continued[index] = len(found)
                found.append([None] * len(grid))
            found[continued[index]][k] = root if root.frequency_hz < upto_hz else None
        before, open_loci = here, continued
    shown = [locus for locus in found if any(root is not None for root in locus)]
    return sorted((_locus(locus) for locus in shown), key=lambda locus: float(np.nanmin(locus.frequency_hz)))


def _locus(found: Sequence[Root | None]) -> Locus:
    names = [root.of.name for root in found if root is not None]
    s = np.array([complex(np.nan, np.nan) if root is None else root.s for root in found])
    return Locus(max(dict.fromkeys(names), key=names.count), s, tuple(found))


def _matched(
    at: Callable[[float], LinearVehicle],
    first: tuple[float, list[Root]],
    last: tuple[float, list[Root]],
    M: Floats,
    halvings: int,
) -> dict[int, int]:
    """Which root of the first point is which of the last; halfway between them is asked where it stays in doubt."""
    apart = distance(first[1], last[1], M)
    pairs = {int(a): int(b) for a, b in zip(*linear_sum_assignment(np.minimum(apart, GONE)), strict=True)}
    worst = max((apart[a, b] for a, b in pairs.items()), default=0.0)
    if halvings and worst > DOUBT:
        middle = 0.5 * (first[0] + last[0])
        half = (middle, roots(at(middle), _highest_hz(first[1], last[1])))
        to_half = _matched(at, first, half, M, halvings - 1)
        from_half = _matched(at, half, last, M, halvings - 1)
        return {a: from_half[b] for a, b in to_half.items() if b in from_half}
    return {a: b for a, b in pairs.items() if apart[a, b] < GONE}


def _highest_hz(*points: list[Root]) -> float:
    return max((root.frequency_hz for roots_of_point in points for root in roots_of_point), default=0.0) * (1 + 1e-9)


def distance(first: list[Root], last: list[Root], M: Floats) -> Floats:
    """How far roots (a,) are from others (b,): ``|s_a - s_b| / (0.1 |s_a + s_b|) + 1 - MAC`` (a, b).

    ``MAC = |q_a* M q_b|^2`` of shapes with ``q* M q = 1``.
    """
    if not first or not last:
        return np.zeros((len(first), len(last)))
    s_a, s_b = (np.array([root.s for root in point]) for point in (first, last))
    q_a, q_b = (np.stack([root.shape for root in point]) for point in (first, last))
    mac = np.abs(q_a.conj() @ M @ q_b.T) ** 2
    moved = np.abs(s_a[:, None] - s_b) / (0.1 * (np.abs(s_a)[:, None] + np.abs(s_b)))
    return np.asarray(moved + 1.0 - mac)
