"""What shear would add to the equivalent range."""

import numpy as np
from numpy.typing import NDArray


def shear_factor(
    variance: NDArray[np.float64], shear_variance: NDArray[np.float64], covariance: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Factor on the equivalent range if shear counted with the normal stress, from their covariance [MPa^2] (Eq. 13).

    ASME VIII-2 5.5.5.3 combines ``sqrt(dS^2 + 3 dT^2) / F(delta)`` for a harmonic path with phase delta. In the plane
    of (sigma, sqrt(3) tau) its F is ``sqrt(l1 / (l1 + l2))`` with the principal variances l1 >= l2. It needs no phase
    and carries the rule over to random histories (an extension of the clause). Normal and shear stress are
    already divided by their own ``I(r)^(1/m)``. NaN where the normal stress does not vary.

    >>> shear_factor(np.array([1.0]), np.array([1.0 / 3.0]), np.array([0.0]))
    array([2.])
    """
    a, b, c = variance, 3.0 * shear_variance, np.sqrt(3.0) * covariance
    largest = 0.5 * (a + b) + np.sqrt(0.25 * (a - b) ** 2 + c**2)
    product = largest * a
    return np.asarray(np.divide(a + b, np.sqrt(product), out=np.full_like(a, np.nan), where=product > 0.0))
