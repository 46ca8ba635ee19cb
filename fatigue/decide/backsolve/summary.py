"""What is said of answers: the body, every weld, and what is held while one thing changes."""

import textwrap
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from typing import Any

from fatigue.decide.backsolve.question import Question
from fatigue.decide.backsolve.rows import AnswerRow
from fatigue.decide.text_lines import aligned
from fatigue.errors import Problem
from fatigue.report.wording import number
from fatigue.shown import shortened, visible

WELDS_TOLD = 40
WIDTH = 110
HELD = {
    "load": "One factor on all stresses, dead load and offsets included; mission and curves are held.",
    "curve": "One factor on the ranges of the curve, its knees at the same numbers of cycles; stresses are held.",
    "km_per_year": "The mission and its mix are held; only the pace changes.",
    "share": "The other events keep their proportions; events by number and cycles across events are held.",
    "thickness": "Nodal forces are held, so that membrane stress falls with 1/t and bending stress with 1/t^2. "
    "Stiffness, mass, modes, load path and the length of the end treatment are held too: a new FE run decides.",
}
ASKED = {
    "load": "load factor",
    "curve": "factor on the curve",
    "km_per_year": "km per year",
    "share": "share",
    "thickness": "thickness [mm]",
}


@dataclass(frozen=True, slots=True)
class Answers:
    """What just meets a target: of the body, and of every weld.

    Attributes
    ----------
    title : of the case
    asked : the question with its target
    held : what stays as it is
    points : which were counted where cycles were counted; empty where none were
    rows : the body first, then the welds, that which decides first
    """

    title: str
    asked: Question
    held: str
    points: str
    rows: tuple[AnswerRow, ...]
    warnings: tuple[Problem, ...] = ()
    written: tuple[str, ...] = ()

    @property
    def body(self) -> AnswerRow:
        """Answer for the whole body."""
        return self.rows[0]

    @property
    def solved(self) -> bool:
        """Whether the target can be met at every weld."""
        return all(row.state != "none" for row in self.rows)

    @property
    def verdict(self) -> str:
        """The answer for the body in one sentence."""
        row, of = self.body, ASKED[self.asked.of]
        target = f"{number(self.asked.target_km)} km"
        if self.asked.of == "km_per_year":
            target = f"{self.asked.years:g} years"
        if self.asked.of == "share":
            of = f"share of '{visible(self.asked.event)}'"
        if row.state == "any":
            return f"{target} are met whatever the {of.removesuffix(' [mm]')}"
        if row.state == "none":
            ends = f"; utilisation {number(row.utilisation_at_0)} at 0, {number(row.utilisation_at_1)} at 1"
            return f"no {of.removesuffix(' [mm]')} meets {target}{ends if self.asked.of == 'share' else ''}"
        side = {"at_most": "at most", "at_least": "at least"}[row.sense]
        if self.asked.of == "thickness":
            return f"{target} need {side} {number(row.factor)} times the thickness"
        return f"{target} {'allow' if row.sense == 'at_most' else 'need'} a {of} of {side} {number(row.answer)}"

    @property
    def notes(self) -> dict[str, str]:
        """What is to be known about answers, and whose."""
        notes = dict.fromkeys(row.note for row in self.rows if row.note)
        return {note: ", ".join(_having(self.rows, note)) for note in notes}

    def as_record(self) -> dict[str, Any]:
        """Record for machines."""
        return asdict(self) | {"verdict": self.verdict, "solved": self.solved}

    def as_text(self) -> str:
        """Text for people: the verdict, a line for each weld, what is held."""
        welds = self.rows[1:]
        lines = [f"{visible(self.title)}: {self.verdict}", "", *_table(self.asked, welds[:WELDS_TOLD])]
        if len(welds) > WELDS_TOLD:
            lines.append(f"and {len(welds) - WELDS_TOLD} welds that ask for less; -o writes all")
        told = [
            textwrap.fill(f"- {whose}: {note}", WIDTH, subsequent_indent="  ") for note, whose in self.notes.items()
        ]
        lines += ["", *told] if told else []
        lines += ["", *(textwrap.fill(text, WIDTH) for text in (self.held, self.points) if text)]
        lines += [f"written: {', '.join(self.written)}"] if self.written else []
        return "\n".join(lines)


def _having(rows: tuple[AnswerRow, ...], note: str) -> list[str]:
    names = [shortened(visible(row.weld)) or "the whole body" for row in rows if row.note == note]
    return names if len(names) <= 4 else [*names[:3], f"{len(names) - 3} more"]


def answer_words(row: AnswerRow) -> str:
    """An answer in a cell: the number, or why there is none."""
    return number(row.answer) if row.state == "solved" else row.state


def _table(asked: Question, rows: tuple[AnswerRow, ...]) -> Iterator[str]:
    """Lines of a table of welds."""
    heads = ["weld", "node", "face", "now", ASKED[asked.of]]
    is_between = any(row.basis == "histogram" for row in rows)
    heads += ["low", "high"] if is_between else []
    if asked.of == "share":
        heads += ["at least", "at most", "u at 0", "u at 1"]
    if asked.of == "thickness":
        heads += ["factor"]
    heads += ["utilisation now", "|u - 1|", "basis"]
    cells = []
    for row in rows:
        line = [shortened(visible(row.weld), 34), str(row.node), row.surface, number(row.now), answer_words(row)]
        line += [number(row.low), number(row.high)] if is_between else []
        if asked.of == "share":
            of_span = (row.share_at_least, row.share_at_most, row.utilisation_at_0, row.utilisation_at_1)
            line += [number(value) for value in of_span]
        if asked.of == "thickness":
            line += [number(row.factor)]
        proof = f"{row.deviation:.1e}" if row.deviation == row.deviation else "-"
        line += [number(row.utilisation_now), proof, row.basis]
        cells.append(line)
    yield from aligned([heads, *cells], right=[1, *range(3, len(heads) - 1)])
