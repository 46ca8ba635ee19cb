"""The lowest modes of a pair K, M, all those up to a frequency or a given number of them."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.linalg import eigh
from scipy.sparse.linalg import ArpackNoConvergence, LinearOperator, eigsh

from fatigue.errors import NumericalError, Problem
from fatigue.flexbody.condensation.factored import number_below

Floats = NDArray[np.float64]

DENSE = 300  # degrees of freedom: below, all modes at once cost less than a few
MASSLESS = 1e-13  # of the largest 1/w^2: a motion without mass, that has no frequency


def lowest(
    K: sparse.csc_array,
    M: sparse.csc_array,
    answer: Callable[[Floats], Floats],
    upto_hz: float | None = None,
    count: int | None = None,
    rigid: int = 0,
) -> tuple[Floats, Floats]:
    """Frequencies (k,) [Hz], ascending, and shapes (n, k) with unit modal mass of ``K phi = w^2 M phi``.

    Parameters
    ----------
    K, M : (n, n) symmetric, K positive but for rigid motions
    answer : static displacement (n,) under forces (n,), that of inertia relief where there are rigid motions; these
        then never come up
    upto_hz, count : the modes wanted: up to a frequency, or so many
    rigid : number of rigid motions of the pair

    Raises
    ------
    NumericalError : the modes do not converge

    Lanczos in shift-invert mode. A repeated frequency may hide from it: up to a frequency, the modes are counted by the
    law of inertia as well.
    """
    n = K.shape[0]
    below = None if upto_hz is None else number_below(K, M, upto_hz)
    wanted = count if count is not None else 16 if below is None else below - rigid
    start = np.random.default_rng(0).standard_normal(n)
    while True:
        tried = max(1, min(wanted if upto_hz is None else wanted + 1, n - 1))
        try:
            w2, shapes = eigsh(K, tried, M, sigma=0.0, OPinv=LinearOperator((n, n), matvec=answer), v0=start)
        except ArpackNoConvergence as error:
            raise NumericalError(
                Problem(
                    "modes_do_not_converge",
                    "finite element model",
                    f"{tried} modes of {n} degrees of freedom do not converge",
                    "look for parts that hang together by next to nothing, or ask for fewer modes",
                )
            ) from error
        order = np.argsort(w2)
        frequency, shapes = np.sqrt(w2[order]) / (2.0 * np.pi), shapes[:, order]
        if upto_hz is None:
            return frequency, shapes
        kept = frequency <= upto_hz
        enough = kept.sum() == wanted if below is not None else not kept.all()
        if enough or tried == n - 1:
            return frequency[kept], shapes[:, kept]
        wanted, below = 2 * tried, None


def all_modes(K: Floats, M: Floats) -> tuple[Floats, Floats]:
    """Frequencies (k,) [Hz], ascending, and shapes (n, k) with unit modal mass of dense K, positive definite, and M.

    Solved as ``M phi = 1/w^2 K phi``: degrees of freedom without mass have no mode, and no harm comes of them.
    """
    flexible, shapes = eigh(M, K)
    has_mass = flexible > MASSLESS * flexible[-1]
    flexible, shapes = flexible[has_mass][::-1], shapes[:, has_mass][:, ::-1]
    return 1.0 / (2.0 * np.pi * np.sqrt(flexible)), shapes / np.sqrt(flexible)


def wanted_of(frequency: Floats, shapes: Floats, upto_hz: float | None, count: int | None) -> tuple[Floats, Floats]:
    """Frequencies and shapes of all modes, cut at a frequency [Hz] or a number."""
    if upto_hz is not None:
        count = int(np.searchsorted(frequency, upto_hz, side="right"))
    return frequency[:count], shapes[:, :count]
