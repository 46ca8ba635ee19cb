"""The known order of events: loops whose stints follow on one another, so that cycles across events are counted."""

from typing import Annotated

from pydantic import Field

from fatigue.case.table import NotNegative, Table, Text


class Sequence(Table):
    """One loop of events that is run again and again."""

    order: Annotated[tuple[Text, ...], Field(strict=False, min_length=1)] = Field(
        description="a list of the names of the events in their order, cyclic; an entry stands for some passes in a row"
    )
    per_1000_km: NotNegative = Field(description="how often the loop is run in 1000 km [-], at least 0")
