"""From the damage of single passes to kilometres: the mission, the load factor and the equivalent range."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.life.curves import DamageLaw
from fatigue.life.rule import cycle_damage

REFERENCE_CYCLES = 2e6  # at which European classes are named


@dataclass(frozen=True, slots=True)
class Pass:
    """How often one simulated pass of an event occurs.

    ``samples`` is how many of its record are kept; ``length`` is the distance of the pass [km], None for an event
    counted by number; ``share`` its part of the mileage; ``per_1000_km`` its number in 1000 km. ``refined``: by how
    much the record is upsampled so that no unit load of the event is sampled more finely; 0: it never is upsampled. It
    recurs within a stint, or is ``half``; ``stints_per_1000_km`` is how often it follows on other events in an order
    that is not known, None: it is not said.
    """

    event: str
    samples: int
    length: float | None
    share: float | None
    per_1000_km: float | None
    refined: int = 1
    half: bool = False
    stints_per_1000_km: float | None = None

    def factor(self, asked: int) -> int:
        """By how much the record is upsampled in all, where ``asked`` is by how much all events are."""
        return max(asked, self.refined) if self.refined else 1

    @property
    def passes_per_km(self) -> float:
        """Passes in one km of the mission [1/km]."""
        if self.length is not None and self.share is not None:
            return self.share / self.length
        assert self.per_1000_km is not None
        return self.per_1000_km / 1000.0


@dataclass(frozen=True, slots=True)
class Loop:
    """Events in a known order that is run again and again: ``order`` has the number of the event of each stint."""

    name: str
    order: tuple[int, ...]
    per_1000_km: float

    @property
    def runs_per_km(self) -> float:
        """Runs of the loop in one km of the mission [1/km]."""
        return self.per_1000_km / 1000.0


@dataclass(frozen=True, slots=True)
class Plan:
    """The mission in numbers: passes per km of every event, runs of every loop, and what must be reached."""

    passes: tuple[Pass, ...]
    target_km: float
    km_per_year: float
    damage_limit: float
    loops: tuple[Loop, ...] = ()

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the events, and of the loops behind them."""
        return (*(one.event for one in self.passes), *(loop.name for loop in self.loops))

    @property
    def weights(self) -> NDArray[np.float64]:
        """Passes per km of the events, and runs per km of the loops behind them [1/km]."""
        return np.array([*(one.passes_per_km for one in self.passes), *(loop.runs_per_km for loop in self.loops)])

    @property
    def joins_events(self) -> bool:
        """Whether cycles across events are looked at: in loops, or in an order that is not known."""
        return any(self.joins(event) for event in range(len(self.passes)))

    def joins(self, event: int) -> bool:
        """Whether an event, by its number, follows on others: in a loop, or in an order that is not known."""
        in_loop = any(event in loop.order for loop in self.loops)
        return in_loop or self.passes[event].stints_per_1000_km is not None


def mission_sum(per_pass: NDArray[np.float64], passes: Sequence[Pass]) -> NDArray[np.float64]:
    """Sum a quantity counted per pass over the mission, Eq. 14: (event, ...) -> (...) [1/km].

    >>> tangent = Pass("tangent", samples=1000, length=2.5, share=1.0, per_1000_km=None)
    >>> loading = Pass("load and unload", samples=2, length=None, share=None, per_1000_km=4.0)
    >>> float(mission_sum(np.array([2e-7, 5e-6]), [tangent, loading]).round(12))
    1e-07
    """
    weights = np.array([p.passes_per_km for p in passes])
    return np.asarray(np.tensordot(weights, per_pass, axes=1))


def life_km(damage_per_km: NDArray[np.float64], damage_limit: NDArray[np.float64] | float) -> NDArray[np.float64]:
    """Distance at which the Miner sum reaches its limit [km], Eq. 15; +inf where nothing damages.

    >>> life_km(np.array([1e-7, 0.0]), 0.5)
    array([5000000.,      inf])
    """
    life = np.full_like(damage_per_km, np.inf)
    with np.errstate(over="ignore"):  # the tail of a spectrum above a cut-off
        return np.divide(damage_limit, damage_per_km, out=life, where=damage_per_km > 0.0)


def stress_utilisation(load_factor: NDArray[np.float64]) -> NDArray[np.float64]:
    """Stress over the largest stress that just meets the target, 1 / load factor; 0 of an infinite one.

    >>> stress_utilisation(np.array([1.25, np.inf]))
    array([0.8, 0. ])
    """
    with np.errstate(divide="ignore"):
        return np.asarray(1.0 / load_factor)


def straight_load_factor(utilisation: NDArray[np.float64], slope: float) -> NDArray[np.float64]:
    """Scale on all stresses that just meets the target on one slope, ``utilisation^(-1/k)`` (Eq. 16); +inf undamaged.

    >>> straight_load_factor(np.array([8.0]), 3.0)
    array([0.5])
    """
    return np.power(utilisation, -1.0 / slope, out=np.full_like(utilisation, np.inf), where=utilisation > 0.0)


def load_factor(
    count: NDArray[np.float64], power_sum: NDArray[np.float64], law: DamageLaw, target_km: float, damage_limit: float
) -> NDArray[np.float64]:
    """Scale on all stresses that about meets the target on a curve with a knee, from the stored spectrum.

    It says where ``load_factor.load_factor_of_counts`` has to look.

    Parameters
    ----------
    count, power_sum : (point, bin) sum n and sum n x^k of the equivalent ranges of each histogram bin [1/km], k the
        first slope of the law

    Returns
    -------
    (point,) factor. Each bin is represented by the range ``(sum n x^k / sum n)^(1/k)``, which is exact on the first
    slope. No representative is further from its ranges than the bin is wide, so the factor is at most one bin width
    (10^(1/64) - 1 = 3.7 %) off, and only as far as damage sits in the bin that holds the knee or the cut-off.
    """
    used = np.flatnonzero(count.any(axis=0))
    n, powers = count[:, used], power_sum[:, used]
    x = np.divide(powers, n, out=np.zeros_like(n), where=n > 0.0) ** (1.0 / law.slopes[0])

    def utilisation(log_factor: NDArray[np.float64]) -> NDArray[np.float64]:
        scaled = x * np.exp(log_factor)[:, None]
        return np.asarray((n * cycle_damage(scaled, law)).sum(axis=1)) * target_km / damage_limit

    straight = DamageLaw(law.slopes[:1], law.log_constants[:1], law.knees[:0], 0.0)
    on_first_slope = (n * cycle_damage(x, straight)).sum(axis=1) * target_km / damage_limit
    damaged = on_first_slope > 0.0
    start = np.log(straight_load_factor(np.where(damaged, on_first_slope, 1.0), float(law.slopes[0])))
    low, high = start - 0.1, start + 0.1
    for _ in range(60):  # widen to a bracket, then halve it
        low = np.where(utilisation(low) > 1.0, low - (high - low), low)
        high = np.where(utilisation(high) < 1.0, high + (high - low), high)
        if np.all(~damaged | ((utilisation(low) <= 1.0) & (utilisation(high) >= 1.0))):
            break
    for _ in range(50):
        middle = 0.5 * (low + high)
        above = utilisation(middle) > 1.0
        low, high = np.where(above, low, middle), np.where(above, middle, high)
    return np.where(damaged, np.exp(low), np.inf)


def range_at_2e6(power_sum_per_km: NDArray[np.float64], slope: float, target_km: float) -> NDArray[np.float64]:
    """Constant range [MPa] that does the same in 2e6 cycles over the target: ``(sum n S^k / 2e6)^(1/k)`` (Eq. 17).

    >>> range_at_2e6(np.array([4.0 * 30.0**3]), 3.0, 5e5).round(9)
    array([30.])
    """
    return np.asarray((power_sum_per_km * target_km / REFERENCE_CYCLES) ** (1.0 / slope))
