"""The lock of a result folder: one run at a time, and nothing of it stays behind."""

import pytest

from fatigue.errors import DataError
from fatigue.results.lock import locked


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
