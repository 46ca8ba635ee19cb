"""What is said of a modal basis: heading by heading, for people and for machines."""

import textwrap
from dataclasses import asdict, dataclass
from typing import Any

from fatigue.basis.finding import Finding
from fatigue.errors import Problem
from fatigue.shown import visible

WIDTH = 110


@dataclass(frozen=True, slots=True)
class Basis:
    """Whether the modal basis of a case is complete enough, as far as the case tells; ``written`` are its files."""

    title: str
    findings: tuple[Finding, ...]
    warnings: tuple[Problem, ...]
    written: tuple[str, ...] = ()

    def as_record(self) -> dict[str, Any]:
        """Record for machines: sentences, rows and notes of each finding by the name of its table."""
        return {
            "title": self.title,
            "findings": {
                finding.table: {
                    "heading": finding.heading,
                    "said": list(finding.said),
                    "rows": [asdict(row) for row in finding.rows],
                    "notes": list(finding.notes),
                }
                for finding in self.findings
            },
            "warnings": [asdict(problem) for problem in self.warnings],
            "written": list(self.written),
        }

    def as_text(self) -> str:
        """Text for people; rows are in the tables."""
        parts = [f"{visible(self.title)}: modal basis"]
        for finding in self.findings:
            lines = [finding.heading, *(_indented(one, "  ", "    ") for one in finding.said)]
            lines += [_indented(f"- {one}", "  ", "    ") for one in finding.notes]
            parts.append("\n".join(lines))
        if self.written:
            parts.append(f"written: {', '.join(self.written)}")
        return "\n\n".join(parts)


def _indented(sentence: str, first: str, then: str) -> str:
    """A sentence broken into lines."""
    return textwrap.fill(visible(sentence), WIDTH, initial_indent=first, subsequent_indent=then)
