"""Which reader a foreign file needs, recognised by its first bytes and not by its name."""

from pathlib import Path
from typing import Literal

from fatigue.errors import DataError, Problem
from fatigue.readers.fe_model import FeModel
from fatigue.readers.fe_results import FeResults
from fatigue.readers.foreign_history import ForeignHistory
from fatigue.readers.mcf import is_mcf, read_mcf
from fatigue.readers.nastran_bdf import read_bdf
from fatigue.readers.nastran_h5 import read_h5, read_h5_model
from fatigue.readers.nastran_op2 import read_op2
from fatigue.readers.nastran_punch import read_punch
from fatigue.readers.text_encoding import marked_encoding
from fatigue.readers.text_history import read_parquet_history, read_text_history

Format = Literal["op2", "h5", "parquet", "punch", "mcf", "bdf", "text"]

_HEAD = 200_000
_BINARY: dict[Format, tuple[bytes, ...]] = {
    "h5": (b"\x89HDF\r\n\x1a\n",),
    "parquet": (b"PAR1",),
    "op2": (b"\x04\0\0\0", b"\x08\0\0\0", b"\0\0\0\x04", b"\0\0\0\x08"),
}
_PUNCH_STARTS = ("$TITLE", "$SUBTITLE", "$LABEL", "$SUBCASE ID", "$GRID POINT")
_BULK_STARTS = ("GRID", "BEGIN BULK", "CEND", "INCLUDE ", "CQUAD4", "CTRIA3", "SOL ")


def recognise(path: Path) -> Format:
    """Tell the format of a file by its content.

    Raises
    ------
    DataError : missing, unreadable or empty file, an unknown binary format
    """
    try:
        with path.open("rb") as file:
            head = file.read(_HEAD)
    except OSError as error:
        raise DataError(
            Problem("unreadable", str(path), f"the file cannot be read ({error.strerror})", "Check the path")
        ) from error
    if not head:
        raise DataError(Problem("empty", str(path), "the file is empty", "Give the file that the solver wrote"))
    for form, starts in _BINARY.items():
        if head.startswith(starts):
            return form
    encoding = marked_encoding(head)
    if b"\0" in head and encoding == "utf-8":
        raise DataError(
            Problem(
                "unknown_binary",
                str(path),
                "an unknown binary format",
                "Give .op2, MSC .h5, .pch, .bdf, .mcf, .parquet or a text table",
            )
        )
    return _text_format(head.decode(encoding, errors="replace"))


def _text_format(text: str) -> Format:
    """Tell the format of a text file by its first lines."""
    lines = text.splitlines()
    if is_mcf(text):
        return "mcf"
    if any(line.startswith(_PUNCH_STARTS) for line in lines[:50]):
        return "punch"
    if any(line.lstrip().upper().startswith(_BULK_STARTS) for line in lines):
        return "bdf"
    return "text"


def read_forces(path: Path, subcase: int | None) -> FeResults:
    """Read grid point forces from any format that holds them."""
    form = recognise(path)
    if form == "op2":
        return read_op2(path, subcase)
    if form == "h5":
        return read_h5(path, subcase)
    if form == "punch":
        return read_punch(path, subcase)
    raise DataError(
        Problem(
            "no_forces", str(path), f"a file of format {form} holds no grid point forces", "Give .op2, MSC .h5 or .pch"
        )
    )


def read_model(path: Path) -> FeModel:
    """Read geometry from any format that holds it."""
    form = recognise(path)
    if form == "bdf":
        return read_bdf(path)
    if form == "h5":
        return read_h5_model(path)
    raise DataError(
        Problem(
            "no_mesh", str(path), f"a file of format {form} holds no mesh", "Give the bulk data (.bdf, .dat) or MSC .h5"
        )
    )


def read_coordinates(path: Path, columns: dict[str, int] | None, time_column: str | None) -> ForeignHistory:
    """Read modal coordinates from any format that holds them."""
    form = recognise(path)
    if form == "mcf":
        if columns is not None or time_column is not None:
            what = "an .mcf file has no names of columns, for --columns or --time-column"
            raise DataError(Problem("no_column", str(path), what, "Leave the options out, or export a table"))
        return read_mcf(path)
    if form == "parquet":
        return read_parquet_history(path, columns, time_column)
    if form == "text":
        return read_text_history(path, columns, time_column)
    raise DataError(
        Problem(
            "no_coordinates",
            str(path),
            f"a file of format {form} holds no modal coordinates",
            "Export them as a text table, .parquet or .mcf",
        )
    )
