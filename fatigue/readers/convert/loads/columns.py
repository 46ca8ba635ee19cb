"""Columns of unit loads among the modal coordinates of an event."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem, refuse
from fatigue.readers.convert.loads.names import UnitLoad
from fatigue.readers.foreign.histories.foreign_history import ForeignHistory
from fatigue.readers.units.channel_names import channel


def load_of_column(name: str, loads: Sequence[UnitLoad]) -> UnitLoad | None:
    """Unit load that a column is named for, ``u_<name>`` with or without a unit behind; None if it is none."""
    called = (name.strip(), channel(name).base)
    return next((load for load in loads if load.column in called), None)


def load_columns(history: ForeignHistory, loads: Sequence[UnitLoad]) -> NDArray[np.int64]:
    """Number of the unit load that each column gives, (m,), 0 where it gives none.

    Raises
    ------
    DataError : two columns of one load, or a unit that is not the load's
    """
    found = [load_of_column(name, loads) for name in history.name]
    problems = []
    for k, load in enumerate(found):
        if load is None:
            continue
        where = f"{history.source}, column {history.name[k]!r}"
        if load in found[:k]:
            problems.append(Problem("unit_load_twice", where, "another column gives this load, too", "Keep one"))
        unit = history.unit[k] if history.unit else ""
        if unit and unit != load.unit:
            what = f"it states {unit}; the load is in {load.unit}"
            remedy = f"State --unit-load-name {load.case.subcase} {load.name} AMOUNT {unit}, or export another unit"
            problems.append(Problem("unit_load_unit", where, what, remedy))
    refuse(DataError, problems)
    return np.array([0 if load is None else load.case.number for load in found], np.int64)


def with_columns(history: ForeignHistory, more: ForeignHistory) -> ForeignHistory:
    """History with the columns of another of the same file behind its own."""
    own, other = (h.unit or ("",) * h.mode.size for h in (history, more))
    return replace(
        history,
        mode=np.concatenate([history.mode, more.mode]),
        frequency=np.concatenate([history.frequency, more.frequency]),
        name=(*history.name, *more.name),
        unit=(*own, *other),
        resolution=None,
        q=np.concatenate([history.q, more.q]),
    )
