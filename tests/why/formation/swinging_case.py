"""The small case with simulated modes: one swings in a burst of hunting, one follows, one is far above."""

import numpy as np
import pandas as pd

from tests.small_case import STEP, SmallCase, small_case
from tests.vibration.oscillator import FINER, response

SECONDS, BURST = 24.0, (8.0, 14.0)  # s
HUNTING_HZ, ZETA = 5.2, 0.015


def forces(seconds=SECONDS):
    """Forces on modes 1 and 2 (2, t), finely sampled: broad noise and a burst of hunting; a slow load."""
    t = STEP / FINER * np.arange(round(seconds / STEP) * FINER)
    rng = np.random.default_rng(2)
    slow = sum(
        np.sin(2.0 * np.pi * f * t + phase) for f, phase in zip((0.3, 0.7, 1.1), 6.0 * rng.random(3), strict=True)
    )
    inside = np.clip(np.minimum(t - BURST[0], BURST[1] - t), 0.0, 1.0)
    hunting = inside * np.sin(2.0 * np.pi * HUNTING_HZ * t)
    w1, w2 = 2.0 * np.pi * 5.0, 2.0 * np.pi * 12.0
    return np.stack([w1**2 * (3.0 * slow + 2.0 * hunting), w2**2 * 5.0 * slow])


def swinging_case(seconds=SECONDS) -> SmallCase:
    """Events ``worn`` with the burst, ``calm`` with the slow loads alone, and one of two samples."""
    case = small_case(seconds)
    force = forces(seconds)
    calm = force.copy()
    calm[0] = calm[1] * (5.0 / 12.0) ** 2 * 0.6
    case.modes["damping_ratio"] = [ZETA, ZETA, np.nan]
    for name, given in (("worn", force), ("calm", calm)):
        q = [response(f, STEP / FINER, hz, ZETA)[::FINER] for f, hz in zip(given, (5.0, 12.0), strict=True)]
        t = STEP * np.arange(len(q[0]))
        case.histories[name] = pd.DataFrame({"time_s": t, "q_1": q[0], "q_2": q[1], "q_7": 2.0 * np.sin(t)})
    case.histories = {name: case.histories[name] for name in ("worn", "calm", "load")}
    case.events = [
        {"name": "worn", "history": "worn", "speed_km_h": 180.0, "share": 0.25, "start_s": 2.0},
        {"name": "calm", "history": "calm", "speed_km_h": 180.0, "share": 0.75, "start_s": 2.0},
        {"name": "load and unload", "history": "load", "per_1000_km": 2.0},
    ]
    return case
