"""What excites a mode, from what the mode does: effective excitation, and the parts that follow it and that swing.

A coordinate of modal mass 1 obeys ``q'' + 2 zeta w_k q' + w_k^2 q = f``, with f all forces on the mode over its modal
mass, those of inertia of the moving frame included. So the excitation follows from the coordinate alone, by the dynamic
stiffness ``H^-1(w) = w_k^2 - w^2 + 2 i zeta w_k w`` in the frequency domain,

    f = IFFT[H^-1 Q],    q_qs = f / w_k^2,    q_dyn = q - q_qs = -(q'' + 2 zeta w_k q') / w_k^2.

``q_qs`` is what the mode would do if it followed its load without inertia. Under a sine at ``r = w / w_k`` the dynamic
part is ``r^2 - 2 i zeta r`` of the coordinate: next to nothing of a slow load, all of it in resonance; above, where the
mode moves against its load, it is more than the coordinate.

Records are differentiated, so what is fast in them counts most: everything above 0.4 of the sampling rate is left out
of the excitation (and remains in the dynamic part). A mode whose frequency is above that is not differentiated at all,
``f = w_k^2 q``: what excites it in resonance cannot be in the record. No record is taken for periodic, not even that
of an event that recurs, because the second derivative would find the seam; see ``continuation``.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fatigue.vibration.continuation import continued
from fatigue.vibration.oscillator import dynamic_stiffness

Floats = NDArray[np.float64]

CUT, GONE = 0.4, 0.45  # of the sampling rate: all of the excitation is kept up to the one, nothing from the other on
SHORTEST = 64  # samples


class Split(NamedTuple):
    """A modal coordinate (..., t) in two parts that add up to it."""

    quasi_static: Floats
    dynamic: Floats


def excitation(q: NDArray[np.floating], step: float, natural_hz: Floats, damping_ratio: Floats) -> Floats:
    """Effective excitation f of modes per modal mass, (m, t) [unit of q / s^2].

    Parameters
    ----------
    q : (m, t) coordinates
    step : time step [s]
    natural_hz, damping_ratio : (m,) of the modes; the damping only counts near resonance

    Raises
    ------
    ValueError : fewer than 64 samples, or a frequency that is not above 0
    """
    return np.asarray((2.0 * np.pi * natural_hz[:, None]) ** 2 * quasi_static(q, step, natural_hz, damping_ratio))


def split(q: NDArray[np.floating], step: float, natural_hz: Floats, damping_ratio: Floats) -> Split:
    """Quasi-static and dynamic part of modal coordinates; parameters and errors as of ``excitation``."""
    follows = quasi_static(q, step, natural_hz, damping_ratio)
    return Split(follows, q - follows)


def quasi_static(q: NDArray[np.floating], step: float, natural_hz: Floats, damping_ratio: Floats) -> Floats:
    """Quasi-static part ``f / w_k^2`` of modal coordinates; parameters and errors as of ``excitation``."""
    samples = q.shape[-1]
    if samples < SHORTEST:
        raise ValueError(f"{samples} samples are too few to be differentiated")
    if not np.all(natural_hz > 0.0):
        raise ValueError("a mode without natural frequency does not follow a load")
    found = np.array(q, dtype=np.float64)
    of = np.flatnonzero(is_differentiated(natural_hz, step))
    if not len(of):
        return found
    mean = found[of].mean(axis=1, keepdims=True)
    x, kept = continued(found[of] - mean)
    length = fast_length(x.shape[1])
    hz = np.asarray(np.fft.rfftfreq(length, step), np.float64)
    natural, damping = natural_hz[of, None], damping_ratio[of, None]
    ratio = dynamic_stiffness(hz, natural, damping) / (2.0 * np.pi * natural) ** 2
    part = np.fft.irfft(pass_band(hz, step) * ratio * np.fft.rfft(x, length), length)
    found[of] = mean + part[:, kept]
    return found


def is_differentiated(natural_hz: Floats, step: float) -> NDArray[np.bool_]:
    """Whether the excitation of modes is found by differentiation; else they follow their loads as far as one sees."""
    return np.asarray(natural_hz <= CUT / step)


def pass_band(hz: Floats, step: float) -> Floats:
    """What is kept of each frequency: 1 up to 0.4 of the sampling rate, 0 from 0.45 on, a cosine between."""
    beyond = np.clip((hz * step - CUT) / (GONE - CUT), 0.0, 1.0)
    return np.asarray(0.5 + 0.5 * np.cos(np.pi * beyond))


def fast_length(samples: int) -> int:
    """Length of a transform that holds so many samples and is fast."""
    from scipy.fft import next_fast_len  # noqa: PLC0415 - scipy.fft takes a while to import

    return int(next_fast_len(samples, real=True))
