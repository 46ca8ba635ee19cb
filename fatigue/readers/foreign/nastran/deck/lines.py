"""A NASTRAN or OptiStruct deck as lines: files joined by INCLUDE, cut into control sections and bulk data."""

import gzip
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from fatigue.errors import DataError, Problem, refuse
from fatigue.readers.foreign.nastran.deck.include import find_include, include_name, is_include

Line = tuple[str, int, str]
"""File, line number, and text without comment and without blanks at its end."""

_SPECIAL = frozenset("IiBbEe \t")  # first letters of INCLUDE, BEGIN, END and ENDDATA, which may be indented
_BEGIN = re.compile(r"\s*BEGIN(?=[\s,]|\Z)[\s,]*(.*)\Z", re.IGNORECASE)
_BEGIN_BULK = re.compile(r"^\s*BEGIN[\s,]+BULK", re.IGNORECASE | re.MULTILINE)
_END = re.compile(r"\s*END[\s,]+(HYPRBEAM|FEMODEL|SUPER|AUXMODEL)", re.IGNORECASE)
_ENDDATA = re.compile(r"\s*ENDDATA\b", re.IGNORECASE)
_BESIDE = ("AUXMODEL", "ARBMODEL", "HYPRBEAM", "MASSID", "UDS", "TRMC")  # blocks that are no part of the model
_PARTS = ("SUPER", "FEMODEL", "MODULE")
_DEEPEST = 50
_MOST_CONTROL = 10_000  # lines
_STARTS = (
    *("GRID", "GRDSET", "BEGIN BULK", "BEGIN,BULK", "CEND", "CQUAD", "CTRIA", "CORD1", "CORD2", "PSHELL", "SOL "),
    *(f"INCLUDE{sign}" for sign in " '\"=,"),
)


def is_deck(head: str) -> bool:
    """Whether a text file begins like a deck."""
    return any(line.lstrip().upper().startswith(_STARTS) for line in head.splitlines())


@dataclass(frozen=True, slots=True, eq=False)
class Deck:
    """A NASTRAN input file with its INCLUDEs: lines before BEGIN BULK, bulk data lines, warnings and included files."""

    control: list[Line]
    bulk: list[Line]
    warnings: tuple[Problem, ...] = ()
    included: tuple[Path, ...] = ()

    def taken(self) -> Iterator[Line]:
        """Give the bulk data lines, and keep none of them: what is made of them has their memory."""
        self.bulk.reverse()
        while self.bulk:
            yield self.bulk.pop()


@dataclass(slots=True)
class _Reading:
    """What is known while files are read."""

    root: Path
    begins: bool  # the root deck itself has BEGIN BULK
    in_control: bool = True
    beside: tuple[str, int] | None = None  # first line of a block beside the model, and how many followed
    warnings: list[Problem] = field(default_factory=list)
    problems: list[Problem] = field(default_factory=list)
    included: dict[Path, None] = field(default_factory=dict)


def place(source: str, number: int) -> str:
    """Name a line as messages do."""
    return f"{source}, line {number}"


def read_deck(path: Path) -> Deck:
    """Read a bulk data file, or a whole input file; every line comes with its place.

    Raises
    ------
    DataError : a file is missing or no text, includes itself, or the model is made of superelements or parts
    """
    text = _text(path, str(path))
    reading = _Reading(path, begins=_BEGIN_BULK.search(text) is not None)
    control: list[Line] = []
    bulk: list[Line] = []
    lines = _lines(path, text, (), reading)
    for source, number, line in lines:
        if line[0] in _SPECIAL:
            if _ENDDATA.match(line):
                _after_end(lines, source, number, reading)
                break
            if opened := _opened(line, place(source, number), reading):
                _note_beside(reading)
                if opened == "model" and reading.in_control:
                    control, bulk, reading.in_control = bulk, [], False
                reading.beside = (place(source, number), 0) if opened == "beside" else None
                continue
        if reading.beside:
            reading.beside = (reading.beside[0], reading.beside[1] + 1)
        else:
            bulk.append((source, number, line))
    _note_beside(reading)
    if reading.in_control:
        reading.problems += _without_begin(bulk)
    refuse(DataError, reading.problems[:10])
    return Deck(control, bulk, tuple(reading.warnings), tuple(reading.included))


def _without_begin(lines: list[Line]) -> list[Problem]:
    """Refuse control sections that no BEGIN BULK ends; pure bulk data has neither."""
    return [
        Problem(
            "no_begin_bulk", place(source, number), "CEND stands here and no BEGIN BULK anywhere", "Write that line"
        )
        for source, number, line in lines[:_MOST_CONTROL]
        if line.strip().upper() == "CEND"
    ]


def _opened(line: str, where: str, reading: _Reading) -> str:
    """Tell what a line opens, with BEGIN or with the END of a block: the "model", a block "beside" it, or nothing."""
    if reading.beside and _END.match(line):
        return "model"
    found = _BEGIN.match(line)
    if not found:
        return ""
    words = re.split(r"[\s,=]+", found[1].upper().strip())
    kind = next((word for word in words if word in (*_BESIDE, *_PARTS)), "")
    if kind in _PARTS and not (kind == "SUPER" and words[-1] == "0"):
        what = f"the model has superelements or parts ({line.strip()})"
        raise DataError(Problem("superelement", where, what, "Give a model without them"))
    if kind in _BESIDE:
        return "beside"
    if words[0] in ("BULK", "SUPER") or (words[0] == "" and not reading.begins):
        return "model"
    if reading.in_control:
        return ""  # a statement of DMAP
    what = f"an unknown block begins here ({line.strip()})"
    raise DataError(Problem("unknown_block", where, what, "Give a model without it"))


def _note_beside(reading: _Reading) -> None:
    if reading.beside:
        where, count = reading.beside
        what = f"the block that begins here is no part of the model; its {count} lines are left out"
        remedy = "Nothing to do if its shells carry no weld to assess"
        reading.warnings.append(Problem("block_left_out", where, what, remedy, count))


def _after_end(lines: Iterator[Line], source: str, number: int, reading: _Reading) -> None:
    """Count what stands after ENDDATA, which solvers do not read."""
    before, count = len(reading.problems), 0
    try:
        for _, _, line in lines:
            count += not _ENDDATA.match(line)
    except DataError:
        count += 1
    count += len(reading.problems) - before  # INCLUDEs of files that are not there
    del reading.problems[before:]
    if count:
        reading.warnings.append(
            Problem(
                "after_enddata",
                place(source, number),
                f"{count} lines after this ENDDATA are not read",
                "Remove the ENDDATA if they belong to the model",
                count,
            )
        )


def _lines(path: Path, text: str, parents: tuple[Path, ...], reading: _Reading) -> Iterator[Line]:
    """Lines of a file without comments, INCLUDEs put in their place."""
    source = str(path)
    numbered = enumerate(text.split("\n"), start=1)
    for number, raw in numbered:
        if raw[:1] in _SPECIAL and is_include(raw):
            yield from _included(path, number, include_name(raw, numbered, place(source, number)), parents, reading)
            continue
        line = (raw[: raw.index("$")] if "$" in raw else raw).rstrip()
        if line and line[0] != "#" and line[:2] != "//":  # comments of OptiStruct
            yield source, number, line


def _included(path: Path, number: int, name: str, parents: tuple[Path, ...], reading: _Reading) -> Iterator[Line]:
    """Lines of an included file; one that only the control sections miss is a warning."""
    where = place(str(path), number)
    try:
        found = find_include(name, path, reading.root, where)
        text = _text(found.path, where)
    except DataError as error:
        if reading.in_control and reading.begins:
            reading.warnings += [
                Problem("control_include", p.where, f"{p.what}; its control statements are left out", p.remedy)
                for p in error.problems
            ]
        else:
            reading.problems += error.problems
        return
    if found.warning:
        reading.warnings.append(found.warning)
    parents = (*parents, path.resolve())
    if found.path.resolve() in parents or len(parents) > _DEEPEST:
        raise DataError(Problem("include_loop", where, f"the file {found.path} includes itself", "Remove the INCLUDE"))
    reading.included[found.path] = None
    yield from _lines(found.path, text, parents, reading)


def _text(path: Path, where: str) -> str:
    """Text of a file in UTF-8, UTF-16 with its mark, or one byte for each letter, perhaps in gzip.

    Raises
    ------
    DataError : the file cannot be read, or is no text
    """
    try:
        data = path.read_bytes()
        if data[:2] == b"\x1f\x8b":
            data = gzip.decompress(data)
        if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
            text = data.decode("utf-16")
        else:
            data = data.rstrip(b"\0\x1a")  # the end as old systems mark it
            try:
                text = data.decode("utf-8-sig")
            except UnicodeDecodeError:
                text = data.decode("latin-1")
    except (OSError, EOFError, ValueError) as error:
        raise DataError(
            Problem("unreadable", where, f"{path} cannot be read ({error})", "Correct the INCLUDE or the path")
        ) from error
    if "\0" in text:
        raise DataError(Problem("not_text", where, f"{path} is a binary file", "Give the bulk data as text"))
    return text.replace("\r\n", "\n").replace("\r", "\n").replace("\f", "").replace("\x1a", "")
