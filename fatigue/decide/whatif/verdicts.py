"""What a change does to the welds: the worst point of each before and after, and the verdict with its proof.

The worst point is the toe point with the largest value. The band of a weld goes from the largest low to the largest
high of all its toe points, so that a point with a wider band is in it. ``meets`` and ``misses`` are proven: no point
can reach the limit, or one surely does. Else it is ``not_proven``, as is a weld that a check beside its toe fails.
"""

from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.decide.whatif.change import Change
from fatigue.decide.whatif.forward import BASES, BOUND, RECOUNT, Forward
from fatigue.decide.whatif.stored import Stored
from fatigue.life.bounds.histogram import Enclosed
from fatigue.life.mission import life_km
from fatigue.quotient import quotient

Floats = NDArray[np.float64]
KEY = ("part", "order", "surface")
MEETS, MISSES, NOT_PROVEN = VERDICTS = ("meets", "misses", "not_proven")


def weld_table(
    stored: Stored, change: Change, curves: list[str], found: Forward, factors: Enclosed, keys: pd.DataFrame
) -> pd.DataFrame:
    """Every weld, those that miss first and then those that are not proven, the largest utilisation first.

    ``curves`` are the names of their curves after the change, ``factors`` the load factors (n,), ``keys`` those of the
    points; the columns are those of ``whatif_welds``.
    """
    before, utilisation = stored.of_welds, found.utilisation(change.after.target_km)
    known = stored.toe & (found.basis != RECOUNT)
    left = np.bincount(stored.weld[stored.toe & ~known], minlength=len(stored.welds))
    worst = _worst(stored, found, utilisation.value, known)
    there = worst >= 0
    low, high = (_extreme(part, stored, known, np.fmax) for part in (utilisation.low, utilisation.high))
    value = np.clip(_at(utilisation.value, worst), low, high)
    limit = found.limit[worst]
    of_weld = Enclosed(*(_extreme(part, stored, known, np.fmin) for part in factors))
    damage = [u * limit / change.after.target_km for u in (value, high, low)]
    lives = [np.where(np.isnan(d), np.nan, life_km(np.where(np.isnan(d), 0.0, d), limit)) for d in damage]
    sure = left == 0
    checks_fail = ~before["fulfilled"].to_numpy(dtype=bool) & (before["utilisation"].to_numpy(dtype=float) <= 1.0)
    was = np.where(before["fulfilled"], MEETS, MISSES)
    verdict = np.select([low > 1.0, sure & (high <= 1.0) & ~checks_fail], [MISSES, MEETS], NOT_PROVEN)
    life_before = before["life_km"].to_numpy(dtype=np.float64)
    place = _places(keys, worst)
    moved = [there & (keys[name].to_numpy()[worst] != before[f"worst_{name}"].to_numpy()) for name in KEY]
    basis = np.where(sure & there, found.basis[worst], RECOUNT)
    table = pd.DataFrame(
        {
            "weld": list(stored.welds),
            "curve": curves,
            "verdict_before": was,
            "verdict": verdict,
            "flips": (verdict != was) & ~checks_fail,
            "basis": np.array(BASES)[basis],
            "points_to_recount": left,
            "life_km_before": life_before,
            "life_km": lives[0],
            "life_km_low": np.where(sure, lives[1], np.nan),
            "life_km_high": lives[2],
            "life_years": lives[0] / change.after.km_per_year,
            "life_ratio": _ratio(lives[0], life_before),
            "utilisation_before": before["utilisation"].to_numpy(dtype=np.float64),
            "utilisation": value,
            "utilisation_low": low,
            "utilisation_high": np.where(sure, high, np.nan),
            "load_factor_before": before["load_factor"].to_numpy(dtype=np.float64),
            "load_factor": of_weld.value,
            "load_factor_low": np.where(sure, of_weld.low, np.nan),
            "load_factor_high": of_weld.high,
            **place,
            "worst_moved": np.logical_or.reduce(moved),
        }
    )
    urgency = table["verdict"].map({MISSES: 0, NOT_PROVEN: 1, MEETS: 2})
    shown = table["utilisation"].fillna(table["utilisation_before"])
    return table.iloc[np.lexsort([-shown, urgency])].reset_index(drop=True)


def _worst(stored: Stored, found: Forward, value: Floats, known: NDArray[np.bool_]) -> NDArray[np.intp]:
    """Row of the worst toe point of every weld, -1 where no number is known; a bound only where there is nothing else.

    Of equal ones it is the first, as in the assessment.
    """
    rows = np.flatnonzero(known)
    order = np.lexsort([rows, -value[rows], found.basis[rows] == BOUND, stored.weld[rows]])
    welds, first = np.unique(stored.weld[rows][order], return_index=True)
    worst = np.full(len(stored.welds), -1)
    worst[welds] = rows[order][first]
    return worst


def _extreme(values: Floats, stored: Stored, known: NDArray[np.bool_], which: np.ufunc) -> Floats:
    """Largest or smallest value of the known toe points of every weld, NaN without any."""
    found = np.full(len(stored.welds), np.nan)
    which.at(found, stored.weld[known], values[known])
    return found


def _at(values: Floats, rows: NDArray[np.intp]) -> Floats:
    return np.where(rows >= 0, values[rows], np.nan)


def _places(keys: pd.DataFrame, worst: NDArray[np.intp]) -> pd.DataFrame:
    """Key of the worst points; empty where there is none."""
    some = keys.iloc[worst]
    columns: dict[str, Any] = {}
    for name in ("part", "order", "node"):
        columns[f"worst_{name}"] = pd.array(some[name].to_numpy(), dtype="Int64")
    columns["worst_surface"] = some["surface"].astype(object).to_numpy()
    table = pd.DataFrame(columns)
    table.loc[worst < 0, :] = None
    return table


def _ratio(after: Floats, before: Floats) -> Floats:
    """Life after over life before; 1 where both are infinite."""
    both = np.isinf(after) & np.isinf(before)
    with np.errstate(invalid="ignore"):
        return np.where(both, 1.0, quotient(after, before))
