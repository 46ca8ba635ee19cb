"""How far the digits of a stiffness matrix carry: a free body that is given in few of them resists rigid motions."""

import numpy as np

from fatigue.errors import Problem
from fatigue.flexbody.factor import unit_rigid_motions
from fatigue.flexbody.structure import Structure

LARGEST = 1e-4  # estimate of the error of the lowest frequency; it may be ten times as large


def rigid_frequency(structure: Structure) -> float:
    """Frequency [Hz] that rounding of K gives a rigid motion, the largest of six: 0 in exact numbers.

    ``w^2`` is the largest eigenvalue of ``R' K R`` with ``R' M R = 1``, of either sign.
    """
    R = unit_rigid_motions(structure)
    grounded = R.T @ (structure.K @ R)
    w2 = np.abs(np.linalg.eigvalsh((grounded + grounded.T) / 2)).max()
    return float(np.sqrt(w2) / (2.0 * np.pi))


def few_digits(structure: Structure, lowest_hz: float, where: str) -> list[Problem]:
    """Warning of a K whose digits do not carry to the lowest elastic frequency.

    Rounding adds to the stiffness of an elastic motion about what it gives a rigid one, so that the lowest frequency is
    wrong by ``(f_rigid / f)^2 / 2`` in the order of magnitude. ``where`` names the file or matrix.
    """
    rigid = rigid_frequency(structure)
    error = (rigid / lowest_hz) ** 2 / 2.0
    if error <= LARGEST:
        return []
    what = (
        f"rigid motions have up to {rigid:.2g} Hz in place of 0, beside {lowest_hz:.3g} Hz of the lowest elastic mode: "
        f"the digits of the matrix leave some {100 * error:.1g} % of that frequency open (a warning above "
        f"{100 * LARGEST:g} %)"
    )
    return [Problem("few_digits", where, what, "Export the stiffness matrix in double precision, with 16 digits")]
