"""An elastic displacement of the simulation against mode shapes times modal coordinates: one row of the audit.

One node, one direction and one record prove which coordinate belongs to which mode, the signs of the modes, their scale
and the units, in one stroke: u(t) = sum_k phi_k q_k(t). Sign flips of modes between FE runs show nowhere else.
"""

from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import CaseError, DataError, Problem
from fatigue.readers.convert.audit.row import AuditRow
from fatigue.readers.convert.displacement.nodes import with_other_node
from fatigue.readers.convert.displacement.record import DisplacementRecord
from fatigue.readers.convert.displacement.side_by_side import causes_of, compared
from fatigue.readers.convert.displacement.verdict import CHECK, judged
from fatigue.readers.convert.modal_basis import coordinate_units
from fatigue.readers.convert.options import Displacement
from fatigue.readers.foreign.fe.model import FeModel, to_basic
from fatigue.readers.foreign.fe.results import FeResults
from fatigue.readers.foreign.histories.foreign_history import ForeignHistory
from fatigue.readers.neutral.body.modes import LOWEST_HZ
from fatigue.readers.units.systems import Normalisation, UnitSystem

Floats = NDArray[np.float64]

_NOISE = 0.01  # misfit below which no cause is looked for


@dataclass(frozen=True, slots=True, eq=False)
class ModalSum:
    """Mode shapes and modal coordinates, whose sum a displacement is compared with.

    Attributes
    ----------
    results, model : as read, in the file's own units and displacement frames
    histories : modal coordinates of the events on uniform times, with the modes of ``results``
    scale : (m,) factor on the coordinates of each mode of the FE run, where the simulation normalises differently
    units, history_units, normalisation : of the force file, of the coordinates, and of the modes
    """

    results: FeResults
    model: FeModel
    histories: Sequence[ForeignHistory]
    scale: Floats
    units: UnitSystem
    history_units: UnitSystem
    normalisation: Normalisation

    @property
    def shape_factor(self) -> Floats:
        """Factor on each mode's shape, (m,), besides that of its length; the simulation's coordinates go with it."""
        return np.asarray(self.scale / coordinate_units(self.results, self.units, self.normalisation))

    @property
    def coordinate_factor(self) -> Floats:
        """Factor on each mode's coordinates as the files have them, (m,)."""
        return coordinate_units(self.results, self.history_units, self.normalisation)


def displacement_row(asked: Displacement, record: DisplacementRecord, modal: ModalSum) -> AuditRow:
    """Row on a displacement beside the sum of the modes at its node; of several events the one that it fits best.

    Raises
    ------
    CaseError : no modal coordinates to compare with; DataError : the node has no mode shape
    """
    name = f"{asked.file.name}, node {asked.node} {asked.direction}"
    results, model = modal.results, modal.model
    if not modal.histories:
        raise CaseError(
            Problem("no_coordinates", name, "a displacement is compared with modal coordinates", "Give --coordinates")
        )
    given = {int(mode) for history in modal.histories for mode in history.mode}
    if (row := _row_without_shapes(name, results, given)) is not None:
        return row
    shape = _shape(asked, name, results, model) * modal.units.length * modal.shape_factor[:, None]
    direction = "xyz".index(asked.direction)
    found = [
        compared(record, direction, results.mode, shape, modal.coordinate_factor, history)
        for history in modal.histories
    ]
    lacking = [
        int(mode)
        for mode, hertz in zip(results.mode, results.frequency, strict=True)
        if int(mode) not in given and not hertz <= LOWEST_HZ
    ]
    best = min(found, key=lambda event: event.misfit)
    if not np.isfinite(best.misfit) or best.misfit > _NOISE:
        explained = [(causes, event) for event in found if (causes := causes_of(event, record))]
        if explained:
            causes, best = min(explained, key=lambda pair: pair[0][0].misfit)
        else:
            causes = ()
        if best.comparison is not None and np.isfinite(best.misfit):
            grids = results.shape_node[np.isin(results.shape_node, model.mesh.node)]
            millimetres = modal.units.length * modal.shape_factor[:, None, None]
            causes = with_other_node(
                causes, best.comparison, asked.node, grids, lambda at: _basic(grids[at], results, model) * millimetres
            )
        return judged(name, best, causes, lacking)
    return judged(name, best, (), lacking)


def _row_without_shapes(name: str, results: FeResults, given: Collection[int]) -> AuditRow | None:
    """Row on a force file that lacks mode shapes, of all modes or of some with coordinates; else None."""
    if not results.shape_node.size:
        return AuditRow(
            CHECK,
            "amber",
            None,
            f"{name}: the force file holds no mode shapes to compare it with",
            "Request DISPLACEMENT(PLOT) = ALL (or a set with the node) for all modes in the same run",
        )
    bare = [m for m, u in zip(results.mode.tolist(), results.shape, strict=True) if m in given and not u.any()]
    if bare:
        return AuditRow(
            CHECK,
            "amber",
            None,
            f"{name}: {len(bare)} modes with coordinates have no displacements in the force file, mode {bare[0]} the "
            "first, so that the sum of the modes lacks them",
            "Request DISPLACEMENT(PLOT) = ALL (or a set with the node) for the unit loads, too",
        )
    return None


def _basic(grids: NDArray[np.int64], results: FeResults, model: FeModel) -> Floats:
    """Translations of grids in every mode (m, n, 3), basic frame, in the file's own units."""
    order = np.argsort(results.shape_node, kind="stable")
    at = order[np.searchsorted(results.shape_node, grids, sorter=order)]
    return np.asarray(to_basic(results.shape[:, at].astype(np.float64), grids, model)[:, :, :3], np.float64)


def _shape(asked: Displacement, name: str, results: FeResults, model: FeModel) -> Floats:
    """Translation of the node in every mode (m, 3), basic frame, in the file's own units."""
    at = np.flatnonzero(results.shape_node == asked.node)
    if not at.size:
        grids = results.shape_node
        where = "is in the mesh but has no mode shape" if asked.node in model.mesh.node else "does not exist"
        raise DataError(
            Problem(
                "no_node",
                name,
                f"the node {where}; {grids.size} grids from {grids.min()} to {grids.max()} have mode shapes",
                "Name one of them, or request DISPLACEMENT for the node",
            )
        )
    shape = to_basic(results.shape[:, at].astype(np.float64), np.array([asked.node]), model)[:, 0, :3]
    if not np.isfinite(shape).all():
        raise DataError(
            Problem("not_a_number", name, "a mode shape holds a value that is no number", "Copy the force file again")
        )
    return np.asarray(shape, np.float64)
