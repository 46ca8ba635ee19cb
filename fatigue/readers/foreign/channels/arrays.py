"""Arrays of NumPy files, ``.npy`` and ``.npz``, never pickled objects."""

import math
import zipfile
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.lib import format as npy
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem
from fatigue.readers.foreign.channels.group import ChannelGroup
from fatigue.readers.foreign.channels.variables import groups_of_variables


def read_npy(path: Path) -> tuple[ChannelGroup, ...]:
    """Channels of one array: a matrix whose first column is time, or a structured one; see ``variables``.

    Raises
    ------
    DataError : a damaged file, pickled objects; as ``groups_of_variables``
    """
    with path.open("rb") as file:
        array = _array(path, file, path.stat().st_size, "")
    return groups_of_variables(path, _named(path.stem, array))


def read_npz(path: Path) -> tuple[ChannelGroup, ...]:
    """Channels among the arrays of an archive; see ``variables``.

    Raises
    ------
    DataError : a damaged file, pickled objects; as ``groups_of_variables``
    """
    variables: dict[str, Any] = {}
    try:
        with zipfile.ZipFile(path) as archive:
            for member in archive.infolist():
                name = member.filename.removesuffix(".npy")
                with archive.open(member) as file:
                    variables |= _named(name, _array(path, file, member.file_size, f", array {name!r}"))
    except (zipfile.BadZipFile, EOFError, NotImplementedError, RuntimeError, OSError) as error:
        raise _damaged(path, "", error) from None
    return groups_of_variables(path, variables)


def _array(path: Path, file: IO[bytes], size: int, which: str) -> NDArray[Any]:
    """One array, unless its header promises more than is there."""
    try:
        version = npy.read_magic(file)
        shape, order, kind = (npy.read_array_header_1_0 if version == (1, 0) else npy.read_array_header_2_0)(file)
        if kind.hasobject:
            what, remedy = "it holds pickled objects, which are never read", "Save arrays of numbers"
            raise DataError(Problem("pickled", f"{path}{which}", what, remedy))
        count = math.prod(shape)
        if min(shape, default=0) < 0 or count * kind.itemsize > size:
            what = f"its header promises {count} values of {kind.itemsize} bytes; there are {size} bytes in all"
            raise DataError(Problem("cut", f"{path}{which}", what, "Copy the file again"))
        data = file.read(count * kind.itemsize)
        return np.frombuffer(data, kind, count).reshape(shape, order="F" if order else "C")
    except (DataError, MemoryError):
        raise
    except Exception as error:  # the header is a text that numpy parses as Python, with its errors
        raise _damaged(path, which, error) from None


def _named(name: str, array: NDArray[Any]) -> dict[str, Any]:
    """An array by its name, a structured one by the names of its fields, a list of texts as one."""
    if array.dtype.names:
        return {field: np.ascontiguousarray(array[field]) for field in array.dtype.names}
    if array.dtype.kind in "US":
        texts = [one.decode("utf-8", "replace") if isinstance(one, bytes) else str(one) for one in array.ravel()]
        return {name: texts[0] if array.ndim == 0 else tuple(texts)}
    return {name: array}


def _damaged(path: Path, which: str, error: Exception) -> DataError:
    said = " ".join(str(error).split())[:120] or type(error).__name__
    what = f"the NumPy file is damaged or cut ({said})"
    return DataError(Problem("npy_damaged", f"{path}{which}", what, "Copy the file again, or save it anew"))
