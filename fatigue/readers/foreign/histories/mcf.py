"""Modal coordinates of an ANSYS ``.mcf`` file: text, long rows wrapped or not."""

import re
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from fatigue.errors import DataError, Problem
from fatigue.readers.foreign.histories.foreign_history import ForeignHistory, check_values
from fatigue.readers.foreign.histories.statements import normalisation_in
from fatigue.readers.text.encoding import read_text
from fatigue.readers.text.numbers import is_number, plain_number
from fatigue.readers.units.channel_names import written

_COUNT = re.compile(r"^\s*Number of Modes\s*:?\s*(\d{1,6})\s*$", re.MULTILINE | re.IGNORECASE | re.ASCII)
_NUMBERS = re.compile(r"^\s*Modes?\s*:?((?:\s+\d+)+)\s*$", re.MULTILINE | re.IGNORECASE | re.ASCII)
_FREQUENCIES = re.compile(
    r"^\s*Frequenc(?:y|ies)\s*:?((?:\s+[-+.\dEDQ]+)+)\s*$", re.MULTILINE | re.IGNORECASE | re.ASCII
)
_TITLE = re.compile(r"\A\s*Modal Coordinates", re.IGNORECASE)
_TABLE = re.compile(r"^\s*(Time|Freq\w*)\s+Coordinates.*$", re.MULTILINE | re.IGNORECASE)


def is_mcf(head: str) -> bool:
    """Whether the beginning of a text file is that of a modal coordinates file."""
    return _COUNT.search(head) is not None and (_TABLE.search(head) or _TITLE.search(head)) is not None


def read_mcf(path: Path, columns: Mapping[str, int] | None = None, time_column: str | None = None) -> ForeignHistory:
    """Read times and modal coordinates of a transient run, mode numbers and frequencies.

    Raises
    ------
    DataError : columns are asked for by names, which there are none of; unreadable, no such file, harmonic coordinates,
        a table that is cut or holds no numbers
    """
    if columns is not None or time_column is not None:
        what = "an .mcf file has no names of columns, for --columns or --time-column"
        raise DataError(Problem("no_column", str(path), what, "Leave the options out, or export a table"))
    text, _ = read_text(path)
    count, table = _COUNT.search(text), _TABLE.search(text)
    if count is None or table is None:
        raise _bad(path, "the lines 'Number of Modes' and 'Time Coordinates' are missing")
    if not table[1].lower().startswith("time"):
        raise DataError(
            Problem("harmonic", str(path), "the coordinates are a harmonic response", "Give a transient analysis")
        )
    modes = int(count[1])
    head = text[: table.start()]
    numbers = _header(path, _NUMBERS.search(head), modes, "mode numbers")
    frequencies = _header(path, _FREQUENCIES.search(head), modes, "frequencies")
    values = _numbers(path, text[table.end() :], "table", text.count("\n", 0, table.end()) + 1)
    if modes == 0 or values.size == 0 or values.size % (modes + 1):
        raise _bad(path, f"{values.size} numbers are no whole number of rows of time and {modes} coordinates")
    if (
        numbers is not None
        and (bad := numbers[~((numbers >= 0) & (numbers < 2**53) & (numbers == np.rint(numbers)))]).size
    ):
        raise _bad(path, f"{bad[0]:g} is no number of a mode")
    normalisation = normalisation_in(path, list(enumerate(head.split("\n"), 1)))
    rows = values.reshape(-1, modes + 1)
    mode = np.arange(1, modes + 1) if numbers is None else numbers.astype(np.int64)
    frequency = np.full(modes, np.nan) if frequencies is None else frequencies
    return check_values(
        ForeignHistory(
            str(path),
            mode,
            frequency,
            tuple(f"mode {m}" for m in mode),
            rows[:, 0].copy(),
            np.ascontiguousarray(rows[:, 1:].T),
            resolution=None if frequencies is None else _resolution(head),
            normalisation=normalisation,
            remarks=_not_understood(path, head[count.end() :]),
        )
    )


def _not_understood(path: Path, head: str) -> tuple[Problem, ...]:
    """Doubts about lines of numbers in the header that are neither mode numbers nor frequencies."""
    rest = _FREQUENCIES.sub("", _NUMBERS.sub("", head))
    lines = [
        line.strip() for line in rest.split("\n") if re.search(r"\d[\d.]*[ED][+-]?\d|(?:\s\d+){2}", line, re.ASCII)
    ]
    remedy = "Check the names of the header's lines, Mode and Frequency"
    return tuple(
        Problem("unread_line", str(path), f"a line of numbers is not understood: {line[:60]!r}", remedy)
        for line in lines
    )


def _resolution(head: str) -> np.ndarray:
    """Half a unit of the last digit of each frequency [Hz]."""
    found = _FREQUENCIES.search(head)
    return np.array([written(plain_number(word, "."))[1] for word in found[1].split()] if found else [])


def _header(path: Path, found: re.Match[str] | None, modes: int, what: str) -> np.ndarray | None:
    """Numbers of a header line that may go on in the next lines; None if the file has no such line."""
    if found is None:
        return None
    values = _numbers(path, found[1], what, 0)
    if values.size != modes:
        raise _bad(path, f"{values.size} {what} for {modes} modes")
    return values


def _numbers(path: Path, text: str, what: str, line: int) -> np.ndarray:
    """Numbers among blanks; ``line`` is that on which they begin, 0 where it does not matter."""
    try:
        return np.array(text.split(), np.float64)
    except ValueError:
        pass
    words = text.split()
    plain = [plain_number(word, ".") for word in words]
    for k, word in enumerate(plain):
        if not is_number(word, "."):
            row = next((n for n, row in enumerate(text.split("\n")) if words[k] in row.split()), 0)
            place = f", line {line + row}" if line else ""
            raise _bad(path, f"the {what} holds a word that is no number ({words[k]!r}{place})")
    return np.array(plain, np.float64)


def _bad(path: Path, found: str) -> DataError:
    return DataError(Problem("mcf_damaged", str(path), found, "Write the file again with MCFOPT"))
