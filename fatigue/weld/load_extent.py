"""How large the nodal forces of weld lines are, in few numbers: what is zero there, or next to nothing, stands out."""

from dataclasses import dataclass, fields
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.weld.line import Lines
from fatigue.weld.line_geometry import lengths, unit

AXIS = 1e-6  # of a normal: what rounding leaves across an axis that it points along
ACROSS = 1e-6  # of the largest force: what single precision leaves of it across a plate that is loaded in its plane


@dataclass(frozen=True, slots=True, eq=False)
class LoadExtent:
    """How large the nodal forces of k line parts are.

    Attributes
    ----------
    weld : (k,) name of the weld of each part
    line_force : (k, m) sizes of all components, moments over the plate thickness, added up along the line, over its
        length [N/mm per unit coordinate]
    largest : (k, 6) largest component at any node in any mode [N, N mm per unit coordinate]
    across_plate : (k,) whether any force points out of the plane of its plate
    normal : (k, 3) largest component of the unit normals of the plate along each axis
    bare : (k,) number of nodes without any force in any mode
    first_bare : (k,) id of one of them, 0 where there is none
    """

    weld: tuple[str, ...]
    line_force: NDArray[np.float64]
    largest: NDArray[np.float64]
    across_plate: NDArray[np.bool_]
    normal: NDArray[np.float64]
    bare: NDArray[np.int64]
    first_bare: NDArray[np.int64]

    @property
    def flat_axis(self) -> int | None:
        """Global axis that all plates have their normal along, as in a plane model; None where they have not."""
        along = self.normal.max(axis=0) > AXIS
        return int(along.argmax()) if np.count_nonzero(along) == 1 else None


def load_extent(lines: Lines, forces: NDArray[np.floating]) -> LoadExtent:
    """How large the nodal forces (n, m, 6) of a stack of line parts are."""
    names = lines.weld if isinstance(lines.weld, tuple) else (lines.weld,)
    first = lines.begin[:-1]
    size, normal = np.abs(forces), unit(lines.normal)
    of_node = size.max(axis=1)
    weights = np.ones((lines.node.size, 6), forces.dtype)
    weights[:, 3:] /= lines.thickness[:, np.newaxis]
    with np.errstate(over="ignore"):  # what is so large is told where it is counted
        total = np.add.reduceat(np.einsum("nmc,nc->nm", size, weights), first, dtype=np.float64)
        across = np.abs(np.einsum("nmc,nc->nm", forces[..., :3], normal.astype(forces.dtype))).max(axis=1)
    is_bare = ~of_node.any(axis=1)
    bare = np.add.reduceat(is_bare.astype(np.int64), first)
    at = [
        int(lines.node[a + is_bare[a:b].argmax()]) if bare[i] else 0 for i, (a, b) in enumerate(pairwise(lines.begin))
    ]
    largest = np.maximum.reduceat(of_node, first)
    return LoadExtent(
        weld=names,
        line_force=total / lengths(lines)[:, np.newaxis],
        largest=largest.astype(np.float64),
        across_plate=np.maximum.reduceat(across, first) > ACROSS * largest[:, :3].max(axis=1),
        normal=np.maximum.reduceat(np.abs(normal), first),
        bare=bare,
        first_bare=np.array(at),
    )


def of_welds(extents: list[LoadExtent]) -> LoadExtent:
    """How large the forces of whole welds are, their parts taken together, in the order in which they come."""
    names = [name for extent in extents for name in extent.weld]
    weld = tuple(dict.fromkeys(names))
    place = {name: i for i, name in enumerate(weld)}
    of_part = np.array([place[name] for name in names])

    def together(name: str) -> NDArray[Any]:
        parts = np.concatenate([getattr(extent, name) for extent in extents])
        whole = np.zeros((len(weld), *parts.shape[1:]), parts.dtype)
        (np.add if name == "bare" else np.maximum).at(whole, of_part, parts)
        return whole

    columns = {field.name: together(field.name) for field in fields(LoadExtent) if field.name != "weld"}
    return LoadExtent(weld=weld, **columns)
