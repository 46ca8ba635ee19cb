"""One step of a vehicle in time: exact where it is linear, explicit where it is not.

``x' = A x + B u + G g`` with the track ``u`` held over a step becomes ``x(k+1) = Ad x(k) + Bd u(k) + Gd g``, by the
matrix exponential of ``[[A, B, G], [0, 0, 0]]``. It is exact, so modes far above the step decay as they have to. The
remainder ``g`` of worn contact, flange and saturation is extrapolated, ``1.5 g(k) - 0.5 g(k-1)`` (Adams and Bashforth);
of the first step it is ``g(0)``.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import expm

from fatigue.compiled import compiled
from fatigue.vehicle.in_time.contact import Contact, remainder

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]

CHUNK = 4096  # steps at a time


class AxleRows(NamedTuple):
    """Rows (axles,) of the state that hold the motion of the wheelsets: y, psi, and their rates."""

    y: Indices
    psi: Indices
    y_rate: Indices
    psi_rate: Indices


class Met(NamedTuple):
    """What the axles meet at every step: inputs ``u`` (n, u) of the linear vehicle, lateral irregularity and wear.

    ``lateral`` (n, axles) [m]; ``worn`` (n, axles) is 1 where the tread law of worn sections holds, 0 where not.
    """

    u: Floats
    lateral: Floats
    worn: Floats


def exact_step(A: Floats, B: Floats, step: float) -> Floats:
    """``[Ad, Bd]`` (n, n + u) of the exact step of ``x' = A x + B u`` over a time [s], u held (Van Loan, 1978).

    >>> exact_step(np.array([[-2.0]]), np.array([[2.0]]), 0.5).round(6).tolist()
    [[0.367879, 0.632121]]
    """
    whole = np.zeros((A.shape[1] + B.shape[1],) * 2)
    whole[: len(A)] = np.hstack([A, B])
    return np.asarray(expm(whole * step)[: len(A)])


def states(step: Floats, start: Floats, met: Met, rows: AxleRows, contact: Contact) -> Iterator[Floats]:
    """States (some steps, n) of a vehicle, chunk by chunk, each before its step; the first one is ``start`` (n,).

    ``step`` (n, n + u + 2 axles) is ``exact_step`` of its linear equations, with the lateral forces [N] on the
    wheelsets and then the moments [N m] about z as the last inputs.
    """
    x, before, turned = start.astype(np.float64), np.full(2 * rows.y.size, np.nan), np.ascontiguousarray(step.T)
    for first in range(0, len(met.u), CHUNK):
        some = slice(first, first + CHUNK)
        met_now = Met(*(np.ascontiguousarray(part[some]) for part in met))
        found = np.empty((len(met_now.u), x.size))
        advance(x, before, met_now, turned, rows, contact, found)
        yield found


@compiled()
def advance(
    x: Floats, before: Floats, met: Met, turned: Floats, rows: AxleRows, contact: Contact, found: Floats
) -> None:
    """Advance a vehicle by as many steps as ``found`` (steps, n) has rows, which take the state before each step.

    Parameters
    ----------
    x : (n,) state, replaced by the one behind the last step
    before : (2 axles,) remainder of the step before, NaN ahead of the first one; replaced
    turned : (n + u + 2 axles, n) the step, its columns as rows: they are added up, which runs along memory
    """
    n, inputs, axles = x.size, met.u.shape[1], rows.y.size
    z = np.empty(n + inputs + 2 * axles)
    g = np.empty(2 * axles)
    for k in range(len(found)):
        found[k] = x
        for i in range(axles):
            d = x[rows.y[i]] - met.lateral[k, i]
            psi, y_rate, psi_rate = x[rows.psi[i]], x[rows.y_rate[i]], x[rows.psi_rate[i]]
            g[i], g[axles + i] = remainder(d, psi, y_rate, psi_rate, met.worn[k, i], contact)
        z[:n] = x
        z[n : n + inputs] = met.u[k]
        for i in range(2 * axles):
            z[n + inputs + i] = g[i] if np.isnan(before[i]) else 1.5 * g[i] - 0.5 * before[i]
            before[i] = g[i]
        product(turned, z, x)


@compiled()
def product(turned: Floats, z: Floats, y: Floats) -> None:
    """Put ``A z`` into y (n,), ``turned`` (m, n) being A': four columns at a time, in an order no library decides."""
    n, m = y.size, z.size
    y[:] = 0.0
    whole = m - m % 4
    for j in range(0, whole, 4):
        a, b, c, d = z[j], z[j + 1], z[j + 2], z[j + 3]
        for i in range(n):
            y[i] += turned[j, i] * a + turned[j + 1, i] * b + turned[j + 2, i] * c + turned[j + 3, i] * d
    for j in range(whole, m):
        for i in range(n):
            y[i] += turned[j, i] * z[j]
