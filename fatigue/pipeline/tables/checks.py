"""Rows of ``checks.parquet``."""

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from fatigue.life.curves import SHIPPED
from fatigue.life.endurance.haigh import EnduranceLine
from fatigue.life.mission import life_km
from fatigue.pipeline.checks.rows import NOT_ASSESSED, NOWHERE, NUMBERS, PLACES, TEXTS, CheckRows
from fatigue.pipeline.solve.rated.rated_curves import RatedCurve

NO_LINES: Mapping[str, EnduranceLine] = MappingProxyType({})
WEAKER = ("verified", SHIPPED, "user", "unverified")  # what the numbers of a curve rest on, the weakest last


def check_table_rows(
    rows: CheckRows, curves: Mapping[str, RatedCurve], lines: Mapping[str, EnduranceLine] = NO_LINES
) -> dict[str, Any]:
    """Rows of ``checks.parquet``, with what follows from damage, curve and endurance line."""
    columns: dict[str, Any] = {name: pa.array(_or_null(rows[name]), pa.string()) for name in TEXTS}
    columns |= {name: rows[name] for name in NUMBERS}
    columns |= {name: pa.array(rows[name], mask=rows[name] == NOWHERE) for name in PLACES}
    known = {name: (line.edition, "user") for name, line in lines.items()}
    known |= {name: (rated.curve.edition, rated.curve.status) for name, rated in curves.items()}
    origin = {name: _origin(name, known) for name in np.unique(rows["curve"]).tolist()}
    of_curve = [origin[name] for name in rows["curve"].tolist()]
    counted = ~np.isnan(rows["damage_per_km"])
    life = np.where(counted, life_km(np.nan_to_num(rows["damage_per_km"]), 1.0) * rows["damage_limit"], np.nan)
    return columns | {
        "curve_status": [status for _, status in of_curve],
        "edition": [edition for edition, _ in of_curve],
        "life_km": life,
        "utilisation_damage": rows["damage_sum"] / rows["damage_limit"],
        "fulfilled": pa.array(rows["fulfilled"] == 1, mask=rows["fulfilled"] == NOT_ASSESSED),
    }


def _origin(name: str, known: Mapping[str, tuple[str, str]]) -> tuple[str | None, str | None]:
    """Edition and status of a curve or line, of several joined by ' + ' all editions and the weakest status."""
    names = [name] if name in known else name.split(" + ")
    if not set(names) <= known.keys():
        return None, None
    editions = dict.fromkeys(known[one][0] for one in names if known[one][0])
    status = max((known[one][1] for one in names), key=WEAKER.index)
    return " + ".join(editions) or None, status


def _or_null(texts: NDArray[np.str_]) -> list[str | None]:
    return [text or None for text in texts.tolist()]
