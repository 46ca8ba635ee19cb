"""Whether a displacement belongs to another node: the sum of the modes at every node that has mode shapes."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from fatigue.readers.convert.displacement.causes import EXPLAINED, Cause
from fatigue.readers.convert.displacement.comparison import Comparison

_AT_ONCE = 5000  # nodes whose shapes stand in memory together
_ASKED = ("fit", "factor", "mode factor")  # causes that a wrong node passes for


def with_other_node(
    causes: tuple[Cause, ...],
    comparison: Comparison,
    own: int,
    node: NDArray[np.int64],
    shapes: Callable[[NDArray[np.int64]], NDArray[np.float64]],
) -> tuple[Cause, ...]:
    """Causes that a wrong node passes for, and the node whose displacement it is.

    Factors fitted to all modes can imitate any node; they are no cause where a node explains the displacement.

    Parameters
    ----------
    own : the node that is named; node : (n,) all that have shapes
    shapes : displacements (M, k, 3) of the nodes at some positions [mm per unit modal coordinate], basic frame
    """
    if any(cause.kind not in _ASKED for cause in causes):
        return causes
    others = np.flatnonzero(node != own)
    blocks = [others[k : k + _AT_ONCE] for k in range(0, others.size, _AT_ONCE)]
    number, axis = comparison.number, comparison.direction
    misfits = [comparison.misfit(shapes(block)[number, :, axis].T) for block in blocks]
    if not misfits:
        return causes
    misfit = np.concatenate(misfits)
    best = int(misfit.argmin())
    base = float(comparison.misfit(comparison.weight))
    least = min([cause.misfit for cause in causes if cause.kind != "fit"], default=EXPLAINED)
    if misfit[best] > min(EXPLAINED, base / 2, max(2 * least, least + 0.01)):
        return causes
    alike = int(np.count_nonzero(misfit <= max(2 * misfit[best], misfit[best] + 0.01))) - 1
    more = f", or of {alike} more that move alike" if alike else ""
    text = f"it is the displacement of node {node[others[best]]}{more}"
    found = Cause("node", float(misfit[best]), text, "Name the node of the FE model that the simulation's marker is at")
    return (*(cause for cause in causes if cause.kind != "fit"), found)
