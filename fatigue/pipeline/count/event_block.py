"""One pass of one event at a block of stations: cycles counted, or bounds in their place, beside the estimate."""

from dataclasses import dataclass, replace
from typing import NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from fatigue.life.counting.block import BlockCount, BlockStress
from fatigue.life.counting.count import count, count_and_residue
from fatigue.life.rule import CycleRule, cycle_damage
from fatigue.life.shear import shear_factor
from fatigue.pipeline.count.bounds import Bound
from fatigue.pipeline.count.estimate import Estimate
from fatigue.pipeline.count.joined.loops import PassResidue, pass_residue
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.mission.offsets import face_offset
from fatigue.pipeline.solve.modal_stress import ModalStress, faces
from fatigue.quotient import quotient
from fatigue.spectrum.outside import missed_damage
from fatigue.spectrum.trust import VERDICTS, judge
from fatigue.weld.structural_stress import RawEnds


class _Variances(NamedTuple):
    """Variances of normal stress and shear, and ``both``, their covariance, (n, 2) [MPa^2]; bending ratios (n, 1)."""

    normal: NDArray[np.float64]
    shear: NDArray[np.float64]
    both: NDArray[np.float64]
    bending_ratio: NDArray[np.float64]
    shear_bending_ratio: NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class EventBlock:
    """One pass of one event at a block of stations; every array is (n, 2): top and bottom face.

    Attributes
    ----------
    estimate : the pass in the frequency domain
    count : its cycles; where bounds stand for them, what only cycles could tell is NaN
    damage_shear : Miner sum with the shear counted with the normal stress
    shear_ratio : standard deviation of the shear over the standard deviation of the normal stress
    damage_raw_end : Miner sum without the end treatment, NaN where that was not counted
    verdict : index into ``VERDICTS``
    residue, residue_raw_end : what is open at its end, with and without the end treatment; None where no events join
    """

    estimate: Estimate
    count: BlockCount
    damage_shear: NDArray[np.float64]
    shear_ratio: NDArray[np.float64]
    damage_raw_end: NDArray[np.float64]
    verdict: NDArray[np.int8]
    residue: PassResidue | None = None
    residue_raw_end: PassResidue | None = None

    def at(self, rows: NDArray[np.intp]) -> Self:
        """Take some stations."""
        return type(self)(
            estimate=self.estimate.at(rows),
            count=self.count.at(rows),
            damage_shear=self.damage_shear[rows],
            shear_ratio=self.shear_ratio[rows],
            damage_raw_end=self.damage_raw_end[rows],
            verdict=self.verdict[rows],
            residue=None if self.residue is None else self.residue.at(rows),
            residue_raw_end=None if self.residue_raw_end is None else self.residue_raw_end.at(rows),
        )

    @property
    def residues(self) -> tuple[PassResidue, PassResidue]:
        """Residue of the pass with treated ends and with raw ones; without a reversal where it joins no other event."""
        nothing = PassResidue.nothing(len(self.verdict))
        return self.residue or nothing, self.residue_raw_end or nothing

    def without_histogram(self) -> Self:
        """The same without histogram and residues, which are larger than all else and serve the whole mission only."""
        nothing = np.zeros((*self.verdict.shape, 0, 2))
        count = replace(self.count, histogram=nothing)
        return replace(self, count=count, residue=None, residue_raw_end=None)


def count_event(stress: ModalStress, load: EventLoad, estimate: Estimate, *, joins: bool = False) -> EventBlock:
    """One pass of an event counted at every station of a block; ``judged`` gives the verdict.

    The residues of a pass are kept where it ``joins`` other events. The equivalent range of a cycle has the bending
    ratio of this cycle (ASME VIII-2 5.5.5).
    """
    of_stress = _variances(stress, load)
    var, shear_var, rule = of_stress.normal, of_stress.shear, stress.rule
    with_shear = _with_shear(rule, estimate.one_ratio, of_stress)
    counted, damage_raw_end, residues = _counted(stress, load, estimate.one_ratio, with_shear, joins=joins)
    damage_shear = counted.damage_with_shear
    if rule.law.is_straight:
        damage_shear = np.where(counted.damage > 0.0, counted.damage * with_shear ** rule.law.slopes[0], 0.0)
    return EventBlock(
        estimate=estimate,
        count=counted,
        damage_shear=damage_shear,
        shear_ratio=quotient(np.sqrt(shear_var), np.sqrt(var)),
        damage_raw_end=damage_raw_end,
        verdict=_not_assessed(var),
        residue=residues[0],
        residue_raw_end=residues[1],
    )


def factor_with_shear(stress: ModalStress, load: EventLoad) -> NDArray[np.float64]:
    """ASME factor (n, 2) on the equivalent range if shear counted; 1 where the normal stress is constant."""
    of_stress = _variances(stress, load)
    return _with_shear(stress.rule, of_stress.bending_ratio, of_stress)


def judged(event: EventBlock, stress: ModalStress, load: EventLoad) -> EventBlock:
    """The same event with its verdict: whether, by what was counted, the estimate may be trusted at each point."""
    if load.trust is None:
        return event
    law, both = stress.rule.law, load.stress_factor * faces(stress.membrane, stress.bending)
    counted, estimate = event.count, event.estimate
    same_ratio, damage = counted.damage_same_ratio.reshape(-1), counted.damage.reshape(-1)
    found = judge(
        both.reshape(-1, both.shape[-1]),
        estimate.moments.reshape(len(estimate.moments), -1),
        load.trust,
        slope=float(law.slopes[0]),
        dirlik_ratio=quotient(estimate.dirlik.reshape(-1), same_ratio),
        tb_ratio=quotient(estimate.tb.reshape(-1), same_ratio),
        kurtosis=counted.kurtosis.reshape(-1),
        top_cycle_share=quotient(cycle_damage(counted.max_equivalent_range.reshape(-1), law), damage),
        samples_per_peak=estimate.samples_per_peak.reshape(-1),
        top_mode_hz=load.top_mode_hz,
        outside_share=estimate.outside_share.reshape(-1),
        missed_damage=missed_damage(estimate.tb, estimate.tb_whole).reshape(-1),
    )
    return replace(event, verdict=found.verdict.reshape(event.verdict.shape))


def bounded_event(estimate: Estimate, bound: Bound, raw_ends: RawEnds) -> EventBlock:
    """One pass of an event with proven bounds in place of a count: damage and largest ranges are never larger."""
    unknown = np.full_like(bound.damage, np.nan)
    damage_raw_end = bound.damage.copy()
    damage_raw_end[raw_ends.rows] = np.nan
    return EventBlock(estimate, bound.as_count(), unknown, unknown, damage_raw_end, _not_assessed(unknown))


def _not_assessed(like: NDArray[np.float64]) -> NDArray[np.int8]:
    return np.full(like.shape, VERDICTS.index("not_assessed"), dtype=np.int8)


def _counted(
    stress: ModalStress,
    load: EventLoad,
    one_ratio: NDArray[np.float64],
    with_shear: NDArray[np.float64],
    *,
    joins: bool,
) -> tuple[BlockCount, NDArray[np.float64], tuple[PassResidue | None, PassResidue | None]]:
    """The count of a block, and its damage (n, 2) with raw ends in place of treated ones, NaN where they do not matter.

    The raw ends that matter are counted beside the block. The residues are those of treated ends and of raw ones.
    """
    n, ends, matters, f = len(stress), stress.raw_ends, stress.raw_end_matters, load.stress_factor
    rows = ends.rows[matters]
    membrane, bending = f * stress.membrane, f * stress.bending
    offset = face_offset(membrane, bending, load)
    block = BlockStress(membrane, bending, stress.size, one_ratio, with_shear, offset)
    if rows.size:
        membrane, bending = f * ends.stress.membrane[matters], f * ends.stress.bending[matters]
        own = stress.size[rows], one_ratio[rows], with_shear[rows], face_offset(membrane, bending, load)
        block = block.beside(BlockStress(membrane, bending, *own))
    residues: tuple[PassResidue | None, PassResidue | None] = (None, None)
    if joins:
        everything, residue = count_and_residue(block, load.record, stress.rule)
        of_all, with_raw_ends = pass_residue(residue, block, load), np.arange(n)
        with_raw_ends[rows] = n + np.arange(rows.size)
        residues = (of_all.at(slice(n)), of_all.at(with_raw_ends))
    else:
        everything = count(block, load.record, stress.rule)
    counted = everything.at(slice(n))
    damage_raw_end = counted.damage.copy()
    damage_raw_end[ends.rows] = np.nan
    damage_raw_end[rows] = everything.damage[n:]
    return counted, damage_raw_end, residues


def _with_shear(rule: CycleRule, one_ratio: NDArray[np.float64], of: _Variances) -> NDArray[np.float64]:
    """``shear_factor`` of both faces, each stress over its own ``I(r)^(1/m)``; ``one_ratio`` is of the normal stress.

    A stress whose variance vanishes has no cycles but those of rounding, and no factor: 1 stands for it.
    """
    I_s, I_t = rule.ratio_factor(one_ratio), rule.ratio_factor(of.shear_bending_ratio)
    return np.nan_to_num(shear_factor(of.normal / I_s**2, of.shear / I_t**2, of.both / (I_s * I_t)), nan=1.0)


def _variances(stress: ModalStress, load: EventLoad) -> _Variances:
    """Variances of normal stress and shear at some stations, the stress factor of the event included."""
    f = load.stress_factor
    S_m, S_b = f * stress.membrane, f * stress.bending
    S_s, S_t = f * stress.in_plane_shear, f * stress.twist_shear
    products = [S @ load.covariance for S in (S_m, S_b, S_s, S_t)]
    C_m, C_b, C_s, C_t = products
    normal, shear = faces(S_m, S_b), faces(S_s, S_t)
    normal_C, shear_C = faces(C_m, C_b), faces(C_s, C_t)
    std_m, std_b, std_s, std_t = (
        np.sqrt(np.maximum(_along_modes(C, S), 0.0)) for C, S in zip(products, (S_m, S_b, S_s, S_t), strict=True)
    )
    return _Variances(
        normal=np.maximum(_along_modes(normal_C, normal), 0.0),
        shear=np.maximum(_along_modes(shear_C, shear), 0.0),
        both=_along_modes(normal_C, shear),
        bending_ratio=np.nan_to_num(quotient(std_b, std_m + std_b))[:, None],
        shear_bending_ratio=np.nan_to_num(quotient(std_t, std_s + std_t))[:, None],
    )


def _along_modes(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray(np.einsum("...m,...m->...", a, b))
