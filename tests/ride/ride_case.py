"""The small case with channels: an acceleration of the bogie that hunts for a while, and the stress that follows it."""

import numpy as np

from tests.small_case import STEP, SmallCase, small_case

HUNTING_HZ = 9.0
HOT = (20.0, 32.0)  # s in which the bogie hunts
CHANNEL = '{ name = "bogie y", column = "a_bogie", unit = "m/s2", role = "bogie", direction = "y" }'


def ride_case(peak: float = 7.0, seconds: float = 60.0) -> SmallCase:
    """A tangent with hunting of ``peak`` m/s2 for a fifth of its time; only mode 1 has stress, which follows it.

    Of all points of a weld the membrane stress is q_1 and the bending stress of the top face half of it [MPa].
    """
    case = small_case(seconds)
    t = np.arange(round(seconds / STEP)) * STEP
    rng = np.random.default_rng(3)
    hunts = np.sin(2.0 * np.pi * HUNTING_HZ * t) * ((t >= HOT[0]) & (t < HOT[1]))
    noise = np.convolve(rng.standard_normal(len(t)), np.ones(4) / 4.0, mode="same")
    tangent = case.histories["noise"].assign(q_1=25.0 * hunts + 8.0 * noise, q_2=0.0, q_7=0.0)
    case.histories = {"tangent": tangent.assign(a_bogie=peak * hunts + 0.4 * noise)}
    case.events = [{"name": "tangent", "history": "tangent", "speed_km_h": 360.0, "share": 1.0, "start_s": 1.0}]
    case.spectrum = {"segment_s": 2.0}
    return case


def with_channels(case_file, *channels, event="tangent"):
    """Give an event of a written case some channels, lines of TOML between braces."""
    text = case_file.read_text()
    line = f"channel = [{', '.join(channels)}]"
    case_file.write_text(text.replace(f'name = "{event}"', f'name = "{event}"\n{line}', 1))
    return case_file
