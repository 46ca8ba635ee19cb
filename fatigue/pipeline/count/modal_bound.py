"""The first tier of bounds: from how far and how much each modal coordinate moves, without a loop over time."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from fatigue.life.bounds.forms import face_forms, part_forms
from fatigue.life.bounds.screening import ModalExtent, extent_bound
from fatigue.pipeline.count.block import Block
from fatigue.pipeline.count.bounds import Bound, Bounds, Screening, event_bound, utilisation
from fatigue.pipeline.count.estimate import Estimate, estimate_event, mean_stress, member_variances
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
    for load, extent in zip(block.loads, screening.extents, strict=True):
        with no_overflow(load.counted.event, block.welds):
            forms = part_forms(stress.membrane, stress.bending, extent.products)
            variances = member_variances(stress, load) if load.is_upsampled else forms[0, :, :2]
            estimates += (estimate_event(stress, load, variances),)
            found.append(_bound(stress, load, extent, forms[..., 2:], estimates[-1].mean))
    return estimates, Bounds(found, block.plan, block.toe, np.zeros((len(block), 1)), screening)


def without_small_raw_ends(block: Block, screening: Screening) -> Block:
    """The same block; raw ends that are proven to stay below the share as well do not matter in it."""
    ends = block.stress.raw_ends
    if not ends.rows.size:
        return block
    raw = replace(block.stress.at(ends.rows), membrane=ends.stress.membrane, bending=ends.stress.bending)
    bounds = []
    for load, extent in zip(block.loads, screening.extents, strict=True):
        with no_overflow(load.counted.event, block.welds):
            forms = face_forms(raw.membrane, raw.bending, extent.products)
            bounds.append(_bound(raw, load, extent, forms, mean_stress(raw, load)))
    matters = np.asarray((utilisation(bounds, block.plan) >= screening.share).any(axis=1))
    return replace(block, stress=replace(block.stress, raw_end_matters=matters))


def _bound(
    stress: ModalStress,
    load: EventLoad,
    extent: ModalExtent,
    forms: NDArray[np.float64],
    mean: NDArray[np.float64],
) -> Bound:
    """Bound of an event from the mean stress (n, 2) and the forms (2, n, 2) that ``extent_bound`` wants."""
    found = extent_bound(stress.membrane, stress.bending, forms, extent)
    return event_bound(found, stress, slice(None), load, mean)
