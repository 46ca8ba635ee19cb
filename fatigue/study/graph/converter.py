"""Which lateral frequency the converter has in a vehicle, as numbers and in words: the nominal one is not it."""

from collections.abc import Mapping

from fatigue.vehicle.definition import Vehicle
from fatigue.vehicle.elastic import ElasticBody
from fatigue.vehicle.stability.coupled import coupled

Value = tuple[float, str, str]  # value, unit, reason

OWN = 0.5  # share of the energy from which a mode is the converter's own


def converter_numbers(vehicle: Vehicle, body: ElasticBody) -> dict[str, Value]:
    """Value, unit and reason of the lateral frequencies of the converter, by name.

    ``converter_in_series_hz`` : on its mounts with the hangers in series, the body held still otherwise [Hz]
    ``converter_coupled_hz`` : undamped, on the free car body [Hz]; ``converter_coupled_share`` : share of the kinetic
    energy of that mode in lateral motion of the converter
    ``converter_running_hz``, ``converter_running_damping`` : of the root at speed and conicity of the vehicle
    """
    found = coupled(vehicle, body)
    return {
        "converter_in_series_hz": (found.in_series_hz, "Hz", ""),
        "converter_coupled_hz": (found.coupled_hz, "Hz", ""),
        "converter_coupled_share": (found.coupled_share, "-", ""),
        "converter_running_hz": (found.running.frequency_hz, "Hz", ""),
        "converter_running_damping": (found.running.damping, "-", ""),
    }


def converter_line(nominal_hz: float, numbers: Mapping[str, Value]) -> str:
    """The frequencies in one line for people.

    >>> hz = {"in_series": 9.07, "coupled": 8.865, "coupled_share": 0.61, "running": 8.9}
    >>> numbers = {f"converter_{k}" + ("" if "share" in k else "_hz"): (v, "", "") for k, v in hz.items()}
    >>> converter_line(9.2, numbers)
    'converter laterally 9.2 Hz by its mounts, 9.07 Hz with the hangers, 8.87 Hz coupled, 8.90 Hz running'
    """
    series, free, share, running = (
        numbers[f"converter_{name}"][0] for name in ("in_series_hz", "coupled_hz", "coupled_share", "running_hz")
    )
    said = f"converter laterally {nominal_hz:g} Hz by its mounts, {series:.2f} Hz with the hangers"
    if share < OWN:
        return f"{said}; coupled it shares modes of the body, at most {100 * share:.0f} % at {free:.2f} Hz"
    return f"{said}, {free:.2f} Hz coupled, {running:.2f} Hz running"
