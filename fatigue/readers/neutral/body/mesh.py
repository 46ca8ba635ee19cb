"""The mesh of a body in the neutral format: nodes and shell elements around the welds."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import Problem
from fatigue.readers.neutral.tables import open_table


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
    unconfirmed : why the thickness of an element is not that of a plate, by its id; of those that the file names
    """

    node: NDArray[np.int64]
    xyz: NDArray[np.float64]
    element: NDArray[np.int64]
    corners: NDArray[np.int64]
    pid: NDArray[np.int64]
    thickness: NDArray[np.float64]
    unconfirmed: Mapping[int, str] = field(default_factory=dict)


def read_mesh(nodes: Path, elements: Path | None, *, strict: bool) -> tuple[Mesh, list[Problem]]:
    """Read the mesh: nodes ``node, x_mm, y_mm, z_mm``; elements ``element, n1 ... n3``, optional ``n4 ... n8``.

    Corner nodes run around the element, n5 ... n8 are its mid-side nodes, empty where the element has fewer. Optional
    are ``pid``, ``thickness_mm``, and ``unconfirmed``: why this thickness is not that of a plate.
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
    table = open_table(elements, texts=("unconfirmed",))
    corners_required, corners_optional = ("n1", "n2", "n3"), ("n4", "n5", "n6", "n7", "n8")
    others = (*corners_optional, "pid", "thickness_mm", "unconfirmed")
    table.expect(("element", *corners_required), others, strict=strict)
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
    reasons = table.texts("unconfirmed", default="") if "unconfirmed" in table.position else []
    doubts = {one: reason for one, reason in zip(element.tolist(), reasons, strict=False) if reason}
    table.refuse()
    mesh = Mesh(node, xyz, element[by_id], corners[by_id], pid[by_id], thickness[by_id], doubts)
    return mesh, warnings + table.warnings
