"""Numbers and cells as programs write them: decimal commas, Fortran exponents (1.0D+03, 1.0+103), quotation marks."""

import csv
import re
from typing import Literal

import pyarrow as pa
import pyarrow.compute as pc

Decimal = Literal[".", ","]

_MANTISSA = {".": r"(?:\d+\.?\d*|\.\d+)", ",": r"(?:\d+,?\d*|,\d+)"}
_POINTED = {".": r"(?:\d+\.\d*|\.\d+)", ",": r"(?:\d+,\d*|,\d+)"}
_NUMBER: dict[Decimal, re.Pattern[str]] = {
    decimal: re.compile(
        rf"[+\u2212-]?(?:{_MANTISSA[decimal]}(?:[EDQ][+-]?\d+)?|{_POINTED[decimal]}[+-]\d{{1,3}})\Z",
        re.IGNORECASE | re.ASCII,
    )
    for decimal in (".", ",")
}
_GAP = re.compile(r"(?:[+-]?(?:nan|inf|infinity)|n/?a|null|-?nan\(ind\)|[+-]?1[.,]#\w+|)\Z", re.IGNORECASE | re.ASCII)
_WORDS = re.compile(r"\"((?:[^\"]|\"\")*)\"|'([^']*)'|([^\s]+)")
_TOUCHING = re.compile(r"(\d[.,]?\d*[EDed][+-]?\d{2,3})(?=[+-]\.?\d)")
_FORTRAN = r"^\s*([+-]?(?:\d+\.?\d*|\.\d+))[DdQq]([+-]?\d+)\s*$"
_LETTERLESS = r"^\s*([+-]?(?:\d+\.\d*|\.\d+))([+-]\d{1,3})\s*$"
_PLAIN = r"^\s*[+-]?(?:\d+\.?\d*|\.\d+)(?:[Ee][+-]?\d+)?\s*$"


def is_number(text: str, decimal: Decimal) -> bool:
    """Whether a cell is a number, with a Fortran exponent perhaps."""
    return _NUMBER[decimal].match(text) is not None


def is_gap(text: str) -> bool:
    """Whether a cell is empty or says that its number is missing or infinite."""
    return _GAP.match(text) is not None


def plain_number(text: str, decimal: Decimal) -> str:
    """Number as Python and Arrow read it: decimal point, exponent after an E; any other text as it is."""
    if not is_number(text, decimal):
        return text
    text = re.sub("[DQ]", "E", text.upper().replace(",", ".").replace("\u2212", "-"))
    return text if "E" in text else re.sub(r"(?<=[\d.])([+-]\d{1,3})\Z", r"E\1", text)


def written_apart(line: str) -> str:
    """Line with a blank between numbers of Fortran's fixed columns, where a sign follows an exponent at once."""
    return _TOUCHING.sub(r"\1 ", line)


def split_fields(line: str, separator: str | None) -> list[str]:
    """Cells of a line, trimmed and without quotation marks; ``None`` divides at blanks; empty ones at the end go."""
    if separator is None:
        fields = [a.replace('""', '"') or b or c for a, b, c in _WORDS.findall(written_apart(line))]
    else:
        try:
            fields = [f.strip().strip("'\"").strip() for f in next(csv.reader([line], delimiter=separator), [])]
        except csv.Error:  # a cell beyond all bounds, a stray carriage return
            fields = [f.strip().strip("'\"").strip() for f in line.split(separator)]
    while fields and not fields[-1]:
        fields.pop()
    return fields


def as_numbers(column: pa.ChunkedArray, decimal: Decimal | None) -> pa.ChunkedArray | None:
    """Numbers of a column of texts, empty cells as null; None if a cell is anything else.

    Where the decimal sign is not known, all have one or the other.
    """
    if decimal is None:
        pointed = as_numbers(column, ".")
        return as_numbers(column, ",") if pointed is None else pointed
    texts = pc.replace_substring(column.cast(pa.string()), "\u2212", "-")
    if decimal == ",":
        texts = pc.if_else(pc.match_substring(texts, "."), pa.scalar("?"), pc.replace_substring(texts, ",", "."))
    for pattern in (_FORTRAN, _LETTERLESS):
        texts = pc.replace_substring_regex(texts, pattern, r"\1E\2")
    texts = pc.utf8_trim_whitespace(texts)
    texts = pc.if_else(pc.equal(texts, ""), pa.scalar(None, pa.string()), texts)
    if pc.all(pc.match_substring_regex(texts, _PLAIN)).as_py() is False:  # None: all cells are empty
        return None
    return texts.cast(pa.float64())
