"""Rows of ``checks.parquet``."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from fatigue.life.mission import life_km
from fatigue.pipeline.checks.rows import NOT_ASSESSED, NOWHERE, NUMBERS, PLACES, TEXTS, CheckRows
from fatigue.pipeline.solve.rated_curves import RatedCurve


def check_table_rows(rows: CheckRows, curves: Mapping[str, RatedCurve]) -> dict[str, Any]:
    """Rows of ``checks.parquet``, with what follows from damage and curve."""
    columns: dict[str, Any] = {name: pa.array(_or_null(rows[name]), pa.string()) for name in TEXTS}
    columns |= {name: rows[name] for name in NUMBERS}
    columns |= {name: pa.array(rows[name], mask=rows[name] == NOWHERE) for name in PLACES}
    of_curve = [curves[name].curve if name in curves else None for name in rows["curve"].tolist()]
    counted = ~np.isnan(rows["damage_per_km"])
    life = np.where(counted, life_km(np.nan_to_num(rows["damage_per_km"]), 1.0) * rows["damage_limit"], np.nan)
    return columns | {
        "curve_status": [curve.status if curve else None for curve in of_curve],
        "edition": [curve.edition if curve else None for curve in of_curve],
        "life_km": life,
        "utilisation_damage": rows["damage_sum"] / rows["damage_limit"],
        "fulfilled": pa.array(rows["fulfilled"] == 1, mask=rows["fulfilled"] == NOT_ASSESSED),
    }


def _or_null(texts: NDArray[np.str_]) -> list[str | None]:
    return [text or None for text in texts.tolist()]
