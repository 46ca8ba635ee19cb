"""Which encoding a text file is written in: UTF-8, UTF-16 or UTF-32 by their marks, else Windows-1252.

A byte that no encoding explains, or a NUL among letters, is told with its line.
"""

import codecs
import re
from pathlib import Path
from typing import Literal

from fatigue.errors import DataError, Problem

Encoding = Literal["utf-8", "utf-16", "utf-16-le", "utf-16-be", "utf-32", "cp1252"]

HEAD_BYTES = 1 << 18  # of a table with names in its first lines
LONG_HEAD_BYTES = 1 << 22  # of a history, which may begin with pages of text
_MARKS: tuple[tuple[bytes, Encoding], ...] = (
    (codecs.BOM_UTF8, "utf-8"),
    (codecs.BOM_UTF32_LE, "utf-32"),  # before UTF-16, whose mark it begins with
    (codecs.BOM_UTF32_BE, "utf-32"),
    (codecs.BOM_UTF16_LE, "utf-16"),
    (codecs.BOM_UTF16_BE, "utf-16"),
)
_TEXT_START = re.compile(rb"(?:[\t\n\r\x20-\x7e]\0){4}")
_TEXT_START_BIG = re.compile(rb"(?:\0[\t\n\r\x20-\x7e]){4}")


def marked_encoding(head: bytes) -> Encoding:
    """Encoding by the first bytes of a file; ``utf-8`` where they do not tell, also for Windows-1252."""
    for mark, encoding in _MARKS:
        if head.startswith(mark):
            return encoding
    if _TEXT_START.match(head):
        return "utf-16-le"
    if _TEXT_START_BIG.match(head):
        return "utf-16-be"
    return "utf-8"


def encoding_of(path: Path, data: bytes) -> Encoding:
    """Encoding of a whole file.

    Raises
    ------
    DataError : bytes that no encoding explains
    """
    encoding = marked_encoding(data[:4096])
    try:
        data.decode(encoding)
    except UnicodeDecodeError as error:
        if encoding != "utf-8":
            raise DataError(undecodable(path, data, encoding, error)) from None
        _refuse_if_damaged(path, data)
        return "cp1252"
    return encoding


def decoded(path: Path, data: bytes) -> tuple[str, Encoding]:
    """Text of a file without byte order mark, and the encoding it was written in.

    Raises
    ------
    DataError : bytes that no encoding explains, NUL bytes
    """
    encoding = encoding_of(path, data)
    text = data.decode(encoding).removeprefix("\ufeff").removesuffix("\x1a")  # the end of a file of DOS
    if "\0" in text:
        raise DataError(nul_problem(path, text[: text.index("\0")].count("\n") + 1))
    return text, encoding


def unreadable(path: Path, error: OSError) -> DataError:
    """Refusal of a file that cannot be opened or read."""
    return DataError(Problem("unreadable", str(path), f"it cannot be read ({error})", "Check the path"))


def read_text(path: Path) -> tuple[str, Encoding]:
    """Text and encoding of a whole file, as ``decoded``.

    Raises
    ------
    DataError : missing or unreadable, bytes that no encoding explains, NUL bytes
    """
    try:
        data = path.read_bytes()
    except OSError as error:
        raise unreadable(path, error) from error
    return decoded(path, data)


def not_utf8_warning(path: Path, data: bytes) -> Problem:
    """Warning of a file that is read as Windows-1252: its first byte beyond UTF-8, and the letter it is taken for."""
    at = _first_stray(data)
    letter = bytes([data[at]]).decode("cp1252")
    what = f"byte {data[at]:#04x} is not UTF-8; the file is read as Windows-1252, where it is {letter!r}"
    return Problem("not_utf8", f"{path.name}: line {_line(data, at)}", what, "Save it as UTF-8")


def nul_problem(path: Path, line: int) -> Problem:
    """Refusal of a NUL among letters."""
    what = "a NUL byte stands in the text; the file is damaged or not a text"
    return Problem("nul_byte", f"{path.name}: line {line}", what, "Write the file again")


def undecodable(path: Path, data: bytes, encoding: Encoding, error: UnicodeDecodeError) -> Problem:
    """Refusal of a byte that cannot be read in the encoding the file declares."""
    line = data[: error.start].decode(encoding, errors="ignore").count("\n") + 1
    name = encoding.upper()
    what = f"byte {data[error.start]:#04x} is not {name}"
    if error.reason == "truncated data":
        what = f"the text ends within a letter of {name}"
    return Problem("not_utf8", f"{path.name}: line {line}", what, "Save it as UTF-8")


def _refuse_if_damaged(path: Path, data: bytes) -> None:
    """Refuse bytes that are neither UTF-8 nor Windows-1252, or a mixture of both."""
    try:
        data.decode("cp1252")
        if data.decode("utf-8", errors="ignore").isascii():
            return
        data.decode("utf-8")
    except UnicodeDecodeError as error:
        raise DataError(undecodable(path, data, "utf-8", error)) from None


def _first_stray(data: bytes) -> int:
    """Position of the first byte that is not UTF-8."""
    try:
        data.decode("utf-8")
    except UnicodeDecodeError as error:
        return error.start
    return len(data)


def _line(data: bytes, at: int) -> int:
    return data.count(b"\n", 0, at) + 1


def read_head(path: Path) -> tuple[str, Encoding, bool]:
    """Beginning of a text file: its text, its encoding, and whether it is the whole file.

    Raises
    ------
    DataError : missing or unreadable, bytes that no encoding explains, NUL bytes
    """
    try:
        with path.open("rb") as file:
            head = file.read(LONG_HEAD_BYTES)
    except OSError as error:
        raise unreadable(path, error) from error
    if len(head) < LONG_HEAD_BYTES or marked_encoding(head) != "utf-8":
        return (*read_text(path), True)
    return (*decoded(path, head[: head.rfind(b"\n") + 1]), False)
