"""Read a finite element body from a folder: tables of shells, or matrices and what their rows are."""

from dataclasses import dataclass
from pathlib import Path

from fatigue.errors import DataError, Problem
from fatigue.files.naming import missing_file
from fatigue.flexbody.shell_mesh import ShellMesh
from fatigue.flexbody.structure import Structure
from fatigue.readers.model.matrices import MATRIX_ENDINGS, read_structure
from fatigue.readers.model.shells import read_shell_mesh
from fatigue.readers.neutral.body.mesh import Mesh, read_mesh
from fatigue.readers.units.systems import unit_system

TABLE_ENDINGS = (".parquet", ".csv")


@dataclass(frozen=True, slots=True, eq=False)
class BodyModel:
    """A finite element body in N, mm, t as it was given.

    Attributes
    ----------
    body : a shell mesh, which has element forces at welds, or matrices, which have none
    mesh : nodes and elements for pictures; None where the folder has none
    files : what was read
    warnings : met while reading
    """

    body: ShellMesh | Structure
    mesh: Mesh | None
    files: tuple[Path, ...]
    warnings: tuple[Problem, ...]


def read_model(folder: Path, *, units: str = "mm-t-s", strict: bool = False) -> BodyModel:
    """Read ``nodes``, ``elements``, ``properties``, or ``K``, ``M`` (.mtx, .npz, .op4) with ``dof``.

    Tables are .parquet or .csv. ``dof`` says of each row of the matrices its ``row``, from 1, ``node`` and
    ``component``, 1 to 6, and has ``x_mm, y_mm, z_mm`` unless ``nodes`` has them. ``units`` are those of K and M.

    Raises
    ------
    CaseError : unknown units
    DataError : files missing or of both kinds; a mistake in one of them
    """
    system = unit_system(units, "units")
    if not folder.is_dir():
        raise DataError(missing_file(folder))
    nodes, elements, properties, dof = (
        _found(folder, name, TABLE_ENDINGS) for name in ("nodes", "elements", "properties", "dof")
    )
    K, M = (_found(folder, name, MATRIX_ENDINGS) for name in ("K", "M"))
    of_matrices = {"K.mtx": K, "M.mtx": M, "dof.csv": dof}
    of_shells = {"nodes.csv": nodes, "elements.csv": elements, "properties.csv": properties}
    by_matrix = any(path is not None for path in of_matrices.values())
    if by_matrix and properties is not None:
        named = ", ".join(path.name for path in of_matrices.values() if path is not None)
        what = f"{properties.name} is here, and {named} too"
        raise DataError(Problem("two_models", str(folder), what, "Keep the properties of the shells, or the matrices"))
    needed = _all_of(folder, of_matrices if by_matrix else of_shells)
    mesh, warnings = read_mesh(nodes, elements, strict=strict) if nodes is not None else (None, [])
    if by_matrix or mesh is None:
        structure, more = read_structure(needed[0], needed[1], needed[2], mesh, system, strict=strict)
        beside = tuple(path for path in (nodes, elements) if path is not None)
        return BodyModel(structure, mesh, (*needed, *beside), (*warnings, *more))
    shells, more = read_shell_mesh(mesh, needed[1], needed[2], strict=strict)
    return BodyModel(shells, mesh, needed, (*warnings, *more))


def _found(folder: Path, name: str, endings: tuple[str, ...]) -> Path | None:
    """File of this name, None if there is none.

    Raises
    ------
    DataError : the folder has two of them
    """
    found = [path for ending in endings if (path := folder / f"{name}{ending}").is_file()]
    if len(found) > 1:
        what = f"{found[0].name} and {found[1].name} are both here"
        raise DataError(Problem("two_files", str(folder), what, "Keep one of them"))
    return found[0] if found else None


def _all_of(folder: Path, files: dict[str, Path | None]) -> tuple[Path, ...]:
    """Give files that all have to be there.

    Raises
    ------
    DataError : some are missing
    """
    missing = [name for name, path in files.items() if path is None]
    if missing:
        what = f"{', '.join(missing)} {'is' if len(missing) == 1 else 'are'} missing"
        remedy = "Give nodes, elements and properties of shells, or K, M and dof"
        raise DataError(Problem("missing_file", str(folder), what, remedy))
    return tuple(path for path in files.values() if path is not None)
