"""The tables of checks beside the normal stress at the toe in ``case.toml``: shear, static load cases, interaction."""

from collections.abc import Iterator
from typing import Annotated, Literal, TypeAlias, get_args

from pydantic import Field

from fatigue.case.check_problems import (
    LINE_KEYS,
    endurance_problems,
    interaction_problems,
    place_problems,
    unused_files,
)
from fatigue.case.problems import absent, clash, path_problems
from fatigue.case.table import NotNegative, Positive, Table, Text
from fatigue.errors import Problem
from fatigue.life.quality import StressCategories, shipped_categories

CHECK_FILES = ("static_cases", "endurance_lines", "strength_factors")
Method = Literal["report", "range", "length", "mlp", "asme", "off"]
Check = Literal["throat_perp", "throat_par", "throat_root", "hot_spot", "nominal", "parent", "interaction", "endurance"]
Rule = Literal["en1993", "iiw", "en1999", "dnv"]
_Names: TypeAlias = Annotated[tuple[Text, ...], Field(strict=False, min_length=1)]


class Multiaxial(Table):
    """How shear at the toe is counted with the normal stress."""

    method: Method = Field(
        default="report",
        description="'report' (life and verdict rest on the normal stress, shear is told beside it), 'range', "
        "'length', 'mlp' or 'asme' (the larger of the two damage sums decides) or 'off'",
    )
    beta: Positive = Field(default=3.0, description="the weight [-] of the square of the shear stress, above 0")
    alpha: NotNegative | None = Field(
        default=None, description="the weight [-] of the path moment of 'mlp', at least 0; it has no default"
    )

    def _contradictions(self) -> Iterator[Problem]:
        if self.method == "mlp" and self.alpha is None:
            yield absent("alpha", "the key is missing although method = 'mlp' is given", "Give the weight alpha [-]")


class Interaction(Table):
    """How the damage sums of normal stress and of shear are combined at some welds."""

    rule: Rule = Field(
        description="'en1993' (damage sums add up to 1), 'iiw' (squares of utilisations add up to cv), 'en1999' "
        "(damage sums add up to damage_limit) or 'dnv'"
    )
    welds: _Names = Field(default=(), description="a list of the welds; left out: every weld with a shear curve")
    cv: Positive | None = Field(default=None, description="the comparison value [-] of 'iiw', above 0")
    damage_limit: Positive | None = Field(
        default=None, description="the allowed damage sum [-] of 'iiw' and 'en1999', above 0"
    )
    alpha: Positive | None = Field(
        default=None, description="the factor [-] of 'dnv' on the principal stress range, above 0"
    )

    def _contradictions(self) -> Iterator[Problem]:
        yield from interaction_problems(self.rule, self.welds, self.cv, self.damage_limit, self.alpha)


class EnduranceCheck(Table):
    """Stress between static load cases against endurance lines."""

    welds: _Names = Field(default=(), description="a list of welds; left out together with points: every weld")
    points: _Names = Field(default=(), description="a list of stress points")
    cases: Text = Field(description="the group of static load cases")
    perp: Text | None = Field(default=None, description="the endurance line of the stress across the weld")
    par: Text | None = Field(
        default=None, description="the endurance line of the stress along the weld, which only points have"
    )
    shear: Text | None = Field(default=None, description="the endurance line of the shear stress")
    curve: Text | None = Field(
        default=None, description="the S-N curve whose cut-off, or else last knee, is the endurance range"
    )
    kappa: Annotated[tuple[float, ...], Field(strict=False)] = Field(
        default=(),
        description="a list of coefficients [-] of u_perp u_par, -2 to 2, of which the largest sum decides",
    )
    limit: Positive | None = Field(
        default=None, description="the largest sum [-] of the combination, above 0; left out: no combination"
    )

    def _contradictions(self) -> Iterator[Problem]:
        lines = self.lines
        yield from endurance_problems(lines, self.curve, self.kappa, self.limit)
        yield from place_problems(self.welds, self.points, by_default="par" not in lines)

    @property
    def lines(self) -> dict[str, str]:
        """The endurance lines it names, by component."""
        return {key: name for key in LINE_KEYS if (name := getattr(self, key)) is not None}


class StressCategory(Table):
    """From which stress utilisation on a weld is of a higher stress category."""

    medium_from: Positive = Field(description="the utilisation [-] from which the category is 'medium', above 0")
    high_from: Positive = Field(description="the utilisation [-] from which the category is 'high', above medium_from")
    source: Text = Field(description="where the limits come from, edition and clause")

    def _contradictions(self) -> Iterator[Problem]:
        if self.high_from <= self.medium_from:
            what = f"{self.high_from:g} is not above medium_from = {self.medium_from:g}"
            yield clash("high_from", what, "Give the limits in ascending order")


class Checks(Table):
    """What is checked beside the normal stress at the toe."""

    static_cases: Text | None = Field(default=None, description="the file of static load cases")
    endurance_lines: Text | None = Field(default=None, description="the file of endurance lines")
    strength_factors: Text | None = Field(default=None, description="the file of factors on the S-N curves")
    counts: Annotated[tuple[Check, ...], Field(strict=False)] = Field(
        default=(),
        description=f"a list of the checks that decide verdict and exit code: {', '.join(get_args(Check))}",
    )
    interaction: Annotated[tuple[Interaction, ...], Field(strict=False)] = Field(
        default=(), description="one [[checks.interaction]] table per rule"
    )
    endurance: Annotated[tuple[EnduranceCheck, ...], Field(strict=False)] = Field(
        default=(), description="one [[checks.endurance]] table per check between static load cases"
    )

    stress_category: StressCategory | None = Field(
        default=None, description="a [checks.stress_category] table; left out: 'medium' from 0.75, 'high' from 0.9 on"
    )

    def _contradictions(self) -> Iterator[Problem]:
        yield from path_problems({key: getattr(self, key) for key in CHECK_FILES})
        lines = [line for check in self.endurance for line in check.lines.values()]
        yield from unused_files(self.static_cases, self.endurance_lines, len(self.endurance), lines)
        if len(set(self.counts)) < len(self.counts):
            yield clash("counts", f"{list(self.counts)} names a check twice", "Name it once")


def stress_categories(asked: StressCategory | None) -> StressCategories:
    """Categories that a case asks for, else those that are shipped."""
    if asked is None:
        return shipped_categories()
    return StressCategories(shipped_categories().names, (asked.medium_from, asked.high_from), asked.source, "user")
