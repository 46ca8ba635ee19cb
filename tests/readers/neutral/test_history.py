"""Histories: the whole record arrives in the order of the modes, and every gap in it is told."""

from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.errors import DataError
from fatigue.life.records.spool import Spool
from fatigue.readers.neutral.history import TimeGrid, check_history, read_history
from fatigue.readers.neutral.record_outline import RecordOutline
from tests.readers.neutral_tables import changed, history, picked, without, write

MODES = np.array([3, 7, 12])
SUFFIXES = pytest.mark.parametrize("suffix", [".csv", ".parquet"])


def refusal_of(path: Path, ignore_modes=(), strict=False) -> str:
    """Message of the refusal, the same whether the samples are kept or not."""
    with pytest.raises(DataError) as refusal:
        read_history(path, "run", MODES, ignore_modes, strict=strict)
    with pytest.raises(DataError) as same:
        check_history(path, MODES, ignore_modes, strict=strict, outline=RecordOutline())
    assert str(same.value) == str(refusal.value)
    return str(refusal.value)


@SUFFIXES
def test_history(tmp_path, suffix):
    """Rows are modes in the order asked for, time is contiguous, the record is uncut."""
    read, warnings = read_history(write(tmp_path / f"q{suffix}", history()), "run", MODES, (), strict=True)
    assert warnings == []
    assert read.event == "run"
    assert read.mode.tolist() == [3, 7, 12]
    assert read.q.tolist() == [[100.0 * mode + i for i in range(5)] for mode in (3, 7, 12)]
    assert read.q.flags.c_contiguous
    assert read.q.dtype == np.float64
    assert read.step == pytest.approx(0.01)
    assert read.start == 2.0
    assert read.duration == pytest.approx(0.05)


@SUFFIXES
def test_a_history_may_go_to_disk(tmp_path, suffix):
    """The same samples in the same precision, in a file of which slices are read."""
    path = write(tmp_path / f"q{suffix}", history())
    read, _ = read_history(path, "run", MODES, (), strict=True)
    spooled, warnings = read_history(path, "run", MODES, (), strict=True, scratch=tmp_path / "scratch" / "q")
    assert warnings == []
    assert isinstance(spooled.q, Spool)
    assert spooled.q.dtype == read.q.dtype
    np.testing.assert_array_equal(np.asarray(spooled.q), read.q)
    grid, _ = check_history(path, MODES, (), strict=True, outline=RecordOutline())
    assert grid == TimeGrid(5, read.step, read.start)


@pytest.mark.parametrize(("double", "dtype"), [((), np.float32), (("q_7",), np.float64)])
def test_precision_of_the_file_is_kept(tmp_path, double, dtype):
    """Single precision stays single unless one mode is stored in double precision."""
    types = {name: pa.float64() if name in double else pa.float32() for name in history() if name != "time_s"}
    read, _ = read_history(write(tmp_path / "q.parquet", history(), types), "run", MODES, (), strict=True)
    assert read.q.dtype == dtype
    assert read.q[1].tolist() == [700.0, 701.0, 702.0, 703.0, 704.0]


def test_two_samples_are_enough(tmp_path):
    """A load and unload event is two samples."""
    read, _ = read_history(write(tmp_path / "q.csv", history(2)), "run", MODES, (), strict=True)
    assert read.q.shape == (3, 2)
    assert refusal_of(write(tmp_path / "q.csv", history(1))) == "q.csv: the history has one sample. Give at least 2."


def test_negative_mode_ids(tmp_path):
    """Mode ids are any whole numbers."""
    path = write(tmp_path / "q.csv", {"time_s": [0, 1], "q_-1": [5.0, 6.0]})
    read, _ = read_history(path, "run", np.array([-1]), (), strict=True)
    assert read.q.tolist() == [[5.0, 6.0]]


def test_modes_of_history_and_body_must_match(tmp_path):
    """Both kinds of mismatch name the modes, unless they are ignored."""
    path = write(tmp_path / "q.csv", without(history(), "q_7") | {"q_8": [0.0] * 5, "q_9": [0.0] * 5})
    assert refusal_of(path) == (
        "q.csv: modes 8, 9 are in the history and not in the table of modes. Add them there, or list them under "
        "ignore_modes.\n"
        "q.csv: modes 7 are in the table of modes and not in the history. Add the columns q_7, or list the modes under "
        "ignore_modes."
    )
    read, warnings = read_history(path, "run", np.array([3, 12]), (7, 8, 9), strict=True)
    assert read.q.shape == (2, 5)
    assert warnings == []


@SUFFIXES
@pytest.mark.parametrize(
    ("columns", "message"),
    [
        (without(history(), "time_s"), "column time_s: the column is missing. Add it; the columns are q_7, q_3, q_12."),
        (changed(history(), "time_s", 3, None), "column time_s, row 3: the value is missing or NaN. Give a number."),
        (
            changed(history(), "time_s", 3, float("inf")),
            "column time_s, row 3: inf is not finite. Give a finite number.",
        ),
        (changed(history(), "q_12", 4, None), "column q_12, row 4: the value is missing or NaN. Give a number."),
        (
            changed(history(), "q_12", 4, float("nan")),
            "column q_12, row 4: the value is missing or NaN. Give a number.",
        ),
        (changed(history(), "q_3", 2, float("-inf")), "column q_3, row 2: -inf is not finite. Give a finite number."),
        (changed(history(), "q_3", 1, "x"), "column q_3, row 1: 'x' is not a number. Give a number."),
        (
            history() | {"q_03": [0.0] * 5},
            "column q_03: mode 3 has the column q_3 already. Remove one of them.",
        ),
    ],
)
def test_bad_values(tmp_path, suffix, columns, message):
    """Every mistake names file, column, row and value."""
    assert refusal_of(write(tmp_path / f"q{suffix}", columns)) == f"q{suffix}: {message}"


def test_missing_time_does_not_hide_missing_modes(tmp_path):
    """Both are told at once."""
    message = refusal_of(write(tmp_path / "q.csv", without(without(history(), "time_s"), "q_3")))
    assert "modes 3 are in the table of modes and not in the history" in message
    assert "column time_s: the column is missing" in message


def test_column_given_twice(tmp_path):
    """A column name that appears twice is refused."""
    path = tmp_path / "q.csv"
    path.write_text("time_s,q_3,q_7,q_12,q_7\n0,1,1,1,1\n1,1,1,1,1\n")
    assert refusal_of(path) == "q.csv: column q_7: the column appears twice. Remove one of them."


def test_unknown_columns(tmp_path):
    """Other columns are a warning, or an error where strict."""
    path = write(tmp_path / "q.csv", history() | {"speed": [1.0] * 5, "q_": [1.0] * 5})
    _, warnings = read_history(path, "run", MODES, (), strict=False)
    assert [warning.where for warning in warnings] == ["q.csv: column speed", "q.csv: column q_"]
    assert "column speed: the column is unknown" in refusal_of(path, strict=True)


@pytest.mark.parametrize(
    ("row", "time", "message"),
    [
        (
            3,
            2.0201,
            "column time_s, row 3: the time goes from 2.01 to 2.0201 s, a step of 0.0101 s where the mean is 0.01 s",
        ),
        (
            3,
            2.01,
            "column time_s, row 3: the time goes from 2.01 to 2.01 s, a step of 0 s where the mean is 0.01 s (2 of",
        ),
        (
            2,
            1.0,
            "column time_s, row 2: the time goes from 2 to 1 s, a step of -1 s where the mean is 0.01 s (2 of 4 st",
        ),
        (
            5,
            2.0,
            "column time_s, row 2: the time goes from 2 to 2.01 s, a step of 0.01 s where the mean is 0 s (4 of 4",
        ),
    ],
)
def test_uneven_steps(tmp_path, row, time, message):
    """A step that differs is told with its row and both times."""
    found = refusal_of(write(tmp_path / "q.csv", changed(history(), "time_s", row, time)))
    assert found.startswith("q.csv: " + message)
    assert found.endswith("differ by more than 1e-3). Write the history at a constant step.")


def test_steps_within_the_tolerance(tmp_path):
    """A deviation below 1e-3 of a step passes."""
    columns = changed(history(), "time_s", 3, 2.020009)
    read, _ = read_history(write(tmp_path / "q.csv", columns), "run", MODES, (), strict=True)
    assert read.step == pytest.approx(0.01)


def test_time_in_single_precision(tmp_path):
    """A long record whose times were rounded to single precision is refused with the remedy for that."""
    samples = 100
    columns = {"time_s": [3600.0 + 0.004 * i for i in range(samples)], "q_3": [0.0] * samples}
    path = write(tmp_path / "q.parquet", columns, {"time_s": pa.float32()})
    with pytest.raises(
        DataError, match=r"Write the history at a constant step and store time_s in double precision\.$"
    ):
        read_history(path, "run", np.array([3]), (), strict=True)


@pytest.mark.parametrize("name", ["q_350_sound_14hz", "q_350_worn_9hz"])
def test_shipped_histories(name):
    """The shipped records are 30 s at 250 Hz of 52 modes in single precision."""
    read, warnings = read_history(Path(f"data/carbody/{name}.parquet"), "run", np.arange(1, 53), (), strict=True)
    assert warnings == []
    assert (read.q.shape, read.q.dtype, read.start) == ((52, 7501), np.float32, 0.0)
    assert read.step == pytest.approx(0.004, rel=1e-12)


@settings(deadline=None, max_examples=25)
@given(data=st.data(), suffix=st.sampled_from([".csv", ".parquet"]))
def test_any_column_order(tmp_path_factory, data, suffix):
    """What was written comes back whatever the order of the columns."""
    mode = data.draw(st.lists(st.integers(-999, 9999), min_size=1, max_size=6, unique=True))
    samples = data.draw(st.integers(2, 20))
    q = data.draw(
        st.lists(
            st.lists(st.floats(-1e12, 1e12), min_size=samples, max_size=samples), min_size=len(mode), max_size=len(mode)
        )
    )
    columns = {"time_s": [0.5 * i for i in range(samples)]} | {f"q_{m}": row for m, row in zip(mode, q, strict=True)}
    names = data.draw(st.permutations(list(columns)))
    path = write(tmp_path_factory.mktemp("q") / f"q{suffix}", {name: columns[name] for name in names})
    read, _ = read_history(path, "run", np.array(sorted(mode)), (), strict=True)
    np.testing.assert_array_equal(read.q, [q[mode.index(m)] for m in sorted(mode)])


def test_rows_are_time_ordered(tmp_path):
    """A record whose rows are not in the order of time is refused, not sorted."""
    assert "a step of" in refusal_of(write(tmp_path / "q.csv", picked(history(), [1, 3, 2, 4, 5])))


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            "time_s",
            "time_ms",
            "column time_ms: this seems to be time, in ms. Give seconds in a column time_s",
        ),
        ("time_s", "Time [ms]", "column Time [ms]: this seems to be time, in ms. Give seconds in a column time_s"),
        (
            "time_s",
            "t",
            "column t: this seems to be time, in a unit that is not stated. Give seconds",
        ),
        (
            "q_7",
            "q_7 [m]",
            "column q_7 [m]: the name states the unit m; neutral coordinates are in N, mm, t, s.",
        ),
        ("q_7", "q_7 [mm]", "column q_7 [mm]: the name states the unit mm; neutral coordinates are in N, mm, t, s."),
    ],
)
@SUFFIXES
def test_stated_units(tmp_path, suffix, old, new, message):
    """A unit beside the one the neutral format has is told, not passed over as an unknown column."""
    columns = {new if name == old else name: values for name, values in history().items()}
    assert f"q{suffix}: {message}" in refusal_of(write(tmp_path / f"q{suffix}", columns))


def test_units_below_the_names(tmp_path):
    """A row of units is passed over where it confirms the names, and refused where it contradicts them."""
    path = write(tmp_path / "q.csv", history())
    names, rest = path.read_text().split("\n", 1)
    path.write_text(f"{names}\ns,mm,mm,mm\n{rest}")
    read, _ = read_history(path, "run", MODES, (), strict=True)
    assert read.q.shape == (3, 5)
    path.write_text(f"{names}\nms,mm,mm,m\n{rest}")
    first, second = refusal_of(path).split("\n")
    assert first.startswith(
        "q.csv: column time_s, row of units: the unit is ms, and the column is one of s. Convert the"
    )
    assert second.startswith(
        "q.csv: column q_12, row of units: the unit is m, and the column is one of mm, or mm*sqrt("
    )


def test_units_in_the_metadata_of_parquet(tmp_path):
    """What a file says of its columns beside their names has to agree with them."""
    columns = history()
    for unit, agrees in (("s", True), ("ms", False)):
        fields = [
            pa.field(name, pa.float64(), metadata={"unit": unit if name == "time_s" else "mm"}) for name in columns
        ]
        pq.write_table(pa.table(list(columns.values()), pa.schema(fields)), tmp_path / "q.parquet")
        if agrees:
            read_history(tmp_path / "q.parquet", "run", MODES, (), strict=True)
        else:
            assert "q.parquet: column time_s: the unit is ms, and" in refusal_of(tmp_path / "q.parquet")


def test_time_as_durations_or_dates(tmp_path):
    """Durations are seconds whatever their unit; dates are refused as such."""
    columns = {name: pa.array(values) for name, values in history().items()}
    path = tmp_path / "q.parquet"
    for unit, ticks in (("ms", 10**3), ("us", 10**6), ("ns", 10**9)):
        time = pa.array([2 * ticks + k * ticks // 100 for k in range(5)], pa.duration(unit))
        pq.write_table(pa.table(columns | {"time_s": time}), path)
        read, _ = read_history(path, "run", MODES, (), strict=True)
        assert (read.step, read.start) == (pytest.approx(0.01), 2.0)
    pq.write_table(pa.table(columns | {"time_s": time.cast(pa.int64()).cast(pa.timestamp("ns"))}), path)
    assert "q.parquet: column time_s: the column holds dates or times of day, as 1970-01-01 00:00:02" in refusal_of(
        path
    )


def test_german_spreadsheet(tmp_path):
    """Semicolons, decimal commas and sep= give the same record as a plain file."""
    path = write(tmp_path / "q.csv", history())
    plain, _ = read_history(path, "run", MODES, (), strict=True)
    path.write_bytes(("sep=;\n" + path.read_text().replace(",", ";").replace(".", ",")).encode("utf-16"))
    read, warnings = read_history(path, "run", MODES, (), strict=True)
    assert warnings == []
    np.testing.assert_array_equal(read.q, plain.q)
    assert (read.step, read.start) == (plain.step, plain.start)
