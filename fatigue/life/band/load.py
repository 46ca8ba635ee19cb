"""Scatter of the damage from one record to the next, from the pieces of a single one.

A record of an event is cut into ``PIECES`` pieces of equal length. Neighbours are alike, a slow swing of the track or
of the vehicle lasts for several of them, so that blocks of ``BLOCK`` pieces are what is drawn: circular moving blocks,
each beginning at another piece. What a bootstrap of 6 such blocks would scatter by has a closed form: no random
numbers.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtri, stdtrit

Floats = NDArray[np.float64]

PIECES = 30
BLOCK = 5  # pieces
BLOCKS = PIECES // BLOCK  # independent ones
CONFIDENCE = 0.90  # of the band of load, two-sided


@dataclass(frozen=True, slots=True, eq=False)
class LoadScatter:
    """Relative standard error of a damage, and the degrees of freedom it was found with; arrays of one shape."""

    se: Floats
    dof: Floats

    @property
    def log_half_width(self) -> Floats:
        """Half of the width of the 90 % band of ln(damage): t se, t of Student for these degrees of freedom."""
        return np.asarray(stdtrit(self.dof, 0.5 * (1.0 + CONFIDENCE)) * self.se)

    @property
    def sigma_ln(self) -> Floats:
        """se_t: the standard deviation of a normal ln(damage) with the same 90 % band."""
        return np.asarray(self.log_half_width / ndtri(0.5 * (1.0 + CONFIDENCE)))


def block_error(pieces: Floats, block: int = BLOCK) -> Floats:
    """Relative standard error of the sum of pieces (..., B) by circular moving blocks, ``B / block`` of them drawn.

    ``se^2 = (B / b) var(C) / d^2``, C_j the sums of b pieces from the j-th on (Kuensch, 1989; Politis and Romano, 1992:
    circular), d the sum of all; 0 where nothing damages. As a small sample it is too small: see ``record_error``.

    >>> float(block_error(np.array([3.0, 1, 2, 8, 7, 2, 1, 4, 12, 3, 2, 3]), block=2).round(6))
    0.239357
    """
    total = pieces.sum(axis=-1, keepdims=True)
    share = np.divide(pieces, total, out=np.zeros_like(pieces), where=total > 0.0)  # whose squares are no overflow
    blocks = np.sum([np.roll(share, -shift, axis=-1) for shift in range(block)], axis=0)
    return np.asarray(np.sqrt(pieces.shape[-1] / block * blocks.var(axis=-1)))


def record_error(pieces: Floats) -> Floats:
    """Relative standard error of the damage of one record by its pieces (..., PIECES).

    That of 6 blocks, whose variance about their own mean is 5 / 6 of what it is about the true one: ``x sqrt(6 / 5)``.
    """
    return np.asarray(block_error(pieces) * np.sqrt(BLOCKS / (BLOCKS - 1.0)))


def mission_scatter(share: Floats, se: Floats) -> LoadScatter:
    """Scatter of the damage of a mission from that of its events, records that know nothing of each other.

    ``se^2 = sum (share_e se_e)^2``, with degrees of freedom by Welch (1947) and Satterthwaite (1946) from those of each
    record, one less than its blocks; as many where nothing scatters.

    Parameters
    ----------
    share, se : (e, ...) share of each event of the damage, and the relative standard error of its record
    """
    variance = (share * se) ** 2
    total, quartic = variance.sum(axis=0), np.sum(variance**2, axis=0) / (BLOCKS - 1.0)
    dof = np.divide(total**2, quartic, out=np.full_like(total, BLOCKS - 1.0), where=quartic > 0.0)
    return LoadScatter(np.sqrt(total), dof)
