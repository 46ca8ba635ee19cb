"""Values of one Arrow column as numpy arrays; nothing here knows of files, or of what is said about mistakes."""

from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.types as pt
from numpy.typing import NDArray

from fatigue.files.naming import composed


def floats_of(column: pa.ChunkedArray) -> NDArray[Any] | None:
    """Floating-point numbers of a column (r,), float32 kept, empty cells as NaN; None where it holds no numbers."""
    if pt.is_null(column.type):
        return np.full(len(column), np.nan)
    if pt.is_decimal(column.type) or pt.is_integer(column.type):
        return np.asarray(column.cast(pa.float64(), safe=False).to_numpy())  # beyond 2^53 rounded
    if pt.is_floating(column.type):
        values = np.asarray(column.to_numpy())
        return values.astype(np.float64) if values.dtype == np.float16 else values
    return None


def seconds_of(durations: pa.ChunkedArray) -> NDArray[np.float64]:
    """Durations in seconds (r,), NaN where one is missing."""
    ticks = {"s": 1, "ms": 10**3, "us": 10**6, "ns": 10**9}[durations.type.unit]
    return np.asarray(durations.cast(pa.int64()).to_numpy()).astype(np.float64) / ticks


def codes_of(texts: pa.DictionaryArray, missing: int) -> NDArray[np.integer]:
    """Codes of a coded column (r,), those of empty cells ``missing``."""
    codes = texts.indices if texts.null_count == 0 else texts.indices.fill_null(missing)
    return np.asarray(codes.to_numpy())


def numbers_of_texts(column: pa.ChunkedArray) -> pa.ChunkedArray:
    """Whole numbers of a column whose texts are all such, as ids are that a program keeps as texts; else the column."""
    if pt.is_dictionary(column.type):
        column = column.cast(column.type.value_type)
    if not is_text(column.type):
        return column
    try:
        return column.cast(pa.int64())
    except pa.ArrowException:
        return column


def is_text(kind: pa.DataType) -> bool:
    """Whether values of this type are texts."""
    return bool(pt.is_string(kind) or pt.is_large_string(kind) or pt.is_string_view(kind))


def is_number(value: object) -> bool:
    """Whether a value is a text that Arrow reads as a number."""
    try:
        pa.scalar(value, pa.string()).cast(pa.float64())
    except (pa.ArrowException, TypeError):
        return False
    return True


def holds_names(column: pa.ChunkedArray) -> bool:
    """Whether a column holds what can be a name: texts, whole numbers, or nothing."""
    kind = column.type.value_type if pt.is_dictionary(column.type) else column.type
    return is_text(kind) or bool(pt.is_integer(kind) or pt.is_null(kind))


def distinct_texts(column: pa.ChunkedArray, default: str) -> tuple[tuple[str, ...], NDArray[np.int32]]:
    """Distinct trimmed texts of a column in sorted order, and which of them each row holds (r,); empty: the default."""
    if not pt.is_dictionary(column.type):
        column = column.cast(pa.string()).dictionary_encode()
    chunks = column.unify_dictionaries().chunks
    stored = [composed(text or "") for text in chunks[0].dictionary.cast(pa.string()).to_pylist()]
    stored.append("")  # position -1 stands for an empty cell
    names, merged = np.unique(np.array([text or default for text in stored], object), return_inverse=True)
    places = [codes_of(chunk, len(stored) - 1) for chunk in chunks]
    place = places[0] if len(places) == 1 else np.concatenate(places)
    used = np.zeros(names.size, dtype=np.bool_)
    used[merged[np.bincount(place, minlength=len(stored)) > 0]] = True
    return tuple(names[used]), (np.cumsum(used, dtype=np.int32) - 1)[merged][place]
