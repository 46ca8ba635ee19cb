"""A symmetric matrix of a body from a ``.mtx`` file of Matrix Market or a ``.npz`` of scipy.sparse."""

from pathlib import Path
from zipfile import BadZipFile

import numpy as np
from scipy import sparse
from scipy.io import mmread

from fatigue.errors import DataError, Problem
from fatigue.files.naming import missing_file

UNEQUAL = 1e-6  # of the largest value, between a matrix and its transpose: files have six digits or more
ENDINGS = (".mtx", ".npz")


def read_symmetric_matrix(path: Path, called: str, units: str, diagonal: str) -> sparse.csc_array:
    """Symmetric matrix (n, n) of a file; messages say what it is ``called``, its ``units``, and what a ``diagonal`` is.

    Raises
    ------
    DataError : missing, of another format, damaged, not square, not symmetric, 0, or below 0 on its diagonal
    """
    matrix = read_matrix(path, called)
    refuse_no_symmetric_matrix(path, matrix, called, units, diagonal)
    return matrix


def read_matrix(path: Path, called: str) -> sparse.csc_array:
    """Real matrix of a file as it is.

    Raises
    ------
    DataError : missing, of another format, damaged, complex
    """
    if not path.is_file():
        raise DataError(missing_file(path))
    readers = {".mtx": mmread, ".npz": sparse.load_npz}
    reader = readers.get(path.suffix.lower())
    if reader is None:
        what = f"unknown kind of file {path.suffix!r}"
        remedy = "Give a .mtx file of Matrix Market or a .npz file that scipy.sparse.save_npz wrote"
        raise DataError(Problem("unknown_format", str(path), what, remedy))
    try:
        with path.open("rb") as file:
            read = reader(file)
        matrix = sparse.csc_array(read, dtype=np.float64) if np.isrealobj(getattr(read, "data", read)) else None
    except (ValueError, OSError, LookupError, TypeError, OverflowError, EOFError, BadZipFile) as error:
        detail = str(error).splitlines()[0] if str(error) else type(error).__name__
        what = f"cannot be read as a matrix ({detail})"
        raise DataError(Problem("damaged_file", str(path), what, "Write the file again")) from None
    if matrix is None:
        raise DataError(Problem("bad_value", path.name, "its values are complex", f"Give a real {called}"))
    return matrix


def refuse_no_symmetric_matrix(path: Path, matrix: sparse.csc_array, called: str, units: str, diagonal: str) -> None:
    """Refuse a matrix that cannot be one of stiffness or mass.

    Raises
    ------
    DataError : not square, not finite, not symmetric, 0, or with values below 0 on its diagonal
    """
    rows, columns = matrix.shape
    if rows != columns or not rows:
        what = f"the matrix has {rows} rows and {columns} columns"
        raise DataError(Problem("bad_shape", path.name, what, "Give a square matrix, as many rows as columns"))
    bad = ~np.isfinite(matrix.data)
    if bad.any():
        entry = int(bad.argmax())
        where = (
            f"{path.name}: row {matrix.indices[entry] + 1}, "
            f"column {np.searchsorted(matrix.indptr, entry, side='right')}"
        )
        raise DataError(Problem("bad_value", where, f"{matrix.data[entry]} is not finite", "Give a finite number"))
    largest = float(np.abs(matrix.data).max(initial=0.0))
    if largest == 0.0:
        raise DataError(Problem("bad_value", path.name, "the matrix is 0", f"Give the {called} {units}"))
    difference = abs(matrix - matrix.T).tocoo()
    if difference.nnz and difference.data.max() > UNEQUAL * largest:
        at = int(difference.data.argmax())
        row, column = sorted((int(difference.coords[0][at]), int(difference.coords[1][at])))
        one_sided = sparse.triu(matrix, 1).nnz == 0 or sparse.tril(matrix, -1).nnz == 0
        what = f"the matrix is not symmetric: {matrix[row, column]:g}, and {matrix[column, row]:g} in row {column + 1}"
        what += "; only one of its triangles is there" if one_sided else ""
        remedy = "Write both triangles, or a .mtx file whose head says symmetric" if one_sided else "Export it again"
        raise DataError(Problem("not_symmetric", f"{path.name}: row {row + 1}, column {column + 1}", what, remedy))
    of_rows = matrix.diagonal()
    if of_rows.min() < 0.0:
        row = int(of_rows.argmin())
        what = f"{of_rows[row]:g} on the diagonal is below 0"
        raise DataError(
            Problem("bad_value", f"{path.name}: row {row + 1}", what, f"Give a {called}, {diagonal} above 0")
        )
