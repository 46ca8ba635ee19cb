"""Car bodies made by hand for tests of the vehicle: a rigid one, and one with a few invented modes."""

import numpy as np

from fatigue.vehicle.elastic import ElasticBody, Point, default_damping

MASS, CG, INERTIA = 30_000.0, np.array([0.0, 0.0, 2.07]), np.diag([77e3, 1.59e6, 1.60e6])
LEFT_RIGHT = (("left", 1.0), ("right", -1.0))
PLACES = {
    **{f"bolster_front_{side}": (8.75, 1.45 * sign, 1.15) for side, sign in LEFT_RIGHT},
    **{f"bolster_rear_{side}": (-8.75, 1.45 * sign, 1.15) for side, sign in LEFT_RIGHT},
    **{f"converter_{k + 1}": (1.75 * (1 - k // 2 * 2), 1.45 * (1 - k % 2 * 2), 1.15) for k in range(4)},
    **{f"transformer_{k + 1}": (5.25 - k // 2 * 1.75, 0.7 * (1 - k % 2 * 2), 1.15) for k in range(4)},
    "floor_mid": (0.0, 0.0, 1.15),
    "floor_front": (8.75, 0.0, 1.15),
    "floor_rear": (-8.75, 0.0, 1.15),
    "roof_mid": (0.0, 0.0, 3.85),
}


def rigid_body():
    """A car body without modes."""
    return elastic_body(np.zeros(0))


def elastic_body(frequency_hz, seed=1, damping_ratio=None):
    """A car body with these modes, their shapes drawn; rotations are not known, as of a reduced shell."""
    rng = np.random.default_rng(seed)
    frequency_hz = np.asarray(frequency_hz, dtype=float)
    points = {}
    for name, place in PLACES.items():
        shape = rng.normal(scale=0.006, size=(6, frequency_hz.size))
        shape[3:] = np.nan
        points[name] = Point(np.array(place), shape)
    damping = default_damping(frequency_hz) if damping_ratio is None else np.full(frequency_hz.size, damping_ratio)
    recover = rng.normal(size=(1, frequency_hz.size))
    return ElasticBody(MASS, CG, INERTIA, frequency_hz, damping, points, ("moment",), recover)


def bending_body(frequency_hz=10.0, damping_ratio=0.015):
    """A car body with one vertical and one lateral bending mode of a free beam 24.5 m long: mirror symmetric."""
    points = {}
    for name, place in PLACES.items():
        xi = place[0] / 12.25
        bend = (1.5 * xi**2 - 0.5) / np.sqrt(MASS / 4.0)  # about the first bending shape, unit modal mass
        shape = np.zeros((6, 2))
        shape[2, 0], shape[1, 1] = bend, bend
        points[name] = Point(np.array(place), shape)
    hz = np.array([frequency_hz, 1.15 * frequency_hz])
    return ElasticBody(MASS, CG, INERTIA, hz, np.full(2, damping_ratio), points)
