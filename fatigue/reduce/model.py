"""A finite element model as it is given, checked and assembled: matrices, and what weld forces need of a mesh."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from fatigue.errors import DataError, Problem, refuse
from fatigue.flexbody.mass import rigid_mass, rigid_motions
from fatigue.flexbody.shell import structure
from fatigue.flexbody.shell_mesh import ShellMesh
from fatigue.flexbody.structure import Structure
from fatigue.readers.foreign.nastran.matrices.deck import has_dmig
from fatigue.readers.model.matrices import DECK_ENDINGS
from fatigue.readers.model.read import BodyModel, read_model
from fatigue.readers.model.shells import read_shell_mesh
from fatigue.readers.neutral.body.mesh import Mesh, read_mesh
from fatigue.readers.neutral.tables import open_table
from fatigue.reduce.plausible import mass_problems, material_problems, other_thickness, size_problems
from fatigue.reduce.welds import Welds, read_welds_of, table_in
from fatigue.stages import stage

DECKS = (".bdf", ".dat", ".nas", ".bulk", ".fem")
IN_MM = "Give lengths in mm, masses in t, forces in N, all of them in one system"


@dataclass(frozen=True, slots=True, eq=False)
class Model:
    """A model ready to be reduced.

    ``mesh`` and ``body`` are the shells as tables have them and as they were computed, None of matrices; ``welds`` are
    None where there are none. ``notes`` say what cannot be had of the model and how to get it.
    """

    structure: Structure
    files: tuple[Path, ...]
    mesh: Mesh | None
    body: ShellMesh | None
    welds: Welds | None
    notes: tuple[Problem, ...]
    warnings: tuple[Problem, ...]


def read_given(folder: Path, properties: Path | None, welds: Path | None, units: str, *, strict: bool) -> Model:
    """Read a model, refuse what cannot be meant, and assemble it.

    Parameters
    ----------
    folder : with ``nodes, elements, properties`` of shells, or ``K, M`` and ``dof``, or a NASTRAN file of DMIG
    properties : a table of properties in place of that of the folder; its thickness goes before that of elements
    welds : folder of ``welds, weld_nodes, weld_elements``, by default the same one
    units : of K and M

    Raises
    ------
    CaseError : unknown units
    DataError : everything that is wrong with a file, or between files
    """
    refuse(DataError, _no_folder(folder))
    stage("reading the model")
    if properties is not None:
        given = _with_properties(folder, properties, strict=strict)
    else:
        given = read_model(folder, units=units, strict=strict)
    if isinstance(given.body, Structure):
        return _of_matrices(folder, given, given.body, welds)
    assert given.mesh is not None
    nodes, elements, of_shells = given.files
    body, pid = given.body, given.mesh.pid
    refuse(DataError, material_problems(body, pid, of_shells.name))
    warnings = [*given.warnings]
    if properties is None:
        warnings += other_thickness(body, pid, _thickness(of_shells), elements, of_shells)
    mesh = replace(given.mesh, thickness=body.thickness)
    found, more = read_welds_of(welds or folder, mesh, body, strict=strict)
    stage("assembling %d elements with %d degrees of freedom", len(body.element), 6 * len(body.node))
    matrices = structure(body)
    refuse(DataError, size_problems(body.xyz, _mass(matrices), f"{nodes.name} and {of_shells.name}", IN_MM))
    files = (*given.files, *(found.files if found else ()))
    notes = () if found else (_no_welds(welds or folder),)
    return Model(matrices, files, mesh, body, found, notes, (*warnings, *more))


def _of_matrices(folder: Path, given: BodyModel, matrices: Structure, welds: Path | None) -> Model:
    """Model of K and M, which have no elements and so no weld forces."""
    K, M = given.named
    refuse(DataError, mass_problems(matrices, M))
    units = "Give K and M in N, mm, t, or name their units with --units; places are in mm"
    refuse(DataError, size_problems(matrices.xyz, _mass(matrices), f"{M} and the places of nodes", units))
    has_welds = any(table_in(welds or folder, name) is not None for name in ("welds", "weld_nodes", "weld_elements"))
    what = f"{K} and {M} have no elements, so no weld forces were written{', welds or not' if has_welds else ''}"
    remedy = "Give the shells (nodes, elements, properties), or take the element forces from the FE program"
    note = Problem("no_weld_forces", str(folder), what, remedy)
    return Model(matrices, given.files, None, None, None, (note,), given.warnings)


def _with_properties(folder: Path, properties: Path, *, strict: bool) -> BodyModel:
    """Shells of a folder with the properties of another table."""
    nodes, elements = table_in(folder, "nodes"), table_in(folder, "elements")
    if nodes is None or elements is None:
        what = "properties are given, and there are no nodes and elements"
        raise DataError(Problem("missing_file", str(folder), what, "Give the folder of the shells, or no --properties"))
    mesh, warnings = read_mesh(nodes, elements, strict=strict)
    has_thickness = "thickness_mm" in open_table(properties).position
    bare = replace(mesh, thickness=np.full(len(mesh.element), np.nan)) if has_thickness else mesh
    body, found = read_shell_mesh(bare, elements, properties, strict=strict)
    named = (elements.name, properties.name)
    return BodyModel(body, mesh, (nodes, elements, properties), named, (*warnings, *found))


def _thickness(properties: Path) -> dict[int, float]:
    """Thickness of every property that has one [mm]."""
    table = open_table(properties)
    pid, thickness = table.integers("pid"), table.numbers("thickness_mm", default=np.nan)
    return dict(zip(pid.tolist(), thickness.tolist(), strict=True))


def _mass(matrices: Structure) -> float:
    """Mass of a body along x [t]."""
    return float(rigid_mass(matrices.M, rigid_motions(matrices.xyz, matrices.direction))[0, 0])


def _no_folder(folder: Path) -> Iterator[Problem]:
    """Refusal of a file that holds no matrices, as a deck of shells, which have to become tables first."""
    if folder.is_file() and not (folder.suffix.lower() in DECK_ENDINGS and has_dmig(folder)):
        kind = "a NASTRAN deck" if folder.suffix.lower() in DECKS else "a file"
        what = f"this is {kind}, and a body is read from a folder"
        remedy = (
            "Give a folder with nodes, elements and properties of its shells, or K and M of the free body: a NASTRAN "
            "file of DMIG, or K.mtx and M.mtx (.npz, .op4) with dof.csv"
        )
        yield Problem("no_folder", str(folder), what, remedy)


def _no_welds(folder: Path) -> Problem:
    what = "there are no tables of welds, so no weld forces were written"
    remedy = "Add welds, weld_nodes and weld_elements, or name their folder with --welds"
    return Problem("no_weld_forces", str(folder), what, remedy)
