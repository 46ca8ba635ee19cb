"""A fleet as a story: conditions of several results, how far every unit runs under each, and what that does to it.

D[point, unit] = sum over the conditions of d[point, condition] km[unit, condition]: nothing is counted again. A
condition is one event of one result. All results must have the same points, on the same curves.
"""

from contextlib import ExitStack
from dataclasses import asdict, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.decide.beside_results import refuse_results
from fatigue.decide.fleet.conditions import Points, Result, read_results, shared_points
from fatigue.decide.fleet.distances import Distances, correlation_matrix, read_distances
from fatigue.decide.fleet.doubts import doubts, refuse_short_loops
from fatigue.decide.fleet.errors_of_damage import counted_as_exact, errors_of_damage
from fatigue.decide.fleet.fleet_file import Fleet, load_fleet
from fatigue.decide.fleet.page import PAGE, fleet_page
from fatigue.decide.fleet.rows import MOST_POINT_ROWS, percentile_rows, point_rows, unit_rows, variance_rows, weld_rows
from fatigue.decide.fleet.summary import FleetFound
from fatigue.decide.fleet.summed import Scatter, Summed, summed, variances
from fatigue.errors import given_path
from fatigue.files.hashes import sha256
from fatigue.files.recorded import Filled, refuse_foreign
from fatigue.report.wording import whole
from fatigue.results.dictionary.decided.fleet import FLEET
from fatigue.results.outputs import damage_told
from fatigue.results.plain_tables import Rows, fill, table_files
from fatigue.stages import stage

Floats = NDArray[np.float64]

RECORD = "fleet.json"
FILLED = Filled("fatigue fleet", "fleet", RECORD, (*table_files(tuple(FLEET)), PAGE))


def fleet(
    file: Path | str, *, into: Path | str | None = None, csv: bool = False, force: bool = False, no_lock: bool = False
) -> FleetFound:
    """What the conditions of several results do to the units of a fleet, written into a folder where one is given.

    Parameters
    ----------
    file : ``fleet.toml``: conditions, and the table of distances in a year
    into : folder for tables, page and record; None: nothing is written
    csv : write the tables as CSV as well
    force : overwrite files in it that are not ours
    no_lock : for a file system without locks, see ``fatigue.assess``

    Raises
    ------
    CaseError : a mistake in the fleet file, or correlations that cannot be
    DataError : a mistake in the distances; results that are not there, or are not of one register, its points and
        curves; files in the way in the folder
    """
    asked = load_fleet(file)
    folder = None if into is None else given_path(into, "into")
    km = asked.resolve(asked.km)
    if folder is not None:
        refuse_results(folder, [asked.resolve(one.results) for one in asked.condition])
        refuse_foreign(folder, FILLED, force=force, inputs=[asked.path, km])
    stage("reading %d conditions", len(asked.condition))
    results = read_results(asked, no_lock=no_lock)
    with ExitStack() as told:
        for result in results.values():
            told.enter_context(damage_told(result.folder))
        return _summed_up(asked, results, folder, km, csv=csv)


def _summed_up(asked: Fleet, results: dict[str, Result], folder: Path | None, km: Path, *, csv: bool) -> FleetFound:
    """The fleet from its results, as ``fleet`` returns it."""
    by_number = np.array([results[one.results].is_by_number(one.event) for one in asked.condition])
    distances, warnings = read_distances(km, asked.names, by_number)
    refuse_short_loops(asked, results, distances)
    correlation = correlation_matrix(asked.names, asked.correlation, asked.path.name)
    points = shared_points(asked, results)
    stage("summing %d points of %d units", len(points.key), len(distances.units))
    of = summed(points, distances)
    scatter = _scatter(asked, results, points, distances, correlation)
    found = FleetFound(
        title=asked.title,
        conditions=asked.names,
        welds=len(points.names),
        points=len(points.key),
        target_years=asked.target_years,
        units=unit_rows(of, scatter, asked.names, asked.target_years),
        percentiles=percentile_rows(of, asked.percentiles),
        variance=variance_rows(of, tuple(variances(of, scatter)), asked.names),
        counted_as_exact=counted_as_exact(asked, scatter.damage_cv, of.worst_of_units),
        every_point=len(points.key) * len(distances.units) <= MOST_POINT_ROWS,
        points_rule=_points_rule(points, distances),
        warnings=(*warnings, *doubts(asked, results, points)),
    )
    if folder is not None:
        stage("writing tables and page")
        written = _write(folder, asked, results, found, of, csv=csv)
        found = replace(found, written=tuple(str(folder / name) for name in written))
    return found


def _points_rule(points: Points, distances: Distances) -> str:
    """What the table of points holds, in words."""
    rows = len(points.key) * len(distances.units)
    if rows <= MOST_POINT_ROWS:
        return (
            f"fleet_points has all {whole(len(points.key))} points of every unit, as these are no more than 2e6 rows."
        )
    return (
        f"There is no table fleet_points: {whole(rows)} rows are more than 2e6. fleet_welds has the worst point of "
        "every weld and unit; docs/fleet.md has a query for any others."
    )


def _scatter(
    asked: Fleet, results: dict[str, Result], points: Points, distances: Distances, correlation: Floats
) -> Scatter:
    """How sure distances and damage are, as far as it is said."""
    pairs = [(one.results, one.event) for one in asked.condition]
    known = list(dict.fromkeys(pairs))
    damage_cv = errors_of_damage(asked, results, points)
    return Scatter(
        correlation=correlation,
        damage_cv=damage_cv,
        same=np.array([known.index(pair) for pair in pairs]),
        is_known=distances.deviation is not None or bool(damage_cv.any()),
    )


def _write(
    folder: Path, asked: Fleet, results: dict[str, Result], found: FleetFound, of: Summed, *, csv: bool
) -> list[str]:
    """Write tables, page and record; returns their names."""
    tables: dict[str, Rows] = {
        "fleet_units": found.units,
        "fleet_welds": weld_rows(of, asked.names, asked.target_years),
        "fleet_percentiles": found.percentiles,
    }
    every = point_rows(of)
    if every is not None:
        tables["fleet_points"] = every
    if found.variance:
        tables["fleet_variance"] = found.variance
    said = {
        "title": asked.title,
        "inputs": {path.name: sha256(path) for path in (asked.path, asked.resolve(asked.km))},
        "conditions": [
            one.model_dump() | {"result": results[one.results].record.get("result", "")} for one in asked.condition
        ],
        "target_years": asked.target_years,
        "verdict": found.verdict,
        "points": found.points_rule,
        "warnings": [asdict(problem) for problem in found.warnings],
    }
    written = {name: (FLEET[name], rows) for name, rows in tables.items()}
    return fill(folder, FILLED, written, {PAGE: fleet_page(found)}, said, csv=csv)
