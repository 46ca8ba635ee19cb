"""Why Dirlik and rainflow differ, split in two: what the formula does wrong, and what is not Gaussian or stationary.

A surrogate is a stationary Gaussian record with all the cross-spectra of the real one. Counted by rainflow it gives the
damage D_s, and the ratio splits exactly: ``D_dirlik / D_rainflow = (D_dirlik / D_s) (D_s / D_rainflow) = A B``. A is
the error of the formula (and of the band limit), B the error of taking the record for stationary and Gaussian. A ratio
near 1 can hide A and B that cancel.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from fatigue.life.records.history import ModalHistory
from fatigue.spectrum.moments import samples_per_segment, segment_starts, windowed
from fatigue.spectrum.taper import hann

MOST_SEGMENTS = 64  # that one surrogate draws on
LONGEST = 16  # segments; a longer surrogate tells no more than several


@dataclass(frozen=True, slots=True, eq=False)
class RatioSplit:
    """Dirlik over rainflow, split; every array is (n,).

    Attributes
    ----------
    formula : A, Dirlik over the mean rainflow damage of the surrogates
    process : B, that mean over the rainflow damage of the record
    standard_error : of ln A and of ln B, from the scatter of the surrogates
    """

    formula: NDArray[np.float64]
    process: NDArray[np.float64]
    standard_error: NDArray[np.float64]


def gaussian_surrogate(history: ModalHistory, segment_s: float, rng: np.random.Generator) -> ModalHistory:
    """Stationary Gaussian record with the spectra and cross-spectra of ``history``, as long or 16 segments.

    Each line of its spectrum is a sum of the spectra of the tapered segments at that frequency, each times a complex
    normal number of its own: that keeps all cross-spectra without ever factorising them.
    """
    length = samples_per_segment(history.step, segment_s)
    window = hann(length)
    samples = min(history.q.shape[1], LONGEST * length)
    starts = np.asarray(segment_starts(history.q.shape[1], length))
    drawn = rng.permutation(starts)[:MOST_SEGMENTS]
    spectrum = np.zeros((history.q.shape[0], samples // 2 + 1), dtype=np.complex128)
    for start in drawn:
        normal = rng.standard_normal((2, spectrum.shape[1]))
        segment = windowed(history.q[:, start : start + length], window)
        spectrum += (normal[0] + 1j * normal[1]) * np.fft.rfft(segment, samples)
    # Half a unit of variance in each part of a line and a mirror image of it: sqrt(1/2) for the complex normal number.
    spectrum *= np.sqrt(0.5 * samples / (len(drawn) * np.sum(window**2)))
    spectrum[:, 0] = 0.0
    return replace(history, q=np.fft.irfft(spectrum, samples))


def ratio_split(
    history: ModalHistory,
    damage_rate: Callable[[ModalHistory], NDArray[np.float64]],
    *,
    dirlik_rate: NDArray[np.float64],
    rainflow_rate: NDArray[np.float64],
    segment_s: float,
    surrogates: int = 8,
    seed: int = 1985,
) -> RatioSplit:
    """Dirlik over rainflow split at some points; the same seed gives the same split.

    ``damage_rate`` counts a record at these points: (n,) damage per second [1/s], the unit of ``dirlik_rate`` and
    ``rainflow_rate`` too.
    """
    rng = np.random.default_rng(seed)
    rates = np.stack([damage_rate(gaussian_surrogate(history, segment_s, rng)) for _ in range(surrogates)])
    mean = rates.mean(axis=0)
    with np.errstate(divide="ignore", invalid="ignore"):  # no damage, no ratio
        return RatioSplit(
            formula=dirlik_rate / mean,
            process=mean / rainflow_rate,
            standard_error=rates.std(axis=0, ddof=1) / mean / np.sqrt(surrogates),
        )


def explained_share(split: RatioSplit, factors: NDArray[np.float64]) -> NDArray[np.float64]:
    """Share of ln B, (n,), that known effects explain.

    ``factors`` (n,) is the factor of modulation on the damage times the factor of tones.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(-np.log(factors) / np.log(split.process))
