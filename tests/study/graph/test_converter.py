"""Lateral frequencies of the converter among the numbers of the graph, and the line that says them."""

from fatigue.study.graph.converter import converter_line, converter_numbers
from fatigue.vehicle.definition import Vehicle
from fatigue.vehicle.stability.coupled import coupled, with_mounts
from tests.vehicle_oracles import body


def test_numbers_are_those_of_the_vehicle():
    """One number each, with its unit."""
    found, numbers = coupled(Vehicle(), body()), converter_numbers(Vehicle(), body())
    assert numbers["converter_in_series_hz"] == (found.in_series_hz, "Hz", "")
    assert numbers["converter_coupled_hz"] == (found.coupled_hz, "Hz", "")
    assert numbers["converter_coupled_share"] == (found.coupled_share, "-", "")
    assert numbers["converter_running_hz"] == (found.running.frequency_hz, "Hz", "")
    assert numbers["converter_running_damping"] == (found.running.damping, "-", "")


def test_the_line_names_no_frequency_that_the_converter_does_not_have():
    """At 9.2 Hz it has a mode of its own; at 14 Hz on the frame body none, and the line says so."""
    own = converter_line(9.2, converter_numbers(Vehicle(), body()))
    assert own == "converter laterally 9.2 Hz by its mounts, 9.20 Hz with the hangers, 8.99 Hz coupled, 9.03 Hz running"
    shared = converter_line(14.0, converter_numbers(with_mounts(Vehicle(), 14.0), body()))
    assert shared.endswith("with the hangers; coupled it shares modes of the body, at most 27 % at 20.82 Hz")
