"""What a record holds above the band of its spectrum, which Dirlik's formula never sees and a count does.

Modes that the upper frequency leaves out, a frequency set too low or noise make stress that is counted and not
estimated. Its share of the variance says little: 1 % of the variance at eight times the frequency makes 15 % of the
damage, as every small cycle on top of a large one makes that one larger. So beside the share of the variance there is a
share of the damage, by Tovo and Benasciutti of the spectrum up to half the sampling rate. On Gaussian records their
ratio of whole to band keeps within 0.8 and 1.25 of the counted one, where the counted one is between 1.1 and 2.
"""

import math

import numpy as np
from numpy.typing import NDArray

from fatigue.quotient import quotient

NEGLIGIBLE = 1e-4  # of the variance, 1 % of the rms: at most 4 % of the damage, yet noise so small may make all peaks


def share_above(band: NDArray[np.float64], above: NDArray[np.float64]) -> NDArray[np.float64]:
    """Share of the variance above the band, (...), from moments (4, ...) of the band and of what lies above it.

    NaN without stress. What is slower than a segment is in neither.

    >>> share_above(np.array([[3.0], [0.0], [0.0], [0.0]]), np.array([[1.0], [0.0], [0.0], [0.0]]))
    array([0.25])
    """
    return quotient(above[0], band[0] + above[0])


def peak_rate(band: NDArray[np.float64], above: NDArray[np.float64]) -> NDArray[np.float64]:
    """Rate of peaks nu_p of the whole record, (...) [1/s], from moments (4, ...) of the band and of what lies above it.

    Less than ``NEGLIGIBLE`` of the variance above the band is left out.
    """
    counts = share_above(band, above) >= NEGLIGIBLE
    m2, m4 = (band[order] + np.where(counts, above[order], 0.0) for order in (2, 3))
    return np.sqrt(quotient(m4, m2))


def missed_damage(damage: NDArray[np.float64], damage_whole: NDArray[np.float64]) -> NDArray[np.float64]:
    """Share of the damage that the band misses, from damages by the spectrum in it and by the whole spectrum.

    >>> missed_damage(np.array([3.0, 0.0]), np.array([4.0, 0.0]))
    array([0.25,  nan])
    """
    return np.clip(1.0 - quotient(damage, damage_whole), 0.0, 1.0)


def in_percent(share: float) -> str:
    """Digits of a share in per cent, such that little is not nothing and nearly all is not everything.

    >>> [in_percent(share) for share in (2e-6, 0.0823, 0.631, 0.99998, 1.0)]
    ['0.0002', '8.2', '63', '99.99', '100']
    """
    return f"{math.floor(1e4 * share) / 100:g}" if share > 0.99 else f"{100 * share:.2g}"
