"""Columns of a history find the modes of the FE run: by number, by frequency, in order."""

from dataclasses import replace

import numpy as np
import pytest

from fatigue.errors import DataError
from fatigue.readers.foreign.histories.foreign_history import ForeignHistory
from fatigue.readers.foreign.histories.matching import matched
from fatigue.readers.foreign.read import read_coordinates


@pytest.fixture
def read(tmp_path):
    """Read coordinates given as text."""

    def reader(text, columns=None, time_column=None):
        path = tmp_path / "q.txt"
        path.write_text(text)
        return read_coordinates(path, columns, time_column)

    return reader


def test_matching(read):
    """Columns find modes by number, by frequency in their names, or in their order."""
    history = read("t,Mode 1 (10.02 Hz),Mode 2 (20 Hz)\n0,1,2\n1,3,4\n")
    modes, frequencies = np.array([4, 7]), np.array([20.0, 10.0])
    assert matched(history, modes, frequencies, "frequency").mode.tolist() == [7, 4]
    assert matched(history, modes, frequencies, "order").mode.tolist() == [4, 7]
    assert matched(history, modes, frequencies, "id").mode.tolist() == [1, 2]
    with pytest.raises(DataError, match=r"10\.02 Hz, the nearest mode"):
        matched(history, modes, np.array([20.0, 11.0]), "frequency")
    twice = read("t,q4,p4\n0,1,2\n1,3,4\n")
    with pytest.raises(DataError, match="mode 4 is claimed"):
        matched(twice, modes, frequencies, "id")
    with pytest.raises(DataError, match="names no mode"):
        matched(read("t,a\n0,1\n1,3\n"), modes, frequencies, "id")
    with pytest.raises(DataError, match="cannot be matched by frequency"):
        matched(read("t,a\n0,1\n1,3\n"), modes, frequencies, "frequency")
    with pytest.raises(DataError, match="1 columns for 2 modes"):
        matched(read("0,1\n1,3\n"), modes, frequencies, "order")


def stated(frequency, mode=(1, 2), resolution=None):
    """Two columns with frequencies, as a file states them."""
    half = None if resolution is None else np.full(2, resolution)
    names = tuple(f"q_{m}" for m in mode)
    q = np.zeros((2, 3))
    return ForeignHistory("q", np.array(mode), np.array(frequency, float), names, np.arange(3.0), q, resolution=half)


def test_a_frequency_that_fits_another_mode():
    """Better by more than the written digits explain is refused; a swap within them is not."""
    modes, fe = np.array([1, 2, 3]), np.array([10.0, 10.4, 20.0])
    assert matched(stated([10.0, 10.4]), modes, fe, "id").mode.tolist() == [1, 2]
    assert matched(stated([10.2, 10.2], resolution=0.05), modes, fe, "id").mode.tolist() == [1, 2]
    assert matched(stated([10.0, 10.0], resolution=0.5), modes, fe, "id").mode.tolist() == [1, 2]
    assert matched(stated([9.0, 11.0]), modes, fe, "id").mode.tolist() == [1, 2]  # far, and nearest to its own
    with pytest.raises(DataError) as refusal:
        matched(stated([10.4, 10.0], resolution=0.05), modes, fe, "id")
    assert [str(problem) for problem in refusal.value.problems] == [
        f"q: column 'q_{m}' has {f} Hz; its mode {m} has {own} Hz in the FE run, mode {other} has {f} Hz. Join by "
        "--match frequency, or use the same modal basis on both sides."
        for m, f, own, other in ((1, "10.4", "10", 2), (2, "10", "10.4", 1))
    ]
    assert matched(stated([10.4, 10.0]), modes, fe, "frequency").mode.tolist() == [2, 1]
    rigid = np.array([1e-5, 3e-5, 20.0])
    assert matched(stated([3e-5, 1e-5]), modes, rigid, "id").mode.tolist() == [1, 2]
    assert matched(stated([10.4, np.nan], (3, 2)), modes, np.array([1.0, 2.0, np.nan]), "id").mode.tolist() == [3, 2]


def test_order_without_rigid_modes():
    """One column too few for all modes and enough for the elastic ones: the way to leave the rigid ones out."""
    modes, fe = np.array([1, 2, 3, 4]), np.array([0.0, 1e-6, 10.0, 20.0])
    with pytest.raises(DataError, match=r"leaves out the rigid modes, add --ignore-modes 1,2\."):
        matched(stated([np.nan, np.nan]), modes, fe, "order")
    same = replace(stated([np.nan, np.nan], (1, 1)), name=("q_1", "q_1"))
    with pytest.raises(DataError, match="column 'q_1' is there 2 times"):
        matched(same, modes[2:], fe[2:], "order")
