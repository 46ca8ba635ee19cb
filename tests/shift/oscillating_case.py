"""The small case with mode 2 as an oscillator under a known force, simulated at any setting."""

import pandas as pd

from tests.small_case import SmallCase, small_case
from tests.vibration.one_mode import STEP, bursts, hunting, kept, simulated

F, Z = 10.0, 0.015
OTHER = 0.2  # of the movement of mode 2 that mode 1 has, by itself


def oscillating(frequency_hz: float = F, damping: float = Z, *, gives_damping: bool = True) -> SmallCase:
    """Two events, mode 2 at a setting under bursts and hunting, mode 1 under its own force whatever mode 2 does."""
    case = small_case()
    case.modes = pd.DataFrame(
        {
            "mode": [1, 2, 7],
            "frequency_hz": [4.0, frequency_hz, 60.0],
            "kind": ["normal", "normal", "interface"],
            "damping_ratio": [0.05, damping, 0.1],
        }
    )
    if not gives_damping:
        case.modes = case.modes.drop(columns="damping_ratio")
    case.histories = {name: _history(force, frequency_hz, damping) for name, force in FORCES.items()}
    case.events = [
        {"name": "bursts", "history": "bursts", "speed_km_h": 350.0, "share": 0.6},
        {"name": "hunting", "history": "hunting", "speed_km_h": 350.0, "share": 0.4},
    ]
    return case


FORCES = {"bursts": 400.0 * bursts(1), "hunting": 200.0 * hunting(2)}


def _history(force, frequency_hz, damping):
    own, other = (kept(simulated(force[::turn], *at)) for turn, at in ((1, (frequency_hz, damping)), (-1, (4.0, 0.05))))
    t = STEP * pd.RangeIndex(len(own))
    scale = 10.0 / REFERENCE
    return pd.DataFrame({"time_s": t, "q_1": OTHER * scale * other, "q_2": scale * own, "q_7": 0.0})


REFERENCE = float(kept(simulated(FORCES["bursts"], F, Z)).std())
