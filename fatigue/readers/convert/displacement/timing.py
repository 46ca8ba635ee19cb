"""Causes that lie in time: a displacement that is late or early, or that is a velocity or an acceleration."""

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.signal import correlate

from fatigue.readers.convert.displacement.causes import Cause

Floats = NDArray[np.float64]

_FEW = 8  # instants: fewer tell nothing


def shifted(time: Floats, summed: Floats, at: Floats, measured: Floats) -> list[Cause]:
    """Shifts in time with which a displacement fits the sum: two records over their own times.

    Parameters
    ----------
    time, summed : (t,) uniform times [s] and the sum of the modes there
    at, measured : (s,) times [s] and the displacement there
    """
    step = (time[-1] - time[0]) / (time.size - 1)
    own = at[0] + step * np.arange(int((at[-1] - at[0]) / step + 1e-6) + 1)
    if own.size < _FEW or time.size < _FEW:
        return []
    y = CubicSpline(at, measured)(np.minimum(own, at[-1]))
    u = summed - summed.mean()
    y = y - y.mean()
    ones_u, ones_y = np.ones_like(u), np.ones_like(y)
    common = correlate(ones_y, ones_u, method="fft")
    y_energy, u_energy = correlate(y**2, ones_u, method="fft"), correlate(ones_y, u**2, method="fft")
    product = correlate(y, u, method="fft")
    enough = common > max(_FEW, 0.5 * min(u.size, y.size))
    likeness = np.where(enough, 2 * product / np.maximum(y_energy + u_energy, 1e-300), -1.0)
    peaks = 1 + np.flatnonzero((likeness[1:-1] > likeness[:-2]) & (likeness[1:-1] >= likeness[2:]))
    peaks = peaks[likeness[peaks] > 0.9]
    best = peaks[np.argsort(-likeness[peaks])][:5]
    spline = CubicSpline(time, summed)
    found = []
    for k in best.tolist():
        before, here, after = likeness[k - 1 : k + 2]
        bend = before - 2 * here + after
        place = k + (0.5 * (before - after) / bend if bend < 0 else 0.0)
        shift = float(own[0] - time[0] + step * (place - (u.size - 1)))
        inside = (at - shift >= time[0]) & (at - shift <= time[-1])
        if np.count_nonzero(inside) < _FEW or abs(shift) < 1e-9:
            continue
        there, theirs = spline(at[inside] - shift), measured[inside]
        rest, level = theirs - there, float(np.std(theirs))
        misfit = float(np.std(rest)) / level if level > 0 else np.inf
        text = f"the displacement is {abs(shift):.4g} s {'late' if shift > 0 else 'early'}"
        found.append(Cause("time", misfit, text, "Export both with one clock and from the same instant on"))
    return found


def derived(time: Floats, summed: Floats, at: Floats, measured: Floats) -> list[Cause]:
    """Derivatives of the sum that a displacement is; parameters as for ``shifted``."""
    inside = (at >= time[0]) & (at <= time[-1])
    level = float(np.std(measured[inside])) if np.count_nonzero(inside) >= _FEW else 0.0
    if time.size < _FEW or level == 0.0:
        return []
    spline = CubicSpline(time, summed)
    found = []
    for order, word in ((1, "a velocity"), (2, "an acceleration")):
        rate = spline(at[inside], order)
        misfit = min(float(np.std(measured[inside] - factor * rate)) / level for factor in (1.0, -1.0, 1e-3, -1e-3))
        found.append(
            Cause("derivative", misfit, f"it is {word}, not a displacement", "Export the elastic displacement")
        )
    return found
