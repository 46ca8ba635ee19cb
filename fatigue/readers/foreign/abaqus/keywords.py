"""The deck language of Abaqus, which CalculiX reads, too: keywords with parameters, and their data lines."""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from fatigue.errors import DataError, Problem
from fatigue.files.naming import missing_foreign_file
from fatigue.readers.text.encoding import marked_encoding, unreadable

_FIRST = re.compile(
    r"^\s*\*\s*(heading|node|element|part|assembly|include|preprint|solid section|shell section|nset|elset|material)\b",
    re.I,
)
_DEEPEST = 50
_READ = (
    *("NODE", "ELEMENT", "NSET", "ELSET", "PART", "END PART", "INSTANCE", "END INSTANCE", "ASSEMBLY", "END ASSEMBLY"),
    *("SHELL SECTION", "SHELL GENERAL SECTION", "SYSTEM", "INCLUDE", "PARAMETER", "STEP"),
    *("NGEN", "NFILL", "NCOPY", "NMAP", "ELGEN", "ELCOPY"),
)
_PARAMETERS = (
    *("TYPE", "ELSET", "NSET", "GENERATE", "INSTANCE", "NAME", "PART", "SYSTEM", "INPUT", "MATERIAL", "COMPOSITE"),
    *("OFFSET", "NODAL THICKNESS", "SHELL THICKNESS"),
)
_SHORTEST = 3  # letters of an abbreviation

Data = tuple[str, int, list[str]]
"""File, line from 1, and the fields of a data line."""


@dataclass(slots=True, eq=False)
class DataLines:
    """Data lines of a keyword, kept as they stand and cut in fields when they are asked for: a fourth of the memory."""

    lines: list[tuple[str, int, str]] = field(default_factory=list)

    def __len__(self) -> int:
        """Count the lines."""
        return len(self.lines)

    def __getitem__(self, at: int) -> Data:
        """Give one line."""
        where, number, line = self.lines[at]
        return where, number, [word.strip() for word in line.split(",")]

    def __iter__(self) -> Iterator[Data]:
        """Give all lines."""
        return (self[at] for at in range(len(self)))


@dataclass(frozen=True, slots=True, eq=False)
class Keyword:
    """A keyword, its parameters by their names in capitals, and its data lines.

    Attributes
    ----------
    name : in capitals, blanks between words single
    parameters : values as written, empty for a flag
    where : file and line
    data : data lines
    """

    name: str
    parameters: dict[str, str]
    where: str
    data: DataLines = field(default_factory=DataLines)

    def get(self, parameter: str, default: str = "") -> str:
        """Value of a parameter."""
        return self.parameters.get(parameter, default)


def is_deck(head: str) -> bool:
    """Whether a text begins like a deck: its first line that is no comment is a keyword."""
    for line in head.splitlines()[:2000]:
        text = line.strip()
        if text and not text.startswith("**"):
            return _FIRST.match(text) is not None and not text.upper().startswith("*KEYWORD")
    return False


def keywords(path: Path) -> tuple[list[Keyword], tuple[Path, ...]]:
    """Keywords of a deck and of the files it includes, and these files.

    Raises
    ------
    DataError : a missing include, data before any keyword, a parameter that is not understood
    """
    found: list[Keyword] = []
    included: list[Path] = []
    for where, number, line in _lines(path, path, included, 0):
        if line.startswith("*"):
            found.append(_keyword(f"{where}, line {number}", line))
        elif found:
            found[-1].data.lines.append((where, number, line))
        else:
            what = f"data stand before any keyword: {line[:40]!r}"
            raise DataError(Problem("inp_damaged", f"{where}, line {number}", what, "Give the whole deck"))
    return found, tuple(included)


def _lines(path: Path, root: Path, included: list[Path], depth: int) -> Iterator[tuple[str, int, str]]:
    """Lines without comments and blanks; keyword lines that end in a comma are joined with the next."""
    try:
        raw_bytes = path.read_bytes()
        text = raw_bytes.decode(marked_encoding(raw_bytes[:4]), errors="replace")
    except (FileNotFoundError, IsADirectoryError):
        raise DataError(missing_foreign_file(path)) from None
    except OSError as error:
        raise unreadable(path, error) from error
    pending, first = "", 0
    for number, raw in enumerate(text.splitlines(), 1):
        line = raw.strip()
        if not line or line.startswith("**"):
            continue
        if pending:
            line = pending + line
        elif line.startswith("*"):
            first = number
        if line.startswith("*") and line.endswith(","):
            pending = line
            continue
        at, pending = (first if line.startswith("*") else number), ""
        if re.match(r"\*\s*include\b", line, re.IGNORECASE):
            yield from _included(f"{path}, line {at}", line, root, included, depth)
        else:
            yield str(path), at, line


def _included(where: str, line: str, root: Path, included: list[Path], depth: int) -> Iterator[tuple[str, int, str]]:
    """Lines of an included file, beside the root deck unless its path is absolute."""
    name = _keyword(where, line).get("INPUT")
    if not name:
        raise DataError(Problem("inp_damaged", where, "*INCLUDE names no INPUT", "Name the file"))
    file = root.parent / name.replace("\\", "/")
    if depth >= _DEEPEST:
        raise DataError(Problem("include_loop", where, f"{name} includes itself", "Break the circle"))
    if not file.is_file():
        what = f"the included file {name} is not beside {root.name}"
        raise DataError(Problem("no_include", where, what, "Copy it there, or give the deck in one file"))
    included.append(file)
    yield from _lines(file, root, included, depth + 1)


def _keyword(where: str, line: str) -> Keyword:
    """A keyword line in its parts; names may be written with any blanks and letters."""
    words = [word.strip() for word in _split(line[1:])]
    keyword = _written_out(words[0], _READ)
    parameters: dict[str, str] = {}
    for word in words[1:]:
        if word:
            name, is_given, value = word.partition("=")
            parameters[_written_out(name, _PARAMETERS)] = value.strip().strip("\"'") if is_given else ""
    return Keyword(keyword, parameters, where)


def _written_out(word: str, known: tuple[str, ...]) -> str:
    """A keyword or parameter in capitals, in full where its first letters, without blanks, are those of one alone."""
    bare = "".join(word.upper().split())
    of_known = {"".join(name.split()): name for name in known}
    if bare in of_known:
        return of_known[bare]
    fits = [name for short, name in of_known.items() if short.startswith(bare)] if len(bare) >= _SHORTEST else []
    return fits[0] if len(fits) == 1 else " ".join(word.upper().split())


def _split(line: str) -> list[str]:
    """Words between commas; a comma in quotation marks separates nothing."""
    return re.findall(r'(?:[^,"]|"[^"]*")+', line) or [""]
