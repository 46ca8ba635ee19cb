"""Channels of events: cut to the kept part, in their own unit and rate; what cannot be had is told with its place."""

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from fatigue.assess import assess
from fatigue.case import load_case
from fatigue.check import check_case
from fatigue.errors import DataError
from fatigue.life.records.unit_load import UniformGrid
from fatigue.readers.neutral import long_history
from fatigue.ride.records import Kept, channel_records, within
from tests.ride.ride_case import CHANNEL, ride_case, with_channels
from tests.small_case import STEP, small_case

OTHER = '{ name = "floor z", history = "other.csv", column = "acc", unit = "g", role = "floor", direction = "z" }'


@pytest.fixture
def case_file(tmp_path):
    """The case with a channel beside its modes."""
    return with_channels(ride_case(seconds=12.0).write(tmp_path), CHANNEL)


def with_other(case_file, table, channel=OTHER):
    """Give the case a channel in a file of its own."""
    table.to_csv(case_file.parent / "other.csv", index=False)
    return with_channels(case_file, channel)


@pytest.fixture
def plain(tmp_path):
    """The case without a channel."""
    return ride_case(seconds=12.0).write(tmp_path)


def test_a_channel_of_the_history_has_the_samples_that_are_assessed(case_file):
    """The start-up is cut as it is for the modes; scale and unit are applied, distance follows from the speed."""
    (one,), warnings = channel_records(load_case(case_file))
    history = pd.read_csv(case_file.parent / "tangent.csv")
    np.testing.assert_array_equal(one.values, history["a_bogie"].to_numpy()[200:])
    assert (one.step, one.start, one.is_acceleration) == (pytest.approx(STEP), 1.0, True)
    assert one.km_per_s == pytest.approx(0.1)
    assert not warnings


def test_g_and_scale_and_shift(plain):
    """9.80665 m/s2 a g; a shift moves the times of the file; a long file is read as a short one."""
    t = 0.01 * np.arange(1500)
    scaled = OTHER.replace(" }", ", scale = -0.5, shift_s = -1.5 }")
    file = with_other(plain, pd.DataFrame({"time_s": t, "acc": t}), scaled)
    (one,), _ = channel_records(load_case(file))
    assert one.start == pytest.approx(1.0)
    samples = one.values  # noqa: PD011
    assert samples.size == 1100
    np.testing.assert_allclose(samples[:2], -0.5 * 9.80665 * np.array([2.5, 2.51]), rtol=1e-12)


def test_a_long_file_is_read_block_by_block(plain, monkeypatch):
    """The same samples, and the same refusal of what is no number."""
    t = 0.01 * np.arange(1500)
    file = with_other(plain, pd.DataFrame({"time_s": t, "b": 1.0, "acc": np.sin(t)}))
    (short,), _ = channel_records(load_case(file))
    monkeypatch.setattr(long_history, "LONG_BYTES", 100)
    monkeypatch.setattr(long_history, "NUMBERS_AT_ONCE", 64)
    (long,), _ = channel_records(load_case(file))
    np.testing.assert_array_equal(short.values, long.values)
    assert (short.step, short.start) == (long.step, long.start)


def test_events_counted_by_number_have_no_distance(tmp_path):
    """Their channels are looked at all the same."""
    case = ride_case(seconds=12.0)
    case.events[0] = {"name": "tangent", "history": "tangent", "per_1000_km": 3.0}
    (one,), _ = channel_records(load_case(with_channels(case.write(tmp_path), CHANNEL)))
    assert np.isnan(one.km_per_s)
    assert one.start == 0.0


@pytest.mark.parametrize("step", [0.001, 0.0125, 1 / 256])
def test_samples_within_the_kept_part(step):
    """Each sample stands for half a step before and behind it, so that the parts of a record tile it."""
    grid = UniformGrid(-3.0, step, round(40.0 / step))
    kept = Kept("e", 1.0, 11.0, 0.1)
    part = within(grid, 0.25, kept)
    times = grid.start + 0.25 + step * np.arange(grid.samples)
    np.testing.assert_array_equal(
        np.arange(grid.samples)[part], np.flatnonzero((times >= 1.0 - step / 2) & (times < 12.0 - step / 2))
    )


T = 0.01 * np.arange(1300)
FAULTY = {
    "no file": (None, r"channel\[1\]\.history: there is no file .*other\.csv"),
    "no column": (pd.DataFrame({"time_s": T, "ac": T}), r"other\.csv: column acc: the column is missing.*time_s, ac"),
    "a gap": (
        pd.DataFrame({"time_s": T, "acc": np.where(T[7] == T, np.nan, T)}),
        r"column acc, row 8: .*missing or NaN",
    ),
    "infinite": (pd.DataFrame({"time_s": T, "acc": np.where(T[7] == T, np.inf, T)}), r"column acc, row 8: inf is not"),
    "a text": (pd.DataFrame({"time_s": T, "acc": ["x" if i == 5 else "1" for i in range(1300)]}), r"row 6: 'x' is not"),
    "uneven": (pd.DataFrame({"time_s": T**1.1, "acc": T}), r"other\.csv: column time_s, row 2: the time goes from"),
    "one sample": (pd.DataFrame({"time_s": [0.0], "acc": [1.0]}), r"one sample"),
    "another time": (pd.DataFrame({"time_s": T + 100.0, "acc": T}), r"lasts from 100 to 112\.99 s and has 0 samples"),
    "no time": (pd.DataFrame({"t": T, "acc": T}), r"column time_s: the column is missing"),
}


@pytest.mark.parametrize("fault", FAULTY)
def test_channels_that_cannot_be_had(plain, fault):
    """File, column and row; the dry run says the same."""
    table, words = FAULTY[fault]
    file = with_channels(plain, OTHER)
    if table is not None:
        table.to_csv(file.parent / "other.csv", index=False)
    with pytest.raises(DataError, match=words):
        channel_records(load_case(file))
    with pytest.raises(DataError, match=words):
        check_case(load_case(file))


def test_all_channels_that_cannot_be_had_are_told_at_once(plain):
    """Not only the first."""
    with_channels(plain, CHANNEL.replace("a_bogie", "a_bogy"), OTHER.replace('"other.csv"', '"tangent.csv"'))
    with pytest.raises(DataError) as refused:
        channel_records(load_case(plain))
    assert [problem.code for problem in refused.value.problems] == ["missing_column", "missing_column"]


@pytest.mark.parametrize(
    ("stated", "own", "is_refused"),
    [
        ("mm/s2", "m/s2", True),
        ("g", "m/s2", True),
        ("m/s2", "g", True),
        ("m/s²", "m/s2", False),
        ("[m/s^2]", "m/s2", False),
        ("m s**-2", "m/s2", False),
        ("G", "g", False),
        ("V", "-", False),
        ("", "g", False),
    ],
)
def test_units_that_a_file_states(plain, stated, own, is_refused):
    """Another unit than that of the case is refused, unless a scale converts it; spellings of one unit are alike."""
    fields = [pa.field("time_s", pa.float64()), pa.field("acc", pa.float64(), metadata={"unit": stated})]
    pq.write_table(pa.table([T, T], schema=pa.schema(fields)), plain.parent / "other.parquet")
    with_channels(plain, OTHER.replace("csv", "parquet").replace('"g"', f'"{own}"'))
    if is_refused:
        with pytest.raises(DataError, match=f"column acc: the unit is {stated}, and the case says '{own}'"):
            channel_records(load_case(plain))
        plain.write_text(plain.read_text().replace(f'unit = "{own}"', f'unit = "{own}", scale = 0.001'))
    assert len(channel_records(load_case(plain))[0]) == 1


def test_doubts_are_told_once(plain):
    """A short record, a dead sensor, a coordinate that is said to be an acceleration: one warning of each kind."""
    still = pd.DataFrame({"time_s": T[:300], "acc": 1.0})
    still.to_csv(plain.parent / "other.csv", index=False)
    modal = '{ name = "q", column = "q_1", unit = "m/s2", role = "other", direction = "y" }'
    with_channels(plain, OTHER, OTHER.replace("floor z", "floor 2 z"), modal)
    _, warnings = channel_records(load_case(plain))
    assert [(problem.code, problem.count) for problem in warnings] == [
        ("short_channel", 2),
        ("still_channel", 2),
        ("modal_channel", 1),
    ]
    assert "covers 18% of the kept part of event 'tangent', less than 99%" in warnings[0].what


def test_a_spike_is_told_with_its_place(plain):
    """One sample of 500 g; without it no word."""
    values = np.random.default_rng(0).standard_normal(len(T))
    with_channels(plain, OTHER)
    for spike, codes in ((500.0, ["spiked_channel"]), (0.5, [])):
        values[700] = spike
        pd.DataFrame({"time_s": T, "acc": values}).to_csv(plain.parent / "other.csv", index=False)
        _, warnings = channel_records(load_case(plain))
        assert [problem.code for problem in warnings] == codes
        if codes:
            assert f"at {T[700]:.6g} s ({500 * 9.80665:.3g})" in warnings[0].what


@pytest.mark.parametrize("suffix", ["csv", "parquet"])
def test_a_column_of_a_channel_is_known(tmp_path, suffix):
    """Nothing is warned of, nor refused where unknown columns are; without the channel it is as before."""
    case = ride_case(seconds=12.0)
    file = case.write(tmp_path, suffix)
    assert "unknown_column" in [problem.code for problem in check_case(load_case(file)).warnings]
    with pytest.raises(DataError, match="a_bogie: the column is unknown"):
        check_case(load_case(file), strict=True)
    with_channels(file, CHANNEL)
    found = check_case(load_case(file), strict=True)
    assert "unknown_column" not in [problem.code for problem in found.warnings]
    (line,) = found.channels
    assert (line.samples, line.rate_hz, line.unit) == (2200, pytest.approx(200.0), "m/s2")
    assert "'bogie y' of 'tangent': bogie y, 2200 samples at 200 Hz, rms" in found.as_text()
    assert found.as_record()["channels"][0]["channel"] == "bogie y"


def test_the_unit_of_a_column_of_a_channel_is_no_doubt(tmp_path):
    """A row of units in the history is compared with the channel, and not said to be useless."""
    case = ride_case(seconds=12.0)
    file = case.write(tmp_path)
    history = (tmp_path / "tangent.csv").read_text().splitlines(keepends=True)
    (tmp_path / "tangent.csv").write_text("".join([history[0], "s,-,-,-,m/s2\n", *history[1:]]))
    assert "unit_unused" in [problem.code for problem in check_case(load_case(file)).warnings]
    with_channels(file, CHANNEL)
    assert "unit_unused" not in [problem.code for problem in check_case(load_case(file)).warnings]


def test_channels_change_no_number_of_an_assessment(tmp_path):
    """Tables of a result with and without channels are the same but for its hash."""
    plain, given = (small_case().write(tmp_path / name) for name in ("plain", "given"))
    with_channels(given, CHANNEL.replace("a_bogie", "q_1").replace("m/s2", "-"), event="noise")
    for file in (plain, given):
        assess(load_case(file), file.parent / "result", threads=1, report=False)
    for name in ("nodes", "damage", "welds"):
        tables = [pd.read_parquet(file.parent / "result" / f"{name}.parquet") for file in (plain, given)]
        pd.testing.assert_frame_equal(*tables)
