"""The record of an event once more: what is kept, what is counted, how often it happens, and Welch's spectrum."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.verify.recount.anew.unit_load import between, factor_for, on_grid
from fatigue.verify.recount.inputs.case import RecountInputs
from fatigue.verify.recount.inputs.coordinates import RecountCoordinates
from fatigue.verify.recount.inputs.loads import RecountLoad, loads_of
from fatigue.verify.recount.inputs.tables import read_pieces

Floats = NDArray[np.float64]

SAMPLES_PER_PEAK = {"samples": 20.0, "vertex": 8.0}  # what upsample = "auto" reaches for
LARGEST_UPSAMPLE = 64  # where it ends
FEWEST_SAMPLES = 100  # of a record that is not left as it is then


@dataclass(frozen=True, slots=True, eq=False)
class RecountRecord:
    """One event.

    Attributes
    ----------
    name : of the event
    kept : (c, t) coordinates after the start-up, without what is constant; as fine as the finest unit load
    step, start : time step of these and file time of the first one [s]
    counted : (c, u) the kept record on the grid on which cycles are counted, ``fine_step`` apart [s]
    duration : of one pass [s]
    offset : (c,) constants of unit loads, and the means of modes that are removed, negative
    recurs : whether the record is a block that repeats
    factor : on all stresses
    length_km : distance of one pass, None for an event counted by number
    passes_per_km : of the mission
    peak : (c,) largest absolute value of each coordinate
    vertex : whether reversals are read at the vertices of parabolas through their samples
    has_spectrum : whether the samples are of one time; those of a static load case are not
    """

    name: str
    kept: Floats
    step: float
    start: float
    counted: Floats
    fine_step: float
    duration: float
    offset: Floats
    recurs: bool
    factor: float
    length_km: float | None
    passes_per_km: float
    peak: Floats
    vertex: bool
    has_spectrum: bool


@dataclass(frozen=True, slots=True)
class SpectrumRules:
    """Length of a segment [s] and highest frequency [Hz]."""

    segment_s: float
    upper_hz: float


def spectrum_rules(case: Mapping[str, Any], coordinates: RecountCoordinates, step: float) -> SpectrumRules:
    """Rules of the case for a record with this time step [s]."""
    asked = case.get("spectrum", {})
    upper = asked.get("upper_hz", min(0.4 / step, 1.5 * coordinates.highest_normal_hz))
    return SpectrumRules(asked.get("segment_s", 4.0), upper)


def read_record(
    inputs: RecountInputs, event: Mapping[str, Any], coordinates: RecountCoordinates, fastest: float, recorded: int
) -> RecountRecord:
    """Record of an event without its start-up; ``fastest`` is the highest peak rate of all points [1/s].

    Where there is no spectrum to have it from, the upsampling factor that the provenance has ``recorded`` is believed.
    """
    counting, loads = inputs.case.get("counting", {}), loads_of(inputs, event)
    by_number = "per_1000_km" in event
    recurs = event.get("residue", "half" if by_number else counting.get("residue", "repeat")) == "repeat"
    if "history" in event:
        q, step, start = _history(inputs.folder / event["history"], event.get("start_s", 0.0), coordinates)
        refined, upsample = factor_for(loads, step), counting.get("upsample", "auto")
        if upsample == "auto":
            enough = SAMPLES_PER_PEAK[counting.get("reversals", "samples")]
            segment = round(inputs.case.get("spectrum", {}).get("segment_s", 4.0) * refined / step)
            has_spectrum = 4 <= segment <= q.shape[1] * refined
            upsample = _upsample(step, enough * fastest, q.shape[1]) if has_spectrum else recorded
    else:
        samples = max(len(load.samples) for load in loads if load.samples is not None)
        q, step, start, refined, upsample = np.zeros((len(coordinates), samples)), 1.0, 0.0, 1, 1
    duration, step = q.shape[1] * step, step / refined
    kept, counted = _with_loads(q, loads, start, step, (refined, max(1, upsample // refined)), recurs=recurs)
    is_removed = event.get("mean_of_q", counting.get("mean_of_q", "keep")) == "remove"
    of_modes = kept[: len(coordinates.mode), ::refined]  # at the samples of the file
    offset = np.append(
        -of_modes.mean(axis=1) if is_removed else 0.0 * of_modes[:, 0], [load.constant for load in loads]
    )
    length = None if by_number else event.get("length_km", event.get("speed_km_h", 0.0) * duration / 3600)
    return RecountRecord(
        name=event["name"],
        kept=kept,
        step=step,
        start=start,
        counted=counted,
        fine_step=step / max(1, upsample // refined),
        duration=duration,
        offset=offset,
        recurs=recurs,
        factor=event.get("stress_factor", 1.0),
        length_km=length,
        passes_per_km=event["per_1000_km"] / 1000 if length is None else event["share"] / length,
        peak=np.maximum(counted.max(axis=1), -counted.min(axis=1)),
        vertex=counting.get("reversals", "samples") == "vertex" and "history" in event,
        has_spectrum="history" in event,
    )


def _history(path: Path, start_s: float, coordinates: RecountCoordinates) -> tuple[Floats, float, float]:
    """Modal coordinates of the kept samples with empty rows for unit loads behind them (c, t), their step and start."""
    time = np.concatenate([piece["time_s"].to_numpy(dtype=float) for piece in read_pieces(path, ["time_s"])])
    samples, step = len(time), float((time[-1] - time[0]) / (len(time) - 1))
    first = int(np.argmax(time - time[0] >= start_s - step / 2))
    start = float(time[first])
    del time  # as long as a mode
    q, done = np.zeros((len(coordinates), samples)), 0
    for piece in read_pieces(path):
        columns = {int(name[2:]): name for name in piece.columns if re.fullmatch(r"q_-?\d+", name)}
        for row, mode in zip(q, coordinates.mode.tolist(), strict=False):
            row[done : done + len(piece)] = piece[columns[mode]].to_numpy(dtype=float)
        done += len(piece)
    return q[:, first:], step, start


def _with_loads(
    q: Floats, loads: Sequence[RecountLoad], start: float, step: float, factors: tuple[int, int], *, recurs: bool
) -> tuple[Floats, Floats]:
    """Kept coordinates on the grid ``step`` [s] that the loads ask for, and those that are counted.

    ``factors`` tell how much finer these are than the file, and those of the kept ones. Samples of a load at the
    instants of the file stand in its row as if it were a mode.
    """
    file_step, modes, samples = step * factors[0], len(q) - len(loads), q.shape[1]
    others = []
    for row, load in enumerate(loads, start=modes):
        own = None if load.samples is None else on_grid(load, start, file_step, samples)
        if own is not None:
            q[row] = own
        if load.times is not None and (load.is_linear or own is None):
            others.append((row, load))
    period = samples * file_step if recurs else None

    def finer_by(factor: int, x: Floats, its_step: float) -> Floats:
        fine = finer(x, factor, recurs=recurs)
        for row, load in others:
            fine[row] = between(load, start, its_step / factor, fine.shape[1], period)
        return fine

    kept = finer_by(factors[0], q, file_step)
    return kept, kept if factors[1] == 1 else finer_by(factors[1], kept, step)


def _upsample(step: float, samples_per_s: float, samples: int) -> int:
    """Power of 2 that gives the fastest point its samples per peak; 1 for load cases, which no signal is made of."""
    factor = 1
    while samples >= FEWEST_SAMPLES and factor / step < samples_per_s and factor < LARGEST_UPSAMPLE:
        factor *= 2
    return factor


def finer(q: Floats, factor: int, *, recurs: bool) -> Floats:
    """Fourier interpolation of each row; a single pass is interpolated by its mirror extension."""
    if factor == 1:
        return q
    kept = q.shape[1]
    fine = np.empty((len(q), kept * factor if recurs else (kept - 1) * factor + 1))
    for row, x in zip(fine, q, strict=True):  # transforms of all of them would take some times the record
        row[:] = _finer_row(x if recurs else np.append(x, x[-2:0:-1]), factor)[: len(row)]
    return fine


def _finer_row(x: Floats, factor: int) -> Floats:
    """Samples that repeat, on a grid so many times finer."""
    n = len(x)
    lines = np.zeros(n * factor // 2 + 1, dtype=complex)
    lines[: n // 2 + 1] = np.fft.rfft(x)
    if n % 2 == 0:  # half the Nyquist line belongs to the negative frequency
        lines[n // 2] /= 2
    return np.fft.irfft(lines, n * factor) * factor


def welch_moments(stress: Floats, step: float, rules: SpectrumRules) -> tuple[Floats, Floats] | None:
    """Spectral moments 0, 1, 2, 4 of a stress history by Welch's method; None for a record below one segment.

    First those up to the upper frequency, then those up to half the sampling rate.

    Segments overlap by half, lose their own mean and are tapered by a periodic Hann window; the trapezoid rule
    integrates the one-sided density.
    """
    n = round(rules.segment_s / step)
    if not 4 <= n <= len(stress):
        return None
    window = np.sin(np.pi * np.arange(n) / n) ** 2
    density = np.zeros(n // 2 + 1)
    starts = range(0, len(stress) - n + 1, n - n // 2)
    for start in starts:
        segment = stress[start : start + n]
        density += np.abs(np.fft.rfft((segment - segment.mean()) * window)) ** 2
    density *= 2 * step / (window @ window) / len(starts)
    density[0] /= 2
    if n % 2 == 0:
        density[-1] /= 2
    f = np.arange(n // 2 + 1) / (n * step)
    used = f <= rules.upper_hz * (1 + 1e-9)
    band, whole = (
        np.array([np.trapezoid(f[some] ** p * density[some], f[some]) for p in (0, 1, 2, 4)])
        for some in (used, slice(None))
    )
    return band, whole
