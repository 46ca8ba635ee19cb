"""Curves as the provenance of a result records them, read back: what a result was computed with, without its case."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.life.allowances import NOTHING, Allowances, bending_thickness
from fatigue.life.curves import SNCurve, ThicknessRule
from fatigue.life.rule import size_factor


def recorded_curve(name: str, recorded: Mapping[str, Any]) -> SNCurve:
    """Curve of an entry of ``curves`` in the provenance; one of an older version had no allowances."""
    allowances = recorded.get("allowances")
    return SNCurve(
        name=name,
        applies=recorded["applies"],
        slopes=tuple(recorded["slopes"]),
        knees_cycles=tuple(recorded["knees_cycles"]),
        reference_cycles=recorded["reference_cycles"],
        reference_range=recorded["reference_range"],
        source=recorded["source"],
        thickness_reference=recorded["thickness_reference_mm"],
        thickness_exponent=recorded["thickness_exponent"],
        status=recorded.get("status", ""),
        quantity=recorded.get("quantity", "normal"),
        allowances=NOTHING if allowances is None else Allowances(**allowances),
    )


def recorded_size(
    name: str,
    recorded: Mapping[str, Any],
    thickness: NDArray[np.float64],
    rule: ThicknessRule,
    attachment: NDArray[np.float64] | float = np.inf,
) -> NDArray[np.float64]:
    """Factor on the range of plates of some thickness [mm] that the result was computed with."""
    curve = recorded_curve(name, recorded)
    of_plate = size_factor(thickness, curve, rule, attachment) * bending_thickness(thickness, curve.allowances)
    return of_plate * float(recorded["used"].get("factor_on_range", 1.0))
