"""A polyline in space: lengths along it, and how far points are from it."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Vectors = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Polyline:
    """Points in order; a closed one goes back to its first point, which it does not repeat.

    Attributes
    ----------
    points : (p, 3) [mm]
    closed : whether it is closed
    """

    points: Vectors
    closed: bool = False

    @property
    def chain(self) -> Vectors:
        """Points, the first one again at the end of a closed polyline."""
        return np.concatenate([self.points, self.points[:1]]) if self.closed else self.points

    @property
    def at(self) -> NDArray[np.float64]:
        """Length along the polyline at each point of the chain [mm]."""
        steps = np.linalg.norm(np.diff(self.chain, axis=0), axis=1)
        return np.concatenate([[0.0], np.cumsum(steps)])

    def point(self, s: float) -> Vectors:
        """Place at a length along the polyline, (3,)."""
        return np.asarray(self.places(np.array([s]))[0])

    def places(self, s: NDArray[np.float64]) -> Vectors:
        """Places at some lengths along the polyline, (n, 3)."""
        at, chain = self.at, self.chain
        return np.column_stack([np.interp(s, at, chain[:, axis]) for axis in range(3)])

    def turned_deg(self, first: float, last: float) -> float:
        """Angle between the directions of the polyline at two lengths along it [deg]."""
        steps = np.diff(self.chain, axis=0)
        at = np.clip(np.searchsorted(self.at, [first, last], side="right") - 1, 0, len(steps) - 1)
        a, b = steps[at]
        cosine = float(a @ b) / max(float(np.linalg.norm(a) * np.linalg.norm(b)), 1e-300)
        return float(np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))))

    def between(self, first: float, last: float) -> "Polyline":
        """Stretch between two lengths along an open polyline, or along the chain of a closed one."""
        at = self.at
        inside = (at > first) & (at < last)
        points = np.concatenate([self.point(first)[None], self.chain[inside], self.point(last)[None]])
        return Polyline(points)

    def nearest(self, places: Vectors) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Distance (n,) of places (n, 3) from the polyline, and the length along it where each is nearest [mm]."""
        chain, at = self.chain, self.at
        best = np.full(len(places), np.inf)
        along = np.zeros(len(places))
        for k in range(len(chain) - 1):
            a, step = chain[k], chain[k + 1] - chain[k]
            size = float(step @ step)
            t = np.clip((places - a) @ step / size, 0.0, 1.0) if size > 0.0 else np.zeros(len(places))
            distance = np.linalg.norm(places - a - t[:, None] * step, axis=1)
            closer = distance < best
            best[closer] = distance[closer]
            along[closer] = at[k] + t[closer] * np.sqrt(size)
        return best, along

    def corners(self, least_deg: float) -> list[int]:
        """Positions of the points where the polyline turns by more than an angle."""
        steps = np.diff(self.chain, axis=0)
        size = np.linalg.norm(steps, axis=1)
        unit = steps / np.where(size > 0.0, size, 1.0)[:, None]
        count = len(self.points)
        inner = range(count) if self.closed else range(1, count - 1)
        cosine = np.cos(np.radians(least_deg))
        return [k for k in inner if unit[k - 1] @ unit[k % len(unit)] < cosine]
