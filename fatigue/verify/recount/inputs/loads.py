"""What every event gives of every unit load, read anew from the case."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.verify.recount.inputs.case import RecountInputs
from fatigue.verify.recount.inputs.tables import read_pieces

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class RecountLoad:
    """One unit load in one event: a constant, samples at ``times`` [s], or samples on the grid of the event.

    Attributes
    ----------
    constant : carried beside the samples; 0 where there are samples
    samples : (n,) values; None: a constant
    times : (n,) of a file of its own; None: the samples are those of the event
    is_linear : straight between samples, not by trigonometric interpolation
    """

    constant: float = 0.0
    samples: Floats | None = None
    times: Floats | None = None
    is_linear: bool = False

    @property
    def step(self) -> float:
        """Time step [s], infinite of what has no grid of its own."""
        if self.times is None:
            return np.inf
        return float((self.times[-1] - self.times[0]) / (len(self.times) - 1))


def loads_of(inputs: RecountInputs, event: Mapping[str, Any]) -> list[RecountLoad]:
    """Unit loads of an event in the order of the case: as the event says, else the mission, else ``when_missing``."""
    of_event = {given["name"]: given for given in event.get("unit_load", [])}
    of_mission = {given["name"]: given for given in inputs.case["mission"].get("unit_load", [])}
    own = inputs.folder / event["history"] if "history" in event else None
    loads = []
    for load in inputs.case["body"].get("unit_load", []):
        name = load["name"]
        if name in of_event:
            loads.append(_given(inputs.folder, of_event[name]))
        elif own is not None and (samples := _column(own, f"u_{name}")) is not None:
            loads.append(RecountLoad(samples=samples))
        else:
            loads.append(RecountLoad(of_mission.get(name, {"constant": 0.0})["constant"]))
    return loads


def _given(folder: Path, given: Mapping[str, Any]) -> RecountLoad:
    scale, is_linear = given.get("scale", 1.0), given.get("interpolation", "fourier") == "linear"
    if "constant" in given:
        return RecountLoad(scale * given["constant"])
    if "values" in given:
        return RecountLoad(samples=scale * np.array(given["values"], dtype=float))
    path, column = folder / given["history"], given.get("column", f"u_{given['name']}")
    times = _of_file(path, "time_s") + given.get("shift_s", 0.0)
    return RecountLoad(samples=scale * _of_file(path, column), times=times, is_linear=is_linear)


def _of_file(path: Path, column: str) -> Floats:
    found = _column(path, column)
    assert found is not None
    return found


def _column(path: Path, column: str) -> Floats | None:
    """One column of a history, None where it is not there."""
    pieces = [piece[column].to_numpy(dtype=float) for piece in read_pieces(path, ["time_s", column]) if column in piece]
    return np.concatenate(pieces) if pieces else None
