"""Damage under long records on disk is shared out as under the same ones in memory, and takes little memory."""

import tracemalloc
from dataclasses import fields, replace

import numpy as np
import pytest

from fatigue.life.counting import long_rainflow
from fatigue.life.curves import catalogue, damage_law
from fatigue.life.records import long_transform, spool
from fatigue.life.records.history import ModalHistory
from fatigue.life.records.spool import CHUNK, create_spool
from fatigue.life.rule import CycleRule
from fatigue.pipeline.mission.event_load import HowCounted, prepare_event
from fatigue.spectrum import long_bands
from fatigue.spectrum.moments import segment_spectra
from fatigue.why import long_record
from fatigue.why.attribute import Attribution, Bins, attribute_event
from fatigue.why.levers import best_levers
from tests.why.one_point import MODES, PLAN, STEP, point

BINS = Bins(np.array([2.0, 6.0, 20.0]), 0.3)
RULE = CycleRule(damage_law(catalogue()["master-aluminium"], None, "haibach", 1e6), True, 60.0, True)


def noise(samples):
    """Coordinates of both modes: noise around their frequencies, one of them drifting into tension."""
    rng = np.random.default_rng(4)
    t = STEP * np.arange(samples)
    return np.stack(
        [
            np.sin(2.0 * np.pi * 5.0 * t) * (1.0 + 0.3 * np.sin(0.7 * t)) + 0.2 * rng.standard_normal(samples) + 1.5,
            np.cos(2.0 * np.pi * 12.1 * t + rng.standard_normal(samples).cumsum() * 0.1),
        ]
    )


def load_of(history, residue):
    """The event ready to be counted."""
    return prepare_event(history, HowCounted(residue, 1.2), segment_spectra(history, 1.0, 40.0), 12.0)


def two_points():
    """Both faces of a station with membrane and bending stress of both modes."""
    one = point(30.0, 12.0)
    both = one.of(np.array([0, 0]))
    bending = np.array([[9.0, -14.0]] * 2)
    return replace(both, bending=bending, face=np.array([0, 1]), rule=np.array([RULE, RULE], dtype=object))


@pytest.mark.parametrize("residue", ["repeat", "half"])
@pytest.mark.parametrize("samples", [9000, 9001])
@pytest.mark.parametrize("together", [1, 100_000], ids=["point by point", "together"])
def test_everything_is_shared_out_as_in_memory(samples, residue, together, tmp_path, monkeypatch):
    """Damage, modes, bands, slopes, places and levers; records of more than one chunk, with and without factors."""
    q = noise(samples)
    record = ModalHistory("sine", MODES.mode, q, STEP, 0.5)
    expected = attribute_event(two_points(), load_of(record, residue), PLAN.passes[0], MODES, BINS)
    levers = best_levers(Attribution(two_points(), (expected,)), [load_of(record, residue)], PLAN, np.array([0, 1]))

    for module, name, value in [
        (long_record, "LONG_NUMBERS", 100),
        (long_record, "STRESS_AT_ONCE", together),
        (long_record, "COUNTED_AT_ONCE", 700),
        (long_bands, "LONGEST_TRANSFORM", 100),
    ]:
        monkeypatch.setattr(module, name, value)
    on_disk = create_spool(tmp_path / "record", q.shape, np.dtype(np.float64))
    on_disk[:, :] = q
    load = load_of(replace(record, q=on_disk), residue)
    found = attribute_event(two_points(), load, PLAN.passes[0], MODES, BINS)
    for field in fields(found):
        if field.name != "event":
            a, b = getattr(expected, field.name), getattr(found, field.name)
            scale = np.abs(a[np.isfinite(a)]).max(initial=0.0)
            np.testing.assert_allclose(b, a, rtol=1e-9, atol=1e-12 * scale, err_msg=field.name)
    assert np.isfinite(found.resonant[:, 0]).all()
    assert np.isnan(found.resonant[:, 1]).all()
    again = best_levers(Attribution(two_points(), (expected,)), [load], PLAN, np.array([0, 1]))
    np.testing.assert_allclose(again.life_counted, levers.life_counted, rtol=1e-12)
    assert {path.name for path in tmp_path.iterdir()} <= {"record", "stress"}


def test_memory_does_not_grow_with_the_record(tmp_path, monkeypatch):
    """Less than three numbers of each sample are held, where a record in memory takes sixteen and more."""
    for module, name, value in [
        (long_record, "LONG_NUMBERS", 100),
        (long_record, "STRESS_AT_ONCE", 1),
        (long_record, "COUNTED_AT_ONCE", CHUNK),
        (long_record, "AT_ONCE", 1 << 14),
        (long_transform, "AT_ONCE", 1 << 14),
        (spool, "AT_ONCE", 1 << 14),
        (long_rainflow, "FEWEST", 1 << 10),
        (long_bands, "LONGEST_TRANSFORM", 100),
    ]:
        monkeypatch.setattr(module, name, value)
    samples = 1 << 17
    q = noise(samples)
    on_disk = create_spool(tmp_path / "record", q.shape, np.dtype(np.float64))
    on_disk[:, :] = q
    load = load_of(ModalHistory("sine", MODES.mode, on_disk, STEP, 0.5), "repeat")
    del q
    tracemalloc.start()
    attribute_event(two_points().of(slice(0, 1)), load, PLAN.passes[0], MODES, BINS)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 3 * 8 * samples
