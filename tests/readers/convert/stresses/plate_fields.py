"""A plate of odd quadrangles and triangles under a linear stress field, as a solver states it: in element axes.

The axes are computed by angles in the plane, not as the program computes them.
"""

from dataclasses import dataclass

import numpy as np

from fatigue.readers.foreign.fe.model import FeModel, Section, Shell, shell_mesh
from fatigue.readers.foreign.fe.shell_stress import StressBlock

T = 6.0  # mm
SOURCE = "plate"


@dataclass(frozen=True)
class Field:
    """Stress in the plane, sx, sy, txy [MPa], linear in x and y: of the mid-surface, and added at the top (z > 0)."""

    membrane: np.ndarray  # (3, 3): constant, slope along x, slope along y of each component
    bending: np.ndarray

    def at(self, xy, top):
        """Stress (3,) at a place on the top (1), the bottom (-1) or in the middle (0)."""
        return (self.membrane + top * self.bending) @ np.array([1.0, xy[0], xy[1]])


def field(seed=0, linear=True):
    """A field drawn from a seed."""
    rng = np.random.default_rng(seed)
    slope = np.array([1.0, 0.02, 0.02]) if linear else np.array([1.0, 0.0, 0.0])
    return Field(rng.normal(size=(3, 3)) * 50 * slope, rng.normal(size=(3, 3)) * 30 * slope)


@dataclass(frozen=True)
class Plate:
    """Shells as corner ids, grids by id, and the property of each shell."""

    grids: dict
    shells: dict
    pid: dict
    model: FeModel


def plate(seed=0, nx=8, ny=6, triangles=0.0, turned=True, pid=lambda x, y: 1, thickness=T, fold=None):
    """A plate of 80 x 60 mm in the x-y plane; corners begin anywhere, normals point up or down; ``fold`` bends it."""
    rng = np.random.default_rng(seed)
    x, y = np.meshgrid(np.linspace(0, 80, nx + 1), np.linspace(0, 60, ny + 1), indexing="ij")
    inner = (x > 0) & (x < 80) & (y > 0) & (y < 60)
    xy = np.stack([x, y], -1) + rng.uniform(-2, 2, (*x.shape, 2)) * inner[..., None]
    number = 10 + 3 * np.arange(x.size).reshape(x.shape)
    place = fold or (lambda p: (*p, 0.0))
    grids = {int(n): np.array(place(p)) for n, p in zip(number.ravel(), xy.reshape(-1, 2).tolist(), strict=True)}
    shells, pids = {}, {}
    for i in range(nx):
        for j in range(ny):
            quad = [int(number[a]) for a in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1))]
            cut = rng.random() < triangles
            for corners in [quad[:3], [quad[2], quad[3], quad[0]]] if cut else [quad]:
                begin, flip = (int(rng.integers(len(corners))), rng.random() < 0.5) if turned else (0, False)
                ring = corners[begin:] + corners[:begin]
                shells[100 + 7 * len(shells)] = tuple(ring[::-1] if flip else ring)
                pids[list(shells)[-1]] = pid(*xy[i : i + 2, j : j + 2].mean(axis=(0, 1)))
    own = [Shell(e, pids[e], corners) for e, corners in shells.items()]
    mesh = shell_mesh(SOURCE, grids, own, {p: Section(thickness) for p in set(pids.values())})
    model = FeModel(SOURCE, mesh, np.empty(0, np.int64), np.empty((0, 3, 3)))
    return Plate(grids, shells, pids, model)


def axis_angle(corners):
    """Angle of the element's x axis in the plane, from its corners (k, 2) in their order."""
    if len(corners) == 3:
        return np.arctan2(*(corners[1] - corners[0])[::-1])
    first, second = corners[2] - corners[0], corners[1] - corners[3]
    a, b = np.arctan2(first[1], first[0]), np.arctan2(second[1], second[0])
    return a + (np.angle(np.exp(1j * (b - a)))) / 2


def in_axes(stress, angle, up):
    """Stress in axes turned by an angle; where the normal points down, y is the other way."""
    c, s = np.cos(angle), np.sin(angle)
    sx, sy, t = stress
    turned = np.array([sx * c * c + sy * s * s + 2 * t * s * c, sx * s * s + sy * c * c - 2 * t * s * c,
                       (sy - sx) * s * c + t * (c * c - s * s)])  # fmt: skip
    return turned * np.array([1.0, 1.0, 1.0 if up else -1.0])


def blocks(plate, field_of, mode=1, subcase=1, corners=True, fibres=(-T / 2, T / 2), eigenvalue=np.nan):
    """Stress blocks of quadrangles and triangles; ``field_of(element)`` is the field in an element."""
    found = []
    for count, kind in ((4, "QUAD4"), (3, "TRIA3")):
        elements = [e for e, own in plate.shells.items() if len(own) == count]
        points = 5 if corners and count == 4 else 1
        node = np.zeros((len(elements), points), np.int64)
        stress = np.zeros((len(elements), points, 2, 3))
        for k, element in enumerate(elements):
            own = plate.shells[element]
            xy = np.array([plate.grids[n][:2] for n in own])
            turn = (xy[1] - xy[0])[0] * (xy[2] - xy[1])[1] - (xy[1] - xy[0])[1] * (xy[2] - xy[1])[0]
            up, angle = turn > 0, axis_angle(xy)
            node[k, 1:] = own[: points - 1]
            for p, place in enumerate([xy.mean(axis=0), *xy][:points]):
                for f, z in enumerate(fibres):
                    share = z / (T / 2) * (1 if up else -1)
                    stress[k, p, f] = in_axes(field_of(element).at(place, share), angle, up)
        if elements:
            fibre = np.broadcast_to(np.array(fibres), (len(elements), points, 2)).copy()
            where = f"{SOURCE} mode {mode}"
            found.append(StressBlock(where, subcase, mode, eigenvalue, kind, np.array(elements), node, fibre, stress))
    return found


def in_frame(stress, x, normal_up):
    """Stress of the plane in the frame of x (2,) and a normal up or down."""
    return in_axes(stress, np.arctan2(x[1], x[0]), normal_up)
