"""Records of events, read and prepared: statistics, upsampling, what memory does not hold, threads."""

import pickle

import numpy as np
import pandas as pd
import pytest

from fatigue.case import load_case
from fatigue.errors import FatigueError
from fatigue.life.counting.single.kernels.product import prepared_samples, space_for_samples
from fatigue.life.curves import catalogue, damage_law
from fatigue.life.records import spool
from fatigue.life.records.history import ModalHistory
from fatigue.life.records.spool import Spool
from fatigue.life.rule import CycleRule
from fatigue.pipeline.mission import events
from fatigue.pipeline.mission.events import event_load, event_loads, top_mode_hz, upper_hz
from fatigue.pipeline.mission.plan import mission_plan
from fatigue.pipeline.solve.body import read_body
from fatigue.pipeline.solve.modal_stress import ModalStress
from fatigue.pipeline.solve.weld_groups import weld_groups
from tests.one_event import NO_RAW_ENDS, assess_event_block, numbers_of
from tests.small_case import small_case


def body_of(case, folder):
    """Read the small files of a case."""
    return read_body(load_case(case.write(folder)), strict=False)


def test_upper_frequency(tmp_path):
    """As given; else the lower of 0.4 of the sampling rate and 1.5 times the highest normal mode."""
    case = small_case()
    body = body_of(case, tmp_path / "a")
    assert top_mode_hz(body) == 12.0
    assert upper_hz(body, ModalHistory("e", np.array([1]), np.zeros((1, 9)), 0.005, 0.0)) == pytest.approx(18.0)
    assert upper_hz(body, ModalHistory("e", np.array([1]), np.zeros((1, 9)), 0.04, 0.0)) == pytest.approx(10.0)
    case.modes["frequency_hz"] = 1e-4  # rigid-body modes under the name of normal ones
    assert top_mode_hz(body_of(case, tmp_path / "rigid")) is None
    case.spectrum["upper_hz"] = 33.0
    assert upper_hz(body_of(case, tmp_path / "b"), ModalHistory("e", np.array([1]), np.zeros((1, 9)), 0.1, 0.0)) == 33.0


def test_event_load_statistics(tmp_path):
    """Mean and covariance of the kept samples; residue by kind of event."""
    case = small_case()
    body = body_of(case, tmp_path)
    load = event_load(body, body.case.mission.event[1], 1)
    q = case.histories["noise"].iloc[200:][["q_1", "q_2", "q_7"]].to_numpy().T
    assert load.mean == pytest.approx(q.mean(axis=1))
    assert load.covariance == pytest.approx(np.cov(q, bias=True), rel=1e-9)
    assert load.residue == "repeat"
    assert event_load(body, body.case.mission.event[2], 1).residue == "half"
    assert load.duration == pytest.approx(11.0)


def test_automatic_upsampling_reaches_twenty_samples_per_peak(tmp_path):
    """A sine at 4.5 Hz sampled at 25 Hz needs a factor of 4; a record without spectrum stays as it is."""
    case = small_case()
    t = np.arange(300) * 0.04
    case.histories["sine"] = pd.DataFrame({"time_s": t, "q_1": np.sin(2 * np.pi * 4.5 * t), "q_2": 0.0, "q_7": 0.0})
    case.counting["upsample"] = "auto"
    case.spectrum["segment_s"] = 2.0
    body = body_of(case, tmp_path / "case")
    loads = event_loads(weld_groups(body, tmp_path / "scratch"), mission_plan(body)[0])
    assert loads[0].counted.step == pytest.approx(0.01)
    assert loads[2].counted.step == pytest.approx(1.0)


@pytest.mark.parametrize("upsample", [1, 2, "auto"])
def test_records_on_disk_bring_the_same_as_records_in_memory(tmp_path, monkeypatch, upsample):
    """Statistics, spectra and trust to 1e-12, in single precision too; the counted samples exactly."""
    case = small_case()
    case.counting["upsample"] = upsample
    body = body_of(case, tmp_path / "case")
    groups, (plan, _) = weld_groups(body, tmp_path / "forces"), mission_plan(body)
    monkeypatch.setattr("fatigue.pipeline.mission.precision.SINGLE_FROM", 0.0)
    held = event_loads(groups, plan, tmp_path / "histories")
    monkeypatch.setattr(events, "HELD_BYTES", 0.0)
    monkeypatch.setattr("fatigue.pipeline.mission.event_load.HELD_SINGLE", 0.0)
    monkeypatch.setattr(spool, "CHUNK", 512)
    monkeypatch.setattr(spool, "AT_ONCE", 600)
    monkeypatch.setattr("fatigue.spectrum.moments.NUMBERS_AT_ONCE", 1000)
    monkeypatch.setattr("fatigue.spectrum.whole_record.NUMBERS_AT_ONCE", 60)
    for a, b in zip(held, event_loads(groups, plan, tmp_path / "histories"), strict=True):
        assert not isinstance(a.counted.q, Spool)
        assert isinstance(b.counted.q, Spool)
        assert isinstance(b.single.q, Spool)
        np.testing.assert_array_equal(np.asarray(b.counted.q), a.counted.q)
        laid_out = prepared_samples(np.asarray(b.single.q), space_for_samples(*b.single.q.shape, np.float32))
        np.testing.assert_allclose(laid_out, a.single.q, rtol=1e-6, atol=1e-6)
        assert (b.counted.step, b.counted.start, b.duration) == (a.counted.step, a.counted.start, a.duration)
        pairs = [(a.mean, b.mean), (a.covariance, b.covariance)]
        if a.moments is not None:
            pairs += [(a.moments.matrix, b.moments.matrix)]
            pairs += [(getattr(a.trust.record, x), getattr(b.trust.record, x)) for x in ("slow", "lines")]
            pairs += [
                (x.forms[: x.periods + 1], y.forms[: y.periods + 1]) for x, y in [(a.trust.periods, b.trust.periods)]
            ]
        for mine, theirs in pairs:
            close = 1e-6 if mine.dtype == np.float32 else 1e-12
            np.testing.assert_allclose(theirs, mine, rtol=close, atol=close * max(1.0, np.abs(mine).max()))


@pytest.mark.parametrize("single", [False, True])
def test_the_number_of_threads_does_not_matter(tmp_path, monkeypatch, single):
    """Events prepared side by side are the same, byte for byte, as one after the other."""
    body = body_of(small_case(), tmp_path / "case")
    groups, (plan, _) = weld_groups(body, tmp_path / "forces"), mission_plan(body, threads=1)
    monkeypatch.setattr("fatigue.pipeline.mission.precision.SINGLE_FROM", 0.0 if single else np.inf)
    one, two, three = (pickle.dumps(event_loads(groups, plan, tmp_path / "histories", n)) for n in (1, 2, 3))
    assert one == two == three
    assert mission_plan(body, threads=3)[0] == plan


@pytest.mark.parametrize("threads", [1, 2, 3])
def test_the_first_event_that_overflows_is_named(tmp_path, threads):
    """Whichever thread finds one first; a thread refuses numbers beyond double precision as the caller would."""
    case = small_case()
    for name in ("sine", "noise"):
        case.histories[name]["q_1"] *= 1e200
    body = body_of(case, tmp_path / "case")
    groups, (plan, _) = weld_groups(body, tmp_path / "forces"), mission_plan(body)
    with pytest.raises(FatigueError, match=f"event '{body.case.mission.event[0].name}' are so large"):
        event_loads(groups, plan, threads=threads)


def test_the_shortest_records_are_held_in_memory(tmp_path, monkeypatch):
    """As many as fit together; without a folder for the others, all of them."""
    body = body_of(small_case(), tmp_path / "case")
    groups, (plan, _) = weld_groups(body, tmp_path / "forces"), mission_plan(body)
    monkeypatch.setattr(events, "HELD_BYTES", 4 * 3 * (2200 + 2))
    loads = event_loads(groups, plan, tmp_path / "histories")
    assert [isinstance(load.counted.q, Spool) for load in loads] == [True, False, False]
    assert not any(isinstance(load.counted.q, Spool) for load in event_loads(groups, plan))


@pytest.mark.parametrize("extension", ["none", "haibach"])
@pytest.mark.parametrize("number", [0, 1, 2])
def test_a_block_of_stations_has_the_same_damage_from_disk_and_from_memory(tmp_path, monkeypatch, number, extension):
    """Every number of a sine, of noise and of two samples, with and without a knee; the kurtosis to 1e-9."""
    case = small_case()
    body = body_of(case, tmp_path / "case")
    event = body.case.mission.event[number]
    law = damage_law(catalogue()["master-steel"], "mean-2sigma", extension, 1e7)
    S = np.random.default_rng(2).normal(size=(4, 5, 3))
    rule = CycleRule(law, uses_bending_ratio=True, yield_MPa=40.0, mean_stress=True)
    stress = ModalStress(*S, size=np.full(5, 1.5), rule=rule, **NO_RAW_ENDS)
    held = numbers_of(assess_event_block(stress, event_load(body, event, 2)))
    monkeypatch.setattr(spool, "CHUNK", 512)
    spooled = event_load(body, event, 2, scratch=tmp_path / "histories")
    assert isinstance(spooled.counted.q, Spool)
    for name, found in numbers_of(assess_event_block(stress, spooled)).items():
        close = 1e-9 if name == "count.kurtosis" else 1e-12
        np.testing.assert_allclose(found, held[name], rtol=close, atol=1e-13, err_msg=name)
