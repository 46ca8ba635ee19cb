"""The file of endurance lines: upper stress at some stress ratios, for one component of stress each."""

from collections.abc import Collection, Iterator, Mapping
from pathlib import Path
from typing import cast

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import Problem
from fatigue.life.endurance.haigh import COMPONENTS, Component, EnduranceLine, endurance_line
from fatigue.readers.neutral.tables import Table, open_table

REQUIRED = ("line", "component", "R", "stress_max_MPa", "edition", "clause")
LOWEST_R = -1e3
FEWEST_ROWS = 2
ROUNDING = 0.01  # by which upper stress or amplitude may go the wrong way from row to row: two digits of a table


def read_endurance_lines(
    path: Path, curves: Collection[str], *, strict: bool
) -> tuple[Mapping[str, EnduranceLine], list[Problem]]:
    """Read ``line, component, R, stress_max_MPa, edition, clause``: the lines by name, and warnings.

    ``stress_max_MPa`` is the upper stress that is endured at the ratio R, the rows of a line ascend with R. ``curves``
    are names that no line may have.

    Raises
    ------
    DataError
        a line with one row, with rows in another order, with two components or none; R outside -1000 to below 1; an
        upper stress that falls as R rises, or an amplitude that rises
    """
    table = open_table(path, texts=("line", "component", "edition", "clause"))
    table.expect(REQUIRED, ("note",), strict=strict)
    names, code = table.groups("line")
    component = table.texts("component")
    table.choices("component", component, COMPONENTS)
    R = table.numbers("R", least=LOWEST_R).astype(np.float64)
    what = f"{_first(R, R >= 1.0):g} is no stress ratio of an upper stress: nothing alternates at 1"
    table.report(R >= 1.0, "bad_value", "R", what, "Give R = minimum / maximum, at least -1000 and below 1")
    stress_max = table.numbers("stress_max_MPa", above=0.0).astype(np.float64)
    edition, clause = table.texts("edition"), table.texts("clause")
    table.refuse()
    lines: dict[str, EnduranceLine] = {}
    for i, name in enumerate(names):
        rows = np.flatnonzero(code == i)
        found = [*_of_line(table, name, rows, component, R, stress_max), *_source(table, name, rows, edition, clause)]
        if name in curves:
            what = f"line '{name}' has the name of an S-N curve"
            found.append(Problem("duplicate", table.where("line", rows[0]), what, "Give the line another name"))
        table.problems.extend(found)
        if not found:
            of = cast(Component, component[rows[0]])
            lines[name] = endurance_line(name, of, R[rows], stress_max[rows], edition[rows[0]], clause[rows[0]])
    table.refuse()
    return lines, table.warnings


def _of_line(
    table: Table,
    name: str,
    rows: NDArray[np.intp],
    component: list[str],
    R: NDArray[np.float64],
    stress_max: NDArray[np.float64],
) -> Iterator[Problem]:
    """Refusals of one line that its rows make together, the first of a kind."""
    others = [row for row in rows if component[row] != component[rows[0]]]
    if others:
        what = f"line '{name}' is for {component[rows[0]]} in {table.row_name(rows[0])} and for {component[others[0]]}"
        remedy = "Give a line of its own to each component"
        yield Problem("contradiction", table.where("component", others[0]), what, remedy)
    if len(rows) < FEWEST_ROWS:
        what = f"line '{name}' has one row, and one stress ratio says nothing of others"
        yield Problem("few_rows", table.where("R", rows[0]), what, "Give the upper stress at a second R, too")
        return
    R, stress_max = R[rows], stress_max[rows]
    after = _first_step(np.diff(R) <= 0.0)
    if after:
        what = f"R of line '{name}' goes from {R[after - 1]:g} to {R[after]:g}"
        remedy = "Give every R once, and sort the rows of a line by R, ascending"
        yield Problem("wrong_order", table.where("R", rows[after]), what, remedy)
        return
    amplitude = 0.5 * stress_max * (1.0 - R)
    after = _first_step(np.diff(stress_max) < -ROUNDING * stress_max[1:])
    if after:
        what = (
            f"the upper stress of line '{name}' falls from {stress_max[after - 1]:g} at R = {R[after - 1]:g} to "
            f"{stress_max[after]:g} at R = {R[after]:g}, although the second cycle lies inside the first"
        )
        remedy = "Give upper stresses; of an amplitude it is 2 amplitude / (1 - R), of a range range / (1 - R)"
        yield Problem("falling_stress", table.where("stress_max_MPa", rows[after]), what, remedy)
        return
    after = _first_step(np.diff(amplitude) > ROUNDING * amplitude[1:])
    if after:
        what = (
            f"the amplitude stress_max (1 - R) / 2 of line '{name}' rises from {amplitude[after - 1]:g} at "
            f"R = {R[after - 1]:g} to {amplitude[after]:g} at R = {R[after]:g}, although its mean rises, too"
        )
        yield Problem("rising_amplitude", table.where("stress_max_MPa", rows[after]), what, "Check both rows")


def _source(
    table: Table, name: str, rows: NDArray[np.intp], edition: list[str], clause: list[str]
) -> Iterator[Problem]:
    """Refusals of a line whose rows come from different editions or clauses."""
    for column, texts in (("edition", edition), ("clause", clause)):
        other = [row for row in rows if texts[row] != texts[rows[0]]]
        if other:
            what = f"line '{name}' is from {texts[rows[0]]!r} and from {texts[other[0]]!r}"
            yield Problem("contradiction", table.where(column, other[0]), what, f"Give a line one {column}")


def _first_step(bad: NDArray[np.bool_]) -> int:
    """Index of the row behind the first bad step; 0 where there is none."""
    return int(bad.argmax()) + 1 if bad.any() else 0


def _first(values: NDArray[np.float64], bad: NDArray[np.bool_]) -> float:
    return float(values[bad.argmax()])
