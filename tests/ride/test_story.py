"""The ride of a finished result: damage in and out of the hot stretches, what the alarm tells, tables and refusals."""

import json
import shutil

import numpy as np
import pandas as pd
import pytest

from fatigue.assess import assess
from fatigue.case import load_case
from fatigue.check import check_case
from fatigue.diagnose import diagnose
from fatigue.documents import write_documents
from fatigue.errors import CaseError, DataError
from fatigue.life.counting.rainflow import rainflow
from fatigue.pipeline.mission import events
from fatigue.results import RIDDEN, read_provenance
from fatigue.ride.story import ride
from fatigue.spectra import spectra
from fatigue.verify.recount import recount
from tests.ride.ride_case import CHANNEL, HOT, ride_case, with_channels


@pytest.fixture(scope="module")
def assessed(tmp_path_factory):
    """Case and result without channels, to be copied by tests that write."""
    folder = tmp_path_factory.mktemp("ride")
    assess(load_case(ride_case().write(folder / "case")), folder / "result", threads=1, report=False)
    return folder


@pytest.fixture
def own(assessed, tmp_path):
    """A copy of case and result for one test."""
    shutil.copytree(assessed / "case", tmp_path / "case")
    shutil.copytree(assessed / "result", tmp_path / "result")
    return tmp_path


def tables_in(folder):
    """Tables of a ride by name."""
    return {name: pd.read_parquet(folder / f"{name}.parquet") for name in RIDDEN}


def naive_shares(history, spans, residue, slope):
    """Share of the damage of one pass in some stretches on one slope: half of each cycle at either of its instants."""
    kept = history[history["time_s"] >= 1.0 - 1e-9]
    stress, time = 1.5 * kept["q_1"].to_numpy(), kept["time_s"].to_numpy()
    cycles = rainflow(stress, residue)
    total = within = 0.0
    for start, end, count in zip(cycles.start, cycles.end, cycles.count, strict=True):
        damage = count * abs(stress[end] - stress[start]) ** slope
        total += damage
        within += sum(0.5 * damage for at in (start, end) if any(a <= time[at] < b for a, b in spans))
    return within / total


def test_damage_in_the_hot_stretches_is_that_of_a_naive_count(own):
    """Inside and outside add up to the damage of the event to 1e-12, at the worst point of every weld."""
    with_channels(own / "case" / "case.toml", CHANNEL)
    summary = ride(own / "result", threads=1)
    table, record = tables_in(own / "result"), read_provenance(own / "result")
    hot = table["flutter"].query("hot")
    assert len(hot) == 1
    assert hot["start_s"].iloc[0] == pytest.approx(HOT[0], abs=1.0)
    assert hot["end_s"].iloc[0] == pytest.approx(HOT[1], abs=1.0)
    assert hot["start_km"].iloc[0] == pytest.approx((hot["start_s"].iloc[0] - 1.0) * 0.1)
    slopes = record["curves"]["master-aluminium"]["used"]["slopes"]
    assert len(slopes) == 1
    spans = [(hot["start_s"].iloc[0], hot["end_s"].iloc[0])]
    history = pd.read_csv(own / "case" / "tangent.csv")
    expected = naive_shares(history, spans, "repeat", slopes[0])
    rows = table["hot_damage"]
    assert rows["weld"].tolist() == ["A", "B"]
    np.testing.assert_allclose(rows["share_inside"], expected, rtol=1e-12)
    assert 0.9 < expected < 1.0
    damage = pd.read_parquet(own / "result" / "damage.parquet")
    both = rows.merge(damage, on=["weld", "part", "order", "surface", "event"], suffixes=("", "_d"))
    np.testing.assert_allclose(both["damage_per_km"], both["damage_per_pass"] / 5.9, rtol=1e-12)
    length = (spans[0][1] - spans[0][0]) / 59.0
    np.testing.assert_allclose(rows["length_share_inside"], length, rtol=1e-9)
    ratio = expected / length / ((1.0 - expected) / (1.0 - length))
    np.testing.assert_allclose(rows["intensity"], ratio, rtol=1e-9)
    assert summary.worst["tangent", "bogie y"].share_inside == pytest.approx(expected)


@pytest.mark.parametrize(("residue", "reversals"), [("half", "samples"), ("repeat", "vertex"), ("half", "vertex")])
def test_the_parts_add_up_however_cycles_are_counted(tmp_path, monkeypatch, residue, reversals):
    """A single pass, reversals at vertices, a record on disk: the damage of the event is that of the assessment."""
    case = ride_case()
    case.counting |= {"residue": residue, "reversals": reversals}
    file = with_channels(case.write(tmp_path / "case"), CHANNEL)
    assess(load_case(file), tmp_path / "result", threads=1, report=False)
    ride(tmp_path / "result", threads=1)
    rows = tables_in(tmp_path / "result")["hot_damage"]
    damage = pd.read_parquet(tmp_path / "result" / "damage.parquet")
    both = rows.merge(damage, on=["weld", "part", "order", "surface", "event"], suffixes=("", "_d"))
    np.testing.assert_allclose(both["damage_per_km"], both["damage_per_pass"] / 5.9, rtol=1e-12)
    before = {name: (tmp_path / "result" / f"{name}.parquet").read_bytes() for name in RIDDEN}
    monkeypatch.setattr(events, "HELD_BYTES", 0.0)
    ride(tmp_path / "result", threads=2)
    assert before == {name: (tmp_path / "result" / f"{name}.parquet").read_bytes() for name in RIDDEN}


@pytest.mark.parametrize(("peak", "alarms", "told"), [(7.0, 0, "missed"), (12.0, 1, "yes")])
def test_whether_the_alarm_tells_of_the_damage(tmp_path, peak, alarms, told):
    """Peaks below its threshold are no alarm, and the damage is the same."""
    file = with_channels(ride_case(peak).write(tmp_path / "case"), CHANNEL)
    assess(load_case(file), tmp_path / "result", threads=1, report=False)
    summary = ride(tmp_path / "result", threads=1)
    (row,) = tables_in(tmp_path / "result")["alarm"].to_dict("records")
    assert (row["alarms"] > 0) == (alarms > 0)
    assert row["told"] == told
    assert row["damage_share_inside_hot"] > 0.9
    assert row["hot_km_share"] == pytest.approx(12.0 / 59.0, abs=0.04)
    assert ("no alarm is not no damage" in summary.as_text()) == (told == "missed")


def test_other_welds_may_damage_elsewhere(tmp_path):
    """Where the hot stretches hold no more of the damage than of the length, there is nothing to tell."""
    case = ride_case()
    q = case.histories["tangent"]
    rng = np.random.default_rng(11)
    case.histories["tangent"] = q.assign(q_1=np.convolve(rng.standard_normal(len(q)), np.ones(4), mode="same"))
    file = with_channels(case.write(tmp_path / "case"), CHANNEL)
    assess(load_case(file), tmp_path / "result", threads=1, report=False)
    ride(tmp_path / "result", threads=1)
    table = tables_in(tmp_path / "result")
    worst = table["hot_damage"].iloc[0]
    assert worst["share_inside"] == pytest.approx(worst["length_share_inside"], abs=0.15)
    assert table["alarm"]["told"].iloc[0] == (
        "missed" if worst["share_inside"] > worst["length_share_inside"] else "nothing_to_tell"
    )


def test_a_case_may_get_channels_after_its_assessment(own):
    """Every command takes the case with channels for the one that was assessed, and the tables are on record."""
    case_file = own / "case" / "case.toml"
    elsewhere = shutil.copy(case_file, own / "case" / "with_channels.toml")
    with_channels(case_file, CHANNEL)
    ride(own / "result", threads=1)
    record = read_provenance(own / "result")
    assert {f"{name}.parquet" for name in RIDDEN} <= {entry["file"] for entry in record["outputs"]}
    (channel,) = record["ride"]["channels"]
    assert channel["file"] == "tangent.csv"
    assert channel["samples"] == 59 * 200
    assert len(channel["sha256"]) == 64
    assert record["ride"]["rules"]["alarm"]["cycles"] == 6
    diagnose(own / "result")
    spectra(own / "result", threads=1)
    assert "ride" in read_provenance(own / "result")
    write_documents(own / "result", ["report.html"])
    assert "so mesh, stress histories" not in (own / "result" / "report.html").read_text(encoding="utf-8")
    assert recount(own / "result").passed
    case_file.write_text(elsewhere.read_text())
    with pytest.raises(CaseError, match="no event has a channel"):
        ride(own / "result")
    with_channels(elsewhere, CHANNEL)
    ride(own / "result", case_file=elsewhere, threads=1)
    case_file.write_text(elsewhere.read_text().replace("share = 1.0", "share = 1.0\nstress_factor = 1.1"))
    with pytest.raises(DataError, match="has changed since the assessment"):
        ride(own / "result")


def test_without_channels_the_refusal_says_how_to_give_one(own):
    """The line of the refusal, put into the case, gives it a channel: a column beside the modes, as a mode is none."""
    with pytest.raises(CaseError, match="no event has a channel") as refused:
        ride(own / "result")
    remedy = refused.value.problems[0].remedy
    line = remedy[remedy.index("channel = [") : remedy.index(" below the name")]
    assert 'column = "a_bogie", unit = "m/s2"' in line
    case_file = own / "case" / "case.toml"
    case_file.write_text(case_file.read_text().replace('name = "tangent"', f'name = "tangent"\n{line}'))
    assert ride(own / "result", threads=1).events == ("tangent",)
    history = pd.read_csv(own / "case" / "tangent.csv")
    history.drop(columns="a_bogie").to_csv(own / "case" / "tangent.csv", index=False)


def test_a_channel_of_a_file_of_its_own(own):
    """Sampled otherwise, in g, shifted and scaled; the hot stretch is where it was."""
    t = np.arange(0.0, 70.0, 0.002)
    hunts = np.sin(2 * np.pi * 9.0 * t) * ((t >= 25.0) & (t < 37.0))
    noise = 0.02 * np.random.default_rng(0).standard_normal(len(t))
    pd.DataFrame({"time_s": t, "acc": 3.5 * (hunts + noise) / 9.80665}).to_parquet(own / "case" / "acc.parquet")
    channel = CHANNEL.replace(
        'column = "a_bogie", unit = "m/s2"', 'column = "acc", unit = "g", scale = 2.0, shift_s = -5.0'
    )
    with_channels(own / "case" / "case.toml", channel.replace("{ ", '{ history = "acc.parquet", '))
    summary = ride(own / "result", threads=1)
    hot = tables_in(own / "result")["flutter"].query("hot")
    assert hot["start_s"].iloc[0] == pytest.approx(20.0, abs=1.0)
    assert hot["peak"].iloc[0] == pytest.approx(7.0, rel=0.1)
    assert not summary.warnings
    assert summary.worst["tangent", "bogie y"].share_inside > 0.9


def test_text_and_record(own):
    """Every event has a block of text; the record has the rows of the tables, and JSON takes it."""
    with_channels(own / "case" / "case.toml", CHANNEL)
    found = ride(own / "result", threads=1)
    text, record = found.as_text(), found.as_record()
    assert "hunting of 'bogie y': 1 hot stretch, " in text
    assert "alarm of 'bogie y' (6 cycles at 8 m/s2): none, largest peak" in text
    assert record["hot_damage"][0]["weld"] == "A"
    assert record["alarm"][0]["told"] == "missed"
    assert "flutter_track" not in record
    assert json.loads(json.dumps(record, default=str))


def test_bands_of_which_no_channel_leaves_anything(own):
    """A stated band wholly above half the sampling rate of every channel is refused; the dry run says the same."""
    case_file = with_channels(own / "case" / "case.toml", CHANNEL)
    case_file.write_text(case_file.read_text() + "\n[ride]\nhunting_band_hz = [100.0, 120.0]\n")
    words = r"ride.hunting_band_hz: the lower edge of 100 Hz is not below 100 Hz, half the sampling rate"
    with pytest.raises(DataError, match=words):
        ride(own / "result")
    with pytest.raises(DataError, match=words):
        check_case(load_case(case_file))


def test_bands_that_channels_reach_in_part(own):
    """A stated band that reaches above half the sampling rate is clipped there, and every row of it says so."""
    floor = CHANNEL.replace("bogie y", "floor y").replace('"bogie"', '"floor"')
    case_file = with_channels(own / "case" / "case.toml", f"{CHANNEL}, {floor}")
    rules = "hunting_band_hz = [4.0, 120.0]\ncomfort_band_hz = [0.5, 150.0]\nalarm = { band_hz = [0.5, 110.0] }\n"
    case_file.write_text(f"{case_file.read_text()}\n[ride]\n{rules}")
    check_case(load_case(case_file))
    ride(own / "result", threads=1)
    table, clipped = tables_in(own / "result"), "sampled at 200 Hz: nothing is known above 100 Hz"
    assert table["flutter"]["reason"].str.startswith(clipped).all()
    assert table["flutter"]["frequency_hz"].notna().all()
    sperling = table["comfort"][table["comfort"]["index"] == "sperling_wz"]
    assert (sperling["band_hz"] == "0.5-100").all()
    assert (sperling["reason"] == clipped).all()
    assert sperling["value"].notna().all()
    assert table["alarm"]["alarms"].isna().all()
    assert "the band of the alarm reaches 110 Hz" in table["alarm"]["reason"].iloc[0]


def test_distance_of_a_channel_that_begins_later_than_its_event(own):
    """Kilometres count from the first kept sample of the event, and not from that of the channel."""
    history = pd.read_csv(own / "case" / "tangent.csv")
    late = history[history["time_s"] >= 11.0 - 1e-9][["time_s", "a_bogie"]]
    late.to_csv(own / "case" / "late.csv", index=False)
    with_channels(own / "case" / "case.toml", CHANNEL.replace("{ ", '{ history = "late.csv", '))
    summary = ride(own / "result", threads=1)
    table = tables_in(own / "result")
    np.testing.assert_allclose(table["flutter"]["start_km"], 0.1 * (table["flutter"]["start_s"] - 1.0), atol=1e-9)
    np.testing.assert_allclose(table["flutter_track"]["km"], 0.1 * (table["flutter_track"]["time_s"] - 1.0), atol=1e-9)
    assert table["flutter"]["start_s"].iloc[0] == pytest.approx(11.0)
    assert [problem.code for problem in summary.warnings] == ["short_channel"]
    assert read_provenance(own / "result")["ride"]["warnings"][0]["code"] == "short_channel"
