"""Bands of lives by the load as they should be, from the recounted cycles, beside those in the table.

Written from the description of the columns: pieces of each pass, the sums of five of them in a row around the end,
variances that add up over the events. Whether a record is too short, and so whether there is a band, is not recounted.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy.stats import t as student

from fatigue.results import read_rows
from fatigue.results.rows import rows_of_welds
from fatigue.results.tables import table_path
from fatigue.verify.recount.anew.mission import RecountEvent
from fatigue.verify.recount.anew.point import OnePass
from fatigue.verify.recount.layout import Key
from fatigue.verify.recount.stored.compare import Row
from fatigue.verify.recount.stored.rows import place
from fatigue.verify.recount.stored.tables import Stored

Floats = NDArray[np.float64]

IN_A_ROW = 5  # pieces of a block
SMALL = 0.05  # share of the damage up to which an event may scatter by all of it
WITH_BAND = ("", "non_stationary")


def stored_bands(stored: Stored, welds: Sequence[str]) -> dict[Key, dict[str, Any]]:
    """Rows of the table of bands of some welds; none of a result without it."""
    if not table_path(stored.folder, "band").exists():
        return {}
    numbers = np.concatenate([np.zeros(0, np.int64), *rows_of_welds(stored.folder, "band", welds).values()])
    rows = read_rows(stored.folder, "band", np.sort(numbers)).to_pandas().to_dict("records")
    return {(row["weld"], int(row["part"]), int(row["order"]), row["surface"]): row for row in rows}


def band_row(
    key: Key,
    events: Sequence[RecountEvent],
    passes: Sequence[OnePass],
    life_km: float,
    bound: float,
    found: Mapping[str, Any],
) -> Row:
    """The row of one point: its life and, where the table has one, its band by the load.

    ``bound`` is what rounding may do to the inverse of the life [1/km]. An event with a small share may scatter as its
    record does or by all of its damage: the table may say either.
    """
    reason = "" if pd.isna(found["band_reason"]) else str(found["band_reason"])
    expected: dict[str, Any] = {"life_km": life_km}
    bounds = {"life_km": bound}
    if reason in WITH_BAND:
        per_km = np.array(
            [event.passes_per_km * one.quantities["damage_per_pass"] for event, one in zip(events, passes, strict=True)]
        )
        share = per_km / per_km.sum()
        errors = [_error(one.pieces) if event.length_km else 1.0 for event, one in zip(events, passes, strict=True)]
        small = (np.abs(share) <= SMALL) & (np.array(errors) < 1.0)
        least, most = (share * np.array(errors)) ** 2, (share * np.where(small, 1.0, errors)) ** 2
        se, dof = float(found["se_load"]), float(found["dof"])
        expected["se_load"] = float(np.clip(se, np.sqrt(least.sum()), np.sqrt(most.sum())))
        if not small.any():
            expected["dof"] = dof = _freedom(least)
        half = float(student.ppf(0.95, dof)) * expected["se_load"]
        expected |= {"life_km_load_low": life_km * np.exp(-half), "life_km_load_high": life_km * np.exp(half)}
        bounds |= _bounds(bound * life_km, expected["se_load"], half)
        bounds |= {name: bounds["ends"] / expected[name] for name in ("life_km_load_low", "life_km_load_high")}
    scale = {"se_load": max(1e-3, expected.get("se_load", 0.0))}
    return Row(f"{place(key)}, band", found, expected, scale, bounds=bounds)


def _bounds(relative: float, se: float, half: float) -> dict[str, float]:
    """What rounding may do where it may move the damage, and so any piece of it, by a ``relative`` part of the sum.

    A sum of 5 pieces moves by as much, and the standard error by the root of 6 x 6/5 of it, as its mean does; ``ends``
    are those of the band, relative.
    """
    of_se = 4.0 * relative * (1.0 + se)
    slope = half / se if se > 0.0 else 2.0
    return {"se_load": of_se, "dof": 20.0 * of_se / max(se, of_se, 1e-300), "ends": relative + slope * of_se}


def _error(pieces: Floats) -> float:
    """Relative standard error of one pass: 6 blocks drawn, by the spread of all that there are."""
    total = float(pieces.sum())
    if total == 0.0:
        return 0.0
    around = np.append(pieces, pieces[: IN_A_ROW - 1])
    blocks = np.convolve(around, np.ones(IN_A_ROW), mode="valid")
    count = len(pieces) / IN_A_ROW
    return float(np.sqrt(count * np.mean((blocks - blocks.mean()) ** 2) * count / (count - 1.0)) / total)


def _freedom(variances: Floats) -> float:
    """Degrees of freedom of a sum of variances that were found with 5 each."""
    largest = float(variances.max(initial=0.0))
    if largest == 0.0:
        return 5.0
    scaled = variances / largest
    return float(5.0 * scaled.sum() ** 2 / (scaled**2).sum())
