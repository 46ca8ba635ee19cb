"""One point under one sine of each of two modes, on a straight curve: damage, shares and slopes are known."""

import numpy as np

from fatigue.life.curves import catalogue, damage_law
from fatigue.life.mission import Pass, Plan
from fatigue.life.records.history import ModalHistory
from fatigue.life.rule import CycleRule
from fatigue.pipeline.mission.event_load import HowCounted, prepare_event
from fatigue.readers.neutral.body.modes import Modes
from fatigue.spectrum.moments import segment_spectra
from fatigue.why.points import Points

STEP, SAMPLES, CYCLES, HZ = 0.01, 2000, 100, 5.0
LENGTH = 2.0  # km
RULE = CycleRule(damage_law(catalogue()["master-steel"], "mean-2sigma", "none", 1e7), uses_bending_ratio=False)
SLOPE = float(RULE.law.slopes[0])
PLAN = Plan((Pass("sine", SAMPLES, LENGTH, 1.0, None),), 1e6, 1e5, 1.0)
MODES = Modes(
    mode=np.array([3, 8]),
    frequency=np.array([HZ, 12.0]),
    damping_ratio=np.array([0.02, np.nan]),
    modal_mass=np.ones(2),
    kind=("normal", "normal"),
    scale=np.ones(2),
)


def sine_load(stress_factor=1.0):
    """The event: both modal coordinates are the same sine of 5 Hz for 20 s."""
    sine = np.sin(2.0 * np.pi * HZ * STEP * (np.arange(SAMPLES) + 0.25))
    history = ModalHistory("sine", MODES.mode, np.stack([sine, sine]), STEP, 0.0)
    return prepare_event(history, HowCounted("repeat", stress_factor), segment_spectra(history, 1.0, 40.0), HZ)


def point(first, second, size=1.5):
    """One point on a top face whose membrane stress is ``first`` and ``second`` of the two modes [MPa]."""
    return Points(
        weld=np.array(["W"], dtype=object),
        part=np.array([1]),
        order=np.array([0]),
        node=np.array([17]),
        face=np.array([0]),
        chosen=np.array(["all"], dtype=object),
        membrane=np.array([[first, second]]),
        bending=np.zeros((1, 2)),
        rule=np.array([RULE], dtype=object),
        size=np.array([size]),
        size_exponent=np.array([-0.25]),
        damage_limit=np.ones(1),
    )
