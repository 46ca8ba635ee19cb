"""Files that are either whole or not there."""

import pytest

from fatigue.errors import DataError
from fatigue.files.whole import replacing, staged


@pytest.mark.parametrize("name", ["x", "x" * 250, "ü" * 120])
def test_a_failure_leaves_the_old_file_and_nothing_else(tmp_path, name):
    """Also of a name that leaves no room for the name of a temporary file."""
    final = tmp_path / name
    final.write_text("old")
    with pytest.raises(KeyboardInterrupt), replacing(final) as unfinished:
        unfinished.write_text("half")
        raise KeyboardInterrupt
    assert final.read_text() == "old"
    with replacing(final) as unfinished:
        unfinished.write_text("new")
    assert [path.name for path in tmp_path.iterdir()] == [name]
    assert final.read_text() == "new"


def test_a_stage_goes_with_the_folders_made_for_it(tmp_path):
    """A failure leaves no empty folder; what was there before stays, and so does what was moved there."""
    (tmp_path / "mine").mkdir()
    folder = tmp_path / "mine" / "a" / "b"
    with pytest.raises(DataError, match="the disk is full"), staged(folder, ".x-") as stage:
        (stage / "half").write_text("")
        raise OSError(28, "No space left on device")
    assert not list((tmp_path / "mine").iterdir())
    with staged(folder, ".x-") as stage:
        (stage / "whole").write_text("")
        (stage / "whole").replace(folder / "whole")
    assert [path.name for path in folder.iterdir()] == ["whole"]
