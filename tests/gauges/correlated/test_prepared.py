"""A channel from raw samples to strain: flags in its own unit, then calibration, rate, trend, band."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from fatigue.gauges.correlated.flag_rows import flag_counts, flag_rows, flags_in_words, spikes_shown
from fatigue.gauges.correlated.prepared import Treatment, km_run, prepared
from fatigue.gauges.measured.calibration_file import AS_IT_IS
from fatigue.gauges.measured.channel_file import Channel
from fatigue.gauges.measured.record_files import open_records
from tests.gauges.measured.tones import flagged_tones, tones

VOLTS = Channel("C1", "channels.csv: channel 'C1'", "C1", (("A", 1.0),), "", "V", full_scale_ue=500.0)
GAIN = replace(AS_IT_IS, factor=-250.0, offset=40.0)
AS_IT_COMES = Treatment(0.0, 60.0, 200.0, bridge=0, samples=None)


def record_of(folder, x, rate_hz=250.0, wanted_hz=200.0):
    """An open record of one channel, from second 5 on."""
    path = folder / "r.parquet"
    pd.DataFrame({"time_s": 5.0 + np.arange(len(x)) / rate_hz, "C1": x}).to_parquet(path)
    (record,), _ = open_records([path], [VOLTS], wanted_hz)
    return record


@pytest.fixture(scope="module")
def flagged(tmp_path_factory):
    """The flagged channel of the oracle, in volts of 250 ue with the sign turned, at 200 Hz."""
    record = record_of(tmp_path_factory.mktemp("record"), flagged_tones() / -250.0)
    return prepared(record, VOLTS, GAIN, AS_IT_COMES)


def test_flags_do_not_depend_on_the_unit(flagged):
    """Full scale is of the amplifier, without the offset of the calibration; samples are read in ue."""
    rows = list(flag_rows("A", "C1", [flagged]))
    assert flags_in_words(rows) == "missing 3, stuck 20, clipped 4, spike 2"
    assert flag_counts(rows) == {"missing": 3, "stuck": 20, "clipped": 4, "spike": 2}
    clean = tones(np.arange(15000) / 250.0) + 40.0
    assert flagged.raw[:3000] == pytest.approx(clean[:3000])
    assert flagged.ue_per_raw == 250.0


def test_rows_say_when_how_many_and_how_far(flagged):
    """Times are those of the file; the distance of a spike is in ue, whatever the sign of the factor."""
    rows = {(row.flag, round(row.first_s, 6)): row for row in flag_rows("A", "C1", [flagged])}
    gap, spike = rows["missing", 25.0], rows["spike", 17.0]
    assert (gap.samples, gap.last_s, np.isnan(gap.value_ue)) == (3, pytest.approx(25.008), True)
    assert (spike.record, spike.samples, spike.bridged) == ("r.parquet", 1, False)
    assert spike.distance_ue == pytest.approx(400.0, rel=0.02)
    assert spike.value_ue == pytest.approx(440.0 + tones(np.array([12.0]))[0])
    assert rows["clipped", 53.0].value_ue == pytest.approx(540.0)


def test_spikes_are_shown_with_the_samples_around_them_the_largest_first(flagged):
    """A tenth of a second before and behind, the spike marked."""
    first, second = spikes_shown([flagged], 5)
    assert first.distance > second.distance
    assert len(first.time) == 51
    assert first.time[first.marked].tolist() == [pytest.approx(17.0)]
    assert np.abs(first.strain).argmax() == first.marked.argmax()
    assert len(spikes_shown([flagged], 1)) == 1


def test_strain_is_in_the_band_at_the_rate_of_the_simulation(flagged):
    """12000 samples, the mean gone, and away from the cuts those of the tones."""
    x = flagged.strain.x
    assert len(x) == 12000
    assert x.mean() == pytest.approx(0.0, abs=1e-9)
    kept = flagged.strain.kept
    error = (x - tones(np.arange(12000) / 200.0))[kept]
    assert np.abs(error - np.median(error)).mean() < 0.3  # of 34 rms: the filter of the resampling, and lines over cuts
    assert flagged.strain.segments[:3] == ((0, 2399), (2401, 2799), (2801, 3999))


def test_a_replay_is_cut_and_rid_of_its_trend(tmp_path):
    """Only the samples that both have are looked at, flags included."""
    t = np.arange(5000) / 250.0
    x = tones(t) + 3.0 * t
    x[4500] = np.nan
    treatment = replace(AS_IT_COMES, samples=3200)
    found = prepared(record_of(tmp_path, x / -250.0), VOLTS, GAIN, treatment)
    assert (len(found.raw), len(found.strain.x)) == (4000, 3200)
    assert found.strain.is_whole
    assert not found.flags.missing.any()
    line = np.polynomial.Polynomial.fit(np.arange(3200), found.strain.x, 1).convert()
    assert line.coef == pytest.approx([0.0, 0.0], abs=1e-3)


def test_km_are_those_of_the_samples_that_are_counted(flagged):
    """29 of 15000 samples are cut out, wherever the train was then."""
    ways = np.full(15000, 1e-3)
    ways[7000:7020] = 0.0  # it stood
    kept, everything = km_run([flagged], [ways])
    assert everything == pytest.approx(14.98)
    assert kept == pytest.approx(14.98 - 9e-3)
