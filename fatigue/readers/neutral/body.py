"""The flexible body in the neutral format: modes, welds, the lines of the welds, and the mesh for pictures."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, TypeAlias, cast

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem, refuse
from fatigue.readers.neutral.tables import Table, open_table
from fatigue.weld.line import LineStack, WeldLine
from fatigue.weld.line_check import check_line, line_warnings, unfit_lines, warned_lines

Surface: TypeAlias = Literal["top", "bottom", "both"]
KINDS = ("normal", "interface", "rigid")
SURFACES = ("top", "bottom", "both")
CHECKED_TOGETHER = 256  # weld lines
LOWEST_HZ = 1e-3  # below it a frequency is the round-off of a rigid mode


@dataclass(frozen=True, slots=True, eq=False)
class Modes:
    """Modes of the body that are used, sorted by id.

    Attributes
    ----------
    mode : (m,) mode id
    frequency : (m,) natural frequency [Hz]
    damping_ratio : (m,) damping ratio, NaN where the file gives none [-]
    modal_mass : (m,) modal mass, 1 where the file gives none
    kind : (m,) normal, interface or rigid
    scale : (m,) factor on the forces of the mode where FE run and simulation normalise it differently [-]
    """

    mode: NDArray[np.int64]
    frequency: NDArray[np.float64]
    damping_ratio: NDArray[np.float64]
    modal_mass: NDArray[np.float64]
    kind: tuple[str, ...]
    scale: NDArray[np.float64]

    @property
    def vibration_hz(self) -> NDArray[np.float64]:
        """Frequencies of the normal modes [Hz]; rigid-body modes that the table takes for normal ones left out."""
        return np.asarray(self.frequency[(np.array(self.kind) == "normal") & (self.frequency > LOWEST_HZ)])


@dataclass(frozen=True, slots=True)
class Weld:
    """One weld: which faces carry a toe, its own curve and end length where it has them.

    ``surface`` is top, bottom or both; ``end_length`` in mm, None: the plate thickness, 0: no end treatment.
    """

    name: str
    closed: bool
    surface: Surface
    curve: str | None
    end_length: float | None
    description: str


@dataclass(frozen=True, slots=True, eq=False)
class Mesh:
    """Nodes and shell elements around the welds, for the balance check and for pictures.

    Attributes
    ----------
    node : (k,) node id, ascending
    xyz : (k, 3) coordinates [mm]
    element : (e,) element id, ascending; empty where the case names no elements
    corners : (e, 8) node ids n1 ... n8 of each element, 0 where it has fewer
    pid : (e,) property id, 0 where the file gives none
    thickness : (e,) thickness [mm], NaN where the file gives none
    """

    node: NDArray[np.int64]
    xyz: NDArray[np.float64]
    element: NDArray[np.int64]
    corners: NDArray[np.int64]
    pid: NDArray[np.int64]
    thickness: NDArray[np.float64]


def read_modes(path: Path, ignore_modes: Collection[int], *, strict: bool) -> tuple[Modes, list[Problem]]:
    """Read ``mode``, ``frequency_hz`` and, where present, ``damping_ratio, modal_mass, kind, scale``."""
    table = open_table(path, texts=("kind",))
    table.expect(("mode", "frequency_hz"), ("damping_ratio", "modal_mass", "kind", "scale"), strict=strict)
    mode = table.integers("mode")
    frequency = table.numbers("frequency_hz", least=0.0).astype(np.float64)
    damping_ratio = table.numbers("damping_ratio", default=np.nan, least=0.0).astype(np.float64)
    modal_mass = table.numbers("modal_mass", default=1.0, above=0.0).astype(np.float64)
    kind = table.texts("kind", default="normal")
    table.choices("kind", kind, KINDS)
    scale = table.numbers("scale", default=1.0).astype(np.float64)
    table.report(scale == 0, "bad_value", "scale", "0 takes the mode out", "List the mode under ignore_modes instead")
    table.unique({"mode": mode})
    table.refuse()
    used = [i for i in np.argsort(mode) if mode[i] not in ignore_modes]
    if not used:
        raise DataError(Problem("no_modes", path.name, "ignore_modes leaves no mode", "Take modes out of ignore_modes"))
    modes = Modes(
        mode[used], frequency[used], damping_ratio[used], modal_mass[used], tuple(kind[i] for i in used), scale[used]
    )
    if "interface" not in modes.kind:
        table.warnings.append(
            Problem(
                "no_interface_mode",
                table.where("kind"),
                f"none of the {len(modes.kind)} modes is an interface mode, so welds near local loads lose most of "
                "their force",
                "Add residual or constraint modes to the FE run and to the simulation, or mark those present",
            )
        )
    return modes, table.warnings


def read_welds(path: Path, curves: Collection[str] | None, *, strict: bool) -> tuple[tuple[Weld, ...], list[Problem]]:
    """Read ``weld`` and, where present, ``closed, surface, curve, end_length_mm, description``, in the file's order.

    ``curves`` are the names a weld's curve may have; None: any, for they are looked at later.
    """
    table = open_table(path, texts=("weld", "surface", "curve", "description"))
    table.expect(("weld",), ("closed", "surface", "curve", "end_length_mm", "description"), strict=strict)
    names, code = table.groups("weld")
    table.unique({"weld": code}, {"weld": names})
    closed = table.flags("closed", default=False)
    surface = table.texts("surface", default="both")
    table.choices("surface", surface, SURFACES)
    curve, curve_code = table.groups("curve", default="")
    if curves is not None:
        table.known("curve", curve, curve_code, {"", *curves}, "the curves")
    end_length = table.numbers("end_length_mm", default=np.nan, least=0.0)
    description = table.texts("description", default="")
    table.refuse()
    welds = tuple(
        Weld(
            name=names[code[i]],
            closed=bool(closed[i]),
            surface=cast(Surface, surface[i]),
            curve=curve[curve_code[i]] or None,
            end_length=None if np.isnan(end_length[i]) else float(end_length[i]),
            description=description[i],
        )
        for i in range(table.rows)
    )
    return welds, table.warnings


def read_lines(
    path: Path, welds: Sequence[Weld], needed: Collection[str], *, strict: bool
) -> tuple[LineStack, list[Problem]]:
    """Read the line of every weld, in the order of ``welds`` and sorted by ``order``; those ``needed`` must be there.

    Columns: ``weld, order, node, x_mm, y_mm, z_mm, thickness_mm, normal_x|y|z, outward_x|y|z`` and, where present,
    ``edge_mid``.

    Raises
    ------
    DataError
        a needed weld without nodes, nodes of an unknown weld, a repeated order or node
    """
    table = open_table(path, texts=("weld",))
    vectors = {name: [f"{name}_{axis}" for axis in "xyz"] for name in ("normal", "outward")}
    coordinates = ["x_mm", "y_mm", "z_mm"]
    table.expect(
        ("weld", "order", "node", *coordinates, "thickness_mm", *vectors["normal"], *vectors["outward"]),
        ("edge_mid",),
        strict=strict,
    )
    names, code = table.groups("weld")
    order = table.integers("order")
    node = table.integers("node")
    xyz = _vectors(table, coordinates)
    thickness = table.numbers("thickness_mm", above=0.0).astype(np.float64)
    normal, outward = _vectors(table, vectors["normal"]), _vectors(table, vectors["outward"])
    edge_mid = table.flags("edge_mid", default=False)
    table.unique({"weld": code, "order": order}, {"weld": names})
    table.unique({"weld": code, "node": node}, {"weld": names})
    table.known("weld", names, code, {weld.name for weld in welds}, "the welds")
    table.complete("weld", names, [weld.name for weld in welds if weld.name in needed], "nodes")
    table.refuse()
    place = {weld.name: i for i, weld in enumerate(welds)}
    of_weld = np.array([place[name] for name in names])[code]
    along = np.lexsort((order, of_weld))
    at = slice(None) if np.array_equal(along, np.arange(along.size)) else along  # no copies of a sorted file
    bare = np.zeros(len(welds), dtype=np.bool_)
    lines = LineStack(
        weld=tuple(weld.name for weld in welds),
        part=np.ones(len(welds), dtype=np.int64),
        closed=np.array([weld.closed for weld in welds]),
        end_length=np.array([np.nan if weld.end_length is None else weld.end_length for weld in welds]),
        corner_start=bare,
        corner_end=bare,
        begin=np.append(0, np.cumsum(np.bincount(of_weld, minlength=len(welds)))),
        order=order[at],
        node=node[at],
        xyz=xyz[at],
        thickness=thickness[at],
        normal=normal[at],
        outward=outward[at],
        edge_mid=edge_mid[at],
    )
    return lines, table.warnings


def _vectors(table: Table, names: Sequence[str]) -> NDArray[np.float64]:
    """Read three columns of numbers as vectors, (r, 3)."""
    vectors = np.empty((table.rows, 3))
    for axis, name in enumerate(names):
        vectors[:, axis] = table.numbers(name)
    return vectors


def checked_lines(lines: LineStack, file: str) -> list[Problem]:
    """Refuse the unfit lines of all welds together; return the warnings about the others."""
    problems: list[Problem] = []
    warnings: list[Problem] = []
    for first in range(0, len(lines), CHECKED_TOGETHER):
        some = lines.lines(slice(first, first + CHECKED_TOGETHER))
        for i in unfit_lines(some):
            try:
                check_line(some[i], _place(file, some[i]))
            except DataError as error:
                problems += error.problems
        if not problems:
            for i in warned_lines(some):
                warnings += line_warnings(some[i], _place(file, some[i]))
    refuse(DataError, problems)
    return warnings


def _place(file: str, line: WeldLine) -> str:
    return f"{file}: weld {line.weld}"


def read_mesh(nodes: Path, elements: Path | None, *, strict: bool) -> tuple[Mesh, list[Problem]]:
    """Read the mesh: nodes ``node, x_mm, y_mm, z_mm``; elements ``element, n1 ... n3``, optional ``n4 ... n8``.

    Corner nodes run around the element, n5 ... n8 are its mid-side nodes, empty where the element has fewer; ``pid``
    and ``thickness_mm`` of an element are optional.
    """
    table = open_table(nodes)
    table.expect(("node", "x_mm", "y_mm", "z_mm"), (), strict=strict)
    node = table.integers("node")
    xyz = np.column_stack([table.numbers(name) for name in ("x_mm", "y_mm", "z_mm")]).astype(np.float64)
    table.unique({"node": node})
    table.refuse()
    by_id = np.argsort(node)
    node, xyz = node[by_id], xyz[by_id]
    if elements is None:
        none = np.zeros(0, dtype=np.int64)
        return Mesh(node, xyz, none, np.zeros((0, 8), dtype=np.int64), none, np.zeros(0)), table.warnings
    warnings = table.warnings
    table = open_table(elements)
    corners_required, corners_optional = ("n1", "n2", "n3"), ("n4", "n5", "n6", "n7", "n8")
    table.expect(("element", *corners_required), (*corners_optional, "pid", "thickness_mm"), strict=strict)
    element = table.integers("element")
    corners = np.column_stack(
        [
            *(table.integers(name) for name in corners_required),
            *(table.integers(name, default=0) for name in corners_optional),
        ]
    )
    pid = table.integers("pid", default=0)
    thickness = table.numbers("thickness_mm", default=np.nan, above=0.0).astype(np.float64)
    table.unique({"element": element})
    for name, ids in zip((*corners_required, *corners_optional), corners.T, strict=True):
        unknown = ~np.isin(ids, node) & ((ids != 0) | (name in corners_required))
        table.report(
            unknown, "unknown_id", name, f"node {ids[unknown.argmax()]} is not in {nodes.name}", "Add the node there"
        )
    table.refuse()
    by_id = np.argsort(element)
    mesh = Mesh(node, xyz, element[by_id], corners[by_id], pid[by_id], thickness[by_id])
    return mesh, warnings + table.warnings
