"""The history of one unit load in a file of its own: ``time_s`` and the column of the load."""

import numpy as np

from fatigue.errors import Problem
from fatigue.life.records.unit_load import LoadRecord, LoadSource, UniformGrid
from fatigue.readers.neutral.history import uniform_step
from fatigue.readers.neutral.tables import open_table


def read_load(source: LoadSource, *, strict: bool) -> tuple[LoadRecord, list[Problem]]:
    """Samples of a unit load, scaled and shifted, whose record has a file of its own; float32 where the file has it.

    Other columns of the file are those of other loads and not read.

    Raises
    ------
    DataError : no such column, fewer than 2 samples, steps that differ by more than 1e-3, a value that is not finite
    """
    assert source.path is not None
    table = open_table(source.path)
    table.expect(("time_s", source.column), table.position, strict=strict)
    time = table.numbers("time_s").astype(np.float64)
    values = table.numbers(source.column)
    table.refuse()
    if source.scale != 1.0:
        values = (source.scale * values.astype(np.float64)).astype(values.dtype)
    grid = UniformGrid(float(time[0]) + source.shift_s, uniform_step(table, time), table.rows)
    warnings = [warning for warning in table.warnings if warning.code != "unit_unused"]  # compared elsewhere
    return LoadRecord(values, grid, source.interpolation, periodic=False), warnings
