"""Whether element forces are in balance: what is not misses corners, is of another frame or contains inertia."""

from pathlib import Path

import numpy as np

from fatigue.errors import DataError, Problem
from fatigue.readers.neutral.body.coordinates import Coordinates
from fatigue.readers.neutral.body.mesh import Mesh
from fatigue.weld.element_forces import BALANCE_RED, ElementForces, balance

IMBALANCE = {"error": BALANCE_RED, "warning": 1e-4}  # of the element's largest term; single precision leaves 3e-5


def checked_balance(
    path: Path, forces: ElementForces, mesh: Mesh | None, coordinates: Coordinates, remedy: str = ""
) -> list[Problem]:
    """Warning of element forces that are further out of balance than single precision explains; worse is refused.

    ``remedy`` is said beside the common one.
    """
    if forces.element.size == 0:
        return []
    xyz = None if mesh is None else dict(zip(mesh.node.tolist(), mesh.xyz, strict=True))
    found = balance(forces, xyz)
    moment = found.force_residual if found.moment_residual is None else found.moment_residual
    residual = np.maximum(found.force_residual, moment)
    worst = int(residual.argmax())
    if residual[worst] <= IMBALANCE["warning"]:
        return []
    problem = Problem(
        "imbalance",
        f"{path.name}: element {found.element[worst]}, {coordinates.name(int(found.mode[worst]))}",
        f"forces and moments are out of balance by {residual[worst]:.2g} of the largest",
        "Export static element forces only (no inertia), of all corners, in global axes" + remedy,
    )
    if residual[worst] > IMBALANCE["error"]:
        raise DataError(problem)
    return [problem]
