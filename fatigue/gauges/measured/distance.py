"""How far a measured record ran: the distance of every sample, from an odometer or a speed."""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

KM_OF = {"km": 1.0, "m": 1e-3}
KM_H_OF = {"km/h": 1.0, "m/s": 3.6}


def of_odometer(reading: Floats) -> tuple[Floats, int]:
    """Distance of every sample (t,), in the unit of the reading, and how often that went backwards.

    Backwards is no distance. Between readings it is a straight line; a sample has half of the way to each neighbour.

    >>> of_odometer(np.array([10.0, 11.0, 12.0, 12.0]))[0].tolist()
    [1.0, 1.0, 0.5, 0.0]
    """
    steps = np.diff(reading)
    ways = np.maximum(steps, 0.0)
    before, behind = np.append(ways[0], ways), np.append(ways, ways[-1])
    return 0.5 * (before + behind), int(np.count_nonzero(steps < 0.0))


def of_speed(speed_km_h: Floats, step: float) -> Floats:
    """Distance of every sample (t,) [km]: a sample stands for one step, whichever way the train goes."""
    return np.abs(speed_km_h) * step / 3600.0


def filled(x: Floats) -> tuple[Floats, int]:
    """Samples (t,) with lines over what is missing, held at both ends, and how many were missing.

    >>> filled(np.array([1.0, np.nan, 3.0, np.nan]))[0].tolist()
    [1.0, 2.0, 3.0, 3.0]
    """
    missing = ~np.isfinite(x)
    if not missing.any() or missing.all():
        return x, int(missing.sum())
    at = np.arange(len(x))
    return np.interp(at, at[~missing], x[~missing]), int(missing.sum())
