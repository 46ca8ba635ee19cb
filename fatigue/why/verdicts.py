"""May the frequency domain be trusted, point by point and event by event: verdict, reason, and the ratio split."""

from dataclasses import dataclass, fields, replace
from functools import partial
from typing import Self

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.life.records.history import ModalHistory, stress_record
from fatigue.life.rule import CycleRule
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.solve.body import Body
from fatigue.quotient import quotient
from fatigue.spectrum.methods import dirlik_damage_rate
from fatigue.spectrum.moments import point_moments, segment_spectra
from fatigue.spectrum.outside import missed_damage
from fatigue.spectrum.reasons import reason
from fatigue.spectrum.stationarity import damage_rate_by_period
from fatigue.spectrum.surrogates import RatioSplit, explained_share, ratio_split
from fatigue.spectrum.trust import VERDICTS, Judgement, judge, trust_matrices
from fatigue.why.attribute import EventAttribution, count_credit
from fatigue.why.long_record import is_long
from fatigue.why.points import Points

Floats = NDArray[np.float64]

NO_SPECTRUM = "The record is shorter than one spectral segment, so there is no frequency-domain estimate to judge."
STATIC = "A static load case has no spectrum, so there is no frequency-domain estimate to judge."
MEASURED = tuple(
    field.name
    for field in fields(Judgement)
    if field.name not in {"verdict", "slope", "slow_hz", "upper_hz", "segments"}
)


@dataclass(frozen=True, slots=True, eq=False)
class EventVerdicts:
    """Verdicts on one event at p points; every array is (p,), NaN where a number could not be had.

    Attributes
    ----------
    event : name
    verdict, reason : one of ``fatigue.spectrum.trust.VERDICTS``, and the same in words with its numbers
    measured : the numbers of ``fatigue.spectrum.trust.Judgement`` by name
    segmentwise_ratio : Dirlik summed over the periods of the record, over rainflow; where the event is not stationary
    formula, process, standard_error : the split of Dirlik over rainflow, see ``RatioSplit``; where it was asked for
    explained : share of ln(process) that the modulation and the tones found explain
    """

    event: str
    verdict: NDArray[np.object_]
    reason: NDArray[np.object_]
    measured: dict[str, Floats]
    segmentwise_ratio: Floats
    formula: Floats
    process: Floats
    standard_error: Floats
    explained: Floats

    def of(self, index: NDArray[np.int64] | slice) -> Self:
        """The same of some of the points."""
        arrays = {f.name: getattr(self, f.name) for f in fields(self) if f.name not in {"event", "measured"}}
        measured = {name: values[index] for name, values in self.measured.items()}
        return replace(self, measured=measured, **{name: values[index] for name, values in arrays.items()})


def event_verdicts(
    body: Body,
    load: EventLoad,
    points: Points,
    attribution: EventAttribution,
    assessed: pd.DataFrame,
    split_at: NDArray[np.int64],
) -> EventVerdicts:
    """Verdicts on one event at some points.

    ``assessed`` has the rows of ``damage.parquet`` of these points in this event; ``split_at`` are the points whose
    ratio is split by counting Gaussian surrogates.
    """
    nothing = np.full(len(points), np.nan)
    is_static = any(e.name == attribution.event and e.history is None for e in body.case.mission.event)
    found = EventVerdicts(
        event=attribution.event,
        verdict=np.full(len(points), VERDICTS[0], dtype=object),
        reason=np.full(len(points), STATIC if is_static else NO_SPECTRUM, dtype=object),
        measured={name: nothing.copy() for name in MEASURED},
        segmentwise_ratio=nothing.copy(),
        formula=nothing.copy(),
        process=nothing.copy(),
        standard_error=nothing.copy(),
        explained=nothing.copy(),
    )
    if load.moments is None:
        return found

    spectra = segment_spectra(load.counted, body.case.spectrum.segment_s, load.moments.upper_hz)
    matrices = trust_matrices(load.counted, spectra)
    modal_stress = load.stress_factor * (points.membrane + points.side[:, None] * points.bending)
    one_ratio = _one_ratio_sizes(points, assessed)
    for law in {id(rule.law): rule.law for rule in points.rule}.values():
        at = np.flatnonzero([rule.law is law for rule in points.rule])
        here = assessed.iloc[at]
        same_ratio = here["damage_same_ratio_per_pass"].to_numpy()
        judgement = judge(
            modal_stress[at],
            point_moments(modal_stress[at], load.moments),
            matrices,
            slope=_slope_of_damage(attribution, at, float(law.slopes[0])),
            dirlik_ratio=quotient(here["damage_dirlik_per_pass"].to_numpy(), same_ratio),
            tb_ratio=quotient(here["damage_tb_per_pass"].to_numpy(), same_ratio),
            kurtosis=here["kurtosis"].to_numpy(),
            top_cycle_share=attribution.top_cycle_share[at],
            samples_per_peak=here["samples_per_peak"].to_numpy(),
            top_mode_hz=load.top_mode_hz,
            outside_share=here["outside_share"].to_numpy(),
            missed_damage=missed_damage(
                here["damage_tb_per_pass"].to_numpy(), here["damage_tb_whole_per_pass"].to_numpy()
            ),
        )
        found.verdict[at] = np.array(VERDICTS, dtype=object)[judgement.verdict]
        found.reason[at] = [reason(judgement, i) for i in range(len(at))]
        for name in MEASURED:
            found.measured[name][at] = getattr(judgement, name)
        changing = at[found.verdict[at] == "non_stationary"]
        rate = damage_rate_by_period(
            modal_stress[changing] * one_ratio[changing, None], spectra, partial(dirlik_damage_rate, law=law)
        )
        counted = assessed["damage_same_ratio_per_pass"].to_numpy()[changing]
        found.segmentwise_ratio[changing] = quotient(load.duration * rate, counted)

    counted = assessed["damage_same_ratio_per_pass"].to_numpy()
    in_band = found.verdict != "outside_band"  # else the split would blame the formula for what it was never given
    damaged = split_at[(counted > 0.0)[split_at] & in_band[split_at]]
    if len(damaged):
        split = _split(
            load, points.of(damaged), one_ratio[damaged], assessed.iloc[damaged], body.case.spectrum.segment_s
        )
        found.formula[damaged], found.process[damaged] = split.formula, split.process
        found.standard_error[damaged] = split.standard_error
        factors = found.measured["modulation_factor"][damaged] * found.measured["line_factor"][damaged]
        found.explained[damaged] = explained_share(split, factors)
    return found


def _split(load: EventLoad, points: Points, size: Floats, assessed: pd.DataFrame, segment_s: float) -> RatioSplit:
    """Dirlik over rainflow split at some points by Gaussian surrogates of the event.

    ``size`` (p,) contains the one bending ratio of the event. Surrogates are made of the few stresses, not of the many
    modal coordinates: both have the same spectra.
    """
    modal_stress = load.stress_factor * (points.membrane + points.side[:, None] * points.bending)
    q = load.counted.q
    stress = stress_record(modal_stress, q) if is_long(q) else modal_stress @ np.asarray(q)
    stresses = replace(load.counted, mode=np.arange(len(modal_stress)), q=stress)

    rules = [CycleRule(rule.law, uses_bending_ratio=False) for rule in points.rule]

    def damage_rate(surrogate: ModalHistory) -> Floats:
        nothing = np.zeros(surrogate.q.shape[1])  # with one bending ratio only the sum of membrane and bending counts
        counted = [
            count_credit(s, nothing, 1.0, factor, rule, "repeat", vertex=load.vertex)
            for s, factor, rule in zip(np.asarray(surrogate.q), size, rules, strict=True)
        ]
        return np.array([c.damage for c in counted]) / surrogate.duration

    return ratio_split(
        stresses,
        damage_rate,
        dirlik_rate=assessed["damage_dirlik_per_pass"].to_numpy() / load.duration,
        rainflow_rate=assessed["damage_same_ratio_per_pass"].to_numpy() / load.duration,
        segment_s=segment_s,
    )


def _one_ratio_sizes(points: Points, assessed: pd.DataFrame) -> Floats:
    """Factors of the thickness over the factor of one bending ratio of the event, in place of one of each cycle."""
    ratios, I = np.nan_to_num(assessed["bending_ratio"].to_numpy()), np.ones(len(points))  # noqa: E741 - as in the standard
    for rule in {id(rule): rule for rule in points.rule}.values():
        at = np.flatnonzero([other is rule for other in points.rule])
        I[at] = rule.ratio_factor(ratios[at])
    return points.size / I


def _slope_of_damage(attribution: EventAttribution, at: NDArray[np.int64], otherwise: float) -> float:
    """Slope k on which most points have their damage."""
    damage, slope = attribution.damage[at], attribution.load_slope[at]
    return float(np.median(slope[damage > 0.0] / damage[damage > 0.0])) if (damage > 0.0).any() else otherwise
