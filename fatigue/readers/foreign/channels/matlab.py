"""Variables of a MATLAB file of version 4 to 7, read with scipy."""

import math
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import scipy.io
import scipy.sparse
from scipy.io.matlab import MatlabFunction, MatlabOpaque, mat_struct

from fatigue.errors import DataError, Problem
from fatigue.readers.foreign.channels.group import ChannelGroup
from fatigue.readers.foreign.channels.variables import Unreadable, cells, groups_of_variables, in_order

AS_ARRAYS = "Save time and values as plain arrays: t = x.Time; q = x.Data; save('run.mat', 't', 'q', '-v7.3')"
MOST_SPARSE = 1 << 27  # elements of a sparse matrix, most of which take no room in the file


def read_matlab(path: Path) -> tuple[ChannelGroup, ...]:
    """Channels among the variables of the file; see ``variables``.

    Raises
    ------
    DataError : a damaged file, two variables of one name; as ``groups_of_variables``
    """
    try:
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            read = scipy.io.loadmat(path, struct_as_record=False, squeeze_me=False, chars_as_strings=True)
    except MemoryError:
        raise
    except Exception as error:
        text = " ".join(str(error).split())[:120] or type(error).__name__
        what = f"the MATLAB file is damaged or cut ({text})"
        raise DataError(Problem("mat_damaged", str(path), what, "Copy the file again, or save it anew")) from None
    if twice := next((str(one.message) for one in said if "uplicate variable name" in str(one.message)), ""):
        name = twice.partition('"')[2].partition('"')[0]
        what = f"two variables are called {name!r}"
        raise DataError(Problem("column_twice", str(path), what, "Save each once, with -append left out"))
    named = {key: value for key, value in read.items() if not (key.startswith("__") and key.endswith("__"))}
    opaque = {"an object": Unreadable("a timeseries, a table or another")} if "__function_workspace__" in read else {}
    return groups_of_variables(path, in_order({key: _plain(value) for key, value in named.items()} | opaque), AS_ARRAYS)


def _plain(value: Any) -> Any:
    """A variable as ``variables`` takes it."""
    if isinstance(value, mat_struct):
        return {str(name): _plain(getattr(value, name)) for name in value._fieldnames}
    if scipy.sparse.issparse(value):
        return (
            Unreadable("a sparse matrix, too large to be filled")
            if math.prod(value.shape) > MOST_SPARSE
            else np.asarray(value.toarray())
        )
    return _of_array(value) if isinstance(value, np.ndarray) else value


def _of_array(value: np.ndarray[Any, Any]) -> Any:
    """An array of numbers, texts or cells, or an object in the shape of one."""
    if isinstance(value, MatlabOpaque | MatlabFunction):
        kind = value["s2"] if value.dtype.names and "s2" in value.dtype.names else "object"
        return Unreadable(f"an object of the class {_class_name(kind)}")
    if value.dtype.kind == "U":
        return str(value.ravel()[0]) if value.size == 1 else tuple(str(text).strip() for text in value.ravel())
    if value.dtype == object:
        return cells([_plain(one) for one in value.ravel()])
    return value


def _class_name(kind: Any) -> str:
    raw = np.asarray(kind).ravel()
    found = raw[0] if raw.size else "object"
    return found.decode("ascii", "replace") if isinstance(found, bytes) else str(found)
