"""Frequency bands of a record that add up to the record exactly, and products taken band by band.

The record is written in an orthonormal basis in time whose members each have one frequency. The sum of products over
samples is then the same sum over coefficients, ``x @ y = X @ Y``. A band is a slice of the coefficients. So the bands
of a product add up to the whole product, and the bands of a record to the record.

A record that recurs is periodic, and its basis is the Fourier basis. A single pass ends elsewhere than it began; the
cosine basis (DCT-II) continues it as its own mirror image, so that the jump does not leak into every band.
"""

import itertools
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from fatigue.life.records.history import Residue

Floats = NDArray[np.float64]

LOWEST_CENTRE_HZ, HIGHEST_CENTRE_HZ = 1.0, 80.0  # nominal one-third octaves a body is felt in


def third_octaves(lowest_hz: float = LOWEST_CENTRE_HZ, highest_hz: float = HIGHEST_CENTRE_HZ) -> Floats:
    """Band edges of one-third octaves, ``10**(n/10) * 10**(+-1/20)`` Hz (IEC 61260-1, base ten).

    The bands run from the one around ``lowest_hz`` to the one around ``highest_hz``; what lies below the first edge and
    above the last one are bands as well, see ``band_slices``.

    >>> third_octaves(1.0, 1.6).round(3)
    array([0.891, 1.122, 1.413, 1.778])
    """
    first, last = round(10.0 * np.log10(lowest_hz)), round(10.0 * np.log10(highest_hz))
    return np.asarray(10.0 ** ((np.arange(first, last + 2) - 0.5) / 10.0))


def coefficients(x: NDArray[np.floating], residue: Residue) -> Floats:
    """Coefficients (..., t) of records (..., t) in the orthonormal basis of a record that recurs, or of a single pass.

    Their frequencies are ``coefficient_frequencies``, ascending.
    """
    if residue == "half":
        from scipy.fft import dct  # noqa: PLC0415 - scipy.fft takes a while to import

        return np.asarray(dct(x.astype(np.float64, copy=False), type=2, norm="ortho"))
    samples = x.shape[-1]
    spectrum = np.fft.rfft(x.astype(np.float64, copy=False), norm="ortho")
    packed = spectrum.view(np.float64)  # Re 0, Im 0, Re 1, Im 1, ...
    packed[..., 2 : samples + 1] *= np.sqrt(2.0)  # cosine and sine of +f and -f; 0 Hz and Nyquist have no mirror image
    if samples % 2 == 0:
        packed[..., samples] /= np.sqrt(2.0)
    packed[..., 1] = packed[..., 0]
    return packed[..., 1 : samples + 1]


def coefficient_frequencies(samples: int, step: float, residue: Residue) -> Floats:
    """Frequency of each of the coefficients, (t,) [Hz], ascending."""
    return frequency_of(np.arange(samples), samples, step, residue)


def frequency_of(index: NDArray[np.int64], samples: int, step: float, residue: Residue) -> Floats:
    """Frequency of some of the coefficients [Hz], given by their places."""
    cycles = index / 2.0 if residue == "half" else (index + 1) // 2
    return np.asarray(cycles / (samples * step))


def band_slices(frequency: Floats, edges: Sequence[float] | Floats) -> list[slice]:
    """Slices of the coefficients below the first edge, between neighbouring edges, and from the last edge on.

    ``frequency`` is ascending [Hz]; a band contains its lower edge. One band more than there are edges; a band between
    two coefficients is empty.
    """
    at = [0, *np.searchsorted(frequency, edges).tolist(), len(frequency)]
    return [slice(a, b) for a, b in itertools.pairwise(at)]


def band_products(x: Floats, y: Floats, bands: Sequence[slice]) -> Floats:
    """Products of all rows of x (n, t) with all rows of y (m, t), coefficient by coefficient, per band: (n, m, b).

    Summed over the bands they are the products of the records, ``x @ y.T``.
    """
    return np.stack([x[:, band] @ y[:, band].T for band in bands], axis=-1)
