"""Long histories: block by block the same samples, times, warnings and refusals as read as a whole."""

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from pyarrow import csv

from fatigue.errors import DataError
from fatigue.life.records.spool import Spool
from fatigue.readers.neutral import long_history
from fatigue.readers.neutral.history import check_history, read_history
from fatigue.readers.neutral.record_outline import RecordOutline

MODES = np.array([3, 7])
SAMPLES = 9001  # more than two chunks of a spool
SUFFIXES = pytest.mark.parametrize("suffix", [".csv", ".parquet"])


@pytest.fixture
def reads_blocks(monkeypatch):
    """Every history is long, and a block has few rows; give a switch back."""

    def switch(*, on: bool) -> None:
        monkeypatch.setattr(long_history, "LONG_NUMBERS", 0 if on else 1e9)
        monkeypatch.setattr(long_history, "LONG_BYTES", 0 if on else 1e9)

    monkeypatch.setattr(long_history, "NUMBERS_AT_ONCE", 3000)
    switch(on=True)
    return switch


def columns(kind=np.float64):
    """Time in s, and two modes out of order."""
    rng = np.random.default_rng(1)
    return {"q_7": rng.normal(size=SAMPLES).astype(kind), "time_s": 2.0 + 0.004 * np.arange(SAMPLES)} | {
        "q_3": rng.normal(size=SAMPLES).astype(kind)
    }


def written(path, table):
    """Write a table as its name says, in row groups that are no multiple of anything."""
    if path.suffix == ".csv":
        csv.write_csv(pa.table(table), path)
    else:
        pq.write_table(pa.table(table), path, row_group_size=2500)
    return path


@SUFFIXES
@pytest.mark.parametrize("kind", [np.float32, np.float64])
@pytest.mark.parametrize("on_disk", [False, True])
def test_block_by_block_is_as_a_whole(tmp_path, reads_blocks, suffix, kind, on_disk):
    """Bit for bit, in the precision of the file."""
    path = written(tmp_path / f"q{suffix}", columns(kind) | {"remark": np.zeros(SAMPLES)})
    scratch = tmp_path / "scratch" / "q" if on_disk else None
    found, warnings = read_history(path, "run", MODES, (), strict=False, scratch=scratch)
    outline, of_whole = RecordOutline(3.0), RecordOutline(3.0)
    grid, of_check = check_history(path, MODES, (), strict=False, outline=outline)
    assert isinstance(found.q, Spool) == on_disk
    reads_blocks(on=False)
    whole, expected = read_history(path, "run", MODES, (), strict=False)
    assert found.q.dtype == whole.q.dtype
    np.testing.assert_array_equal(np.asarray(found.q), whole.q)
    assert (found.step, found.start) == (whole.step, whole.start)
    assert check_history(path, MODES, (), strict=False, outline=of_whole)[0] == grid
    assert outline.equals(of_whole)
    assert [column.kept for column in outline.columns] == [column.kept for column in of_whole.columns]
    assert warnings == of_check == expected
    assert len(expected) == 1


@SUFFIXES
@pytest.mark.parametrize(
    ("name", "row", "value"),
    [("q_7", 8000, np.nan), ("q_3", 5000, np.inf), ("time_s", 4321, 0.0), ("time_s", 7, np.nan), ("time_s", 9000, 1e3)],
)
def test_mistakes_are_told_with_their_row(tmp_path, reads_blocks, suffix, name, row, value):
    """In the words of a short history, wherever in the file they are."""
    table = columns()
    table[name][row] = value
    path = written(tmp_path / f"q{suffix}", table)
    messages = []
    for on in (True, False):
        reads_blocks(on=on)
        for scratch in (None, tmp_path / "q"):
            with pytest.raises(DataError) as refusal:
                read_history(path, "run", MODES, (), strict=True, scratch=scratch)
            messages.append(str(refusal.value))
        with pytest.raises(DataError) as refusal:
            check_history(path, MODES, (), strict=True, outline=RecordOutline())
        messages.append(str(refusal.value))
    assert f"column {name}, row" in messages[0]
    assert len(set(messages)) == 1


def test_a_file_that_is_cut_short(tmp_path, reads_blocks):
    """Damaged in the middle: refused by its name."""
    path = written(tmp_path / "q.parquet", columns())
    data = bytearray(path.read_bytes())
    data[20_000:60_000] = bytes(40_000)
    path.write_bytes(data)
    with pytest.raises(DataError, match=r"q\.parquet"):
        read_history(path, "run", MODES, (), strict=True, scratch=tmp_path / "scratch")


def test_whole_numbers_and_texts_are_left_to_the_other_reader(tmp_path, reads_blocks):
    """Whole numbers are numbers; durations are seconds."""
    table = columns() | {"q_7": np.arange(SAMPLES), "time_s": pa.array(4 * np.arange(SAMPLES), pa.duration("ms"))}
    found, _ = read_history(written(tmp_path / "q.parquet", table), "run", MODES, (), strict=True)
    assert found.q[1, 1:3].tolist() == [1.0, 2.0]
    assert found.step == pytest.approx(0.004)
