"""Neutral tables of a reduced body: modes, shapes and flexibility of its points, weld forces, the mesh for pictures."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from fatigue.flexbody.shell_mesh import ShellMesh
from fatigue.flexbody.structure import Basis, Structure
from fatigue.readers.neutral.body.interface_shapes import DIRECTIONS
from fatigue.readers.neutral.body.mesh import Mesh
from fatigue.readers.neutral.forces.convention import COMPONENTS
from fatigue.reduce.interface import InterfacePoint, motion_of, place_of
from fatigue.reduce.welds import Welds, weld_forces

Floats = NDArray[np.float64]

MODES, POINTS = "modes.csv", "points.csv"
SHAPES, OBSERVED_SHAPES, FLEXIBILITY = "interface_shapes.csv", "observed_shapes.csv", "flexibility.csv"
FORCES, NODES, ELEMENTS = "nodal_forces.parquet", "nodes.parquet", "elements.parquet"


@dataclass(frozen=True, slots=True, eq=False)
class Modes:
    """Modes of a reduced body as the table has them: numbers from 1, damping ratio (m,) or None without a column."""

    basis: Basis
    damping_ratio: Floats | None

    @property
    def number(self) -> NDArray[np.int64]:
        """Number (m,) of each mode, ascending with the frequency."""
        return np.arange(1, len(self.basis.frequency) + 1)


def modes_table(modes: Modes) -> pa.Table:
    """Table of the modes, with unit modal mass [t] and their kind."""
    damping = {} if modes.damping_ratio is None else {"damping_ratio": modes.damping_ratio}
    return pa.table(
        {
            "mode": modes.number,
            "frequency_hz": modes.basis.frequency,
            **damping,
            "modal_mass": np.ones(len(modes.number)),
            "kind": np.where(modes.basis.normal, "normal", "interface").tolist(),
        }
    )


def points_table(points: Sequence[InterfacePoint], structure: Structure) -> pa.Table:
    """Table of all points; one of a pattern lies in the middle of its nodes."""
    place = np.array([place_of(point, structure) for point in points])
    return pa.table(
        {
            "point": [point.name for point in points],
            "node": [point.node for point in points],
            **{f"{a}_mm": place[:, k] for k, a in enumerate("xyz")},
            "side": [point.side for point in points],
            "components": [point.components for point in points],
            "nodes": [len(point.nodes) for point in points],
        }
    )


def shapes_table(points: Sequence[InterfacePoint], structure: Structure, modes: Modes) -> pa.Table:
    """Table of the shapes of points, mm or rad per unit modal coordinate."""
    value = motion_of(points, structure) @ modes.basis.shapes
    keys = [(point.name, DIRECTIONS[direction]) for point in points for direction in point.directions]
    number = len(modes.number)
    return pa.table(
        {
            "point": np.repeat([name for name, _ in keys], number).tolist(),
            "direction": np.repeat([direction for _, direction in keys], number).tolist(),
            "mode": np.tile(modes.number, len(keys)),
            "value": value.ravel(),
        }
    )


def flexibility_table(points: Sequence[InterfacePoint], static: Floats) -> pa.Table:
    """Table of the static solution with inertia relief, mm/N or 1/(N mm), of the loaded directions (d,)."""
    keys = [(point.name, DIRECTIONS[direction]) for point in points for direction in point.directions]
    return pa.table(
        {
            "point": [name for name, _ in keys],
            "direction": [direction for _, direction in keys],
            "value_mm_per_N": static,
        }
    )


def forces_table(welds: Welds, body: ShellMesh, modes: Modes) -> pa.Table:
    """Table of the weld forces, one row for each weld, node and mode, in single precision."""
    name, node, force = [], [], []
    number = len(modes.number)
    for line, (weld, of_weld) in enumerate(
        zip(welds.lines.weld, weld_forces(welds, body, modes.basis.shapes), strict=True)
    ):
        nodes = welds.nodes(line)
        name += [weld] * (len(nodes) * number)
        node.append(np.repeat(nodes, number))
        force.append(of_weld.swapaxes(1, 2).reshape(-1, 6).astype(np.float32))
    flat, nodes = np.concatenate(force), np.concatenate(node)
    columns = {component: np.ascontiguousarray(flat[:, k]) for k, component in enumerate(COMPONENTS)}
    mode = np.tile(modes.number, len(nodes) // number)
    return pa.table({"weld": name, "node": nodes, "mode": mode, **columns})


def nodes_table(mesh: Mesh) -> pa.Table:
    """Table of the nodes of a mesh."""
    return pa.table({"node": mesh.node, **{f"{a}_mm": mesh.xyz[:, k] for k, a in enumerate("xyz")}})


def elements_table(mesh: Mesh) -> pa.Table:
    """Table of the shells of a mesh, with the thickness they were computed with."""
    corners = {f"n{k + 1}": mesh.corners[:, k] for k in range(4)}
    return pa.table({"element": mesh.element, "pid": mesh.pid, **corners, "thickness_mm": mesh.thickness})
