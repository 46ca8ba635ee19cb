"""Whether the spectra of a case would miss too much of its stress: seen on few welds and the beginnings of records."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from fatigue.errors import Problem
from fatigue.life.mission import Plan
from fatigue.pipeline.count.estimate import estimate_event, member_variances
from fatigue.pipeline.count.outside_band import OutsideBand, Spectral
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.mission.events import load_of, shortened_record
from fatigue.pipeline.solve.body import Body
from fatigue.pipeline.solve.model import Model
from fatigue.pipeline.solve.stations import modal_stress
from fatigue.spectrum.outside import missed_damage
from fatigue.spectrum.trust import missed_limit

READ_AT_MOST = 5e6  # numbers in all records that are looked at, beside the longest: about a second
BEGINNING = 16_384  # samples of a record that are looked at


def band_warnings(model: Model, plan: Plan, scratch: Path) -> list[Problem]:
    """One warning where the spectra miss too much of the damage at the toes of a group of welds, else none.

    The longest record is looked at, the others as far as ``READ_AT_MOST`` allows; ``scratch`` is a folder.
    """
    spectra: dict[str, Spectral] = {}
    upper_hz: dict[str, float] = {}
    for number, load in beginnings(model.body, plan, scratch):
        if load.moments is not None:
            one = plan.passes[number]
            spectra[one.event] = _spectral(model, load, one.passes_per_km * one.samples / load.counted.q.shape[1])
            upper_hz[one.event] = load.moments.upper_hz
    if not spectra:
        return []
    band, whole = (sum(of.weight * getattr(of, name) for of in spectra.values()) for name in ("band", "whole"))
    slopes = np.array([rated.rule.law.slopes[0] for rated in model.curve_of_weld])
    limits = np.array([missed_limit(slope) for slope in slopes])[model.stations.weld]
    found = OutsideBand()
    found.add(model.stations, missed_damage(band, whole) > limits[:, None], spectra)
    return found.warnings(upper_hz, "toe points looked at")


def beginnings(body: Body, plan: Plan, scratch: Path) -> Iterator[tuple[int, EventLoad]]:
    """Numbers of the events that are looked at, and each of them by the first samples of its record."""
    for number in _looked_at(body, plan):
        with threadpool_limits(limits=1, user_api="blas"):
            load = _beginning(body, number, scratch)
        yield number, load


def _looked_at(body: Body, plan: Plan) -> list[int]:
    """Numbers of the events that are looked at: the longest, and the shortest of the others."""
    numbers = len(body.coordinates) * np.array([one.samples for one in plan.passes])
    *others, longest = np.argsort(numbers, kind="stable").tolist()
    cheap = np.cumsum(numbers[others]) <= READ_AT_MOST
    return sorted([longest, *np.array(others, dtype=int)[cheap].tolist()])


def _beginning(body: Body, number: int, scratch: Path) -> EventLoad:
    """An event by the first samples of its record."""
    event = body.case.mission.event[number]
    history = shortened_record(body, event, BEGINNING, scratch)
    return load_of(body, event, history, 1, single=False)


def _spectral(model: Model, load: EventLoad, weight: float) -> Spectral:
    """What the spectrum of an event says of the stations of the group, curve by curve."""
    stations = model.stations
    found: NDArray[np.float64] = np.full((3, len(stations), 2), np.nan)
    for rated, rows in model.by_curve():
        stress = modal_stress(stations, rows, rated)
        of = estimate_event(stress, load, member_variances(stress, load))
        found[:, rows] = of.tb, of.tb_whole, of.outside_share
    return Spectral(weight, *found)
