"""By how much an assessment will upsample each record: by all welds, and the beginnings of records."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fatigue.life.mission import Plan
from fatigue.pipeline.forecast.band_trial import beginnings
from fatigue.pipeline.mission.upsampling import PeakForms, peak_forms
from fatigue.pipeline.solve.body import Body
from fatigue.weld.structural_stress import StructuralStress


@dataclass(frozen=True, slots=True)
class Foretold:
    """The events that are looked at, by number, and what each needs at the welds so far: a number of samples for one.

    The other events are taken for ones like the longest.
    """

    forms: dict[int, PeakForms]
    needed: dict[int, int]
    longest: int

    def add(self, stress: StructuralStress) -> None:
        """Take some stations in."""
        for number, forms in self.forms.items():
            self.needed[number] = max(self.needed[number], forms.factor(forms.fastest(stress)))

    def factors(self, asked: int | str, plan: Plan) -> tuple[int, ...]:
        """Factor of each event, as the case asks for it or as it needs."""
        if isinstance(asked, int):
            return tuple(one.factor(asked) for one in plan.passes)
        needed = (self.needed.get(number, self.needed[self.longest]) for number in range(len(plan.passes)))
        return tuple(p.factor(factor * max(1, p.refined)) for factor, p in zip(needed, plan.passes, strict=True))


def foretold(body: Body, plan: Plan, scratch: Path) -> Foretold:
    """Events of a case whose welds are still to be added; none is looked at where the case gives the factor.

    ``scratch`` is a folder.
    """
    is_asked = body.case.counting.upsample == "auto"
    forms = {number: peak_forms(load) for number, load in beginnings(body, plan, scratch)} if is_asked else {}
    return Foretold(forms, dict.fromkeys(forms, 1), int(np.argmax([one.samples for one in plan.passes])))


def upsampling_text(factors: Sequence[int]) -> str:
    """By how much how many records are upsampled, in words.

    >>> upsampling_text((4, 1, 4))
    '4 times 2 of 3 events'
    """
    found = [f"{factor} times {factors.count(factor)} of {len(factors)} events" for factor in sorted({*factors} - {1})]
    return ", ".join(found) or "none"
