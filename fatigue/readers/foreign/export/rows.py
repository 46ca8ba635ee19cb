"""Rows of a block as what they are to be: so many columns, ids, whole numbers."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.readers.foreign.export.layout import Block, damaged


def columns(path: Path, block: Block, count: int) -> NDArray[np.float64]:
    """Rows (r, count); a block of another width is refused."""
    if block.values.shape[1] != count:
        raise damaged(path, block.line, f"*{block.name} has {block.values.shape[1]} columns, and {count} are read")
    return block.values


def only_row(path: Path, block: Block, count: int) -> NDArray[np.float64]:
    """The row (count,) of a block that has one, which begins with a number from 1."""
    row = columns(path, block, count)
    if len(row) != 1 or not (row[0, 0] >= 1 and float(row[0, 0]).is_integer()):
        raise damaged(path, block.line, f"*{block.name} has to have one row that begins with its number")
    found: NDArray[np.float64] = row[0]
    return found


def ids(path: Path, block: Block, column: int) -> NDArray[np.int64]:
    """Ids (r,) of a column, whole numbers from 1."""
    values = block.values[:, column] if block.values.shape[1] > column else np.full(len(block.values), np.nan)
    bad = np.flatnonzero(~((values >= 1) & (values < 2**53) & (values == np.rint(values))))
    if bad.size:
        raise damaged(path, block.line + int(bad[0]) + 1, f"{values[bad[0]]:g} is no id")
    return values.astype(np.int64)


def whole(path: Path, block: Block) -> NDArray[np.int64]:
    """Rows of whole numbers, none below zero."""
    values = block.values
    bad = np.argwhere(~((values >= 0) & (values < 2**53) & (values == np.rint(values))))
    if bad.size:
        row, column = bad[0].tolist()
        raise damaged(path, block.line + row + 1, f"{values[row, column]:g} is no id")
    return values.astype(np.int64)
