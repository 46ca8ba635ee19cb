"""What is said of a gauge: a word from its equivalent range ratio, or why there is none; and of all gauges together."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

GOOD, FAIR, POOR, SIGN, DATA, NOT_ALIGNABLE = "good", "fair", "poor", "sign", "data", "not_alignable"
JUDGED = (GOOD, FAIR, POOR)
SUSPECT = (POOR, SIGN)  # exit code 1

FEWEST_KEPT = 0.90
GOOD_RATIO, FAIR_RATIO = (0.9, 1.1), (0.8, 1.25)
SIGN_CORRELATION, LEAST_CORRELATION = -0.5, 0.7

YARDSTICK = (
    "Yardstick from the literature: rig against line damage of C80 wagons -16 to +27 %, which is an equivalent range "
    "ratio of 0.95 to 1.07 at k 3.6."
)


def verdict(equivalent_range_ratio: float, kept_share: float, correlation: float | None) -> str:
    """Word for a gauge (measured_data 2.5); ``correlation`` is that of aligned records, None: they are not.

    >>> verdict(1.05, 1.0, None), verdict(1.2, 1.0, 0.9), verdict(1.0, 1.0, -0.98), verdict(1.0, 0.8, None)
    ('good', 'fair', 'sign', 'data')
    """
    if not kept_share >= FEWEST_KEPT or np.isnan(equivalent_range_ratio):
        return DATA
    if correlation is not None and not correlation >= LEAST_CORRELATION:
        return SIGN if correlation < SIGN_CORRELATION else NOT_ALIGNABLE
    for word, (low, high) in ((GOOD, GOOD_RATIO), (FAIR, FAIR_RATIO)):
        if low <= equivalent_range_ratio <= high:
            return word
    return POOR


@dataclass(frozen=True, slots=True)
class CaseLine:
    """Damage ratio over the gauges that were judged: their number, geometric mean, and sd of the natural logarithm."""

    gauges: int
    damage_ratio: float
    log_sd: float


def case_line(damage_ratios: Sequence[float]) -> CaseLine:
    """Line of all gauges from the damage ratios of those that were judged; NaN where there are too few.

    >>> found = case_line([2.0, 0.5])
    >>> found.damage_ratio, round(found.log_sd, 4)
    (1.0, 0.9803)
    """
    logs = np.log([ratio for ratio in damage_ratios if 0.0 < ratio < np.inf])
    mean = float(np.exp(logs.mean())) if logs.size else np.nan
    return CaseLine(int(logs.size), mean, float(logs.std(ddof=1)) if logs.size > 1 else np.nan)
