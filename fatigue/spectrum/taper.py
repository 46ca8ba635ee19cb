"""The periodic Hann window, which a spectrum wants (the symmetric one is for filters), on samples or on a transform.

The window ``(1 - cos(2 pi i / n)) / 2`` has three spectral lines. So a bin under the window is half the bin without it,
less a quarter of either neighbour; where few bins are kept this costs less than a product with all samples.
"""

import numpy as np
from numpy.typing import NDArray


def hann(length: int) -> NDArray[np.float64]:
    """Window of so many samples.

    >>> hann(4)
    array([0. , 0.5, 1. , 0.5])
    """
    return 0.5 - 0.5 * np.cos(2 * np.pi * np.arange(length) / length)


def tapered(transform: NDArray[np.complex128], samples: int, bins: slice) -> NDArray[np.complex128]:
    """Transforms of records under the window, (n, bins), from their transforms without it, (n, samples // 2 + 1)."""
    before = transform[:, [1]].conj()  # mirror image: the bin below 0 Hz
    beyond = transform[:, [samples - transform.shape[1]]].conj()  # ... and that above the last one
    inside = transform[:, max(0, bins.start - 1) : bins.stop + 1]
    around = np.concatenate([before, inside, beyond] if bins.start == 0 else [inside, beyond], axis=1)
    width = bins.stop - bins.start
    found = around[:, :width] + around[:, 2 : width + 2]
    found *= -0.5
    found += around[:, 1 : width + 1]
    found *= 0.5
    return np.asarray(found)
