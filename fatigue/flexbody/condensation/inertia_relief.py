"""Static answer of a free body: loads are balanced by the inertia of the rigid motion that they cause."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.linalg import SuperLU

from fatigue.flexbody.condensation.factored import factored, solved
from fatigue.flexbody.condensation.rigid import determinate_support, rigid_modes
from fatigue.flexbody.structure import Structure

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class FreeBody:
    """A free structure ready to be loaded: its rigid motions X_r (n, r), and K factored with some rows held."""

    structure: Structure
    rigid: Floats
    free: NDArray[np.bool_]
    factors: SuperLU

    def answer(self, F: Floats) -> Floats:
        """Elastic displacement (n, c) or (n,) under forces of the same shape, orthogonal to rigid motion by mass.

        ``P' K^+ P F`` with ``P = I - M X_r X_r'``: loads and the inertia forces that balance them, K solved with any
        statically determinate support, and the rigid motion taken out of the answer (inertia relief). The support
        bears nothing, and so it makes no difference where it is.

        Source: Craig and Chang 1977; ``P`` is symmetric under the mass matrix.
        """
        X_r, M = self.rigid, self.structure.M
        balanced = F - M @ (X_r @ (X_r.T @ F))
        X = np.zeros_like(balanced)
        X[self.free] = solved(self.factors, balanced[self.free])
        return np.asarray(X - X_r @ (X_r.T @ (M @ X)))


def free_body(structure: Structure, support: Sequence[int] | None = None) -> FreeBody:
    """A structure with its rigid motions, held at ``support``: as many rows as rigid motions, determinate.

    Raises
    ------
    NumericalError : the structure is not free, or the support does not hold it
    """
    rigid = rigid_modes(structure)
    held = determinate_support(structure, rigid) if support is None else np.asarray(support)
    free = np.ones(len(structure.node), dtype=bool)
    free[held] = False
    return FreeBody(structure, rigid, free, factored(structure.K[free][:, free]))
