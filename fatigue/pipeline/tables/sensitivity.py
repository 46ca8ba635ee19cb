"""Rows of ``sensitivity.parquet``: every weld under other assumptions, one at a time."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import pyarrow as pa

from fatigue.pipeline.count.result import GroupResult
from fatigue.pipeline.count.worst import WorstPoint
from fatigue.pipeline.sensitivity.group import FIELDS, variants_of
from fatigue.pipeline.sensitivity.notes import NOTES
from fatigue.pipeline.sensitivity.sampling import OtherSampling
from fatigue.pipeline.sensitivity.worst import NOWHERE, OPEN
from fatigue.pipeline.solve.model import Model
from fatigue.pipeline.tables.rows import FACES
from fatigue.results import coded
from fatigue.results.dictionary.sensitivity import BASES


def sensitivity_rows(
    model: Model, result: GroupResult, worst: Sequence[WorstPoint], sampling: OtherSampling
) -> dict[str, Any]:
    """Rows of the welds of a group, weld by weld in the order of the variants; ``worst`` are their worst points."""
    variants, stations = variants_of(model.case, sampling), model.stations
    of_welds = result.sensitivity.transpose(1, 0, 2).reshape(-1, len(FIELDS))
    utilisation, fulfilled, station, face, basis, recounted, note = of_welds.T
    at = station.astype(np.int64)
    nowhere = at == NOWHERE
    assessed = np.array([result.mission.utilisation[p.station, p.face] <= 1.0 for p in worst])
    is_open = fulfilled == OPEN
    flips = ~is_open & ((fulfilled == 1) != np.repeat(assessed, len(variants)))
    of_station = {name: pa.array(getattr(stations, name)[at], mask=nowhere) for name in ("part", "node", "order")}
    return {
        "variant": coded(np.tile(np.arange(len(variants)), len(worst)), variants),
        "weld": coded(np.repeat(np.arange(len(worst)), len(variants)), stations.names),
        **of_station,
        "surface": coded(np.where(nowhere, -1, face).astype(np.int64), FACES),
        "utilisation": utilisation.copy(),
        "fulfilled": pa.array(fulfilled == 1, mask=is_open),
        "flips": flips,
        "basis": coded(basis.astype(np.int64), BASES),
        "recounted": recounted.astype(np.int64),
        "note": coded(note.astype(np.int64), NOTES),
    }
