"""Time and frequency domain at all points of a result: how far they agree, and the points that are drawn."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.report.figures import drawn_points
from fatigue.results import read_codes, read_rows, read_table

_NUMBERS = ("life_km_same_ratio", "life_km_dirlik", "dirlik_ratio")


@dataclass(frozen=True, slots=True, eq=False)
class Domains:
    """What is shown of both domains.

    Attributes
    ----------
    ratio : (k,) damage by Dirlik / by rainflow at the same bending ratio, of all points where both damage and there is
        a life by both
    verdicts : how many points have which verdict, most first
    drawn : rows of the table of nodes, all or of very many points a part, with the kurtosis of the stress in the
        governing event of each
    """

    ratio: NDArray[np.float64]
    verdicts: tuple[tuple[str, int], ...]
    drawn: pd.DataFrame


def read_domains(folder: Path, events: Sequence[str]) -> Domains:
    """What is shown of both domains, read; ``events`` are the events of the mission in its order.

    Raises
    ------
    DataError : no finished result there, or a table is damaged
    """
    codes, names = read_codes(folder, "nodes", "dirlik_verdict")
    points = read_table(folder, "nodes", _NUMBERS).to_pandas()
    points["dirlik_verdict"] = pd.Categorical.from_codes(codes, names)
    ratio = points["dirlik_ratio"].to_numpy()
    used, first, count = np.unique(codes, return_index=True, return_counts=True)
    most_first = np.lexsort((first, -count))

    rows = np.flatnonzero(drawn_points(points))
    drawn = read_rows(
        folder, "nodes", rows, ["weld", "node", "surface", "governing_event", "dirlik_verdict", *_NUMBERS]
    )
    return Domains(
        ratio=ratio[np.isfinite(ratio) & (ratio > 0.0) & ~np.isnan(points["life_km_dirlik"].to_numpy())],
        verdicts=tuple((names[used[i]], int(count[i])) for i in most_first),
        drawn=_with_kurtosis(drawn.to_pandas(), rows, folder, events),
    )


def _with_kurtosis(drawn: pd.DataFrame, rows: NDArray[np.int64], folder: Path, events: Sequence[str]) -> pd.DataFrame:
    """Points with the kurtosis of the stress in the governing event of each; NaN where nothing damages.

    The table of damage lists all events of every point in the order of the table of nodes.
    """
    event = pd.Index(events).get_indexer(drawn["governing_event"])
    known = event >= 0
    kurtosis = np.full(len(drawn), np.nan)
    table = read_rows(folder, "damage", rows[known] * len(events) + event[known], ["kurtosis"])
    kurtosis[known] = table["kurtosis"].to_numpy()
    return drawn.assign(kurtosis=kurtosis)
