"""Stresses of homogeneous shells from an MSC Nastran HDF5 file: tables below ``NASTRAN/RESULT/ELEMENTAL/STRESS``."""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem
from fatigue.readers.foreign.fe.shell_stress import REQUEST, ShellStresses, StressBlock
from fatigue.readers.foreign.nastran.results.h5 import domain_key, opened, unusable_domain
from fatigue.readers.foreign.nastran.results.stress_kinds import LAYERED_WHY

_GROUP = "NASTRAN/RESULT/ELEMENTAL/STRESS"
_SHELL = re.compile(r"(QUAD4|QUAD8|QUADR|QUAD(?=_CN)|TRIA3|TRIA6|TRIAR)(_CN)?(_COMP)?(_CPLX)?\Z")
"""Name of the shell, whether it has corners, plies, complex numbers; QUAD_CN is a QUAD4 with corners."""
_AT_ONCE = 1 << 17  # rows


def read_h5_stresses(path: Path, wanted: NDArray[np.int64]) -> ShellStresses:
    """Read the stresses of the ``wanted`` elements in all real modes and static subcases, in double precision.

    Raises
    ------
    DataError : damaged file, no stresses of shells, complex results
    """
    found: list[StressBlock] = []
    unread: dict[int, str] = {}
    problems: list[Problem] = []
    with opened(path) as read:
        domains = {int(d["ID"]): d for d in read("NASTRAN/RESULT/DOMAINS", required=False)}
        for name, form in _tables(path):
            if form[4]:
                what = f"the stresses of {form[1]} are complex (table {name})"
                problems.append(Problem("complex_stresses", str(path), what, REQUEST))
                continue
            rows = _wanted_rows(path, name, wanted)
            if form[3]:
                unread |= dict.fromkeys(np.unique(rows["EID"]).tolist(), LAYERED_WHY)
                continue
            for key in np.unique(rows["DOMAIN_ID"]).tolist():
                where = f"{path}, {name} domain {key}"
                if key not in domains:
                    what = "the table of domains lacks it"
                    raise DataError(Problem("no_domain", where, what, "Copy the file again"))
                if (other := unusable_domain(domains[key], where)) is not None:
                    problems.append(other)
                else:
                    own = rows[rows["DOMAIN_ID"] == key]
                    found.append(_block(where, domains[key], "QUAD4" if form[1] == "QUAD" else form[1], own))
    if not (found or unread or problems):
        what = f"no stresses of these shells below {_GROUP}"
        raise DataError(Problem("no_stresses", str(path), what, f"{REQUEST}, with MDLPRM,HDF5,1"))
    return ShellStresses(str(path), tuple(found), unread, tuple(problems))


def _tables(path: Path) -> Iterator[tuple[str, re.Match[str]]]:
    """Names of the tables of shells, taken apart."""
    with h5py.File(path, "r") as file:
        group = file.get(_GROUP)
        names = [name for name, table in group.items() if isinstance(table, h5py.Dataset)] if group is not None else []
    for name in names:
        if (form := _SHELL.match(name)) is not None:
            yield name, form


def _wanted_rows(path: Path, name: str, wanted: NDArray[np.int64]) -> NDArray[Any]:
    """Rows of the wanted elements of a table, which is read piece by piece."""
    with h5py.File(path, "r") as file:
        table = file[f"{_GROUP}/{name}"]
        parts = [table[:0]]
        for first in range(0, len(table), _AT_ONCE):
            rows = table[first : first + _AT_ONCE]
            parts.append(rows[np.isin(rows["EID"], wanted)])
    return np.concatenate(parts)


def _block(where: str, domain: Any, kind: str, rows: NDArray[Any]) -> StressBlock:
    """Stresses of one mode and kind of element."""
    shear = next((name for name in ("XY", "T") if f"{name}1" in (rows.dtype.names or ())), "TXY")
    fibre = np.stack([rows["FD1"], rows["FD2"]], axis=-1)
    stress = np.stack([np.stack([rows[f"{c}{k}"] for c in ("X", "Y", shear)], axis=-1) for k in (1, 2)], axis=-2)
    node = np.zeros((len(rows), 1), np.int64)
    if fibre.ndim == 2:  # centres only
        fibre, stress = fibre[:, None], stress[:, None]
    else:
        node = rows["GRID"].astype(np.int64)
        node[:, 0] = 0  # the number of nodes stands there
    subcase, mode = domain_key(domain)
    eigenvalue = float(domain["TIME_FREQ_EIGR"]) if mode else np.nan
    return StressBlock(where, subcase, mode, eigenvalue, kind, rows["EID"].astype(np.int64), node, fibre, stress)
