"""Geometry of an FE model as weld lines need it, the same for every solver and file format."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem, refuse
from fatigue.weld.mesh import NONE, ShellMesh
from fatigue.weld.solid.mesh import SolidMesh


@dataclass(frozen=True, slots=True, eq=False)
class FeModel:
    """Shells, displacement frames and the markers a user may have set at the welds; in the file's own unit of length.

    Attributes
    ----------
    source : file
    mesh : shells and all grids; without shells in a model of solids
    solids : solid elements, whose grids are those of ``mesh``; None without any
    frame_node : (k,) grids whose displacement frame (CD) is not the basic one, ascending
    frame : (k, 3, 3) axes of their displacement frames, one in each row, in basic components
    unconfirmed_sections : why the thickness of a property has to be confirmed by hand, by property id
    unconfirmed_elements : the same, by element id
    node_sets : node sets by their id
    marker_edges : pairs of grids joined by plot elements or bars, (p, 2), by card name ("PLOTEL", "CBAR", "CBEAM")
    other_cards : how many cards of elements other than shells there are, by name
    warnings : met while reading
    included : files it was read from besides ``source``
    """

    source: str
    mesh: ShellMesh
    frame_node: NDArray[np.int64]
    frame: NDArray[np.float64]
    unconfirmed_sections: Mapping[int, str] = field(default_factory=dict)
    unconfirmed_elements: Mapping[int, str] = field(default_factory=dict)
    node_sets: Mapping[int, NDArray[np.int64]] = field(default_factory=dict)
    marker_edges: Mapping[str, NDArray[np.int64]] = field(default_factory=dict)
    other_cards: Mapping[str, int] = field(default_factory=dict)
    warnings: tuple[Problem, ...] = ()
    included: tuple[Path, ...] = ()
    solids: SolidMesh | None = None


@dataclass(frozen=True, slots=True)
class Section:
    """A shell property: thickness, offset of the reference plane, and why the thickness has to be confirmed by hand."""

    thickness: float
    offset: float = 0.0
    unconfirmed: str = ""


@dataclass(frozen=True, slots=True)
class Shell:
    """A shell element as a file gives it: grid ids, 0 for a mid-side node left out."""

    element: int
    pid: int
    corners: tuple[int, ...]
    mids: tuple[int, ...] = ()
    thickness: float | None = None  # its own instead of the property's
    offset: float = 0.0
    unconfirmed: str = ""


@dataclass(frozen=True, slots=True)
class Solid:
    """A solid element as a file gives it: grid ids in the order of ``SolidMesh``, 0 for a mid-side node left out."""

    element: int
    pid: int
    corners: tuple[int, ...]
    mids: tuple[int, ...] = ()


def shell_mesh(
    source: str, grids: Mapping[int, NDArray[np.float64]], shells: list[Shell], sections: Mapping[int, Section]
) -> ShellMesh:
    """Mesh of grids, shells and sections.

    Raises
    ------
    DataError : an element id used twice, a grid that does not exist or is used twice in one element
    """
    shells = sorted(shells, key=lambda shell: shell.element)
    node = np.array(sorted(grids), np.int64)
    index = {int(n): i for i, n in enumerate(node)}
    refuse(DataError, _element_problems(source, shells, index))
    corner = np.full((len(shells), 4), NONE, np.int64)
    mid = np.full((len(shells), 4), NONE, np.int64)
    for row, shell in enumerate(shells):
        corner[row, : len(shell.corners)] = [index[n] for n in shell.corners]
        mid[row, : len(shell.mids)] = [index[n] if n else NONE for n in shell.mids]
    section = [sections.get(shell.pid, Section(np.nan)) for shell in shells]
    return ShellMesh(
        node=node,
        xyz=np.array([grids[int(n)] for n in node], np.float64).reshape(-1, 3),
        element=np.array([shell.element for shell in shells], np.int64),
        corner=corner,
        mid=mid,
        pid=np.array([shell.pid for shell in shells], np.int64),
        thickness=np.array(
            [
                s.thickness if shell.thickness is None else shell.thickness
                for shell, s in zip(shells, section, strict=True)
            ]
        ),
        offset=np.array([shell.offset + s.offset for shell, s in zip(shells, section, strict=True)]),
    )


def solid_mesh(
    source: str, grids: Mapping[int, NDArray[np.float64]], solids: Sequence[Solid], shells: Sequence[Shell]
) -> SolidMesh | None:
    """Mesh of grids and solids, whose ids ``shells`` do not have; None without solids.

    Raises
    ------
    DataError : neither shells nor solids, an element id used twice, a grid that does not exist or is used twice in one
        element
    """
    if not solids:
        if shells:
            return None
        what = "the model has neither shell nor solid elements"
        raise DataError(Problem("no_shells", source, what, "Give the bulk data that holds the plates"))
    solids = sorted(solids, key=lambda solid: solid.element)
    node = np.array(sorted(grids), np.int64)
    index = {int(n): i for i, n in enumerate(node)}
    refuse(DataError, _element_problems(source, solids, index))
    both = sorted({solid.element for solid in solids} & {shell.element for shell in shells})
    if both:
        where = f"{source}, element {both[0]}"
        raise DataError(
            Problem("element_twice", where, "a shell and a solid have one element id", "Give it another id")
        )
    corner = np.full((len(solids), 8), NONE, np.int64)
    mid = np.full((len(solids), 12), NONE, np.int64)
    for row, solid in enumerate(solids):
        corner[row, : len(solid.corners)] = [index[n] for n in solid.corners]
        mid[row, : len(solid.mids)] = [index[n] if n else NONE for n in solid.mids]
    return SolidMesh(
        node=node,
        xyz=np.array([grids[int(n)] for n in node], np.float64).reshape(-1, 3),
        element=np.array([solid.element for solid in solids], np.int64),
        corner=corner,
        mid=mid,
        pid=np.array([solid.pid for solid in solids], np.int64),
    )


def _element_problems(source: str, shells: Sequence[Shell | Solid], index: Mapping[int, int]) -> list[Problem]:
    """Duplicate elements, missing grids and collapsed elements, at most ten of them."""
    problems = []
    for before, shell in zip([None, *shells], shells, strict=False):
        where = f"{source}, element {shell.element}"
        used = [*shell.corners, *(n for n in shell.mids if n)]
        if before is not None and before.element == shell.element:
            problems.append(Problem("element_twice", where, "the element id is used twice", "Give it another id"))
        if missing := [n for n in used if n not in index]:
            problems.append(
                Problem("no_grid", where, f"its grid {missing[0]} does not exist", "Include the grid's file")
            )
        elif len(set(used)) < len(used):
            problems.append(Problem("collapsed", where, f"a grid is used twice: {used}", "Use a triangle"))
        if len(problems) >= 10:
            break
    return problems


def others_left_out(source: str, others: Mapping[str, int]) -> tuple[Problem, ...]:
    """Warning about elements that are neither shells nor solids, by their types."""
    if not others:
        return ()
    listed = ", ".join(f"{count} {name}" for name, count in sorted(others.items()))
    what = f"elements that are neither shells nor solids are left out: {listed}"
    return (
        Problem("elements_left_out", source, what, "Nothing to do, unless a type is misspelt", sum(others.values())),
    )


def in_mm(model: FeModel, unit_length: float) -> FeModel:
    """Model in mm, from one whose unit of length is ``unit_length`` mm."""
    mesh = model.mesh
    scaled = {name: getattr(mesh, name) * unit_length for name in ("xyz", "thickness", "offset")}
    solids = model.solids and replace(model.solids, xyz=model.solids.xyz * unit_length)
    return replace(model, mesh=replace(mesh, **scaled), solids=solids)


def to_basic(values: NDArray[np.floating], node: NDArray[np.int64], model: FeModel) -> NDArray[np.floating]:
    """Forces or shapes (m, r, 6) at ``node`` (r,) in the basic frame, from the displacement frames."""
    at = np.minimum(np.searchsorted(model.frame_node, node), max(model.frame_node.size - 1, 0))
    turned = np.flatnonzero(model.frame_node[at] == node) if model.frame_node.size else np.empty(0, np.int64)
    if not turned.size:
        return values
    axes = model.frame[at[turned]].astype(values.dtype)
    rotated = values.copy()
    for part in (slice(0, 3), slice(3, 6)):
        rotated[:, turned, part] = np.einsum("rij,mri->mrj", axes, values[:, turned, part])
    return rotated
