"""The first tier of bounds: from how far and how much each modal coordinate moves, without a loop over time."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from fatigue.life.bounds.forms import face_forms, part_forms
from fatigue.life.bounds.screening import PowerSums, extent_bound
from fatigue.life.mission import Plan
from fatigue.pipeline.count.block import Block
from fatigue.pipeline.count.bounds import Bound, Bounds, Screening, event_bound, first_slope_bound, utilisation
from fatigue.pipeline.count.estimate import Estimate, estimate_event, mean_stress, member_variances
from fatigue.pipeline.count.joined.junctions import Junctions
from fatigue.pipeline.count.overflow import no_overflow
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.solve.modal_stress import ModalStress


def estimated_and_bounded(block: Block, screening: Screening) -> tuple[tuple[Estimate, ...], Bounds]:
    """Estimate and bound of every event at all stations of a block.

    Both need variances. The variances are worked out once, unless the two are of different samples.
    """
    stress = block.stress
    estimates: tuple[Estimate, ...] = ()
    found: list[Bound] = []
    first_slopes: list[NDArray[np.float64]] = []
    for load, extent in zip(block.loads, screening.extents, strict=True):
        with no_overflow(load.counted.event, block.welds):
            forms = part_forms(stress.membrane, stress.bending, extent.products)
            variances = member_variances(stress, load) if load.is_upsampled else forms[0, :, :2]
            estimates += (estimate_event(stress, load, variances),)
            limits = extent_bound(stress.membrane, stress.bending, forms[..., 2:], extent)
            found.append(event_bound(limits, stress, slice(None), load, estimates[-1].mean))
            first_slopes += _first_slopes(limits, stress, load, block.plan)
    junctions = _junctions(stress, [estimate.mean for estimate in estimates], first_slopes, block.plan)
    return estimates, Bounds(found, block.plan, block.toe, np.zeros((len(block), 1)), screening, junctions)


def without_small_raw_ends(block: Block, screening: Screening) -> Block:
    """The same block; raw ends that are proven to stay below the share as well do not matter in it."""
    if not block.stress.raw_ends.rows.size:
        return block
    matters = np.asarray((bounded_raw_ends(block, screening) >= screening.share).any(axis=1))
    return replace(block, stress=replace(block.stress, raw_end_matters=matters))


def bounded_raw_ends(block: Block, screening: Screening) -> NDArray[np.float64]:
    """Largest share of the damage limit (e, 2) that the whole mission can use up at the raw ends of a block."""
    ends = block.stress.raw_ends
    raw = replace(block.stress.at(ends.rows), membrane=ends.stress.membrane, bending=ends.stress.bending)
    bounds: list[Bound] = []
    means: list[NDArray[np.float64]] = []
    first_slopes: list[NDArray[np.float64]] = []
    for load, extent in zip(block.loads, screening.extents, strict=True):
        with no_overflow(load.counted.event, block.welds):
            forms = face_forms(raw.membrane, raw.bending, extent.products)
            limits = extent_bound(raw.membrane, raw.bending, forms, extent)
            means.append(mean_stress(raw, load))
            bounds.append(event_bound(limits, raw, slice(None), load, means[-1]))
            first_slopes += _first_slopes(limits, raw, load, block.plan)
    junctions = _junctions(raw, means, first_slopes, block.plan)
    return utilisation(bounds, block.plan, junctions=junctions)


def _first_slopes(
    limits: tuple[NDArray[np.float64], PowerSums], stress: ModalStress, load: EventLoad, plan: Plan
) -> list[NDArray[np.float64]]:
    """The bound that junctions want of an event on a curve of several slopes or allowances; else none."""
    rule = stress.rule  # what is counted with allowances of a cycle is no bound of the same cycles in another order
    wanted = plan.joins_events and not (rule.law.is_straight and rule.is_of_range_alone)
    return [first_slope_bound(limits, stress, load)] if wanted else []


def _junctions(
    stress: ModalStress, means: list[NDArray[np.float64]], first_slopes: list[NDArray[np.float64]], plan: Plan
) -> Junctions | None:
    """Where the events of a mission meet; None where they stay apart."""
    return Junctions.of(stress, means, first_slopes) if plan.joins_events else None
