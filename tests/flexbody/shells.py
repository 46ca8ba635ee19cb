"""Small shell meshes for the tests of finite elements."""

import dataclasses

import numpy as np

from fatigue.flexbody.elements.section import Section
from fatigue.flexbody.shell_mesh import NONE, ShellMesh
from tests.shell_fe import grid

STEEL = {"E": 210000.0, "nu": 0.3, "rho": 7.85e-9, "nsm": 0.0}
ARRAYS = ("thickness", "bending_thickness", "E", "nu", "rho", "nsm")


def shell_mesh(xyz, corners, thickness=4.0, **others):
    """A mesh of one section with ids from 1; ``corners`` of three or four columns."""
    corners = np.asarray(corners)
    if corners.shape[1] == 3:
        corners = np.column_stack([corners, np.full(len(corners), NONE)])
    values = {"thickness": thickness, "bending_thickness": thickness} | STEEL | others
    arrays = {name: np.full(len(corners), float(values[name])) for name in ARRAYS}
    return ShellMesh(
        np.arange(1, len(xyz) + 1), np.asarray(xyz, float), np.arange(1, len(corners) + 1), corners, **arrays
    )


def plate(nx, ny, a=400.0, b=300.0, thickness=4.0, triangles=False, **others):
    """A rectangular plate of nx by ny quads, or of twice as many triangles."""
    xyz, quads = grid(np.linspace(0, a, nx + 1), np.linspace(0, b, ny + 1))
    return shell_mesh(xyz, halved(quads) if triangles else quads, thickness, **others)


def halved(quads):
    """Two triangles of each quad, the diagonals by turns."""
    even = np.arange(len(quads)) % 2 == 0
    first = np.where(even[:, None], quads[:, [0, 1, 2]], quads[:, [0, 1, 3]])
    second = np.where(even[:, None], quads[:, [0, 2, 3]], quads[:, [1, 2, 3]])
    return np.stack([first, second], axis=1).reshape(-1, 3)


def tube(around, along, radius=100.0, length=400.0, twist=0.0, thickness=2.0, **others):
    """An open half tube whose elements are warped where it is twisted [rad]."""
    phi, x = np.linspace(0.0, np.pi, around + 1), np.linspace(0.0, length, along + 1)
    xyz, quads = grid(x, phi)
    angle = xyz[:, 1] + twist * xyz[:, 0] / length
    bulge = radius * (1.0 + 0.2 * np.sin(3.0 * np.pi * xyz[:, 0] / length) * np.cos(angle))
    places = np.column_stack([xyz[:, 0], bulge * np.cos(angle), bulge * np.sin(angle)])
    return shell_mesh(places, quads, thickness, **others)


def together(a, b, shift):
    """Two meshes as one, the second moved, its ids from 1001."""
    joined = {name: np.concatenate([getattr(a, name), getattr(b, name)]) for name in ARRAYS}
    other = np.where(b.corners == NONE, NONE, b.corners + len(a.node))
    return dataclasses.replace(
        a,
        node=np.concatenate([a.node, b.node + 1000]),
        xyz=np.concatenate([a.xyz, b.xyz + np.asarray(shift, float)]),
        element=np.concatenate([a.element, b.element + 1000]),
        corners=np.concatenate([a.corners, other]),
        **joined,
    )


def section(count, thickness=2.0, bending_thickness=3.0, **others):
    """Section of some elements."""
    values = STEEL | others
    arrays = (np.full(count, float(values[name])) for name in ("E", "nu", "rho", "nsm"))
    return Section(np.full(count, thickness), np.full(count, bending_thickness), *arrays)
