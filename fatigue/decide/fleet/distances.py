"""How far every unit runs under every condition in a year: a table with one row for each unit and condition."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.decide.fleet.fleet_file import Correlation
from fatigue.errors import CaseError, Problem
from fatigue.readers.neutral.tables import Table, open_table
from fatigue.shown import few, visible

Floats = NDArray[np.float64]

KM, PASSES = "km_per_year", "passes_per_year"
ROUNDING = 1e-9  # of a correlation matrix, up to which its smallest eigenvalue may be below 0


@dataclass(frozen=True, slots=True, eq=False)
class Distances:
    """Units and how far they run.

    Attributes
    ----------
    units : names, in the order of the table
    distance : (u, c) km in a year under each condition; passes where the condition is counted by number
    deviation : (u, c) standard deviation of these; None: not given
    by_number : (c,) conditions that are counted by number
    """

    units: tuple[str, ...]
    distance: Floats
    deviation: Floats | None
    by_number: NDArray[np.bool_]

    @property
    def km(self) -> Floats:
        """Distance (u,) of each unit in a year [km]; passes are none."""
        return np.asarray(self.distance[:, ~self.by_number].sum(axis=1))


def read_distances(
    path: Path, conditions: Sequence[str], by_number: NDArray[np.bool_]
) -> tuple[Distances, tuple[Problem, ...]]:
    """Distances of a table, and warnings about the table.

    Columns are ``unit``, ``condition``, and ``km_per_year`` or, of a condition that is ``by_number``,
    ``passes_per_year``; optionally ``km_per_year_sd``, ``passes_per_year_sd``.

    Raises
    ------
    DataError : everything that is wrong with the table
    """
    table = open_table(path, texts=("unit", "condition"))
    wanted = [name for name, some in ((KM, ~by_number), (PASSES, by_number)) if some.any()]
    deviations = [f"{name}_sd" for name in (KM, PASSES)]
    table.expect(("unit", "condition", *wanted), (KM, PASSES, *deviations), strict=False)
    names, unit = table.groups("unit")
    given, condition = table.groups("condition")
    table.known("condition", given, condition, conditions, "the conditions of the fleet")
    table.refuse()
    column = np.array([conditions.index(name) for name in given])[condition]
    table.unique({"unit": unit, "condition": condition}, {"unit": names, "condition": given})
    values = _of_its_kind(table, (KM, PASSES), by_number[column])
    has_sd = any(name in table.position for name in deviations)
    sd = _of_its_kind(table, deviations, by_number[column], default=0.0) if has_sd else None
    table.refuse()
    units = _in_order(names, unit)
    row = np.array([units.index(name) for name in names])[unit]
    there = np.zeros((len(units), len(conditions)), np.bool_)
    there[row, column] = True
    table.problems.extend(_missing(table, units, conditions, there))
    table.refuse()
    distance, deviation = np.zeros(there.shape), np.zeros(there.shape)
    distance[row, column] = values
    table.problems.extend(_at_rest(table, units, distance))
    table.refuse()
    if sd is not None:
        deviation[row, column] = sd
    found = Distances(units, distance, None if sd is None else deviation, by_number)
    return found, tuple(table.warnings)


def _of_its_kind(
    table: Table, names: Sequence[str], by_number: NDArray[np.bool_], default: float | None = None
) -> Floats:
    """Values (r,) at least 0, each row from the column of its kind; what stands in the other one is a mistake."""
    values = np.zeros(table.rows)
    for name, other, own in zip(names, reversed(names), (~by_number, by_number), strict=True):
        if name not in table.position and not own.any():
            continue
        column = table.numbers(name, default=np.nan).astype(np.float64)
        if default is None:
            missing = "the value is missing or NaN"
            table.report(
                own & np.isnan(column), "missing_value", name, missing, "Give a number, 0 where it does not run"
            )
        table.report(own & (column < 0.0), "bad_value", name, _first(column, own & (column < 0.0)), "Give at least 0")
        what = "the condition is counted by " + ("number" if name.startswith(KM) else "km")
        foreign = ~own & ~np.isnan(column) & (column != 0.0)
        table.report(foreign, "fleet_kind", name, what, f"Give {other} in its place, and leave this empty")
        values[own] = np.nan_to_num(column[own], nan=default or 0.0)
    return values


def _first(values: Floats, marked: NDArray[np.bool_]) -> str:
    return f"{values[marked][0]:g} is below 0" if marked.any() else ""


def _in_order(names: Sequence[str], code: NDArray[np.integer]) -> tuple[str, ...]:
    """Names in the order in which they come first."""
    first = np.unique(code, return_index=True)[1]
    return tuple(names[int(place)] for place in code[np.sort(first)].tolist())


def _missing(
    table: Table, units: Sequence[str], conditions: Sequence[str], there: NDArray[np.bool_]
) -> Iterator[Problem]:
    """Refusal of units without a row for some condition."""
    for unit, row in zip(units, there, strict=True):
        if not row.all():
            names = few([repr(visible(conditions[c])) for c in np.flatnonzero(~row).tolist()])
            what = f"unit {visible(unit)!r} has no row for the condition {names}"
            yield Problem("fleet_no_km", table.path.name, what, "Add it, with 0 where the unit never runs under it")


def _at_rest(table: Table, units: Sequence[str], distance: Floats) -> Iterator[Problem]:
    for unit in np.flatnonzero(~(distance > 0.0).any(axis=1)).tolist():
        what = f"unit {visible(units[unit])!r} runs nowhere: all its distances are 0"
        yield Problem("fleet_no_km", table.path.name, what, "Give its distances, or remove its rows")


def correlation_matrix(conditions: Sequence[str], given: Sequence[Correlation], file: str) -> Floats:
    """Matrix (c, c) of the correlations of distances, 0 where none is given.

    Raises
    ------
    CaseError : no distances can be correlated like that
    """
    matrix = np.eye(len(conditions))
    for one in given:
        i, j = (conditions.index(name) for name in one.conditions)
        matrix[i, j] = matrix[j, i] = one.rho
    lowest = float(np.linalg.eigvalsh(matrix)[0])
    if lowest < -ROUNDING:
        what = f"no distances can be correlated like this: the smallest eigenvalue of the matrix is {lowest:.2g}"
        raise CaseError(Problem("bad_correlation", f"{file}: correlation", what, "Take coefficients nearer to 0"))
    return matrix


def covariance(deviation: Floats, correlation: Floats) -> Floats:
    """Covariance (c, c) of distances from their standard deviations (c,)."""
    return deviation[:, None] * correlation * deviation[None, :]


def covariance_of_units(distance: Floats) -> Floats:
    """Covariance (c, c) of the distances (u, c) over the units, n - 1."""
    apart = distance - distance.mean(axis=0)
    return np.asarray(apart.T @ apart / (len(distance) - 1))
