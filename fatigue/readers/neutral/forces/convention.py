"""What the forces of a file are: their columns, the side they act on, and the size of the mode they belong to.

``fatigue.readers.convert.audit.sign_proof`` proves which convention a solver writes; here it is applied, once.
"""

from typing import Any, Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from fatigue.readers.neutral.body.modes import Modes
from fatigue.readers.neutral.body.unit_loads import UnitLoads

Convention: TypeAlias = Literal["on_element", "on_node"]
COMPONENTS = ("fx_N", "fy_N", "fz_N", "mx_Nmm", "my_Nmm", "mz_Nmm")


def on_element_factor(modes: Modes | UnitLoads, convention: Convention) -> NDArray[np.float64]:
    """Factor of each mode or unit load (m,) that turns forces of a file into on_element forces as simulated."""
    return modes.scale if convention == "on_element" else -modes.scale


def on_element(force: NDArray[Any], factor: NDArray[np.float64]) -> NDArray[Any]:
    """Multiply the forces of a file, (..., 6), by their factors, (..., 1); in place where these are only signs."""
    if not np.isin(factor, (-1.0, 1.0)).all():
        force = force.astype(np.float64)  # a product in single precision would cost the last digits
    force *= factor.astype(force.dtype)
    return force
