"""Tables of the neutral format read anew with pandas: whole ones, and some rows of those that grow with the body."""

from collections.abc import Iterator, Sequence
from contextlib import ExitStack, closing
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq

from fatigue.verify.recount.inputs.dialect import read_texts

FORCE_COLUMNS = ["fx_N", "fy_N", "fz_N", "mx_Nmm", "my_Nmm", "mz_Nmm"]
IDS = ("mode", "node", "order", "element")
TEXTS = ("weld", "unit_load", "surface", "curve", "kind", "description", "closed", "edge_mid", "curve_shear",
         "curve_root", "joint", "sides", "lever", "combination", "point", "planes", "case", "group", "line",
         "component", "role", "joint_type", "performance_class", "inspection_class")  # fmt: skip
_ROWS_AT_ONCE = 1 << 16
_BYTES_AT_ONCE = 1 << 20  # of each column, so that a file of one row group is not read as a whole


def read_frame(path: Path) -> pd.DataFrame:
    """Read a table: ids as integers, texts and flags as they are, all else as numbers."""
    if path.suffix.lower() == ".parquet":
        return _typed(pd.read_parquet(path))
    return _typed(pd.concat(read_texts(path, TEXTS), ignore_index=True))


def read_pieces(path: Path, columns: Sequence[str] = ()) -> Iterator[pd.DataFrame]:
    """Read a table piece by piece, in the order of its rows and typed as by ``read_frame``: some columns or all."""
    yield from (_typed(piece) for piece in _pieces(path, columns))


def read_rows_where(path: Path, key: str, values: Sequence[Any]) -> pd.DataFrame:
    """Read the rows of a table whose ``key``, ``weld`` or an id, is among some values."""
    found: list[pd.DataFrame] = []
    for piece in _pieces(path, (), key, values):
        codes, keys = pd.factorize(piece[key], use_na_sentinel=False)
        keys = pd.Series(keys)
        among = (_key(keys) if key == "weld" else _ids(keys)).isin(values).to_numpy()
        found.append(_typed(piece[among[codes]] if len(piece) else piece))
    return pd.concat([piece for piece in found if len(piece)] or found[:1], ignore_index=True)


def _pieces(path: Path, columns: Sequence[str], key: str = "", values: Sequence[Any] = ()) -> Iterator[pd.DataFrame]:
    """Pieces of a table as it stands, at least one; row groups whose key is surely none of the values are left out."""
    with ExitStack() as stack:
        if path.suffix.lower() == ".parquet":
            file = stack.enter_context(pq.ParquetFile(path, buffer_size=_BYTES_AT_ONCE))
            names = [name for name in file.schema_arrow.names if not columns or name.strip() in columns]
            yield _named(file.schema_arrow.empty_table().select(names).to_pandas())
            for number in range(file.num_row_groups):
                if not key or _may_hold(file, number, key, values):
                    for batch in file.iter_batches(_ROWS_AT_ONCE, [number], names):
                        yield _named(pa.Table.from_batches([batch]).to_pandas())
            return
        for piece in stack.enter_context(closing(read_texts(path, TEXTS, _ROWS_AT_ONCE))):
            named = _named(piece)
            yield named[[name for name in named.columns if name in columns]] if columns else named


def _may_hold(file: pq.ParquetFile, number: int, key: str, values: Sequence[Any]) -> bool:
    """Whether some of the values may be in a row group, by the least and the greatest of its keys."""
    group = file.metadata.row_group(number)
    names = [name.strip() for name in file.schema_arrow.names]
    statistics = group.column(names.index(key)).statistics
    if statistics is None or not statistics.has_min_max:
        return True
    least, greatest = statistics.min, statistics.max
    of_one_kind = all(isinstance(value, type(least)) for value in values[:1])
    if not of_one_kind or (isinstance(least, str) and (least != least.strip() or greatest != greatest.strip())):
        return True  # texts of numbers, and names with blanks around them, are ordered otherwise than these values
    if isinstance(least, str) and not all(value.isascii() for value in values):
        return True  # a letter with an accent may stand there as two characters, and is ordered by the first of them
    return any(least <= value <= greatest for value in values)


def _named(frame: pd.DataFrame) -> pd.DataFrame:
    frame.columns = frame.columns.str.strip()
    for name in frame.columns[frame.dtypes.map(lambda kind: kind.kind == "m")]:
        frame[name] = frame[name].dt.total_seconds()  # durations
    return frame


def _typed(frame: pd.DataFrame) -> pd.DataFrame:
    """Table with ids, numbers and names of welds in their types."""
    frame = _named(frame.copy(deep=False))
    for name in frame.columns.difference(TEXTS):
        frame[name] = _ids(frame[name]) if name in IDS else _numbers(frame[name])
    if "weld" in frame:
        frame["weld"] = _key(frame["weld"])
    return frame


def _ids(column: pd.Series) -> pd.Series:
    """Ids of a column, exact where they are written as whole numbers; a program may write them as 12.0 or 1e3.

    Where some are missing, as modes in rows of unit loads are, they are numbers and NaN.
    """
    try:
        return column.astype(np.int64)
    except ValueError:
        numbers = column.astype(np.float64)
        return numbers if numbers.isna().any() else numbers.astype(np.int64)


def _numbers(column: pd.Series) -> pd.Series:
    """Numbers of a column; a column of texts that nobody asks for stays as it is."""
    try:
        return column.astype(np.float64)
    except (TypeError, ValueError):
        return column


def _key(weld: pd.Series) -> pd.Series:
    return weld.astype(str).str.strip().str.normalize("NFC")
