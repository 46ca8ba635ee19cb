"""``fleet.toml`` as frozen models: the conditions that units run under, and the table of how far they run."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Annotated, Any

from pydantic import BaseModel, Field, PrivateAttr

from fatigue.case.problems import clash, path_problems
from fatigue.case.table import NotNegative, Positive, Table, Text
from fatigue.case.toml_file import checked_file, read_toml
from fatigue.errors import CaseError, Problem, given_path, refuse

WHAT = "a fleet (fleet.toml)"
PERCENT = (5.0, 10.0, 50.0, 90.0, 95.0)

Percent = Annotated[float, Field(ge=0, le=100)]


class Condition(Table):
    """What a unit may run under: a line, a wheel state, a payload; one event of one result."""

    name: Text = Field(description="its name, unique, as the table of distances has it")
    results: Text = Field(description="a result folder of fatigue assess, relative to the fleet file")
    event: Text = Field(
        description="an event of that result; '(sequence 1)': what its cycles across events add for each run of them"
    )
    damage_cv: NotNegative | None = Field(
        default=None,
        description="relative standard error of its damage, at least 0, for the variance shares; left out: se_load in "
        "band.parquet of the result, where its mission is this one event",
    )


class Correlation(Table):
    """How the distances of two conditions hang together, where their standard deviations are given."""

    conditions: Annotated[tuple[Text, ...], Field(strict=False, min_length=2, max_length=2)] = Field(
        description="a list of two names of conditions"
    )
    rho: Annotated[float, Field(ge=-1, le=1)] = Field(
        description="their coefficient of correlation, -1 to 1: below 0 for parts of a budget"
    )

    def _contradictions(self) -> Iterator[Problem]:
        if self.conditions[0] == self.conditions[1]:
            yield clash("conditions", f"{self.conditions[0]!r} stands there twice", "Name two conditions")


class Fleet(Table):
    """The whole of ``fleet.toml``."""

    title: str = Field(default="Fleet", description="the title of tables and page")
    km: Text = Field(description="the table of distances in a year, .csv or .parquet, relative to the fleet file")
    target_years: Positive | None = Field(
        default=None, description="years that every weld of every unit has to live, above 0; left out: no verdict"
    )
    percentiles: Annotated[tuple[Percent, ...], Field(strict=False, min_length=1)] = Field(
        default=PERCENT, description="a list of percentiles over the units, 0 to 100"
    )
    condition: Annotated[tuple[Condition, ...], Field(strict=False, min_length=1)] = Field(
        description="one [[condition]] table per condition"
    )
    correlation: Annotated[tuple[Correlation, ...], Field(strict=False)] = Field(
        default=(), description="one [[correlation]] table per pair of conditions whose distances are correlated"
    )
    _path: Path = PrivateAttr(Path())

    def model_post_init(self, context: Path | None) -> None:
        """Remember the file, where the fleet comes from one."""
        if context is not None:
            self._path = context

    @property
    def path(self) -> Path:
        """The fleet file."""
        return self._path

    def resolve(self, name: str) -> Path:
        """Path of what the fleet names, relative to the folder of the fleet file."""
        return self._path.parent / name

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the conditions."""
        return tuple(condition.name for condition in self.condition)

    def _contradictions(self) -> Iterator[Problem]:
        yield from path_problems({"km": self.km})
        first: dict[str, int] = {}
        for number, condition in enumerate(self.condition, 1):
            if first.setdefault(condition.name, number) < number:
                what = f"{condition.name!r} is already the name of condition[{first[condition.name]}]"
                yield Problem("duplicate", f"condition[{number}].name", what, "Give every condition its own name")
        yield from self._errors_of_one_damage()
        pairs: dict[frozenset[str], int] = {}
        for number, one in enumerate(self.correlation, 1):
            where = f"correlation[{number}].conditions"
            for name in one.conditions:
                if name not in first:
                    what, known = f"there is no condition {name!r}", ", ".join(map(repr, first))
                    yield Problem("unknown_id", where, what, f"Name two of {known}")
            if pairs.setdefault(frozenset(one.conditions), number) < number:
                what = f"the pair stands in correlation[{pairs[frozenset(one.conditions)]}] already"
                yield Problem("duplicate", where, what, "Keep one of them")

    def _errors_of_one_damage(self) -> Iterator[Problem]:
        """Refusal of two standard errors of the damage of one event of one result, which has one."""
        first: dict[tuple[str, str], int] = {}
        for number, condition in enumerate(self.condition, 1):
            before = first.setdefault((condition.results, condition.event), number)
            stated = self.condition[before - 1].damage_cv
            if condition.damage_cv != stated:
                here, there = ("none" if cv is None else f"{cv:g}" for cv in (condition.damage_cv, stated))
                what = f"is {here}, and {there} in condition[{before}], whose event is the same: it has one error"
                yield clash(f"condition[{number}].damage_cv", what, "State the same in both")


MODELS: dict[tuple[str, ...], type[BaseModel]] = {
    (): Fleet,
    ("condition",): Condition,
    ("correlation",): Correlation,
}


def load_fleet(path: Path | str) -> Fleet:
    """Fleet of a fleet file, read and checked in itself; what it names is not opened.

    Raises
    ------
    CaseError : every mistake of the file, not only the first
    """
    path = given_path(path, "fleet")
    raw = read_toml(path, WHAT)
    refuse(CaseError, _another_file(raw, path))
    return checked_file(Fleet, raw, path, MODELS)


def _another_file(raw: Mapping[str, Any], path: Path) -> Iterator[Problem]:
    """Refusal of a case that is given instead of a fleet."""
    if "condition" not in raw and {"body", "mission"} & raw.keys():
        remedy = "Give a fleet.toml whose conditions name results of it"
        yield Problem("foreign_format", path.name, "this is a case (case.toml), not a fleet", remedy)
