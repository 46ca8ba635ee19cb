"""What is found about a modal basis under one heading: sentences, rows of a table, and what cannot be had and why."""

from dataclasses import dataclass
from typing import Any

from fatigue.errors import Problem


@dataclass(frozen=True, slots=True)
class Finding:
    """One thing that was looked at.

    Attributes
    ----------
    table : its name among the tables of ``fatigue.results.dictionary.basis``, also of the file
    heading : of text and page
    said : sentences that sum it up
    rows : frozen dataclasses whose fields are the columns of the table
    notes : what could not be had, and why; what the numbers assume
    warnings : doubts that a reader has to see
    """

    table: str
    heading: str
    said: tuple[str, ...] = ()
    rows: tuple[Any, ...] = ()
    notes: tuple[str, ...] = ()
    warnings: tuple[Problem, ...] = ()
