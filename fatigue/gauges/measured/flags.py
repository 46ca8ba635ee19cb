"""Flags of one measured channel on its raw samples: missing, stuck, clipped, spike, drift; nothing is repaired.

A flag says what a sample looks like, not what it is: a spike may be the largest real cycle of a ride.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import median_filter

Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]

FEWEST_STUCK = 5  # samples
STUCK_S = 0.05
FULL_SCALE_SHARE = 0.999
SPIKE_TIMES = 15.0  # the robust scale of the distances from the running median
NORMAL_MAD = 1.4826  # standard deviation over median absolute deviation of a Gaussian variable
BLOCK_S = 10.0  # of the medians that drift is told by
DRIFT_SHARE = 0.25  # of the span of the channel about its block medians


@dataclass(frozen=True, slots=True)
class Drift:
    """Range of the medians of blocks, and span of the channel about them from its 1st to its 99th percentile."""

    range: float
    span: float

    @property
    def is_flagged(self) -> bool:
        """Whether the medians wander over more than ``DRIFT_SHARE`` of the span; never of fewer than two blocks."""
        return self.range > DRIFT_SHARE * self.span


@dataclass(frozen=True, slots=True, eq=False)
class Flags:
    """What is wrong with the samples of a channel; masks are (t,), and a sample may have several.

    Attributes
    ----------
    missing : not finite
    stuck : in a run of equal samples
    clipped : at full scale
    spike : far from the median of its neighbours
    distance : (t,) of each sample from that median, NaN where a neighbour is missing
    drift : of the channel as a whole, which cuts nothing
    """

    missing: Mask
    stuck: Mask
    clipped: Mask
    spike: Mask
    distance: Floats
    drift: Drift

    @property
    def cut(self) -> Mask:
        """Samples that are flagged, and cut the record."""
        return np.asarray(self.missing | self.stuck | self.clipped | self.spike)

    @property
    def masks(self) -> dict[str, Mask]:
        """Flags of samples by name, in the order in which they are looked for."""
        return {"missing": self.missing, "stuck": self.stuck, "clipped": self.clipped, "spike": self.spike}


def flags_of(x: Floats, rate_hz: float, full_scale: float | None = None) -> Flags:
    """Flags of the raw samples ``x`` (t,) of a channel, in its own unit, as ``full_scale`` is (measured_data 2.1)."""
    missing = ~np.isfinite(x)
    stuck = stuck_samples(x, max(FEWEST_STUCK, round(STUCK_S * rate_hz)))
    clipped = np.zeros_like(missing)
    if full_scale is not None:
        clipped = np.abs(np.where(missing, 0.0, x)) >= FULL_SCALE_SHARE * full_scale
    distance = median_distance(x)
    return Flags(missing, stuck, clipped, spikes(distance) & ~stuck, distance, drift_of(x, rate_hz))


def stuck_samples(x: Floats, shortest: int) -> Mask:
    """Samples (t,) in runs of at least ``shortest`` equal finite ones.

    >>> stuck_samples(np.array([1.0, 2.0, 2.0, 2.0, 3.0]), 3).tolist()
    [False, True, True, True, False]
    """
    found = np.zeros(len(x), dtype=np.bool_)
    same = np.append(x[1:] == x[:-1], False)
    for first, last in runs(same):
        if last - first + 2 >= shortest:
            found[first : last + 2] = True
    return found


def median_distance(x: Floats) -> Floats:
    """``|x_i - median(x_(i-2) .. x_(i+2))|`` of each sample (t,); NaN where one of the five is missing or not there."""
    distance = np.full(len(x), np.nan)
    if len(x) < 5:
        return distance
    finite = np.isfinite(x)
    held = np.where(finite, x, 0.0)
    whole = np.lib.stride_tricks.sliding_window_view(finite, 5).all(axis=1)
    inner = np.abs(held - median_filter(held, size=5))[2:-2]
    distance[2:-2] = np.where(whole, inner, np.nan)
    return distance


def spikes(distance: Floats) -> Mask:
    """Samples further from their running median than ``SPIKE_TIMES`` the robust scale of the positive distances."""
    positive = distance[distance > 0.0]
    if not positive.size:
        return np.zeros(len(distance), dtype=np.bool_)
    return np.asarray(distance > SPIKE_TIMES * NORMAL_MAD * np.median(positive))


def drift_of(x: Floats, rate_hz: float) -> Drift:
    """Drift of a channel: medians of its full blocks of ``BLOCK_S``, and its span less these medians.

    A block without a finite sample is passed over; a channel shorter than two blocks has no drift.
    """
    length = round(BLOCK_S * rate_hz)
    blocks = x[: len(x) // length * length].reshape(-1, length) if length else np.zeros((0, 1))
    blocks = np.where(np.isfinite(blocks), blocks, np.nan)
    blocks = blocks[~np.isnan(blocks).all(axis=1)]
    if len(blocks) < 2:
        return Drift(0.0, 0.0)
    medians = np.nanmedian(blocks, axis=1)
    low, high = np.nanpercentile(blocks - medians[:, None], [1.0, 99.0])
    return Drift(float(np.ptp(medians)), float(high - low))


def runs(mask: Mask) -> list[tuple[int, int]]:
    """First and last index of every run of marked samples.

    >>> runs(np.array([True, False, True, True]))
    [(0, 0), (2, 3)]
    """
    edges = np.flatnonzero(np.diff(np.concatenate([[0], mask.astype(np.int8), [0]])))
    return [(int(first), int(end) - 1) for first, end in edges.reshape(-1, 2)]
