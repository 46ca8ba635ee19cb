"""How much the damage of a point scatters with its records, and why that may not be known.

Events of which it is not known have reasons of their own: a record too short to know its scatter from, or an event
counted by number, which is one manoeuvre and no stretch of track; and so have cycles across events, which no piece of a
record holds. As long as all of them together have no more than ``MINOR`` of the damage, each is taken to scatter by the
whole of its damage, and the band stands. From there on there is none.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.life.band.load import LoadScatter, mission_scatter, record_error
from fatigue.life.mission import Plan
from fatigue.pipeline.life_band.points import BandPoint
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.spectrum.trust import record_scatter

Floats = NDArray[np.float64]

MINOR = 0.05  # of the damage: scattering by all of it, it makes 5 % of the standard error
OF_OTHER_CYCLES = 1e-3  # damage above that of the cycles of the normal stress, by which another sum has decided

REASONS = ("", "screened", "no_damage", "shear", "short_record", "single_pass", "across_events", "non_stationary")
_NONE, _SCREENED, _NO_DAMAGE, _SHEAR, _SHORT, _SINGLE, _ACROSS, _MODULATED = range(len(REASONS))
WITH_BAND = ("", "non_stationary")


@dataclass(frozen=True, slots=True, eq=False)
class CountedPieces:
    """Damage of n points in one pass of e events, in ``pieces`` (n, e, p), and what l ``loops`` (n, l) add in one run.

    ``slope`` (n,) is k where the damage of each point is done.
    """

    pieces: Floats
    loops: Floats
    slope: Floats


def load_scatter(
    points: Sequence[BandPoint], counted: CountedPieces, loads: Sequence[EventLoad], plan: Plan
) -> tuple[LoadScatter, NDArray[np.intp]]:
    """Scatter of the damage per km of some points (n,), and why it is none: index into ``REASONS`` (n,).

    ``non_stationary`` is no such reason: the scatter is there, and at least so large.
    """
    events = len(loads)
    weights = plan.weights
    per_km = np.concatenate([counted.pieces.sum(axis=2), counted.loops], axis=1).T * weights[:, None]
    total = per_km.sum(axis=0)
    share = np.divide(per_km, total, out=np.zeros_like(per_km), where=total > 0.0)
    cause, modulated = _causes(points, counted, loads, plan)
    error = np.ones_like(share)
    known = cause == _NONE
    error[known] = np.concatenate([record_error(counted.pieces).T, np.zeros((len(plan.loops), len(points)))])[known]
    unknown = np.stack([np.abs(np.where(cause == why, share, 0.0)).sum(axis=0) for why in (_SHORT, _SINGLE, _ACROSS)])
    reason = np.where(
        unknown.sum(axis=0) > MINOR,
        _SHORT + unknown.argmax(axis=0),
        np.where(np.where(modulated, share[:events], 0.0).sum(axis=0) > MINOR, _MODULATED, _NONE),
    )
    assessed = np.array([point.damage_per_km for point in points])
    reason[assessed > (1.0 + OF_OTHER_CYCLES) * total] = _SHEAR
    reason[~(total > 0.0)] = _NO_DAMAGE
    reason[[point.is_bound for point in points]] = _SCREENED
    return mission_scatter(share, error), reason


def _causes(
    points: Sequence[BandPoint], counted: CountedPieces, loads: Sequence[EventLoad], plan: Plan
) -> tuple[NDArray[np.intp], NDArray[np.bool_]]:
    """Why the scatter of each event and each loop behind them is not known (e + l, n); events not stationary (e, n)."""
    cause = np.full((len(loads) + len(plan.loops), len(points)), _ACROSS)
    modulated = np.zeros((len(loads), len(points)), np.bool_)
    stress = np.stack([point.stress for point in points])
    for event, (load, one) in enumerate(zip(loads, plan.passes, strict=True)):
        if one.length is None:
            cause[event] = _SINGLE
        elif load.trust is None:
            cause[event] = _SHORT
        else:
            found = record_scatter(load.stress_factor * stress, load.trust, counted.slope)
            cause[event] = np.where(found.record_too_short, _SHORT, _NONE)
            modulated[event] = found.is_modulated & ~found.record_too_short
    return cause, modulated
