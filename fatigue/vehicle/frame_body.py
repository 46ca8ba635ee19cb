"""The frame model of the reference trailer: a car body of beams, small enough to solve in a fraction of a second.

Rings at 15 stations along the car, of 12 nodes each, joined by longitudinals, braced panels and end walls. All of it is
invented; what is physical is the algebra. Units are SI; the body's own frame has x forward, y left, z up from the
floor, x = 0 at mid car. The points are those of the vehicle.
"""

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from fatigue.flexbody.condensation.craig_bampton import craig_bampton
from fatigue.flexbody.condensation.free_interface import free_interface
from fatigue.flexbody.condensation.orthonormal import orthonormal
from fatigue.flexbody.elements.beam import beam_stiffness
from fatigue.flexbody.factor import free_body
from fatigue.flexbody.mass import centre_of_mass, rigid_mass, rigid_motions
from fatigue.flexbody.modes import free_modes
from fatigue.flexbody.structure import Basis, Structure
from fatigue.vehicle.definition import Car
from fatigue.vehicle.elastic import ElasticBody, Point, default_damping

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

STATION_M = 1.75
STATIONS = range(-7, 8)
RING = np.array(  # y, z of the positions k = 0 .. 11
    [(0.0, 0.0), (0.7, 0.0), (1.45, 0.0), (1.6, 0.9), (1.5, 2.1), (0.8, 2.6), (0.0, 2.7), (-0.8, 2.6), (-1.5, 2.1),
     (-1.6, 0.9), (-1.45, 0.0), (-0.7, 0.0)]
)  # fmt: skip
E_PA, G_PA = 70e9, 27e9
MASS_KG = 30_000.0
ROTARY_M2 = 0.05  # rotary inertia of a node about each axis, per mass

EXTERNAL = {
    "coupler_front": (7, 0), "coupler_rear": (-7, 0),
    "bolster_front_left": (5, 2), "bolster_front_right": (5, 10),
    "bolster_rear_left": (-5, 2), "bolster_rear_right": (-5, 10),
}  # fmt: skip
INTERNAL = {
    "converter_1": (1, 2), "converter_2": (1, 10), "converter_3": (-1, 2), "converter_4": (-1, 10),
    "transformer_1": (3, 1), "transformer_2": (3, 11), "transformer_3": (2, 1), "transformer_4": (2, 11),
    "roof_1": (-2, 5), "roof_2": (-2, 7), "roof_3": (-3, 5), "roof_4": (-3, 7),
}  # fmt: skip
OUTPUTS = {"floor_mid": (0, 0), "floor_front": (5, 0), "floor_rear": (-5, 0), "roof_mid": (0, 6), "roof_base": (-2, 5)}
MOUNT_BEAM = ((1, 1), (1, 2))  # the cross beam of the floor at the front left mount of the converter


def node_at(station: int, position: int) -> int:
    """Number of the node at a station -7 .. 7 and a position 0 .. 11 of its ring."""
    return len(RING) * (station + 7) + position % len(RING)


def frame_nodes() -> Floats:
    """Places (180, 3) [m] of the nodes in the body's own frame."""
    x = np.repeat(STATION_M * np.array(STATIONS), len(RING))
    return np.column_stack([x, np.tile(RING, (len(STATIONS), 1))])


def frame_beams() -> tuple[Integers, Floats, Floats]:
    """Nodes (696, 2), areas (696,) [m2] and moments of inertia I = J (696,) [m4] of the members."""
    members: list[tuple[int, int, float, float]] = []
    for s in STATIONS:
        for k in range(12):
            floor = k in {0, 1, 10, 11}
            inertia_m4 = 1.2e-5 * (20.0 if floor else 1.0) * (3.0 if floor and abs(s) == 5 else 1.0)
            members.append((node_at(s, k), node_at(s, k + 1), 2e-3, inertia_m4))
    for s in STATIONS[:-1]:
        for k in range(12):
            members.append((node_at(s, k), node_at(s + 1, k), 6.5e-3 * (1.6 if k in {2, 10} else 1.0), 4e-6))
            brace = 6e-3 * (0.25 if k in {3, 8} else 1.0)  # windows give way
            members.append((node_at(s, k), node_at(s + 1, k + 1), brace, 1e-10))
            members.append((node_at(s, k + 1), node_at(s + 1, k), brace, 1e-10))
    for s in (-7, 7):
        for a, b in ((2, 8), (10, 4), (2, 4), (10, 8), (3, 9), (0, 6)):
            members.append((node_at(s, a), node_at(s, b), 2e-3, 1e-8))
    nodes = np.array([member[:2] for member in members], dtype=np.int64)
    area, inertia = np.array([member[2:] for member in members]).T
    return nodes, area, inertia


def nodal_mass() -> Floats:
    """Mass (180,) [kg] of the nodes: floor heavy, roof light, the ends 0.6 of it."""
    of_ring = np.array([1.25 if k in {0, 1, 2, 10, 11} else 0.7 if k in {5, 6, 7} else 0.95 for k in range(12)])
    weight = np.where(np.abs(STATIONS) == 7, 0.6, 1.0)[:, None] * of_ring
    return np.asarray((MASS_KG / weight.sum() * weight).ravel())


def frame_structure() -> Structure:
    """K and M (1080, 1080) of the bare car body; rows node by node: x, y, z, rx, ry, rz."""
    xyz = frame_nodes()
    nodes, area, inertia = frame_beams()
    stiffness = beam_stiffness(xyz[nodes[:, 0]], xyz[nodes[:, 1]], E_PA * area, E_PA * inertia, G_PA * inertia)
    at = _rows(nodes)
    row, column = np.broadcast_arrays(at[:, :, None], at[:, None, :])
    size = 6 * len(xyz)
    K = sparse.csc_array(sparse.coo_array((stiffness.ravel(), (row.ravel(), column.ravel())), shape=(size, size)))
    mass = np.repeat(nodal_mass(), 6) * np.tile([1.0, 1.0, 1.0, *3 * [ROTARY_M2]], len(xyz))
    return Structure(
        K=K,
        M=sparse.csc_array(sparse.diags_array(mass)),
        node=np.repeat(np.arange(len(xyz)), 6),
        direction=np.tile(np.arange(6), len(xyz)),
        xyz=np.repeat(xyz, 6, axis=0),
    )


def masters_of(*groups: dict[str, tuple[int, int]]) -> NDArray[np.bool_]:
    """Rows (1080,) of all six degrees of freedom of the nodes of these groups of points."""
    masters = np.zeros(6 * len(STATIONS) * len(RING), dtype=bool)
    for group in groups:
        masters[_rows(np.array([node_at(*at) for at in group.values()]))] = True
    return masters


def frame_basis(structure: Structure, basis: str, cut_hz: float, keep_hz: float | None) -> Basis:
    """A basis of the frame body.

    ``weak``: Craig-Bampton with the 6 external nodes as masters, ``strong``: with all 18, six degrees of freedom each;
    fixed-interface modes up to ``cut_hz``. ``residual``: free modes up to ``cut_hz`` and residual attachment modes of
    the three forces at all 18 nodes. ``full``: exact modes. Shapes above ``keep_hz`` are left out, None keeps all.

    Raises
    ------
    ValueError : no such basis
    """
    match basis:
        case "weak":
            T = craig_bampton(structure, masters_of(EXTERNAL), upto_hz=cut_hz)
        case "strong":
            T = craig_bampton(structure, masters_of(EXTERNAL, INTERNAL), upto_hz=cut_hz)
        case "residual":
            T = free_interface(free_body(structure), _unit_forces(structure), upto_hz=cut_hz)
        case "full":
            all_of_them = len(structure.node) - 6
            return free_modes(free_body(structure), upto_hz=keep_hz, count=all_of_them if keep_hz is None else None)
        case _:
            raise ValueError(f"no basis {basis!r}: weak, strong, residual, full")
    found = orthonormal(structure, T, cut_hz).basis
    kept = found.frequency <= (np.inf if keep_hz is None else keep_hz)
    return Basis(found.shapes[:, kept], found.frequency[kept], found.normal[kept])


def frame_body(car: Car) -> ElasticBody:
    """The car body of the reference trailer, from ``basis``, ``cut_hz``, ``keep_hz`` and ``floor_z_m`` of the car.

    ``recover`` has ``mount_mx`` [N m/(m sqrt(kg))]: the moment about x on the second node of the floor beam at the
    front left mount of the converter, a row of ``k_e u_e``.
    """
    structure = frame_structure()
    basis = frame_basis(structure, car.basis, car.cut_hz, car.keep_hz)
    centre = centre_of_mass(rigid_mass(structure.M, rigid_motions(structure.xyz, structure.direction)))
    about_centre = rigid_mass(structure.M, rigid_motions(structure.xyz, structure.direction, centre))
    floor = np.array([0.0, 0.0, car.floor_z_m])
    xyz = frame_nodes()
    points = {
        name: Point(xyz[node_at(*at)] + floor, basis.shapes[_rows(np.array([node_at(*at)]))])
        for name, at in (EXTERNAL | INTERNAL | OUTPUTS).items()
    }
    return ElasticBody(
        mass=float(about_centre[0, 0]),
        cg=centre + floor,
        inertia=(about_centre[3:, 3:] + about_centre[3:, 3:].T) / 2.0,
        frequency_hz=basis.frequency,
        damping_ratio=default_damping(basis.frequency),
        points=points,
        recovered=("mount_mx",),
        recover=mount_moment(basis.shapes)[None],
    )


def mount_moment(shapes: Floats) -> Floats:
    """Moment about x (k,) [N m] on the second node of the floor beam at a mount, for shapes (1080, k) [m], [rad]."""
    ends = np.array([node_at(*at) for at in MOUNT_BEAM])
    nodes, area, inertia = frame_beams()
    member = np.flatnonzero((nodes == ends).all(axis=1))[0]
    xyz, area, inertia = frame_nodes()[ends], area[[member]], inertia[[member]]
    k_e = beam_stiffness(xyz[[0]], xyz[[1]], E_PA * area, E_PA * inertia, G_PA * inertia)[0]
    return np.asarray(k_e[9] @ shapes[_rows(ends)])


def _rows(nodes: Integers) -> Integers:
    """Rows (..., 6 times the last axis) of the degrees of freedom of nodes (..., n)."""
    return np.asarray((6 * nodes[..., None] + np.arange(6)).reshape(*nodes.shape[:-1], -1))


def _unit_forces(structure: Structure) -> Floats:
    """Columns (1080, 54) of a unit force along x, y, z at each interface node."""
    loaded = masters_of(EXTERNAL, INTERNAL) & (structure.direction < 3)
    return np.asarray(np.eye(len(loaded))[:, loaded])
