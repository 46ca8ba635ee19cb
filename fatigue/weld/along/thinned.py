"""A weld line as few points in space: its ends, its corners, and as many between as it takes to stay near it."""

import numpy as np
from numpy.typing import NDArray

from fatigue.weld.along.polyline import Polyline

NEAR = 0.05  # of the mean edge: no node is further from the points


def thinned(xyz: NDArray[np.float64], *, closed: bool) -> Polyline:
    """Polyline of some of the nodes (n, 3) of a line, mid-side nodes among them on curved edges (Douglas, Peucker)."""
    around = np.concatenate([xyz, xyz[:1]]) if closed else xyz
    edge = float(np.linalg.norm(np.diff(around, axis=0), axis=1).mean())
    if not closed:
        return Polyline(xyz[_kept(xyz, NEAR * edge)])
    half = int(np.linalg.norm(xyz - xyz[0], axis=1).argmax())  # two stretches that are no point
    first, second = _kept(around[: half + 1], NEAR * edge), _kept(around[half:], NEAR * edge)
    kept = [*first, *(half + k for k in second[1:-1])]
    if len(kept) < 3:
        kept = sorted({0, half // 2, half, (half + len(xyz)) // 2})
    return Polyline(xyz[kept], closed=True)


def _kept(points: NDArray[np.float64], near: float) -> list[int]:
    """Positions of the points to keep, so that the others stay near the polyline of these."""
    if len(points) < 3:
        return list(range(len(points)))
    distance, _ = Polyline(points[[0, -1]]).nearest(points)
    far = int(distance.argmax())
    if distance[far] <= near:
        return [0, len(points) - 1]
    return [*_kept(points[: far + 1], near), *(far + k for k in _kept(points[far:], near)[1:])]
