"""Warnings of records that are sampled too coarsely for the points of the body, with the damage that hides."""

from collections.abc import Mapping, Sequence

import numpy as np

from fatigue.errors import Problem
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.mission.record_units import FEWEST_SAMPLES
from fatigue.pipeline.solve.body import Body
from fatigue.spectrum.trust import (
    FEW_SAMPLES_PER_PEAK,
    FEWEST_SAMPLES_PER_PEAK,
    sampling_loss,
    vertex_sampling_loss,
)


def sampling_warnings(body: Body, loads: Sequence[EventLoad], samples_per_peak: Mapping[str, float]) -> list[Problem]:
    """Warnings of the events whose fastest point has too few ``samples_per_peak``, as they are counted.

    Reversals at vertices need fewer. Where the program chooses the upsampling, there are no such events: what it counts
    as it is are load cases, not samples.
    """
    slope = max(float(rated.rule.law.slopes[0]) for rated in body.curves.values())
    warnings = []
    for load in loads:
        event, samples = load.counted.event, samples_per_peak[load.counted.event]
        is_listed = body.case.counting.upsample == "auto" and load.counted.q.shape[1] < FEWEST_SAMPLES
        if samples >= (FEWEST_SAMPLES_PER_PEAK if load.vertex else FEW_SAMPLES_PER_PEAK) or is_listed:
            continue
        low = 100 * float((vertex_sampling_loss if load.vertex else sampling_loss)(np.array(samples), slope))
        what = f"{samples:.1f} samples per peak at the fastest point, damage there is about {low:.0f} % low"
        remedy = 'Set upsample = "auto" in [counting], or sample the simulation more finely'
        warnings.append(Problem("sampling", f"event '{event}'", what, remedy))
    return warnings
