"""What makes the worst point of a weld, and so its verdict, doubtful."""

from collections.abc import Sequence

from fatigue.errors import Problem
from fatigue.pipeline.count.mission_block import MissionBlock
from fatigue.pipeline.count.worst import WorstPoint
from fatigue.pipeline.solve.model import Model
from fatigue.pipeline.tables.rows import FACES
from fatigue.weld.warnings.summed_corners import REMEDY


def worst_at_corners(model: Model, mission: MissionBlock, worst: Sequence[WorstPoint]) -> list[Problem]:
    """Warning of each weld whose worst point is at a corner where the nodal forces of both legs are one sum."""
    stations = model.stations
    return [
        Problem(
            "worst_at_corner",
            f"weld {stations.names[point.weld]}, node {stations.node[point.station]}, {FACES[point.face]} face",
            f"the worst point of the weld is at a corner where its nodal forces are summed over both legs, so its life "
            f"of {mission.life_km[point.station, point.face]:.4g} km is no lower bound",
            REMEDY,
        )
        for point in worst
        if stations.summed_corner[point.station]
    ]
