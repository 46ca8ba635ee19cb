"""In which precision cycles are counted, and which jobs are large: by the number of stress samples alone."""

from collections.abc import Sequence
from typing import Literal

Precision = Literal["auto", "double"]
"""``auto``: single precision from ``SINGLE_FROM`` on, within 1e-6 of the damage; ``double``: whatever the size."""

SINGLE_FROM = 3e7
"""Stress samples of a job, both faces, from which on single precision pays.

Below it saves a third of a second at most, and its loops take 12 s to compile in the first run on a machine.
"""

LARGE_FROM = 5e9
"""Stress samples of a job, both faces, from which on points are screened and few cycles kept by default."""


def stress_samples(stations: int, samples: Sequence[int]) -> float:
    """Stress values of both faces of all stations, over events of so many samples as they are counted."""
    return 2.0 * stations * sum(samples)


def counts_single(stations: int, samples: Sequence[int], precision: Precision) -> bool:
    """Whether cycles of a job are counted in single precision, where its law and records allow it."""
    return precision == "auto" and stress_samples(stations, samples) > SINGLE_FROM


def is_large(stations: int, samples: Sequence[int]) -> bool:
    """Whether a job is so large that its points are screened by default."""
    return stress_samples(stations, samples) > LARGE_FROM
