"""What the source paper asks of its analysis graph, sentence by sentence, and the numbers of these vehicles beside it.

No verdict is passed here: sentences are tested by ``[[claim]]`` of a study.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

from fatigue.report.sections.cells import Cell, Heading, PageTable
from fatigue.study.graph.summary import Graph, ranges_of
from fatigue.study.graph.vehicle_graph import VehicleGraph

DASH = "–"


@dataclass(frozen=True, slots=True)
class Ask:
    """One sentence of the paper, its section, and the text that a vehicle has for it."""

    section: str
    sentence: str
    of: Callable[[VehicleGraph, Graph], str]


def _smallest_conicity(graph: VehicleGraph, found: Graph) -> str:
    value = found.numbers[graph.name]["conicity_min"][0]
    return DASH if math.isnan(value) else f"{value:.3g}"


def _hunting(graph: VehicleGraph, found: Graph) -> str:
    numbers = found.numbers[graph.name]
    hz, at = numbers["hunting_hz_at_crossing"][0], numbers["conicity_max"][0]
    return DASH if math.isnan(hz) else f"{hz:.2f} Hz, from conicity {at:.3g} on"


def _lower_mode(graph: VehicleGraph, _: Graph) -> str:
    gains = [crossing for crossing in graph.over_conicity[0].crossings if crossing.change == "gains"]
    return DASH if not gains else f"{gains[-1].root.of.name}, {gains[-1].root.frequency_hz:.2f} Hz"


def _over_speed(conicity: float) -> Callable[[VehicleGraph, Graph], str]:
    """Stable speeds at a conicity."""

    def of(graph: VehicleGraph, _: Graph) -> str:
        line = next((line for line in graph.over_speed if line.at == conicity), None)
        return DASH if line is None else f"stable: {ranges_of(line)}"

    return of


def _over_conicity(speed: float) -> Callable[[VehicleGraph, Graph], str]:
    """Stable conicities at a speed."""

    def of(graph: VehicleGraph, _: Graph) -> str:
        line = next((line for line in graph.over_conicity if line.at == speed), None)
        return DASH if line is None else f"stable: {ranges_of(line)}"

    return of


ASKS = (
    Ask(
        "4.1, 4.2",
        "Smallest equivalent conicity: 0.10 with the stiff guidance (120/12.5 MN/m), 0.03 to 0.05 with the soft one "
        "(15/6 MN/m)",
        _smallest_conicity,
    ),
    Ask("4.1", "What is unstable below is hunting formed with the roll of the car body", _lower_mode),
    Ask(
        "4.1",
        "Bogies on worn wheels hunt at 7.0 to 8.0 Hz; with a wheelbase of 2.7 m and fewer yaw dampers at about 5.0 Hz",
        _hunting,
    ),
    Ask("4.2", "Car body unstable at 160 to 200 km/h for conicities below 0.10 (here: at 0.06)", _over_speed(0.06)),
    Ask("4.2", "Conicities of 0.25 to 0.35 on lines for 380 km/h", _over_conicity(380.0)),
    Ask("4.2", "Speeds of 450 and 575 km/h are aimed at (here: at conicity 0.3)", _over_speed(0.3)),
)


def asks_table(found: Graph) -> PageTable:
    """Sentences beside numbers, a column for each vehicle."""
    headings = (
        Heading("section", numeric=False),
        Heading("what the paper says", numeric=False),
        *(Heading(of.name, numeric=False) for of in found.vehicles),
    )
    rows = tuple(
        (Cell(ask.section), Cell(ask.sentence), *(Cell(ask.of(of, found)) for of in found.vehicles)) for ask in ASKS
    )
    return PageTable("asks", headings, rows)
