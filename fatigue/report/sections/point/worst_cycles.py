"""The cycles that damage a point most."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

OF_CYCLES = ("event", "start_s", "end_s", "count", "damage")


def most_damaging(cycles: pd.DataFrame, event: str | None, most: int) -> Sequence[tuple[float, float]]:
    """Instants of the most damaging cycles of an event [s], the worst first; none where its cycles are not kept.

    ``cycles`` has the columns ``OF_CYCLES`` of the table of cycles.
    """
    cycles = cycles[cycles["event"] == event]
    each = (cycles["damage"] / cycles["count"]).to_numpy()
    worst = cycles.iloc[np.argsort(-each, kind="stable")[:most]]
    return [(float(start), float(end)) for start, end in zip(worst["start_s"], worst["end_s"], strict=True)]
