"""The table of the stress category in ``case.toml``: its limits where they are not those that are shipped."""

from collections.abc import Iterator

from pydantic import Field

from fatigue.case.problems import clash
from fatigue.case.table import Positive, Table, Text
from fatigue.errors import Problem
from fatigue.life.quality import StressCategories, shipped_categories


class StressCategory(Table):
    """From which stress utilisation on a weld is of a higher stress category."""

    medium_from: Positive = Field(description="the utilisation [-] from which the category is 'medium', above 0")
    high_from: Positive = Field(description="the utilisation [-] from which the category is 'high', above medium_from")
    source: Text = Field(description="where the limits come from, edition and clause")

    def _contradictions(self) -> Iterator[Problem]:
        if self.high_from <= self.medium_from:
            what = f"{self.high_from:g} is not above medium_from = {self.medium_from:g}"
            yield clash("high_from", what, "Give the limits in ascending order")


def stress_categories(asked: StressCategory | None) -> StressCategories:
    """Categories that a case asks for, else those that are shipped."""
    if asked is None:
        return shipped_categories()
    return StressCategories(shipped_categories().names, (asked.medium_from, asked.high_from), asked.source, "user")
