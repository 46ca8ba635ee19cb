"""Channels as tests make them: sines and noise of any role and direction."""

from dataclasses import replace

import numpy as np

from fatigue.ride.channel import ChannelRecord

RATE = 250.0


def sine(amplitude=0.5, frequency=5.4, duration=60.0, rate=RATE):
    """Sine (n,) that begins with a phase of 0.3."""
    return amplitude * np.sin(2 * np.pi * frequency * np.arange(round(duration * rate)) / rate + 0.3)


def noise(rms=0.5, duration=60.0, rate=RATE, seed=1):
    """White noise (n,)."""
    return rms * np.random.default_rng(seed).standard_normal(round(duration * rate))


def channel(values, name="mid z", role="floor", direction="z", rate=RATE, speed=360.0, **other):
    """Channel of an event at 360 km/h, 100 m in a second; ``speed`` None: counted by number."""
    record = ChannelRecord(
        event="worn",
        name=name,
        role=role,
        direction=direction,
        is_acceleration=True,
        values=np.asarray(values, float),
        step=1 / rate,
        start=1.0,
        km_per_s=np.nan if speed is None else speed / 3600.0,
    )
    return replace(record, **other)
