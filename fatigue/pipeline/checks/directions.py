"""Of stresses in several directions the critical one: that with the largest damage of the whole mission.

The weighted sum over events comes first, the maximum over directions behind it: each event may have another worst
direction, and the sum of these belongs to no plane.
"""

import numpy as np
from numpy.typing import NDArray

SAME = 1e-9  # relative: what is nearer is a tie, which round-off must not break


def critical(damage: NDArray[np.float64], largest_range: NDArray[np.float64]) -> NDArray[np.intp]:
    """Number of the critical one of d directions, (n, d, ...) -> (n, ...), given their damage and largest ranges.

    Of directions with the same damage, none for instance below a cut-off, it is the one with the largest range, and of
    those with the same range the first.
    """
    worst = damage >= (1.0 - SAME) * damage.max(axis=1, keepdims=True)
    of_worst = np.where(worst, largest_range, -1.0)
    return np.asarray((of_worst >= (1.0 - SAME) * of_worst.max(axis=1, keepdims=True)).argmax(axis=1))
