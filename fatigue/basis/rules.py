"""What is taken for enough: rules of thumb with their source, data and no verdicts."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Rule:
    """A share that is taken for enough, where it is from, and whether its source was seen."""

    share: float
    source: str
    status: str


EFFECTIVE_MASS = Rule(
    share=0.90,
    source="rule of thumb in base-excited structural dynamics: effective mass of the modes in the band over the mass",
    status="recalled, in no edition that was compared",
)
