"""One event of the multibody simulation: its modal coordinates over time."""

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

Residue = Literal["repeat", "half"]


@dataclass(frozen=True, slots=True, eq=False)
class ModalHistory:
    """Modal coordinates of one event on a uniform time grid.

    Attributes
    ----------
    event : name of the event
    mode : (m,) mode ids
    q : (m, t) modal coordinates, time contiguous [unit modal coordinate]
    step : time step [s]
    start : file time of the first sample [s]
    """

    event: str
    mode: NDArray[np.int64]
    q: NDArray[np.floating]
    step: float
    start: float

    @property
    def duration(self) -> float:
        """Duration of the pass [s]: samples times step, because a block that repeats has no last instant."""
        return float(self.q.shape[1] * self.step)


def kept(history: ModalHistory, start_s: float) -> ModalHistory:
    """Cut the start-up: keep the samples with ``time - time[0] >= start_s - step / 2``."""
    first = max(0, int(np.ceil(start_s / history.step - 0.5)))
    return replace(history, q=np.ascontiguousarray(history.q[:, first:]), start=history.start + first * history.step)


def upsampled(history: ModalHistory, factor: int, residue: Residue) -> ModalHistory:
    """Interpolate the record by FFT onto a grid ``factor`` times finer.

    A record that repeats is periodic as it stands; a single pass is mirrored about its ends first, so that no jump
    between its last and first sample rings through it.
    """
    if factor == 1:
        return history
    q = history.q.astype(np.float64)
    samples = q.shape[1]
    if residue == "repeat":
        fine = _fft_interpolate(q, factor)
    else:
        mirrored = np.concatenate([q, q[:, -2:0:-1]], axis=1)
        fine = _fft_interpolate(mirrored, factor)[:, : (samples - 1) * factor + 1]
    return replace(history, q=np.ascontiguousarray(fine), step=history.step / factor)


def _fft_interpolate(q: NDArray[np.float64], factor: int) -> NDArray[np.float64]:
    """Evaluate the trigonometric interpolant of each row on a grid ``factor`` times finer."""
    samples = q.shape[1]
    spectrum = np.fft.rfft(q, axis=1)
    if samples % 2 == 0:
        spectrum[:, -1] *= 0.5  # the Nyquist line stands for both +f and -f
    return np.asarray(np.fft.irfft(spectrum * factor, n=samples * factor, axis=1))
