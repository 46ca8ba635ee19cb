"""Files in the wrong place, told by their content before anything is read of them."""

import re
import zipfile
from pathlib import Path
from typing import BinaryIO

from fatigue.errors import Problem
from fatigue.files.known_formats import AS_CSV, BINARY, HINTS, OWN, SUFFIXES, TEXT, UNPACK, ZIPPED, Known

_ARCHIVES = (b"PK\x03\x04", b"PK\x05\x06")
HEAD = 200_000  # bytes of a file that are looked at


def known_format(path: Path, *, text: bool = True) -> Known | None:
    """Format of a file that is read nowhere; None for any other, and for a file that cannot be opened.

    Parameters
    ----------
    text : recognise formats of text as well, not only binary ones
    """
    try:
        with path.open("rb") as file:
            head = file.read(HEAD)
            if head.startswith(_ARCHIVES):
                names = archive_names(file)
                return None if _own_archive(names) else _zip(names)
            if head.startswith(b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"):
                return _office(head)
    except OSError:
        return None
    binary = next((known for known in BINARY if known.fits(head)), None)
    if binary is not None or not text or b"\0" in head:
        return binary
    plain = head.removeprefix(b"\xef\xbb\xbf").replace(b"\r\n", b"\n")
    return next((known for known in TEXT if known.fits(plain)), None)


def misplaced(path: Path, where: str, *, text: bool = True) -> Problem | None:
    """Refusal of a file whose content belongs elsewhere, be it read there or nowhere; None if that cannot be told."""
    known = known_format(path, text=text) or own_format(path, text=text)
    if known is not None:
        return Problem("foreign_format", where, f"this is {known.name}", known.remedy)
    return unknown_binary(path, where, "Give the file itself", stray=0.15)


def own_format(path: Path, *, text: bool = True) -> Known | None:
    """Format of a file that is read in one place or another; None for a plain table of text."""
    try:
        with path.open("rb") as file:
            head = file.read(HEAD)
            if head.startswith(_ARCHIVES):
                return _own_archive(archive_names(file))
    except OSError:
        return None
    if b"\0" in head:
        return next((known for known in OWN if known.is_binary and known.fits(head)), None)
    plain = head.removeprefix(b"\xef\xbb\xbf").replace(b"\r\n", b"\n")
    return next((known for known in OWN if (text or known.is_binary) and known.fits(plain)), None)


def unknown_binary(path: Path, where: str, remedy: str, *, stray: float = 0.0) -> Problem | None:
    """Refusal of a binary file without signature: what it may be by a program's name in it, else by its own name.

    None for a text, be it of two bytes a character, and for a file that cannot be opened. ``remedy`` is for one that
    tells nothing; a share of ``stray`` control characters is taken for damage of a text.
    """
    try:
        with path.open("rb") as file:
            head = file.read(HEAD)
    except OSError:
        return None
    padded = head.rstrip(b"\0\x1a")  # as the end of a text may be
    controls = len(re.findall(rb"[\0-\x08\x0e-\x1f]", padded))
    if (padded and (b"\0" not in padded or controls <= stray * len(padded))) or not head or _two_byte_text(head):
        return None
    what = "this is an unknown binary format"
    if not head.strip(b"\0"):
        what += ", it begins with nothing but zeros"
        return Problem("unknown_binary", where, what, "Copy the file again, perhaps it was not fetched yet")
    hint = next((known for known in HINTS if known.fits(head[:4096])), None) or SUFFIXES.get(path.suffix.lower())
    if hint is not None:
        return Problem("unknown_binary", where, f"{what}, perhaps {hint.name}", hint.remedy)
    return Problem("unknown_binary", where, what, remedy)


def _two_byte_text(head: bytes) -> bool:
    """Whether bytes are text in UTF-16: a byte order mark, or zeros at every other place and nowhere else."""
    zeros = (head[:2000:2].count(0), head[1:2000:2].count(0))
    half = len(head[:2000]) // 2
    return head.startswith((b"\xff\xfe", b"\xfe\xff", b"\0\0\xfe\xff")) or (min(zeros) == 0 and max(zeros) > 0.9 * half)


def archive_names(file: BinaryIO) -> list[str] | None:
    """Names of the files in a ZIP archive; None where it is damaged."""
    try:
        with zipfile.ZipFile(file) as archive:
            return archive.namelist()
    except (zipfile.BadZipFile, OSError, ValueError, NotImplementedError, RuntimeError):
        return None


def _own_archive(names: list[str] | None) -> Known | None:
    """Format of a ZIP archive that is read."""
    return next((known for known in OWN if known.fits_archive(names or ())), None)


def _zip(names: list[str] | None) -> Known:
    """What a ZIP archive is: many programs store their documents in one."""
    if names is None:
        return Known("a ZIP archive, or an Excel workbook, cut short", "Copy it again")
    known = next((known for pattern, known in ZIPPED if any(re.match(pattern, name) for name in names)), None)
    return known or Known("a ZIP archive", UNPACK)


def _office(head: bytes) -> Known:
    """What a document of old Office is: a workbook has a stream of that name."""
    if any(name.encode("utf-16-le") in head for name in ("Workbook", "Book")):
        return Known("an old Excel workbook (.xls)", AS_CSV)
    return Known("an old Office document, perhaps an Excel workbook (.xls)", AS_CSV)
