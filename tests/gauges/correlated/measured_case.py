"""A small case with gauges, and records of them made from the simulation itself, spoilt as a test wants it."""

from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pandas as pd

from fatigue.case import load_case
from fatigue.gauges.gauge_file import read_gauges
from fatigue.gauges.rows import gauge_rows
from fatigue.gauges.simulated import simulated
from fatigue.pipeline.solve.body import read_body
from fatigue.pipeline.solve.weld_groups import weld_groups
from tests.small_case import small_case

EVENT = "noise"
HIGHEST_HZ = 18.0  # 1.5 x the highest normal mode
RATE = 200.0
KM = 1.1  # of a pass: 11 s at 360 km/h
GAUGES = ("G1", "G2", "G3")


@dataclass(frozen=True)
class MeasuredCase:
    """Files of a case with gauges G1, G2, G3, and what they read in the event: strain (3, 2200) [ue] at 200 Hz."""

    folder: Path
    strain: np.ndarray

    @property
    def case(self):
        """The case file."""
        return self.folder / "case.toml"

    @property
    def gauges(self):
        """The table of gauges."""
        return self.folder / "gauges.csv"

    def channels(self, name="channels", **columns):
        """A table of channels C1, C2, C3 of the gauges, in ue unless told otherwise; rows of a speed behind them."""
        table = {"channel": ["C1", "C2", "C3"], "gauge": list(GAUGES), "unit": "ue"} | columns
        path = self.folder / f"{name}.csv"
        pd.DataFrame(table).to_csv(path, index=False)
        return path

    def record(self, name="ride", strain=None, rate=RATE, **columns):
        """A record of the channels at a rate, with further columns."""
        x = self.strain if strain is None else strain
        table = {"time_s": 3.0 + np.arange(x.shape[1]) / rate} | {f"C{i + 1}": row for i, row in enumerate(x)}
        path = self.folder / f"{name}.parquet"
        pd.DataFrame(table | columns).to_parquet(path, index=False)
        return path


def measured_case(folder):
    """Write the case, its gauges, and read them in the simulation."""
    small_case().write(folder)
    pd.DataFrame(
        {
            "gauge": GAUGES,
            "kind": "toe",
            "weld": ["A", "A", "B"],
            "order": [2, 5, 4],
            "surface": ["top", "bottom", "top"],
            "E_MPa": 70000.0,
            "nu": 0.3,
        }
    ).to_csv(folder / "gauges.csv", index=False)
    body = read_body(load_case(folder / "case.toml"), strict=False)
    gauges, _ = read_gauges(folder / "gauges.csv")
    with TemporaryDirectory() as scratch:
        rows, _ = gauge_rows(weld_groups(body, Path(scratch)), gauges)
        event = next(event for event in body.case.mission.event if event.name == EVENT)
        return MeasuredCase(folder, np.array(simulated(body, rows, event).strain))


def delayed(x, seconds, rate=RATE):
    """Signals (..., t) later by any time, around the record."""
    f = np.fft.rfftfreq(x.shape[-1], 1.0 / rate)
    return np.fft.irfft(np.fft.rfft(x) * np.exp(-2j * np.pi * f * seconds), x.shape[-1])


def at_twice_the_rate(x):
    """Signals (..., t) at twice the rate, their Fourier interpolant."""
    n = x.shape[-1]
    lines = np.fft.rfft(x)
    return 2.0 * np.fft.irfft(np.concatenate([lines, np.zeros((*x.shape[:-1], n - n // 2))], axis=-1), 2 * n)
