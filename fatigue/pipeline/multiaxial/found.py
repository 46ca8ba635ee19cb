"""What is kept of shear at every point of a group of welds, as one array, and the words of its codes."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

Found = NDArray[Any]

FACES = ("top", "bottom")
STATUSES = ("settled_fails", "settled_passes", "fails", "counted")
VERDICTS = ("passes", "fails", "model_dependent", "settled_passes", "settled_fails")
NULL = -1  # of a code: not known, or not looked at
MODELS = ("range", "length", "mlp")  # of the path counter
NUMBERS = ("bound", *MODELS, "asme", "path_factor", "path_moment", "range_MPa", "normal")

_POINT = np.dtype(
    [*((name, np.float64) for name in NUMBERS), ("event", np.int64)]
    + [(name, np.int8) for name in ("shear_required", "status", "verdict")]
)


def nothing_found(shape: tuple[int, ...]) -> Found:
    """So many points of which nothing is known.

    ``bound``, ``range``, ``length``, ``mlp``, ``asme`` and ``normal`` are Miner sums at the target over the limit,
    cycles across events included, the last by normal stress alone; ``bound`` is T1. ``path_factor`` and
    ``path_moment`` are of the half cycle with the largest range, ``range_MPa``. ``event`` has the largest share of the
    sum by range. The others are codes: 0 or 1, of ``STATUSES`` and of ``VERDICTS``.
    """
    found = np.zeros(shape, _POINT)
    for name in _POINT.names or ():
        found[name] = np.nan if name in NUMBERS else NULL
    return found


def verdicts(found: Found) -> NDArray[np.int8]:
    """Verdict of every point by its status, and by the numbers where the counter ran."""
    status, code = found["status"], {name: number for number, name in enumerate(VERDICTS)}
    with np.errstate(invalid="ignore"):  # NaN is not above 1
        others = np.any([found[name] > 1.0 for name in ("length", "mlp", "asme")], axis=0)
        fails = found["range"] > 1.0
    by_numbers = np.select([fails, others], [code["fails"], code["model_dependent"]], code["passes"])
    settled = np.select(
        [status == STATUSES.index("settled_passes"), status == STATUSES.index("fails")],
        [code["settled_passes"], code["fails"]],
        NULL,
    )
    verdict = np.where(np.isnan(found["range"]), settled, by_numbers)
    return np.where(status == STATUSES.index("settled_fails"), code["settled_fails"], verdict).astype(np.int8)
