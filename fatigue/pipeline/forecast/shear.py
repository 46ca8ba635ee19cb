"""What shear at the toes will take: points whose paths are counted, time and memory."""

from collections.abc import Sequence

from fatigue.pipeline.multiaxial.counted import LONG_PATH, LONGEST_PATH
from fatigue.pipeline.multiaxial.found import MODELS

LEFT = 0.05  # of the points: neither a bound nor the normal stress settles them
HIGHLY_USED = 0.05  # of the worst points of a large job, which are counted from a tenth of the limit on
PATH = 1.0e-6  # processor time [s] of each sample of a path,
PATH_MODE = 1.6e-9  # for each mode: four stresses
UNDECIDED = 0.25  # of the points: bounds leave open whether their shear is above a third of the normal stress
SHEAR_MODE = 0.15e-9  # [s] for each sample and mode of these, in single precision
BYTES = 250.0  # of each sample of a path, while it is counted


def counted_paths(method: str, welds: int, stations: int, *, screened: bool) -> float:
    """Points whose paths are counted, as far as can be told before anything is."""
    if method == "off":
        return 0.0
    if method in MODELS:
        return 2.0 * stations
    share = 0.02 if screened else LEFT
    return min(2.0 * stations, welds * (HIGHLY_USED if screened else 1.0) + share * 2.0 * stations)


def shear_seconds(
    method: str, welds: int, stations: int, modes: int, samples: Sequence[int], *, screened: bool
) -> float:
    """Processor time [s] of shear in records of so many samples as they are counted."""
    if method == "off":
        return 0.0
    paths = counted_paths(method, welds, stations, screened=screened)
    undecided = UNDECIDED * 2.0 * stations * (0.3 if screened else 1.0)
    return sum(samples) * (paths * (PATH + PATH_MODE * modes) + undecided * SHEAR_MODE * modes)


def path_memory(method: str, samples: Sequence[int], threads: int) -> float:
    """Memory [bytes] for the paths that threads count side by side; of long records one at a time is counted."""
    if method == "off":
        return 0.0
    longest = min(max(samples), LONGEST_PATH)
    return BYTES * (longest + (threads - 1) * min(longest, LONG_PATH))
