"""What is wrong with the checks of a case: keys of an interaction or an endurance check that do not fit together."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from fatigue.case.problems import absent, clash
from fatigue.errors import Problem

LINE_KEYS = ("perp", "par", "shear")  # of [[checks.endurance]]: the component of each line
NEEDED = {"en1993": (), "iiw": ("cv", "damage_limit"), "en1999": ("damage_limit",)}  # keys of each rule
LARGEST_KAPPA = 2.0  # beyond it u_perp^2 + u_par^2 - kappa u_perp u_par is negative for some stresses
MADE_BY = {  # what makes a check: a table of the case and a key in it
    **dict.fromkeys(("throat_perp", "throat_par", "throat_root"), ("body", "weld_throats")),
    **dict.fromkeys(("hot_spot", "nominal", "parent"), ("body", "stress_points")),
    "interaction": ("checks", "interaction"),
    "endurance": ("checks", "endurance"),
}


def interaction_problems(
    rule: str, welds: Sequence[str], cv: float | None, damage_limit: float | None, alpha: float | None
) -> Iterator[Problem]:
    """Refusals of an interaction whose rule lacks a key, or cannot use one."""
    yield from _twice("welds", welds)
    if rule == "dnv":
        what = (
            "'dnv' compares principal stress ranges, which need the stress along the weld, and line forces do not "
            "have it"
        )
        yield clash("rule", what, "Use 'en1993', 'iiw' or 'en1999', or a hot spot in stress_points with its planes")
        return
    for key, value in (("cv", cv), ("damage_limit", damage_limit), ("alpha", alpha)):
        if key in NEEDED[rule] and value is None:
            what = f"the key is missing although rule = '{rule}' is given, and it has no default"
            yield absent(key, what, "Give it, from the edition you work by")
        if key not in NEEDED[rule] and value is not None:
            users = " and ".join(f"'{one}'" for one, keys in NEEDED.items() if key in keys) or "'dnv'"
            yield clash(
                key, f"{value:g} is given, and rule '{rule}' has no use for it", f"Remove it; it is for {users}"
            )


def endurance_problems(
    lines: Mapping[str, str], curve: str | None, kappa: Sequence[float], limit: float | None
) -> Iterator[Problem]:
    """Refusals of an endurance check without line and curve, or with a combination of what it does not look at."""
    if not lines and curve is None:
        remedy = "Give a line for perp, par or shear, or a curve"
        yield absent("perp", "neither an endurance line nor a curve is given", remedy)
    if limit is not None and len(lines) < 2:
        what = f"limit = {limit:g} is given for {len(lines)} line{'' if len(lines) == 1 else 's'}"
        yield clash("limit", what, "Give lines of two components or three, or remove it")
    if kappa and limit is None:
        what = "the key is missing although kappa is given, and it has no default"
        yield absent("limit", what, "Give the largest sum of the combination")
    if kappa and not {"perp", "par"} <= lines.keys():
        what = f"{list(kappa)} is given without lines of both perp and par, whose product it multiplies"
        yield clash("kappa", what, "Give both lines or remove it")
    beyond = [one for one in kappa if abs(one) > LARGEST_KAPPA]
    if beyond:
        what = f"with {beyond[0]:g} the combination is negative for some stresses"
        yield clash("kappa", what, f"Give coefficients from -{LARGEST_KAPPA:g} to {LARGEST_KAPPA:g}")


def place_problems(welds: Sequence[str], points: Sequence[str], *, by_default: bool) -> Iterator[Problem]:
    """Refusals of where an endurance check is made; ``by_default`` welds can be looked at."""
    yield from _twice("welds", welds)
    yield from _twice("points", points)
    if (welds or not points) and not by_default:
        what = "a line for the stress along the weld is given for welds, and line forces do not have this stress"
        yield clash("par", what, "Give points alone, or remove it and keep in mind what is not looked at")


def unused_files(
    static_cases: str | None, endurance_lines: str | None, checks: int, lines: Sequence[str]
) -> Iterator[Problem]:
    """Refusals of files that no check needs, and of checks without their files."""
    if checks and static_cases is None:
        what = "the key is missing although [[checks.endurance]] is given"
        yield absent("static_cases", what, "Give the file of the static load cases")
    if static_cases is not None and not checks:
        what = f"static_cases = {static_cases!r} is given, and no [[checks.endurance]] compares its cases"
        yield clash("static_cases", what, "Add [[checks.endurance]] or remove it")
    if lines and endurance_lines is None:
        what = f"the key is missing although [[checks.endurance]] names the line '{lines[0]}'"
        yield absent("endurance_lines", what, "Give the file of the endurance lines")
    if endurance_lines is not None and not lines:
        what = f"endurance_lines = {endurance_lines!r} is given, and no [[checks.endurance]] names a line"
        yield clash("endurance_lines", what, "Name a line for perp, par or shear, or remove it")


def counts_problems(raw: dict[str, Any]) -> Iterator[Problem]:
    """Refusal of every check in ``[checks] counts`` that the case does not ask for: it would decide nothing."""
    checks = raw.get("checks")
    counts = checks.get("counts") if isinstance(checks, dict) else None
    for check in counts if isinstance(counts, list) else ():
        table, key = MADE_BY.get(check, ("", "")) if isinstance(check, str) else ("", "")
        given = raw.get(table)
        if table and not (isinstance(given, dict) and given.get(key)):
            what = f"{check!r} is to decide, but {table}.{key} is not given"
            yield clash("checks.counts", what, f"Give {table}.{key}, or remove {check!r}")


def _twice(key: str, names: Sequence[str]) -> Iterator[Problem]:
    """Refusal of a name that is listed twice."""
    again = [name for i, name in enumerate(names) if name in names[:i]]
    if again:
        yield clash(key, f"names '{again[0]}' twice", "Name it once")
