"""Normal modes of a body, free or held, by Lanczos iteration on its flexibility.

The flexibility of a free body is that of its elastic motions, so that rigid motions are none of its modes. Modes are
sought until enough have settled, and once more in the space that they leave: none may be left there below the limit.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.linalg import eigh

from fatigue.errors import DataError, NumericalError, Problem
from fatigue.flexbody.factor import NOT_POSITIVE, Factor, FreeBody, factored
from fatigue.flexbody.lanczos import most_flexible
from fatigue.flexbody.structure import Basis, Structure

Floats = NDArray[np.float64]
Solve = Callable[[Floats], Floats]

MOST = 1000  # modes of a large body: each takes a vector in memory and a solution with the factors
SMALL = 240  # rows: all modes at once, by dense matrices
DENSE = 3000  # rows: the same where more than a third of all modes are asked for
SETTLED = 1e-10  # accuracy of a flexibility; that of a shape is its root over the gap to the next one
CHECKED = 1e-3  # of one that is only held against a limit
LEFT = 1e-12  # of the largest flexibility: what rounding leaves


def free_modes(body: FreeBody, *, count: int | None = None, upto_hz: float | None = None) -> Basis:
    """Elastic modes of a free body with unit modal mass, the lowest ``count`` or all up to ``upto_hz``.

    The largest component of each is positive, of several alike the first. The same input gives the same bytes.

    Raises
    ------
    DataError : K is not positive on elastic motions
    NumericalError : more modes than are sought
    """
    return _lowest(body.factor.solve, body.structure.M, body.rigid, count, upto_hz)


def held_modes(
    structure: Structure,
    held: NDArray[np.bool_],
    *,
    count: int | None = None,
    upto_hz: float | None = None,
    factor: Factor | None = None,
) -> Basis:
    """Modes with the rows ``held`` (n,) at rest (fixed-interface modes), else as ``free_modes``; shapes are 0 there.

    ``factor`` is that of the stiffness with these rows held, where the caller has it.

    Raises
    ------
    DataError : the rows do not hold the body; and as ``free_modes``
    """
    factor = factored(structure, held) if factor is None else factor
    keep = sparse.diags_array((~held).astype(np.float64))
    M = sparse.csc_array(keep @ structure.M @ keep)
    return _lowest(factor.solve, M, np.zeros((len(held), 0)), count, upto_hz)


def signed(shapes: Floats) -> Floats:
    """Shapes (n, k), each turned so that the first of its components above half the largest is positive."""
    size = np.abs(shapes)
    first = np.argmax(size > 0.5 * size.max(axis=0, initial=0.0), axis=0) if shapes.size else np.zeros(0, np.int64)
    return np.asarray(shapes * np.where(shapes[first, np.arange(shapes.shape[1])] < 0.0, -1.0, 1.0))


@dataclass(slots=True, eq=False)
class _Found:
    """Motions found so far, orthonormal in M, rigid ones first: shapes (n, r + m), M times them, f (m,) [Hz]."""

    M: sparse.csc_array
    shapes: Floats
    M_shapes: Floats
    frequency: Floats

    def add(self, shapes: Floats, frequency: Floats) -> None:
        """Take modes (n, k) in, freed of what was found before, with unit modal mass."""
        shapes = self.without(shapes)
        M_shapes = self.M @ shapes
        mass = np.sqrt(np.einsum("ij,ij->j", shapes, M_shapes))
        self.shapes = np.hstack([self.shapes, shapes / mass])
        self.M_shapes = np.hstack([self.M_shapes, M_shapes / mass])
        self.frequency = np.concatenate([self.frequency, frequency])

    def most_flexible(self) -> float:
        """Largest flexibility 1/w^2 that was found, 0 if none was."""
        return 1.0 / (2.0 * np.pi * float(self.frequency.min(initial=np.inf))) ** 2

    def without(self, shapes: Floats) -> Floats:
        """Shapes orthogonal to all that was found."""
        return np.asarray(shapes - self.shapes @ (self.M_shapes.T @ shapes))

    def balanced(self, loads: Floats) -> Floats:
        """Loads that move nothing of what was found."""
        return np.asarray(loads - self.M_shapes @ (self.shapes.T @ loads))


def _lowest(solve: Solve, M: sparse.csc_array, rigid: Floats, count: int | None, upto_hz: float | None) -> Basis:
    """Lowest modes by flexibility ``solve``, those of ``rigid`` (n, r) left out."""
    if (count is None) == (upto_hz is None):
        raise ValueError("one of count and upto_hz")
    n = M.shape[0]
    found = _Found(M, rigid, np.asarray(M @ rigid), np.zeros(0))
    if n <= SMALL or (n <= DENSE and count is not None and count > n // 3):
        found.add(*_all_modes(lambda loads: found.without(solve(found.balanced(loads))), M))
        return _basis(found, rigid.shape[1], count, upto_hz)
    if count is not None and count > MOST:
        raise NumericalError(_too_many("are asked for", n))

    def enough(flexible: Floats) -> bool:
        if len(flexible) > MOST:
            raise NumericalError(_too_many(f"lie below {upto_hz:g} Hz", n))
        return len(flexible) >= count if count is not None else _beyond(flexible, upto_hz)

    def sought(enough: Callable[[Floats], bool], accuracy: float) -> tuple[Floats, Floats]:
        start = np.random.default_rng(len(found.frequency)).standard_normal(n)
        flexible, shapes = most_flexible(solve, M, (found.shapes, found.M_shapes), start, enough, accuracy)
        return _positive(flexible, shapes, found.most_flexible())

    found.add(*sought(enough, SETTLED))
    while True:  # of modes with one frequency one start finds one, so that others say whether any is left
        limit = upto_hz if upto_hz is not None else _nth(found.frequency, count)
        _, estimate = sought(_any, CHECKED)
        if not estimate.size or estimate[0] > limit * (1.0 + CHECKED):
            return _basis(found, rigid.shape[1], count, upto_hz)
        shapes, frequency = sought(partial(_beyond, limit_hz=limit), SETTLED)
        missed = frequency <= limit
        if not missed.any():
            return _basis(found, rigid.shape[1], count, upto_hz)
        found.add(shapes[:, missed], frequency[missed])


def _too_many(asked: str, n: int) -> Problem:
    what = f"more than {MOST} modes {asked}, and no more are sought in a body of {n} degrees of freedom"
    return Problem("too_many_modes", "modes", what, "Ask for fewer, or up to a lower frequency")


def _any(flexible: Floats) -> bool:
    return len(flexible) > 0


def _beyond(flexible: Floats, limit_hz: float | None) -> bool:
    """Whether a motion above a frequency is among those that have settled."""
    return limit_hz is not None and bool(np.any((2.0 * np.pi * limit_hz) ** 2 * np.abs(flexible) < 1.0))


def _nth(frequency: Floats, count: int | None) -> float:
    """Frequency of the last mode that is wanted, infinite while there are fewer."""
    return float(np.sort(frequency)[count - 1]) if count and len(frequency) >= count else np.inf


def _all_modes(flexibility: Solve, M: sparse.csc_array) -> tuple[Floats, Floats]:
    """Shapes (n, k) and frequencies (k,) [Hz] of all motions that have stiffness and mass, by dense matrices."""
    scale = np.sqrt(M.diagonal())
    heavy = scale > 0.0
    of_mass, V = eigh(M[heavy][:, heavy].toarray() / np.outer(scale[heavy], scale[heavy]))
    V = V[:, of_mass > LEFT * of_mass[-1]] * np.sqrt(of_mass[of_mass > LEFT * of_mass[-1]])
    root = np.zeros((len(scale), V.shape[1]))  # M = root root'
    root[heavy] = scale[heavy, None] * V
    moved = flexibility(root)
    flexible, W = eigh(root.T @ moved)
    kept = np.abs(flexible) > LEFT * np.abs(flexible).max(initial=0.0)
    return _positive(flexible[kept], moved @ W[:, kept], 0.0)


def _positive(flexible: Floats, shapes: Floats, largest: float) -> tuple[Floats, Floats]:
    """Shapes (n, k) and frequencies (k,) [Hz], ascending, of flexibilities 1/w^2.

    What is only rounding, beside the largest of them or the ``largest`` before, is left out.

    Raises
    ------
    DataError : a flexibility is negative
    """
    kept = np.abs(flexible) > LEFT * np.abs(flexible).max(initial=largest)
    flexible, shapes = flexible[kept], shapes[:, kept]
    if (flexible < 0.0).any():
        what = f"the stiffness of a motion is negative, w^2 = {1.0 / flexible.min():g} rad2/s2"
        raise DataError(Problem("not_positive", "K", what, NOT_POSITIVE))
    order = np.argsort(-flexible, kind="stable")
    return shapes[:, order], 1.0 / (2.0 * np.pi * np.sqrt(flexible[order]))


def _basis(found: _Found, rigid: int, count: int | None, upto_hz: float | None) -> Basis:
    """Modes that were asked for, in ascending order."""
    order = np.argsort(found.frequency, kind="stable")
    frequency = found.frequency[order]
    kept = order[frequency <= upto_hz] if upto_hz is not None else order[:count]
    shapes = signed(found.shapes[:, rigid + kept])
    return Basis(shapes, found.frequency[kept], np.ones(kept.size, dtype=np.bool_))
