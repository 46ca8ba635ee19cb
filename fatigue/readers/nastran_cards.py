"""Lines of NASTRAN bulk data to cards: small, large and free fields, continuations, INCLUDE; SETs of case control."""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from fatigue.errors import DataError, Problem

_REAL = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[ED]?[+-]?\d+)?\Z", re.ASCII)
_EXPONENT = re.compile(r"(?<=[\d.])[ED]?([+-]\d+)\Z|(?<=[\d.])[ED](\d+)\Z", re.ASCII)
_INCLUDE = re.compile(r"\s*INCLUDE\s+", re.IGNORECASE)
_DELIMITER = re.compile(r"\s*(BEGIN|ENDDATA)\b", re.IGNORECASE)
_SUPERELEMENT = re.compile(r"\s*BEGIN\s+(SUPER|AUXMODEL)", re.IGNORECASE)
_NAME = re.compile(r"[A-Z][A-Z0-9]*\Z", re.ASCII)


@dataclass(frozen=True, slots=True)
class Card:
    """One bulk data card: its upper-case name, its data fields (field 2 first) and where it stands."""

    name: str
    fields: tuple[str, ...]
    where: str

    def text(self, at: int) -> str:
        """Field ``at``, empty if the card ends before."""
        return self.fields[at] if at < len(self.fields) else ""

    def integer(self, at: int, default: int | None = None) -> int:
        """Whole number in field ``at``; an empty field takes the default."""
        text = self.text(at)
        if not text and default is not None:
            return default
        digits = text[1:] if text[:1] in ("+", "-") else text
        if not (digits.isascii() and digits.isdigit() and len(digits) < 17):
            raise self._bad(at, text, "a whole number")
        return int(text)

    def real(self, at: int, default: float | None = None) -> float:
        """Real number in field ``at``, in any NASTRAN spelling such as ``2.9+7``; an empty field takes the default."""
        text = self.text(at)
        if not text and default is not None:
            return default
        try:
            value = float(text)
        except ValueError:
            value = self._nastran_real(at, text.upper())
        if not abs(value) < 1e100 or "_" in text:
            raise self._bad(at, text, "a number of sensible size")
        return value

    def _nastran_real(self, at: int, text: str) -> float:
        """Read ``2.9+7`` and ``1.D3``, which only FORTRAN understands."""
        if not _REAL.match(text):
            raise self._bad(at, text, "a number")
        return float(_EXPONENT.sub(lambda m: "E" + (m[1] or m[2]), text))

    def _bad(self, at: int, text: str, wanted: str) -> DataError:
        found = (
            f"{self.name} field {at + 2} is {text!r}, not {wanted}" if text else f"{self.name} field {at + 2} is empty"
        )
        return DataError(Problem("bad_field", self.where, found, "Correct the card"))


@dataclass(frozen=True, slots=True, eq=False)
class Deck:
    """A NASTRAN input file with its INCLUDEs: the lines before BEGIN BULK, and the bulk data lines."""

    control: list[tuple[str, str]]
    bulk: list[tuple[str, str]]


def read_deck(path: Path) -> Deck:
    """Read a bulk data file, or a whole input file; every line comes with its place.

    Raises
    ------
    DataError : a file is missing or no text, includes itself, or begins the bulk data of a superelement
    """
    control: list[tuple[str, str]] = []
    bulk: list[tuple[str, str]] = []
    began = False
    for where, line in _lines(path, ()):
        if not (found := _DELIMITER.match(line)):
            bulk.append((where, line))
        elif found[1].upper() == "ENDDATA":
            break
        elif not began and not _SUPERELEMENT.match(line):
            control, bulk, began = bulk, [], True
        else:
            raise DataError(
                Problem(
                    "superelement", where, f"the model has superelements ({line.strip()})", "Give a model without them"
                )
            )
    return Deck(control, bulk)


def _lines(path: Path, parents: tuple[Path, ...]) -> Iterator[tuple[str, str]]:
    """Lines of a file without comments, INCLUDEs put in their place."""
    try:
        real = path.resolve()
        text = path.read_text("utf-8", errors="replace")
    except (OSError, ValueError) as error:
        raise DataError(
            Problem("unreadable", str(path), f"the file cannot be read ({error})", "Correct the INCLUDE or the path")
        ) from error
    if "\0" in text:
        raise DataError(Problem("not_text", str(path), "this is a binary file", "Give the bulk data as text"))
    if real in parents or len(parents) > 50:
        raise DataError(Problem("include_loop", str(path), "the file includes itself", "Remove the INCLUDE"))
    numbered = enumerate(text.splitlines(), start=1)
    for number, raw in numbered:
        line = raw.split("$", 1)[0].rstrip()
        if not line:
            continue
        if not _INCLUDE.match(line):
            yield f"{path}, line {number}", line
            continue
        name = _INCLUDE.sub("", line, count=1).strip()
        quote = name[:1]
        while quote in ("'", '"') and (len(name) < 2 or name[-1] != quote):  # a long name goes on in the next lines
            following = next(numbered, None)
            if following is None:
                raise DataError(
                    Problem("bad_include", f"{path}, line {number}", "the file name has no end", "Close the quotation")
                )
            name += following[1].strip()
        yield from _lines(path.parent / name.strip("'\""), (*parents, real))


def cards(lines: list[tuple[str, str]]) -> Iterator[Card]:
    """Join lines and their continuations to cards.

    Raises
    ------
    DataError : a continuation without a card or with another name than announced, replicated cards
    """
    name, where, fields, announced = "", "", [], ""
    for place, raw in lines:
        line = raw.expandtabs(8)
        head, data, mark = _split(line)
        if not head or head[0] in "+*":
            if not name:
                raise DataError(Problem("stray_line", place, "a continuation without a card before it", "Remove it"))
            if announced.strip("+*") and head.strip("+*") and announced.strip("+*") != head.strip("+*"):
                raise DataError(
                    Problem(
                        "continuation_order",
                        place,
                        f"continuation {head} follows a card that announces {announced}",
                        "Write every continuation straight after its card",
                    )
                )
            fields += data
        else:
            if name:
                yield Card(name, tuple(fields), where)
            if not _NAME.match(head.rstrip("* ")):
                raise DataError(
                    Problem("bad_card", place, f"{head!r} is no card name", "Write the cards out, without replication")
                )
            name, where, fields = head.rstrip("* "), place, list(data)
        announced = mark
    if name:
        yield Card(name, tuple(fields), where)


def _split(line: str) -> tuple[str, list[str], str]:
    """Name or continuation mark, data fields (8, in large format 4) and the mark that announces a continuation."""
    if "," in line:
        parts = [part.strip() for part in line.split(",")]
        head = parts[0].upper()
        width = 4 if head.endswith("*") or head.startswith("*") else 8
        data, rest = parts[1 : width + 1], parts[width + 1 :]
    else:
        head = line[:8].strip().upper()
        size = 16 if "*" in head else 8
        width = 64 // size
        data = [line[8 + size * k : 8 + size * (k + 1)].strip() for k in range(width)]
        rest = [line[72:80].strip()]
    mark = rest[0].upper() if rest and rest[0][:1] in ("+", "*") else ""
    return head, data + [""] * (width - len(data)), mark


def case_sets(lines: list[tuple[str, str]]) -> dict[int, list[int]]:
    """Read the integer SETs of case control, ``SET 5 = 1, 2 THRU 9 EXCEPT 6, 20``; other sets are left out."""
    text = ""
    sets: dict[int, list[int]] = {}
    for _, line in lines:
        text = f"{text} {line.strip()}" if text else line.strip()
        if text.endswith(","):
            continue
        if found := re.match(r"SET\s+(\d{1,9})\s*=\s*(.*)\Z", text.upper(), re.ASCII):
            members = set_members(re.findall(r"[^\s,]+", found[2]))
            if members is not None:
                sets[int(found[1])] = members
        text = ""
    return sets


def set_members(words: list[str]) -> list[int] | None:
    """Expand ``1 2 THRU 9 EXCEPT 6``; None where something else stands, such as ALL, or a range of over ten million."""
    members: list[int] = []
    at = 0
    excluding = False
    last: range | None = None
    while at < len(words):
        word = words[at]
        if word == "EXCEPT":
            excluding, at = True, at + 1
            continue
        if word == "THRU":
            if not members or at + 1 >= len(words) or not _is_id(words[at + 1]):
                return None
            last = range(members[-1] + 1, int(words[at + 1]) + 1)
            if len(last) > 10_000_000:
                return None
            members += last
            excluding, at = False, at + 2
            continue
        if not _is_id(word):
            return None
        number = int(word)
        if excluding and last is not None and number in last:
            members.remove(number)
        else:
            excluding = False
            members.append(number)
        at += 1
    return members


def _is_id(word: str) -> bool:
    return word.isascii() and word.isdigit() and len(word) < 10
