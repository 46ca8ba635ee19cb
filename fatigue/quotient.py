"""Division where the divisor may be nothing: a ratio that cannot be had is NaN, never an error or a made-up 0."""

import numpy as np
from numpy.typing import NDArray


def quotient(a: NDArray[np.float64] | float, b: NDArray[np.float64]) -> NDArray[np.float64]:
    """Divide ``a / b`` element by element, broadcast together; NaN where ``b`` is not above 0."""
    return np.asarray(np.divide(a, b, out=np.full(np.broadcast(a, b).shape, np.nan), where=b > 0.0))
