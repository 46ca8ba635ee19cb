"""The tables of checks beside the normal stress at the toe in ``case.toml``: shear, static load cases, interaction."""

from collections.abc import Iterator
from typing import Annotated, Literal, TypeAlias, get_args

from pydantic import Field

from fatigue.case.problems import absent, clash, path_problems
from fatigue.case.quality import StressCategory
from fatigue.case.table import NotNegative, Positive, Table, Text
from fatigue.errors import Problem

CHECK_FILES = ("static_cases", "endurance_lines", "strength_factors")
Method = Literal["report", "range", "length", "mlp", "asme", "off"]
Check = Literal["throat_perp", "throat_par", "throat_root", "hot_spot", "nominal", "parent", "interaction", "endurance"]
_Names: TypeAlias = Annotated[tuple[Text, ...], Field(strict=False)]


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

    rule: Literal["en1993", "iiw", "en1999", "dnv"] = Field(description="'en1993', 'iiw', 'en1999' or 'dnv'")
    welds: _Names = Field(default=(), description="a list of the welds; left out: every weld with a shear curve")
    cv: Positive | None = Field(default=None, description="the comparison value [-] of 'iiw', above 0")
    damage_limit: Positive | None = Field(default=None, description="the allowed damage sum [-], above 0")
    alpha: Positive | None = Field(
        default=None, description="the factor [-] of 'dnv' on the principal stress range, above 0"
    )


class EnduranceCheck(Table):
    """Stress between static load cases against endurance lines."""

    welds: _Names = Field(default=(), description="a list of welds")
    points: _Names = Field(default=(), description="a list of stress points")
    cases: Text = Field(description="the group of static load cases")
    perp: Text | None = Field(default=None, description="the endurance line of the stress across the weld")
    par: Text | None = Field(default=None, description="the endurance line of the stress along the weld")
    shear: Text | None = Field(default=None, description="the endurance line of the shear stress")
    curve: Text | None = Field(default=None, description="the S-N curve whose cut-off or knee is the endurance range")
    kappa: Annotated[tuple[float, ...], Field(strict=False)] = Field(
        default=(), description="a list of coefficients [-] of u_perp u_par, of which the largest sum decides"
    )
    limit: Positive | None = Field(default=None, description="the largest sum [-] of the combination, above 0")


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
        if self.endurance and self.static_cases is None:
            what = "the key is missing although [[checks.endurance]] is given"
            yield absent("static_cases", what, "Give the file of the static load cases")
        if len(set(self.counts)) < len(self.counts):
            yield clash("counts", f"{list(self.counts)} names a check twice", "Name it once")
