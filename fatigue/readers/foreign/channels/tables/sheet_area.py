"""How far the cells of a workbook reach: a stray cell at the end of a sheet would make its reader fill all memory."""

import re
import zipfile
import zlib
from pathlib import Path

from fatigue.errors import DataError, Problem

_MOST_CELLS = 50_000_000  # with the empty ones; about what a million samples of 50 channels take
_MOST_BYTES = 8 << 30  # of all parts, unpacked
_BLOCK = 1 << 24
_CELL = re.compile(rb'<(?:\w+:)?c r="([A-Z]{1,3})(\d{1,7})"')


def refuse_far_cells(path: Path) -> None:
    """Refuse a workbook with a sheet whose corner cells span more than memory should hold.

    Raises
    ------
    DataError : such a sheet, with its last row and column; a damaged archive
    """
    try:
        with zipfile.ZipFile(path) as archive:
            size = sum(part.file_size for part in archive.infolist())
            if size > _MOST_BYTES:
                what = f"unpacked it has {size / 2**30:.0f} GiB"
                raise DataError(Problem("workbook_damaged", str(path), what, "Write the channels as CSV or Parquet"))
            for part in archive.infolist():
                if re.match(r"xl/worksheets/[^/]+\.xml", part.filename):
                    _refuse_far_cells(path, archive, part)
    except (zipfile.BadZipFile, zlib.error, EOFError, OSError, NotImplementedError, RuntimeError, ValueError) as error:
        what = f"the workbook is damaged or cut ({' '.join(str(error).split())[:120]})"
        raise DataError(Problem("workbook_damaged", str(path), what, "Copy the file again, or save it anew")) from None


def _refuse_far_cells(path: Path, archive: zipfile.ZipFile, part: zipfile.ZipInfo) -> None:
    columns: set[bytes] = set()
    rows, rest = 0, b""
    with archive.open(part) as file:
        while block := file.read(_BLOCK):
            found = _CELL.findall(rest + block)
            rest = block[-40:]
            columns.update(letters for letters, _ in found)
            rows = max(rows, max((int(row) for _, row in found), default=0))
    column = max((len(letters), letters) for letters in columns)[1].decode() if columns else "A"
    width = 0
    for letter in column:
        width = 26 * width + ord(letter) - ord("A") + 1
    if rows * width > _MOST_CELLS:
        what = f"its cells reach to row {rows} and column {column}, {rows * width} cells with the empty ones"
        remedy = "Delete the stray cells beyond the table, or write the channels as CSV or Parquet"
        raise DataError(Problem("workbook_damaged", f"{path}, {part.filename}", what, remedy))
