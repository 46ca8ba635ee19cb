"""The bases that a body can be reduced to, and how much of its local flexibility each of them keeps."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import CaseError, DataError, Problem
from fatigue.flexbody.condensation.craig_bampton import craig_bampton
from fatigue.flexbody.condensation.free_interface import free_interface
from fatigue.flexbody.condensation.guyan import guyan
from fatigue.flexbody.condensation.kuhar import kuhar
from fatigue.flexbody.condensation.orthonormal import orthonormal
from fatigue.flexbody.factor import free_body
from fatigue.flexbody.flexibility import flexibility_index
from fatigue.flexbody.structure import Basis, Structure
from fatigue.reduce.interface import InterfacePoint, motion_of
from fatigue.reduce.masters import Masters, masters
from fatigue.stages import stage

Floats = NDArray[np.float64]
Name = Literal["residual", "strong", "weak", "guyan", "kuhar"]

RESIDUAL: Name = "residual"
STRONG, WEAK = "strong", "weak"


@dataclass(frozen=True, slots=True)
class Recipe:
    """How a body is reduced.

    ``cut_hz`` ends the normal or fixed-interface modes, ``keep_hz`` the columns that are kept (None: all), ``kuhar_hz``
    is the frequency that the dynamic condensation is exact at.
    """

    name: Name = RESIDUAL
    cut_hz: float = 60.0
    keep_hz: float | None = None
    kuhar_hz: float | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Reduced:
    """A basis of d loaded directions.

    Attributes
    ----------
    basis : shapes with unit modal mass, without rigid motions
    dropped : columns left out above ``keep_hz``, and their part of the flexibility (d,)
    static : (d,) displacement of each loaded direction under a unit load of its own, with inertia relief [mm/N]
    kept : (d,) part of it that the basis has
    """

    basis: Basis
    dropped: int
    static: Floats
    kept: Floats


def reduce_to(structure: Structure, points: Sequence[InterfacePoint], recipe: Recipe) -> Reduced:
    """Basis of a free body with its loaded points.

    ``residual``: normal modes up to the cut and a residual attachment mode of every loaded direction (Craig and Chang
    1977). ``strong``: Craig-Bampton with the external and internal points as masters, ``weak`` with the external ones
    alone. ``guyan``, ``kuhar``: static or dynamic condensation to the external and internal points.

    Raises
    ------
    CaseError : nothing up to ``keep_hz``
    DataError : no external points for a weak basis, masters that do not hold the body, matrices of no free body
    NumericalError : the iteration for modes found no end, or Kuhar's frequency is one of the held body
    """
    loaded = [point for point in points if point.is_loaded]
    C = motion_of(loaded, structure)
    given = None if recipe.name == RESIDUAL else _masters(structure, loaded, recipe)
    stage("factorising %d degrees of freedom", len(structure.node))
    body = free_body(structure)
    if given is None:
        stage("normal modes up to %g Hz and %d residual attachment modes", recipe.cut_hz, len(C))
        T = free_interface(body, np.ascontiguousarray(C.T), upto_hz=recipe.cut_hz)
    else:
        T = np.asarray(given.B @ _condensed(given, recipe))
    stage("making the basis orthonormal")
    basis = orthonormal(structure, T, recipe.cut_hz).basis
    static = np.einsum("dn,nd->d", C, body.elastic(C.T))
    last = np.inf if recipe.keep_hz is None else recipe.keep_hz
    keep = basis.frequency <= last
    if not keep.any():
        what = f"the lowest frequency of the basis is {basis.frequency.min():.4g} Hz: nothing up to {last:g} Hz is left"
        raise CaseError(Problem("nothing_kept", "--keep-hz", what, "Keep more, or all"))
    kept = Basis(basis.shapes[:, keep], basis.frequency[keep], basis.normal[keep])
    index = flexibility_index(C @ kept.shapes, np.ones(len(kept.frequency)), kept.frequency)
    return Reduced(kept, int(np.count_nonzero(~keep)), static, index / static)


def _masters(structure: Structure, loaded: Sequence[InterfacePoint], recipe: Recipe) -> Masters:
    """Masters of a condensation: the external points of a weak basis, else all that are loaded."""
    external = [point for point in loaded if point.side == "external"]
    if recipe.name == WEAK and not external:
        what = "a weak basis has external points as its masters, and there are none"
        raise DataError(Problem("no_external", "interface", what, "Give the side external to some, or take residual"))
    if recipe.name == WEAK:
        return masters(structure, motion_of(external, structure), "external")
    return masters(structure, motion_of(loaded, structure), "loaded")


def _condensed(given: Masters, recipe: Recipe) -> Floats:
    """Columns (n, k) of a condensation in the coordinates of its masters."""
    number = int(given.rows.sum())
    if recipe.name in (STRONG, WEAK):
        stage("%d constraint modes and fixed-interface modes up to %g Hz", number, recipe.cut_hz)
        return craig_bampton(given.structure, given.rows, upto_hz=recipe.cut_hz)
    if recipe.kuhar_hz is None:
        stage("static condensation to %d degrees of freedom", number)
        return guyan(given.structure, given.rows)
    stage("condensation at %g Hz to %d degrees of freedom", recipe.kuhar_hz, number)
    return kuhar(given.structure, given.rows, recipe.kuhar_hz)
