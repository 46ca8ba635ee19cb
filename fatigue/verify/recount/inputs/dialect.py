"""CSV tables in the layouts of office programs and solvers, brought to plain texts with pandas."""

import codecs
import re
from collections.abc import Generator
from pathlib import Path

import numpy as np
import pandas as pd

_KEYS = {"weld", "mode", "node", "element", "time_s"}
_SEPARATORS = ";\t|,"
_UNIT = re.compile(r"[\[(<].*[\])>]|-|ms|s|mm|m|N|N ?mm|Hz|MPa|mm\*sqrt\(t\)|")


def read_texts(path: Path, texts: tuple[str, ...], rows_at_once: int | None = None) -> Generator[pd.DataFrame]:
    """Read a table as texts, so many rows at a time: names trimmed, numbers with a point and an E, empty cells missing.

    ``texts`` are columns whose cells are left as they are.
    """
    encoding = _encoding(path)
    with path.open(encoding=encoding) as file:
        head = [file.readline(1 << 20) for _ in range(200)]
        first, names, separator = _header(_whole_cells(head))
        file.seek(0)
        for _ in range(first):
            file.readline()
        pieces = pd.read_csv(
            file,
            sep=separator,
            header=None,
            names=range(len(names)),
            index_col=False,
            chunksize=rows_at_once or 1 << 30,
            skipinitialspace=True,
            dtype=str,
            keep_default_na=False,
            na_values=[""],
        )
        for piece in pieces:
            piece.columns = pd.Index(names)
            if len(piece) and piece[names[0]].iloc[-1] == "\x1a":  # the end of a file of DOS
                piece = piece[:-1]  # noqa: PLW2901
            if (piece[names[0]].str.strip() == names[0]).any():  # the names once more
                again = piece.apply(lambda column: column.str.strip() == column.name).all(axis=1)
                piece = piece[~again]  # noqa: PLW2901
            yield piece.apply(lambda column: column if column.name in texts else _numbers(column))


def _encoding(path: Path) -> str:
    """Encoding of a file, by the mark at its beginning, by zeros between letters, or by trying."""
    with path.open("rb") as file:
        head = file.read(64)
        if head.startswith((codecs.BOM_UTF32_LE, codecs.BOM_UTF32_BE)):
            return "utf-32"
        if head.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
            return "utf-16"
        if len(head) > 1 and 0 in head[:2]:
            return "utf-16-le" if head[1] == 0 else "utf-16-be"
        file.seek(0)
        decoder = codecs.getincrementaldecoder("utf-8-sig")()
        try:
            while block := file.read(1 << 22):
                decoder.decode(block)
        except UnicodeDecodeError:
            return "cp1252"
    return "utf-8-sig"


def _whole_cells(head: list[str]) -> list[str]:
    """Lines in which every cell in quotation marks stands on its last line as a whole."""
    for k in range(len(head) - 1):
        if head[k].count('"') % 2:
            head[k], head[k + 1] = "", head[k].rstrip("\r\n") + " " + head[k + 1]
    return head


def _header(head: list[str]) -> tuple[int, list[str], str]:
    """Number of lines above the rows, the names, and what separates them."""
    at = next(k for k, line in enumerate(head) if line.strip() and not re.match(r'"?sep=|\s*(#|%|!|//)', line, re.I))
    declared = next((m[1] for line in head[:at] if (m := re.match(r'"?sep=(.)', line, re.IGNORECASE))), None)
    if at and re.match(r"\s*(#|%|!|//)", head[at - 1]):  # names may stand in a comment
        text = head[at - 1].strip().lstrip("#%!/ ")
        separator = declared or _separator(text)
        above, below = _cells(text, separator), _cells(head[at], separator)
        are_numbers = re.match(r"[-+.\d]", below[-1]) is not None and len(above) == len(below)
        if are_numbers or (_KEYS & set(above) and not _KEYS & set(below)):
            return at, above, separator
    separator = declared or _separator(head[at])
    names = _cells(head[at], separator)
    units = next((k for k in range(at + 1, len(head)) if head[k].strip()), at)
    cells = _cells(head[units], separator)
    are_units = any(cells) and all(_UNIT.fullmatch(cell) for cell in cells) and units > at
    return (units if are_units else at) + 1, names, separator


def _separator(line: str) -> str:
    """What divides most cells of a line: a sign, else blanks."""
    separator = max(_SEPARATORS, key=line.count)
    return separator if separator in line else r"\s+" if len(line.split()) > 1 else ","


def _cells(line: str, separator: str) -> list[str]:
    cells = line.split() if separator == r"\s+" else line.rstrip("\r\n").split(separator)
    return [cell.strip().strip('"').strip() for cell in cells]


def _numbers(column: "pd.Series[str]") -> "pd.Series[str]":
    """Numbers written with a point and an E."""
    try:
        column.astype(np.float64)
    except ValueError:
        plain = column.str.replace(",", ".").str.replace("\u2212", "-").str.strip()
        plain = plain.str.replace(r"(?<=[\d.])[DdQq](?=[+-]?\d)", "E", regex=True)
        return plain.str.replace(r"^([+-]?\d*\.\d*)([+-]\d{1,3})$", r"\1E\2", regex=True)
    return column
