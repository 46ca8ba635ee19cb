"""Spectral moments of every point's stress from matrices of the modal coordinates: no point ever needs a spectrum.

Stress is linear in the modal coordinates q, and a spectral moment is quadratic in stress. So with the moment matrices
``M_p = integral of f**p Re S_qq(f) df`` the moment of a point with stress per unit modal coordinate s is ``s' M_p s``.
Windowed, detrended segments are linear in q as well: the result is that of Welch's method applied to the point's own
stress history, to rounding (Braccesi, Cianetti et al. published the idea for modal models, 2005 and later).
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem
from fatigue.life.history import ModalHistory

Real = TypeVar("Real", bound=np.floating)

DIRLIK_ORDERS = (0.0, 1.0, 2.0, 4.0)
FREQUENCY_TOLERANCE = 1e-9  # a bin that rounding puts above the upper limit still counts
NUMBERS_AT_ONCE = 1_000_000  # of the segment spectra: 16 MB
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

    def part(self, first: int, last: int) -> "Spectra":
        """Take the segments from ``first`` to before ``last``."""
        return replace(self, starts=self.starts[first:last])

    def amplitudes(self) -> Iterator[NDArray[np.complex128]]:
        """Transform some segments after the others, (some, f, m), in bounded memory.

        The mean over segments of ``amplitude[:, :, i].conj() * amplitude[:, :, j]`` is the one-sided cross-spectral
        density of modes i and j [unit modal coordinate**2 / Hz].
        """
        modes, bins, length = self.history.q.shape[0], len(self.frequency), len(self.window)
        some = max(1, NUMBERS_AT_ONCE // (modes * max(bins, self.starts.step // 4)))
        for first in range(0, len(self.starts), some):
            starts = self.starts[first : first + some]
            samples = self.history.q[:, starts[0] : starts[-1] + length]
            amplitude = np.empty((len(starts), bins, modes), dtype=np.complex128)
            for spectrum, start in zip(amplitude, starts, strict=True):
                segment = windowed(samples[:, start - starts[0] : start - starts[0] + length], self.window)
                spectrum[:] = self.scale[:, None] * np.fft.rfft(segment, axis=1).T[:bins]
            yield amplitude


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
    """Round the segment length to samples."""
    return round(segment_s / step)


def has_spectrum(history: ModalHistory, segment_s: float) -> bool:
    """Whether the record holds at least one segment of at least four samples."""
    return segment_count(history.q.shape[1], history.step, segment_s) > 0


def segment_count(samples: int, step: float, segment_s: float) -> int:
    """Count the segments that a record of so many samples holds; 0 where a segment has fewer than four samples."""
    length = samples_per_segment(step, segment_s)
    return len(segment_starts(samples, length)) if length >= 4 else 0


def segment_spectra(history: ModalHistory, segment_s: float, upper_hz: float) -> Spectra:
    """Cut all modal coordinates into segments that overlap by half: own mean removed, periodic Hann window.

    Bins above ``upper_hz`` [Hz] are dropped. The scaling is that of Welch's method (1967), one-sided.

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
    window = hann(length)
    bins = np.arange(length // 2 + 1)
    frequency = bins / (length * history.step)
    kept = np.count_nonzero(frequency <= upper_hz * (1 + FREQUENCY_TOLERANCE))
    one_sided = np.where((bins == 0) | (2 * bins == length), 1.0, 2.0)  # 0 Hz and Nyquist have no mirror image
    return Spectra(
        history=history,
        starts=segment_starts(history.q.shape[1], length),
        window=window,
        frequency=frequency[:kept],
        scale=np.sqrt(one_sided * history.step / np.sum(window**2))[:kept],
        weight=_trapezoid_weights(frequency[:kept]),
        resolution_hz=1.0 / (length * history.step),
        upper_hz=upper_hz,
        segment_s=length * history.step,
    )


def hann(length: int) -> NDArray[np.float64]:
    """Return the periodic Hann window, which a spectrum wants (the symmetric one is for filters)."""
    return 0.5 - 0.5 * np.cos(2 * np.pi * np.arange(length) / length)


def segment_starts(samples: int, length: int) -> range:
    """First samples of the segments that overlap by half."""
    return range(0, samples - length + 1, length - length // 2)


def windowed(samples: NDArray[np.floating], window: NDArray[np.float64]) -> NDArray[np.float64]:
    """Remove the mean of one segment of modal coordinates (m, len(window)) and taper it.

    The mean goes in double precision: gravity can be a thousand times what is left.
    """
    segment = samples.astype(np.float64)
    segment -= segment[:, :1]  # a record at rest then has exactly no spectrum
    segment -= segment.mean(axis=1, keepdims=True)
    segment *= window
    return segment


def moment_matrices(spectra: Spectra, orders: Sequence[float] = DIRLIK_ORDERS) -> MomentMatrices:
    """Integrate the cross-spectra of the modal coordinates, times f**p, over the kept bins."""
    modes, segments = spectra.history.q.shape[0], len(spectra.starts)
    matrix = np.zeros((len(orders), modes, modes))
    for amplitude in spectra.amplitudes():
        parts = _real_parts(amplitude)
        for i, order in enumerate(orders):
            rows = (parts * np.sqrt(spectra.weight * spectra.frequency**order)[:, None]).reshape(-1, modes)
            matrix[i] += rows.T @ rows
    return MomentMatrices(
        orders=np.asarray(orders, dtype=np.float64),
        matrix=matrix / segments,
        segments=segments,
        resolution_hz=spectra.resolution_hz,
        upper_hz=spectra.upper_hz,
    )


def cross_densities(spectra: Spectra) -> NDArray[np.float64]:
    """Real parts of the one-sided cross-spectral densities of the modes, (f, m, m) [unit modal coordinate**2 / Hz]."""
    modes, bins = spectra.history.q.shape[0], len(spectra.frequency)
    density = np.zeros((bins, modes, modes))
    some = max(1, NUMBERS_AT_ONCE // modes**2)
    for amplitude in spectra.amplitudes():
        parts = _real_parts(amplitude)
        for first in range(0, bins, some):
            rows = np.ascontiguousarray(parts[:, first : first + some].transpose(1, 0, 2))
            density[first : first + some] += rows.transpose(0, 2, 1) @ rows
    density /= len(spectra.starts)
    return density


def _real_parts(amplitude: NDArray[np.complex128]) -> NDArray[np.float64]:
    """Real and imaginary parts of segment spectra, one after the other, (2 s, f, m).

    Their products add up to the real part of a cross-spectrum. Its imaginary part is antisymmetric and leaves no trace
    in a quadratic form.
    """
    return np.concatenate([amplitude.real, amplitude.imag])


def point_moments(shapes: NDArray[np.float64], matrices: MomentMatrices) -> NDArray[np.float64]:
    """Spectral moments of the stress at every point.

    ``shapes`` is (n, m), the stress per unit modal coordinate [MPa]; returns (p, n) [MPa**2 Hz**p], never negative.
    """
    return np.maximum(quadratic_forms(shapes, matrices.matrix), 0.0)


def quadratic_forms(shapes: NDArray[np.floating], matrices: NDArray[Real]) -> NDArray[Real]:
    """Evaluate ``s' M s`` for all rows s of ``shapes`` (n, m) and all M of ``matrices`` (p, m, m): (p, n).

    Works in the precision of the matrices.
    """
    forms = np.empty((len(matrices), len(shapes)), dtype=matrices.dtype)
    for first in range(0, len(shapes), BLOCK_POINTS):
        block = shapes[first : first + BLOCK_POINTS].astype(matrices.dtype, copy=False)
        for row, matrix in zip(forms, matrices, strict=True):
            np.einsum("nm,nm->n", block @ matrix, block, out=row[first : first + BLOCK_POINTS])
    return forms


def _trapezoid_weights(frequency: NDArray[np.float64]) -> NDArray[np.float64]:
    """Weights that make a sum over bins the trapezoid rule."""
    weight = np.zeros_like(frequency)
    width = np.diff(frequency)
    weight[:-1] += 0.5 * width
    weight[1:] += 0.5 * width
    return weight
