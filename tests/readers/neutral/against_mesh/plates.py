"""A plate with a plate on it, their mesh, and the weld line between them as its tables have it."""

from dataclasses import replace

import numpy as np

from fatigue.readers.neutral.against_mesh import TableNames, mesh_warnings
from fatigue.readers.neutral.body.mesh import Mesh
from fatigue.weld.line import stacked
from tests.shell_fe import grid, joined
from tests.weld_lines import weld_line

NAMES = TableNames("weld_nodes.csv", "nodes.csv", "elements.csv")
BASE, ATTACHED = 8.0, 6.0  # thickness [mm]
EDGE = 10.0  # [mm]


def tee(parabolic=False):
    """A plate of 100 x 40 x 8 mm with one of 100 x 20 x 6 mm upright on its middle; node ids are positions + 1."""
    base, quads = grid(np.linspace(0, 100, 11), np.linspace(-20, 20, 5))
    base = np.column_stack([base[:, :2], np.zeros(len(base))])
    wall, of_wall = grid(np.linspace(0, 100, 11), np.linspace(0, 20, 3))
    wall = np.column_stack([wall[:, 0], np.zeros(len(wall)), wall[:, 1]])
    xyz, corners = joined((base, quads), (wall, of_wall))
    thickness = np.where(np.arange(len(corners)) < len(quads), BASE, ATTACHED)
    return with_mids(xyz, corners, thickness) if parabolic else mesh(xyz, corners + 1, thickness)


def mesh(xyz, nodes, thickness):
    """Mesh of elements given by their node ids, (e, 3) to (e, 8)."""
    filled = np.zeros((len(nodes), 8), dtype=np.int64)
    filled[:, : nodes.shape[1]] = nodes
    number = np.arange(1, len(nodes) + 1)
    return Mesh(np.arange(1, len(xyz) + 1), xyz, number, filled, np.ones_like(number), np.asarray(thickness, float))


def with_mids(xyz, corners, thickness):
    """The same mesh with a mid-side node amid every side."""
    sides = np.stack([corners, np.roll(corners, -1, axis=1)], axis=2).reshape(-1, 2)
    ends, which = np.unique(np.sort(sides, axis=1), axis=0, return_inverse=True)
    mids = len(xyz) + which.reshape(corners.shape)
    return mesh(np.vstack([xyz, xyz[ends].mean(axis=1)]), np.hstack([corners, mids]) + 1, thickness)


def weld_of(plates, mids=False, **given):
    """The line along the wall, seen from the base plate at negative y; its nodes have their ids from the mesh."""
    on_line = (np.abs(plates.xyz[:, 1]) < 1e-9) & (np.abs(plates.xyz[:, 2]) < 1e-9)
    at = np.flatnonzero(on_line)
    at = at[np.argsort(plates.xyz[at, 0])]
    if not mids:
        at = at[np.abs(plates.xyz[at, 0] % EDGE) < 1e-9]
    marks = np.abs(plates.xyz[at, 0] % EDGE) > 1e-9
    return weld_line(plates.xyz[at], **({"thickness": BASE, "node": plates.node[at], "edge_mid": marks} | given))


def told(plates, *lines, confirmed=None, knows_sides=False):
    """Warnings about lines, as codes and as text."""
    named = [replace(line, weld=f"W{i}") for i, line in enumerate(lines, start=1)]
    found = mesh_warnings(stacked(named), plates, NAMES, confirmed or {}, knows_sides=knows_sides)
    return [problem.code for problem in found], [str(problem) for problem in found]
