"""The same mistake in many columns, told once: fifty coordinates in m are one mistake, not fifty."""

import re
from collections.abc import Iterable, Sequence
from dataclasses import replace

from fatigue.errors import Problem
from fatigue.shown import few

ONE_BY_ONE = 5  # columns with the same mistake; more are told together
PLACES = 8  # names and spans of names in one list
_OF_A_COLUMN = re.compile(r"(?P<file>.*?): column (?P<name>.+?)(?P<rest>, row [^,]+)?", re.DOTALL)
_NUMBERED = re.compile(r"(.*?)(0|-?[1-9]\d{0,17})", re.DOTALL)


def told_once(problems: Iterable[Problem], one_by_one: int = ONE_BY_ONE) -> list[Problem]:
    """Problems in their order; those that say the same of more than so many columns of a file are one with a count."""
    same: dict[tuple[str, str, str, str], list[Problem]] = {}
    for problem in problems:
        found = _OF_A_COLUMN.fullmatch(problem.where)
        place = problem.where if found is None else found["file"] + ": column"
        same.setdefault((problem.code, place, problem.what, problem.remedy), []).append(problem)
    return [told for group in same.values() for told in (group if len(group) <= one_by_one else [_together(group)])]


def column_list(names: Sequence[str]) -> str:
    """Names of columns, neighbours that only count on as a span.

    >>> column_list(["time_s", "q_1", "q_2", "q_3", "q_7"])
    'time_s, q_1 to q_3, q_7'
    """
    spans: list[list[str]] = []
    for name in names:
        if spans and _counts_on(spans[-1][-1], name):
            spans[-1].append(name)
        else:
            spans.append([name])
    shown = [[f"{span[0]} to {span[-1]}"] if len(span) > 2 else span for span in spans]
    return few([text for texts in shown for text in texts], PLACES)


def _counts_on(before: str, after: str) -> bool:
    one, other = _NUMBERED.fullmatch(before), _NUMBERED.fullmatch(after)
    return bool(one and other and one[1] == other[1] and int(other[2]) == int(one[2]) + 1)


def _together(group: Sequence[Problem]) -> Problem:
    """One problem for those of several columns of a file, the first row named where rows differ."""
    found = [_OF_A_COLUMN.fullmatch(problem.where) for problem in group]
    parts = [match for match in found if match is not None]
    if len(parts) < len(group):
        return replace(group[0], count=len(group))
    names, rests = [match["name"] for match in parts], [match["rest"] or "" for match in parts]
    rest = rests[0] if len(set(rests)) == 1 else f" (the first: {names[0]}{rests[0]})"
    where = f"{parts[0]['file']}: {len(names)} columns, {column_list(names)}{rest}"
    return replace(group[0], where=where, count=sum(problem.count for problem in group))
