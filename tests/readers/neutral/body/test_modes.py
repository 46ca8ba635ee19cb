"""Modes: what the file says arrives, and what it says wrong is told."""

import numpy as np
import pytest

from fatigue.readers.neutral.body.modes import read_modes
from tests.readers.neutral_tables import MODES, changed, refusal_of, without, write

SUFFIXES = pytest.mark.parametrize("suffix", [".csv", ".parquet"])


@SUFFIXES
def test_modes_are_sorted_by_id(tmp_path, suffix):
    """Modes come in ascending order with their values and the documented defaults."""
    modes, warnings = read_modes(write(tmp_path / f"m{suffix}", MODES), (), strict=True)
    assert modes.mode.tolist() == [3, 7, 12]
    assert modes.frequency.tolist() == [8.0, 12.5, 90.0]
    assert modes.kind == ("normal", "normal", "interface")
    assert np.isnan(modes.damping_ratio).all()
    assert modes.modal_mass.tolist() == [1.0, 1.0, 1.0]
    assert modes.scale.tolist() == [1.0, 1.0, 1.0]
    assert warnings == []


@SUFFIXES
def test_optional_columns_of_modes(tmp_path, suffix):
    """Empty cells take the defaults, others their values."""
    extra = {"damping_ratio": [0.02, None, 0.0], "modal_mass": [None, 2.0, 1.0], "scale": [-2.0, None, 0.5]}
    modes, _ = read_modes(write(tmp_path / f"m{suffix}", MODES | extra), (), strict=True)
    np.testing.assert_array_equal(modes.damping_ratio, [np.nan, 0.02, 0.0])
    assert modes.modal_mass.tolist() == [2.0, 1.0, 1.0]
    assert modes.scale.tolist() == [1.0, -2.0, 0.5]


def test_ignored_modes_are_left_out(tmp_path):
    """Ignored modes disappear; ids that no table has may be listed."""
    modes, _ = read_modes(write(tmp_path / "m.csv", MODES), (3, 99), strict=True)
    assert modes.mode.tolist() == [7, 12]
    message = refusal_of(read_modes, tmp_path / "m.csv", (3, 7, 12))
    assert message == "m.csv: ignore_modes leaves no mode. Take modes out of ignore_modes."


@pytest.mark.parametrize("modes", [without(MODES, "kind"), changed(MODES, "kind", 3, "rigid")])
def test_no_interface_mode_is_a_warning(tmp_path, modes):
    """Without interface modes local welds lose their force, so the user is told."""
    _, warnings = read_modes(write(tmp_path / "m.csv", modes), (), strict=True)
    assert [warning.code for warning in warnings] == ["no_interface_mode"]
    assert str(warnings[0]).startswith(
        "m.csv: column kind: none of the 3 modes is an interface mode, so welds near local"
    )


@SUFFIXES
@pytest.mark.parametrize(
    ("columns", "message"),
    [
        (without(MODES, "mode"), "column mode: the column is missing. Add it; the columns are frequency_hz, kind."),
        (changed(MODES, "mode", 2, 7), "column mode, row 2: mode 7 repeats row 1. Keep one of the rows."),
        (changed(MODES, "mode", 2, 3.5), "column mode, row 2: 3.5 is not a whole number. Give a whole number."),
        (changed(MODES, "frequency_hz", 3, -1.0), "column frequency_hz, row 3: -1 is below 0. Give at least 0."),
        (changed(MODES, "frequency_hz", 3, None), "column frequency_hz, row 3: the value is missing or NaN. Give a"),
        (
            changed(MODES, "frequency_hz", 3, float("inf")),
            "column frequency_hz, row 3: inf is not finite. Give a finite",
        ),
        (changed(MODES, "frequency_hz", 1, "f"), "column frequency_hz, row 1: 'f' is not a number. Give a number."),
        (
            changed(MODES, "kind", 3, "residual"),
            "column kind, row 3: 'residual' is not one of normal, interface, rigid. Give one of normal, interface,",
        ),
        (
            MODES | {"scale": [1.0, 0.0, 1.0]},
            "column scale, row 2: 0 takes the mode out. List the mode under ignore_modes",
        ),
        (MODES | {"modal_mass": [1.0, 0.0, 1.0]}, "column modal_mass, row 2: 0 is not above 0. Give more than 0."),
        (MODES | {"damping_ratio": [0.1, 0.1, -0.1]}, "column damping_ratio, row 3: -0.1 is below 0. Give at least 0."),
    ],
)
def test_bad_modes(tmp_path, suffix, columns, message):
    """Every mistake in the modes names file, column, row and value."""
    path = write(tmp_path / f"m{suffix}", columns)
    assert refusal_of(read_modes, path, ()).startswith(f"m{suffix}: {message}")


@SUFFIXES
@pytest.mark.parametrize(
    ("column", "values", "code", "said"),
    [
        ("damping_ratio", [2.0, 1.5, 1.0], "unusual_damping", "2 of mode 7 is above 0.3; so are those of 1 more"),
        ("damping_ratio", [0.02, 0.31, 1.0], "unusual_damping", "0.31 of mode 3 is above 0.3"),
        ("damping_ratio", [0.3, 0.05, 5.0], None, ""),  # an interface mode may be damped as one likes
        ("frequency_hz", [8.0, 1e300, 90.0], "unusual_frequency", "1e+300 of mode"),
    ],
)
def test_damping_in_per_cent_and_frequencies_of_nothing(tmp_path, suffix, column, values, code, said):
    """Once for all modes, with the largest value."""
    _, warnings = read_modes(write(tmp_path / f"m{suffix}", MODES | {column: values}), (), strict=True)
    assert [warning.code for warning in warnings] == ([code] if code else [])
    assert not code or said in warnings[0].what


def test_damping_that_multibody_codes_set_above_a_kilohertz_is_no_doubt(tmp_path):
    """Normal modes above 1000 Hz are damped critically by rule; below, the same ratio is told."""
    damped = {"damping_ratio": [0.02, 1.0, 1.0]}
    high = MODES | {"frequency_hz": [8.0, 1200.0, 5000.0]} | damped
    assert not read_modes(write(tmp_path / "high.csv", high), (), strict=True)[1]
    low = MODES | {"frequency_hz": [8.0, 900.0, 5000.0]} | damped
    assert [w.code for w in read_modes(write(tmp_path / "low.csv", low), (), strict=True)[1]] == ["unusual_damping"]
