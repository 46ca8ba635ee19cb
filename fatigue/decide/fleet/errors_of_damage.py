"""How sure the damage of a condition is: as the fleet file states it, or from the life band of its result."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from fatigue.decide.fleet.conditions import Points, Result
from fatigue.decide.fleet.fleet_file import Fleet
from fatigue.results import read_table, refuse_mixed

Floats = NDArray[np.float64]

_KEY = ["weld", "part", "order", "surface"]


def errors_of_damage(fleet: Fleet, results: Mapping[str, Result], points: Points) -> Floats:
    """Relative standard error (p, c) of the damage of every condition, 0 where nothing says it.

    ``se_load`` of the band of a result is that of its whole mission: it is taken where the mission is one event.

    Raises
    ------
    DataError : the table of the band is of another result, or damaged
    """
    found = np.zeros((len(points.key), len(fleet.condition)))
    for c, condition in enumerate(fleet.condition):
        if condition.damage_cv is not None:
            found[:, c] = condition.damage_cv
        elif len(results[condition.results].events) == 1:
            found[:, c] = _of_band(results[condition.results], points)
    return found


def counted_as_exact(fleet: Fleet, errors: Floats, worst: NDArray[np.int64]) -> tuple[str, ...]:
    """Conditions of which nothing says how sure their damage is, at one of the points ``worst`` at least."""
    silent = (errors[worst] == 0.0).any(axis=0)
    asked = zip(fleet.condition, silent, strict=True)
    return tuple(one.name for one, is_silent in asked if is_silent and one.damage_cv is None)


def _of_band(result: Result, points: Points) -> Floats:
    """Standard errors (p,) from the band of a result, 0 where it has none."""
    if not (result.folder / "band.parquet").exists():
        return np.zeros(len(points.key))
    refuse_mixed(result.folder, result.record, ("band",), ("band",))
    band = read_table(result.folder, "band", [*_KEY, "se_load"]).to_pandas()
    key = points.key[_KEY].astype({"weld": str, "surface": str})
    both = key.merge(band, on=_KEY, how="left", validate="one_to_one")
    errors: Floats = both["se_load"].fillna(0.0).to_numpy(dtype=np.float64)
    return errors
