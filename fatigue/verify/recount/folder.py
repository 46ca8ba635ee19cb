"""The recount as a story: inputs as they were, lines solved anew, points counted anew, table against table.

In memory at a time are some welds, one record, and of the result the rows of some points; what grows with the body are
the keys of its stations and two columns of its points.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from numbers import Integral
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from fatigue.errors import CaseError, DataError, Problem, given_path, refuse
from fatigue.results import ASSESSED, read_provenance, strangers, upsampling_factors
from fatigue.verify.recount.anew.body import closed_welds, layout, solved_lines
from fatigue.verify.recount.anew.curve import curve_named, origin_of
from fatigue.verify.recount.anew.mission import RecountEvent
from fatigue.verify.recount.anew.point import Values
from fatigue.verify.recount.anew.rounding import Bounds
from fatigue.verify.recount.checked import SHARE, check_table
from fatigue.verify.recount.choice import MOST_SAMPLES, choose, groups_of_welds, worst_points
from fatigue.verify.recount.counted import Passes, bounds_of, count, loop_names, mean_stress_of, values_of
from fatigue.verify.recount.inputs.case import RecountInputs, open_inputs, strength_factors
from fatigue.verify.recount.inputs.coordinates import RecountCoordinates, read_coordinates
from fatigue.verify.recount.layout import FACES, Key, Layout
from fatigue.verify.recount.sheared import Sheared, decided_by_method, paths_to_count, shear_of
from fatigue.verify.recount.stored.band import band_row, stored_bands
from fatigue.verify.recount.stored.checks import check_frame, has_checks, of_weld
from fatigue.verify.recount.stored.compare import LOAD_FACTOR_STEP, ColumnCheck, Recount, Row, compare, merged
from fatigue.verify.recount.stored.decisive import failed_by_checks
from fatigue.verify.recount.stored.rows import (
    RecountWeld,
    Station,
    damage_row,
    largest_stress,
    node_row,
    stress_rows,
    weld_row,
)
from fatigue.verify.recount.stored.shear import shear_rows, stored_shear
from fatigue.verify.recount.stored.sums import check_load_factors, check_sums, smallest_load_factors
from fatigue.verify.recount.stored.tables import (
    Stored,
    fastest_peaks,
    governing_points,
    is_counted,
    left_out_check,
    open_tables,
    rows_of,
    toes_and_utilisation,
    with_cycles,
    with_histogram,
)
from fatigue.verify.recount.varied import check_sensitivity

TOES = {"top": ("top",), "bottom": ("bottom",), "both": FACES}
FORCES_AT_ONCE = 400_000  # nodes times modes of the welds that are solved at a time: some 150 MB
SAMPLES_AT_ONCE = 50_000_000  # of stress that are counted before rows are compared: a curve with knees keeps cycles
POINTS_AT_ONCE = 2000
STRESS_ROWS_AT_ONCE = 20_000


def recount(
    folder: Path | str,
    *,
    sample: int | None = 50,
    seed: int = 0,
    case_file: Path | str | None = None,
    most_samples: int = MOST_SAMPLES,
) -> Recount:
    """Recount of points of a finished result from its input files, by other code than the one that made it.

    Files of the folder that belong to another result are named; where they are tables of the assessment nothing is
    recounted. Files that were changed since they were written are named, too, and of tables that can be read all the
    same the recount tells what was changed in them.

    Nothing here imports the line solver, the counting or the spectra of the program: dense matrices, the ``rainflow``
    package, a spectrum of each point's own stress, curves from constants copied a second time.

    Where recounting the worst point of every weld would take long it is done for as many welds as ``most_samples``
    allows, half of them those with the shortest lives, half drawn; and all rows of the tables are checked for what one
    follows from the other.

    Parameters
    ----------
    folder : the result folder
    sample : how many points beside each weld's worst one; None: all
    seed : of what is drawn
    case_file : the case it was made from; by default where the provenance of the result says
    most_samples : stress samples that counting the worst points may take

    Raises
    ------
    DataError : no finished result there, or inputs that are missing or changed since; CaseError : no number of points
    """
    refuse(CaseError, _senseless(sample, seed))
    folder = given_path(folder, "folder")
    case_file = None if case_file is None else given_path(case_file, "case_file")
    record = read_provenance(folder)
    astray = tuple(strangers(folder, record))
    tables = [problem for problem in astray if Path(problem.where).name in {f"{table}.parquet" for table in ASSESSED}]
    if any(problem.code == "other_result" for problem in tables):
        return Recount(folder, 0, 0, (), strangers=astray)
    try:
        inputs = open_inputs(record, folder, case_file)
    except DataError as error:
        raise DataError(*astray, *error.problems) from None
    try:
        return _recount(folder, record, inputs, astray, sample=sample, seed=seed, most_samples=most_samples)
    except Exception as error:
        if tables:  # what was changed in them cannot be told
            raise DataError(*tables) from error
        raise


def _recount(
    folder: Path,
    record: Mapping[str, Any],
    inputs: RecountInputs,
    astray: tuple[Problem, ...],
    *,
    sample: int | None,
    seed: int,
    most_samples: int,
) -> Recount:
    """The recount of a folder whose inputs are as they were; ``astray`` are its files that are not."""
    coordinates, body = read_coordinates(inputs), layout(inputs)
    events = [event["name"] for event in inputs.case["mission"]["event"]]
    stored = open_tables(folder, body, [*events, *loop_names(inputs)], coordinates, record)
    checks = [*stored.keys, *left_out_check(stored, inputs)]
    if not all(check.passed for check in checks):
        return Recount(folder, 0, body.points, tuple(checks), strangers=astray)

    toe, utilisation = toes_and_utilisation(stored)
    worst, samples, shear = worst_points(body, toe, utilisation), _samples(record), stored_shear(stored, inputs, record)
    governing = governing_points(stored)
    most = max(2, most_samples // samples)
    named = governing if shear is None else np.union1d(governing, np.array(sorted(shear.half_cycles), dtype=np.int64))
    choice = choose(body, worst, utilisation, named, sample=sample, seed=seed, most=most)
    sampling = list(zip(fastest_peaks(folder, inputs, events), upsampling_factors(record), strict=True))
    toes = _toes(inputs, body)
    cycles_of, histogram_of = with_cycles(stored, governing, record), with_histogram(stored, record, toes)
    paths_of = paths_to_count(shear, choice.points, samples, everything=sample is None)
    all_counted = bool(is_counted(stored).all())
    share = record["rules"]["screening"]["share_of_limit"]
    raw_life_enough = np.inf if share == 0.0 else inputs.case["mission"]["target_km"] / share
    frame = check_frame(folder) if has_checks(inputs) else None
    found: list[ColumnCheck] = []
    mission: list[RecountEvent] = []
    weld_of_point = body.weld[choice.points // 2]
    for group in groups_of_welds(body, np.unique(weld_of_point).tolist(), len(coordinates), FORCES_AT_ONCE):
        welds = _welds(inputs, coordinates, record, [body.welds[weld] for weld in group])
        stations = _stations(body, welds, group)
        points = choice.points[np.isin(weld_of_point, group)]
        values: dict[Key, Values] = {}
        bounds: dict[Key, Bounds] = {}
        at_once = max(1, min(SAMPLES_AT_ONCE // samples, POINTS_AT_ONCE))
        for first in range(0, len(points), at_once):
            few = {int(point): stations[int(point) // 2] for point in points[first : first + at_once]}
            passes, mission = count(
                inputs, coordinates, few, sampling, stored, cycles_of, histogram_of, shear, paths_of
            )
            of_few = values_of(inputs, few, passes, mission)
            rounding = bounds_of(inputs, few, passes, mission, of_few)
            sheared = shear_of(inputs, body, few, passes, mission, of_few, rounding, shear)
            of_few, rounding = decided_by_method(inputs, few, of_few, rounding, sheared, shear)
            steps = _steps(inputs, few.values())
            found += _compared(few, stored, of_few, rounding, passes, mission, raw_life_enough, steps, sheared)
            values |= {body.key(point): of_few[point] for point in few}
            bounds |= {body.key(point): rounding[point] for point in few}
        recounted = {number: stations[number] for number in np.unique(points // 2).tolist()}
        found += _compared_stress(coordinates, recounted, stored)
        chosen = {body.welds[weld]: welds[body.welds[weld]] for weld in group if weld in choice.welds}
        found += _compared_welds(chosen, stored, values, bounds, inputs, frame, all_counted=all_counted)
    checks += merged(found)
    station_at = _station_finder(inputs, coordinates, record)
    if frame is not None:
        checks += check_table(
            frame,
            inputs,
            coordinates,
            record,
            body,
            station_at,
            sampling,
            sample=sample,
            seed=seed,
            most=int(SHARE * most_samples) // samples,
        )
    checks += check_sensitivity(
        stored,
        inputs,
        coordinates,
        record,
        station_at,
        sampling,
        sample=sample,
        seed=seed,
        most=int(SHARE * most_samples) // samples,
        samples=samples,
    )
    checks += check_sums(stored, inputs.case, mission) if choice.what else check_load_factors(stored, toes)
    return Recount(folder, len(choice.points), body.points, tuple(checks), choice.what, astray)


def _senseless(sample: object, seed: object) -> Iterator[Problem]:
    """Problems of arguments that make no sense."""
    for name, given in (("sample", 0 if sample is None else sample), ("seed", seed)):
        if not (isinstance(given, Integral) and int(given) >= 0):
            yield Problem("argument", name, f"{given!r} is no whole number from 0 on", "Give one")


def _toes(inputs: RecountInputs, body: Layout) -> NDArray[np.bool_]:
    """Whether each point is at a toe, by the inputs, (p,)."""
    surfaces = [inputs.register.welds[name].surface or "both" for name in body.welds]
    return np.array([[face in TOES[surface] for face in FACES] for surface in surfaces])[body.weld].ravel()


def _samples(record: Mapping[str, Any]) -> int:
    """Samples on which a point is counted, as far as they are known before the records are read."""
    events = record["mission"]["events"]
    return sum(int(e["samples"]) * factor for e, factor in zip(events, upsampling_factors(record), strict=True))


def _welds(
    inputs: RecountInputs, coordinates: RecountCoordinates, record: Mapping[str, Any], names: Sequence[str]
) -> dict[str, RecountWeld]:
    """Some welds, read and solved."""
    parts: dict[str, list[Any]] = {name: [] for name in names}
    for solved in solved_lines(inputs, coordinates, names):
        parts[solved.line.weld].append(solved)
    welds, closed, factors = {}, closed_welds(inputs, names), strength_factors(inputs)
    for name in names:
        entry = inputs.register.welds[name]
        surface, curve = entry.surface or "both", entry.curve or inputs.case["curve"]["name"]
        of_curve = curve_named(curve, inputs.case, record, factors)
        welds[name] = RecountWeld(
            given={"closed": name in closed, "surface": surface},
            parts=tuple(parts[name]),
            curve_name=curve,
            curve=of_curve,
            toes=TOES[surface],
            attachment=np.inf if np.isnan(entry.attachment) else entry.attachment,
            limit=of_curve.limit(inputs.case["mission"]),
            origin=origin_of(curve, inputs.case, record),
        )
    return welds


def _station_finder(
    inputs: RecountInputs, coordinates: RecountCoordinates, record: Mapping[str, Any]
) -> Callable[[str, int, int], Station]:
    """Function that finds a station by weld, part and order; a weld is solved when it is asked for."""
    of_weld: dict[str, dict[tuple[int, int], Station]] = {}

    def find(weld: str, part: int, order: int) -> Station:
        if weld not in of_weld:
            solved = _welds(inputs, coordinates, record, [weld])[weld]
            of_weld[weld] = {
                (one.line.part, number): Station(solved, one, at, largest_stress(one))
                for one in solved.parts
                for at, number in enumerate(one.line.order.tolist())
            }
        return of_weld[weld][part, order]

    return find


def _stations(body: Layout, welds: Mapping[str, RecountWeld], group: Sequence[int]) -> dict[int, Station]:
    """Stations of a group of welds by their numbers in the layout."""
    stations: dict[int, Station] = {}
    for index in group:
        weld = welds[body.welds[index]]
        places = (
            Station(weld, solved, at, largest)
            for solved, largest in zip(weld.parts, map(largest_stress, weld.parts), strict=True)
            for at in range(len(solved.line.order))
        )
        stations |= dict(enumerate(places, start=int(body.first[index])))
    return stations


def _compared(
    stations: Mapping[int, Station],
    stored: Stored,
    values: Mapping[int, Values],
    bounds: Mapping[int, Bounds],
    passes: Mapping[int, Passes],
    events: Sequence[RecountEvent],
    raw_life_enough: float,
    steps: Mapping[str, float],
    sheared: Mapping[int, Sheared],
) -> list[ColumnCheck]:
    """Checks of the stored rows of some points beside the recounted ones."""
    points, e = np.array(list(stations)), len(events)
    of_nodes = rows_of(stored, "nodes", stored.nodes.of(points))
    of_damage = rows_of(stored, "damage", stored.damage.of((points[:, None] * e + np.arange(e)).ravel()))
    nodes: list[Row] = []
    damage: list[Row] = []
    for i, (point, station) in enumerate(stations.items()):
        key, found = stored.body.key(point), of_nodes[i]
        nodes.append(node_row(key, station, values[point], bounds[point], found, raw_life_enough))
        if point in sheared:
            own = sheared[point]
            nodes += shear_rows(key, own.values, own.bounds, found, exact_bound=own.exact_bound, toe=own.toe)
        for j, (event, one) in enumerate(zip(events, passes[point].treated, strict=True)):
            damage.append(damage_row(key, event, one, of_damage[i * e + j], is_bound=bool(found["screened"])))
    in_bands = stored_bands(stored, sorted({station.solved.line.weld for station in stations.values()}))
    bands = [
        band_row(key, events, passes[point].treated, values[point]["life_km"], bounds[point]["life_km"], in_bands[key])
        for point, key in ((point, stored.body.key(point)) for point in stations)
        if key in in_bands and in_bands[key]["band_reason"] != "screened"
    ]
    cycles = [row for of in passes.values() for row in of.cycles]
    histograms = [row for of in passes.values() for row in of.histograms]
    half_cycles = [row for of in passes.values() for row in of.half_cycles]
    return [
        *compare("nodes", nodes, steps),
        *compare("damage", damage, steps),
        *compare("cycles", cycles, steps),
        *(compare("histogram", histograms, steps) if histograms else []),
        *(compare("band", bands, steps) if bands else []),
        *(compare("path_cycles", half_cycles, steps) if half_cycles else []),
    ]


def _compared_stress(
    coordinates: RecountCoordinates, stations: Mapping[int, Station], stored: Stored
) -> list[ColumnCheck]:
    """Checks of the stored stress of some stations beside the solved one, few of them at a time."""
    numbers, c = np.array(list(stations)), len(coordinates)
    checks: list[ColumnCheck] = []
    for first in range(0, len(numbers), max(1, STRESS_ROWS_AT_ONCE // c)):
        few = numbers[first : first + max(1, STRESS_ROWS_AT_ONCE // c)]
        found = rows_of(stored, "structural_stress", stored.stress.of((few[:, None] * c + np.arange(c)).ravel()))
        of_station = [found[i * c : (i + 1) * c] for i in range(len(few))]
        rows = [
            row
            for number, of in zip(few.tolist(), of_station, strict=True)
            for row in stress_rows(stations[number], coordinates, of)
        ]
        checks += compare("structural_stress", rows, {})
    return checks


def _compared_welds(
    welds: Mapping[str, RecountWeld],
    stored: Stored,
    values: Mapping[Key, Values],
    bounds: Mapping[Key, Bounds],
    inputs: RecountInputs,
    frame: pd.DataFrame | None,
    *,
    all_counted: bool,
) -> list[ColumnCheck]:
    """Checks of the stored rows of some welds beside the recounted ones; ``frame`` is the table of checks."""
    least = smallest_load_factors(stored, _toes(inputs, stored.body))
    rows, asked, failed = [], inputs.case.get("checks", {}), failed_by_checks(stored.folder, inputs.case)
    for name, weld in welds.items():
        found = stored.welds.loc[name].to_dict()
        of_checks = of_weld(frame, name, least[name], asked) | dict(inputs.register.welds[name].quality)
        own = {key: of for key, of in values.items() if key[0] == name}
        more = of_checks | {"a check fails": name in failed}
        rows.append(weld_row(weld, own, bounds, found, more, all_counted=all_counted))
    return compare("welds", rows, {})


def _steps(inputs: RecountInputs, stations: Iterable[Station]) -> dict[str, float]:
    """Tolerances of columns that are found in steps where damage does not scale with one power of the load."""
    scales = not mean_stress_of(inputs).counts and all(station.weld.curve.is_straight for station in stations)
    return {} if scales else {"load_factor": LOAD_FACTOR_STEP}
