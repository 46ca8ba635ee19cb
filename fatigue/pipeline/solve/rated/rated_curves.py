"""The S-N curves a case asks for, at its survival level and with its extension, for the stress that asks for them."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from fatigue.case import Case
from fatigue.errors import CaseError, Problem, refuse
from fatigue.life.allowances import bending_thickness
from fatigue.life.curves import DamageLaw, Extension, Quantity, SNCurve, Survival, ThicknessRule, damage_law
from fatigue.life.curves import survival_level as level_of
from fatigue.life.mission import Plan
from fatigue.life.rule import CycleRule, size_exponent, size_factor
from fatigue.pipeline.solve.rated.known_curves import curves_of_case
from fatigue.readers.neutral.body.strength_factors import StrengthFactor, on_limit, on_range
from fatigue.readers.neutral.body.welds import Weld
from fatigue.shown import few

__all__ = ["AskedCurve", "RatedCurve", "asked_curves", "curves_of_case", "rated_curves"]

Use = Literal["toe", "hot_spot", "nominal", "throat", "root", "parent", "endurance"]
FITS: dict[str, tuple[str, ...]] = {  # what a curve that serves a use may apply to
    "toe": ("structural", "dS"),
    "hot_spot": ("hot_spot", "structural"),
    "nominal": ("nominal",),
    "throat": ("throat",),
    "root": ("throat", "structural", "dS"),
    "parent": ("parent",),
    "endurance": ("structural", "hot_spot", "nominal", "throat", "parent", "dS"),
}
NO_BENDING = ("throat", "endurance")  # uses whose stresses are no membrane and bending stress of a plate
USES = {
    "toe": "the structural stress at the toe",
    "hot_spot": "a hot-spot stress",
    "nominal": "a nominal stress",
    "throat": "the stress in the throat",
    "root": "the structural stress of the throat at the root",
    "parent": "the stress in the parent metal",
    "endurance": "a stress between static load cases",
}
APPLIES = {
    "structural": "structural stress",
    "dS": "the equivalent structural stress dS",
    "hot_spot": "hot-spot stress",
    "nominal": "nominal stress",
    "throat": "the stress in the throat",
    "parent": "the stress in the parent metal",
}


@dataclass(frozen=True, slots=True)
class RatedCurve:
    """A curve as this assessment uses it: at a survival level, with the rules that turn cycles into damage.

    ``factors`` are those of the table of strength factors; ``attachment`` is the length [mm] of what a weld attaches,
    where the curve is ``at`` a weld and asks for it.
    """

    curve: SNCurve
    survival: str
    rule: CycleRule
    thickness_rule: ThicknessRule
    factors: tuple[StrengthFactor, ...] = ()
    attachment: float = np.inf

    @property
    def is_unverified(self) -> bool:
        """Whether nobody has compared its numbers with their source."""
        return self.curve.status == "unverified"

    @property
    def on_range(self) -> float:
        """Factor on every range, whatever the plate: partial factors and those of the table; 1 without any."""
        of = self.curve.allowances
        return of.gamma_Ff * of.gamma_Mf * on_range(self.factors)

    def at(self, weld: Weld) -> "RatedCurve":
        """The curve at a weld, whose attachment has a length of its own."""
        if self.curve.allowances.thickness_effective == "t" or weld.attachment is None:
            return self
        return replace(self, attachment=weld.attachment)

    def size(
        self, thickness: NDArray[np.float64], attachment: NDArray[np.float64] | None = None
    ) -> NDArray[np.float64]:
        """Factor of plates of some thickness [mm] on the range: ``size_factor`` and all that is not a cycle's own.

        ``attachment`` are the lengths of their attachments [mm], by default that of the weld.
        """
        length = self.attachment if attachment is None else attachment
        of_plate = size_factor(thickness, self.curve, self.thickness_rule, length)
        return of_plate * bending_thickness(thickness, self.curve.allowances) * self.on_range

    def size_exponent(self, thickness: float) -> float:
        """Exponent d ln(size) / d ln(t) of ``size`` at a thickness [mm]."""
        of = self.curve.allowances
        of_bending = of.bending_exponent if of.bending_factor != "none" else 0.0
        return size_exponent(thickness, self.curve, self.thickness_rule, self.attachment) + of_bending

    def damage_limit(self, of_mission: float) -> float:
        """Allowed damage sum on this curve: its own, else that of the mission, with the factors of the table."""
        own = self.curve.damage_limit
        return (of_mission if own is None else own) * on_limit(self.factors)

    def plan(self, plan: Plan) -> Plan:
        """The mission with the damage limit of this curve."""
        limit = self.damage_limit(plan.damage_limit)
        return plan if limit == plan.damage_limit else replace(plan, damage_limit=limit)


@dataclass(frozen=True, slots=True)
class AskedCurve:
    """A curve that something asks for: its name, where that is said, and the stress it is to serve.

    ``use`` is one of ``USES``; ``toe`` and ``normal`` is the stress that the settings of ``[curve]`` are for.
    """

    name: str
    where: str
    use: Use = "toe"
    quantity: Quantity = "normal"

    @property
    def is_main(self) -> bool:
        """Whether it is for the normal stress at a toe."""
        return self.use == "toe" and self.quantity == "normal"


def asked_curves(case: Case, welds: Sequence[Weld]) -> list[AskedCurve]:
    """Curves that the case and its welds ask for, normal stress and shear at the toe."""
    file = case.body.welds
    return [
        AskedCurve(case.curve.name, f"{case.path.name}: curve.name"),
        *(AskedCurve(w.curve, f"{file}: weld {w.name}: curve") for w in welds if w.curve),
        *(
            AskedCurve(w.curve_shear, f"{file}: weld {w.name}: curve_shear", quantity="shear")
            for w in welds
            if w.curve_shear
        ),
    ]


def rated_curves(
    case: Case, curves: Mapping[str, SNCurve], asked: Sequence[AskedCurve], factors: Sequence[StrengthFactor] = ()
) -> dict[str, RatedCurve]:
    """Every curve that is asked for, rated; all that is wrong with them is refused at once.

    What ``[curve]`` says of survival, extension and mean stress holds for every curve that has a place for it: a level
    for curves with scatter, an extension for curves without knees, f_M for curves in dS. At the normal stress of a toe
    a curve without a place for it is refused; elsewhere it is taken as it is given.

    Raises
    ------
    CaseError : a curve that is not there, that is for another stress, or that has no place for what is asked of it
    """
    rated: dict[str, RatedCurve] = {}
    problems: list[Problem] = []
    for name in dict.fromkeys(one.name for one in asked):
        of_name = [one for one in asked if one.name == name]
        found = list(_problems(case, curves, of_name))
        problems += found
        if not found:
            own = tuple(factor for factor in factors if factor.curve == name)
            try:
                rated[name] = _rated(case, curves[name], own, at_toe=any(one.is_main for one in of_name))
            except CaseError as error:
                problems += [replace(p, where=f"{case.path.name}: {p.where}") for p in error.problems]
    refuse(CaseError, problems)
    return rated


def attachment_problems(case: Case, welds: Sequence[Weld], curves: Mapping[str, RatedCurve]) -> Iterator[Problem]:
    """Refusals of welds without the length of their attachment, on curves that ask for it."""
    without: dict[str, list[str]] = {}
    for weld in welds:
        for name in {weld.curve or case.curve.name, weld.curve_shear or ""} & set(curves):
            if curves[name].curve.allowances.thickness_effective == "L_half" and weld.attachment is None:
                without.setdefault(name, []).append(weld.name)
    for name, some in without.items():
        what = f"curve '{name}' has thickness_effective = 'L_half', and {len(some)} of its welds ({few(some)}) have no "
        what += "length of their attachment"
        remedy = "Give attachment_mm, the length along the stress, or thickness_effective = 't'"
        yield Problem("attachment", f"{case.body.welds}: column attachment_mm", what, remedy)


def _problems(case: Case, curves: Mapping[str, SNCurve], asked: Sequence[AskedCurve]) -> Iterator[Problem]:
    """Refusals of a curve that is not there, or not for the stress it is asked for."""
    name = asked[0].name
    if name not in curves:
        known = ", ".join(sorted(curves))
        what, remedy = f"there is no curve '{name}'", f"Choose one of {known}, or add [curves.{name}]"
        yield Problem("unknown_curve", asked[-1].where, what, remedy)
        return
    curve = curves[name]
    for one in {(one.use, one.quantity): one for one in reversed(asked)}.values():
        of = curve.allowances
        if curve.quantity != one.quantity:
            what = f"curve '{name}' is for {_stress(curve.quantity)}, and {USES[one.use]} is asked for "
            what += f"{'shear' if one.quantity == 'shear' else 'its normal stress'}"
            remedy = f"Name a curve with quantity = '{one.quantity}'"
            yield Problem("curve_quantity", one.where, what, remedy)
        elif curve.applies not in FITS[one.use] or (curve.applies == "dS" and one.quantity == "shear"):
            fits = [applies for applies in FITS[one.use] if applies != "dS" or one.quantity == "normal"]
            what = f"curve '{name}' is for {APPLIES[curve.applies]} (applies = '{curve.applies}'), not for "
            what += USES[one.use]
            remedy = f"Name a curve with applies = {' or '.join(repr(applies) for applies in fits)}"
            yield Problem("curve_applies", one.where, what, remedy)
        elif one.is_main and case.curve.mean_stress == "asme" and curve.applies != "dS":
            what = f"mean_stress = 'asme' belongs to the master curve and does not apply to curve '{name}'"
            yield Problem("mean_stress", one.where, what, 'Set mean_stress = "none", or use a curve in dS')
        elif case.curve.mean_stress == "asme" and curve.applies == "dS" and of.stress_ratio != "none":
            what = f"curve '{name}' allows for the stress ratio by mean_stress = '{of.stress_ratio}', and so does "
            what += "mean_stress = 'asme' of [curve]"
            yield Problem("mean_stress", one.where, what, "Take one of them: they are two rules for the same effect")
        elif of.bending_factor != "none" and one.use in NO_BENDING:
            what = (
                f"curve '{name}' has bending_factor = '{of.bending_factor}', and no bending ratio of a cycle is known "
            )
            what += f"of {USES[one.use]}"
            yield Problem("bending_factor", one.where, what, "Name a curve without bending_factor")
        elif one.use != "toe" and of.thickness_effective == "L_half":
            what = f"curve '{name}' has thickness_effective = 'L_half', and attachments have a length at toes only"
            yield Problem("attachment", one.where, what, "Name a curve with thickness_effective = 't'")


def _stress(quantity: Quantity) -> str:
    return "shear stress (quantity = 'shear')" if quantity == "shear" else "normal stress (quantity = 'normal')"


def _rated(case: Case, curve: SNCurve, factors: tuple[StrengthFactor, ...], *, at_toe: bool) -> RatedCurve:
    """A curve at the survival level and with the extension of the case, where it has a place for them.

    Raises
    ------
    CaseError : it has not, and serves the normal stress of a toe
    """
    survival: Survival | None = case.curve.survival if at_toe or curve.has_scatter else None
    extension: Extension = case.curve.extension if at_toe or not curve.knees_cycles else "none"
    law = damage_law(curve, survival, extension, case.curve.knee_cycles)
    return RatedCurve(
        curve=curve,
        survival=level_of(curve, survival),
        rule=_cycle_rule(case, curve, law),
        thickness_rule=case.curve.thickness_rule,
        factors=factors,
    )


def _cycle_rule(case: Case, curve: SNCurve, law: DamageLaw) -> CycleRule:
    """Rule of the cycles of a curve; f_M belongs to curves in dS, and is not even shown beside others."""
    of = curve.allowances
    on_dS = curve.applies == "dS"
    f_M = on_dS and of.stress_ratio == "none"
    asme = f_M and case.curve.mean_stress == "asme"
    return CycleRule(law, on_dS, case.curve.yield_MPa if f_M else None, asme, of.bending_factor, of.stress_ratio)
