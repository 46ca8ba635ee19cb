"""What the columns of a solid weld are checked by: where they stand, how far they reach, how straight they are."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.weld.line import Vectors
from fatigue.weld.line_geometry import unit
from fatigue.weld.solid.columns import Columns


@dataclass(frozen=True, slots=True, eq=False)
class ColumnShape:
    """The shape of n columns of two nodes or more, against what their stations say.

    Attributes
    ----------
    reach : (n,) distance of the two outer nodes along the normal [mm]
    off_mid : (n,) distance of the station from the middle between the outer nodes [mm]
    off_outer : (n,) distance of the station from the nearer outer node [mm]
    lean_deg : (n,) angle between the normal and the line through the outer nodes, 0 to 90 [degrees]
    bow : (n,) largest distance of a node from that line [mm]
    top : (n,) node on the side to which the normal points
    """

    reach: NDArray[np.float64]
    off_mid: NDArray[np.float64]
    off_outer: NDArray[np.float64]
    lean_deg: NDArray[np.float64]
    bow: NDArray[np.float64]
    top: NDArray[np.int64]


def column_shape(columns: Columns, mid: Vectors, normal: Vectors) -> ColumnShape:
    """Shape of columns whose stations are at ``mid`` with a plate ``normal``, (n, 3) each; nodes in any order."""
    station, start = columns.station, columns.begin[:-1]
    z = unit(normal)
    height = np.sum((columns.xyz - mid[station]) * z[station], axis=1)
    by_height = np.lexsort((height, station))
    low, high = columns.xyz[by_height[start]], columns.xyz[by_height[columns.begin[1:] - 1]]
    chord = high - low
    length = np.linalg.norm(chord, axis=1)
    along = chord / np.where(length > 0, length, 1.0)[:, np.newaxis]
    reach = np.sum(chord * z, axis=1)
    from_low = columns.xyz - low[station]
    aside = from_low - np.sum(from_low * along[station], axis=1)[:, np.newaxis] * along[station]
    cosine = np.clip(np.abs(np.sum(along * z, axis=1)), 0.0, 1.0)
    return ColumnShape(
        reach=reach,
        off_mid=np.linalg.norm((low + high) / 2 - mid, axis=1),
        off_outer=np.minimum(np.linalg.norm(low - mid, axis=1), np.linalg.norm(high - mid, axis=1)),
        lean_deg=np.degrees(np.arccos(cosine)),
        bow=np.maximum.reduceat(np.linalg.norm(aside, axis=1), start),
        top=columns.node[by_height[columns.begin[1:] - 1]],
    )
