"""Numbers of the analysis graph where claims ask for any: of the variants they name, the same under every seed."""

from collections.abc import Iterator, Sequence

from fatigue.errors import FatigueError
from fatigue.study.car_body import car_body
from fatigue.study.claims import Claim
from fatigue.study.claims.place import variant_of
from fatigue.study.graph.numbers import Value, graph_numbers
from fatigue.study.quantities import Number
from fatigue.study.variants.varied.base_files import BaseFiles
from fatigue.study.variants.varied.expansion import Plan
from fatigue.vehicle.definition import Car, Vehicle
from fatigue.vehicle.elastic import ElasticBody

OF_GRAPH = {
    "conicity_min": "-",
    "conicity_max": "-",
    "conicity_min_hz": "Hz",
    "conicity_max_hz": "Hz",
    "hunting_hz_at_crossing": "Hz",
    "critical_speed_km_h": "km/h",
    "stable_again_km_h": "km/h",
    "hunting_speed_km_h": "km/h",
    "hunting_speed_hz": "Hz",
    "least_damping": "-",
    "least_damping_hz": "Hz",
    "worn_hunting_hz": "Hz",
    "converter_in_series_hz": "Hz",
    "converter_coupled_hz": "Hz",
    "converter_coupled_share": "-",
    "converter_running_hz": "Hz",
    "converter_running_damping": "-",
}
"""Numbers of the analysis graph and their units."""


def graphed(claims: Sequence[Claim], files: BaseFiles, plan: Plan, seeds: Sequence[int]) -> Iterator[Number]:
    """Numbers of the graph of variants whose graph claims name, under every seed; none of a study without a vehicle.

    A vehicle that has no graph, as one whose body is damaged, has NaN with the reason.
    """
    if files.vehicle is None:
        return
    changes = {planned.variant.name: planned.changes for planned in plan.variants}
    variants = [planned.variant for planned in plan.variants]
    terms = (term for claim in claims for side in claim.expressions for term in side.terms)
    asked = (variant_of(term, variants) for term in terms if term.quantity in OF_GRAPH)
    wanted = dict.fromkeys(variant.name for variant in asked if variant is not None)
    bodies: dict[Car, ElasticBody] = {}
    for name in wanted:
        vehicle = files.changed_vehicle(changes[name])
        assert vehicle is not None
        for quantity, (value, unit, reason) in _of_vehicle(vehicle, bodies).items():
            yield from (Number(name, seed, quantity, "", float(value), unit, reason) for seed in seeds)


def _of_vehicle(vehicle: Vehicle, bodies: dict[Car, ElasticBody]) -> dict[str, Value]:
    """All numbers of the graph of a vehicle, or for each the reason why there is none."""
    try:
        if vehicle.car not in bodies:
            bodies[vehicle.car] = car_body(vehicle)
        return graph_numbers(vehicle, bodies[vehicle.car])
    except FatigueError as error:
        return {name: (float("nan"), unit, str(error.problems[0])) for name, unit in OF_GRAPH.items()}
