"""What every table of ``case.toml`` keeps: no unknown key, no conversion, and what contradicts itself is refused."""

from collections.abc import Iterator
from typing import Annotated, Self, TypeAlias

from pydantic import BaseModel, ConfigDict, Field, model_validator

from fatigue.case.problems import Contradictions
from fatigue.errors import Problem

Positive: TypeAlias = Annotated[float, Field(gt=0)]
NotNegative: TypeAlias = Annotated[float, Field(ge=0)]
Text: TypeAlias = Annotated[str, Field(min_length=1)]


class Table(BaseModel):
    """One table of the case: no unknown key, no conversion, no NaN or infinity, never changed once read."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, allow_inf_nan=False)

    @model_validator(mode="after")
    def _agrees_with_itself(self) -> Self:
        if problems := list(self._contradictions()):
            raise Contradictions(problems)
        return self

    def _contradictions(self) -> Iterator[Problem]:
        """Refusals of keys of this table that are fine alone and wrong together."""
        yield from ()
