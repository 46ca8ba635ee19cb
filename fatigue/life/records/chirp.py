"""A Fourier sum at equally spaced places of any distance: the chirp transform (Bluestein; Rabiner et al., 1969)."""

import numpy as np
from numpy.typing import NDArray

Complex = NDArray[np.complex128]
Floats = NDArray[np.float64]


def fourier_sum(lines: Complex, first: float, apart: float, samples: int) -> Complex:
    """``sum over k of lines_k exp(2 pi i k (first + apart n))`` for n from 0, (samples,), in the time of three FFT.

    With ``2 k n = k^2 + n^2 - (n - k)^2`` the sum is a convolution with a chirp.

    >>> fourier_sum(np.array([1.0, 2.0]), 0.0, 0.25, 4).round(12).real
    array([ 3.,  1., -1.,  1.])
    """
    k, n = np.arange(lines.size), np.arange(samples)
    length = 1 << (lines.size + samples - 2).bit_length()
    chirp = _unit(0.5 * _turns(apart, np.arange(max(lines.size, samples)) ** 2, 2.0))
    ring = np.zeros(length, dtype=np.complex128)
    ring[:samples] = chirp[:samples].conj()
    if lines.size > 1:
        ring[1 - lines.size :] = chirp[lines.size - 1 : 0 : -1].conj()
    given = np.fft.fft(lines * _unit(_turns(first, k, 1.0)) * chirp[: lines.size], length)
    given *= np.fft.fft(ring)
    return np.asarray(np.fft.ifft(given)[:samples] * chirp[n])


def _turns(factor: float, whole: NDArray[np.int64], modulus: float) -> Floats:
    """Product of a factor with whole numbers below 2^53, modulo 1 or 2, to the last digit.

    Both are split in two (Dekker, 1971), so that each of the four products is exact before its turns are dropped.
    """
    scaled = factor * 134217729.0  # 2^27 + 1
    high = scaled - (scaled - factor)
    upper, lower = whole >> 27, whole & ((1 << 27) - 1)
    found = np.zeros(whole.size)
    for part in (high, factor - high):
        found += np.fmod(part * upper * 2.0**27, modulus) + np.fmod(part * lower, modulus)
    return found


def _unit(turns: Floats) -> Complex:
    return np.asarray(np.exp(2j * np.pi * turns))
