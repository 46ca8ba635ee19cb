"""Read a finite element body: tables of shells, matrices and what their rows are, or a NASTRAN file of matrices."""

from dataclasses import dataclass
from pathlib import Path

from fatigue.errors import DataError, Problem
from fatigue.files.naming import missing_file
from fatigue.flexbody.shell_mesh import ShellMesh
from fatigue.flexbody.structure import Structure
from fatigue.readers.foreign.nastran.matrices.deck import has_dmig
from fatigue.readers.model.matrices import DECK_ENDINGS, MATRIX_ENDINGS, read_structure, read_structure_of_deck
from fatigue.readers.model.shells import read_shell_mesh
from fatigue.readers.neutral.body.mesh import Mesh, read_mesh
from fatigue.readers.units.systems import UnitSystem, unit_system

TABLE_ENDINGS = (".parquet", ".csv")


@dataclass(frozen=True, slots=True, eq=False)
class BodyModel:
    """A finite element body in N, mm, t as it was given.

    Attributes
    ----------
    body : a shell mesh, which has element forces at welds, or matrices, which have none
    mesh : nodes and elements for pictures; None where the folder has none
    files : what was read
    named : the files of K and M, or of elements and properties, in messages
    warnings : met while reading
    """

    body: ShellMesh | Structure
    mesh: Mesh | None
    files: tuple[Path, ...]
    named: tuple[str, str]
    warnings: tuple[Problem, ...]


def read_model(path: Path, *, units: str = "mm-t-s", strict: bool = False) -> BodyModel:
    """Read ``nodes``, ``elements``, ``properties``, or ``K``, ``M`` with ``dof``, or a NASTRAN file of DMIG.

    ``path`` is a folder of these, or the NASTRAN file. Tables are .parquet or .csv, matrices .mtx, .npz or .op4.
    ``dof`` says of each row of the matrices its ``row``, from 1, ``node`` and ``component``, 1 to 6, and has ``x_mm,
    y_mm, z_mm`` unless ``nodes`` has them; without either, places are found from K. ``units`` are those of K and M, and
    of the grids of a NASTRAN file.

    Raises
    ------
    CaseError : unknown units
    DataError : files missing or of several kinds; a mistake in one of them
    """
    system = unit_system(units, "units")
    if path.is_file():
        return _of_deck(path, None, (), system, [])
    if not path.is_dir():
        raise DataError(missing_file(path))
    nodes, elements, properties, dof = (
        _found(path, name, TABLE_ENDINGS) for name in ("nodes", "elements", "properties", "dof")
    )
    K, M = (_found(path, name, MATRIX_ENDINGS) for name in ("K", "M"))
    of_matrices = {"K.mtx": K, "M.mtx": M, "dof.csv": dof}
    of_shells = {"nodes.csv": nodes, "elements.csv": elements, "properties.csv": properties}
    decks = sorted(file for file in path.iterdir() if file.suffix.lower() in DECK_ENDINGS and has_dmig(file))
    by_matrix = any(file is not None for file in of_matrices.values())
    kinds = [
        *([properties.name] if properties is not None else []),
        *([", ".join(file.name for file in of_matrices.values() if file is not None)] if by_matrix else []),
        *(file.name for file in decks if properties is None and not by_matrix),
    ]
    if len(kinds) > 1:
        what = f"{kinds[0]} is here, and {kinds[1]} too"
        remedy = "Keep the properties of shells, or K, M and dof, or one NASTRAN file"
        raise DataError(Problem("two_models", str(path), what, remedy))
    by_deck = bool(decks) and properties is None and not by_matrix
    needed = () if by_deck else _all_of(path, of_matrices if by_matrix else of_shells)
    mesh, warnings = read_mesh(nodes, elements, strict=strict) if nodes is not None else (None, [])
    beside = tuple(file for file in (nodes, elements) if file is not None)
    if by_deck:
        return _of_deck(decks[0], mesh, beside, system, warnings)
    if by_matrix or mesh is None:
        structure, more = read_structure(needed[0], needed[1], needed[2], mesh, system, strict=strict)
        return BodyModel(structure, mesh, (*needed, *beside), (needed[0].name, needed[1].name), (*warnings, *more))
    shells, more = read_shell_mesh(mesh, needed[1], needed[2], strict=strict)
    return BodyModel(shells, mesh, needed, (needed[1].name, needed[2].name), (*warnings, *more))


def _of_deck(
    path: Path, mesh: Mesh | None, beside: tuple[Path, ...], system: UnitSystem, warnings: list[Problem]
) -> BodyModel:
    structure, names, included = read_structure_of_deck(path, mesh, system)
    named = (f"{names[0]} of {path.name}", f"{names[1]} of {path.name}")
    return BodyModel(structure, mesh, (path, *included, *beside), named, tuple(warnings))


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
        remedy = "Give nodes, elements and properties of shells, or K, M and dof, or one NASTRAN file of DMIG"
        raise DataError(Problem("missing_file", str(folder), what, remedy))
    return tuple(path for path in files.values() if path is not None)
