"""INCLUDE statements of NASTRAN and OptiStruct: the file name as written, and the file it means on this machine."""

import os
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from fatigue.errors import DataError, Problem

_STATEMENT = re.compile(r"\s*INCLUDE(?=[\s,='\"]|\Z)[\s,=]*", re.IGNORECASE)
_SYMBOL = re.compile(r"([A-Za-z_]\w+):(.*)\Z", re.DOTALL)
_DRIVE = re.compile(r"([A-Za-z]):([\\/].*)\Z", re.DOTALL)
_BLANK = "\0"
_LONGEST = 1000
_VARIABLE = re.compile(r"\$\{(\w+)\}|\$(\w+)|%(\w+)%")


@dataclass(frozen=True, slots=True)
class Found:
    """The file an INCLUDE means, and a warning where two files could be meant."""

    path: Path
    warning: Problem | None = None


def is_include(line: str) -> bool:
    """Whether a line begins an INCLUDE statement."""
    return _STATEMENT.match(line) is not None


def include_name(line: str, following: Iterator[tuple[int, str]], where: str) -> str:
    """File name of the statement that ``line`` begins; it goes on after an open quotation and after a comma.

    Quotation marks may enclose any part of the name; ``$`` begins a comment only outside of them. Blanks at the ends
    of lines do not count; those outside of quotation marks, which NASTRAN drops, are given as NUL.

    Raises
    ------
    DataError : no name, a quotation without end
    """
    text, quote = _STATEMENT.sub("", line, count=1).strip(), ""
    name = ""
    while True:
        part, quote = _unquoted(text, quote, at_start=not name)
        name += part
        if not quote and not part.endswith(","):
            break
        name = name if quote else name[:-1].rstrip(_BLANK)
        following_line = next(following, None)
        if following_line is None or len(name) > _LONGEST:
            raise DataError(Problem("bad_include", where, "the file name has no end", "Close the quotation"))
        text = following_line[1].strip()
        if not quote and text.startswith("$"):
            text = ","  # a comment inside the statement
    name = name.strip(f"{_BLANK} ")
    if not name:
        raise DataError(Problem("bad_include", where, "INCLUDE names no file", "Name the file"))
    return name


def _unquoted(text: str, quote: str, at_start: bool) -> tuple[str, str]:
    """Text without quotation marks and comment, and the quotation mark still open at its end."""
    kept = ""
    for char in text:
        if quote:
            if char == quote:
                quote = ""
            else:
                kept += char
        elif char in "'\"":
            quote = char
        elif char == "$" and (kept or not at_start or not _VARIABLE.match(text)):
            break
        else:
            kept += _BLANK if char in " \t" else char
    return (kept if quote else kept.rstrip(_BLANK)), quote


def find_include(name: str, including: Path, root: Path, where: str) -> Found:
    r"""Find the file, beside the including file or beside the root deck, in any letter case, with \\ or / in its path.

    ``DIR:a.bdf`` and ``$DIR/a.bdf`` take the environment variable DIR; ``.gz`` may be left out, as OptiStruct allows.

    Raises
    ------
    DataError : no such file, an environment variable that is not set
    """
    text = _expanded(name, where)
    name = name.replace(_BLANK, " ")
    places = list(dict.fromkeys((including.parent, root.parent)))
    for spelling in dict.fromkeys((text.replace(_BLANK, " "), text.replace(_BLANK, ""))):
        wanted = Path(spelling if os.name == "nt" else spelling.replace("\\", "/"))
        found = [path for place in places if (path := _in_any_case(place / wanted))]
        if found:
            return Found(found[0], _two_files(found, name, where))
    tried = " and ".join(str(place / wanted) for place in ([Path()] if wanted.is_absolute() else places))
    what, remedy = f"INCLUDE '{name}' is not found, looked for {tried}", "Correct the path, or bring the file"
    if os.name != "nt" and (drive := _DRIVE.match(name)):
        what = f"INCLUDE '{name}' names a drive of Windows"
        remedy = f"Set the environment variable DOS_DRIVE_{drive[1].upper()} to the folder that stands for it"
    raise DataError(Problem("no_include", where, what, remedy))


def _expanded(name: str, where: str) -> str:
    """Replace a logical symbol, a drive letter and environment variables."""
    if os.name != "nt" and (drive := _DRIVE.match(name)):
        there = os.environ.get(f"DOS_DRIVE_{drive[1].upper()}")  # as OptiStruct does
        return f"{there}{drive[2]}" if there else name
    if symbol := _SYMBOL.match(name):
        return f"{_variable(symbol[1], name, where).rstrip('/')}/{symbol[2].lstrip('/')}"
    return _VARIABLE.sub(lambda m: _variable(m[1] or m[2] or m[3], name, where) if _is_meant(m[0]) else m[0], name)


def _is_meant(text: str) -> bool:
    """Take ``$NAME`` in a file name for a variable only if one of that name is set, ``${NAME}`` always."""
    return text[:2] == "${" or text.strip("$%") in os.environ


def _variable(symbol: str, name: str, where: str) -> str:
    for spelling in (symbol, symbol.upper(), symbol.lower()):
        if value := os.environ.get(spelling):
            return value
    raise DataError(
        Problem(
            "no_symbol",
            where,
            f"INCLUDE '{name}' needs the logical symbol {symbol}, which is not set",
            f"Set the environment variable {symbol} to its folder",
        )
    )


def _in_any_case(path: Path) -> Path | None:
    """Give the file itself, or the only one whose path differs in letter case alone, or its gzip."""
    at = Path(path.anchor)
    try:
        if path.is_file():
            return path
        for part in path.parts[1:] if path.anchor else path.parts:
            if (at / part).exists():
                at /= part
                continue
            same = [entry for entry in at.iterdir() if entry.name.lower() in (part.lower(), f"{part.lower()}.gz")]
            if len(same) != 1:
                return None
            at = same[0]
        return at if at.is_file() else None
    except OSError:  # no folder, no right to look into it, a name too long
        return None


def _two_files(found: list[Path], name: str, where: str) -> Problem | None:
    """Warning where the file beside the including file and the one beside the root deck differ."""
    if len(found) < 2 or found[0].samefile(found[1]) or found[0].read_bytes() == found[1].read_bytes():
        return None
    return Problem(
        "two_includes",
        where,
        f"INCLUDE '{name}' may mean {found[0]} or {found[1]}, which differ; the first is read",
        "Remove or rename the other",
    )
