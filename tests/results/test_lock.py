"""The lock of a result folder: one run at a time, and nothing of it stays behind."""

import errno
import os

import pytest

from fatigue.errors import DataError
from fatigue.results.lock import LOCK, locked


def test_lock_is_exclusive_and_goes_away(tmp_path):
    """One run at a time; the folder is free again afterwards, and gone if it was made for nothing."""
    folder = tmp_path / "result"
    with locked(folder), pytest.raises(DataError, match="another run is writing to this folder"), locked(folder):
        pass
    assert not folder.exists()
    folder.mkdir()
    with locked(folder):
        pass
    assert folder.exists()


def test_a_folder_that_cannot_be_made_is_named(tmp_path):
    """The parent is a file."""
    (tmp_path / "file").write_text("")
    with pytest.raises(DataError, match="cannot be written"), locked(tmp_path / "file" / "result"):
        pass


@pytest.mark.parametrize("number", [errno.ENOLCK, errno.ENOTSUP, errno.EOPNOTSUPP, errno.ENOSYS, errno.EINVAL])
def test_a_file_system_without_locks_is_told_with_the_way_round(tmp_path, monkeypatch, number):
    """It is not taken for another run, and nothing stays behind."""

    def lockless(descriptor):
        raise OSError(number, os.strerror(number))

    monkeypatch.setattr("fatigue.results.lock._lock", lockless)
    with pytest.raises(DataError, match=r"the file system has no locks .* or --no-lock if no"), locked(tmp_path / "r"):
        pass
    assert not (tmp_path / "r").exists()
    with locked(tmp_path / "r", no_lock=True):
        pass
    assert not (tmp_path / "r").exists()


def test_without_locks_the_file_itself_keeps_runs_apart(tmp_path):
    """Two such runs, and one such with one that locks, whichever is first; the message names the process."""
    folder = tmp_path / "result"
    who = rf"another run is writing to this folder \(process {os.getpid()} on .* since .*remove .*{LOCK}"
    with locked(folder, no_lock=True):
        for no_lock in (True, False):
            with pytest.raises(DataError, match=who), locked(folder, no_lock=no_lock):
                pass
    with locked(folder), pytest.raises(DataError, match="another run is writing"), locked(folder, no_lock=True):
        pass
    assert not folder.exists()


def test_the_file_of_a_killed_run_is_named_and_stays(tmp_path):
    """Nobody can tell from here whether it still runs; once removed, the folder is free."""
    (tmp_path / LOCK).write_text("process 1 on elsewhere since yesterday")
    for no_lock in (True, False):
        with pytest.raises(DataError, match="process 1 on elsewhere"), locked(tmp_path, no_lock=no_lock):
            pass
    (tmp_path / LOCK).unlink()
    with locked(tmp_path, no_lock=True):
        pass
