"""The stress of every coordinate at the stress points of a body, read when it is needed: the table is large."""

from fatigue.errors import Problem
from fatigue.pipeline.solve.body import Body
from fatigue.readers.neutral.points.modal_stresses import PointStress, read_modal_stresses
from fatigue.readers.neutral.spare_memory import give_back


def point_stress(body: Body) -> tuple[PointStress | None, list[Problem]]:
    """Stress at the points of a body, None without points, and the warnings about its table.

    Raises
    ------
    DataError : with every mistake found in the table
    """
    if body.points is None:
        return None, []
    files = body.case.body
    assert files.modal_stresses is not None
    path = body.case.resolve(files.modal_stresses)
    found = read_modal_stresses(path, body.points, body.coordinates, files.ignore_modes, strict=body.strict)
    give_back()
    return found
