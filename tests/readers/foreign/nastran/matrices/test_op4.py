"""Formatted OUTPUT4 files: dense, and strings with both kinds of header, in both precisions."""

import numpy as np
import pytest
from scipy import sparse

from fatigue.errors import DataError
from fatigue.readers.foreign.nastran.matrices.op4 import read_op4

A = np.array([[2.5, 0, -1, 0], [0, 3, 0, 0], [-1, 0, 4.25e-7, 0], [0, 0, 0, 0], [1, 7, 0, 0]])


def strings(column):
    """Runs of values that are not 0: their first row from 1, and the values."""
    filled = np.flatnonzero(column)
    for run in np.split(filled, np.flatnonzero(np.diff(filled) > 1) + 1):
        if run.size:
            yield run[0] + 1, column[run]


def numbers(values, per_line, width, exponent="E"):
    """Values in lines of a format."""
    fields = [f"{value:{width}.{width - 7}E}".replace("E", exponent) for value in values]
    return ["".join(fields[k : k + per_line]) for k in range(0, len(fields), per_line)]


def op4(matrix, form, kind=2, name="KAA", layout="dense", per_line=5, width=16, exponent="E"):
    """A matrix as OUTPUT4 writes it."""
    rows, columns = matrix.shape
    sign = -1 if layout == "two words" else 1
    text = [f"{columns:8d}{sign * rows:8d}{form:8d}{kind:8d}{name:8s}1P,{per_line}E{width}.{width - 7}"]
    for j, column in enumerate(matrix.T, start=1):
        runs = list(strings(column))
        if not runs:
            continue
        if layout == "dense":
            first, last = runs[0][0], np.flatnonzero(column)[-1] + 1
            text.append(f"{j:8d}{first:8d}{last - first + 1:8d}")
            text += numbers(column[first - 1 : last], per_line, width, exponent)
            continue
        lengths = [1 + kind * values.size for _, values in runs]
        words = sum(lengths) + (len(runs) if layout == "two words" else 0)
        text.append(f"{j:8d}{0:8d}{words:8d}")
        for length, (row, values) in zip(lengths, runs, strict=True):
            head = f"{length:8d}{row:8d}" if layout == "two words" else f"{row + 65536 * length:8d}"
            text += [head, *numbers(values, per_line, width, exponent)]
    return "\n".join([*text, f"{columns + 1:8d}{1:8d}{1:8d}", *numbers([1.0], per_line, width, exponent)]) + "\n"


@pytest.mark.parametrize("layout", ["dense", "one word", "two words"])
@pytest.mark.parametrize(("kind", "per_line", "width"), [(1, 5, 16), (2, 3, 23)])
def test_all_layouts_give_the_same_matrix(tmp_path, layout, kind, per_line, width):
    """Several matrices in one file, a column without values, numbers that touch, exponents with D."""
    path = tmp_path / "m.op4"
    text = op4(A, 2, kind, "KAA", layout, per_line, width) + op4(A.T, 2, kind, "MAA", layout, per_line, width, "D")
    path.write_text(text)
    read = read_op4(path)
    assert list(read) == ["KAA", "MAA"]
    np.testing.assert_allclose(read["KAA"].toarray(), A, rtol=1e-9)
    np.testing.assert_allclose(read["MAA"].toarray(), A.T, rtol=1e-9)


def test_lines_as_a_solver_writes_them(tmp_path):
    """One column of a sparse matrix of 25 rows in the three forms, line by line as they stand in such files."""
    values = "-4.062035008E+02", " 2.102038380E+03", "-1.166030979E+03", " 7.149293476E+02"
    rows = 7, 14, 16, 23
    end = ["      32       1       1", " 1.000000000E+00"]
    two = ["      31     -25       2       2RMAT    1P,5E16.9", "       2       0      16"]
    one = ["      31      25       2       2RMAT    1P,5E16.9", "       2       0      12"]
    for row, value in zip(rows, values, strict=True):
        two += [f"       3{row:8d}", value]
        one += [f"{3 * 65536 + row:8d}", value]
    for text in (one, two):
        (tmp_path / "r.op4").write_text("\n".join([*text, *end]))
        matrix = read_op4(tmp_path / "r.op4")["RMAT"]
        assert matrix.shape == (25, 31)
        assert {
            (int(i), int(j)): v for (i, j), v in zip(zip(*matrix.nonzero(), strict=True), matrix.data, strict=True)
        } == {(row - 1, 1): float(value) for row, value in zip(rows, values, strict=True)}


def test_a_triangle_of_a_symmetric_matrix_is_both(tmp_path):
    """Form 6 with one triangle stands for the whole; with both it stays as it is."""
    S = sparse.csc_array(A[:3, :3] + A[:3, :3].T)
    for given in (np.tril(S.toarray()), S.toarray()):
        (tmp_path / "s.op4").write_text(op4(given, 6))
        np.testing.assert_allclose(read_op4(tmp_path / "s.op4")["KAA"].toarray(), S.toarray(), rtol=1e-9)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (b"\x18\x00\x00\x00\x05\xff", "is no formatted OUTPUT4 file"),
        (b"", "no matrix begins here"),
        (b"hello world\n", "are no 4 whole numbers in fields of 8"),
        (op4(A, 2, 4).encode(), "KAA is complex"),
        ("\n".join(op4(A, 2).splitlines()[:4]).encode(), "the file ends within a matrix"),
        (op4(A, 2).replace("1P,5E16.9", "LIST").encode(), "'LIST' is no format of numbers"),
        (op4(A, 2).replace("2.500000000E+00", "2.5000x0000E+00").encode(), "are no 5 numbers in fields of 16"),
        (op4(A, 2).replace("       4       5", "       4       3").encode(), "KAA has 3 rows, and a value beyond them"),
        (op4(A, 2, layout="one word").replace("  196609", "  131073").encode(), "holds no whole values"),
    ],
)
def test_damaged_files_are_refused(tmp_path, text, said):
    """With file and line."""
    (tmp_path / "m.op4").write_bytes(text)
    with pytest.raises(DataError) as error:
        read_op4(tmp_path / "m.op4")
    assert said in str(error.value)
    assert "m.op4" in str(error.value)
