"""Why a displacement of the simulation is not mode shapes times modal coordinates: likely causes, tried one by one.

Every cause but a shift in time is another set of weights in sum_k w_k q_k; its misfit follows from products of the
records that are made once. A cause is named where it explains the displacement and no other does as well.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

import numpy as np

from fatigue.readers.convert.displacement.comparison import SHARE, Comparison, best_fit, fitted_factors

Kind = Literal[
    "units",
    "sign",
    "axis",
    "node",
    "mode sign",
    "mode order",
    "numbering",
    "time",
    "derivative",
    "factor",
    "mode factor",
    "fit",
]

EXPLAINED = 0.05
"""Misfit, relative to the rms of the displacement, up to which a cause counts as explaining it."""

_UNITS = {
    1000.0: "metres against millimetres",
    25.4: "inches against millimetres",
    1000.0 / 25.4: "metres against inches",
    10.0: "centimetres against millimetres",
    100.0: "metres against centimetres",
    1000.0**0.5: "modes of unit mass in kilograms against tonnes",
    1000.0**1.5: "metres against millimetres, and kilograms against tonnes",
}
_AXES = "xyz"


@dataclass(frozen=True, slots=True)
class Cause:
    """One cause, and the misfit that is left with it."""

    kind: Kind
    misfit: float
    text: str
    remedy: str


def explain(comparison: Comparison, in_time: list[Cause], base: float) -> tuple[Cause, ...]:
    """Causes that explain a displacement alike: one is an answer, several are none.

    Where a simple cause leaves as little as any other, only simple ones count: every flip of one mode has pairs of
    flips that do as well. A fit of all modes is asked last.

    Parameters
    ----------
    comparison : the records at common instants
    in_time : causes that are no weights of the modes
    base : misfit without any cause; one that does not halve it explains nothing
    """
    limit = min(EXPLAINED, base / 2)
    single = [*_whole(comparison), *_one_flip(comparison), *_numbering(comparison), *in_time]
    double = [*_swaps(comparison), *_flips(comparison), *_factors(comparison)]
    best = min(cause.misfit for cause in (*single, *double))
    if best > limit:
        return tuple(cause for cause in _fit(comparison) if cause.misfit <= limit)
    if min(cause.misfit for cause in single) <= 1.3 * best + 0.002:
        double = []
    about = min(limit, max(2 * best, best + 0.01))
    alike = [cause for cause in (*single, *double) if cause.misfit <= about]
    return tuple(sorted(alike, key=lambda cause: cause.misfit))


def _whole(c: Comparison) -> Iterator[Cause]:
    """Causes that concern all modes alike: direction, sign and units."""
    for axis in range(3):
        weight = c.shape[c.number, axis]
        for factor, units in {1.0: "", **_UNITS, **{1 / f: text for f, text in _UNITS.items()}}.items():
            for sign in (1, -1):
                if axis == c.direction and sign * factor == 1:
                    continue
                said, remedies = [], []
                kind: Kind = "axis" if axis != c.direction else "sign" if sign < 0 else "units"
                if axis != c.direction:
                    said.append(f"the direction is {'-' if sign < 0 else ''}{_AXES[axis]} of the FE model")
                    remedies.append("Name the direction in the basic frame of the FE model")
                elif sign < 0:
                    said.append("the sign of the direction, or of all modes, is opposite")
                    remedies.append(
                        "If the simulation's axis points the other way turn the displacement round, else see which run "
                        "the modes are of"
                    )
                if units:
                    said.append(f"the displacement is {factor:.4g} times the sum: {units}")
                    remedies.append("Correct the units of FE files, coordinates or displacement")
                text, remedy = " and ".join(said), "; ".join(remedies)
                yield Cause(kind, float(c.misfit(sign * factor * weight)), text, remedy)


def _one_flip(c: Comparison) -> Iterator[Cause]:
    for mode, misfit in zip(c.mode.tolist(), c.flipped.tolist(), strict=True):
        yield _flip_cause((mode,), misfit)


def _flip_cause(modes: tuple[int, ...], misfit: float) -> Cause:
    what = f"mode {modes[0]}" if len(modes) == 1 else f"the modes {', '.join(map(str, modes))}"
    return Cause(
        "mode sign",
        misfit,
        f"the sign of {what} is opposite",
        "Take forces, mode shapes and the modes of the simulation from one FE run: each run draws the signs anew",
    )


def _flips(c: Comparison) -> Iterator[Cause]:
    """Opposite signs of two modes, and of all modes that a fit finds opposite."""
    square, left = c.rest
    one = c.weight * left
    size = np.diagonal(c.parts)
    pairs = square + 4 * (one[:, None] + one) + 4 * (size[:, None] + size + 2 * c.parts)
    i, j = np.triu_indices(c.mode.size, 1)
    misfit = c.relative(pairs[i, j])
    for k in np.flatnonzero(misfit <= EXPLAINED):
        yield _flip_cause((int(c.mode[i[k]]), int(c.mode[j[k]])), float(misfit[k]))
    opposite = [k for k, factor in fitted_factors(c) if abs(factor + 1) < 0.2]
    if len(opposite) > 2:
        weight = c.weight.copy()
        weight[opposite] *= -1
        yield _flip_cause(tuple(c.mode[opposite].tolist()), float(c.misfit(weight)))


def _swaps(c: Comparison) -> Iterator[Cause]:
    """Two modes that changed places."""
    square, left = c.rest
    qq = c.products[0]
    size = np.diagonal(qq)
    i, j = np.triu_indices(c.mode.size, 1)
    by = c.weight[j] - c.weight[i]
    misfit = c.relative(square - 2 * by * (left[i] - left[j]) + by**2 * (size[i] + size[j] - 2 * qq[i, j]))
    for k in np.flatnonzero(misfit <= EXPLAINED):
        yield Cause(
            "mode order",
            float(misfit[k]),
            f"the modes {c.mode[i[k]]} and {c.mode[j[k]]} have changed places",
            "Map the columns with --columns or --match frequency",
        )


def _numbering(c: Comparison) -> Iterator[Cause]:
    """Coordinates that belong to modes so many places further on."""
    total = len(c.shape)
    for step in range(1 - total, total):
        to = c.number + step
        inside = (to >= 0) & (to < total)
        if step == 0 or not inside.any():
            continue
        weight = np.where(inside, c.shape[np.clip(to, 0, total - 1), c.direction], 0.0)
        yield Cause(
            "numbering",
            float(c.misfit(weight)),
            f"the coordinates belong to the modes {abs(step)} further {'on' if step > 0 else 'back'} in the FE run",
            "Use --match frequency or order, or map the columns with --columns",
        )


def _factors(c: Comparison) -> Iterator[Cause]:
    """One factor on all modes, or on one of them."""
    qq, qy, _ = c.products
    square, left = c.rest
    summed = float(c.weight @ qq @ c.weight)
    if summed > 0:
        factor = float(c.weight @ qy) / summed
        yield Cause(
            "factor",
            float(c.misfit(factor * c.weight)),
            f"the displacement is {factor:.4g} times the sum",
            "Give the simulation's generalised masses with --simulation-modes, and check the units",
        )
    own = np.diagonal(qq)
    for k in np.flatnonzero(np.diagonal(c.parts) > (SHARE * c.rms) ** 2):
        factor = 1 + float(left[k] / (own[k] * c.weight[k]))
        yield Cause(
            "mode factor",
            float(c.relative(square - left[k] ** 2 / own[k])),
            f"mode {c.mode[k]} takes part with a factor of {round(factor, 3) + 0.0:.3g}",
            "Give the simulation's generalised masses with --simulation-modes; near 0: the simulation lacks the mode",
        )


def _fit(c: Comparison) -> Iterator[Cause]:
    """Modes whose factors a fit of all modes tells apart from 1."""
    if not (off := fitted_factors(c)):
        return
    misfit, _ = best_fit(c)
    some = ", ".join(f"mode {c.mode[k]}: {round(factor, 3) + 0.0:.3g}" for k, factor in off[:10])
    more = f" and {len(off) - 10} more" if len(off) > 10 else ""
    yield Cause(
        "fit",
        misfit,
        f"factors fitted to the modes differ from 1: {some}{more}",
        "Take forces, mode shapes and coordinates from one modal basis",
    )
