"""What a case compares: static load cases with endurance lines or curves, damage sums with each other."""

import difflib
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from fatigue.case import Case, EnduranceCheck, Interaction
from fatigue.errors import CaseError, Problem, refuse
from fatigue.life.curves import SNCurve
from fatigue.life.endurance.haigh import EnduranceLine
from fatigue.pipeline.solve.rated.rated_curves import AskedCurve, RatedCurve
from fatigue.readers.neutral.body.coordinates import Coordinates
from fatigue.readers.neutral.body.welds import Weld
from fatigue.readers.neutral.endurance.endurance_lines import read_endurance_lines
from fatigue.readers.neutral.endurance.static_cases import CaseGroup, read_static_cases
from fatigue.readers.neutral.points.stress_points import StressPoints
from fatigue.shown import few
from fatigue.weld.beside.hot_spot import EDGE

MOST_CORNERS = 12  # alternating loads of which all 4^k / 2 pairs of corners are gone through, in a second a point


@dataclass(frozen=True, slots=True, eq=False)
class Compared:
    """Groups of static load cases and endurance lines by name; empty where a case compares none."""

    groups: Mapping[str, CaseGroup]
    lines: Mapping[str, EnduranceLine]

    def lines_of(self, check: EnduranceCheck) -> list[EnduranceLine]:
        """The lines of an endurance check."""
        return [self.lines[name] for name in check.lines.values()]


def read_compared(
    case: Case, coordinates: Coordinates, curves: Collection[str], *, strict: bool
) -> tuple[Compared, list[Problem]]:
    """Static load cases and endurance lines of a case, read and checked, and warnings about them.

    Raises
    ------
    DataError : with every mistake found in the file at fault
    """
    groups: Mapping[str, CaseGroup] = {}
    lines: Mapping[str, EnduranceLine] = {}
    warnings: list[Problem] = []
    if case.checks.static_cases is not None:
        groups, found = read_static_cases(case.resolve(case.checks.static_cases), coordinates, case.body.ignore_modes)
        warnings += found
    if case.checks.endurance_lines is not None:
        lines, found = read_endurance_lines(case.resolve(case.checks.endurance_lines), curves, strict=strict)
        warnings += found
    return Compared(groups, lines), warnings


def endurance_curves(case: Case, curves: Mapping[str, SNCurve]) -> Iterator[AskedCurve]:
    """Curves that the endurance checks of a case ask for, each for the stress that it is a curve of."""
    for number, check in enumerate(case.checks.endurance, 1):
        if check.curve is not None:
            where = f"{case.path.name}: checks.endurance[{number}].curve"
            quantity = curves[check.curve].quantity if check.curve in curves else "normal"
            yield AskedCurve(check.curve, where, use="endurance", quantity=quantity)


def refuse_wrong_checks(
    case: Case,
    welds: Sequence[Weld],
    points: StressPoints | None,
    compared: Compared,
    curves: Mapping[str, RatedCurve],
) -> None:
    """Refuse interactions and endurance checks that name what there is not, or what does not go together.

    ``welds`` are those to assess, ``points`` the stress points of the body.

    Raises
    ------
    CaseError : with every mistake found
    """
    file = case.path.name
    problems: list[Problem] = list(_of_counts(case, points))
    for number, interaction in enumerate(case.checks.interaction, 1):
        where = f"{file}: checks.interaction[{number}]"
        problems += _of_interaction(interaction, welds, where)
        if interaction in case.checks.interaction[: number - 1]:
            problems.append(Problem("duplicate", where, "is there already, with the same keys", "Remove one of them"))
    for number, check in enumerate(case.checks.endurance, 1):
        where = f"{file}: checks.endurance[{number}]"
        problems += _of_names(check, welds, points, compared, where)
        problems += _of_lines(check, compared, where)
        problems += _of_curve(check, points, compared, curves, where)
        if check in case.checks.endurance[: number - 1]:
            problems.append(Problem("duplicate", where, "is there already, with the same keys", "Remove one of them"))
    refuse(CaseError, problems)


def _of_counts(case: Case, points: StressPoints | None) -> Iterator[Problem]:
    """Refusal of a check that is to decide, and that no stress point is for."""
    kinds = {"hot_spot": ("hot_spot_a", EDGE), "nominal": ("nominal",), "parent": ("parent", "haz")}
    for check in case.checks.counts:
        if points is None or check not in kinds or set(kinds[check]) & set(points.kind):
            continue
        what = f"'{check}' is to decide, but {case.body.stress_points} has no point of kind {' or '.join(kinds[check])}"
        yield Problem("no_check", f"{case.path.name}: checks.counts", what, f"Add such a point, or remove '{check}'")


def looks_at_welds(check: EnduranceCheck) -> bool:
    """Whether an endurance check is made at welds, some or all of them."""
    return bool(check.welds) or not check.points


def endurance_range(rated: RatedCurve) -> float:
    """Equivalent range that a curve endures for ever: its cut-off, else its last knee; NaN where it has neither."""
    law = rated.rule.law
    if law.cutoff > 0.0:
        return law.cutoff
    return float(law.knees[-1]) if len(law.knees) else np.nan


def _of_interaction(interaction: Interaction, welds: Sequence[Weld], where: str) -> Iterator[Problem]:
    with_shear = [weld.name for weld in welds if weld.curve_shear]
    yield from _unknown(f"{where}.welds", interaction.welds, [weld.name for weld in welds], "welds to assess")
    known = {weld.name for weld in welds}
    bare = [name for name in interaction.welds if name in known and name not in with_shear]
    if bare:
        what = f"{few([repr(name) for name in bare])} of them has no curve for its shear stress"
        yield Problem("no_shear_curve", f"{where}.welds", what, "Give curve_shear in the table of welds")
    if not interaction.welds and not with_shear:
        what = "no weld to assess has a curve for its shear stress"
        yield Problem("no_shear_curve", where, what, "Give curve_shear in the table of welds")


def _of_names(
    check: EnduranceCheck, welds: Sequence[Weld], points: StressPoints | None, compared: Compared, where: str
) -> Iterator[Problem]:
    """Refusals of groups, welds and points that there are not."""
    yield from _unknown(f"{where}.welds", check.welds, [weld.name for weld in welds], "welds to assess")
    yield from _unknown(f"{where}.cases", [check.cases], list(compared.groups), "groups of static load cases")
    group = compared.groups.get(check.cases)
    if group is None:
        return
    if group.points and looks_at_welds(check):
        what = f"group '{group.name}' has stresses at points, and welds need amounts of coordinates"
        remedy = "Give points, or a group with columns q_<mode> and u_<name>"
        yield Problem("contradiction", f"{where}.cases", what, remedy)
    own = points.name if points else ()
    known = group.points or own
    of = f"points of group '{group.name}'" if group.points else "stress points"
    yield from _unknown(f"{where}.points", check.points, known, of)
    on_edges = [name for name in check.points if points and name in own and points.kind[own.index(name)] == EDGE]
    beyond = [key for key in ("par", "shear") if key in check.lines]
    if on_edges and beyond and not group.points:
        what = f"{few([repr(name) for name in on_edges])} is on the edge of a plate, which has stress along it alone"
        remedy = f"Check it by a line for perp in a table of its own, without {' and '.join(beyond)}"
        yield Problem("contradiction", f"{where}.points", what, remedy)


def _of_lines(check: EnduranceCheck, compared: Compared, where: str) -> Iterator[Problem]:
    """Refusals of lines that there are not or that are of another component, and of too many corners."""
    for key, name in check.lines.items():
        yield from _unknown(f"{where}.{key}", [name], list(compared.lines), "endurance lines")
        line = compared.lines.get(name)
        if line is not None and line.component != key:
            what = f"line '{name}' is for {line.component}, not for {key}"
            yield Problem("contradiction", f"{where}.{key}", what, f"Name it under {line.component}, or another line")
    group = compared.groups.get(check.cases)
    if check.limit is not None and group is not None and group.kind == "alternating":
        k = len(group.cases)
        if k > MOST_CORNERS:
            what = (
                f"the {k} alternating cases of group '{group.name}' have 2^{k} corners, and a combination needs "
                f"every pair of them"
            )
            remedy = f"Combine at most {MOST_CORNERS} cases, or leave limit out: components alone have no bound"
            yield Problem("many_corners", f"{where}.cases", what, remedy)


def _of_curve(
    check: EnduranceCheck,
    points: StressPoints | None,
    compared: Compared,
    curves: Mapping[str, RatedCurve],
    where: str,
) -> Iterator[Problem]:
    """Refusals of curves that have no endurance range, or none that a single pair of stresses tells."""
    rated = curves.get(check.curve or "")
    if rated is None:
        return
    if rated.curve.applies == "dS":
        what = f"curve '{check.curve}' is in the equivalent range dS, which no endurance limit is known for"
        yield Problem("endurance_curve", f"{where}.curve", what, "Name a curve in MPa with a cut-off or knee")
    elif np.isnan(endurance_range(rated)):
        what = f"curve '{check.curve}' has neither a cut-off nor a knee: every range damages"
        yield Problem("endurance_curve", f"{where}.curve", what, "Name a curve with one, or endurance lines")
    elif rated.curve.thickness_reference is not None and check.cases in compared.groups:
        given = set(compared.groups[check.cases].points) - set(points.name if points else ())
        bare = [name for name in check.points if name in given]
        if bare:
            what = f"curve '{check.curve}' has a thickness rule, and {few([repr(name) for name in bare])} no thickness"
            yield Problem("endurance_curve", f"{where}.curve", what, "Give the points in stress_points as well")


def _unknown(where: str, names: Sequence[str], known: Sequence[str], of: str) -> Iterator[Problem]:
    """Refusal of every name that is not known."""
    for name in names:
        if name not in known:
            near = difflib.get_close_matches(name, known, n=1)
            there = few([repr(one) for one in known]) if known else "none"
            remedy = f"Write {near[0]!r}" if near else f"Name one of the {of}: {there}"
            yield Problem("unknown_name", where, f"{name!r} is not one of the {of}", remedy)
