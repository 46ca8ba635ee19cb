"""Modal coordinates on disk behave like the array they were written from."""

from concurrent.futures import ThreadPoolExecutor
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.errors import DataError
from fatigue.life.records import spool
from fatigue.life.records.spool import Spool, SpoolWriter, create_spool, time_slices


def spooled(q, path: Path) -> Spool:
    """Write an array to a file."""
    made = create_spool(path, q.shape, q.dtype)
    made[:, :] = q
    return made


@settings(deadline=None, max_examples=60)
@given(st.lists(st.integers(0, 20), max_size=6), st.integers(1, 4), st.sampled_from([np.float32, np.float64]))
def test_what_is_appended_is_there_in_its_order(tmp_path_factory, widths, modes, kind):
    """Parts of any width, shorter and longer than a chunk, one after the other."""
    parts = [np.random.default_rng(i).normal(size=(modes, width)).astype(kind) for i, width in enumerate(widths)]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(spool, "CHUNK", 7)
        with SpoolWriter(tmp_path_factory.mktemp("q") / "new" / "q", modes, np.dtype(kind)) as writer:
            for part in parts:
                writer.append(part)
        found = writer.spool()
        assert (found.shape, found.dtype) == ((modes, sum(widths)), kind)
        np.testing.assert_array_equal(np.asarray(found), np.concatenate([np.empty((modes, 0), kind), *parts], axis=1))


@settings(deadline=None, max_examples=60)
@given(st.data(), st.integers(1, 5), st.integers(1, 40), st.sampled_from([np.float32, np.float64]))
def test_any_part_is_that_of_the_array(tmp_path_factory, data, modes, samples, kind):
    """Whole, by modes, by samples, across the ends of chunks, with and without a start-up cut."""
    rng = np.random.default_rng(samples)
    q = rng.normal(size=(modes, samples)).astype(kind)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(spool, "CHUNK", 7)
        first = data.draw(st.integers(0, samples))
        found, wanted = spooled(q, tmp_path_factory.mktemp("q") / "q").later(first), q[:, first:]
        assert (found.shape, found.dtype) == (wanted.shape, wanted.dtype)
        np.testing.assert_array_equal(np.asarray(found), wanted)
        for _ in range(5):
            a, b, c, d = (data.draw(st.one_of(st.none(), st.integers(0, samples + 2))) for _ in range(4))
            np.testing.assert_array_equal(found[a:b, c:d], wanted[a:b, c:d])


@settings(deadline=None, max_examples=40)
@given(st.data(), st.integers(1, 5), st.integers(1, 40))
def test_parts_are_written_where_they_belong(tmp_path_factory, data, modes, samples):
    """Rows and columns in any order, numbers of another kind converted."""
    q = np.zeros((modes, samples), np.float32)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(spool, "CHUNK", 7)
        made = spooled(q, tmp_path_factory.mktemp("q") / "q")
        for value in range(1, 5):
            i, j = sorted(data.draw(st.tuples(st.integers(0, modes), st.integers(0, modes))))
            a, b = sorted(data.draw(st.tuples(st.integers(0, samples), st.integers(0, samples))))
            made[i:j, a:b] = q[i:j, a:b] = np.full((j - i, b - a), float(value))
        np.testing.assert_array_equal(made[:, :], q)


def test_threads_read_at_the_same_time(tmp_path):
    """Each read has its own place in the file."""
    q = np.random.default_rng(0).normal(size=(20, 20_000)).astype(np.float32)
    made = spooled(q, tmp_path / "q")
    pieces = [slice(a, a + 777) for a in range(0, 20_000, 500)] * 3
    with ThreadPoolExecutor(8) as executor:
        for piece, found in zip(pieces, executor.map(lambda piece: made[:, piece], pieces), strict=True):
            np.testing.assert_array_equal(found, q[:, piece])


@pytest.mark.parametrize("shape", [(1, 1), (3, 4096), (3, 10_000_000), (100, 100_000), (5000, 9000)])
def test_pieces_of_time_are_bounded_and_cover_the_record(shape):
    """16 MB in double precision, or the samples of one chunk where there are very many modes."""
    pieces = list(time_slices(shape))
    assert (pieces[0].start, pieces[-1].stop) == (0, shape[1])
    assert all(a.stop == b.start for a, b in pairwise(pieces))
    assert max(piece.stop - piece.start for piece in pieces) <= max(spool.CHUNK, spool.AT_ONCE // shape[0])


def test_a_file_that_is_cut_short_is_noticed(tmp_path):
    """Nobody is given numbers that were never written."""
    made = spooled(np.ones((2, 100)), tmp_path / "q")
    with made.path.open("r+b") as file:
        file.truncate(1000)
    with pytest.raises(DataError, match="the scratch file is cut short"):
        made[:, :]


def test_a_full_disk_and_a_bad_place_are_told(tmp_path, monkeypatch):
    """In the words of the program."""
    (tmp_path / "file").write_text("")
    with pytest.raises(DataError, match=r"cannot be written .*Give a folder you may write to"):
        create_spool(tmp_path / "file" / "q", (1, 1), np.dtype(np.float32))
    made = spooled(np.ones((2, 100)), tmp_path / "q")

    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(spool, "write_all", full)
    with pytest.raises(DataError, match="the disk is full"):
        made[:, :] = np.zeros((2, 100))
