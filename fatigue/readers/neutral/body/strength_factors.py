"""Factors on S-N curves from a table of the user: what a standard asks for beside the curve, clause by clause."""

import math
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, TypeAlias, cast

from fatigue.errors import Problem
from fatigue.readers.neutral.tables import open_table

Role: TypeAlias = Literal["strength", "stress", "limit"]
ROLES = ("strength", "stress", "limit")


@dataclass(frozen=True, slots=True)
class StrengthFactor:
    """One factor on a curve.

    ``role`` says what it does: ``strength`` divides the range, ``stress`` multiplies it, ``limit`` multiplies the
    damage limit. ``clause`` and ``edition`` say where it comes from.
    """

    curve: str
    factor: str
    role: Role
    value: float
    clause: str
    edition: str
    note: str


def read_strength_factors(
    path: Path, curves: Collection[str], *, strict: bool
) -> tuple[tuple[StrengthFactor, ...], list[Problem]]:
    """Read ``curve, factor, role, value, clause, edition`` and, where present, ``note``, in the file's order.

    ``curves`` are the names a curve may have.

    Raises
    ------
    DataError : a value or a clause is empty, a curve is unknown, or a factor is given twice for a curve
    """
    table = open_table(path, texts=("curve", "factor", "role", "clause", "edition", "note"))
    table.expect(("curve", "factor", "role", "value", "clause", "edition"), ("note",), strict=strict)
    names, code = table.groups("curve")
    factors, factor_code = table.groups("factor")
    role = table.texts("role")
    table.choices("role", role, ROLES)
    table.known("curve", names, code, set(curves), "the curves")
    table.unique({"curve": code, "factor": factor_code}, {"curve": names, "factor": factors})
    value = table.numbers("value", above=0.0)
    clause, edition, note = table.texts("clause"), table.texts("edition"), table.texts("note", default="")
    table.refuse()
    return tuple(
        StrengthFactor(
            curve=names[code[i]],
            factor=factors[factor_code[i]],
            role=cast(Role, role[i]),
            value=float(value[i]),
            clause=clause[i],
            edition=edition[i],
            note=note[i],
        )
        for i in range(table.rows)
    ), table.warnings


def on_range(factors: Sequence[StrengthFactor]) -> float:
    """Factor on every range: stress roles over strength roles; exactly 1 without any."""
    stress = math.prod(one.value for one in factors if one.role == "stress")
    return stress / math.prod(one.value for one in factors if one.role == "strength")


def on_limit(factors: Sequence[StrengthFactor]) -> float:
    """Factor on the damage limit."""
    return math.prod(one.value for one in factors if one.role == "limit")
