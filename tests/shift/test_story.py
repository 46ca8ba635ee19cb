"""The shift study of a finished result against the assessment of a rerun, and what it refuses."""

import json
import shutil

import numpy as np
import pandas as pd
import pytest

from fatigue.assess import assess
from fatigue.case import load_case
from fatigue.diagnose import diagnose
from fatigue.errors import CaseError, DataError
from fatigue.results import read_provenance
from fatigue.shift.story import shift
from tests.shift.oscillating_case import F, Z, oscillating
from tests.small_case import small_case
from tests.test_sequences import LOOP, empty_and_laden

POINT = ["weld", "part", "order", "surface"]


def assessed(case, folder):
    """Result of a case."""
    assess(load_case(case.write(folder / "case")), folder / "result", threads=1, report=False)
    return folder / "result"


@pytest.fixture(scope="module")
def kept(tmp_path_factory):
    """A diagnosed result of the oscillating case, to be copied."""
    result = assessed(oscillating(), tmp_path_factory.mktemp("shift"))
    diagnose(result)
    return result.parent


@pytest.fixture
def result(kept, tmp_path):
    """A copy for one test."""
    shutil.copytree(kept, tmp_path / "own")
    return tmp_path / "own" / "result"


def beside(result, setting=None):
    """Rows of the table at a setting, by default as assessed, with those of ``nodes`` beside them."""
    table, nodes = (pd.read_parquet(result / f"{name}.parquet") for name in ("shift", "nodes"))
    rows = table["is_as_assessed"] if setting is None else np.isclose(table["frequency_hz"], setting)
    return table[rows].merge(nodes, on=POINT, suffixes=("", "_n"))


def test_the_setting_as_assessed_is_the_result(result):
    """Damage and life of every toe point at the setting as assessed are those of the assessment, to rounding."""
    found = shift(result, mode=2, to_hz=[9.0, 12.0], threads=1)
    rows = beside(result)
    toes = pd.read_parquet(result / "nodes.parquet")["toe"]
    assert len(rows) == toes.sum()
    np.testing.assert_allclose(rows["damage_per_km"], rows["damage_per_km_n"], rtol=1e-12)
    np.testing.assert_allclose(rows["life_km"], rows["life_km_n"], rtol=1e-12)
    assert (rows["life_ratio"] == 1.0).all()
    assert [line.is_as_assessed for line in found.settings] == [False, True, False]
    worst = rows[rows["is_worst_of_weld"]].set_index("weld")["life_km"]
    assert {curve.weld: curve.life_km[1] for curve in found.welds} == worst.to_dict()


@pytest.mark.parametrize("counting", [{"upsample": 1}, {"upsample": 4}, {"upsample": 1, "reversals": "vertex"}])
@pytest.mark.parametrize("residue", ["repeat", "half"])
def test_as_assessed_for_every_way_of_counting(counting, residue, tmp_path):
    """Upsampled, at vertices, single or recurring; an event of two samples; across the events of a sequence."""
    case = small_case() if "reversals" in counting else empty_and_laden()
    case.counting, case.extra = dict(counting, residue=residue), "" if "reversals" in counting else LOOP
    result = assessed(case, tmp_path)
    shift(result, mode=2, to_hz=[11.0], threads=1)
    rows = beside(result)
    np.testing.assert_allclose(rows["damage_per_km"], rows["damage_per_km_n"], rtol=1e-9)
    moved = pd.read_parquet(result / "shift.parquet").query("frequency_hz == 11.0")
    assert not np.allclose(moved["damage_per_km"], rows["damage_per_km"])


@pytest.mark.parametrize(("to", "damping"), [(12.0, Z), (8.5, Z), (F, 0.03)])
def test_lives_are_those_of_a_rerun(to, damping, result, tmp_path):
    """No feedback here: the lives of all points are those of the case simulated at the new setting, within 6 %."""
    found = shift(result, mode=2, to_hz=[to], to_damping=[damping], threads=1)
    rerun = pd.read_parquet(assessed(oscillating(to, damping), tmp_path) / "nodes.parquet")
    table = pd.read_parquet(result / "shift.parquet")
    rows = table[~table["is_as_assessed"]].merge(rerun, on=POINT, suffixes=("", "_n"))
    np.testing.assert_allclose(rows["damage_per_km"], rows["damage_per_km_n"], rtol=0.06)
    assert np.abs(np.log(rows["life_ratio"])).max() > 0.1
    assert found.method == "screening without feedback"


def test_a_peak_between_is_told(result):
    """Moved through the hunting at 9.2 Hz the life falls and rises: not monotonic, its minimum is named."""
    found = shift(result, mode=2, to_hz=np.arange(7.0, 13.1, 1.0).tolist(), threads=1)
    worst = found.welds[0]
    assert worst.turns
    assert found.settings[worst.shortest].frequency_hz in {9.0, 10.0}
    text = " ".join(found.as_text().split())
    assert "not monotonic" in text
    assert "screening without feedback" in text.lower()
    assert "shortest" in text
    assert json.loads(json.dumps(found.as_record()))["method"] == "screening without feedback"


def test_an_event_alone(result):
    """Moved in one event, the others stay as they are: the parts add up."""
    whole, parts = {}, []
    for events in ((), ("bursts",), ("hunting",)):
        shift(result, mode=2, to_hz=[12.0], events=events, threads=1)
        table = pd.read_parquet(result / "shift.parquet")
        at, before = (table[table["is_as_assessed"] == flag]["damage_per_km"].to_numpy() for flag in (False, True))
        (parts if events else whole.setdefault("all", [])).append(at - before)
    np.testing.assert_allclose(parts[0] + parts[1], whole["all"][0], rtol=1e-9, atol=1e-18)


def test_the_mode_with_most_damage_is_found(result):
    """Without a mode: that with the largest share of the diagnosis; the record of the result keeps what was asked."""
    record = read_provenance(result)
    found = shift(result, to_damping=[0.02, 0.03], threads=1)
    assert found.mode in {1, 2}
    assert found.largest_shares[0].mode == found.mode
    assert f"{found.largest_shares[0].share:.0%}" in found.as_text()
    said = read_provenance(result)["shift_study"]
    assert said["mode"] == found.mode
    assert said["method"] == "screening without feedback"
    assert "shift_study" not in record
    shift(result, mode=1, to_hz=[3.0], threads=1)  # again, over the table before
    assert read_provenance(result)["shift_study"]["mode"] == 1


def test_damping_is_assumed_where_there_is_none(tmp_path):
    """0.015 unless given, and printed as assumed; what is given is used."""
    result = assessed(oscillating(gives_damping=False), tmp_path)
    found = shift(result, mode=2, to_hz=[12.0], threads=1)
    assert (found.damping_ratio, found.damping_is_assumed) == (0.015, True)
    assert "1.5 % assumed" in found.as_text()
    assert shift(result, mode=2, to_hz=[12.0], damping=0.02, threads=1).damping_ratio == 0.02


def test_a_record_that_cannot_hold_a_resonance_is_scaled(tmp_path):
    """Two samples a second apart: (f / f')^2 and a warning; a short record is doubted; neither in the others."""
    result = assessed(small_case(), tmp_path)
    found = shift(result, mode=2, to_hz=[14.0], threads=1)
    by_code = {problem.code: problem for problem in found.warnings}
    assert set(by_code) == {"shift_static"}
    assert "load and unload" in by_code["shift_static"].what
    assert found.settings[1].rms_ratio[2] == pytest.approx((12.0 / 14.0) ** 2)
    codes = [problem.code for problem in shift(result, mode=1, to_hz=[5.5], damping=0.005, threads=1).warnings]
    assert codes == ["shift_static", "shift_short"]


def test_long_records_read_their_row_from_disk(tmp_path, monkeypatch):
    """A record on disk gives the same table."""
    result = assessed(small_case(4.0), tmp_path)
    shift(result, mode=2, to_hz=[12.0], threads=1)
    held = pd.read_parquet(result / "shift.parquet")
    monkeypatch.setattr("fatigue.pipeline.mission.events.HELD_BYTES", 0.0)
    for name in ("fatigue.why.long_record.LONGEST_TRANSFORM", "fatigue.why.long_record.LONG_NUMBERS"):
        monkeypatch.setattr(name, 10)
    shift(result, mode=2, to_hz=[12.0], threads=1)
    on_disk = pd.read_parquet(result / "shift.parquet")
    np.testing.assert_allclose(on_disk["damage_per_km"], held["damage_per_km"], rtol=1e-6)


@pytest.mark.parametrize(
    ("asked", "words"),
    [
        ({"mode": 3}, "the body has no mode 3"),
        ({"mode": 7}, "is of the kind interface"),
        ({"mode": 2, "damping": 0.02}, "has the damping ratio 0.015"),
        ({"mode": 2, "to_hz": [-1.0]}, "is no frequency of a mode"),
        ({"mode": 2, "to_hz": [float("nan")]}, "is no frequency of a mode"),
        ({"mode": 2, "to_damping": [0.0]}, "is no damping ratio"),
        ({"mode": 2, "to_hz": []}, "nothing says where"),
        ({"mode": 2, "to_hz": [200.0]}, "not below half the sampling rate"),
        ({"mode": 2, "events": ["worn"]}, "the mission has no event 'worn'"),
        ({"mode": 2, "to_hz": np.linspace(5.0, 6.0, 300)}, "200 are possible"),
    ],
)
def test_refusals(kept, asked, words):
    """One line each, and nothing is written."""
    with pytest.raises(CaseError, match=words):
        shift(kept / "result", **({"to_hz": [12.0]} | asked))
    assert not (kept / "result" / "shift.parquet").exists()


def test_without_diagnosis_the_mode_has_to_be_named(tmp_path):
    """What is missing is said, with both ways out."""
    result = assessed(oscillating(), tmp_path)
    with pytest.raises(DataError, match="fatigue diagnose"):
        shift(result, to_hz=[12.0])


def test_an_input_that_has_changed_is_refused(result):
    """The record of today is not that of the result."""
    path = result.parent / "case" / "bursts.csv"
    path.write_text(path.read_text().replace("0.0", "0.1", 1))
    with pytest.raises(DataError, match="bursts"):
        shift(result, mode=2, to_hz=[12.0])
