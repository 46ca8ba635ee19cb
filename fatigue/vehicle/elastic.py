"""The car body as the vehicle sees it: a rigid body and modes with unit modal mass, known at some points."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Point:
    """A point of the car body: its ``place`` (3,) [m] in the frame of the vehicle, and how the modes move it.

    ``shape`` (6, m) is displacement along and rotation about x, y, z per unit modal coordinate [1/sqrt(kg)], [1/(m
    sqrt(kg))]; a rotation that is not known is NaN.
    """

    place: Floats
    shape: Floats


@dataclass(frozen=True, slots=True, eq=False)
class ElasticBody:
    """A free flexible body: ``mass`` [kg], ``cg`` (3,) [m], ``inertia`` (3, 3) [kg m2] about it, and its modes.

    ``cg`` is in the frame of the vehicle (x forward, y left, z up from rail top, origin at mid vehicle).
    ``frequency_hz`` and ``damping_ratio`` are (m,). ``points`` are known by name: ``bolster_front_left`` ...,
    ``converter_1`` ..., ``transformer_1`` ..., where the suspension takes hold, and those that outputs are read at.
    ``recover`` (r, m) gives further linear outputs per unit modal coordinate, named ``recovered`` (the moment in a
    cross beam of the frame body).
    """

    mass: float
    cg: Floats
    inertia: Floats
    frequency_hz: Floats
    damping_ratio: Floats
    points: Mapping[str, Point]
    recovered: tuple[str, ...] = ()
    recover: Floats | None = None


def default_damping(frequency_hz: Floats) -> Floats:
    """Damping ratio (m,) by frequency: 1.5 % below 100 Hz, 10 % from 100 to 1000 Hz, 100 % above.

    >>> default_damping(np.array([8.0, 100.0, 1000.1])).tolist()
    [0.015, 0.1, 1.0]
    """
    return np.asarray(np.select([frequency_hz < 100.0, frequency_hz <= 1000.0], [0.015, 0.10], 1.0))
