"""Blocks of a results table in an OP2 file: an identification of 146 words, and the data that follow it."""

import re
from collections.abc import Iterator
from dataclasses import dataclass

from fatigue.errors import DataError, Problem
from fatigue.readers.foreign.fe.static_case import Heading, heading
from fatigue.readers.foreign.nastran.results.analysis import MODES
from fatigue.readers.foreign.nastran.results.op2_records import Op2File, Op2Table, Record, characters, text_of

_ID_WORDS = 146
_FIELD_WORDS = 32  # of title, subtitle and label, from word 51 on
_SUPERELEMENT_AT = 99  # first character in the subtitle
_SUPERELEMENT = re.compile(r"SUPERELEMENT\s+(\d+)\b")


@dataclass(frozen=True, slots=True)
class Identification:
    """The words of an identification record that say what the next record holds."""

    approach: int
    table_code: int
    element_type: int
    subcase: int
    mode: int
    format_code: int
    words_per_row: int
    stress_code: int
    is_thermal: bool
    eigenvalue: float  # word 6
    own: tuple[float, float]  # words 14 and 16, in force tables of MSC Nastran the eigenvalue and the frequency
    superelement: int
    heading: Heading

    @property
    def key(self) -> tuple[int, int]:
        """Subcase and mode; word 5 of a static subcase is a load set or nothing."""
        return self.subcase, self.mode if self.approach == MODES else 0

    @property
    def is_modal(self) -> bool:
        """Whether the block belongs to a mode, sorted by mode."""
        return self.approach == MODES and self.mode > 0 and self.table_code < 1000


def _is_head(op2: Op2File, record: Record) -> bool:
    """Whether a record has the length of an identification, which no number of whole rows has."""
    return sum(chunk.length * chunk.number for chunk in record) == _ID_WORDS * op2.word


def heads(op2: Op2File, table: Op2Table) -> Iterator[Identification]:
    """Identifications of a table that is not decoded further."""
    return (_identification(op2, record) for record in table.records if _is_head(op2, record))


def blocks(op2: Op2File, table: Op2Table) -> Iterator[tuple[Identification, Record]]:
    """Identification and data of every block of a results table; the data may be cut into several records."""
    starts = [k for k, record in enumerate(table.records) if _is_head(op2, record)]
    if not table.records:
        return
    if starts[:1] != [0]:
        words = sum(chunk.length * chunk.number for chunk in table.records[0]) // op2.word
        raise damaged(op2, table, f"an identification record of {words} words, not {_ID_WORDS}")
    for start, end in zip(starts, [*starts[1:], len(table.records)], strict=True):
        head = _identification(op2, table.records[start])
        body = tuple(chunk for record in table.records[start + 1 : end] for chunk in record)
        if end == start + 1:
            raise damaged(op2, table, f"no data follow the identification of subcase {head.subcase} mode {head.mode}")
        yield head, body


def damaged(op2: Op2File, table: Op2Table, found: str) -> DataError:
    """Refusal of a table whose content contradicts itself."""
    return DataError(
        Problem(
            "op2_table_damaged",
            f"{op2.path}, table {table.name}",
            found,
            "Copy the file again in binary mode, or repeat the run",
        )
    )


def _identification(op2: Op2File, record: Record) -> Identification:
    """Decode an identification record."""
    raw = op2.record(record)
    words, reals = raw.view(f"{op2.order}i{op2.word}"), raw.view(f"{op2.order}f{op2.word}")
    size = _FIELD_WORDS * op2.word
    fields = [raw[at : at + size].tobytes() for at in range(raw.size - 3 * size, raw.size, size)]
    texts = [text_of(field, op2.word) for field in fields]  # title, subtitle and label
    return Identification(
        approach=int(words[0]) // 10,  # the last digit is the device
        table_code=int(words[1]),
        element_type=int(words[2]),
        subcase=int(words[3]),
        mode=int(words[4]),
        format_code=int(words[8]),
        words_per_row=int(words[9]),
        stress_code=int(words[10]),
        is_thermal=int(words[22]) == 1,
        eigenvalue=float(reals[5]),
        own=(float(reals[13]), float(reals[15])),
        superelement=_superelement(op2, fields, texts),
        heading=heading(*texts),
    )


def _superelement(op2: Op2File, fields: list[bytes], texts: list[str]) -> int:
    """Find the superelement's number behind the subtitle, 0: residual structure; a user's title may hold the word."""
    if found := _SUPERELEMENT.match(characters(fields[1], op2.word)[_SUPERELEMENT_AT:].strip()):
        return int(found[1])
    for text in texts:
        if found := _SUPERELEMENT.fullmatch(text):
            return int(found[1])
    return 0
