"""The scatter of a variance by chance: what a stationary Gaussian process leads to expect from period to period.

The variance of a Gaussian process' variance is a sum of squared autocovariances (Bendat and Piersol, Random Data,
section 8.3), and the autocovariance of a point's stress at each lag is a quadratic form in its modal stress. Most of
the hundreds of lags repeat each other, so a few forms hold nearly all of it.
"""

import numpy as np
from numpy.typing import NDArray

from fatigue.spectrum.moments import Spectra, segment_starts
from fatigue.spectrum.pairs import pairs, weights_of_pairs
from fatigue.spectrum.taper import hann

LONGEST_LAG = 0.4  # of the segment an autocovariance comes from: beyond, its taper leaves too little
NEGLIGIBLE = 0.01  # share of the scatter energy the principal spectra may miss: a few per cent at a single point


def principal_scatter(
    spectra: Spectra, density: NDArray[np.float64], scale: NDArray[np.float64], taper: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Forms H_j with ``sum (s' H_j s)**2`` the variance of a Gaussian process' tapered variance, (r, pairs).

    ``density`` (f, pairs) belongs to the spectra, and is used up; ``s`` is the modal stress times ``scale`` (m,);
    ``taper`` is the weight of each squared sample. The forms are given by their weights of pairs, (r, pairs).

    That variance is ``2 sum over lags of overlap(lag) (s' R(lag) s)**2`` with the autocovariance R of the coordinates
    and the autocorrelation of the taper. The few principal directions of the stack of matrices hold all but
    ``NEGLIGIBLE`` of its energy, the sum of its squared numbers.
    """
    first, second = pairs(len(scale))
    beside_diagonal = np.sqrt(weights_of_pairs(len(scale)))  # each number there stands twice in the energy
    density *= beside_diagonal / (scale[first] * scale[second])
    stack = _lags_of_densities(spectra, taper)  # times the density; as long as it is smaller, it stands alone
    if len(stack) > stack.shape[1]:
        stack = np.asarray(np.linalg.qr(stack, mode="r"))  # the same sums of squares from no more rows than bins
    if len(stack) > density.shape[1]:
        density = np.asarray(np.linalg.qr(stack @ density, mode="r"))  # ... or than pairs
        stack = np.eye(len(density))
    energy, direction = np.linalg.eigh(stack @ (density @ density.T) @ stack.T)
    kept = int(np.searchsorted(np.cumsum(energy), NEGLIGIBLE * energy.sum()))
    return np.asarray(direction[:, kept:].T @ stack @ density * beside_diagonal)


def period_taper(length: int, segments: int) -> NDArray[np.float64]:
    """Weight with which each squared sample enters the variance of a period of some segments; sums to 1."""
    hop = length - length // 2
    taper = np.zeros(length + (segments - 1) * hop)
    for start in segment_starts(len(taper), length):
        taper[start : start + length] += hann(length) ** 2
    return np.asarray(taper / taper.sum())


def _lags_of_densities(spectra: Spectra, taper: NDArray[np.float64]) -> NDArray[np.float64]:
    """Matrix (lags, f) from densities to autocovariances, each times the root of its weight in the sum over lags."""
    window, step = spectra.window, spectra.history.step
    stride = max(1, int(1 / (2.5 * spectra.upper_hz * step)))  # R**2 has twice the bandwidth of the stress
    lag = np.arange(0, min(int(LONGEST_LAG * len(window)), len(taper)), stride)
    both_signs = np.where(lag == 0, 1.0, 2.0)
    overlap = stride * both_signs * _autocorrelation(taper)[lag]
    seen = _autocorrelation(window)[lag] / np.sum(window**2)  # of R, through the taper of the spectrum
    to_lags = np.cos(2 * np.pi * np.outer(lag * step, spectra.frequency)) * spectra.weight
    return np.asarray((np.sqrt(2 * overlap) / seen)[:, None] * to_lags)


def _autocorrelation(x: NDArray[np.float64]) -> NDArray[np.float64]:
    """``sum of x(i) x(i + lag)`` for lags 0 to len(x) - 1."""
    return np.fft.irfft(np.abs(np.fft.rfft(x, 2 * len(x))) ** 2, 2 * len(x))[: len(x)]
