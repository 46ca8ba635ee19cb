"""What a root is called: the body that has most of its kinetic energy, and how this body moves.

Energy decides, so that the same root has the same name wherever it is asked for. Names of sway follow the pole: the
height about which the car body turns while it moves sideways, below its centre of gravity (lower sway) or above it
(upper sway). Wheelsets that move where they point, ``y'/V = psi``, hunt; those that slide across their heading creep.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.vehicle.equations.coordinates import BOGIES, CAR, CONVERTER, GROUPS, TRANSFORMER, WHEELSETS, Coordinates

Floats = NDArray[np.float64]
Complex = NDArray[np.complex128]

WORDS = {"y": "lateral", "z": "bounce", "rx": "roll", "ry": "pitch", "rz": "yaw"}
PURE = 0.01  # of the energy of sway: a car body with less of it in roll moves laterally, with less sideways it rolls
HUNTS = 0.3  # of the energy of a root of the car body: lateral and yaw motion of bogies and wheelsets
SLIDES = 0.7  # of wheelsets: |y'/V - psi|^2 over |y'/V|^2 + |psi|^2 from which they creep
WHEELSETS_ALONE = 2.0 / 3.0  # of the energy of a root that hunts, on wheelsets: their bogie hardly takes part
ALONE = 2.0 / 3.0  # of the energy of running gear, at one end

ENDS = (BOGIES[0], *WHEELSETS[:2]), (BOGIES[1], *WHEELSETS[2:])


@dataclass(frozen=True, slots=True)
class Named:
    """Name of a root, the ``group`` with most of its kinetic energy, and what share each group has.

    ``body_mode`` is the flexible mode of the car body with most energy, 0 the first, None without modes;
    ``body_mode_share`` is its share of the energy of the root.
    """

    name: str
    group: str
    shares: Mapping[str, float]
    body_mode: int | None
    body_mode_share: float


def named(s_over_speed: complex, q: Complex, M: Floats, at: Coordinates, body_hz: Floats) -> Named:
    """Name and energies of a root s with the shape q (n,); M (n, n) is the mass matrix.

    Energy is ``q* M q``. ``s_over_speed`` is s/V [1/m]. ``body_hz`` (m,) are the frequencies of the modes of the car
    body, which stand in the name of a root that is one of them.
    """
    energy = energies(q, M)
    shares = {group: float(energy[at.of(*bodies)].sum()) for group, bodies in GROUPS.items()}
    group = max(shares, key=lambda name: shares[name])
    of_modes = energy[at.flex]
    body_mode = int(of_modes.argmax()) if of_modes.size else None
    share = float(of_modes.max()) if of_modes.size else 0.0
    if group == "flex" and body_mode is not None:
        name = f"body mode {body_mode + 1} ({body_hz[body_mode]:.1f} Hz)"
    elif group == "car":
        name = _car(q, energy, at)
    elif group == "conv":
        name = f"converter {WORDS[_strongest(energy, at, CONVERTER)]}"
    elif group == "trafo":
        name = f"transformer {WORDS[_strongest(energy, at, TRANSFORMER)]}"
    else:
        name = _running_gear(group, _sliding(s_over_speed, q, at), q, energy, at)
    return Named(name, group, shares, body_mode, share)


def energies(q: Complex, M: Floats) -> Floats:
    """Share (n,) of each coordinate of the kinetic energy ``q* M q``."""
    energy = np.real(q.conj() * (M @ q))
    return np.asarray(energy / energy.sum())


def _strongest(energy: Floats, at: Coordinates, *bodies: str) -> str:
    """The motion of these bodies with most energy."""
    of = {motion: sum(float(energy[at.column(body, motion)]) for body in bodies) for motion in WORDS}
    return max(of, key=lambda motion: of[motion])


def _lateral(energy: Floats, at: Coordinates) -> float:
    """Share of lateral and yaw motion of bogies and wheelsets."""
    return sum(float(energy[at.column(body, motion)]) for body in (*BOGIES, *WHEELSETS) for motion in ("y", "rz"))


def _car(q: Complex, energy: Floats, at: Coordinates) -> str:
    motion = _strongest(energy, at, CAR)
    words = f"car body {WORDS[motion]}"
    if motion in ("y", "rx"):
        y, rx = (at.column(CAR, of) for of in ("y", "rx"))
        if min(energy[y], energy[rx]) > PURE * (energy[y] + energy[rx]):
            pole_above = np.real(q[y] * np.conj(q[rx])) > 0.0  # y - rx (z - z_cg) = 0 at z = z_cg + y/rx
            words = f"car body {'upper' if pole_above else 'lower'} sway"
    return f"{words} with hunting" if _lateral(energy, at) > HUNTS else words


def _running_gear(group: str, sliding: float, q: Complex, energy: Floats, at: Coordinates) -> str:
    of = {motion: sum(float(energy[at.column(bogie, motion)]) for bogie in BOGIES) for motion in ("z", "rx", "ry")}
    of["y"] = _lateral(energy, at)
    motion = max(of, key=lambda name: of[name])
    words = f"bogie {WORDS[motion]}"
    if motion == "y" and sliding < SLIDES:
        words = "wheelset hunting" if energy[at.of(*WHEELSETS)].sum() > WHEELSETS_ALONE else "bogie hunting"
    elif motion == "y":
        words = "wheelset creep" if group == "wheelsets" else f"bogie {WORDS[_strongest(energy, at, *BOGIES)]}"
    front, rear = (float(energy[at.of(*bodies)].sum()) for bodies in ENDS)
    if max(front, rear) > ALONE * (front + rear):
        return f"{words} ({'front' if front > rear else 'rear'})"
    a, b = (q[at.column(bogie, motion)] for bogie in BOGIES)
    return f"{words} ({'in phase' if np.real(a * np.conj(b)) > 0.0 else 'opposed'})"


def _sliding(s_over_speed: complex, q: Complex, at: Coordinates) -> float:
    """``|y'/V - psi|^2`` over ``|y'/V|^2 + |psi|^2``, summed over wheelsets: 0 where they roll as they point."""
    along, heading = s_over_speed * q[at.wheelset_y], q[at.wheelset_yaw]
    both = np.sum(np.abs(along) ** 2 + np.abs(heading) ** 2)
    return float(np.sum(np.abs(along - heading) ** 2) / both) if both else 1.0
