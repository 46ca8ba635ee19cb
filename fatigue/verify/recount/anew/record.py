"""The record of an event once more: what is kept, what is counted, how often it happens, and Welch's spectrum."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.verify.recount.inputs.case import RecountInputs, RecountModes
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
    kept : (m, t) modal coordinates after the start-up
    step, start : time step and file time of the first kept sample [s]
    counted : (m, u) the kept record on the grid on which cycles are counted, ``fine_step`` apart [s]
    recurs : whether the record is a block that repeats
    factor : on all stresses
    length_km : distance of one pass, None for an event counted by number
    passes_per_km : of the mission
    peak : (m,) largest absolute value of each coordinate
    """

    name: str
    kept: Floats
    step: float
    start: float
    counted: Floats
    fine_step: float
    recurs: bool
    factor: float
    length_km: float | None
    passes_per_km: float
    peak: Floats

    @property
    def duration(self) -> float:
        """Duration of one pass [s]."""
        return float(self.kept.shape[1] * self.step)


@dataclass(frozen=True, slots=True)
class SpectrumRules:
    """Length of a segment [s] and highest frequency [Hz]."""

    segment_s: float
    upper_hz: float


def spectrum_rules(case: Mapping[str, Any], modes: RecountModes, step: float) -> SpectrumRules:
    """Rules of the case for a record with this time step [s]."""
    asked = case.get("spectrum", {})
    upper = asked.get("upper_hz", min(0.4 / step, 1.5 * modes.highest_normal_hz))
    return SpectrumRules(asked.get("segment_s", 4.0), upper)


def read_record(
    inputs: RecountInputs, event: Mapping[str, Any], modes: RecountModes, fastest: float, recorded: int
) -> RecountRecord:
    """Record of an event without its start-up; ``fastest`` is the highest peak rate of all points [1/s].

    Where there is no spectrum to have it from, the upsampling factor that the provenance has ``recorded`` is believed.
    """
    path = inputs.folder / event["history"]
    time = np.concatenate([piece["time_s"].to_numpy(dtype=float) for piece in read_pieces(path, ["time_s"])])
    samples, step = len(time), float((time[-1] - time[0]) / (len(time) - 1))
    first = int(np.argmax(time - time[0] >= event.get("start_s", 0.0) - step / 2))
    start = float(time[first])
    del time  # as long as a mode
    q = _coordinates(path, modes.mode.tolist(), samples)[:, first:]

    by_number = "per_1000_km" in event
    by_default = "half" if by_number else inputs.case.get("counting", {}).get("residue", "repeat")
    recurs = event.get("residue", by_default) == "repeat"
    upsample = inputs.case.get("counting", {}).get("upsample", "auto")
    if upsample == "auto":
        has_spectrum = 4 <= round(spectrum_rules(inputs.case, modes, step).segment_s / step) <= q.shape[1]
        enough = SAMPLES_PER_PEAK[inputs.case.get("counting", {}).get("reversals", "samples")]
        upsample = _upsample(step, enough * fastest, q.shape[1]) if has_spectrum else recorded
    length = None if by_number else event.get("length_km", event.get("speed_km_h", 0.0) * q.shape[1] * step / 3600)
    return RecountRecord(
        name=event["name"],
        kept=q,
        step=step,
        start=start,
        counted=finer(q, upsample, recurs=recurs),
        fine_step=step / upsample,
        recurs=recurs,
        factor=event.get("stress_factor", 1.0),
        length_km=length,
        passes_per_km=event["per_1000_km"] / 1000 if length is None else event["share"] / length,
        peak=np.maximum(q.max(axis=1), -q.min(axis=1)),
    )


def _coordinates(path: Path, modes: list[int], samples: int) -> Floats:
    """Coordinates (m, t) of a history, piece by piece: a frame of all of them would be as much again."""
    q, first = np.empty((len(modes), samples)), 0
    for piece in read_pieces(path):
        columns = {int(name[2:]): name for name in piece.columns if name.startswith("q_")}
        for row, mode in zip(q, modes, strict=True):
            row[first : first + len(piece)] = piece[columns[mode]].to_numpy(dtype=float)
        first += len(piece)
    return q


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
    if not recurs:
        there_and_back = np.concatenate([q, q[:, -2:0:-1]], axis=1)
        return finer(there_and_back, factor, recurs=True)[:, : (q.shape[1] - 1) * factor + 1]
    n = q.shape[1]
    lines = np.fft.fft(q, axis=1)
    padded = np.zeros((len(q), n * factor), dtype=complex)
    half = (n + 1) // 2
    padded[:, :half] = lines[:, :half]
    padded[:, padded.shape[1] - (n - half) :] = lines[:, half:]
    if n % 2 == 0:  # half the Nyquist line belongs to the positive frequency
        padded[:, -(n // 2)] /= 2
        padded[:, n // 2] = padded[:, -(n // 2)]
    return np.fft.ifft(padded, axis=1).real * factor


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
