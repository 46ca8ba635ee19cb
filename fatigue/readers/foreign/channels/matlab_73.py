"""Variables of a MATLAB file of version 7.3, which is an HDF5 file, read with h5py.

Arrays lie transposed; a text is an array of 16 bits a character; cells and arrays of structures are references.
"""

from pathlib import Path
from typing import Any

import numpy as np
import scipy.sparse

from fatigue.errors import DataError, Problem
from fatigue.readers.foreign.channels.group import ChannelGroup
from fatigue.readers.foreign.channels.matlab import AS_ARRAYS, MOST_SPARSE
from fatigue.readers.foreign.channels.variables import Unreadable, cells, groups_of_variables, in_order

_NUMBERS = frozenset(
    {"double", "single", "logical", *(f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64))}
)
_DEEPEST = 32  # structures in each other; a file that refers to itself goes on for ever
_MOST_PACKED = 1100  # deflate packs a run of equal bytes to 1 in 1032 at most


def read_matlab_73(path: Path) -> tuple[ChannelGroup, ...]:
    """Channels among the variables of the file; see ``variables``.

    Raises
    ------
    DataError : a damaged file; as ``groups_of_variables``
    """
    import h5py  # noqa: PLC0415 - the package of this format alone

    try:
        with h5py.File(path, "r") as file:
            variables = {name: _plain(file[name], file, 0) for name in file if not name.startswith("#")}
    except (DataError, MemoryError):
        raise
    except Exception as error:
        said = " ".join(str(error).split())[:120] or type(error).__name__
        what = f"the MATLAB file is damaged or cut ({said})"
        raise DataError(Problem("mat_damaged", str(path), what, "Copy the file again, or save it anew")) from None
    return groups_of_variables(path, in_order(variables), AS_ARRAYS)


def _plain(item: Any, file: Any, depth: int) -> Any:
    """A variable as ``variables`` takes it."""
    if depth > _DEEPEST:
        return Unreadable("a structure that contains itself")
    kind = _text(item.attrs.get("MATLAB_class", b""))
    if "MATLAB_object_decode" in item.attrs or (kind and kind not in (*_NUMBERS, "char", "cell", "struct", "sparse")):
        return Unreadable(f"an object of the class {kind}" if kind else "an object")
    if hasattr(item, "keys"):
        is_sparse = kind == "sparse" or "MATLAB_sparse" in item.attrs
        return _sparse(item) if is_sparse else _struct(item, file, depth)
    return _of_data(item, kind, file, depth)


def _of_data(item: Any, kind: str, file: Any, depth: int) -> Any:
    """Nothing, an array of references, characters or numbers."""
    if "MATLAB_empty" in item.attrs:
        return "" if kind == "char" else np.zeros(0)
    _refuse_promise(item, file)
    if item.dtype == object:
        return cells([_plain(file[reference], file, depth + 1) for reference in item[()].T.ravel()])
    if kind == "char":
        rows = np.atleast_2d(np.asarray(item[()]).T)
        texts = tuple("".join(map(chr, row)).strip("\0 ") for row in rows.tolist())
        return texts[0] if len(texts) == 1 else texts
    values = item[()]
    if values.dtype.names:  # real and imaginary part
        values = values["real"] + 1j * values["imag"] if {"real", "imag"} <= set(values.dtype.names) else np.zeros(0)
    return np.asarray(values).T


def _struct(item: Any, file: Any, depth: int) -> Any:
    """A structure, or an array of structures, each field of which is an array of references."""
    order = ["".join(map(_text, name)) for name in item.attrs.get("MATLAB_fields", ())]  # HDF5 has them by the alphabet
    fields = {name: item[name] for name in (order if set(order) == set(item) else item)}
    references = {
        name: field[()].T.ravel()
        for name, field in fields.items()
        if not hasattr(field, "keys") and field.dtype == object and "MATLAB_class" not in field.attrs
    }
    if fields and len(references) == len(fields) and len({len(some) for some in references.values()}) == 1:
        count = len(next(iter(references.values())))
        rows = [
            {name: _plain(file[some[k]], file, depth + 1) for name, some in references.items()} for k in range(count)
        ]
        return rows[0] if count == 1 else rows
    return {name: _plain(field, file, depth + 1) for name, field in fields.items()}


def _sparse(item: Any) -> Any:
    """A sparse matrix, whole: values, their rows, and where each column begins among them."""
    rows, starts = int(item.attrs["MATLAB_sparse"]), np.asarray(item["jc"][()]).ravel()
    shape = (rows, starts.size - 1)
    if "data" not in item or rows * shape[1] > MOST_SPARSE:
        return Unreadable("a sparse matrix, empty or too large to be filled")
    parts = (np.asarray(item["data"][()]).ravel(), np.asarray(item["ir"][()]).ravel(), starts)
    return np.asarray(scipy.sparse.csc_array(parts, shape=shape).toarray())


def _refuse_promise(item: Any, file: Any) -> None:
    """Refuse an array that promises more values than the file can hold, however well it packs them."""
    there = Path(file.filename).stat().st_size
    if item.size * item.dtype.itemsize > _MOST_PACKED * there:
        what = f"it promises {item.size} values, and the file has {there} bytes"
        where = f"{file.filename}, array {item.name!r}"
        raise DataError(Problem("cut", where, what, "Copy the file again"))


def _text(value: Any) -> str:
    return value.decode("ascii", "replace") if isinstance(value, bytes) else str(value)
