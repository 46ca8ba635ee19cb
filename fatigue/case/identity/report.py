"""The table ``[report]`` of ``case.toml``: who answers for a result, what it is of, and what its report looks like.

No number depends on it: it may come, change and go, and the result stays the same one.
"""

from collections.abc import Iterator
from datetime import date, datetime
from typing import Any

from pydantic import Field, field_validator

from fatigue.case.problems import path_problems
from fatigue.case.table import Table, Text
from fatigue.errors import Problem

LONGEST = 2000  # letters of an entry
PEOPLE = ("document", "revision", "date", "author", "checker", "approver")
"""What a report needs to be identified; without one of them it is a draft."""


class Report(Table):
    """Identity and look of the report; all keys are texts, and none of them changes a number."""

    document: Text | None = Field(default=None, description="the number of the document", max_length=LONGEST)
    revision: Text | None = Field(default=None, description="the revision of the document", max_length=LONGEST)
    date: Text | None = Field(default=None, description="the date of the revision, as in 2026-05-31")
    author: Text | None = Field(default=None, description="who prepared it", max_length=LONGEST)
    checker: Text | None = Field(default=None, description="who checked it", max_length=LONGEST)
    approver: Text | None = Field(default=None, description="who approved it", max_length=LONGEST)
    company: Text | None = Field(default=None, description="the company that answers for it", max_length=LONGEST)
    logo: Text | None = Field(
        default=None, description="the file of the logo (.png, .svg or .jpg, at most 1 MB), before that of the template"
    )
    vehicle: Text | None = Field(default=None, description="the vehicle and its configuration", max_length=LONGEST)
    fe_model: Text | None = Field(
        default=None, description="the finite element model, with its version", max_length=LONGEST
    )
    mbs_model: Text | None = Field(
        default=None, description="the multibody model, with its version", max_length=LONGEST
    )
    track: Text | None = Field(default=None, description="the track the loads come from", max_length=LONGEST)
    payload: Text | None = Field(default=None, description="the payload", max_length=LONGEST)
    wear: Text | None = Field(default=None, description="the state of wear of wheels and rails", max_length=LONGEST)
    standard: Text | None = Field(
        default=None, description="the standard the assessment follows, with its edition", max_length=LONGEST
    )
    template: Text | None = Field(
        default=None, description="the folder of a company template: template.toml with colours and texts, and a logo"
    )
    language: Text | None = Field(
        default=None,
        description="the language of headings, captions and verdicts: 'en' or 'de'; left out: as in the template",
    )

    @field_validator("date", mode="before")
    @classmethod
    def _as_day(cls, value: Any) -> Any:
        """A day, which TOML may hold as one; no time, and no day that no calendar has."""
        if isinstance(value, datetime) or not isinstance(value, str | date):
            raise ValueError(f"{value!r} is no date; give a day as in 2026-05-31")
        if isinstance(value, date):
            return value.isoformat()
        try:
            is_day = date.fromisoformat(value).isoformat() == value
        except ValueError:
            is_day = False
        if not is_day:
            raise ValueError(f'"{value[:60]}" is no date')
        return value

    def _contradictions(self) -> Iterator[Problem]:
        yield from path_problems({"logo": self.logo, "template": self.template})

    @property
    def is_empty(self) -> bool:
        """Whether the case says nothing of its report."""
        return not self.as_record()

    def as_record(self) -> dict[str, str]:
        """The entries that are given, by their keys."""
        return {key: str(value) for key, value in self if value is not None}
