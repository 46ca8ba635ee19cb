"""What the operating system refuses: place, reason and remedy in one line, whatever library it was said to."""

import errno

import pytest

from fatigue.errors import DataError
from fatigue.files.mishaps import LONGEST_SHOWN, cannot_write, reason, refusal, refused_writing, shown


@pytest.mark.parametrize(
    ("number", "words"),
    [
        (errno.ENOSPC, "q.parquet: the disk is full. Free some space and give the same command again."),
        (errno.EDQUOT, "q.parquet: the disk is full. Free some space and give the same command again."),
        (errno.EFBIG, "q.parquet: cannot be written (File too large). Raise the largest size of a file (`ulimit -f`)"),
        (errno.EMFILE, "q.parquet: cannot be written (Too many open files). Raise the number of files"),
        (errno.EROFS, "q.parquet: cannot be written (Read-only file system). Give a folder you may write to."),
        (errno.EACCES, "q.parquet: cannot be written (Permission denied). Give a folder you may write to."),
        (errno.EIO, "q.parquet: cannot be written (Input/output error). Copy the files to another disk"),
    ],
)
def test_what_cannot_be_written_is_told_with_its_place(number, words):
    """Also where the error names no file, as those of a write do not."""
    with pytest.raises(DataError) as refused, refused_writing("q.parquet"):
        raise OSError(number, "said in the words of a library. Detail: [errno 1] x")  # as Arrow does
    assert str(refused.value).startswith(words)


def test_an_error_without_number_keeps_its_words():
    """As libraries raise for a damaged file."""
    assert reason(OSError("odd bytes")) == "odd bytes"
    assert reason(OSError()) == "OSError"
    assert "cannot be written (odd bytes)" in str(cannot_write("x", OSError("odd bytes")))


def test_a_folder_that_is_not_there_is_told(tmp_path):
    """Not the file in it."""
    path = tmp_path / "no" / "x"
    with pytest.raises(FileNotFoundError) as met:
        path.write_text("")
    assert str(refusal(met.value)) == f"{path}: there is no folder {path.parent}. Make it, or correct the path."


def test_endless_paths_are_shown_without_their_middle():
    """The ends tell which one it is."""
    assert shown("a" * LONGEST_SHOWN) == "a" * LONGEST_SHOWN
    assert shown("a" * 5000 + "z") == "a" * 200 + " ... " + "a" * 199 + "z"
