"""What the page of a study is made of: the study in words, its variants and runs, numbers, verdicts, warnings."""

from collections.abc import Sequence
from dataclasses import dataclass

from fatigue.errors import Problem
from fatigue.study.claims.verdict import Verdict
from fatigue.study.quantities import Number, StudyRun, Variant
from fatigue.study.variants.ratios import RatioRow


@dataclass(frozen=True, slots=True)
class Varied:
    """One thing that is varied: its short name, the keys behind it, and all its values, that of the base first."""

    name: str
    keys: tuple[str, ...]
    values: tuple[float | int | str | bool, ...]


@dataclass(frozen=True, slots=True)
class Studied:
    """A finished study; what it does not have is None or empty.

    Attributes
    ----------
    title : of the study
    vehicle, case : names of the files of the base
    source : where the histories come from, as the end of a sentence ("rides of the vehicle")
    combine : one-at-a-time | full
    seeds : of every variant
    variants : the base first
    runs : of every variant under every seed
    numbers : of every variant under every seed
    ratios : of every quantity between variants that differ in one thing, and between each and the base
    verdicts : one of every claim, in the order of the study
    warnings : of the study and of its runs, one of each kind
    """

    title: str
    vehicle: str | None
    case: str | None
    source: str
    combine: str
    varied: Sequence[Varied]
    seeds: Sequence[int]
    variants: Sequence[Variant]
    runs: Sequence[StudyRun]
    numbers: Sequence[Number]
    ratios: Sequence[RatioRow]
    verdicts: Sequence[Verdict] = ()
    warnings: Sequence[Problem] = ()
