"""The recount of welds under other assumptions: points of some rows counted under the changed case.

A row that names a point has the largest utilisation of the weld, which is that of its point. A row that stands for a
bound has to lie on its side of what is counted: at the worst point of the assessment, and at all toe points of the weld
where everything is recounted.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from fatigue.verify.recount.anew.across_events.loop import loop_pass
from fatigue.verify.recount.anew.curve import curve_named
from fatigue.verify.recount.anew.mission import RecountEvent, bounds_of_point, point_values
from fatigue.verify.recount.anew.point import OnePass, RecountPoint, Values, one_pass, point_of
from fatigue.verify.recount.anew.record import FEWEST_SAMPLES, read_record, spectrum_rules
from fatigue.verify.recount.anew.shear.columns import AtPoint, ShearExtent, shear_bounds, shear_extent, shear_values
from fatigue.verify.recount.anew.shear.passes import ShearPass, ShearRules, shear_pass
from fatigue.verify.recount.anew.varied import RAW_END, SAMPLING, SHEAR, expected_variants, limited, varied_case
from fatigue.verify.recount.counted import loop_names, mean_stress_of
from fatigue.verify.recount.inputs.case import RecountInputs, strength_factors
from fatigue.verify.recount.inputs.coordinates import RecountCoordinates
from fatigue.verify.recount.layout import Layout
from fatigue.verify.recount.stored.compare import TOLERANCE, ColumnCheck, Row, compare, merged
from fatigue.verify.recount.stored.rows import Station
from fatigue.verify.recount.stored.sensitivity import (
    AT_A_POINT,
    chosen_rows,
    consistent,
    missing_rows,
    sensitivity_of,
    where,
)
from fatigue.verify.recount.stored.shear import DECIDING
from fatigue.verify.recount.stored.tables import Stored, fastest_peaks

StationOf = Callable[[str, int, int], Station]
Place = tuple[int, int, str]  # part, order, surface
PATH_SAMPLES = 300_000  # of paths that are counted where rows are drawn: some ten seconds


@dataclass(slots=True, eq=False)
class Asked:
    """A toe point under a variant.

    Attributes
    ----------
    variant, point : its name, and the stresses of the point on the curve of the variant
    method : of shear that decides with the normal stress; empty: none
    passes : of every event and loop, filled as records are read
    extents, paths : of every event, where a method of shear needs them
    """

    variant: str
    point: RecountPoint
    method: str
    passes: list[OnePass] = field(default_factory=list)
    extents: list[ShearExtent] = field(default_factory=list)
    paths: list[ShearPass] = field(default_factory=list)

    @property
    def has_path(self) -> bool:
        """Whether the path of normal stress and shear is counted."""
        return self.method not in ("", "asme")


@dataclass(slots=True, eq=False)
class Weld:
    """A row of the table and the points of its weld that are counted; ``everywhere``: at all of its toe points."""

    row: Mapping[str, Any]
    points: dict[Place, Asked]
    node: dict[Place, int]
    everywhere: bool


@dataclass(frozen=True, slots=True, eq=False)
class Job:
    """What the points are made from and counted with."""

    inputs: RecountInputs
    coordinates: RecountCoordinates
    record: Mapping[str, Any]
    rules: ShearRules
    factors: Sequence[Mapping[str, Any]]


def check_sensitivity(
    stored: Stored,
    inputs: RecountInputs,
    coordinates: RecountCoordinates,
    record: Mapping[str, Any],
    station_of: StationOf,
    sampling: Sequence[tuple[float, int]],
    *,
    sample: int | None,
    seed: int,
    most: int,
    samples: int,
) -> list[ColumnCheck]:
    """Checks of the table of welds under other assumptions; none of a result that is older than the table.

    ``most`` points of ``samples`` each may be counted where rows are drawn.
    """
    rows = sensitivity_of(stored.folder)
    if not rows:
        return []
    asked = inputs.case.get("multiaxial", {})
    rules = ShearRules(asked.get("method", "report"), asked.get("beta", 3.0), asked.get("alpha"))
    variants = expected_variants(inputs.case, rules.method, {row["variant"] for row in rows})
    keys = missing_rows(rows, variants, stored.body.welds)
    if not keys.passed:
        return [keys]
    job = Job(inputs, coordinates, record, rules, strength_factors(inputs))
    known = [row for row in rows if row["variant"] != "upsample_auto" or _peaks_are_known(job, stored)]
    welds = _chosen(known, stored, job, station_of, sample=sample, seed=seed, most=most, samples=samples)
    points = [point for weld in welds for point in weld.points.values()]
    events = _count(points, job, stored, sampling)
    own = [_row(weld, {at: _utilisation(point, job, events) for at, point in weld.points.items()}) for weld in welds]
    return [keys, *merged(compare("sensitivity", [*consistent(rows, stored.welds), *own], {}))]


def _peaks_are_known(job: Job, stored: Stored) -> bool:
    """Whether the result has peaks per second of every event that is a signal.

    One that is shorter than a segment has none in its tables: the program upsamples it by shorter segments.
    """
    events = job.record["mission"]["events"]
    by_auto = replace(job.inputs, case=varied_case(job.inputs.case, "upsample_auto"))
    fastest = fastest_peaks(stored.folder, by_auto, [event["name"] for event in job.inputs.case["mission"]["event"]])
    return all(peaks > 0.0 or event["samples"] < FEWEST_SAMPLES for peaks, event in zip(fastest, events, strict=True))


def _chosen(
    rows: Sequence[Mapping[str, Any]],
    stored: Stored,
    job: Job,
    station_of: StationOf,
    *,
    sample: int | None,
    seed: int,
    most: int,
    samples: int,
) -> list[Weld]:
    """The rows to recount with their points, as many as may be counted."""
    chosen, left, paths = [], max(most, 2), max(PATH_SAMPLES // samples, 2)
    for number in chosen_rows(rows, sample=sample, seed=seed):
        one = _weld(rows[number], stored, job, station_of, everywhere=sample is None)
        needed, of_paths = len(one.points), sum(point.has_path for point in one.points.values())
        if sample is not None and (needed > left or of_paths > paths):
            continue
        left, paths = left - needed, paths - of_paths
        chosen.append(one)
    return chosen


def _weld(row: Mapping[str, Any], stored: Stored, job: Job, station_of: StationOf, *, everywhere: bool) -> Weld:
    """A row with the point that it names and the worst one of the assessment, or with all toe points of its weld."""
    body, assessed = stored.body, stored.welds.loc[row["weld"]]
    of_weld = _stations(body, row["weld"])
    toes = station_of(row["weld"], *of_weld[0]).weld.toes
    places: list[Place] = [(*at, surface) for at in of_weld for surface in toes]
    if not everywhere:
        worst = int(assessed["worst_part"]), int(assessed["worst_order"]), str(assessed["worst_surface"])
        named = row["part"], row["order"], row["surface"]
        places = [place for place in places if place in (worst, named)]
    stations = {place: station_of(row["weld"], place[0], place[1]) for place in places}
    return Weld(
        row=row,
        points={place: _asked(row["variant"], station, place[2], job) for place, station in stations.items()},
        node={place: int(station.solved.line.node[station.at]) for place, station in stations.items()},
        everywhere=everywhere,
    )


def _stations(body: Layout, weld: str) -> list[tuple[int, int]]:
    """Part and order of each station of a weld."""
    at = np.flatnonzero(body.weld == body.welds.index(weld))
    return list(zip(body.part[at].tolist(), body.order[at].tolist(), strict=True))


def _asked(variant: str, station: Station, surface: str, job: Job) -> Asked:
    """A toe point with the stress and the curve of a variant."""
    solved, line, weld = station.solved, station.solved.line, station.weld
    components = (solved.raw if variant == RAW_END else solved.treated)[station.at]
    curve = curve_named(weld.curve_name, varied_case(job.inputs.case, variant), job.record, job.factors)
    thickness = float(line.thickness[station.at])
    point = point_of(components, station.largest, surface, limited(curve, variant), thickness, weld.attachment)
    method = SHEAR.get(variant, job.rules.method if job.rules.method in DECIDING else "")
    return Asked(variant, point, method)


def _count(
    points: Sequence[Asked], job: Job, stored: Stored, sampling: Sequence[tuple[float, int]]
) -> list[RecountEvent]:
    """Passes of every event and loop at all points, one record in memory at a time; returns the events."""
    mission = job.inputs.case["mission"]
    names = [event["name"] for event in mission["event"]]
    loops = mission.get("sequence", [])
    f_M = mean_stress_of(job.inputs)
    events: list[RecountEvent] = []
    sampled = next((one.variant for one in points if one.variant in SAMPLING), None)
    for variant in [None, *([sampled] if sampled else [])]:
        inputs, own, events = job.inputs, [one for one in points if one.variant not in SAMPLING], []
        if variant is not None:
            inputs = replace(inputs, case=varied_case(inputs.case, variant))
            own = [one for one in points if one.variant == variant]
            fastest = fastest_peaks(stored.folder, inputs, [*names, *loop_names(inputs)])
            sampling = [(rate, recorded) for rate, (_, recorded) in zip(fastest, sampling, strict=False)]
        for number, given in enumerate(mission["event"]):
            record = replace(read_record(inputs, given, job.coordinates, *sampling[number]), has_spectrum=False)
            spectrum = spectrum_rules(inputs.case, job.coordinates, record.step)
            events.append(RecountEvent(record.name, record.length_km, record.passes_per_km))
            keeps = number if any(given["name"] in loop["order"] for loop in loops) else None
            for one in own:
                one.passes.append(replace(one_pass(one.point, record, spectrum, f_M, keeps), rows={}))
                if one.method:
                    one.extents.append(shear_extent(one.point, record, job.rules.beta))
                if one.has_path:
                    one.paths.append(replace(shear_pass(one.point, record, job.rules, f_M), rows={}))
        orders = [[names.index(name) for name in loop["order"]] for loop in loops]
        for one in own:
            one.passes += [loop_pass(one.point, order, one.passes[: len(names)], f_M)[0] for order in orders]
    return events + [
        RecountEvent(f"(sequence {i})", None, loop["per_1000_km"] / 1000) for i, loop in enumerate(loops, 1)
    ]


def _utilisation(of: Asked, job: Job, events: Sequence[RecountEvent]) -> tuple[float, float]:
    """Utilisation of a point under its variant, and what rounding may do to it."""
    mission, curve, n = job.inputs.case["mission"], of.point.curve, len(job.inputs.case["mission"]["event"])
    raw = [one.quantities["damage_per_pass"] for one in of.passes]
    mean_stress = mean_stress_of(job.inputs)
    normal = point_values(of.passes, raw, events, mission, curve, mean_stress)
    of_raw = [one.bounds["damage_per_pass"] for one in of.passes]
    rounding = bounds_of_point(of.passes, of_raw, events, mission, curve, normal)
    used = float(normal["utilisation"])
    if not of.method:
        return used, rounding["utilisation"]
    normal["damage_per_km_transitions"] = float(
        sum(event.passes_per_km * damage for event, damage in zip(events[n:], raw[n:], strict=True))
    )
    at = AtPoint(of.point, of.passes[:n], of.extents, of.paths or None, mean_stress, np.nan, has_sums=False)
    by_method = shear_values(at, normal, events[:n], mission, job.rules.beta)
    own = shear_bounds(at, normal, rounding, by_method, events[:n], mission, job.rules.beta)
    name = "utilisation_asme" if of.method == "asme" else f"utilisation_path_{of.method}"
    return float(np.fmax(used, by_method[name])), max(rounding["utilisation"], own[name])


def _row(weld: Weld, found: Mapping[Place, tuple[float, float]]) -> Row:
    """A row as it should be: the largest utilisation of its points, or the stored bound where it is on its side."""
    row = weld.row
    stored, basis = float(row["utilisation"]), row["basis"]
    named = row["part"], row["order"], row["surface"]
    worst = max(found, key=lambda place: found[place][0])
    largest, rounding = found[worst]
    expected: Values = {}
    if basis in AT_A_POINT:
        is_worst = named in found and (
            basis == "counted" or found[named][0] + found[named][1] >= largest * (1.0 - TOLERANCE) - rounding
        )
        at = named if is_worst else worst
        used, rounding = found[at]
        expected = {"part": at[0], "node": weld.node[at], "order": at[1], "surface": at[2], "utilisation": used}
        expected["fulfilled"] = (largest if basis == "counted" else used) <= 1.0
    elif row["fulfilled"] and basis == "bound":  # at most this
        expected = {"utilisation": stored if largest <= stored * (1.0 + TOLERANCE) + rounding else largest}
        expected["fulfilled"] = largest <= 1.0
    elif weld.everywhere:  # at least this
        expected = {"utilisation": stored if largest >= stored * (1.0 - TOLERANCE) - rounding else largest}
        expected |= {"fulfilled": largest <= 1.0} if basis == "bound" else {}
    unsure = np.inf if abs(largest - 1.0) <= TOLERANCE else 0.0
    return Row(where(row), row, expected, {}, bounds={"utilisation": rounding, "fulfilled": unsure})
