"""A finite element model as it is given: matrices, and where it is a mesh of shells what weld forces need of it."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem, refuse
from fatigue.flexbody.shell_mesh import ShellMesh
from fatigue.flexbody.structure import Structure
from fatigue.weld.line import LineStack

TABLES = (".parquet", ".csv")
MATRICES = (".mtx", ".npz", ".dmig", ".pch", ".op4")


@dataclass(frozen=True, slots=True, eq=False)
class WeldSides:
    """Weld lines and the elements of the assessed side of each, by name."""

    lines: LineStack
    elements: Mapping[str, NDArray[np.int64]]


@dataclass(frozen=True, slots=True, eq=False)
class Model:
    """A model ready to be reduced.

    ``mesh`` and ``welds`` are None where the model does not have them, and ``no_forces`` says why there are then no
    weld forces. ``tables`` are those of mesh and welds that go into the folder as they are, by file name, ``files`` all
    that was read, ``node_file`` the one that nodes are told by.
    """

    structure: Structure
    files: tuple[Path, ...]
    node_file: str
    mesh: ShellMesh | None = None
    welds: WeldSides | None = None
    no_forces: Problem | None = None
    tables: Mapping[str, pa.Table] = field(default_factory=dict)
    warnings: tuple[Problem, ...] = ()


def table_in(folder: Path, name: str) -> Path | None:
    """The table of this name in a folder, Parquet or CSV; None where there is none.

    Raises
    ------
    DataError : there are both
    """
    return _only(folder, name, [folder / f"{name}{suffix}" for suffix in TABLES])


def matrix_in(folder: Path, name: str) -> Path | None:
    """The file of the matrix K or M in a folder; None where there is none.

    Raises
    ------
    DataError : there are several
    """
    return _only(folder, name, [folder / f"{letter}{suffix}" for letter in (name, name.lower()) for suffix in MATRICES])


def _only(folder: Path, name: str, paths: list[Path]) -> Path | None:
    found: list[Path] = []
    for path in paths:
        if path.is_file() and not any(path.samefile(other) for other in found):
            found.append(path)
    if len(found) > 1:
        what = f"{name} is there twice: {' and '.join(path.name for path in found)}"
        raise DataError(Problem("twice", str(folder), what, "Keep one of the files"))
    return found[0] if found else None


HEAVIEST, LIGHTEST = 2.3e-8, 1e-13  # t/mm3, of the box around a body: osmium, a tenth of air
THIN = 1e-2  # of its longest side: what a flat body counts as thick


def refuse_other_units(xyz: NDArray[np.float64], mass_t: float, where: str) -> None:
    """Refuse a body that is heavier or lighter than any body of its size in mm and t.

    Raises
    ------
    DataError : mass or places are in other units
    """
    side = np.ptp(xyz, axis=0)
    density = mass_t / float(np.prod(np.maximum(side, THIN * side.max())))
    if LIGHTEST < density < HEAVIEST:
        return
    size = " x ".join(f"{length:.4g}" for length in side.tolist())
    than = "heavier than osmium" if density >= HEAVIEST else "lighter than air"
    what = f"a body of {mass_t:.4g} t in a box of {size} mm would be {than}"
    remedy = "Give lengths in mm, masses in t, forces in N, all of them in one system"
    refuse(DataError, [Problem("other_unit", where, what, remedy)])
