"""How much of the stress at the welds lies above a frequency, in each of two bases.

Displacements agree long before forces near an attachment do, and what disagrees first is what is fast.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.signal import welch

from fatigue.basis.counted import FACES, OpenCase
from fatigue.basis.finding import Finding
from fatigue.basis.two_bases.matched import Match, stress_of
from fatigue.pipeline.mission.event_load import EventLoad

Floats = NDArray[np.float64]

ABOVE_HZ = 20.0  # the band in which two bases of one car body were seen to differ: factors 0.2 to 1.5
HEADING = f"Two bases: stress above {ABOVE_HZ:g} Hz at the worst points"
SEGMENT_S = 2.0
SAMPLES_AT_ONCE = 2_000_000  # of the stress of some points: 16 MB
RECOVERED = (
    "The stress is that of the nodal forces at the weld, recovered from the modes: it converges later than "
    "displacements do, and neither basis is exact near an attachment."
)
NO_EVENT = "the other case has no event of this name"


@dataclass(frozen=True, slots=True)
class ContentRow:
    """One event at the worst point of one weld in both cases; see the columns of ``bases_content``."""

    weld: str
    part: int
    node: int
    order: int
    surface: str
    event: str
    rms_MPa: float  # noqa: N815
    other_rms_MPa: float  # noqa: N815
    rms_above_MPa: float  # noqa: N815
    other_rms_above_MPa: float  # noqa: N815
    ratio_above: float
    reason: str


def content(case: OpenCase, other: OpenCase, matches: Sequence[Match]) -> Finding:
    """Stress of every event at matched points of two cases, whole and above ``ABOVE_HZ``."""
    of_other = {load.counted.event: load for load in other.loads}
    rows = [row for load in case.loads for row in _rows(load, of_other.get(load.counted.event), matches)]
    rows.sort(key=lambda row: row.weld)  # stable: events stay in the order of the case
    return Finding("bases_content", HEADING, tuple(_said(rows)), tuple(rows), (RECOVERED,) if rows else ())


def rms_above(signal: Floats, step: float, above_hz: float = ABOVE_HZ) -> tuple[Floats, Floats]:
    """Root mean square of signals (p, t), their mean removed, and of their part above a frequency (p,) each.

    The part is that of the mean of Hann segments of 2 s, half over each other (Welch 1967), so that the ends of a
    record are no fast motion.
    """
    whole = signal.std(axis=1)
    n = min(signal.shape[1], max(4, round(SEGMENT_S / step)))
    frequency, psd = welch(signal, 1.0 / step, nperseg=n, axis=1)
    above = psd[:, frequency > above_hz].sum(axis=1) * (frequency[1] - frequency[0])
    return whole, np.minimum(np.sqrt(above), whole)


def _rows(load: EventLoad, of_other: EventLoad | None, matches: Sequence[Match]) -> Iterator[ContentRow]:
    """One event at all points."""
    reason = NO_EVENT if of_other is None else _too_slow(load) or _too_slow(of_other)
    if not matches or of_other is None or reason:
        nothing = np.full(len(matches), np.nan)
        values = [(nothing, nothing)] * 2
    else:
        values = [_rms(stress, one) for stress, one in zip(stress_of(matches), (load, of_other), strict=True)]
    (whole, above), (other_whole, other_above) = values
    for i, match in enumerate(matches):
        weld, part, order = match.group.place(match.station)
        ratio = other_above[i] / above[i] if above[i] > 0.0 else np.nan
        yield ContentRow(
            weld, part, int(match.group.node[match.station]), order, FACES[match.face], load.counted.event,
            float(whole[i]), float(other_whole[i]), float(above[i]), float(other_above[i]), float(ratio), reason,
        )  # fmt: skip


def _too_slow(load: EventLoad) -> str:
    """Why a record says nothing about the band; empty where it does."""
    nyquist_hz = 0.5 / (load.counted.step * load.upsample)
    if nyquist_hz <= ABOVE_HZ:
        return f"a record of this event ends at {nyquist_hz:.4g} Hz"
    return "a record of this event has fewer than 8 samples" if load.counted.q.shape[1] < 8 else ""


def _rms(stress: Floats, load: EventLoad) -> tuple[Floats, Floats]:
    """Root mean square of the stress of an event at some points (p, c), whole and above."""
    q, rows = load.counted.q, max(1, SAMPLES_AT_ONCE // load.counted.q.shape[1])
    found = [
        rms_above(load.stress_factor * stress[first : first + rows] @ np.asarray(q[:, :]), load.counted.step)
        for first in range(0, len(stress), rows)
    ]
    return np.concatenate([whole for whole, _ in found]), np.concatenate([above for _, above in found])


def _said(rows: Sequence[ContentRow]) -> Iterator[str]:
    known = [row for row in rows if np.isfinite(row.ratio_above) and row.ratio_above > 0.0]
    if not known:
        return
    low, high = min(known, key=lambda row: row.ratio_above), max(known, key=lambda row: row.ratio_above)
    yield (
        f"Above {ABOVE_HZ:g} Hz the stress in the other case is {low.ratio_above:.3g} ({low.weld}, {low.event}) to "
        f"{high.ratio_above:.3g} ({high.weld}, {high.event}) times that in the first, at the worst points."
    )
