"""Spectral moments of every point's stress from matrices of the modal coordinates: no point ever needs a spectrum.

Stress is linear in the modal coordinates q, and a spectral moment is quadratic in stress. So with the moment matrices
``M_p = integral of f**p Re S_qq(f) df`` the moment of a point with stress per unit modal coordinate s is ``s' M_p s``.
Windowed, detrended segments are linear in q as well: the result is what Welch's method finds of the point's own
stress history, to rounding (Braccesi, Cianetti et al. published the idea for modal models, 2005 and later).
"""

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem
from fatigue.life.records.history import ModalHistory
from fatigue.spectrum.pairs import pairs
from fatigue.spectrum.taper import hann, tapered

Real = TypeVar("Real", bound=np.floating)

DIRLIK_ORDERS = (0.0, 1.0, 2.0, 4.0)
FREQUENCY_TOLERANCE = 1e-9  # a bin that rounding puts above the upper limit still counts
NUMBERS_AT_ONCE = 2_000_000  # of samples or spectra, of several segments: 16 MB
CACHED_NUMBERS = 80_000  # in double precision, with as many again beside them
BLOCK_POINTS = 1024  # keeps a block of points and its product with one matrix in the processor's cache


@dataclass(frozen=True, slots=True, eq=False)
class Spectra:
    """Segment spectra of the modal coordinates, scaled to one-sided densities; they are computed when asked for.

    Attributes
    ----------
    history : the record
    starts : first samples of the segments
    window : (length of a segment,) taper
    frequency : (f,) [Hz]
    scale : (f,) from transform to amplitude
    weight : (f,) trapezoid weights: half a bin at both ends [Hz]
    resolution_hz : distance of the bins [Hz]
    upper_hz : upper limit asked for [Hz]
    segment_s : length of a segment [s]
    first_bin : number of the first bin that is kept
    """

    history: ModalHistory
    starts: range
    window: NDArray[np.float64]
    frequency: NDArray[np.float64]
    scale: NDArray[np.float64]
    weight: NDArray[np.float64]
    resolution_hz: float
    upper_hz: float
    segment_s: float
    first_bin: int = 0

    def transforms(self) -> Iterator[NDArray[np.float64]]:
        """Transforms of one segment after the other, (m, 2 f): the real and the imaginary part of each bin.

        The mean over segments of the products of two modes, summed over both parts of a bin, is the real part of their
        one-sided cross-spectral density [unit modal coordinate**2 / Hz]. The imaginary part is antisymmetric and leaves
        no trace in a quadratic form.
        """
        length = len(self.window)
        some = max(1, NUMBERS_AT_ONCE // (self.history.q.shape[0] * self.starts.step))  # read together
        for first in range(0, len(self.starts), some):
            starts = self.starts[first : first + some]
            samples = self.history.q[:, starts[0] : starts[-1] + length]
            for start in starts:
                yield self._transform(samples[:, start - starts[0] : start - starts[0] + length])

    def _transform(self, samples: NDArray[np.floating]) -> NDArray[np.float64]:
        """Transform of one segment, (m, length of a segment), some modes at a time."""
        length, bins = samples.shape[1], len(self.frequency)
        amplitude = np.empty((len(samples), bins), dtype=np.complex128)
        at_once = max(1, CACHED_NUMBERS // length)
        for first in range(0, len(samples), at_once):
            some = slice(first, first + at_once)
            transform = np.fft.rfft(_from_first(samples[some]), axis=1)
            transform[:, 0] = 0.0  # the mean of the segment
            kept = slice(self.first_bin, self.first_bin + bins)
            np.multiply(tapered(transform, length, kept), self.scale, out=amplitude[some])
        return amplitude.view(np.float64)


@dataclass(frozen=True, slots=True, eq=False)
class MomentMatrices:
    """Moment matrices of one event.

    Attributes
    ----------
    orders : (p,) exponent of the frequency
    matrix : (p, m, m) symmetric [unit modal coordinate**2 Hz**p]
    segments : number of segments averaged
    resolution_hz : distance of the bins [Hz]
    upper_hz : upper limit of the spectrum [Hz]
    """

    orders: NDArray[np.float64]
    matrix: NDArray[np.float64]
    segments: int
    resolution_hz: float
    upper_hz: float


def samples_per_segment(step: float, segment_s: float) -> int:
    """Number of samples of a segment, its length rounded."""
    return round(segment_s / step)


def default_upper_hz(step: float, top_mode_hz: float | None) -> float:
    """Upper frequency of the spectra [Hz]: the lower of 0.4 f_s and 1.5 x the highest normal mode, if there is one.

    >>> default_upper_hz(0.004, 40.0), default_upper_hz(0.01, 40.0), default_upper_hz(0.01, None)
    (60.0, 40.0, 40.0)
    """
    return 0.4 / step if top_mode_hz is None else min(0.4 / step, 1.5 * top_mode_hz)


def has_spectrum(history: ModalHistory, segment_s: float) -> bool:
    """Whether the record holds at least one segment of at least four samples."""
    return segment_count(history.q.shape[1], history.step, segment_s) > 0


def segment_count(samples: int, step: float, segment_s: float) -> int:
    """Number of segments in a record of so many samples; 0 where a segment has fewer than four samples."""
    length = samples_per_segment(step, segment_s)
    return len(segment_starts(samples, length)) if length >= 4 else 0


def segment_spectra(history: ModalHistory, segment_s: float, upper_hz: float) -> Spectra:
    """Spectra of segments that overlap by half, of all modal coordinates: own mean removed, periodic Hann window.

    Bins above ``upper_hz`` [Hz] are dropped. The scaling is Welch's (1967), one-sided.

    Raises
    ------
    DataError : the record is shorter than one segment
    """
    if not has_spectrum(history, segment_s):
        raise DataError(
            Problem(
                "short_record",
                f"event {history.event!r}",
                f"{history.duration:g} s of record hold no segment of {segment_s:g} s, so there is no spectrum",
                "shorten segment_s in [spectrum] or record longer",
            )
        )
    length = samples_per_segment(history.step, segment_s)
    frequency = np.arange(length // 2 + 1) / (length * history.step)
    kept = np.count_nonzero(frequency <= upper_hz * (1 + FREQUENCY_TOLERANCE))
    window = hann(length)
    return Spectra(
        history=history,
        starts=segment_starts(history.q.shape[1], length),
        window=window,
        frequency=frequency[:kept],
        scale=_welch_scale(window, history.step)[:kept],
        weight=_trapezoid_weights(frequency[:kept]),
        resolution_hz=1.0 / (length * history.step),
        upper_hz=upper_hz,
        segment_s=length * history.step,
    )


def spectra_above(spectra: Spectra) -> Spectra | None:
    """Spectra of the same segments from the last bin of the band to half the sampling rate; None without a bin there.

    The trapezoids of both add up to the one over all bins: moments of both add up to those of the whole record.
    """
    length, last = len(spectra.window), len(spectra.frequency) - 1
    if last == length // 2:
        return None
    frequency = np.arange(last, length // 2 + 1) / (length * spectra.history.step)
    return replace(
        spectra,
        frequency=frequency,
        scale=_welch_scale(spectra.window, spectra.history.step)[last:],
        weight=_trapezoid_weights(frequency),
        upper_hz=0.5 / spectra.history.step,
        first_bin=last,
    )


def segment_starts(samples: int, length: int) -> range:
    """First samples of the segments that overlap by half."""
    return range(0, samples - length + 1, length - length // 2)


def windowed(samples: NDArray[np.floating], window: NDArray[np.float64]) -> NDArray[np.float64]:
    """One segment of modal coordinates, (m, len(window)), without its mean and tapered.

    The mean goes in double precision: gravity can be a thousand times what is left.
    """
    segment = _from_first(samples)
    segment -= segment.mean(axis=1, keepdims=True)
    segment *= window
    return segment


def _from_first(samples: NDArray[np.floating]) -> NDArray[np.float64]:
    """Samples less the first one of each mode, in double precision: a record at rest has exactly no spectrum."""
    return np.asarray(samples - samples[:, :1].astype(np.float64), dtype=np.float64)


def moment_matrices(spectra: Spectra, orders: Sequence[float] = DIRLIK_ORDERS) -> MomentMatrices:
    """Moment matrices M_p of an event, Eq. 18: integrals of ``f**p Re S_qq`` over the kept bins."""
    return next(moments_by_chunk(spectra, orders, len(spectra.starts)))


def moments_by_chunk(spectra: Spectra, orders: Sequence[float], size: int) -> Iterator[MomentMatrices]:
    """Moment matrices of one chunk after the other, each of ``size`` segments; the last may have fewer."""
    modes, segments = spectra.history.q.shape[0], len(spectra.starts)
    exponents = np.asarray(orders, dtype=np.float64)
    roots = np.repeat(np.sqrt(spectra.weight * spectra.frequency ** exponents[:, None]), 2, axis=1)
    matrix = np.zeros((len(orders), modes, modes))
    for number, parts in enumerate(spectra.transforms()):
        for i, root in enumerate(roots):
            rows = parts * root
            matrix[i] += rows @ rows.T
        done = number % size + 1
        if done == size or number + 1 == segments:
            yield MomentMatrices(
                orders=exponents,
                matrix=matrix / done,
                segments=done,
                resolution_hz=spectra.resolution_hz,
                upper_hz=spectra.upper_hz,
            )
            matrix[:] = 0.0


def cross_densities(spectra: Spectra) -> NDArray[np.float64]:
    """Real parts of the one-sided cross-spectral densities of the modes, (f, m, m) [unit modal coordinate**2 / Hz]."""
    modes = spectra.history.q.shape[0]
    first, second = pairs(modes)
    density = np.empty((len(spectra.frequency), modes, modes))
    density[:, first, second] = density[:, second, first] = pair_densities(spectra)
    return density


def pair_densities(spectra: Spectra) -> NDArray[np.float64]:
    """Real part of the one-sided cross-spectral density of each of the ``pairs`` of modes, (f, pairs)."""
    modes, bins = spectra.history.q.shape[0], len(spectra.frequency)
    upper = np.ravel_multi_index(pairs(modes), (modes, modes))
    density = np.zeros((bins, len(upper)))
    some = max(1, NUMBERS_AT_ONCE // (2 * modes * bins))
    bins_at_once = max(1, CACHED_NUMBERS // modes**2)
    transforms = spectra.transforms()
    while segments := list(itertools.islice(transforms, some)):
        rows = np.empty((bins, 2 * len(segments), modes))
        for i, parts in enumerate(segments):
            rows[:, 2 * i : 2 * i + 2] = parts.reshape(modes, bins, 2).transpose(1, 2, 0)
        for first in range(0, bins, bins_at_once):
            block = rows[first : first + bins_at_once]
            products = block.transpose(0, 2, 1).copy() @ block  # of a copy: the product with itself is slower
            density[first : first + bins_at_once] += products.reshape(len(block), -1).take(upper, axis=1)
    density /= len(spectra.starts)
    return density


def point_moments(modal_stress: NDArray[np.float64], matrices: MomentMatrices) -> NDArray[np.float64]:
    """Spectral moments ``s' M_p s`` of the stress at every point, (p, n) [MPa**2 Hz**p], never negative (Eq. 18).

    ``modal_stress`` is (n, m) [MPa per unit modal coordinate].

    Examples
    --------
    A coordinate of amplitude 3 at 5 Hz and 2 MPa per unit of it: the variance of a stress of amplitude 6 MPa.

    >>> sine = 3.0 * np.sin(2 * np.pi * 5.0 * np.arange(4000) / 200)
    >>> history = ModalHistory("sine", np.array([1]), sine[np.newaxis], 1 / 200, 0.0)
    >>> matrices = moment_matrices(segment_spectra(history, segment_s=2.0, upper_hz=80.0))
    >>> float(point_moments(np.array([[2.0]]), matrices)[0, 0].round(9))
    18.0
    """
    return np.maximum(quadratic_forms(modal_stress, matrices.matrix), 0.0)


def quadratic_forms(modal_stress: NDArray[np.floating], matrices: NDArray[Real]) -> NDArray[Real]:
    """Quadratic forms ``s' M s``, (p, n), of all rows s of ``modal_stress`` (n, m) and all M of ``matrices`` (p, m, m).

    They have the precision of the matrices.

    >>> quadratic_forms(np.array([[1.0, 2.0]]), np.eye(2)[np.newaxis])
    array([[5.]])
    """
    forms = np.empty((len(matrices), len(modal_stress)), dtype=matrices.dtype)
    for first in range(0, len(modal_stress), BLOCK_POINTS):
        block = modal_stress[first : first + BLOCK_POINTS].astype(matrices.dtype, copy=False)
        for row, matrix in zip(forms, matrices, strict=True):
            np.einsum("nm,nm->n", block @ matrix, block, out=row[first : first + BLOCK_POINTS])
    return forms


def _welch_scale(window: NDArray[np.float64], step: float) -> NDArray[np.float64]:
    """Factors from transform to amplitude, whose square is a one-sided density, (length // 2 + 1,)."""
    bins = np.arange(len(window) // 2 + 1)
    one_sided = np.where((bins == 0) | (2 * bins == len(window)), 1.0, 2.0)  # 0 Hz and Nyquist have no mirror image
    return np.asarray(np.sqrt(one_sided * step / np.sum(window**2)))


def _trapezoid_weights(frequency: NDArray[np.float64]) -> NDArray[np.float64]:
    """Weights that make a sum over bins the trapezoid rule."""
    weight = np.zeros_like(frequency)
    width = np.diff(frequency)
    weight[:-1] += 0.5 * width
    weight[1:] += 0.5 * width
    return weight
