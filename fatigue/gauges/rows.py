"""What every gauge reads per unit of every coordinate of the body: the row that makes a history of its strain.

A gauge on an element gets the mean stress of the element from its corner forces, one at a stress point the stress of
the table, a stand-in at a toe the structural stress. Then all are alike: stress in a plane, a direction, a material.
Only changes are comparable with a measurement, which has no zero; a mean is never compared.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import Problem
from fatigue.gauges.gauge_file import Gauge
from fatigue.pipeline.solve.weld_groups import WeldGroups

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class GaugeRows:
    """Rows of g gauges over the c coordinates of a body, modes and behind them unit loads, in the order of the table.

    Attributes
    ----------
    gauges : as they are listed
    strain : (g, c) what the grid shows per unit of each coordinate, transverse sensitivity included [1e-6]
    stress : (g, c) normal stress of the face along the grid [MPa]
    """

    gauges: tuple[Gauge, ...]
    strain: Floats
    stress: Floats

    def __len__(self) -> int:
        """Count the gauges."""
        return len(self.gauges)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the gauges."""
        return tuple(gauge.name for gauge in self.gauges)


def gauge_rows(groups: WeldGroups, gauges: Sequence[Gauge]) -> tuple[GaugeRows, list[Problem]]:
    """Rows of some gauges on the body of these welds, and the warnings about their files.

    Raises
    ------
    DataError : every gauge that cannot be had, with the reason
    """
    raise NotImplementedError
