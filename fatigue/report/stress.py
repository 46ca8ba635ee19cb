"""Stress histories and spectra of the points shown in detail, recovered from the histories of the modal coordinates."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from fatigue.life.records.history import ModalHistory, mean_and_covariance, stress_chunks, stress_record
from fatigue.spectrum.moments import cross_densities, has_spectrum, segment_spectra

CLOSE_UP_SAMPLES = 75  # before and after an instant of a cycle
ENVELOPE_BINS = 600  # of the whole record
DOMINANT_MODES = 4


@dataclass(frozen=True, slots=True, eq=False)
class EventRecord:
    """One event as every point needs it: modal coordinates, their mean and covariance, and constants beside them.

    The stress factor is applied to the modal stress of a point, and to ``covariance`` already. ``offset`` (m,) is what
    is constant beside the samples of each coordinate.
    """

    history: ModalHistory
    stress_factor: float
    mean: NDArray[np.float64]
    covariance: NDArray[np.float64]
    offset: NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class StressSpectrum:
    """One-sided stress spectrum of one event: frequency [Hz], density [MPa^2/Hz]."""

    event: str
    frequency: NDArray[np.float64]
    density: NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Excerpt:
    """Stress around one or both instants of a cycle: file time [s], structural stress and parts of modes [MPa]."""

    instants: tuple[float, ...]
    time: NDArray[np.float64]
    stress: NDArray[np.float64]
    parts: Mapping[int, NDArray[np.float64]]


@dataclass(frozen=True, slots=True, eq=False)
class Envelope:
    """Smallest and largest structural stress [MPa] in equal spans of one record over file time [s]."""

    event: str
    time: NDArray[np.float64]
    low: NDArray[np.float64]
    high: NDArray[np.float64]


def event_record(
    history: ModalHistory,
    stress_factor: float,
    constants: NDArray[np.float64] | None = None,
    removed: NDArray[np.bool_] | None = None,
) -> EventRecord:
    """Record of an event with its stress factor, and the mean and covariance of its modal coordinates.

    ``constants`` (m,) stand beside the samples, by default 0; of the coordinates ``removed`` (m,) the mean is taken
    off.
    """
    mean, covariance = mean_and_covariance(history.q)
    offset = np.zeros(len(mean)) if constants is None else constants
    if removed is not None:
        offset = offset - np.where(removed, mean, 0.0)
    return EventRecord(history, stress_factor, mean, stress_factor**2 * covariance, offset)


def spectrum(
    record: EventRecord, modal_stress: NDArray[np.float64], segment_s: float, upper_hz: float
) -> StressSpectrum | None:
    """Welch spectrum of the stress of a point, ``modal_stress`` (m,) [MPa]; None for a record below one segment."""
    if not has_spectrum(record.history, segment_s):
        return None
    history = record.history
    stress = replace(history, q=stress_record(record.stress_factor * modal_stress[None], history.q))
    spectra = segment_spectra(stress, segment_s, upper_hz)
    return StressSpectrum(history.event, spectra.frequency, cross_densities(spectra)[:, 0, 0])


def variance_shares(record: EventRecord, modal_stress: NDArray[np.float64]) -> NDArray[np.float64]:
    """Share of each mode in the variance of the stress (m,): ``s_k (C s)_k / s' C s``; shares sum to 1.

    A mode with a negative share relieves the others. All are NaN where nothing varies.
    """
    parts = modal_stress * (record.covariance @ modal_stress)
    total = parts.sum()
    return np.asarray(parts / total if total > 0.0 else np.full_like(parts, np.nan))


def excerpts(
    record: EventRecord, modal_stress: NDArray[np.float64], start_s: float, end_s: float, modes: Sequence[int]
) -> list[Excerpt]:
    """Stress around the two instants of a cycle: one excerpt where they are close, else one at each.

    ``modes`` are the rows of q whose parts of the stress are shown.
    """
    history, factors = record.history, record.stress_factor * modal_stress
    last = history.q.shape[1] - 1
    at = sorted(min(max(round((t - history.start) / history.step), 0), last) for t in (start_s, end_s))
    groups = [at] if at[1] - at[0] <= 2 * CLOSE_UP_SAMPLES else [at[:1], at[1:]]
    found = []
    for group in groups:
        first = max(0, group[0] - CLOSE_UP_SAMPLES)
        q = history.q[:, first : group[-1] + CLOSE_UP_SAMPLES + 1]
        found.append(
            Excerpt(
                instants=tuple(history.start + history.step * i for i in group),
                time=history.start + history.step * (first + np.arange(q.shape[1])),
                stress=factors @ q + factors @ record.offset,
                parts={int(history.mode[k]): factors[k] * (q[k] - record.mean[k]) for k in modes},
            )
        )
    return found


def envelope(record: EventRecord, modal_stress: NDArray[np.float64]) -> Envelope:
    """Extremes of the stress over the whole kept record, in at most ``ENVELOPE_BINS`` spans."""
    history = record.history
    samples = history.q.shape[1]
    starts = np.linspace(0, samples, min(ENVELOPE_BINS, samples), endpoint=False).astype(np.int64)
    low, high = np.full(len(starts), np.inf), np.full(len(starts), -np.inf)
    begin = 0
    for stress in stress_chunks(record.stress_factor * modal_stress, history.q):
        first = int(np.searchsorted(starts, begin, side="right")) - 1  # the span that the chunk begins in
        last = int(np.searchsorted(starts, begin + len(stress)))
        at = np.maximum(starts[first:last] - begin, 0)
        low[first:last] = np.minimum(low[first:last], np.minimum.reduceat(stress, at))
        high[first:last] = np.maximum(high[first:last], np.maximum.reduceat(stress, at))
        begin += len(stress)
    constant = float(record.stress_factor * modal_stress @ record.offset)
    return Envelope(
        event=history.event,
        time=np.asarray(history.start + history.step * starts, dtype=np.float64),
        low=low + constant,
        high=high + constant,
    )


def deviations(record: EventRecord, modal_stress: NDArray[np.float64]) -> NDArray[np.float64]:
    """Standard deviation of the stress at many stations, (n,) [MPa], of their modal stress (n, m)."""
    return np.asarray(np.sqrt(np.maximum(((modal_stress @ record.covariance) * modal_stress).sum(axis=1), 0.0)))
