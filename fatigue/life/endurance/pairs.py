"""The worst pair of some stress states at each point: every pair is a cycle, with the R of its own two stresses.

Components of one pair belong to the same two states. So a combination of their utilisations is taken pair by pair,

    A = u_perp^2 + u_par^2 - kappa_i u_perp u_par + u_shear^2,

u_perp and u_par with the sign of their stress of larger magnitude, the largest of all coefficients kappa_i given.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from fatigue.compiled import compiled
from fatigue.life.endurance.haigh import COMPONENTS, EnduranceLine, utilisation

Floats = NDArray[np.float64]

MORE = 1.0 + 1e-12  # by which a later pair has to exceed the worst one so far: equal pairs differ by rounding


@dataclass(frozen=True, slots=True, eq=False)
class LineTable:
    """Some endurance lines, one at most of each component, as compiled loops take them.

    The points of component c are ``begin[c]`` to ``begin[c + 1]`` of ``kappa`` and ``amplitude``; none: not looked at.
    """

    begin: NDArray[np.int64]
    kappa: Floats
    amplitude: Floats

    @classmethod
    def of(cls, lines: Sequence[EnduranceLine]) -> Self:
        """Table of some lines."""
        of_component = {line.component: line for line in lines}
        some = [of_component[one] for one in COMPONENTS if one in of_component]
        rows = [len(of_component[one].kappa) if one in of_component else 0 for one in COMPONENTS]
        return cls(
            begin=np.concatenate([[0], np.cumsum(rows)]),
            kappa=np.concatenate([np.zeros(0), *(line.kappa for line in some)]),
            amplitude=np.concatenate([np.zeros(0), *(line.amplitude for line in some)]),
        )


@dataclass(frozen=True, slots=True, eq=False)
class WorstPairs:
    """The pair of states with the largest combination at each of n points.

    Attributes
    ----------
    value : (n,) the combination A
    pair : (n, 2) the two states
    inside : (n,) whether the lines have it; where not, ``value`` is an upper bound
    """

    value: Floats
    pair: NDArray[np.int64]
    inside: NDArray[np.bool_]


def worst_pairs(states: Floats, lines: Sequence[EnduranceLine], coefficients: Sequence[float] = ()) -> WorstPairs:
    """Worst pair of the states (n, s, 3) of n points, components as in ``COMPONENTS``, s at least 2.

    ``coefficients`` are the kappa_i, none of them above 2; without any the product is left out. A line alone gives the
    square of its utilisation.
    """
    table = LineTable.of(lines)
    found = WorstPairs(
        np.zeros(len(states)), np.zeros((len(states), 2), dtype=np.int64), np.ones(len(states), dtype=np.bool_)
    )
    kappa_i = np.array([*coefficients], dtype=np.float64)
    own = np.ascontiguousarray(states, dtype=np.float64)
    _search(own, table.begin, table.kappa, table.amplitude, kappa_i, found.value, found.pair, found.inside)
    return found


def signed_utilisations(one: Floats, other: Floats, lines: Sequence[EnduranceLine]) -> Floats:
    """Utilisations (n, 3) of pairs of states (n, 3), with the sign of the stress of larger magnitude; 0 without line.

    Above the last point of a line it is an upper bound.
    """
    table, u = LineTable.of(lines), np.zeros((len(one), 3))
    for point in range(len(one)):
        pair_utilisations(one[point], other[point], table.begin, table.kappa, table.amplitude, u[point])
    return u


def plane_range(states: Floats) -> Floats:
    """Largest distance (n,) of two states (n, s, 2) in a plane."""
    largest = np.zeros(len(states))
    for i in range(1, states.shape[1]):
        away = states[:, i:] - states[:, i - 1 : i]
        largest = np.maximum(largest, np.hypot(away[..., 0], away[..., 1]).max(axis=1, initial=0.0))
    return largest


@compiled()
def pair_utilisations(
    one: Floats, other: Floats, begin: NDArray[np.int64], kappa: Floats, amplitude: Floats, u: Floats
) -> bool:
    """Write the signed utilisations (3,) of a pair of states, and return whether the lines have all of them."""
    inside = True
    for c in range(3):
        u[c] = 0.0
        rows = slice(begin[c], begin[c + 1])
        if begin[c + 1] > begin[c]:
            low, high = min(one[c], other[c]), max(one[c], other[c])
            sign = 1.0
            if -low > high:
                sign = -1.0
                if c == 2:
                    low, high = -high, -low
            found, has_it = utilisation(low, high, kappa[rows], amplitude[rows])
            u[c] = sign * found
            inside = inside and has_it
    return inside


@compiled()
def combination(u: Floats, coefficients: Floats, inside: bool) -> float:
    """Combination A of signed utilisations (3,); an upper bound where one of them is not inside its line.

    There the product may only add: A is convex in each utilisation, which lies between 0 and its bound.
    """
    product: float = 0.0
    for i in range(len(coefficients)):
        of_this = -coefficients[i] * u[0] * u[1]
        if i == 0 or of_this > product:
            product = of_this
    if not inside:
        product = max(product, 0.0)
    return float(u[0] ** 2 + u[1] ** 2 + u[2] ** 2 + product)


@compiled()
def _search(
    states: Floats,
    begin: NDArray[np.int64],
    kappa: Floats,
    amplitude: Floats,
    coefficients: Floats,
    value: Floats,
    pair: NDArray[np.int64],
    inside: NDArray[np.bool_],
) -> None:
    """Write value, pair and inside of the worst pair at every point."""
    u = np.empty(3)
    for point in range(len(states)):
        some = states[point]
        pair[point, 1] = 1
        for i in range(len(some)):
            for j in range(i + 1, len(some)):
                has_all = pair_utilisations(some[i], some[j], begin, kappa, amplitude, u)
                A = combination(u, coefficients, has_all)
                if MORE * value[point] < A:
                    value[point], inside[point] = A, has_all
                    pair[point, 0], pair[point, 1] = i, j
