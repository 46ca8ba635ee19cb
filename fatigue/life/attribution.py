"""What makes the damage: every cycle's share for modes, frequency bands and instants, and the slopes of the damage.

Structural stress is linear in the modal coordinates, s = sum_k w_k q_k. A rainflow cycle between the instants i and j
has the signed range ``ds = s[j] - s[i] = sum_k w_k (q_k[j] - q_k[i])``, so the part ``w_k (q_k[j] - q_k[i]) / ds`` of
its damage is owed to mode k. The parts add up to one for any S-N curve; a part below 0 belongs to a mode that relieves.
With the damage over ds laid on the two instants of every cycle, as one vector g over time, mode k owes
``w_k (q_k @ g)``: cycles need no list, and whatever adds up to q (modes, bands) gets parts that add up to the damage.

The same cycles give the gradient of the damage with respect to every sample of the membrane and the bending stress.
Every sensitivity follows from it by the chain rule: the range, the bending ratio and the mean-stress factor of each
cycle all move. It is exact where no two reversals tie and no cycle sits on a knee or a cut-off. Across a tie cycles
trade instants: their ranges do not jump, but their bending ratios do, so that damage itself has small steps (parts in
a thousand) which no gradient sees. Nor does it see the cycles that cross a cut-off.

Where reversals are read at their vertices (``fatigue.life.counting.vertex``), their parts are laid on the three samples
that each is read from: s at a vertex is a sum of these, and so is q. The parts still add up. The gradient takes the
instants of the vertices as they are; that is exact for the range, which is stationary there, and leaves out of the
bending ratio what a shift of the instant does to it.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.life.counting.rainflow import Cycles
from fatigue.life.counting.vertex import spread
from fatigue.life.rule import (
    CycleRule,
    bending_ratio,
    cycle_damage,
    equivalent_range,
    local_slope,
)

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]


@dataclass(frozen=True, slots=True, eq=False)
class Credit:
    """The damage of one point in one pass of an event, laid on the samples of the record.

    Attributes
    ----------
    damage : Miner sum D of the cycles
    top_cycle : damage of the one most damaging cycle
    slope : dD / d ln x, x the equivalent ranges of all cycles: k D on one slope k; also dD / d ln(load)
    share : (t,) the vector g of the module; ``stress @ share`` is D [1/MPa]
    place : (t,) half of each cycle's damage at either instant; adds up to D
    by_membrane, by_bending : (t,) dD / d sigma_m[t] and dD / d sigma_b[t], bending of the top face [1/MPa]
    """

    damage: float
    top_cycle: float
    slope: float
    share: Floats
    place: Floats
    by_membrane: Floats
    by_bending: Floats

    @property
    def by_offset(self) -> float:
        """Derivative of the damage by a constant added to the stress [1/MPa]: that of all samples together."""
        return float(self.by_membrane.sum())


@dataclass(frozen=True, slots=True, eq=False)
class CycleCredit:
    """The damage of c cycles of one point, and what its derivatives lay on their two instants; every array is (c,).

    Attributes
    ----------
    damage, slope : Miner sums, and their derivatives by ln x as in ``Credit``
    share : damage over signed range, laid on the end, less on the start [1/MPa]
    by_range : derivative by the stress at the end, less at the start, but for the largest stress itself [1/MPa]
    by_peak : derivative by the largest stress, on the instant of it [1/MPa]
    peak_at_end : whether that is the end
    by_ratio : derivatives through the bending ratio by membrane stress, negative, and by bending stress, laid like
        ``share`` [1/MPa]; None where the rule does not use it
    """

    damage: Floats
    slope: Floats
    share: Floats
    by_range: Floats
    by_peak: Floats
    peak_at_end: NDArray[np.bool_]
    by_ratio: tuple[Floats, Floats] | None


def cycle_credit(
    membrane: Floats,
    bending: Floats,
    count: Floats,
    side: float,
    size: float,
    rule: CycleRule,
    offset: float = 0.0,
) -> CycleCredit:
    """Damage and derivatives of cycles, from the stresses (2, c) at start and end of each.

    Parameters
    ----------
    membrane, bending : (2, c) membrane stress, and bending stress of the top face [MPa]
    count : (c,) 1 or 0.5
    side : +1 top face, -1 bottom face
    size : factor of the thickness on the range
    rule : from the range to its damage
    offset : constant stress of the face beside the samples [MPa], of which f_M and f(R) depend
    """
    dm, db = membrane[1] - membrane[0], bending[1] - bending[0]
    start, end = membrane + side * bending
    ds = end - start
    S = np.abs(ds)
    maximum = np.where(ds > 0.0, end, start) + offset
    r = bending_ratio(dm, db)
    f_M = rule.mean_stress_factor(maximum - S, maximum)
    x = equivalent_range(S, size, rule.ratio_factor(r), f_M)
    by_range, by_peak = rule.mean_stress_slopes(maximum - S, maximum)

    damage = count * cycle_damage(x, rule.law)
    slope = damage * local_slope(x, rule.law)
    by_ratio = None
    if rule.depends_on_bending:
        by_r = -slope * rule.log_ratio_factor_slope(r) / (np.abs(dm) + np.abs(db))
        by_ratio = by_r * r * np.sign(dm), by_r * (1.0 - r) * np.sign(db)
    return CycleCredit(damage, slope, damage / ds, slope * by_range / ds, slope * by_peak, ds > 0.0, by_ratio)


def credit(
    cycles: Cycles,
    membrane: Floats,
    bending: Floats,
    side: float,
    size: float,
    rule: CycleRule,
    offset: float = 0.0,
    shift: Floats | None = None,
) -> Credit:
    """Lay the damage of every cycle on its two instants (Eq. 23).

    Parameters
    ----------
    cycles : of ``membrane + side * bending``, ranges above 0; one across the end of the record has two instants, too
    membrane, bending : (t,) membrane stress, and bending stress of the top face [MPa]
    side, size, rule, offset : as of ``cycle_credit``
    shift : (t,) where the stresses are those of a ``VertexHistory``, its shifts
    """
    start, end, samples = cycles.start, cycles.end, len(membrane)
    both = np.stack([start, end])
    of = cycle_credit(membrane[both], bending[both], cycles.count, side, size, rule, offset)
    by_stress = _on_instants(start, end, of.by_range, samples)
    by_stress += np.bincount(np.where(of.peak_at_end, end, start), of.by_peak, samples)
    by_membrane, by_bending = by_stress, side * by_stress
    if of.by_ratio is not None:
        by_membrane = by_membrane - _on_instants(start, end, of.by_ratio[0], samples)
        by_bending = by_bending + _on_instants(start, end, of.by_ratio[1], samples)
    share = _on_instants(start, end, of.share, samples)
    if shift is not None:
        share, by_membrane, by_bending = (spread(laid, shift) for laid in (share, by_membrane, by_bending))
    place = np.zeros(samples)
    for at in (start, end):
        place += np.bincount(at, 0.5 * of.damage, samples)
    return Credit(
        damage=float(of.damage.sum()),
        top_cycle=float(of.damage.max(initial=0.0)),
        slope=float(of.slope.sum()),
        share=share,
        place=place,
        by_membrane=by_membrane,
        by_bending=by_bending,
    )


def _on_instants(start: Indices, end: Indices, value: Floats, samples: int) -> Floats:
    """Add ``value`` at the end and subtract it at the start of every cycle: the transpose of taking ranges."""
    return np.asarray(np.bincount(end, value, samples) - np.bincount(start, value, samples), dtype=np.float64)
