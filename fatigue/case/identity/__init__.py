"""Who answers for a result: the table ``[report]`` of a case, and the case without it, on which its numbers depend."""

from fatigue.case.identity.numbers_text import numbers_text
from fatigue.case.identity.report import PEOPLE, Report

__all__ = ["PEOPLE", "Report", "numbers_text"]
