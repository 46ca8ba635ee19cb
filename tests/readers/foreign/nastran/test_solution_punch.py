"""Punch files of solution set displacements, sorted by time and by mode."""

import numpy as np
import pytest

from fatigue.errors import DataError
from fatigue.readers.foreign.read import read_channels, read_coordinates, recognise
from tests.readers.foreign.nastran.solution_punch_writer import dollar, heading, row, solution_punch

T = 0.005 * np.arange(12)
Q = np.random.default_rng(2).standard_normal((3, 12))
MODES = (1, 2, 11)


def by_time(subcase=1, word="DISPLACEMENTS", q=Q):
    """SORT1."""
    return solution_punch(T, q, MODES, subcase=subcase, word=word)


def by_mode(subcase=1, q=Q):
    """SORT2: a block for each mode."""
    return "".join(
        heading("DISPLACEMENTS", subcase)
        + dollar(f"$POINT ID = {mode:12d}  IDENTIFIED BY TIME", 7)
        + "".join(row(f"{t:.3E}", "M", q[k, n]) for n, t in enumerate(T))
        for k, mode in enumerate(MODES)
    )


LATER = heading("DISPLACEMENTS", 1) + dollar("$TIME = 0.9", 7) + row(1, "M", 1.0)


@pytest.mark.parametrize("text", [by_time(), by_mode()], ids=["by time", "by mode"])
def test_modal_coordinates(tmp_path, text):
    """The mode is the number of the row or of the block."""
    (tmp_path / "run.pch").write_text(text)
    assert recognise(tmp_path / "run.pch").key == "punch"
    history = read_coordinates(tmp_path / "run.pch", None, None)
    assert history.mode.tolist() == list(MODES)
    np.testing.assert_allclose(history.time, T, rtol=1e-3)
    np.testing.assert_allclose(history.q, Q, rtol=1e-6)


def test_velocities_and_extra_points_are_no_coordinates(tmp_path):
    """Passed over, the points told."""
    extra = by_time().replace(row(11, "M", Q[2, 3]), row(11, "M", Q[2, 3]) + row(99, "E", 5.0))
    (tmp_path / "run.pch").write_text(by_time(word="VELOCITY", q=9 * Q) + extra)
    history = read_coordinates(tmp_path / "run.pch", None, None)
    np.testing.assert_allclose(history.q, Q, rtol=1e-6)
    assert [warning.code for warning in history.warnings] == ["points_left_out"]


def test_subcases_are_groups(tmp_path):
    """Each an event: together they would claim every mode twice, and are refused with the way to one of them."""
    (tmp_path / "run.pch").write_text(by_time(1) + by_time(2, q=2 * Q))
    first, second = read_channels(tmp_path / "run.pch")
    assert (first.name, second.name) == ("subcase 1", "subcase 2")
    np.testing.assert_allclose(second.values([0]), 2 * Q[:1], rtol=1e-6)
    with pytest.raises(DataError, match=r"'q_1' is in groups 'subcase 1' and 'subcase 2'.*--group 'subcase 2' -o"):
        read_coordinates(tmp_path / "run.pch", None, None)


@pytest.mark.parametrize(
    ("text", "code", "said"),
    [
        (by_time().replace("$REAL OUTPUT   ", "$REAL-IMAGINARY"), "harmonic", "complex"),
        (by_mode().replace("IDENTIFIED BY TIME", "IDENTIFIED BY FREQ"), "harmonic", "by freq"),
        (
            by_time() + heading("DISPLACEMENTS", 1) + dollar("$TIME = 0.9", 7) + row(1, "M", 1.0),
            "several_times",
            "mode 2",
        ),
        (by_time() + by_time(), "punch_damaged", "two coordinates"),
        (
            by_time().replace("      0.000000E+00       7", "      2.000000E+00       7", 1),
            "punch_damaged",
            "beside the",
        ),
        (
            by_time().replace("      0.000000E+00       8", "      2.000000E+00       8", 1),
            "punch_damaged",
            "beside the",
        ),
        (by_time().replace("$TIME = 5", "$TIMES = 5", 1), "punch_damaged", "a row of a mode or a time"),
        (by_time().replace("E-", "X-", 3), "punch_damaged", "no number"),
        (heading("ACCELERATION", 1) + row(1, "M", 1.0), "no_coordinates", "no displacements of the solution set"),
    ],
)
def test_what_cannot_be_read_is_refused(tmp_path, text, code, said):
    """With its line."""
    (tmp_path / "run.pch").write_text(text)
    with pytest.raises(DataError) as caught:
        read_coordinates(tmp_path / "run.pch", None, None)
    assert caught.value.problems[0].code == code
    assert said in str(caught.value)


def test_line_ends_of_windows_and_other_headings(tmp_path):
    """As copied in another mode, and as the heading stands elsewhere."""
    text = by_time().replace("DISPLACEMENTS - SOLUTION SET", "DISPLACEMENT (SOLUTION SET)  ").replace("\n", "\r\n")
    (tmp_path / "run.pch").write_bytes(text.encode())
    np.testing.assert_allclose(read_coordinates(tmp_path / "run.pch", None, None).q, Q, rtol=1e-6)


def test_a_cut_punch_file(tmp_path):
    """Within a block a mode lacks its last time, which is refused; where a block ends nothing tells it."""
    text = by_time()
    end = text.index("$TITLE", len(text) // 2)
    (tmp_path / "run.pch").write_text(text[: end - 200])
    with pytest.raises(DataError, match="times"):
        read_coordinates(tmp_path / "run.pch", None, None)
    (tmp_path / "run.pch").write_text(text[:end])
    assert read_coordinates(tmp_path / "run.pch", None, None).time.size < T.size
