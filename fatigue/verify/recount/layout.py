"""Where the points of a body are: the key of every station in the order of the results, and the way back from a key."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

FACES = ("top", "bottom")
Key = tuple[str, int, int, str]  # weld, part, order, surface


@dataclass(frozen=True, slots=True, eq=False)
class Layout:
    """The stations of a body: welds as in their table, their parts, nodes along each part.

    Every station has two points, top before bottom; point 2 n and 2 n + 1 belong to station n.

    Attributes
    ----------
    welds : names
    weld : (n,) index into the names, ascending
    part, order : (n,) the rest of the key of each station
    """

    welds: tuple[str, ...]
    weld: NDArray[np.int32]
    part: NDArray[np.int64]
    order: NDArray[np.int64]

    def __len__(self) -> int:
        """Number of stations."""
        return len(self.weld)

    @property
    def points(self) -> int:
        """Number of points."""
        return 2 * len(self)

    @property
    def first(self) -> NDArray[np.int64]:
        """First station of every weld and, last, the number of stations, (w + 1,)."""
        return np.searchsorted(self.weld, np.arange(len(self.welds) + 1)).astype(np.int64)

    def station(self, number: int) -> tuple[str, int, int]:
        """Key of a station."""
        return self.welds[self.weld[number]], int(self.part[number]), int(self.order[number])

    def key(self, point: int) -> Key:
        """Key of a point."""
        return *self.station(point // 2), FACES[point % 2]


def station_finder(body: Layout) -> Callable[[NDArray[Any], NDArray[Any], NDArray[Any]], NDArray[np.int64]]:
    """Function that finds stations by index of the weld, part and order, (r,) each; -1 where there is none."""
    parts, orders = np.unique(body.part), np.unique(body.order)

    def code(weld: NDArray[Any], part: NDArray[Any], order: NDArray[Any]) -> NDArray[np.int64]:
        part_at, order_at = np.searchsorted(parts, part), np.searchsorted(orders, order)
        return np.asarray((weld.astype(np.int64) * len(parts) + part_at) * len(orders) + order_at)

    codes = code(body.weld, body.part, body.order)
    ascending = np.argsort(codes, kind="stable")
    codes = codes[ascending]

    def find(weld: NDArray[Any], part: NDArray[Any], order: NDArray[Any]) -> NDArray[np.int64]:
        at = np.searchsorted(codes, code(weld, part, order)).clip(max=len(codes) - 1)
        station = ascending[at]
        same = (body.weld[station] == weld) & (body.part[station] == part) & (body.order[station] == order)
        return np.where(same, station, -1)

    return find
