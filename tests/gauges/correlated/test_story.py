"""The whole comparison on records made from the simulation itself: each fault gets the verdict that it has to."""

import json
import math
from datetime import datetime
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from fatigue.case import load_case
from fatigue.errors import CaseError, DataError
from fatigue.gauges.correlated.asked import Asked
from fatigue.gauges.correlated.story import correlate
from fatigue.gauges.gauge_file import read_gauges
from fatigue.gauges.measured.band import band_limited
from fatigue.gauges.rows import gauge_rows
from fatigue.gauges.simulated import simulated
from fatigue.life.counting.rainflow import rainflow
from fatigue.pipeline.solve.body import read_body
from fatigue.pipeline.solve.weld_groups import weld_groups
from fatigue.results.dictionary.decided.correlation import CORRELATED, correlation_columns
from tests.gauges.correlated.measured_case import EVENT, HIGHEST_HZ, KM, RATE, at_twice_the_rate, delayed, measured_case

CARBODY = Path(__file__).parents[3] / "data" / "carbody"
K = 3.6085450346420327  # 1/h of the master curve of aluminium


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """Case, gauges, and what they read."""
    return measured_case(tmp_path_factory.mktemp("case"))


def told(made, record, channels=None, into=None, **asked):
    """Compare one record; by default over the distance of a pass."""
    records = record if isinstance(record, list) else [record]
    asked = Asked(**({"km": KM * len(records)} | asked))
    channels = channels or made.channels()
    return correlate(made.case, made.gauges, channels, records, event=EVENT, into=into, asked=asked)


def verdicts(found):
    """Verdicts in the order of the channels."""
    return [one.verdict for one in found.comparisons]


def test_the_simulation_agrees_with_itself(made):
    """Every ratio is 1, nothing is flagged, and the band, the distance and k are those of the case."""
    found = told(made, made.record())
    assert verdicts(found) == ["good"] * 3
    assert found.agrees
    assert found.band_hz == (0.0, HIGHEST_HZ)
    assert found.km_simulated == pytest.approx(KM)
    assert found.k == pytest.approx(K)
    assert found.k_source == "1/h of curve 'master-aluminium'"
    for one in found.comparisons:
        numbers = one.numbers
        ratios = [numbers.rms_ratio, numbers.damage_ratio, numbers.equivalent_range_ratio]
        ratios += [*numbers.band_ratios.values(), *numbers.range_ratios.values()]
        assert [ratio for ratio in ratios if not math.isnan(ratio)] == pytest.approx(
            [1.0] * sum(not math.isnan(r) for r in ratios), rel=1e-9
        )
        assert one.flags == ()
        assert one.kept_share == 1.0
        assert one.km_lost == 0.0


def test_the_pseudo_damage_is_that_of_the_band_limited_strain(made):
    """``sum n range^k`` over the distance of the pass, and the share that the band leaves out."""
    found = told(made, made.record()).comparisons[0]

    def damage(x):
        cycles = rainflow(x, "repeat")
        return cycles.count @ cycles.range**K / KM

    limited = damage(band_limited(made.strain[0], RATE, 0.0, HIGHEST_HZ))
    assert found.numbers.damage_simulated == pytest.approx(limited, rel=1e-12)
    assert found.lost_share == pytest.approx(1.0 - limited / damage(made.strain[0]), rel=1e-9)
    assert found.lost_share > 0.1  # the noise goes beyond the band


def test_a_gain_is_found(made):
    """1.2 is fair, 1.3 and 1/1.3 are poor; damage goes with the power k. Offsets and trends of the mean are none."""
    gains = np.array([1.2, 1.3, 1 / 1.3])
    found = told(made, made.record(strain=gains[:, None] * made.strain + 500.0))
    assert verdicts(found) == ["fair", "poor", "poor"]
    assert not found.agrees
    for one, gain in zip(found.comparisons, gains, strict=True):
        assert one.numbers.equivalent_range_ratio == pytest.approx(gain, rel=1e-9)
        assert one.numbers.damage_ratio == pytest.approx(gain**K, rel=1e-9)
        assert one.numbers.rms_ratio == pytest.approx(gain, rel=1e-9)
    assert found.line.damage_ratio == pytest.approx(1.2 ** (K / 3), rel=1e-9)
    assert found.line.log_sd == pytest.approx(np.log(gains**K).std(ddof=1), rel=1e-9)


def test_a_flipped_channel_shows_only_when_it_is_aligned(made):
    """Damage does not tell a sign: statistics are good, the correlation is -1."""
    x = made.strain.copy()
    x[1] *= -1.0
    record = made.record(strain=x)
    assert verdicts(told(made, record)) == ["good"] * 3
    found = told(made, record, max_lag_s=0.5)
    assert verdicts(found) == ["good", "sign", "good"]
    assert found.comparisons[1].alignment.correlation < -0.99
    assert not found.agrees


def test_a_late_record_at_another_rate_with_noise_is_aligned(made):
    """400 Hz, 23.4 ms late, a drift over the record, 1 % of noise: lag to 0.1 ms, still good."""
    x = delayed(at_twice_the_rate(made.strain), 0.0234, 2 * RATE)
    x += np.random.default_rng(2).standard_normal(x.shape) * 0.01 * made.strain.std()
    x += 20.0 * np.arange(x.shape[1]) / x.shape[1]
    found = told(made, made.record(strain=x, rate=2 * RATE), max_lag_s=0.2, low_hz=0.5)
    assert verdicts(found) == ["good"] * 3
    for one in found.comparisons:
        assert one.alignment.lag_s == pytest.approx(0.0234, abs=1e-4)
        assert one.alignment.correlation > 0.97
        assert one.coherence > 0.95
        assert one.numbers.rms_ratio == pytest.approx(1.0, abs=0.02)


def test_another_track_is_not_alignable_and_compared_per_km(made):
    """Noise of the same spectrum: the histories have nothing in common, the statistics agree."""
    phase = np.exp(2j * np.pi * np.random.default_rng(9).random(made.strain.shape[1] // 2 + 1))
    x = np.fft.irfft(np.fft.rfft(made.strain) * phase, made.strain.shape[1])
    record = made.record(strain=x)
    assert verdicts(told(made, record, max_lag_s=0.2)) == ["not_alignable"] * 3
    found = told(made, record)
    for one in found.comparisons:
        assert one.numbers.rms_ratio == pytest.approx(1.0, rel=1e-9)
        assert 0.85 < one.numbers.equivalent_range_ratio < 1.15
    assert not told(made, record, max_lag_s=0.2).agrees  # nothing was judged


def test_spikes_stuck_and_missing_samples_are_cut(made):
    """They are listed with their places, and do no damage; the same samples ignored would do most of it."""
    x = made.strain.copy()
    rms = x[0].std()
    x[0, [300, 1700]] += [80 * rms, -90 * rms]
    x[0, 600:630] = x[0, 600]
    x[0, 900:905] = np.nan
    found = told(made, made.record(strain=x))
    first = found.comparisons[0]
    assert first.said_flags == "missing 5, stuck 30, spike 2"
    places = [(row.flag, round((row.first_s - 3.0) * RATE), row.samples) for row in first.flags]
    assert places == [("missing", 900, 5), ("stuck", 600, 30), ("spike", 300, 1), ("spike", 1700, 1)]
    assert first.flags[2].distance_ue == pytest.approx(80 * rms, rel=0.05)
    assert first.kept_share == pytest.approx(1.0 - 37 / 2200)
    assert first.km == pytest.approx(KM * first.kept_share)
    assert first.km_lost == pytest.approx(KM * 37 / 2200)
    assert verdicts(found) == ["good"] * 3
    assert [one.said_flags for one in found.comparisons[1:]] == ["", ""]
    assert [spike.distance for spike in first.drawn.spikes] == sorted(
        [spike.distance for spike in first.drawn.spikes], reverse=True
    )


def test_a_clipped_channel_is_flagged_at_its_full_scale(made):
    """An amplifier of half the range."""
    full = 0.8 * np.abs(made.strain[0]).max()
    x = np.clip(made.strain, -full, full)
    channels = made.channels("ranged", full_scale_ue=[full, "", ""])
    found = told(made, made.record(strain=x), channels)
    clipped = int((np.abs(x[0]) >= 0.999 * full).sum())
    assert found.comparisons[0].said_flags.startswith(f"clipped {clipped}")
    assert "clipped" not in found.comparisons[1].said_flags


def test_where_the_train_stands_nothing_is_had_per_km(made):
    """Counted is only what was recorded at rest: no ratio, no figure of cycles per km, and a warning."""
    x, speed = made.strain.copy(), np.zeros(made.strain.shape[1])
    x[0, 500:530], speed[500:530] = np.nan, 100.0
    channels = made.channels("stood", channel=["C1", "v"], gauge=["G1", "speed"], unit=["ue", "km/h"])
    found = told(made, made.record(strain=x, v=speed), channels, km=None, into=made.folder / "stood")
    assert verdicts(found) == ["data"]
    assert np.isnan(list(found.comparisons[0].numbers.range_ratios.values())).all()
    assert "stood_still" in [warning.code for warning in found.warnings]


def test_two_records_of_one_name_are_told_apart(made):
    """By their folders, among the hashes and the flagged places; the files of the case have hashes, too."""
    x = made.strain.copy()
    x[0, 100] = np.nan
    paths = []
    for day in ("monday", "tuesday"):
        (made.folder / day).mkdir()
        paths.append(made.record(f"{day}/ride", strain=x))
    found = told(made, paths, into=made.folder / "two")
    names = [path.as_posix() for path in paths]
    assert [row.record for row in found.comparisons[0].flags] == names
    inputs = json.loads((made.folder / "two" / "correlation.json").read_text("utf-8"))["inputs"]
    assert {*names, "case.toml", "gauges.csv", "modes.csv"} <= inputs.keys()


def test_a_long_gap_leaves_no_verdict(made):
    """Less than nine tenths kept: data, with a warning; the numbers are given all the same."""
    x = made.strain.copy()
    x[2, 500:800] = np.nan
    found = told(made, made.record(strain=x))
    assert verdicts(found) == ["good", "good", "data"]
    assert found.comparisons[2].numbers.rms_ratio == pytest.approx(1.0, abs=0.1)
    assert "few_samples_kept" in [warning.code for warning in found.warnings]
    assert found.line.gauges == 2


@pytest.mark.parametrize("max_lag_s", [None, 0.1])
def test_a_dead_channel_has_no_numbers(made, tmp_path, max_lag_s):
    """All samples stuck or missing: nothing is counted, drawn or divided; tables and page are written all the same."""
    x = made.strain.copy()
    x[0] = 4.0
    x[1] = np.nan
    asked = Asked(km=KM, max_lag_s=max_lag_s)
    record = made.record(strain=x)
    found = correlate(made.case, made.gauges, made.channels(), [record], event=EVENT, into=tmp_path, asked=asked)
    assert verdicts(found) == ["data", "data", "good"]
    assert math.isnan(found.comparisons[0].numbers.damage_ratio)
    assert found.comparisons[1].km == 0.0
    json.dumps(found.as_record())
    assert "data" in found.as_text()
    assert pd.read_parquet(tmp_path / "correlation.parquet")["rms_ratio"].isna().tolist() == [True, True, False]
    assert "? data" in (tmp_path / "correlation.html").read_text()


def test_short_gaps_are_bridged_when_asked(made):
    """Gaps of up to 3 samples: a line, counted, and said; longer ones stay."""
    x = made.strain.copy()
    x[0, 100:103] = np.nan
    x[0, 400:404] = np.nan
    found = told(made, made.record(strain=x), bridge=3)
    first = found.comparisons[0]
    assert first.bridged == 3
    assert [row.bridged for row in first.flags] == [True, False]
    assert first.kept_share == pytest.approx(1.0 - 4 / 2200)
    assert "3 flagged samples" in next(w.what for w in found.warnings if w.code == "gaps_bridged")


def test_a_drift_is_flagged_and_cuts_nothing(made):
    """A slow rise over 30 s of records: the flag is of the channel, and the lower end of the band takes it out."""
    x = np.tile(made.strain, (1, 3))
    x[0] += 3.0 * np.ptp(x[0]) * np.arange(x.shape[1]) / x.shape[1]
    record = made.record("drift", strain=x)
    found = told(made, record, km=3 * KM)
    assert found.comparisons[0].said_flags == "drift"
    assert found.comparisons[0].kept_share == 1.0
    assert "channel_drift" in [warning.code for warning in found.warnings]
    assert found.comparisons[0].numbers.band_ratios[0.0, 2.0] > 1.5
    without = told(made, record, km=3 * KM, low_hz=1.0)
    assert without.comparisons[0].numbers.equivalent_range_ratio < found.comparisons[0].numbers.equivalent_range_ratio
    assert without.comparisons[0].lost_share > found.comparisons[0].lost_share


def test_units_and_calibrations_lead_to_strain(made):
    """mV/V by its factor and offset, MPa by its modulus, a bridge by its weights."""
    x = made.strain
    raw = np.stack([(x[0] - 7.0) / 500.0, x[1] * 70000.0 / 1e6, 0.5 * x[0] - 0.5 * x[2]])
    channels = made.channels(
        "units",
        unit=["mV/V", "MPa", "ue"],
        gauge=["G1", "G2", ""],
        bridge=["", "", "G1:0.5; G3:-0.5"],
        E_MPa=["", 70000, ""],
    )
    table = made.folder / "calibration.csv"
    table.write_text(
        "channel,valid_from,factor,offset,sign_checked\n"
        "C1,2026-01-01T00:00:00Z,500,7,true\nC1,2026-06-01T00:00:00Z,9,0,true\n"
        "C2,2026-01-01T00:00:00Z,1,0,true\nC3,2026-01-01T00:00:00Z,1,0,true\n"
    )
    asked = Asked(km=KM, recorded_at=datetime.fromisoformat("2026-05-31T23:00:00-01:00"))
    record = made.record("raw", strain=raw)
    with pytest.raises(DataError, match="has 2 calibrations"):
        correlate(made.case, made.gauges, channels, [record], event=EVENT, calibration=table, asked=Asked(km=KM))
    early = Asked(km=KM, recorded_at=datetime.fromisoformat("2026-05-31T22:59:00Z"))
    found = correlate(made.case, made.gauges, channels, [record], event=EVENT, calibration=table, asked=early)
    assert [one.numbers.equivalent_range_ratio for one in found.comparisons] == pytest.approx([1.0] * 3, rel=1e-9)
    assert found.comparisons[2].channel.gauge == "G1:0.5; G3:-0.5"
    assert "sign_unchecked" not in [warning.code for warning in found.warnings]
    late = correlate(made.case, made.gauges, channels, [record], event=EVENT, calibration=table, asked=asked)
    assert late.comparisons[0].numbers.rms_ratio == pytest.approx(9 / 500)


def test_distance_from_a_speed_and_an_odometer(made):
    """At 360 km/h, and 100 m a second: the same as the distance given."""
    t = np.arange(2200) / RATE
    record = made.record("run", v=100.0, odo=5.0 + 0.1 * t)
    given = told(made, record)
    for gauge, unit, column in (("speed", "m/s", "v"), ("odometer", "km", "odo")):
        channels = made.channels(
            "run",
            channel=["C1", "C2", "C3", "X"],
            file_column=["C1", "C2", "C3", column],
            gauge=["G1", "G2", "G3", gauge],
            unit=["ue", "ue", "ue", unit],
        )
        found = told(made, record, channels, km=None)
        assert found.distance == f"channel 'X' ({gauge})"
        for one, other in zip(found.comparisons, given.comparisons, strict=True):
            assert one.km == pytest.approx(KM)
            assert one.numbers.damage_measured == pytest.approx(other.numbers.damage_measured)


def test_several_records_are_one_measurement(made):
    """The same pass three times, in files of two rates, over three times the distance."""
    other = made.record("again", strain=at_twice_the_rate(made.strain), rate=2 * RATE)
    found = told(made, [made.record("once"), made.record("twice"), other])
    for one in found.comparisons:
        assert one.km == pytest.approx(3 * KM)
        assert one.numbers.equivalent_range_ratio == pytest.approx(1.0, abs=0.01)


def test_an_exponent_and_a_band_can_be_asked_for(made):
    """Damage ratios hold for one k: it is printed."""
    found = told(made, made.record(strain=1.1 * made.strain), exponent=5.0, low_hz=1.0, high_hz=10.0)
    assert found.band_hz == (1.0, 10.0)
    assert found.comparisons[0].numbers.damage_ratio == pytest.approx(1.1**5, rel=1e-9)
    assert "k = 5 (as asked)" in found.as_text()


def test_channels_of_an_amplifier_that_differ_in_lag_are_told(made):
    """More than 0.02 / hi apart within a group; not between groups."""
    x = made.strain.copy()
    x[1] = delayed(x[1], 0.004)
    record = made.record("amplifiers", strain=x)
    warnings = told(made, record, made.channels("group", sync_group=["a"] * 3), max_lag_s=0.1).warnings
    said = next(warning for warning in warnings if warning.code == "not_synchronous")
    assert said.where == "sync_group 'a'"
    assert "'C2' is 4.01 ms later than" in said.what
    warnings = told(made, record, made.channels("group", sync_group=["a", "b", "a"]), max_lag_s=0.1).warnings
    assert "not_synchronous" not in [w.code for w in warnings]


def test_stand_ins_are_told(made):
    """A gauge at a toe proves nothing about a grid beside the weld."""
    found = told(made, made.record())
    assert "stand_in_compared" in [warning.code for warning in found.warnings]


def test_what_is_written(made, tmp_path):
    """Tables with the columns of the dictionary, a page that says the verdicts, a record; the same bytes again."""
    x = made.strain.copy()
    x[0, 300] += 100.0 * x[0].std()
    record = made.record("written", strain=np.stack([x[0], 1.3 * x[1], x[2]]))
    again = {}
    for folder in (tmp_path / "a", tmp_path / "b"):
        asked = Asked(km=KM)
        found = correlate(
            made.case, made.gauges, made.channels(), [record], event=EVENT, into=folder, asked=asked, csv=True
        )
        again[folder.name] = {path.name: path.read_bytes() for path in sorted(folder.iterdir())}
    assert again["a"] == again["b"]
    assert sorted(again["a"]) == sorted(
        [
            *(f"{name}.{kind}" for name in CORRELATED for kind in ("parquet", "csv")),
            "correlation.html",
            "correlation.json",
        ]
    )
    tables = {name: pd.read_parquet(tmp_path / "a" / f"{name}.parquet") for name in CORRELATED}
    bands = (0.0, 2.0, 5.0, 8.0, 12.0, HIGHEST_HZ)
    assert list(tables["correlation"]) == [column.name for column in correlation_columns(bands)]
    assert tables["correlation"]["verdict"].tolist() == ["good", "poor", "good"]
    assert tables["correlation"]["damage_ratio"][1] == pytest.approx(1.3**K, rel=1e-9)
    assert tables["channel_flags"][["channel", "flag", "samples"]].to_numpy().tolist() == [["C1", "spike", 1]]
    reached = tables["gauge_exceedance"].query("channel == 'C2'")
    assert reached["measured_per_km"].iloc[0] >= reached["measured_per_km"].iloc[-1] > 0.0
    spectra = tables["gauge_spectra"].query("channel == 'C2'")
    power = spectra[["measured_ue2_per_hz", "simulated_ue2_per_hz"]].sum()
    assert power.iloc[0] / power.iloc[1] == pytest.approx(1.69, rel=1e-6)
    page = (tmp_path / "a" / "correlation.html").read_text()
    for said in ("✕ poor", "✓ good", "2 good, 1 poor", "Warnings", "was not checked", "k = 3.6085", "spike"):
        assert said in page
    said = json.loads((tmp_path / "a" / "correlation.json").read_text())
    assert said["verdicts"] == {"C1": "good", "C2": "poor", "C3": "good"}
    assert {"case.toml", "modes.csv", "gauges.csv", "channels.csv", "written.parquet"} <= said["inputs"].keys()
    assert found.written[-1].endswith("correlation.json")


def test_names_are_no_markup(made, tmp_path):
    """A channel may be called anything."""
    name = "<script>alert(1)</script>"
    record = made.record("markup").rename(made.folder / "markup.parquet")
    channels = made.channels("markup", channel=[name, "C2", "C3"], file_column=["C1", "C2", "C3"])
    correlate(made.case, made.gauges, channels, [record], event=EVENT, into=tmp_path / "out", asked=Asked(km=KM))
    page = (tmp_path / "out" / "correlation.html").read_text()
    assert name not in page
    assert "&lt;script&gt;alert(1)" in page


def test_files_of_somebody_else_and_inputs_are_not_overwritten(made, tmp_path):
    """Neither a table that stands in the way, nor a record in the folder itself."""
    (tmp_path / "correlation.parquet").write_text("mine")
    with pytest.raises(DataError, match="was not written by fatigue gauges correlate"):
        correlate(made.case, made.gauges, made.channels(), [made.record()], event=EVENT, into=tmp_path)
    record = made.record().rename(made.folder / "gauge_spectra.parquet")
    with pytest.raises(DataError, match="is an input of this correlation"):
        correlate(made.case, made.gauges, made.channels(), [record], event=EVENT, into=made.folder, force=True)
    record.unlink()


@pytest.mark.parametrize(
    ("asked", "error", "said"),
    [
        ({"km": None}, DataError, "how far the records ran is not known"),
        ({"km": -1.0}, CaseError, "-1.0 is no finite number above 0"),
        ({"exponent": math.inf}, CaseError, "inf is no exponent of an S-N curve"),
        ({"bridge": -1}, CaseError, "-1 samples are no gap"),
        ({"low_hz": 20.0}, DataError, "there is no common band: it would go from 20 to 18 Hz"),
        (
            {"high_hz": 0.5},
            DataError,
            "the band from 0 to 0.5 Hz has 5.5 lines of the shortest record, which lasts 11 s",
        ),
        ({"high_hz": 120.0}, DataError, "120 Hz is above half the lower sampling rate, 100 Hz"),
    ],
)
def test_what_makes_no_sense_is_refused(made, asked, error, said):
    """In one line each, before anything is compared."""
    with pytest.raises(error) as caught:
        told(made, made.record(), **asked)
    assert said in str(caught.value)


def test_a_slow_record_has_a_lower_band(made):
    """At 25 Hz 0.4 of the rate is 10 Hz: both sides end there."""
    x = band_limited(made.strain, RATE, 0.0, 10.0)[:, ::8]
    found = told(made, made.record("slow", strain=x, rate=25.0))
    assert found.band_hz == (0.0, 10.0)
    assert [one.numbers.rms_ratio for one in found.comparisons] == pytest.approx([1.0] * 3, abs=0.03)


def test_events_without_distance_and_unknown_ones_are_refused(made):
    """Every number is per km."""
    for event, said in (("load and unload", "is counted by number and has no distance"), ("nois", "It has 'sine'")):
        with pytest.raises(CaseError) as caught:
            correlate(made.case, made.gauges, made.channels(), [made.record()], event=event)
        assert said in str(caught.value)


def test_only_one_record_replays_a_simulation(made):
    """And there has to be one."""
    with pytest.raises(CaseError, match="2 records cannot all replay one simulation"):
        told(made, [made.record("once"), made.record("twice")], max_lag_s=0.1)
    with pytest.raises(CaseError, match="there is no list of records"):
        told(made, [])


def test_a_replay_is_cut_to_what_both_have(made):
    """A record that goes on, and one that ends early: the same stretch of both is counted, over its own distance."""
    longer = np.concatenate([made.strain, 5.0 * made.strain], axis=1)
    found = told(made, made.record("longer", strain=longer), km=2 * KM, max_lag_s=0.05)
    shorter = told(made, made.record("shorter", strain=made.strain[:, :1500]), km=KM * 1500 / 2200, max_lag_s=0.05)
    for result in (found, shorter):
        assert verdicts(result) == ["good"] * 3
        for one in result.comparisons:
            assert one.numbers.rms_ratio == pytest.approx(1.0, abs=0.02)
            assert one.numbers.damage_ratio == pytest.approx(1.0, abs=0.1)
    assert found.comparisons[0].km == pytest.approx(KM)


def test_sound_wheels_beside_worn_ones_on_the_shipped_car_body(tmp_path):
    """The worked case of docs/correlation.md: the roof does not feel them, the hanger lacks its 8 to 12 Hz."""
    body = read_body(load_case(CARBODY / "case_gauges.toml"), strict=False)
    names = ["bracket_front", "pad_a", "hanger1"]
    gauges = [gauge for gauge in read_gauges(CARBODY / "gauges.csv")[0] if gauge.name in names]
    rows, _ = gauge_rows(weld_groups(body, tmp_path), gauges)
    sound = simulated(body, rows, next(event for event in body.case.mission.event if event.name == "sound 350"))
    record = pd.DataFrame(dict(zip(rows.names, sound.strain, strict=True)))
    record.insert(0, "time_s", sound.time)
    record.to_parquet(tmp_path / "sound.parquet", index=False)
    channels = pd.DataFrame({"channel": names, "gauge": names, "unit": "ue"})
    channels.to_csv(tmp_path / "channels.csv", index=False)
    found = correlate(
        body.case,
        CARBODY / "gauges.csv",
        tmp_path / "channels.csv",
        [tmp_path / "sound.parquet"],
        event="worn 350",
        asked=Asked(km=2.82),
    )
    assert verdicts(found) == ["good", "good", "poor"]
    assert [one.said_flags for one in found.comparisons] == ["", "", ""]  # a clean record has no spike
    ratios = [one.numbers.equivalent_range_ratio for one in found.comparisons]
    assert ratios == pytest.approx([0.99, 1.00, 0.24], abs=0.005)
    hunting = [one.numbers.band_ratios[8.0, 12.0] for one in found.comparisons]
    assert hunting == pytest.approx([0.98, 0.97, 0.19], abs=0.006)
