"""Values of a case that are allowed and hardly meant: a speed in m/s, a yield strength in Pa, a mileage in m.

Each kind is told once, with the value that is furthest off and the places of the others.
"""

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from fatigue.case.tables import Case
from fatigue.errors import Problem
from fatigue.files.look_alike import name_warnings
from fatigue.shown import few, shortened

YEARS = 100.0  # no vehicle lasts longer; the mileage in m, or that of a month, makes more
NO_DAMAGE = "the event is never passed and does no damage"


@dataclass(frozen=True, slots=True)
class Usual:
    """What values of a key usually are: between two bounds, of which ``why`` says where they come from."""

    code: str
    low: float
    high: float
    unit: str
    why: str
    remedy: str

    def distance(self, value: float) -> float:
        """How far a value lies outside: the factor to the nearer bound, 1 inside."""
        return max(value / self.high, self.low / value if value > 0 else math.inf, 1.0)


SPEED = Usual("unusual_speed", 1.0, 600.0, "km/h", "no train is faster", "Give km/h; 100 m/s are 360 km/h")
YIELD = Usual(
    "unusual_yield",
    20.0,
    2000.0,
    "MPa",
    "annealed aluminium to maraging steel",
    "Give MPa: 1 ksi is 6.895, 1e6 Pa is 1",
)
SHARE = Usual("unusual_share", 1e-5, 1.0, "", "10 m in 1000 km", "Give the share of the mileage, not of something else")
NUMBER = Usual("unusual_number", 1e-4, 1e5, "", "once in 10 million km to every 10 m", "Count the events in 1000 km")
FACTOR = Usual("unusual_factor", 0.1, 10.0, "", "what partial and allowance factors are", "Convert units elsewhere")
TARGET = Usual("unusual_mileage", 1e3, 1e8, "km", "a trial run to 100 million km", "Give km, not m")
PER_YEAR = Usual("unusual_mileage", 100.0, 3.1e6, "km", "a year of 8760 h at 350 km/h", "Give km in a year")
LIMIT = Usual("unusual_limit", 0.05, 2.0, "", "damage sums at failure", "Give a damage sum, not per cent")
CYCLES = Usual("unusual_curve", 1e4, 1e10, "", "low cycles to giga-cycles", "Give cycles, not their logarithm")
RANGE = Usual("unusual_curve", 5.0, 1000.0, "MPa", "weld details to base material", "Give MPa")
SLOPE = Usual("unusual_curve", 1.5, 25.0, "", "what S-N curves have", "Give k of N = A S^-k, not 1 / k")
SCATTER = Usual(
    "unusual_curve", 0.02, 1.0, "", "what test series have", "Give the standard deviation of log10 of cycles"
)


def case_warnings(case: Case) -> list[Problem]:
    """Warnings about values of a case that are hardly meant, and about events whose names look alike."""
    found: dict[str, list[tuple[str, float, Usual]]] = {}
    for place, value, usual in _values(case):
        if usual.distance(value) > 1.0:
            found.setdefault(usual.code, []).append((place, value, usual))
    file, mission = case.path.name, case.mission
    warnings = [_told(file, values) for values in found.values()]
    idle = [event.name for event in mission.event if event.share == 0.0 or event.per_1000_km == 0.0]
    if idle:
        names = few([f"'{name}'" for name in idle])
        warnings.append(Problem("idle_event", f"{file}: mission.event {names}", NO_DAMAGE, "Leave it out", len(idle)))
    years = mission.target_km / mission.km_per_year
    if years > YEARS and "unusual_mileage" not in found:
        what = f"target_km = {mission.target_km:g} at km_per_year = {mission.km_per_year:g} takes {years:.4g} years"
        remedy = f"Check both: few vehicles last {YEARS:g} years"
        warnings.append(Problem("unusual_mileage", f"{file}: mission.target_km", what, remedy))
    loads = (load.name for load in case.body.unit_load)
    warnings += name_warnings(f"{file}: body.unit_load.name", loads, "unit loads")
    return warnings + name_warnings(f"{file}: mission.event.name", (event.name for event in mission.event), "events")


def _values(case: Case) -> Iterator[tuple[str, float, Usual]]:
    """Every value of the case that is compared with what it usually is, with its place."""
    mission = case.mission
    for number, event in enumerate(mission.event, 1):
        place, name = f"mission.event[{number}]", f"('{shortened(event.name)}')"
        of_event = (
            ("speed_km_h", event.speed_km_h, SPEED),
            ("share", event.share, SHARE),
            ("per_1000_km", event.per_1000_km, NUMBER),
            ("stress_factor", event.stress_factor, FACTOR),
        )
        yield from ((f"{place}.{key} {name}", value, usual) for key, value, usual in of_event if value)
    yield "mission.target_km", mission.target_km, TARGET
    yield "mission.km_per_year", mission.km_per_year, PER_YEAR
    yield "mission.damage_limit", mission.damage_limit, LIMIT
    if case.curve.yield_MPa is not None:
        yield "curve.yield_MPa", case.curve.yield_MPa, YIELD
    if case.curve.extension != "none":
        yield "curve.knee_cycles", case.curve.knee_cycles, CYCLES
    for name, curve in case.curves.items():
        place = f"curves.{shortened(name)}"
        if curve.range_at_2e6_MPa is not None:
            yield f"{place}.range_at_2e6_MPa", curve.range_at_2e6_MPa, RANGE
        yield from ((f"{place}.slopes", slope, SLOPE) for slope in curve.slopes or ())
        yield from ((f"{place}.knees_cycles", knee, CYCLES) for knee in curve.knees_cycles)
        if curve.log10_scatter is not None:
            yield f"{place}.log10_scatter", curve.log10_scatter, SCATTER
        yield from ((f"{place}.{key}", getattr(curve, key), FACTOR) for key in ("gamma_Ff", "gamma_Mf"))
        if curve.damage_limit is not None:
            yield f"{place}.damage_limit", curve.damage_limit, LIMIT


def _told(file: str, found: Iterable[tuple[str, float, Usual]]) -> Problem:
    """One warning for all values of a kind: the one that is furthest off, and the places of the others."""
    (place, value, usual), *others = sorted(found, key=lambda one: -one[2].distance(one[1]))
    key = place.split(" (")[0].rpartition(".")[2]
    unit = f" {usual.unit}" if usual.unit else ""
    what = f"{key} = {value:g} is outside {usual.low:g} to {usual.high:g}{unit} ({usual.why})"
    if others:
        what += f"; likewise {few([f'{value:g} at {place}' for place, value, _ in others])}"
    return Problem(usual.code, f"{file}: {place}", what, usual.remedy, 1 + len(others))
