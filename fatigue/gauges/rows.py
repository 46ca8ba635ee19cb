"""What every gauge reads per unit of every coordinate of the body: the row that makes a history of its strain.

A gauge on an element gets the mean stress of the element from its corner forces, one at a stress point the stress of
the table, a stand-in at a toe the structural stress. Then all are alike: stress in a plane, a direction, a material.
Only changes are comparable with a measurement, which has no zero of its own.
"""

from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np

from fatigue.errors import DataError, Problem, refuse
from fatigue.gauges.gauge_file import ELEMENT, TABLE, TOE, Gauge
from fatigue.gauges.grid import Grid, grid_at_point, grid_at_toe
from fatigue.gauges.instrument import Floats
from fatigue.gauges.material import Properties, read_properties
from fatigue.gauges.on_element import Plates, grid_on_element, read_plates
from fatigue.gauges.table_row import at_point
from fatigue.gauges.toe_row import at_toe
from fatigue.pipeline.solve.model import Model, solve_group
from fatigue.pipeline.solve.point_stress import point_stress
from fatigue.pipeline.solve.weld_groups import WeldGroups


@dataclass(frozen=True, slots=True, eq=False)
class GaugeRows:
    """Rows of g gauges over the c coordinates of a body, modes and behind them unit loads, in the order of the table.

    Attributes
    ----------
    gauges : as they are listed
    grids : where each sits, and the stress under it
    strain : (g, c) what the grid shows per unit of each coordinate, transverse sensitivity included [ue]
    stress : (g, c) normal stress of the face along the grid [MPa]
    plates : the shells and their forces; None where no gauge is on an element
    """

    gauges: tuple[Gauge, ...]
    grids: tuple[Grid, ...]
    strain: Floats
    stress: Floats
    plates: Plates | None = None

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
    body, kinds = groups.body, {gauge.kind for gauge in gauges}
    properties, warnings = _properties(groups)
    plates, of_plates = read_plates(body, properties) if ELEMENT in kinds else (None, [])
    stress, of_stress = point_stress(body) if TABLE in kinds else (None, [])
    models = _models(groups, {gauge.weld for gauge in gauges if gauge.kind == TOE})
    warnings += of_plates + of_stress

    def grid_of(gauge: Gauge) -> Grid:
        if gauge.kind == TOE:
            return grid_at_toe(gauge, at_toe(gauge, models), properties)
        if gauge.kind == TABLE:
            return grid_at_point(gauge, at_point(gauge, body.points, stress, body.case.path.name), properties)
        assert plates is not None
        return grid_on_element(gauge, plates)

    grids: list[Grid] = []
    problems: list[Problem] = []
    for gauge in gauges:
        try:
            grids.append(grid_of(gauge))
        except DataError as error:
            problems += error.problems
    refuse(DataError, problems)
    warnings += [doubt for grid in grids for doubt in grid.doubts]
    strain, stress_along = (np.stack([of(grid) for grid in grids]) for of in (Grid.strain, Grid.along))
    return GaugeRows(tuple(gauges), tuple(grids), strain, stress_along, plates), warnings


def _properties(groups: WeldGroups) -> tuple[Properties, list[Problem]]:
    """The table of properties of the case; nothing where it names none."""
    case = groups.body.case
    if case.body.properties is None:
        return Properties(), []
    return read_properties(case.resolve(case.body.properties), strict=groups.body.strict)


def _models(groups: WeldGroups, welds: Collection[str]) -> dict[str, Model]:
    """The groups in which some welds are solved, by the names of these welds; unknown ones are left out."""
    names = groups.body.welds
    wanted = [{weld.name for weld in names[some]}.intersection(welds) for some in groups.groups]
    solved = [(own, solve_group(groups, number)) for number, own in enumerate(wanted) if own]
    return {weld: model for own, model in solved for weld in own}
