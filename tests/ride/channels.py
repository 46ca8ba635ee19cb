"""Channels made up for tests of a ride: noise, a burst of hunting, a converter that follows."""

import numpy as np
from scipy import signal

from fatigue.ride.channel import ChannelRecord

RATE = 200.0
START_S = 1.0
KM_PER_S = 350 / 3600


def record(values, name="bogie", role="bogie", direction="y", is_acceleration=True, **other):
    """One channel of the event "worn", at 200 Hz from 1 s on unless told otherwise."""
    placed = {"step": 1 / RATE, "start": START_S, "km_per_s": KM_PER_S} | other
    return ChannelRecord("worn", name, role, direction, is_acceleration, np.asarray(values, float), **placed)


def hunting(between=(20.3, 31.7), rms=3.0, seconds=60.0, f=7.8, rate=RATE, seed=0):
    """Lateral acceleration of a bogie: noise of about 0.3 m/s2 in the band of hunting, and a burst of ``rms``."""
    t = np.arange(round(seconds * rate)) / rate
    sos = signal.butter(2, 40, fs=rate, output="sos")
    noise = 0.75 * np.sqrt(rate / RATE) * signal.sosfilt(sos, np.random.default_rng(seed).standard_normal(t.size))
    return noise + np.sqrt(2) * rms * np.sin(2 * np.pi * f * t) * ((t >= between[0]) & (t < between[1]))


def hung(values, f_e, damping, rate=RATE, seed=1):
    """What an oscillator makes of it, and noise of its own."""
    w = 2 * np.pi * f_e
    t = np.arange(len(values)) / rate
    _, out, _ = signal.lsim(signal.lti([2 * damping * w, w**2], [1, 2 * damping * w, w**2]), values, t)
    return out + 0.2 * np.random.default_rng(seed).standard_normal(t.size)
