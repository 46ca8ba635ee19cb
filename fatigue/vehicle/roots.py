"""Roots of the linear vehicle: frequency, damping and the body that moves.

A root s is an eigenvalue of the state matrix: frequency ``|s|/2 pi``, damping ratio ``-Re s/|s|``. A vehicle is stable
where all roots have a negative real part, the slow lateral ones of the car body included.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.vehicle.assembly import LinearVehicle
from fatigue.vehicle.stability.naming import Named, named

Floats = NDArray[np.float64]
Complex = NDArray[np.complex128]

SWINGS = 0.3  # imaginary part of the slowest root that counts as one that swings [rad/s]
DECAYS = 1e-6  # real part of the slowest root that decays [1/s]: rounding leaves less of a root at 0


@dataclass(frozen=True, slots=True, eq=False)
class Root:
    """One root ``s`` [1/s], what moves in it, and its ``shape`` (n,) over the coordinates, of kinetic energy 1/2."""

    s: complex
    of: Named
    shape: Complex

    @property
    def frequency_hz(self) -> float:
        """``|s|/2 pi`` [Hz]."""
        return abs(self.s) / (2.0 * np.pi)

    @property
    def damping(self) -> float:
        """Damping ratio ``-Re s/|s|``; negative: it grows."""
        return -self.s.real / abs(self.s) if self.s else 0.0

    def __str__(self) -> str:
        """One line: name, frequency, damping, and the group that moves most."""
        return (
            f"{self.of.name}, {self.frequency_hz:.2f} Hz, damping {100.0 * self.damping:.2f} %, "
            f"{self.of.group} {100.0 * self.of.shares[self.of.group]:.0f} % of the energy"
        )


def roots(of: LinearVehicle, upto_hz: float = 25.0) -> list[Root]:
    """Roots that swing, up to a frequency, in ascending order; one of each conjugate pair."""
    s, shapes = np.linalg.eig(of.A)
    chosen = np.flatnonzero((s.imag > SWINGS) & (np.abs(s) < 2.0 * np.pi * upto_hz))
    return [root_of(of, s[k], shapes[:, k]) for k in sorted(chosen, key=lambda k: (abs(s[k]), s[k].real))]


def least_stable(of: LinearVehicle) -> Root:
    """The root with the largest real part, of all roots."""
    s, shapes = np.linalg.eig(of.A)
    k = min(range(len(s)), key=lambda k: (-s[k].real, -s[k].imag))
    return root_of(of, s[k], shapes[:, k])


def largest_real_part(A: Complex | Floats) -> float:
    """Largest real part of all roots [1/s]: negative where the vehicle is stable."""
    return float(np.linalg.eigvals(A).real.max())


def is_stable(of: LinearVehicle) -> bool:
    """Whether all roots decay; one that stays where it is, as of a vehicle that nothing guides, does not."""
    return largest_real_part(of.A) < -DECAYS


def root_of(of: LinearVehicle, s: complex, state: Complex) -> Root:
    """The root s with this state vector (N,)."""
    q = state[: of.coordinates.size].astype(np.complex128)
    q = q / np.sqrt(np.real(q.conj() @ of.M @ q))
    largest = q[np.abs(q).argmax()]
    q = q * (np.conj(largest) / abs(largest))
    return Root(complex(s), named(complex(s) / of.speed_m_s, q, of.M, of.coordinates, of.body_hz), q)
