"""Stress at stress points once more: extrapolated to the toe, and on planes across the plate by Mohr's circle."""

from collections.abc import Mapping

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.verify.recount.inputs.coordinates import RecountCoordinates

Floats = NDArray[np.float64]

WEIGHTS = {  # of read-outs at these multiples of the thickness (a), or at these distances [mm] (b)
    "hot_spot_a": {(0.4, 1.0): (1.67, -0.67), (0.4, 0.9, 1.4): (2.52, -2.24, 0.72), (0.5, 1.5): (1.5, -0.5)},
    "hot_spot_b": {(4.0, 8.0, 12.0): (3.0, -3.0, 1.0), (5.0, 15.0): (1.5, -0.5)},
}
NEAR_TOE = [0.0, *(sign * phi for phi in range(5, 61, 5) for sign in (1.0, -1.0))]  # deg, the nearest first
ALL_ROUND = [float(phi) for phi in range(0, 180, 5)]


def point_tensors(
    rows: pd.DataFrame, kind: str, thickness: float, coordinates: RecountCoordinates, scale: Floats
) -> Mapping[str, Floats]:
    """sx, sy, txy (3, c) [MPa per unit coordinate] at every surface of one point; ``rows`` are those of its table."""
    place = {f"mode {mode}": at for at, mode in enumerate(coordinates.mode.tolist())}
    place |= {f"load {name}": len(place) + k for k, name in enumerate(coordinates.unit_loads)}
    weight = _weights(rows, kind, thickness)
    found: dict[str, Floats] = {}
    loads = rows["unit_load"] if "unit_load" in rows else pd.Series("", index=rows.index)
    for row, load in zip(rows.to_dict("records"), loads.fillna("").astype(str).str.strip(), strict=True):
        at = place.get(f"load {load}" if load else f"mode {int(row['mode'])}")
        if at is None:  # a mode that is ignored
            continue
        tensor = found.setdefault(str(row["surface"]).strip(), np.zeros((3, len(coordinates))))
        values = [float(np.nan_to_num(row.get(name, 0.0))) for name in ("sx_MPa", "sy_MPa", "txy_MPa")]
        tensor[:, at] += scale[at] * weight[_read_out(row)] * np.array(values)
    return found


def on_plane(tensor: Floats, phi_deg: float) -> Floats:
    """Normal stress (c,) on the plane whose normal is turned by an angle from x: centre and radius of Mohr's circle."""
    sx, sy, txy = tensor
    double = np.deg2rad(2.0 * phi_deg)
    return np.asarray((sx + sy) / 2.0 + (sx - sy) / 2.0 * np.cos(double) + txy * np.sin(double))


def shear_on_plane(tensor: Floats, phi_deg: float) -> Floats:
    """Shear stress (c,) on this plane."""
    sx, sy, txy = tensor
    double = np.deg2rad(2.0 * phi_deg)
    return np.asarray(txy * np.cos(double) - (sx - sy) / 2.0 * np.sin(double))


def _read_out(row: Mapping[str, object]) -> int:
    value = row.get("read_out", 1)
    return 1 if value is None or pd.isna(value) else int(float(str(value)))


def _weights(rows: pd.DataFrame, kind: str, thickness: float) -> dict[int, float]:
    """Weight of each read-out of a point, by its number."""
    numbers = [_read_out(row) for row in rows.to_dict("records")]
    if kind not in WEIGHTS:
        return dict.fromkeys(numbers, 1.0)
    distance = dict(zip(numbers, rows["distance_mm"].astype(float), strict=True))
    unit = thickness if kind == "hot_spot_a" else 1.0
    ascending = sorted(distance, key=lambda number: distance[number])
    given = [distance[number] / unit for number in ascending]
    fitting = [known for known in WEIGHTS[kind] if len(known) == len(given)]
    nearest = min(fitting, key=lambda known: float(np.abs(np.subtract(known, given)).max()))
    return dict(zip(ascending, WEIGHTS[kind][nearest], strict=True))
