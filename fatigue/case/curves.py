"""The tables of S-N curves in ``case.toml``: the curve in use, and curves of the user."""

import itertools
from collections.abc import Collection, Iterator
from typing import Annotated, Any, Literal

from pydantic import Field

from fatigue.case.problems import absent, clash
from fatigue.case.table import NotNegative, Positive, Table, Text
from fatigue.errors import Problem
from fatigue.life.allowances import BendingFactor, StressRatio, ThicknessEffective
from fatigue.life.curves import Applies, CurveStatus, Extension, Quantity, Survival, ThicknessRule

NEEDED = ("slopes", "range_at_2e6_MPa", "applies", "source")  # of a curve that is not in the catalogue


MeanStress = Literal["none", "asme"]


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
    mean_stress: MeanStress = Field(default="none", description="the mean stress correction: 'none' or 'asme'")
    yield_MPa: Positive | None = Field(  # noqa: N815  (the unit keeps its spelling)
        default=None, description="the yield strength [MPa], above 0"
    )

    def _contradictions(self) -> Iterator[Problem]:
        if self.mean_stress == "asme" and self.yield_MPa is None:
            what = "the key is missing although mean_stress = 'asme' is given"
            yield absent("yield_MPa", what, "Give the yield strength [MPa] or set mean_stress = 'none'")


class CustomCurve(Table):
    """An S-N curve of the user: straight lines in log-log, the first one fixed by its range at 2e6 cycles.

    Under the name of a curve of the catalogue it is that curve, with the keys that are given in the place of its own.
    """

    slopes: Annotated[tuple[Positive, ...], Field(strict=False, min_length=1)] | None = Field(
        default=None,
        description="a list of the slopes [-] from large ranges to small ones, each above 0; needed unless the "
        "catalogue has the curve",
    )
    knees_cycles: Annotated[tuple[Positive, ...], Field(strict=False)] = Field(
        default=(),
        description="a list of the cycles [-] at the knees, ascending; as many as slopes: the last one is a cut-off",
    )
    range_at_2e6_MPa: Positive | None = Field(  # noqa: N815
        default=None,
        description="the range at 2e6 cycles, of stress [MPa] or of dS [MPa mm^-0.222], above 0; needed unless the "
        "catalogue has the curve",
    )
    applies: Applies | None = Field(
        default=None,
        description="the range the curve is for: 'structural' (stress), 'dS' (equivalent structural stress), "
        "'nominal', 'hot_spot', 'throat' or 'parent'; needed unless the catalogue has the curve",
    )
    quantity: Quantity = Field(default="normal", description="the stress the curve is for: 'normal' or 'shear'")
    source: Text | None = Field(
        default=None,
        description="the source: document, edition, clause; needed unless the catalogue has the curve",
    )
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
    thickness_effective: ThicknessEffective = Field(
        default="t",
        description="the thickness of the thickness rule: 't', or 'L_half' (half the length of the attachment, "
        "attachment_mm of the welds table, where that is at most the plate thickness)",
    )
    bending_factor: BendingFactor = Field(
        default="none",
        description="the allowance for bending through the thickness: 'none', or 'bs7608' (ranges are divided by "
        "(bending_reference_mm / t)^bending_exponent (1 + 0.18 R_b^1.4), R_b the bending ratio of the cycle)",
    )
    bending_reference_mm: Positive | None = Field(
        default=None, description="the reference thickness [mm] of bending_factor, above 0"
    )
    bending_exponent: NotNegative | None = Field(
        default=None, description="the thickness exponent [-] of bending_factor, at least 0"
    )
    mean_stress: StressRatio = Field(
        default="none",
        description="the allowance for the stress ratio R of each cycle, static stress included, by which ranges are "
        "divided: 'none', 'iiw_low' or 'iiw_medium' residual stress",
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
        if slopes is not None and "knees_cycles" in self.model_fields_set:
            yield from _number_of_knees(len(slopes), len(knees), "knees_cycles")
        if (self.thickness_reference_mm is None) != (self.thickness_exponent is None):
            without = "thickness_reference_mm" if self.thickness_reference_mm is None else "thickness_exponent"
            what = "thickness_reference_mm and thickness_exponent need each other"
            yield absent(without, what, "Give both or neither")
        yield from self._allowances()

    def _allowances(self) -> Iterator[Problem]:
        """Refusals of allowances that lack a number, or that the stress of the curve has no place for."""
        of_bending = {key: getattr(self, key) for key in ("bending_reference_mm", "bending_exponent")}
        for key, value in of_bending.items():
            if self.bending_factor != "none" and value is None:
                what = f"the key is missing although bending_factor = '{self.bending_factor}' is given"
                yield absent(key, what, "Give it from the edition of the curve")
            if self.bending_factor == "none" and value is not None:
                remedy = "Add bending_factor = 'bs7608', or remove the key"
                yield clash(key, f"{value:g} is given without bending_factor", remedy)
        if self.applies == "dS" and self.bending_factor != "none":
            what = f"'{self.bending_factor}' is given for a curve in dS, which has I(r) of the bending ratio already"
            yield clash("bending_factor", what, "Remove it, or give the curve of a stress")
        if self.quantity == "shear":
            if self.applies == "dS":
                what = "'dS' is the equivalent range of the normal stress and has no shear curve"
                yield clash("applies", what, "Give the stress the curve is for, such as 'structural' or 'throat'")
            if self.mean_stress != "none":
                what = f"'{self.mean_stress}' is given for shear, whose sign, and R with it, is a matter of the frame"
                yield clash("mean_stress", what, "Remove it")
            if self.bending_factor != "none":
                what = f"'{self.bending_factor}' is given for shear, and the bending ratio is of the normal stress"
                yield clash("bending_factor", what, "Remove it")


def _number_of_knees(slopes: int, knees: int, where: str) -> Iterator[Problem]:
    if knees not in (slopes - 1, slopes):
        what = f"{knees} knees do not go with {slopes} slopes"
        yield clash(where, what, "Give one knee less than slopes, or as many for a cut-off at the last")


def own_curve_problems(raw: dict[str, Any], catalogue: Collection[str]) -> Iterator[Problem]:
    """Refusals of a curve that is not in the catalogue and lacks one of the keys it would have from there."""
    curves = raw.get("curves")
    for name, given in curves.items() if isinstance(curves, dict) else ():
        if isinstance(given, dict) and name not in catalogue:
            for key in NEEDED:
                if key not in given:
                    meaning = (CustomCurve.model_fields[key].description or "").partition("; needed")[0]
                    yield absent(f"curves.{name}.{key}", "the key is missing", f"Give {meaning}")
            if isinstance(slopes := given.get("slopes"), list) and slopes and "knees_cycles" not in given:
                yield from _number_of_knees(len(slopes), 0, f"curves.{name}.knees_cycles")
