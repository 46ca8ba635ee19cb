"""Normal modes of a body, free or held, by Lanczos iteration on its flexibility.

The flexibility of a free body is that of its elastic motions, so that rigid motions are none of its modes. Modes are
sought in batches, each in the space that those before it leave; the last one says that none is left below the limit.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.linalg import eigh
from scipy.sparse.linalg import ArpackError, LinearOperator, eigsh

from fatigue.errors import DataError, NumericalError, Problem
from fatigue.flexbody.factor import Factor, FreeBody, factored
from fatigue.flexbody.structure import Basis, Structure

Floats = NDArray[np.float64]
Solve = Callable[[Floats], Floats]

SMALL = 240  # rows: all modes at once, by dense matrices
FIRST = 24  # modes of the first batch where a frequency is asked for
CHECKED = 1e-3  # accuracy of an eigenvalue that is only held against a limit
LEFT = 1e-12  # of the largest flexibility: what rounding leaves


def free_modes(body: FreeBody, *, count: int | None = None, upto_hz: float | None = None) -> Basis:
    """Elastic modes of a free body with unit modal mass, the lowest ``count`` or all up to ``upto_hz``.

    The largest component of each is positive, of several alike the first. The same input gives the same bytes.

    Raises
    ------
    DataError : K is not positive on elastic motions
    NumericalError : the iteration found no end
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
    found = _Found(M, rigid, M @ rigid, np.zeros(0))
    n = M.shape[0]

    def flexibility(loads: Floats) -> Floats:
        return found.without(solve(found.balanced(loads)))

    while True:
        limit = _limit(found.frequency, count, upto_hz)
        if limit is None:
            wanted = _still_wanted(found.frequency, count, upto_hz)
            if n <= SMALL or wanted > n // 3:
                found.add(*_all_modes(flexibility, M))
                break
            shapes, frequency = _batch(flexibility, M, wanted, len(found.frequency), 0.0)
            found.add(shapes, frequency)
            if len(frequency) < wanted:
                break
        else:
            _, estimate = _batch(flexibility, M, 1, len(found.frequency), CHECKED)
            if not estimate.size or estimate[0] > limit * (1.0 + CHECKED):
                break
            shapes, frequency = _batch(flexibility, M, 1, len(found.frequency), 0.0)
            if not frequency.size or frequency[0] > limit:
                break
            found.add(shapes, frequency)
    return _basis(found, rigid.shape[1], count, upto_hz)


def _limit(frequency: Floats, count: int | None, upto_hz: float | None) -> float | None:
    """Frequency below which no mode may be left; None while too few are found to tell."""
    if upto_hz is not None:
        return upto_hz if frequency.max(initial=0.0) > upto_hz else None
    return float(np.sort(frequency)[count - 1]) if count and len(frequency) >= count else None


def _still_wanted(frequency: Floats, count: int | None, upto_hz: float | None) -> int:
    """Modes of the next batch; the number of modes of plates grows with the frequency."""
    if count is not None:
        return count - len(frequency)
    if not frequency.size or upto_hz is None:
        return FIRST
    expected = len(frequency) * min(upto_hz / frequency.max(), 3.0)
    return max(int(1.1 * expected) - len(frequency), 0) + 4


def _batch(flexibility: Solve, M: sparse.csc_array, wanted: int, found: int, accuracy: float) -> tuple[Floats, Floats]:
    """Shapes (n, k) and frequencies (k,) [Hz] of the most flexible motions, k at most ``wanted``."""
    n = M.shape[0]
    inverse = LinearOperator((n, n), matvec=flexibility, dtype=np.float64)
    start = flexibility(M @ np.random.default_rng(found).standard_normal(n))
    try:  # in this mode of ARPACK the first matrix only says how large the problem is
        w2, shapes = eigsh(M, wanted, M=M, sigma=0.0, OPinv=inverse, v0=start, tol=accuracy)
    except ArpackError as error:
        what = f"the iteration for {wanted} modes did not end ({error})"
        remedy = "Ask for fewer modes, and look for masses many orders apart"
        raise NumericalError(Problem("no_convergence", "modes", what, remedy)) from None
    return _positive(shapes, w2)


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
    return _positive(moved @ W[:, kept], 1.0 / flexible[kept])


def _positive(shapes: Floats, w2: Floats) -> tuple[Floats, Floats]:
    """Shapes and frequencies [Hz] in ascending order; what is only rounding is left out.

    Raises
    ------
    DataError : an eigenvalue is negative
    """
    size = np.abs(w2)
    kept = size < size.min(initial=np.inf) / LEFT
    order = np.argsort(w2[kept], kind="stable")
    w2, shapes = w2[kept][order], shapes[:, kept][:, order]
    if w2.size and w2[0] < 0.0:
        what = f"the stiffness of a motion is negative, w^2 = {w2[0]:g} rad2/s2"
        raise DataError(
            Problem("not_positive", "K", what, "Export K without geometric stiffness, and M of the same run")
        )
    return shapes, np.sqrt(w2) / (2.0 * np.pi)


def _basis(found: _Found, rigid: int, count: int | None, upto_hz: float | None) -> Basis:
    """Modes that were asked for, in ascending order."""
    order = np.argsort(found.frequency, kind="stable")
    frequency = found.frequency[order]
    kept = order[frequency <= upto_hz] if upto_hz is not None else order[:count]
    shapes = signed(found.shapes[:, rigid + kept])
    return Basis(shapes, found.frequency[kept], np.ones(kept.size, dtype=np.bool_))
