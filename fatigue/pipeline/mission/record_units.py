"""Times of records that cannot be s (refusals), and times that hardly are (warnings).

A wrong unit of time leaves every stress as it is: with times in ms an event lasts a thousand times as long, covers a
thousand times the distance, and does a thousandth of its damage per km. So the step of a record is compared with the
periods of the body's own vibration, which a simulation of a flexible body has to follow. One of a body so stiff that it
does not vibrate may leave them out: its step is short all the same.
"""

import numpy as np

from fatigue.errors import Problem
from fatigue.readers.neutral.body.modes import Modes
from fatigue.readers.neutral.history import TimeGrid

FEWEST_SAMPLES = 100  # shorter records are load cases typed in by hand, their times may be anything
COARSE = 0.05  # [s] simulations write steps of 0.0001 to 0.02 s; in ms the shortest of them is above
FINEST = 1000.0  # samples in a period of the fastest mode; simulations write 5 to 50


def step_problems(grid: TimeGrid, modes: Modes, file: str, event: str) -> list[Problem]:
    """Problems of a coarse step in which every vibration passes a period; ``file`` is the record of ``event``."""
    slowest, _ = _vibration_hz(grid, modes)
    if grid.step * slowest <= 1.0 or grid.step < COARSE:
        return []
    in_ms = grid.step / 1000.0
    looks = f", it looks like ms (a step of {in_ms:g} s)" if in_ms < COARSE else ""
    remedy = f"Give time_s in s{looks}; if the record is really quasi-static, interpolate it to a shorter step"
    return [_too_long(grid, slowest, file, event, remedy)]


def step_warnings(grid: TimeGrid, modes: Modes, file: str, event: str) -> list[Problem]:
    """Warnings of a step that leaves out all vibration, or is far shorter than any needs.

    They are for records of which ``step_problems`` finds nothing.
    """
    slowest, fastest = _vibration_hz(grid, modes)
    if grid.step * slowest > 1.0:
        remedy = "Check that time_s is in s, and sample the simulation more finely unless the body is quasi-static"
        return [_too_long(grid, slowest, file, event, remedy)]
    if grid.step * fastest * FINEST >= 1.0:
        return []
    return [
        Problem(
            "short_step",
            f"{file}: column time_s",
            f"the step of event '{event}' is {grid.step:g} s, less than a thousandth of a period of the fastest normal "
            f"mode ({1.0 / fastest:.3g} s, {fastest:.3g} Hz)",
            "Check that time_s is in s",
        )
    ]


def _vibration_hz(grid: TimeGrid, modes: Modes) -> tuple[float, float]:
    """Frequencies of the slowest and the fastest normal mode [Hz]; 0 and infinity where nothing is judged by them."""
    vibration_hz = modes.vibration_hz
    if grid.samples < FEWEST_SAMPLES or not vibration_hz.size:
        return 0.0, np.inf
    return float(vibration_hz.min()), float(vibration_hz.max())


def _too_long(grid: TimeGrid, slowest: float, file: str, event: str, remedy: str) -> Problem:
    return Problem(
        "long_step",
        f"{file}: column time_s",
        f"the step of event '{event}' is {grid.step:g} s, longer than a period of the slowest normal mode "
        f"({1.0 / slowest:.3g} s, {slowest:.3g} Hz), so the record cannot hold any vibration of the body",
        remedy,
    )
