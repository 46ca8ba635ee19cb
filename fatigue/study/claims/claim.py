"""A sentence as a test: the ``[[claim]]`` tables of ``study.toml`` as frozen models."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Annotated, Any, Literal

from pydantic import Field, ValidationError
from pydantic_core import ErrorDetails

from fatigue.case.problems import absent, clash, model_problems
from fatigue.case.table import NotNegative, Positive, Table, Text
from fatigue.errors import CaseError, Problem, refuse
from fatigue.study.claims.expression import Expression, ExpressionError, parsed

Operator = Literal[">", "<", "between"]
Side = float | Expression

MOST_TOLERANCE = 1.0


class Claim(Table):
    """One sentence: two sides and what is said of them, or the reason why nothing can be said."""

    text: Text = Field(description="the sentence in the words of this study")
    paper: str = Field(default="", description="the sentence it comes from, or where it stands")
    left: Text | None = Field(default=None, description="quantity[:weld or pattern][name=value,...], or one / another")
    operator: Operator | None = Field(default=None, description="'>', '<' or 'between'")
    right: float | Text | Annotated[tuple[float | Text, ...], Field(strict=False)] | None = Field(
        default=None, description="a number or an expression as that of left; for 'between' a list of two of them"
    )
    factor: Positive = Field(default=1.0, description="a number above 0 that right is multiplied by")
    agree: Annotated[int, Field(ge=1)] | None = Field(
        default=None, description="the number of seeds that have to agree, by default three quarters of them"
    )
    seeds: Annotated[tuple[int, ...], Field(strict=False, min_length=1)] | None = Field(
        default=None, description="a list of the seeds it is tried under, by default all of the study"
    )
    tolerance: Annotated[NotNegative, Field(lt=MOST_TOLERANCE)] = Field(
        default=0.0, description="a share of the larger side up to which both are the same, so that neither is larger"
    )
    undecidable: Text | None = Field(
        default=None, description="instead of left, operator and right: the reason why nothing can be said of it"
    )

    @property
    def left_side(self) -> Expression | None:
        """Its left side; None where nothing can be said of it."""
        return None if self.left is None else parsed(self.left)

    @property
    def right_sides(self) -> tuple[Side, ...]:
        """Its right side, or the lower and the upper end of 'between'."""
        given = self.right if isinstance(self.right, tuple) else (self.right,)
        return tuple(parsed(one) if isinstance(one, str) else float(one) for one in given if one is not None)

    @property
    def expressions(self) -> tuple[Expression, ...]:
        """The expressions of both sides."""
        left = () if self.left_side is None else (self.left_side,)
        return (*left, *(side for side in self.right_sides if isinstance(side, Expression)))

    def statement(self) -> str:
        """What is tried, as one line of mathematics; "" where nothing can be said of it."""
        if self.left is None:
            return ""
        factor = "" if self.factor == 1.0 else f"{self.factor:g} x "
        right = " and ".join(
            f"{factor}{side:g}" if isinstance(side, float) else f"{factor}{side}" for side in self.right_sides
        )
        return f"{self.left_side} {self.operator} {right}"

    def needed(self, seeds: int) -> int:
        """How many of some seeds have to agree."""
        return self.agree if self.agree is not None else math.ceil(0.75 * seeds)

    def _contradictions(self) -> Iterator[Problem]:
        sides = {"left": self.left, "operator": self.operator, "right": self.right}
        given = [key for key, value in sides.items() if value is not None]
        if self.undecidable is not None:
            if given:
                what = f"{' and '.join(given)} and undecidable are given"
                yield clash(given[0], what, "Keep undecidable, or what is compared")
            return
        for key in sides.keys() - set(given):
            remedy = f"Give {Claim.model_fields[key].description}, or undecidable with the reason"
            yield absent(key, "the key is missing", remedy)
        if not isinstance(self.right, tuple):
            if self.operator == "between" and self.right is not None:
                yield clash("right", "'between' has one end", "Give a list of the lower and the upper end")
        elif len(self.right) != 2:
            yield clash("right", f"the list has {len(self.right)} items", "Give the lower and the upper end")
        elif self.operator in (">", "<"):
            yield clash("right", f"{self.operator!r} has two right sides", "Give one, or operator = 'between'")
        else:
            low, high = self.right
            if isinstance(low, float | int) and isinstance(high, float | int) and low > high:
                yield clash("right", f"the lower end {low:g} is above the upper end {high:g}", "Swap them")
        for key, text in self._texts():
            try:
                parsed(text)
            except ExpressionError as error:
                yield Problem("bad_expression", key, f"{text!r}: {error.what}", error.remedy)
        yield from self._of_seeds()

    def _texts(self) -> Iterator[tuple[str, str]]:
        if self.left is not None:
            yield "left", self.left
        for side in self.right if isinstance(self.right, tuple) else (self.right,):
            if isinstance(side, str):
                yield "right", side

    def _of_seeds(self) -> Iterator[Problem]:
        if self.seeds is None:
            return
        if len(set(self.seeds)) < len(self.seeds):
            yield Problem("duplicate", "seeds", "a seed is there twice", "Give each of them once")
        if self.agree is not None and self.agree > len(self.seeds):
            what = f"agree = {self.agree} can never be reached by {len(self.seeds)} seeds"
            yield clash("agree", what, f"Give at most {len(self.seeds)}")


def read_claims(raw: Sequence[Mapping[str, Any]], seeds: Sequence[int], file: str = "study.toml") -> tuple[Claim, ...]:
    """Claims of the ``[[claim]]`` tables of a study of some seeds.

    Raises
    ------
    CaseError : every mistake of every table
    """
    problems: list[Problem] = []
    claims: list[Claim] = []
    for number, table in enumerate(raw, 1):
        try:
            claims.append(Claim.model_validate(table))
        except ValidationError as error:
            problems += _mistakes(error, number, {"claim": list(raw)})
        else:
            problems += (replace(one, where=f"claim[{number}].{one.where}") for one in _of_seeds(claims[-1], seeds))
    refuse(CaseError, (replace(one, where=f"{file}: {one.where}") for one in problems))
    return tuple(claims)


def _of_seeds(claim: Claim, seeds: Sequence[int]) -> Iterator[Problem]:
    """Refusals of seeds that the study does not have, and of more that have to agree than there are."""
    known = ", ".join(map(str, seeds))
    if unknown := [seed for seed in claim.seeds or () if seed not in seeds]:
        what = f"the study has no seed {', '.join(map(str, unknown))}"
        yield Problem("unknown_seed", "seeds", what, f"Give some of {known}, or add it to seeds of the study")
    if claim.seeds is None and claim.agree is not None and claim.agree > len(seeds):
        what = f"agree = {claim.agree} can never be reached by the {len(seeds)} seeds of the study"
        yield clash("agree", what, f"Give at most {len(seeds)}, or add seeds to the study")


def _mistakes(error: ValidationError, number: int, raw: dict[str, Any]) -> list[Problem]:
    """Refusals of one table; a value that fits none of the types its key may have is reported once."""
    first: dict[tuple[str, str], Problem] = {}
    for details in error.errors():
        key = details["loc"][:1]
        place: ErrorDetails = {**details, "loc": ("claim", number - 1, *key)}
        for problem in model_problems(place, {(): Claim, ("claim",): Claim}, raw):
            of_right = key == ("right",) and problem.code == "bad_value"
            told = replace(problem, what=f"{raw['claim'][number - 1]['right']!r} is no side") if of_right else problem
            first.setdefault((told.where, told.what), told)
    return list(first.values())
