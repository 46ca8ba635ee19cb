"""Numbers of the analysis graph in a study."""

from fatigue.study.graph.numbers import graph_numbers
from fatigue.study.variants.graphed import OF_GRAPH
from fatigue.vehicle.definition import Vehicle
from fatigue.vehicle.frame_body import frame_body


def test_every_number_of_the_graph_may_stand_in_a_claim():
    """Names and units are those of the graph."""
    vehicle = Vehicle()
    found = graph_numbers(vehicle, frame_body(vehicle.car))
    assert {name: unit for name, (_, unit, _) in found.items()} == OF_GRAPH
