"""How far normal stress and shear can move together in one record, without a history of either.

In the plane of (s, sqrt(beta) tau) the stress of a point runs along a path. With Cauchy-Schwarz over its n steps the
length is

    Lambda = sum sqrt(ds^2 + beta dtau^2) <= sqrt(n (w_s' G w_s + beta w_tau' G w_tau)),    G = sum dq dq',

w the stresses per unit modal coordinate; a record that recurs steps from its last sample to its first one, too. In the
principal axes V of the coordinates ``w'q = sum over k of (V'w)_k (V'q)_k``, so no shear ranges further than

    D(tau) <= sum over k of |V'w_tau|_k range((V'q)_k),

nor further than its own path is long, and in a record that recurs half of that. What it ranges at least is seen at the
few instants at which a principal coordinate is at its extremes.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.life.bounds.forms import FormPair, face_forms, form_pair
from fatigue.life.bounds.screening import ROUNDING
from fatigue.life.records.history import Residue, cached_chunks
from fatigue.life.records.spool import Samples

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class PathExtent:
    """How far and how much the modal coordinates of one record move; see ``path_extent``.

    Attributes
    ----------
    products : sum of dq dq' over the steps, beside the covariance
    axes : (m, m) principal axes V, the deviations of the coordinates in them
    ranges : (m,) range of every principal coordinate
    extremes : (m, e) the coordinates at the instants at which a principal one is largest or smallest
    steps : how many there are; as many as samples where the record recurs
    recurs : whether it does
    """

    products: FormPair
    axes: Floats
    ranges: Floats
    extremes: Floats
    steps: int
    recurs: bool


@dataclass(frozen=True, slots=True, eq=False)
class PathLimits:
    """Upper bounds of the path of n points with two faces, arrays (n, 2) [MPa].

    ``length`` of the path in the plane, and ``shear_range``.
    """

    length: Floats
    shear_range: Floats


def path_extent(q: Samples, residue: Residue, covariance: Floats) -> PathExtent:
    """Prepare the bounds of all paths of a record of modal coordinates (m, t), once per event.

    ``covariance`` (m, m) gives the principal axes; any will do, of the coordinates themselves the bounds are closest.
    """
    modes, samples = q.shape
    deviation = np.sqrt(np.diagonal(covariance))
    deviation = np.where(deviation > 0.0, deviation, 1.0)
    _, directions = np.linalg.eigh(covariance / np.outer(deviation, deviation))
    principal = directions.T / deviation

    recurs = residue == "repeat"
    before = samples - 1 if recurs else 0
    last = q[:, before : before + 1].astype(np.float64)
    products = np.zeros((modes, modes))
    ends = np.stack([np.full(modes, -np.inf), np.full(modes, np.inf)])  # of each principal coordinate
    there = np.zeros((2, modes, modes))  # the coordinates at these ends
    for chunk in cached_chunks(q):
        x = np.concatenate([last, chunk], axis=1)
        last = x[:, -1:].copy()
        step = np.diff(x, axis=1)
        products += step @ step.T
        y = principal @ x
        for end, at, beyond in ((0, y.argmax(axis=1), np.greater), (1, y.argmin(axis=1), np.less)):
            values = y[np.arange(modes), at]
            further = beyond(values, ends[end])
            ends[end, further] = values[further]
            there[end][:, further] = x[:, at[further]]
    return PathExtent(
        products=form_pair(covariance, products),
        axes=deviation[:, None] * directions,
        ranges=ends[0] - ends[1],
        extremes=np.concatenate(list(there), axis=1),
        steps=samples if recurs else samples - 1,
        recurs=recurs,
    )


def path_limits(
    normal: tuple[Floats, Floats], shear: tuple[Floats, Floats], beta: float, extent: PathExtent
) -> PathLimits:
    """Bound the paths of n points at both faces; beta weighs the square of the shear.

    ``normal`` and ``shear`` are each the mean and the part that changes its sign from the top to the bottom face, both
    (n, m) [MPa per unit modal coordinate].
    """
    of_normal, of_shear = (_of_steps(mean, gradient, extent) for mean, gradient in (normal, shear))
    shear_length = np.sqrt(extent.steps * of_shear) * (0.5 if extent.recurs else 1.0)
    mean, gradient = (w @ extent.axes for w in shear)
    in_axes = np.stack([np.abs(mean + gradient) @ extent.ranges, np.abs(mean - gradient) @ extent.ranges], axis=1)
    return PathLimits(
        length=np.sqrt(extent.steps * (of_normal + beta * of_shear)) * (1.0 + ROUNDING),
        shear_range=np.minimum(in_axes, shear_length) * (1.0 + ROUNDING),
    )


def least_range(shear: Floats, extent: PathExtent) -> Floats:
    """What shear stresses (k, m) [MPa per unit modal coordinate] range at least, (k,) [MPa]."""
    return np.asarray(np.ptp(shear @ extent.extremes, axis=1) * (1.0 - ROUNDING))


def _of_steps(mean: Floats, gradient: Floats, extent: PathExtent) -> Floats:
    """``w' G w`` of both faces (n, 2), raised by its largest rounding error."""
    pair = extent.products
    size = (np.abs(mean) + np.abs(gradient)) @ pair.size
    return np.asarray(face_forms(mean, gradient, pair)[1] + pair.rounding[1] * size[:, None] ** 2)
