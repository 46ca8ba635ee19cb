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
from fatigue.readers.foreign.channels.variables import Unreadable, groups_of_variables, in_order

_AS_ARRAYS = "Save time and values as arrays of numbers: np.savez('run.npz', t=t, q=q)"


def read_npy(path: Path) -> tuple[ChannelGroup, ...]:
    """Channels of one array: a matrix whose first column is time, or a structured one; see ``variables``.

    Raises
    ------
    DataError : a damaged file, pickled objects; as ``groups_of_variables``
    """
    with path.open("rb") as file:
        array = _array(path, file, path.stat().st_size, "")
    if array is None:
        what, remedy = "it holds pickled objects, which are never read", "Save arrays of numbers"
        raise DataError(Problem("pickled", str(path), what, remedy))
    variable = _variable(array)
    return groups_of_variables(path, variable if isinstance(variable, dict) else {path.stem: variable}, _AS_ARRAYS)


def read_npz(path: Path) -> tuple[ChannelGroup, ...]:
    """Channels among the arrays of an archive, but pickled objects; a structured array is a group; see ``variables``.

    Raises
    ------
    DataError : a damaged file, two arrays of one name; as ``groups_of_variables``
    """
    variables: dict[str, Any] = {}
    try:
        with zipfile.ZipFile(path) as archive:
            for member in archive.infolist():
                name = member.filename.removesuffix(".npy")
                if name in variables:
                    what = f"two arrays are called {name!r}"
                    raise DataError(Problem("column_twice", str(path), what, "Save each array once"))
                if member.filename.endswith(".npy"):
                    with archive.open(member) as file:
                        array = _array(path, file, member.file_size, f", array {name!r}")
                    variables[name] = Unreadable("a pickled object") if array is None else _variable(array)
    except (zipfile.BadZipFile, EOFError, NotImplementedError, RuntimeError, OSError) as error:
        raise _damaged(path, "", error) from None
    return groups_of_variables(path, in_order(variables), _AS_ARRAYS)


def _array(path: Path, file: IO[bytes], size: int, which: str) -> NDArray[Any] | None:
    """One array, unless its header promises more than is there; None if it is one of pickled objects."""
    try:
        version = npy.read_magic(file)
        shape, order, kind = (npy.read_array_header_1_0 if version == (1, 0) else npy.read_array_header_2_0)(file)
        if kind.hasobject:
            return None
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


def _variable(array: NDArray[Any]) -> Any:
    """An array as ``variables`` takes it: a structured one by the names of its fields, a list of texts as one."""
    if array.dtype.names:
        return {field: _variable(np.ascontiguousarray(array[field])) for field in array.dtype.names}
    if array.dtype.kind in "US":
        texts = [one.decode("utf-8", "replace") if isinstance(one, bytes) else str(one) for one in array.ravel()]
        return texts[0] if array.ndim == 0 else tuple(texts)
    return array


def _damaged(path: Path, which: str, error: Exception) -> DataError:
    said = " ".join(str(error).split())[:120] or type(error).__name__
    what = f"the NumPy file is damaged or cut ({said})"
    return DataError(Problem("npy_damaged", f"{path}{which}", what, "Copy the file again, or save it anew"))
