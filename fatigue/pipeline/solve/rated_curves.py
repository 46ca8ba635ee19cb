"""The S-N curves a case asks for, at its survival level and with its extension."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from fatigue.case import Case, CustomCurve
from fatigue.errors import CaseError, Problem, refuse
from fatigue.life.curves import (
    DamageLaw,
    Quantity,
    SNCurve,
    ThicknessRule,
    catalogue,
    damage_law,
    survival_level,
    user_curve,
)
from fatigue.life.rule import CycleRule, size_factor
from fatigue.readers.neutral.body.throats import WeldThroat
from fatigue.readers.neutral.body.welds import Weld


@dataclass(frozen=True, slots=True)
class RatedCurve:
    """A curve as this assessment uses it: at a survival level, with the rules that turn cycles into damage."""

    curve: SNCurve
    survival: str
    rule: CycleRule
    thickness_rule: ThicknessRule

    def size(self, thickness: NDArray[np.float64]) -> NDArray[np.float64]:
        """Factor of plates of some thickness [mm] on the range, see ``size_factor``."""
        return size_factor(thickness, self.curve, self.thickness_rule)


@dataclass(frozen=True, slots=True)
class AskedCurve:
    """A curve that something asks for: its name, where that is said, and the stress it is to serve.

    ``use`` is ``toe`` or one of ``Applies`` other than ``dS`` and ``structural``, which serve a toe; ``root`` is the
    structural stress of a throat, which a curve for throats, for structural stress or for dS may serve.
    """

    name: str
    where: str
    use: str = "toe"
    quantity: Quantity = "normal"


def asked_curves(case: Case, welds: Sequence[Weld], throats: Iterable[WeldThroat] = ()) -> list[AskedCurve]:
    """Curves that the case and its welds ask for, normal stress and shear at the toe, and those of the throats."""
    file, of_throats = case.body.welds, case.body.weld_throats
    return [
        AskedCurve(case.curve.name, f"{case.path.name}: curve.name"),
        *(AskedCurve(w.curve, f"{file}: weld {w.name}: curve") for w in welds if w.curve),
        *(
            AskedCurve(w.curve_shear, f"{file}: weld {w.name}: curve_shear", quantity="shear")
            for w in welds
            if w.curve_shear
        ),
        *(curve for throat in throats for curve in _of_throat(throat, f"{of_throats}: weld {throat.weld}")),
    ]


def _of_throat(throat: WeldThroat, where: str) -> Iterator[AskedCurve]:
    yield AskedCurve(throat.curve, f"{where}: curve", use="throat")
    yield AskedCurve(throat.curve_shear, f"{where}: curve_shear", use="throat", quantity="shear")
    if throat.curve_root:
        yield AskedCurve(throat.curve_root, f"{where}: curve_root", use="root")


def curves_of_case(case: Case) -> dict[str, SNCurve]:
    """Curves of the catalogue and of the case, which may not redefine a key of the catalogue."""
    shipped = catalogue()
    refuse(
        CaseError,
        (
            Problem(
                "duplicate_curve",
                f"{case.path.name}: curves.{name}",
                "is a curve of the catalogue",
                "Choose another name",
            )
            for name in case.curves
            if name in shipped
        ),
    )
    return dict(shipped) | {name: _own_curve(name, given) for name, given in case.curves.items()}


def _own_curve(name: str, given: CustomCurve) -> SNCurve:
    return user_curve(
        name=name,
        slopes=given.slopes,
        knees_cycles=given.knees_cycles,
        range_at_2e6=given.range_at_2e6_MPa,
        applies=given.applies,
        source=given.source,
        log10_scatter=given.log10_scatter,
        thickness_reference=given.thickness_reference_mm,
        thickness_exponent=given.thickness_exponent or 0.0,
        edition=given.edition,
        clause=given.clause,
        status=given.status,
    )


def rated_curves(case: Case, curves: Mapping[str, SNCurve], asked: Sequence[AskedCurve]) -> dict[str, RatedCurve]:
    """Every curve that is asked for, rated; all that is wrong with them is refused at once."""
    rated: dict[str, RatedCurve] = {}
    problems: list[Problem] = []
    for name, where in {one.name: one.where for one in asked}.items():
        if name not in curves:
            known = ", ".join(sorted(curves))
            problems.append(
                Problem(
                    "unknown_curve",
                    where,
                    f"there is no curve '{name}'",
                    f"Choose one of {known}, or add [curves.{name}]",
                )
            )
            continue
        curve = curves[name]
        if case.curve.mean_stress == "asme" and curve.applies != "dS":
            problems.append(
                Problem(
                    "mean_stress",
                    where,
                    f"mean_stress = 'asme' belongs to the master curve and does not apply to curve '{name}'",
                    'Set mean_stress = "none", or use a curve in dS',
                )
            )
            continue
        try:
            law = damage_law(curve, case.curve.survival, case.curve.extension, case.curve.knee_cycles)
        except CaseError as error:
            problems += [replace(p, where=f"{case.path.name}: {p.where}") for p in error.problems]
            continue
        rated[name] = RatedCurve(
            curve=curve,
            survival=survival_level(curve, case.curve.survival),
            rule=_cycle_rule(case, curve, law),
            thickness_rule=case.curve.thickness_rule,
        )
    refuse(CaseError, problems)
    return rated


def _cycle_rule(case: Case, curve: SNCurve, law: DamageLaw) -> CycleRule:
    """Rule of the cycles of a curve; f_M belongs to curves in dS, and is not even shown beside others."""
    on_dS = curve.applies == "dS"
    return CycleRule(law, on_dS, case.curve.yield_MPa if on_dS else None, case.curve.mean_stress == "asme")
