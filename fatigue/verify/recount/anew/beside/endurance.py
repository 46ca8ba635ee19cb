"""Stress between static load cases once more: every pair of states or of corners, one after the other."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations, product

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

COMPONENTS = ("perp", "par", "shear")
MOST_CORNERS = 8  # loads of which every pair of corners is gone through here
AT_END = 1e-9  # of kappa: a cycle at the last row of a line


@dataclass(frozen=True, slots=True, eq=False)
class HaighLine:
    """Allowed mean and amplitude (r,) [MPa] of a component, from small stress ratios to large ones."""

    mean: Floats
    amplitude: Floats

    @classmethod
    def through(cls, R: Floats, stress_max: Floats) -> "HaighLine":
        """Line through upper stresses at some stress ratios."""
        order = np.argsort(R)
        top, low = stress_max[order], (R * stress_max)[order]
        return cls((top + low) / 2.0, (top - low) / 2.0)

    def allowed(self, mean: float, amplitude: float) -> float:
        """Allowed amplitude of a cycle: where its ray meets the line; NaN beyond the last row, the first one before."""
        kappa = mean / amplitude
        of_rows = self.mean / self.amplitude
        if kappa <= of_rows[0]:
            return float(self.amplitude[0])
        if kappa >= of_rows[-1]:
            return float(self.amplitude[-1]) if kappa - of_rows[-1] <= AT_END * max(1.0, abs(kappa)) else np.nan
        j = int(np.searchsorted(of_rows, kappa)) - 1
        chord = np.array([self.mean[j + 1] - self.mean[j], self.amplitude[j + 1] - self.amplitude[j]])
        meets = np.linalg.solve(np.array([[kappa, -chord[0]], [1.0, -chord[1]]]), [self.mean[j], self.amplitude[j]])
        return float(meets[0])


@dataclass(frozen=True, slots=True, eq=False)
class CaseStates:
    """Stress (s, 3) of the states that are compared at a point, components as in ``COMPONENTS`` [MPa].

    Of alternating loads these are all corners, ``static`` (3,) in their middle and ``loads`` (k, 3) as they are given.
    """

    states: Floats
    static: Floats | None = None
    loads: Floats | None = None


def alternating(static: Floats, loads: Floats) -> CaseStates:
    """States of loads that act in either sense, each for itself; without corners where these are too many."""
    if len(loads) > MOST_CORNERS:
        return CaseStates(np.zeros((0, 3)), static, loads)
    signs = np.array(list(product((-1.0, 1.0), repeat=len(loads))))
    return CaseStates(static + signs @ loads, static, loads)


def worst_cycle(of: CaseStates, component: str, line: HaighLine | None) -> dict[str, float]:
    """Range, R, amplitude, allowed amplitude and utilisation of the worst cycle of a component.

    Without a line it is the cycle with the largest range. Empty utilisation: R is above that of the last row.
    """
    c = COMPONENTS.index(component)
    if of.loads is not None and of.static is not None:
        reach = float(np.abs(of.loads[:, c]).sum())
        cycles = [(of.static[c] - reach, of.static[c] + reach)]
    else:
        cycles = [(min(a, b), max(a, b)) for a, b in combinations(of.states[:, c].tolist(), 2)]
    rated = [_rated(low, high, component, line) for low, high in cycles]
    return max(rated, key=lambda one: (one["severity"], one["range_max_MPa"]) if line else one["range_max_MPa"])


def plane_range(of: CaseStates) -> float:
    """Largest distance of two states in the plane of normal stress and sqrt(3) shear; NaN of too many corners."""
    points = of.states[:, [0, 2]] * [1.0, np.sqrt(3.0)]
    if not len(points):
        return np.nan
    return float(max(np.hypot(*(points - one).T).max() for one in points))


def worst_combination(
    of: CaseStates, lines: Mapping[str, HaighLine], kappa: Sequence[float]
) -> tuple[float, bool] | None:
    """Largest ``u_perp^2 + u_par^2 - kappa u_perp u_par + u_shear^2`` of all pairs, and whether the lines have it.

    None where corners are too many.
    """
    if not len(of.states):
        return None
    worst, inside = 0.0, True
    for one, other in combinations(of.states, 2):
        u, known = dict.fromkeys(COMPONENTS, 0.0), True
        for name, line in lines.items():
            c = COMPONENTS.index(name)
            rated = _rated(min(one[c], other[c]), max(one[c], other[c]), name, line)
            larger = max(one[c], other[c], key=abs)
            u[name] = np.sign(larger) * rated["severity"]
            known &= not np.isnan(rated["utilisation_stress"])
        mixed = max((-k * u["perp"] * u["par"] for k in kappa), default=0.0)
        value = u["perp"] ** 2 + u["par"] ** 2 + u["shear"] ** 2 + (mixed if known else max(mixed, 0.0))
        if value > worst * (1.0 + 1e-12):
            worst, inside = value, known
    return worst, inside


def _rated(low: float, high: float, component: str, line: HaighLine | None) -> dict[str, float]:
    """One cycle; ``severity`` is its utilisation, beyond the last row an upper bound."""
    if component == "shear" and abs(low) > abs(high):  # the sign of shear is a matter of the frame
        low, high = -high, -low
    amplitude, mean = (high - low) / 2.0, (high + low) / 2.0
    allowed = np.nan if line is None or amplitude == 0.0 else line.allowed(mean, amplitude)
    used = 0.0 if amplitude == 0.0 else amplitude / allowed
    severity = used
    if line is not None and amplitude > 0.0 and np.isnan(allowed):
        severity = high / (line.amplitude[-1] + line.mean[-1])
    ratio = 1.0 if low == high else -np.inf if high == 0.0 else low / high
    return {
        "range_max_MPa": high - low,
        "R": ratio,
        "amplitude_MPa": amplitude,
        "allowed_amplitude_MPa": allowed,
        "utilisation_stress": used,
        "severity": severity,
    }
