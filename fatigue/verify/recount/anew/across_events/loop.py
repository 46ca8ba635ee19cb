"""Cycles across events at a point: one run of a loop as if it were one more event, and the bound in any order."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from fatigue.verify.recount.anew.across_events.chain_rounding import Chained, chain_bounds, chain_cycle_bounds
from fatigue.verify.recount.anew.across_events.sequence import Net, net_cycles
from fatigue.verify.recount.anew.across_events.turns import Turns
from fatigue.verify.recount.anew.across_events.unknown_order import open_and_closed, paired
from fatigue.verify.recount.anew.curve import RecountCurve
from fatigue.verify.recount.anew.mean_stress import MeanStress, stress_ratio, stress_ratios
from fatigue.verify.recount.anew.point import OnePass, RecountPoint, Values

Floats = NDArray[np.float64]
Counts = NDArray[np.int64]


def loop_pass(
    point: RecountPoint, order: Sequence[int], passes: Sequence[OnePass], mean_stress: MeanStress
) -> tuple[OnePass, Net]:
    """One run of a loop at a point beyond its events by themselves; quantities that it does not have are NaN.

    ``passes`` are those of all events by number, with their turning points.
    """
    turns = {event: one for event in order if (one := passes[event].turns) is not None}
    net, curve, size = net_cycles(order, turns), point.curve, point.size
    n = net.count
    s = net.stress
    rows, f_M = cycles_between(net, net.start, net.end), mean_stress.factor(s[net.start], s[net.end])
    x = _equivalent(rows, size, curve)
    dS = x / f_M if mean_stress.counts else x
    closing = cycles_between(net, *net.closing)
    S_closing, dS_closing = closing["range_MPa"], _equivalent(closing, size, curve)
    if mean_stress.counts:
        dS_closing = dS_closing / mean_stress.factor(*s[net.closing])
    damage, k = curve.damage(dS), curve.slopes[0]
    top = s[net.closing[:, S_closing.argmax()]] if len(S_closing) else np.zeros(0)
    values: Values = dict.fromkeys(passes[0].quantities, np.nan)
    values |= {
        "damage_per_pass": float(n @ damage),
        "cycles_per_pass": float(n.sum()),
        "max_range_MPa": float(S_closing.max(initial=0.0)),
        "max_equivalent_range_dS": float(dS_closing.max(initial=0.0)),
        "power_sum": float(n @ rows["range_MPa"] ** k),
        "R_largest": stress_ratio(*top.tolist()) if len(top) else np.nan,
        "with_mean_stress": float(n @ curve.damage(x / f_M)) if mean_stress.is_known(curve) else np.nan,
        "with_shear": np.nan,  # what shear adds to a cycle between two events is not known
    }
    rows |= {"count": n, "equivalent_range_dS": dS, "damage": n * damage}
    delta = max(passes[event].cycle_bounds["delta_level"] for event in turns)
    chained = Chained(
        delta=delta,
        stress=s,
        ranges=rows["range_MPa"],
        equivalent=dS,
        counts=n,
        R=stress_ratios(*s[net.closing[:, S_closing >= S_closing.max(initial=0.0) - 4.0 * delta]]),
        of_events=sum(passes[event].quantities["damage_per_pass"] for event in order),
        size=size,
        mean_stress=mean_stress.counts,
    )
    kept = slice(0) if curve.is_straight and not mean_stress.counts else slice(None)
    low, high = np.minimum(s[net.start], s[net.end]), np.maximum(s[net.start], s[net.end])
    bounds = dict.fromkeys(passes[0].bounds, 0.0) | chain_bounds(
        chained, values["damage_per_pass"], values["max_range_MPa"], values["R_largest"], curve
    )
    return OnePass(values, x[kept], n[kept], low[kept], high[kept], rows, bounds, chain_cycle_bounds(chained)), net


def cycles_between(turns: Turns | Net, start: Counts, end: Counts) -> dict[str, Floats]:
    """Columns of the cycles between some turning points."""
    i, j, s = start, end, turns.stress
    dm, db = np.abs(turns.membrane[j] - turns.membrane[i]), np.abs(turns.bending[j] - turns.bending[i])
    return {
        "start_s": turns.time[i],
        "end_s": turns.time[j],
        "range_MPa": np.abs(s[j] - s[i]),
        "mean_MPa": (s[i] + s[j]) / 2,
        "membrane_range_MPa": dm,
        "bending_range_MPa": db,
        "bending_ratio": np.divide(db, dm + db, out=np.zeros_like(db), where=dm + db > 0),
    }


def bound_per_km(
    point: RecountPoint, stints: Mapping[int, float], passes: Sequence[OnePass], mean_stress: MeanStress
) -> float:
    """What cycles across events add at most per km in any order, where events occur in so many stints per km.

    Paired ranges are taken for pure membrane stress and on the first slope: the damage is convex in them then. Where
    the mean stress counts, each of them may reach up to the highest stress of all.
    """
    curve, size = point.curve, point.size
    residues, replaced = [], 0.0
    for event, per_km in stints.items():
        turns = passes[event].turns
        assert turns is not None
        open_, closed = open_and_closed(turns)
        rows, s = cycles_between(turns, closed.start, closed.end), turns.stress
        dS = _equivalent(rows, size, curve)
        if mean_stress.counts:
            dS = dS / mean_stress.factor(s[closed.start], s[closed.end])
        residues.append(s[open_])
        replaced += per_km * (passes[event].quantities["damage_per_pass"] - float(curve.damage(dS).sum()))
    ranges, counts = paired(residues, list(stints.values()))
    dS = ranges * size / curve.bending_factor(np.zeros(1))
    if mean_stress.counts:
        dS = dS / mean_stress.least_factor(ranges, max(residue.max() for residue in residues))
    return float(counts @ curve.convex_damage(dS)) - replaced


def _equivalent(rows: Mapping[str, Floats], size: float, curve: RecountCurve) -> Floats:
    """Equivalent range of cycles without mean stress, (c,)."""
    f_R = curve.stress_ratio_factor(*(rows["mean_MPa"] + sign * rows["range_MPa"] / 2.0 for sign in (-1.0, 1.0)))
    return np.asarray(rows["range_MPa"] * size / curve.bending_factor(rows["bending_ratio"]) / f_R)
