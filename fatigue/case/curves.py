"""The tables of S-N curves in ``case.toml``: the curve in use, and curves of the user."""

import itertools
from collections.abc import Iterator
from typing import Annotated, Literal

from pydantic import Field

from fatigue.case.problems import absent, clash
from fatigue.case.table import NotNegative, Positive, Table, Text
from fatigue.errors import Problem
from fatigue.life.curves import Applies, CurveStatus, Extension, Quantity, Survival, ThicknessRule


class Curve(Table):
    """The S-N curve of every weld that names no other, and how it is used."""

    name: Text = Field(description="the key of a curve of the catalogue or of [curves]")
    survival: Survival | None = Field(
        default=None,
        description="the survival level; left out: mean-2sigma on curves with scatter, as tabulated on the others",
    )
    thickness_rule: ThicknessRule = Field(
        default="actual", description="the thickness in dS: 'actual', or 'asme' (at least 16 mm, at most 150 mm)"
    )
    extension: Extension = Field(
        default="none", description="the curve beyond knee_cycles: 'none', 'haibach' or 'cutoff'"
    )
    knee_cycles: Positive = Field(
        default=1e7, description="the number of cycles [-] at the knee of the extension, above 0"
    )
    mean_stress: Literal["none", "asme"] = Field(
        default="none", description="the mean stress correction: 'none' or 'asme'"
    )
    yield_MPa: Positive | None = Field(  # noqa: N815  (the unit keeps its spelling)
        default=None, description="the yield strength [MPa], above 0"
    )

    def _contradictions(self) -> Iterator[Problem]:
        if self.mean_stress == "asme" and self.yield_MPa is None:
            what = "the key is missing although mean_stress = 'asme' is given"
            yield absent("yield_MPa", what, "Give the yield strength [MPa] or set mean_stress = 'none'")


class CustomCurve(Table):
    """An S-N curve of the user: straight lines in log-log, the first one fixed by its range at 2e6 cycles."""

    slopes: Annotated[tuple[Positive, ...], Field(strict=False, min_length=1)] = Field(
        description="a list of the slopes [-] from large ranges to small ones, each above 0"
    )
    knees_cycles: Annotated[tuple[Positive, ...], Field(strict=False)] = Field(
        default=(),
        description="a list of the cycles [-] at the knees, ascending; as many as slopes: the last one is a cut-off",
    )
    range_at_2e6_MPa: Positive = Field(  # noqa: N815
        description="the range at 2e6 cycles, of stress [MPa] or of dS [MPa mm^-0.222], above 0"
    )
    applies: Applies = Field(
        description="the range the curve is for: 'structural' (stress), 'dS' (equivalent structural stress), "
        "'nominal', 'hot_spot', 'throat' or 'parent'"
    )
    quantity: Quantity = Field(default="normal", description="the stress the curve is for: 'normal' or 'shear'")
    source: Text = Field(description="the source: document, edition, clause")
    edition: str = Field(default="", description="the edition of the source")
    clause: str = Field(default="", description="the clause or table of the source")
    status: CurveStatus = Field(
        default="user",
        description="what its numbers rest on: 'verified' (seen in a public source, the one named), 'user' (entered by "
        "the user) or 'unverified'",
    )
    checked_by: str = Field(default="", description="who compared the numbers with the source")
    checked_on: str = Field(default="", description="when, as in 2026-05-31")
    log10_scatter: Positive | None = Field(
        default=None,
        description="the standard deviation of log10 of the cycles [-], above 0; the curve is then the mean",
    )
    thickness_reference_mm: Positive | None = Field(
        default=None, description="the thickness [mm] above which the range is increased by (t / reference) ^ exponent"
    )
    thickness_exponent: NotNegative | None = Field(default=None, description="the thickness exponent [-], at least 0")
    thickness_effective: Literal["t", "L_half"] = Field(
        default="t",
        description="the thickness of the thickness rule: 't', or 'L_half' (half the length of the attachment where "
        "that is at most the plate thickness)",
    )
    bending_factor: Literal["none", "bs7608"] = Field(
        default="none", description="the allowance for bending through the thickness: 'none' or 'bs7608'"
    )
    bending_reference_mm: Positive | None = Field(
        default=None, description="the reference thickness [mm] of bending_factor, above 0"
    )
    bending_exponent: NotNegative | None = Field(
        default=None, description="the thickness exponent [-] of bending_factor, at least 0"
    )
    mean_stress: Literal["none", "iiw_low", "iiw_medium"] = Field(
        default="none",
        description="the allowance for the stress ratio of each cycle: 'none', 'iiw_low' or 'iiw_medium' residual "
        "stress",
    )
    gamma_Ff: Positive = Field(  # noqa: N815
        default=1.0, description="the partial factor [-] on stress ranges, above 0"
    )
    gamma_Mf: Positive = Field(  # noqa: N815
        default=1.0, description="the partial factor [-] on the resistance, which divides the curve, above 0"
    )
    damage_limit: Positive | None = Field(
        default=None, description="the allowed damage sum [-] on this curve, above 0; left out: that of the mission"
    )

    def _contradictions(self) -> Iterator[Problem]:
        knees, slopes = self.knees_cycles, self.slopes
        if any(after <= before for before, after in itertools.pairwise(knees)):
            yield clash("knees_cycles", f"{list(knees)} does not ascend", "Sort the knees by cycles")
        if len(knees) not in (len(slopes) - 1, len(slopes)):
            what = f"{len(knees)} knees do not go with {len(slopes)} slopes"
            yield clash("knees_cycles", what, "Give one knee less than slopes, or as many for a cut-off at the last")
        if (self.thickness_reference_mm is None) != (self.thickness_exponent is None):
            without = "thickness_reference_mm" if self.thickness_reference_mm is None else "thickness_exponent"
            what = "thickness_reference_mm and thickness_exponent need each other"
            yield absent(without, what, "Give both or neither")
