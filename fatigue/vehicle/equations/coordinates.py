"""The coordinates of a vehicle: which body they move, and where it carries its points."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from fatigue.flexbody.mass import rigid_motions

Floats = NDArray[np.float64]

MOTIONS = ("y", "z", "rx", "ry", "rz")  # of a rigid body about its centre of gravity; none moves along x
WHEELSET_MOTIONS = ("y", "rz")
OF_SIX = {"x": 0, "y": 1, "z": 2, "rx": 3, "ry": 4, "rz": 5}

CAR, FLEX, CONVERTER, TRANSFORMER = "car", "flex", "conv", "trafo"
BOGIES = ("bogie_front", "bogie_rear")
WHEELSETS = ("wheelset_1", "wheelset_2", "wheelset_3", "wheelset_4")

GROUPS = {  # whose share of kinetic energy names a root
    "car": (CAR,),
    "flex": (FLEX,),
    "conv": (CONVERTER,),
    "trafo": (TRANSFORMER,),
    "bogies": BOGIES,
    "wheelsets": WHEELSETS,
}


@dataclass(frozen=True)
class Coordinates:
    """The order of the n coordinates q of a vehicle whose car body has some ``modes``.

    Car body as a rigid one (y, z, rx, ry, rz), its modes, converter, transformer, front and rear bogie (y, z, rx, ry,
    rz each), four wheelsets (y, rz each): 33 and the modes.
    """

    modes: int

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Name (n,) of each coordinate: body and motion.

        >>> Coordinates(1).names[4:7]
        ('car.rz', 'flex.1', 'conv.y')
        """
        motions = {CAR: MOTIONS, FLEX: tuple(str(mode + 1) for mode in range(self.modes))}
        motions |= dict.fromkeys((CONVERTER, TRANSFORMER, *BOGIES), MOTIONS)
        motions |= dict.fromkeys(WHEELSETS, WHEELSET_MOTIONS)
        return tuple(f"{body}.{motion}" for body, of_body in motions.items() for motion in of_body)

    @property
    def size(self) -> int:
        """How many there are, n."""
        return len(self.names)

    @cached_property
    def _columns(self) -> dict[str, int]:
        return {name: column for column, name in enumerate(self.names)}

    def column(self, body: str, motion: str) -> int:
        """Which coordinate moves a body like this."""
        return self._columns[f"{body}.{motion}"]

    @cached_property
    def _of_body(self) -> dict[str, NDArray[np.int64]]:
        bodies = np.array([name.partition(".")[0] for name in self.names])
        return {body: np.flatnonzero(bodies == body) for bodies_of in GROUPS.values() for body in bodies_of}

    def of(self, *bodies: str) -> NDArray[np.int64]:
        """Which coordinates move these bodies, body by body."""
        return np.concatenate([self._of_body[body] for body in bodies])

    @cached_property
    def flex(self) -> slice:
        """The modes of the car body."""
        return slice(len(MOTIONS), len(MOTIONS) + self.modes)

    @cached_property
    def wheelset_y(self) -> NDArray[np.int64]:
        """Lateral displacement (4,) of the wheelsets."""
        return np.array([self.column(wheelset, "y") for wheelset in WHEELSETS])

    @cached_property
    def wheelset_yaw(self) -> NDArray[np.int64]:
        """Yaw angle psi (4,) of the wheelsets."""
        return np.array([self.column(wheelset, "rz") for wheelset in WHEELSETS])

    def carried(self, body: str, cg: Floats, place: Floats) -> Floats:
        """Displacement (3, n) along x, y, z of a place on a rigid body, ``u = t + theta x (place - cg)``.

        Parameters
        ----------
        cg, place : (3,) [m] in the frame of the vehicle
        """
        field = rigid_motions(np.tile(place, (3, 1)), np.arange(3), cg)
        motions = WHEELSET_MOTIONS if body in WHEELSETS else MOTIONS
        motion = np.zeros((3, self.size))
        for name in motions:
            motion[:, self.column(body, name)] = field[:, OF_SIX[name]]
        return motion
