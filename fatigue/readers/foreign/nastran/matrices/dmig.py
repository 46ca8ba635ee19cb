"""DMIG bulk data to matrices: headers, columns, one triangle or both.

``DMIG NAME 0 IFO TIN TOUT`` opens a matrix; ``DMIG NAME GJ CJ - G1 C1 A1 -`` has entries of the column of grid GJ,
component CJ, four fields each. A symmetric one (IFO 6) has each pair once, in either triangle.
"""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem
from fatigue.readers.foreign.nastran.deck.card import Card

Integers = NDArray[np.int64]
Floats = NDArray[np.float64]

SQUARE, SYMMETRIC = 1, 6
REAL = (1, 2)
FIRST = 4  # field of the first entry of a column
SAME = 1e-6  # of the larger: between both values of a pair that is given twice


@dataclass(slots=True)
class Dmig:
    """A matrix as its cards give it: degrees of freedom are pairs of grid and component, 1 to 6."""

    name: str
    where: str
    symmetric: bool
    row: list[tuple[int, int]] = field(default_factory=list)
    column: list[tuple[int, int]] = field(default_factory=list)
    value: list[float] = field(default_factory=list)

    def dofs(self) -> set[tuple[int, int]]:
        """Degrees of freedom that it has."""
        return {*self.row, *self.column}

    def entries(self, dofs: list[tuple[int, int]]) -> tuple[Integers, Integers, Floats]:
        """Row, column and value of its entries among sorted ``dofs``, both triangles of a symmetric one.

        Raises
        ------
        DataError : an entry twice, with two values
        """
        number = {dof: i for i, dof in enumerate(dofs)}
        i = np.array([number[dof] for dof in self.row], dtype=np.int64)
        j = np.array([number[dof] for dof in self.column], dtype=np.int64)
        value = np.array(self.value)
        if self.symmetric:
            i, j = np.maximum(i, j), np.minimum(i, j)
        keys, first, again = np.unique(i * len(dofs) + j, return_index=True, return_inverse=True)
        different = np.abs(value - value[first][again]) > SAME * np.abs(value)
        if different.any():
            row, column = self.row[int(different.argmax())], self.column[int(different.argmax())]
            what = (
                f"grid {row[0]}, component {row[1]} in the column of grid {column[0]}, component {column[1]} is there"
            )
            what += " twice with two values"
            raise DataError(Problem("entry_twice", f"{self.where}, {self.name}", what, "Keep one of them"))
        i, j, value = keys // len(dofs), keys % len(dofs), value[first]
        below = i != j
        if not self.symmetric:
            return i, j, value
        return np.append(i, j[below]), np.append(j, i[below]), np.append(value, value[below])


def add_dmig(matrices: dict[str, Dmig], card: Card) -> None:
    """Take one DMIG card in: the header of a matrix, or entries of one of its columns.

    Raises
    ------
    DataError : complex or rectangular, a column without its header, a scalar point, a field that is no number
    """
    name = card.text(0).upper()
    if card.text(1) == "0":
        matrices[name] = _header(name, card, matrices)
        return
    if name not in matrices:
        what = f"a column of {name or 'a matrix without a name'} stands here, and its header nowhere before"
        raise DataError(Problem("no_header", card.where, what, "Begin the matrix with DMIG NAME 0"))
    matrix, column = matrices[name], _dof(card, 1)
    for at in range(FIRST, len(card.fields), 4):
        if any(card.text(k) for k in range(at, at + 4)):
            matrix.row.append(_dof(card, at))
            matrix.column.append(column)
            matrix.value.append(card.real(at + 2))


def _header(name: str, card: Card, matrices: dict[str, Dmig]) -> Dmig:
    form, kind = card.integer(2), card.integer(3)
    if name in matrices:
        what = f"{name} begins again, after {matrices[name].where}"
        raise DataError(Problem("matrix_twice", card.where, what, "Keep one of them"))
    if form not in (SQUARE, SYMMETRIC):
        what = f"{name} is rectangular (form {form})"
        raise DataError(Problem("bad_matrix", card.where, what, "Give a square or symmetric matrix, form 1 or 6"))
    if kind not in REAL:
        what = f"{name} is complex (type {kind})"
        raise DataError(Problem("bad_matrix", card.where, what, "Give a real matrix, type 1 or 2"))
    return Dmig(name, card.where, form == SYMMETRIC)


def _dof(card: Card, at: int) -> tuple[int, int]:
    grid, component = card.integer(at), card.integer(at + 1, 0)
    if not 1 <= component <= 6:
        what = f"{card.text(0)} has point {grid} with component {component}"
        remedy = "Give matrices of grids alone, components 1 to 6, without modal coordinates"
        raise DataError(Problem("scalar_point", card.where, what, remedy))
    return grid, component
