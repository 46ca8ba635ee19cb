"""Whether the mean of q holds the dead load already, which a unit load gives a second time: event by event.

A simulation that starts at rest under gravity has its static deflection in the mean of q, one about the deflected state
has not. Nothing in a record says which. So the stress of the mean of q, a, is compared with the stress of the gravity
load at 1, g, over all stations, membrane and bending stress alike:

    beta = a.g / g.g        cos = a.g / (|a| |g|)

All welds are solved once for it, group after group; without a gravity load nothing is done.
"""

from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from functools import partial
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from fatigue.case import MeanOfQ
from fatigue.errors import CaseError, Problem, refuse
from fatigue.pipeline.mission.offsets import MeanLevel
from fatigue.pipeline.solve.body import Body
from fatigue.pipeline.solve.model import solve_group
from fatigue.pipeline.solve.weld_groups import WeldGroups
from fatigue.shown import few, shortened
from fatigue.side_by_side import in_order

Floats = NDArray[np.float64]
Verdict = Literal["absent", "unclear", "contained", "reversed", "units"]

NOTHING = 0.01  # of |g|: a mean of q below it holds no dead load
OTHER_SHAPE = 0.5  # cosine below which the mean of q is something else
SAME_SHAPE = 0.9  # cosine from which it is the dead load; between the two a short modal basis lacks its shape
ONCE = (0.5, 1.5)  # factors of a dead load that is there once
NOT_A_SWING = 0.5  # mean over time from which a gravity load given over time is a dead load, too


@dataclass(frozen=True, slots=True)
class HeldGravity:
    """What the mean of q of one event holds of the dead load, and what the gravity load gives on top.

    Attributes
    ----------
    event, unit_load : names of the event and of the gravity load
    mean_of_q : keep or remove
    beta, cos : factor and cosine of the module; NaN where the gravity load or the mean of q makes no stress
    verdict : absent, unclear, contained, reversed, or units: the same shape with another factor
    given : what the event gives of the gravity load, its constant and its mean over time
    is_on_top : whether that is a dead load
    """

    event: str
    unit_load: str
    mean_of_q: MeanOfQ
    beta: float
    cos: float
    verdict: Verdict
    given: float
    is_on_top: bool

    @property
    def in_words(self) -> str:
        """What is in the mean of q, and what becomes of it."""
        words = {
            "absent": "not in the mean of q",
            "unclear": "unclear whether in the mean of q",
            "contained": "in the mean of q",
            "reversed": "in the mean of q, reversed",
            "units": "in the mean of q, in other units",
        }[self.verdict]
        return words + (", which is removed" if self.mean_of_q == "remove" else "") + f", {self.given:g} given"

    def as_record(self) -> dict[str, Any]:
        """The same for machines; null for what is not known."""
        unknown = {name: None for name in ("beta", "cos") if np.isnan(getattr(self, name))}
        return asdict(self) | unknown

    @property
    def from_q(self) -> float:
        """Times that the level of the event holds the dead load by its q; NaN where nobody knows."""
        held = {"absent": 0.0, "contained": 1.0, "reversed": -1.0}
        return 0.0 if self.mean_of_q == "remove" else held.get(self.verdict, np.nan)

    @property
    def is_twice(self) -> bool:
        """Whether the dead load is in the mean of q and given on top."""
        return self.verdict == "contained" and self.is_on_top and self.mean_of_q == "keep"


def gravity_audit(
    groups: WeldGroups, levels: Sequence[MeanLevel], threads: int | None = None
) -> tuple[tuple[HeldGravity, ...], list[Problem]]:
    """What the mean of q of every event holds of the dead load, and the warnings about it.

    Raises
    ------
    CaseError : the dead load is there twice, or comes and goes in a sequence by the mean of q alone
    """
    case = groups.body.case
    found = held_gravity(groups, levels, threads)
    refuse(CaseError, gravity_problems(found, [sequence.order for sequence in case.mission.sequence], case.path.name))
    return found, gravity_warnings(found, case.path.name)


def held_gravity(
    groups: WeldGroups, levels: Sequence[MeanLevel], threads: int | None = None
) -> tuple[HeldGravity, ...]:
    """What the mean of q of every event holds of the dead load; nothing for a body without a gravity load.

    ``threads`` solve a group of welds each, by default one per processor core.
    """
    body = groups.body
    if not has_gravity(body):
        return ()
    name = next(load.name for load in body.case.body.unit_load if load.role == "gravity")
    coordinates = body.coordinates
    at = coordinates.unit_load.index(name)
    means = np.stack([np.where(coordinates.is_mode, level.mean, 0.0) for level in levels], axis=1)
    unit = np.eye(len(coordinates))[:, at : at + 1]
    of_groups = in_order(partial(_products, groups, np.hstack([means, unit])), range(len(groups)), threads)
    sums = np.sum(of_groups, axis=0)
    found = []
    for event, level in enumerate(levels):
        constant, mean = float(level.constant[at]), float(level.mean[at])
        of_event = sums[np.ix_([event, -1], [event, -1])]
        (aa, ag), (_, gg) = of_event.tolist()
        beta, cos, verdict = verdict_of(aa, ag, gg, constant + mean)
        is_on_top = constant != 0.0 or abs(mean) >= NOT_A_SWING
        own = level.event, name, level.mean_of_q
        found.append(HeldGravity(*own, beta, cos, verdict, constant + mean, is_on_top))
    return tuple(found)


def has_gravity(body: Body) -> bool:
    """Whether a unit load of the body is its dead load."""
    return any(load.role == "gravity" for load in body.case.body.unit_load)


def verdict_of(aa: float, ag: float, gg: float, given: float = 0.0) -> tuple[float, float, Verdict]:
    """beta, cos and verdict of the products a.a, a.g and g.g.

    A gravity load whose unit is not g is ``given`` at its dead load, 9.81 m/s2 or -1: a mean of q that holds as much
    contains it all the same.
    """
    if gg == 0.0 or aa == 0.0:
        return (np.nan if gg == 0.0 else 0.0), np.nan, "absent"
    beta, cos = ag / gg, ag / np.sqrt(aa * gg)
    if np.sqrt(aa) < NOTHING * np.sqrt(gg) or abs(cos) < OTHER_SHAPE:
        return beta, cos, "absent"
    if abs(cos) < SAME_SHAPE:
        return beta, cos, "unclear"
    if _is_once(beta) or (given != 0.0 and _is_once(beta / given)):
        return beta, cos, "contained"
    return beta, cos, "reversed" if _is_once(-beta) else "units"


def gravity_problems(found: Sequence[HeldGravity], sequences: Sequence[Sequence[str]], case_file: str) -> list[Problem]:
    """Refusals: a dead load that is there twice, and one that comes and goes in a sequence of events by its q alone."""
    return [*_twice(found, case_file), *_differing(found, sequences, case_file)]


def gravity_warnings(found: Sequence[HeldGravity], case_file: str) -> list[Problem]:
    """Warnings about dead loads in the mean of q that nobody can tell, or that are of another sign or unit."""
    doubtful = [one for one in found if one.verdict == "unclear" and one.is_on_top and one.mean_of_q == "keep"]
    warnings: list[Problem] = []
    if doubtful:
        worst = max(doubtful, key=lambda one: abs(one.cos))
        what = (
            f"the mean of q makes a stress partly like that of {worst.unit_load} "
            f"(cosine {worst.cos:.2f}, {OTHER_SHAPE:g} to {SAME_SHAPE:g} is unclear; {worst.beta:.2f} times as much), "
            f"which is given on top: the dead load may be there twice{_likewise(doubtful, worst)}"
        )
        remedy = 'Set mean_of_q = "remove" if the simulation runs under gravity; a short modal basis lacks its shape'
        warnings.append(Problem("gravity_unclear", _where(worst, case_file), what, remedy, len(doubtful)))
    return [
        *warnings,
        *_factor_warnings(
            "gravity_reversed",
            [one for one in found if one.verdict == "reversed"],
            "is against it",
            "Check the direction of gravity and the signs of mode shapes and forces; one of them is turned",
            case_file,
        ),
        *_factor_warnings(
            "gravity_units",
            [one for one in found if one.verdict == "units"],
            f"is neither once ({ONCE[0]:g} to {ONCE[1]:g} times) nor absent",
            "Check the units of q, of the forces and of the gravity load (9.81, 1000): one of them is another",
            case_file,
        ),
    ]


def _factor_warnings(
    code: str, some: Sequence[HeldGravity], finding: str, remedy: str, case_file: str
) -> Iterator[Problem]:
    """Warning about dead loads of the same shape with another sign or in other units."""
    if some:
        worst = max(some, key=lambda one: abs(np.log(abs(one.beta))))
        what = (
            f"the mean of q makes {worst.beta:.4g} times the stress of "
            f"{worst.unit_load} at 1 (cosine {worst.cos:.3f}), which {finding}{_likewise(some, worst)}"
        )
        yield Problem(code, _where(worst, case_file), what, remedy, len(some))


def _products(groups: WeldGroups, columns: Floats, number: int) -> Floats:
    """Products (k, k) of the stresses of some columns (c, k) of coordinates, over the stations of a group of welds."""
    stress = solve_group(groups, number).stations.treated
    parts = [S @ columns for S in (stress.membrane, stress.bending)]
    return np.asarray(sum(part.T @ part for part in parts))


def _is_once(factor: float) -> bool:
    return ONCE[0] <= factor <= ONCE[1]


def _twice(found: Sequence[HeldGravity], case_file: str) -> Iterator[Problem]:
    twice = [one for one in found if one.is_twice]
    if not twice:
        return
    worst = max(twice, key=lambda one: one.cos)
    what = (
        f"the dead load is there twice: the mean of q makes {worst.beta:.3g} times "
        f"the stress of {worst.unit_load} at 1 (cosine {worst.cos:.3f}), and {worst.unit_load} = {worst.given:g} is "
        f"given on top{_likewise(twice, worst)}"
    )
    remedy = f'Set mean_of_q = "remove" in [counting] or in the event, or do not give {worst.unit_load} there'
    yield Problem("gravity_twice", _where(worst, case_file), what, remedy, len(twice))


def _differing(found: Sequence[HeldGravity], sequences: Sequence[Sequence[str]], case_file: str) -> Iterator[Problem]:
    """Refusal of sequences whose events hold different dead loads by their q, which nothing that is given evens out."""
    of_event = {one.event: one for one in found}
    differing = []
    for number, order in enumerate(sequences, 1):
        entries = [of_event[name] for name in dict.fromkeys(order) if name in of_event]
        differing += [(number, entries[0], other) for other in entries[1:] if _differ(entries[0], other)][:1]
    if not differing:
        return
    number, first, other = differing[0]
    what = (
        f"the mean of q holds the dead load in different ways: in event '{shortened(first.event)}' {_held(first)}, in "
        f"'{shortened(other.event)}' {_held(other)}, so that the sequence would count a false cycle of the dead load"
    )
    if len(differing) > 1:
        what += f"; so would {few([f'mission.sequence[{n}]' for n, *_ in differing[1:]])}"
    remedy = f'Set mean_of_q = "remove" in [counting] and give {first.unit_load} in every event of the sequence'
    yield Problem("gravity_differs", f"{case_file}: mission.sequence[{number}].order", what, remedy, len(differing))


def _differ(one: HeldGravity, other: HeldGravity) -> bool:
    """Whether two levels hold different dead loads by their q; what is given may even that out."""
    if one.from_q == other.from_q or (one.verdict == other.verdict and one.mean_of_q == other.mean_of_q):
        return False
    return not abs(one.from_q + one.given - other.from_q - other.given) < ONCE[0]


def _held(one: HeldGravity) -> str:
    """What the level of an event holds by its q, in words."""
    if one.mean_of_q == "remove":
        return "it is removed"
    return f"it is {one.verdict} (beta {one.beta:.3g}, cosine {one.cos:.3g})"


def _likewise(found: Sequence[HeldGravity], worst: HeldGravity) -> str:
    others = [f"'{shortened(one.event)}'" for one in found if one is not worst]
    return f"; likewise in {few(others)}" if others else ""


def _where(one: HeldGravity, case_file: str) -> str:
    return f"{case_file}: mean_of_q of event '{shortened(one.event)}'"
