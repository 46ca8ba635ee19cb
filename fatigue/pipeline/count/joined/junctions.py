"""Bounds of what loops of events add, without any cycle counted: how often events meet, and how far they are apart.

With b(e) a bound of the damage of a pass of e, b_1(e) the same with the first slope of the curve extended, R a range
that no two stresses of the events exceed, and d_1 the damage of one cycle on that slope, pure membrane, one run of n
stints, h of them ``half``, adds no more than

    sum_j (b_1(e_j) - b(e_j)) + (n + h/2) d_1(R),

because a junction of two passes adds at most one upcrossing of any interval of stress, and ``half`` leaves out no more
than half a cycle. With ``1000 n_e`` passes not below the stints, the sum of the events and of this is a bound.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol, Self

import numpy as np
from numpy.typing import NDArray

from fatigue.life.mission import Plan
from fatigue.life.rule import equivalent_range
from fatigue.life.sequence import Convex, convex_damage
from fatigue.pipeline.count.joined.loops import Joined, nothing_known
from fatigue.pipeline.solve.modal_stress import ModalStress

Floats = NDArray[np.float64]
Rows = NDArray[np.intp] | slice


class EventBound(Protocol):
    """What is asked of the bound of an event: arrays (n, 2)."""

    @property
    def damage(self) -> Floats:
        """Of one pass."""

    @property
    def max_range(self) -> Floats:
        """Largest range [MPa]."""


@dataclass(frozen=True, slots=True, eq=False)
class Junctions:
    """What is known of n stations where events meet.

    ``mean`` (e, n, 2) is the mean of the stress of every event, constants included [MPa]; ``first_slope`` (e, n, 2) are
    bounds b_1 of the damage of a pass, None where the curve has no other slope; ``convex`` is d_1, ``size`` (n, 1) the
    factor of the thickness, and ``equivalent`` (n, 1) the largest dS of a range over the range.
    """

    mean: Floats
    first_slope: Floats | None
    convex: Convex
    size: Floats
    equivalent: Floats

    @classmethod
    def of(cls, stress: ModalStress, mean: Sequence[Floats], first_slope: Sequence[Floats]) -> Self:
        """Of the stations of a block, from mean stress and bound b_1 (n, 2) of every event; none of b_1: one slope."""
        size, I = stress.size[:, None], stress.rule.ratio_factor(np.zeros(()))  # noqa: E741 - the symbol of the standard
        of_slope = np.stack(first_slope) if first_slope else None
        equivalent = np.asarray(equivalent_range(1.0, size, I, 1.0))
        return cls(np.stack(mean), of_slope, convex_damage(stress.rule), size, equivalent)

    def at(self, rows: Rows) -> Self:
        """Take some stations."""
        first_slope = None if self.first_slope is None else self.first_slope[:, rows]
        return type(self)(self.mean[:, rows], first_slope, self.convex, self.size[rows], self.equivalent[rows])

    def bounded(self, plan: Plan, bounds: Sequence[EventBound]) -> Joined:
        """Bounds of every loop, and of an unknown order, from those of the events at the same stations."""
        loops = []
        for loop in plan.loops:
            largest = self._range(loop.order, bounds)
            halves = sum(plan.passes[event].half for event in loop.order)
            damage = (len(loop.order) + 0.5 * halves) * self._damage(largest)
            damage = damage + self._beside_the_slope(loop.order, np.ones(len(loop.order)), bounds)
            loops.append(nothing_known(damage, largest, self.equivalent * largest))
        return Joined(tuple(loops), self._unknown_order(plan, bounds))

    def _unknown_order(self, plan: Plan, bounds: Sequence[EventBound]) -> Floats:
        stints = [0.0 if one.stints_per_1000_km is None else one.stints_per_1000_km / 1000.0 for one in plan.passes]
        known = tuple(i for i, one in enumerate(plan.passes) if one.stints_per_1000_km is not None)
        if not known:
            return np.full(self.mean.shape[1:], np.nan)
        weights = np.array([stints[i] for i in known])
        junctions = sum(w * (1.0 + 0.5 * plan.passes[i].half) for w, i in zip(weights, known, strict=True))
        of_slope = self._beside_the_slope(known, weights, bounds)
        return np.asarray(junctions * self._damage(self._range(known, bounds)) + of_slope)

    def _range(self, events: Sequence[int], bounds: Sequence[EventBound]) -> Floats:
        """A range that no two stresses of some events exceed."""
        largest = np.max([bounds[e].max_range for e in events], axis=0)
        for i in set(events):
            for j in set(events) - {i}:
                apart = self.mean[i] + bounds[i].max_range - (self.mean[j] - bounds[j].max_range)
                largest = np.maximum(largest, apart)
        return np.asarray(largest)

    def _damage(self, largest: Floats) -> Floats:
        x = self.size * largest
        of_slopes = zip(self.convex.exponents, self.convex.log_scales, strict=True)
        return np.asarray(np.max([np.exp(log_scale) * x**k for k, log_scale in of_slopes], axis=0))

    def _beside_the_slope(self, events: Sequence[int], weights: Floats, bounds: Sequence[EventBound]) -> Floats:
        """``sum weight (b_1 - b)`` of some events; infinite where an event has no bound."""
        total = np.zeros(self.mean.shape[1:])
        for event, weight in zip(events, weights, strict=True):
            b = bounds[event].damage
            if self.first_slope is not None:
                total = total + weight * np.where(np.isfinite(b), self.first_slope[event], np.inf)
                total = total - weight * np.where(np.isfinite(b), b, 0.0)
            else:
                total = total + np.where(np.isfinite(b), 0.0, np.inf)
        return total
