"""The modal coordinates of one pass in single precision."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from fatigue.life.counting.record import SingleRecord
from fatigue.life.counting.signal import not_finite
from fatigue.life.counting.single.kernels.product import prepared_samples, samples_between, space_for_samples
from fatigue.life.records.history import mean_and_covariance
from fatigue.life.records.spool import Samples, Spool

Floats = NDArray[np.float64]
Singles = NDArray[np.float32]

CHUNK = 4096  # samples recovered at a time, a multiple of ``product.STEP``


def single_record(q: Samples, into: Spool | None = None, known: tuple[Floats, Floats] | None = None) -> SingleRecord:
    """Prepare modal coordinates (m, t) for ``count_single``, once for all points.

    Their copy in single precision is written to ``into`` (m, t), by default to memory. ``known`` are their mean and
    covariance, see ``mean_and_covariance``, where somebody has computed them before.

    Raises
    ------
    NumericalError : a sample is not finite
    """
    modes, t = q.shape
    chunks = [slice(first, min(first + CHUNK, t)) for first in range(0, t, CHUNK)]
    with np.errstate(invalid="ignore"):
        mean, covariance = mean_and_covariance(q) if known is None else known
    if not np.isfinite(np.diagonal(covariance)).all():
        _refuse_not_finite(q, chunks)
    exponent = np.frexp(np.sqrt(np.diagonal(covariance)))[1]
    scale, over_scale = np.ldexp(1.0, exponent), np.ldexp(1.0, -exponent)

    def normalised(chunk: slice) -> Singles:
        centred = q[:, chunk] - mean[:, None]
        centred *= over_scale[:, None]
        return centred.astype(np.float32)

    if into is not None:
        for chunk in chunks:
            into[:, chunk] = normalised(chunk)
        return SingleRecord(into, scale, mean, covariance)
    laid_out = space_for_samples(modes, t, np.float32)
    for chunk in chunks:
        prepared_samples(normalised(chunk), samples_between(laid_out, chunk.start, chunk.stop))
    return SingleRecord(laid_out, scale, mean, covariance)


def _refuse_not_finite(q: Samples, chunks: Sequence[slice]) -> None:
    """Name the first sample that is not finite."""
    for chunk in chunks:
        finite = np.isfinite(q[:, chunk])
        if not finite.all():
            mode, sample = np.argwhere(~finite)[0]
            raise not_finite(f"sample {chunk.start + sample} of modal coordinate {mode}")
