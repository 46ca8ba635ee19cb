"""A long record on disk is split, counted and ranked as the same one in memory, and takes little memory."""

import tracemalloc
from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest

from fatigue.life.counting import long_rainflow
from fatigue.life.mission import Loop, Pass, Plan
from fatigue.life.records import history, long_transform, spool
from fatigue.life.records.history import ModalHistory, upsampled
from fatigue.life.records.spool import CHUNK, create_spool
from fatigue.pipeline.mission.event_load import HowCounted, prepare_event
from fatigue.spectrum.moments import segment_spectra
from fatigue.why import long_record
from fatigue.why.attribute import Attribution, Bins, attribute_event
from fatigue.why.formation import modes, point_stress
from fatigue.why.formation.formation import formation
from tests.vibration.oscillator import FINER, band_limited_noise, response
from tests.why.one_point import MODES, point

STEP, SAMPLES = 0.01, 9001
PLAN = Plan((Pass("worn", SAMPLES, 2.0, 1.0, None),), 1e6, 1e5, 1.0)
BINS = Bins(np.array([2.0, 6.0, 20.0]), 0.1)


@cache
def swinging(samples=SAMPLES):
    """Mode 3 of 5 Hz under noise and a burst at 5.3 Hz, mode 8 of 12 Hz under a slow load."""
    t = STEP / FINER * np.arange(samples * FINER)
    burst = np.exp(-(((t - 0.6 * t[-1]) / 4.0) ** 2)) * np.sin(2.0 * np.pi * 5.3 * t)
    noise = band_limited_noise(len(t), STEP / FINER, 20.0)
    forces = 1000.0 * (2.0 * burst + 0.3 * noise), 5600.0 * np.sin(5.0 * t)
    q = [
        response(f, STEP / FINER, hz, 0.02)[::FINER] + 1.5
        for f, hz in zip(forces, MODES.frequency.tolist(), strict=True)
    ]
    return ModalHistory("worn", MODES.mode, np.stack(q), STEP, 0.5)


def formed(record, factor, residue, tmp_path=None, plan=PLAN):
    """Formation under one event at one point, upsampled by a factor; in files where there is a folder."""
    load = prepare_event(record, HowCounted(residue, 1.2), segment_spectra(record, 1.0, 40.0), 12.0)
    counted = upsampled(record, factor, residue, tmp_path and tmp_path / "upsampled")
    load = replace(load, counted=counted, upsample=factor)
    points = point(30.0, 12.0)
    event = attribute_event(points, load, plan.passes[0], MODES, BINS)
    mission = SimpleNamespace(event=[SimpleNamespace(name="worn", history="worn.csv")])
    body = SimpleNamespace(modes=MODES, case=SimpleNamespace(mission=mission))
    return formation(body, Attribution(points, (event,)), [load], plan, np.array([0]), None)


def on_disk(record, folder):
    """The record in a file."""
    found = create_spool(folder / "record", record.q.shape, np.dtype(np.float64))
    found[:, :] = record.q
    return replace(record, q=found)


def as_long(monkeypatch, block):
    """Every record in a file is a long one."""
    for module, name, value in [
        (long_record, "LONG_NUMBERS", 100),
        (long_record, "COUNTED_AT_ONCE", CHUNK),
        (modes, "BLOCK", block),
        (point_stress, "BLOCK", block),
        (spool, "AT_ONCE", 1 << 14),
        (history, "LONGEST_TRANSFORM", 100),
    ]:
        monkeypatch.setattr(module, name, value)


@pytest.mark.parametrize("residue", ["repeat", "half"])
@pytest.mark.parametrize("factor", [1, 2])
@pytest.mark.parametrize("loop", [False, True])
def test_the_same_as_in_memory(residue, factor, loop, tmp_path, monkeypatch):
    """Shares, frequencies, damages of both parts, place and cost of the swing, alone and in a loop of events."""
    plan = replace(PLAN, loops=(Loop("(sequence 1)", (0, 0), 5.0),)) if loop else PLAN
    record = swinging()
    expected = formed(record, factor, residue, plan=plan)
    as_long(monkeypatch, 4000)
    found = formed(on_disk(record, tmp_path), factor, residue, tmp_path, plan=plan)
    one, other = expected.modes[0], found.modes[0]
    assert one.mode_class.tolist() == other.mode_class.tolist() == ["resonant", "quasi_static"]
    assert other.rms == pytest.approx(one.rms, rel=1e-9)
    assert other.indicators.dynamic_share == pytest.approx(one.indicators.dynamic_share, rel=1e-3)
    assert other.half_power_share[0] == pytest.approx(one.half_power_share[0], rel=0.2)
    assert other.response_hz == pytest.approx(one.response_hz, abs=0.02)
    one, other = expected.welds[0], found.welds[0]
    assert other.dominant_hz == pytest.approx(one.dominant_hz, abs=0.02)
    for name in ("damage", "quasi_static", "dynamic", "dynamic_share"):
        assert getattr(other, name) == pytest.approx(getattr(one, name), rel=1e-3)
    one, other = expected.watch[0], found.watch[0]
    assert (one.swing.mode, one.swing.first, one.swing.last) == (other.swing.mode, other.swing.first, other.swing.last)
    assert one.swing.mode == 0
    assert other.life_without == pytest.approx(one.life_without, rel=1e-3)
    assert {path.name for path in tmp_path.iterdir()} <= {"record", "upsampled"}


def test_memory_does_not_grow_with_the_record(tmp_path, monkeypatch):
    """Less than three numbers of each sample are held."""
    as_long(monkeypatch, 1 << 12)
    monkeypatch.setattr(modes, "NUMBERS_AT_ONCE", 1 << 13)
    monkeypatch.setattr(long_record, "AT_ONCE", 1 << 14)
    monkeypatch.setattr(long_transform, "AT_ONCE", 1 << 14)
    monkeypatch.setattr(long_rainflow, "FEWEST", 1 << 10)
    samples = 1 << 17
    record = swinging(SAMPLES)
    formed(record, 1, "repeat")  # what is imported for it
    longer = replace(record, q=np.tile(record.q, (1, samples // SAMPLES + 1))[:, :samples])
    load = prepare_event(longer, HowCounted("repeat"), None, 12.0)
    points = point(30.0, 12.0)
    event = attribute_event(points, load, PLAN.passes[0], MODES, BINS)
    load = replace(load, counted=on_disk(longer, tmp_path))
    del longer
    mission = SimpleNamespace(event=[SimpleNamespace(name="worn", history="worn.csv")])
    body = SimpleNamespace(modes=MODES, case=SimpleNamespace(mission=mission))
    tracemalloc.start()
    found = formation(body, Attribution(points, (event,)), [load], PLAN, np.array([0]), None)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert found.watch
    assert peak < 3 * 8 * samples
