"""Modal coordinates of an ANSYS ``.mcf`` file: text, long rows wrapped or not."""

import re
from pathlib import Path

import numpy as np

from fatigue.errors import DataError, Problem
from fatigue.readers.foreign_history import ForeignHistory, check_values

_COUNT = re.compile(r"^\s*Number of Modes\s*:?\s*(\d{1,6})\s*$", re.MULTILINE | re.IGNORECASE | re.ASCII)
_NUMBERS = re.compile(r"^\s*Modes?\s*:?((?:\s+\d+)+)\s*$", re.MULTILINE | re.IGNORECASE | re.ASCII)
_FREQUENCIES = re.compile(
    r"^\s*Frequenc(?:y|ies)\s*:?((?:\s+[-+.\dED]+)+)\s*$", re.MULTILINE | re.IGNORECASE | re.ASCII
)
_TABLE = re.compile(r"^\s*(Time|Freq\w*)\s+Coordinates.*$", re.MULTILINE | re.IGNORECASE)


def is_mcf(head: str) -> bool:
    """Whether the beginning of a text file is that of a modal coordinates file."""
    return _COUNT.search(head) is not None


def read_mcf(path: Path) -> ForeignHistory:
    """Read times and modal coordinates of a transient run, mode numbers and frequencies.

    Raises
    ------
    DataError : unreadable, no such file, harmonic coordinates, a table that is cut or holds no numbers
    """
    try:
        text = path.read_text("ascii", errors="replace")
    except OSError as error:
        raise DataError(Problem("unreadable", str(path), f"it cannot be read ({error})", "Check the path")) from error
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
    try:
        values = np.array(text[table.end() :].split(), np.float64)
    except ValueError as error:
        raise _bad(path, f"the table holds a word that is no number ({error})") from None
    if modes == 0 or values.size == 0 or values.size % (modes + 1):
        raise _bad(path, f"{values.size} numbers are no whole number of rows of time and {modes} coordinates")
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
        )
    )


def _header(path: Path, found: re.Match[str] | None, modes: int, what: str) -> np.ndarray | None:
    """Numbers of a header line that may go on in the next lines; None if the file has no such line."""
    if found is None:
        return None
    try:
        values = np.array(found[1].split(), np.float64)
    except ValueError as error:
        raise _bad(path, f"the {what} hold a word that is no number ({error})") from None
    if values.size != modes:
        raise _bad(path, f"{values.size} {what} for {modes} modes")
    return values


def _bad(path: Path, found: str) -> DataError:
    return DataError(Problem("mcf_damaged", str(path), found, "Write the file again with MCFOPT"))
