"""Quality data of the welds in ``welds.parquet``: what is given for each, and the category of its stress."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from fatigue.life.quality import StressCategories
from fatigue.readers.neutral.body.welds import QUALITY, Weld


def quality_rows(
    welds: Sequence[Weld], load_factor: ArrayLike, of_checks: ArrayLike | None, categories: StressCategories
) -> dict[str, Any]:
    """Columns of the quality data.

    ``load_factor`` (w,) is that of the welds' toes, NaN where there is none; ``of_checks`` (w,) the largest stress
    utilisation of their other checks, NaN where nothing else is checked, None: nowhere.
    """
    factor = np.asarray(load_factor, np.float64)
    with np.errstate(divide="ignore"):
        utilisation = 1.0 / factor  # of an infinite one: 0
    if of_checks is not None:
        utilisation = np.fmax(utilisation, np.asarray(of_checks, np.float64))
    return {
        **{name: [getattr(weld, name) or None for weld in welds] for name in QUALITY},
        "stress_utilisation": utilisation,
        "stress_category": categories.of(utilisation),
    }
