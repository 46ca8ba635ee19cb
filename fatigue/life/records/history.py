"""One event of the multibody simulation: its modal coordinates over time."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from fatigue.life.records.long_interpolation import interpolate_long
from fatigue.life.records.spool import Samples, Spool, SpoolWriter, create_spool, time_slices

CACHED_NUMBERS = 125_000  # in double precision: 1 MB
SHORTEST_CHUNK = 64  # samples
LONG_NUMBERS = 4_000_000  # of a record on disk that is diagnosed there: in double precision 32 MB, some times over
LONGEST_TRANSFORM = 1_000_000  # samples of a record on disk whose transforms are made in memory: 56 MB

Residue = Literal["repeat", "half"]


@dataclass(frozen=True, slots=True, eq=False)
class ModalHistory:
    """Modal coordinates of one event on a uniform time grid.

    Attributes
    ----------
    event : name of the event
    mode : (m,) mode ids
    q : (m, t) modal coordinates, time contiguous [unit modal coordinate]; a long record is on disk
    step : time step [s]
    start : file time of the first sample [s]
    """

    event: str
    mode: NDArray[np.int64]
    q: Samples
    step: float
    start: float

    @property
    def duration(self) -> float:
        """Duration of the pass [s]: samples times step, because a block that repeats has no last instant."""
        return float(self.q.shape[1] * self.step)


def first_kept(step: float, start_s: float) -> int:
    """Index of the first sample with ``time - time[0] >= start_s - step / 2``."""
    return max(0, int(np.ceil(start_s / step - 0.5)))


def kept(history: ModalHistory, start_s: float) -> ModalHistory:
    """Cut the start-up, see ``first_kept``."""
    first, q = first_kept(history.step, start_s), history.q
    cut = q.later(first) if isinstance(q, Spool) else np.ascontiguousarray(q[:, first:])
    return replace(history, q=cut, start=history.start + first * history.step)


def stress_history(modal_stress: NDArray[np.float64], q: Samples) -> NDArray[np.float64]:
    """Recover stress histories (..., t) [MPa] from modal stress (..., m) [MPa per unit modal coordinate].

    The superposition of Eq. 5. It takes the modal coordinates (m, t) a bounded number of samples at a time, whatever
    their precision.
    """
    rows = modal_stress.reshape(-1, modal_stress.shape[-1])
    stress = np.empty((len(rows), q.shape[1]))
    first = 0
    for chunk in cached_chunks(q):
        end = first + chunk.shape[1]
        np.matmul(rows, chunk.astype(np.float64, copy=False), out=stress[:, first:end])
        first = end
    return stress.reshape(*modal_stress.shape[:-1], -1)


def stress_chunks(modal_stress: NDArray[np.float64], q: Samples) -> Iterator[NDArray[np.float64]]:
    """Chunks (..., t) of what ``stress_history`` recovers, one after the other."""
    for chunk in cached_chunks(q):
        yield modal_stress @ chunk.astype(np.float64, copy=False)


def stress_record(modal_stress: NDArray[np.float64], q: Samples) -> Samples:
    """Stress histories (n, t) [MPa], in a file named ``stress`` beside a record that is on disk.

    Raises
    ------
    DataError : the disk is full
    """
    if not isinstance(q, Spool):
        return stress_history(modal_stress, q)
    with SpoolWriter(q.path.with_name("stress"), len(modal_stress), np.dtype(np.float64)) as writer:
        for chunk in stress_chunks(modal_stress, q):
            writer.append(chunk)
    return writer.spool()


def mean_and_covariance(q: Samples) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Time mean (m,) and covariance (m, m) of modal coordinates (m, t).

    In one pass: each chunk about its own mean, and the means of the chunks about each other (Chan, Golub and LeVeque,
    1979). Taken from the first sample, so that a record at rest has exactly no variance.
    """
    modes, samples = q.shape
    first, offset = q[:, :1].astype(np.float64), np.zeros(modes)
    products, before = np.zeros((modes, modes)), 0
    for chunk in cached_chunks(q):
        centred = chunk - first
        mean = centred.mean(axis=1)
        centred -= mean[:, None]
        products += centred @ centred.T
        count = chunk.shape[1]
        apart = mean - offset
        offset += apart * (count / (before + count))
        products += np.outer(apart, apart) * (before * count / (before + count))
        before += count
    return first[:, 0] + offset, products / samples


def cached_chunks(q: Samples) -> Iterator[NDArray[np.floating]]:
    """Cut modal coordinates (m, t) into chunks of time that stay in the processor's cache in double precision."""
    width = max(SHORTEST_CHUNK, CACHED_NUMBERS // q.shape[0])
    for part in time_slices(q.shape):
        read = q[:, part]
        for first in range(0, read.shape[1], width):
            yield read[:, first : first + width]


def upsampled(history: ModalHistory, factor: int, residue: Residue, scratch: Path | None = None) -> ModalHistory:
    """Interpolate the record by FFT onto a grid ``factor`` times finer.

    A record that repeats is periodic as it stands; a single pass is mirrored about its ends first, so that no jump
    between its last and first sample rings through it. One mode is transformed at a time, in about five times the
    memory of its fine samples, ten times for a single pass. The result goes to the file ``scratch``, if one is given;
    a long record is transformed in files beside it then.
    """
    if factor == 1:
        return history
    modes, samples = history.q.shape
    shape = (modes, samples * factor if residue == "repeat" else (samples - 1) * factor + 1)
    double = np.dtype(np.float64)
    fine: Samples = np.empty(shape) if scratch is None else create_spool(scratch, shape, double)
    period = samples if residue == "repeat" else 2 * (samples - 1)
    for mode in range(modes):
        if isinstance(fine, Spool) and period * factor > LONGEST_TRANSFORM:
            interpolate_long(history.q, fine, mode, factor, period)
            continue
        q = history.q[mode : mode + 1, :].astype(np.float64)
        if residue == "half":
            q = np.concatenate([q, q[:, -2:0:-1]], axis=1)
        fine[mode : mode + 1, :] = _fft_interpolate(q, factor)[:, : shape[1]]
    return replace(history, q=fine, step=history.step / factor)


def _fft_interpolate(q: NDArray[np.float64], factor: int) -> NDArray[np.float64]:
    """Evaluate the trigonometric interpolant of each row on a grid ``factor`` times finer."""
    samples = q.shape[1]
    spectrum = np.fft.rfft(q, axis=1)
    if samples % 2 == 0:
        spectrum[:, -1] *= 0.5  # the Nyquist line stands for both +f and -f
    return np.asarray(np.fft.irfft(spectrum * factor, n=samples * factor, axis=1))
