"""By how much records are upsampled where the program chooses: enough for all points, no weld solved for nothing."""

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.assess import assess
from fatigue.case import load_case
from fatigue.life.counting.rainflow import rainflow
from fatigue.life.records.history import ModalHistory
from fatigue.pipeline.mission import upsampling
from fatigue.pipeline.mission.event_load import HowCounted, of_samples
from fatigue.pipeline.mission.events import event_loads
from fatigue.pipeline.mission.plan import mission_plan
from fatigue.pipeline.mission.upsampling import factor_for, peak_forms
from fatigue.pipeline.solve.body import read_body
from fatigue.pipeline.solve.model import solve_group
from fatigue.pipeline.solve.weld_groups import weld_groups
from fatigue.readers.neutral.event.event_record import EventRecord
from fatigue.results import read_provenance, upsampling_factors
from fatigue.spectrum.moments import moment_matrices, point_moments, segment_spectra, spectra_above
from fatigue.spectrum.outside import peak_rate
from fatigue.verify.recount.folder import recount
from tests.small_case import STEP, small_case
from tests.test_outside_band import shaken


def loaded(q, upper_hz=15.0, segment_s=1.0, step=0.01):
    """An event of these coordinates, with a spectrum where it is long enough."""
    history = ModalHistory("e", np.arange(len(q)), q, step, 0.0)
    is_long = q.shape[1] * step >= segment_s
    spectra = segment_spectra(history, segment_s, upper_hz) if is_long else None
    return of_samples(EventRecord(history, history.duration), HowCounted("repeat"), spectra, None)


def factors_of(case, folder, residue=None):
    """Factors of the events of a case."""
    body = read_body(load_case(case.write(folder)), strict=False)
    loads = event_loads(weld_groups(body, folder / "scratch"), mission_plan(body)[0])
    return [load.upsample for load in loads]


def automatic(**histories):
    """The small case with other records of the sine and the noise, upsampled automatically."""
    case = small_case()
    case.counting["upsample"] = "auto"
    for name, q in histories.items():
        zero = np.zeros(len(q))
        case.histories[name] = pd.DataFrame({"time_s": STEP * np.arange(len(q)), "q_1": q, "q_2": zero, "q_7": zero})
    case.events[1].pop("start_s")
    return case


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 10_000), st.integers(1, 5), st.booleans())
def test_no_stress_has_more_peaks_than_the_bound(seed, modes, has_dependent):
    """Whatever a stress takes of each coordinate, of the band alone or of the whole record; nearly reached by one."""
    rng = np.random.default_rng(seed)
    q = np.cumsum(rng.normal(size=(modes, 500)), axis=1) * 10.0 ** rng.uniform(-6, 3, (modes, 1))
    q += rng.uniform(0, 2) * q.std() * rng.normal(size=q.shape)
    if has_dependent:
        q = np.concatenate([q, q.sum(axis=0)[np.newaxis]])
    load = loaded(q)
    band = load.moments
    above = moment_matrices(upsampling_above(load))
    stress = rng.normal(size=(200, len(q))) / q.std(axis=1)
    rates = peak_rate(point_moments(stress, band), point_moments(stress, above))
    bound = peak_forms(load).fastest_of_any()
    assert np.nanmax(rates) <= bound * (1 + 1e-9)
    assert bound <= 50.0


def upsampling_above(load):
    """Spectra of what lies above the band of an event."""
    return spectra_above(segment_spectra(load.counted, 1.0, 15.0))


def test_the_bound_of_one_coordinate_is_its_rate_of_peaks():
    """A sine of 8 Hz: every stress has 8 peaks per second."""
    t = np.arange(1000) * 0.01
    assert peak_forms(loaded(np.sin(2 * np.pi * 8.0 * t)[None])).fastest_of_any() == pytest.approx(8.0, rel=0.05)


def test_each_event_gets_what_all_its_points_ask_for(tmp_path):
    """As found by solving every weld: 12 welds in groups, events at different rates."""
    case = small_case(pairs=8)
    case.counting["upsample"] = "auto"
    body = read_body(load_case(case.write(tmp_path)), strict=False)
    groups, (plan, _) = weld_groups(body, tmp_path / "scratch"), mission_plan(body)
    found = event_loads(groups, plan)
    solved = [solve_group(groups, number).stations.treated for number in range(len(groups))]
    for load, as_given in zip(found, event_loads(groups, plan, factors=(1, 1, 1)), strict=True):
        rates = [peak_forms(as_given).fastest(stress) for stress in solved]
        assert load.upsample == factor_for(max(rates), as_given.counted.step)
        assert load.counted.step == pytest.approx(as_given.counted.step / load.upsample)
    assert {load.upsample for load in found} >= {1, 8}


def test_welds_are_solved_only_as_long_as_they_may_ask_for_more(tmp_path, monkeypatch):
    """None where no stress could be too fast for its samples; one where it asks for as much as any could."""
    solved = []
    monkeypatch.setattr(upsampling, "solve_group", lambda groups, n: solved.append(n) or solve_group(groups, n))
    t = STEP * np.arange(4000)
    slow, fast = np.sin(2 * np.pi * 2.0 * t), np.sin(2 * np.pi * 30.0 * t)
    assert factors_of(automatic(sine=slow, noise=slow), tmp_path / "slow") == [1, 1, 1]
    assert solved == []
    case = automatic(sine=fast, noise=slow)
    for name in ("welds", "weld_nodes", "nodal_forces"):
        setattr(case, name, getattr(small_case(pairs=8), name))
    body = read_body(load_case(case.write(tmp_path / "fast")), strict=False)
    groups, (plan, _) = weld_groups(body, tmp_path / "scratch"), mission_plan(body)
    assert len(groups) == 4
    assert [load.upsample for load in event_loads(groups, plan, threads=1)] == [4, 1, 1]
    assert solved == [0]


@pytest.mark.parametrize("residue", ["repeat", "half"])
def test_records_of_every_kind(tmp_path, residue):
    """At rest: as it is. White noise: 8 times, below the 16 that half the sampling rate would ask for."""
    rng = np.random.default_rng(3)
    case = automatic(sine=np.full(4000, 12.5), noise=rng.normal(size=4000))
    case.counting["residue"] = residue
    assert factors_of(case, tmp_path) == [1, 8, 1]


def test_load_cases_are_counted_as_they_are(tmp_path):
    """A zigzag of 99 values is a list of load cases: no overshoot between them, no warning; of 100, a signal."""
    zigzag = np.tile([0.0, 30.0, 10.0, 20.0], 40)
    case = automatic(sine=zigzag[:99], noise=zigzag[:100])
    case.spectrum["segment_s"] = 0.1
    done = assess(case.write(tmp_path / "case"), tmp_path / "result", report=False)
    assert upsampling_factors(read_provenance(tmp_path / "result"))[:2] == [1, 16]
    assert not [w for w in done.warnings if w.code == "sampling"]
    damage = pd.read_parquet(tmp_path / "result" / "damage.parquet").set_index("event")
    assert damage.loc["sine", "max_range_MPa"].max() == pytest.approx(45.0)  # 30 times 1.5 MPa


def test_a_short_record_is_judged_by_shorter_segments(tmp_path):
    """3 s in segments of 4 s have no spectrum, but peaks: counted as finely, and recounted."""
    t = STEP * np.arange(600)
    case = automatic(sine=30.0 * np.sin(2 * np.pi * 35.0 * t + 0.3), noise=30.0 * np.sin(2 * np.pi * 2.0 * t))
    case.spectrum["segment_s"] = 4.0
    assess(case.write(tmp_path / "case"), tmp_path / "result", report=False)
    assert upsampling_factors(read_provenance(tmp_path / "result")) == [4, 1, 1]
    damage = pd.read_parquet(tmp_path / "result" / "damage.parquet").set_index("event")
    assert damage.loc["sine", "max_range_MPa"].max() == pytest.approx(90.0, rel=0.01)
    assert damage.loc["sine", "samples_per_peak"].isna().all()
    assert recount(tmp_path / "result").passed


def test_content_above_the_band_loses_nothing_by_default(tmp_path):
    """10 to 40 Hz at 200 samples/s, the highest normal mode at 5 Hz: 11 % of the damage was lost and not told."""
    case = shaken(10.0, 40.0)
    case.modes["frequency_hz"] = [3.0, 5.0, 60.0]
    damage = {}
    for upsample in (1, 16, None):
        case.counting = {} if upsample is None else {"upsample": upsample}
        folder = tmp_path / str(upsample)
        assess(case.write(folder / "case"), folder / "result", report=False)
        table = pd.read_parquet(folder / "result" / "damage.parquet")
        damage[upsample] = table[table["event"] == "sine"]["damage_per_pass"].max()
    assert damage[1] / damage[16] == pytest.approx(0.89, abs=0.02)
    assert damage[None] / damage[16] == pytest.approx(1.0, abs=0.01)


def test_sample_counts_stay_what_they_are(tmp_path):
    """``upsample = 1``: each record is the one in the file, whatever its peaks."""
    assert factors_of(shaken(40.0, 60.0), tmp_path) == [1, 1, 1]


def test_the_samples_of_a_sine_at_many_phases():
    """Why 20: of a sine with 20 samples per period a range is at most 1.2 % low, with 10 at most 5 %."""
    for samples, low in ((20.0, 0.0124), (10.0, 0.0490)):
        phase = np.linspace(0.0, 2 * np.pi / samples, 50)
        t = np.arange(2000)
        ranges = [rainflow(np.sin(2 * np.pi * t / (samples + 1e-3) + a), "half").range.max() for a in phase]
        assert min(ranges) >= 2.0 * (1.0 - low) * (1 - 1e-3)
