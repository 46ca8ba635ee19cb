"""Which reader a foreign file needs, recognised by its first bytes and not by its name."""

from collections.abc import Collection
from pathlib import Path
from typing import Literal

from fatigue.errors import DataError, Problem, refuse
from fatigue.known_formats import known_format, own_format, unknown_binary
from fatigue.naming import missing_foreign_file
from fatigue.readers.foreign.fe.model import FeModel
from fatigue.readers.foreign.fe.results import FeResults
from fatigue.readers.foreign.histories.foreign_history import ForeignHistory
from fatigue.readers.foreign.histories.mcf import is_mcf, read_mcf
from fatigue.readers.foreign.histories.text import read_parquet_history, read_text_history
from fatigue.readers.foreign.nastran.deck.bdf import read_bdf
from fatigue.readers.foreign.nastran.results.h5 import read_h5, read_h5_model
from fatigue.readers.foreign.nastran.results.op2 import read_op2
from fatigue.readers.foreign.nastran.results.punch import read_punch
from fatigue.readers.text.encoding import marked_encoding

Format = Literal["op2", "h5", "parquet", "punch", "mcf", "bdf", "text"]

_IS: dict[Format, tuple[str, str]] = {  # what each is called, and the option it belongs to
    "op2": ("a NASTRAN OP2 file", "--forces"),
    "h5": ("an HDF5 file", "--forces or --mesh"),
    "parquet": ("a Parquet table", "--coordinates, or, if it is a table of a case, to case.toml"),
    "punch": ("a NASTRAN punch file", "--forces"),
    "mcf": ("an ANSYS file of modal coordinates", "--coordinates"),
    "bdf": ("a NASTRAN deck", "--mesh"),
    "text": ("a text table", "--coordinates if it holds them"),
}

_HEAD = 200_000
_READABLE = "Give .op2, MSC .h5, .pch, .bdf, .mcf, .parquet or a text table"
_BINARY: dict[Format, tuple[bytes, ...]] = {
    "h5": (b"\x89HDF\r\n\x1a\n",),
    "parquet": (b"PAR1",),
    "op2": (b"\x04\0\0\0", b"\x08\0\0\0", b"\0\0\0\x04", b"\0\0\0\x08"),
}
_PUNCH_STARTS = ("$TITLE", "$SUBTITLE", "$LABEL", "$SUBCASE ID", "$GRID POINT")
_BULK_STARTS = (
    *("GRID", "GRDSET", "BEGIN BULK", "BEGIN,BULK", "CEND", "CQUAD", "CTRIA", "CORD1", "CORD2", "PSHELL", "SOL "),
    *(f"INCLUDE{sign}" for sign in " '\"=,"),
)


def recognise(path: Path) -> Format:
    """Tell the format of a file by its content.

    Raises
    ------
    DataError : missing, unreadable or empty file, an unknown binary format
    """
    try:
        with path.open("rb") as file:
            head = file.read(_HEAD)
    except (FileNotFoundError, NotADirectoryError, IsADirectoryError):
        raise DataError(missing_foreign_file(path)) from None
    except OSError as error:
        raise DataError(
            Problem("unreadable", str(path), f"the file cannot be read ({error.strerror})", "Check the path")
        ) from error
    if not head:
        raise DataError(Problem("empty", str(path), "the file is empty", "Give the file that the solver wrote"))
    for form, starts in _BINARY.items():
        if head.startswith(starts):
            return form
    if (known := known_format(path)) is not None:
        raise DataError(Problem("foreign_format", str(path), f"this is {known.name}", known.remedy))
    refuse(DataError, filter(None, [unknown_binary(path, str(path), _READABLE)]))
    return _text_format(head.decode(marked_encoding(head), errors="replace"))


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


def read_forces(path: Path, subcase: int | None, interface: Collection[int] = ()) -> FeResults:
    """Read grid point forces from any format that holds them, with static subcases named as interface modes."""
    form = recognise(path)
    if form == "op2":
        return read_op2(path, subcase, interface)
    if form == "h5":
        return read_h5(path, subcase, interface)
    if form == "punch":
        return read_punch(path, subcase, interface)
    raise DataError(
        _swapped("no_forces", path, form, "grid point forces", "--forces an .op2, an MSC .h5 or a punch file")
    )


def read_model(path: Path) -> FeModel:
    """Read geometry from any format that holds it."""
    form = recognise(path)
    if form == "bdf":
        return read_bdf(path)
    if form == "h5":
        return read_h5_model(path)
    raise DataError(_swapped("no_mesh", path, form, "mesh", "--mesh the deck (.bdf, .dat) or the MSC .h5"))


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
    if form == "text" and ((own := own_format(path)) is None or "--coordinates" in own.remedy):
        return read_text_history(path, columns, time_column)
    raise DataError(
        _swapped("no_coordinates", path, form, "modal coordinates", "--coordinates a text table, .parquet or .mcf")
    )


def _swapped(code: str, path: Path, form: Format, lacks: str, wanted: str) -> Problem:
    """Refusal of a file that is sound and in the wrong place: what it is, and where it belongs."""
    name, option = _IS[form]
    if form == "text" and (own := own_format(path)) is not None:
        return Problem(code, str(path), f"this is {own.name}, which holds no {lacks}", f"{own.remedy}, and to {wanted}")
    what = f"this is {name} (format {form}), which holds no {lacks}"
    return Problem(code, str(path), what, f"Give it to {option}, and to {wanted}")
