"""One basis for forces and coordinates, function by function: joined, scaled, or refused with the difference."""

import numpy as np
import pytest

from fatigue.errors import DataError
from fatigue.readers.convert.modal_basis import (
    assumed_masses,
    common_modes,
    coordinate_units,
    mode_masses,
    mode_scale,
    numbered,
    simulated_frequencies,
    simulation_modes,
    with_known_frequencies,
    without_modes,
)
from fatigue.readers.foreign.fe.results import FeResults
from fatigue.readers.foreign.histories.foreign_history import ForeignHistory
from fatigue.readers.neutral.body.modes import LOWEST_HZ
from fatigue.readers.units.systems import SYSTEMS


def fe(mode=(1, 2, 3), frequency=(0.0, 5.0, 9.0), mass=(np.nan, np.nan, np.nan), **more):
    """Results of a modal run with one force row; its force and shape are the number of the mode."""
    number = np.asarray(mode, float)
    return FeResults(
        source="run.op2",
        solver="",
        analysis=more.pop("analysis", "modal"),
        mode=np.array(mode, np.int64),
        frequency=np.array(frequency, float),
        modal_mass=np.array(mass, float),
        node=np.array([11]),
        element=np.array([21]),
        kind=np.array(["QUAD4"]),
        force=number[:, None, None] * np.ones((1, 1, 6)),
        shape_node=np.array([11]),
        shape=number[:, None, None] * np.ones((1, 1, 6)),
        **more,
    )


def history(mode=(1, 2, 3), frequency=(np.nan, np.nan, np.nan), resolution=None):
    """Coordinates of some modes, four samples."""
    mode = np.array(mode, np.int64)
    names = tuple(f"q_{m}" for m in mode)
    q = np.arange(4.0) * mode[:, None]
    return ForeignHistory("run.csv", mode, np.array(frequency, float), names, np.arange(4.0), q, resolution=resolution)


def test_modes_are_left_out_with_all_that_is_theirs():
    """Forces, shapes, frequencies and masses of the modes that stay; of none that is named, the same results."""
    results = fe(mass=(1.0, 2.0, 3.0))
    left = without_modes(results, [2, 77])
    assert left.mode.tolist() == [1, 3]
    assert left.force[:, 0, 0].tolist() == left.shape[:, 0, 0].tolist() == [1.0, 3.0]
    assert (left.frequency.tolist(), left.modal_mass.tolist()) == ([0.0, 9.0], [1.0, 3.0])
    assert without_modes(results, [77]) is results
    with pytest.raises(DataError, match="all 3 modes with forces are left out: 1, 2, 3"):
        without_modes(results, [1, 2, 3])


@pytest.mark.parametrize(
    ("stated", "resolution", "listed", "fits"),
    [
        (5.0, 0.05, 5.04, True),
        (5.0, 0.05, 4.96, True),
        (5.0, 0.05, 5.2, False),
        (5.0, 0.05, 4.8, False),
        (5.12, 0.005, 5.1, True),  # 5.1 stands for 5.05 to 5.15
        (5.12, 0.005, 5.0, False),
        (5.12, 0.005, 5.3, False),
        (5.12, 0.005, np.nan, True),
    ],
)
def test_frequencies_of_the_table_must_be_those_of_the_file(stated, resolution, listed, fits):
    """As far as the digits of both go, above as below."""
    own = history(frequency=(np.nan, stated, np.nan), resolution=np.array([np.nan, resolution, np.nan]))
    table = {1: (1.5, np.nan), 2: (listed, np.nan)}
    if fits:
        found = with_known_frequencies(own, table, "modes.csv").frequency
        np.testing.assert_array_equal(found, [1.5, stated, np.nan])
    else:
        with pytest.raises(DataError, match=rf"mode 2 has {listed:g} Hz, and {stated:g} Hz in run\.csv"):
            with_known_frequencies(own, table, "modes.csv")


def test_table_of_the_simulation(tmp_path):
    """Frequency and mass by mode; none without a file, and a mass that is not given is none."""
    (tmp_path / "modes.csv").write_text("mode,frequency_hz,modal_mass\n4,5.5,2.5\n7,9.25,1\n")
    assert simulation_modes(tmp_path / "modes.csv")[0] == {4: (5.5, 2.5), 7: (9.25, 1.0)}
    (tmp_path / "bare.csv").write_text("mode,frequency_hz\n4,5.5\n")
    found, warnings = simulation_modes(tmp_path / "bare.csv")
    assert found[4][0] == 5.5
    assert np.isnan(found[4][1])
    assert (warnings, simulation_modes(None)) == ([], ({}, []))


def test_columns_without_numbers_take_those_of_the_table():
    """In its order; columns that name their modes keep them, and another number of rows is refused."""
    table = {7: (1.0, np.nan), 5: (2.0, np.nan), 9: (3.0, np.nan)}
    assert numbered(history(mode=(0, 0, 0)), table, "modes.csv").mode.tolist() == [7, 5, 9]
    assert numbered(history(mode=(1, 0, 2)), table, "modes.csv").mode.tolist() == [7, 5, 9]
    assert numbered(history(), table, "modes.csv").mode.tolist() == [1, 2, 3]
    assert numbered(history(mode=(0, 0), frequency=(np.nan,) * 2), {}, "modes.csv").mode.tolist() == [0, 0]
    with pytest.raises(DataError, match=r"3 modes for 2 columns of run\.csv"):
        numbered(history(mode=(0, 0), frequency=(np.nan,) * 2), table, "modes.csv")


def test_frequencies_of_the_simulation_by_mode():
    """Of the histories, those that are stated; without a history those of the table."""
    assert simulated_frequencies([history(frequency=(np.nan, 5.0, 9.0))], {1: (7.0, 1.0)}) == {2: 5.0, 3: 9.0}
    assert simulated_frequencies([], {1: (7.0, 1.0)}) == {1: 7.0}


@pytest.mark.parametrize(("frequency", "rigid"), [(LOWEST_HZ, True), (1.001 * LOWEST_HZ, False), (0.0, True)])
def test_rigid_modes_may_lack_coordinates(frequency, rigid):
    """Up to the lowest frequency a mode is left out with a warning; an elastic one, or a static one, is refused."""
    results, of = fe(frequency=(frequency, 5.0, 9.0)), history(mode=(2, 3), frequency=(np.nan,) * 2)
    if rigid:
        left, (warning,) = common_modes(results, [of], "run.op2", ())
        assert left.mode.tolist() == [2, 3]
        assert warning.what == "rigid modes 1 are left out"
        with pytest.raises(DataError, match="modes 1 have forces and no coordinates"):
            common_modes(results, [of], "run.op2", [1])
    else:
        with pytest.raises(DataError, match="modes 1 have forces and no coordinates"):
            common_modes(results, [of], "run.op2", ())


def test_modes_that_only_one_side_has():
    """Each history is looked at; of many modes ten are named and the others counted."""
    results = fe()
    assert common_modes(results, [history(), history()], "run.op2", ()) == (results, [])
    with pytest.raises(DataError, match="modes 4 have coordinates and no forces"):
        common_modes(results, [history(), history(mode=(1, 2, 4))], "run.op2", ())
    with pytest.raises(DataError, match="modes 3 have forces and no coordinates"):
        common_modes(results, [history(), history(mode=(1, 2), frequency=(np.nan,) * 2)], "run.op2", ())
    many = history(mode=range(1, 16), frequency=(np.nan,) * 15)
    with pytest.raises(DataError, match="modes 4, 5, 6, 7, 8, 9, 10, 11, 12, 13 and 2 more have coordinates"):
        common_modes(results, [many], "run.op2", ())
    ten = history(mode=range(1, 14), frequency=(np.nan,) * 13)
    with pytest.raises(DataError, match="modes 4, 5, 6, 7, 8, 9, 10, 11, 12, 13 have coordinates"):
        common_modes(results, [ten], "run.op2", ())


@pytest.mark.parametrize(
    ("mode", "proposal"),
    [
        ((11, 12, 13), "If modes 11-13 of the simulation are modes 1-3 of the FE run, state --match order"),
        ((1, 2), "state --match order --ignore-modes 1"),
        ((2, 4), None),
        ((5, 6), None),
    ],
)
def test_a_count_that_begins_elsewhere_is_proposed(mode, proposal):
    """As many modes, or as many as there are elastic ones from 1 on; otherwise nothing is guessed."""
    results = fe(frequency=(0.0, 5.0, 9.0)) if proposal else fe(frequency=(3.0, 5.0, 9.0))
    of = history(mode=mode, frequency=(np.nan,) * len(mode))
    with pytest.raises(DataError) as caught:
        common_modes(results, [of], "run.op2", (1,))
    assert ("--match order" in str(caught.value)) == bool(proposal)
    assert (proposal or "") in str(caught.value)


def test_modes_normalised_otherwise_are_scaled_by_the_root_of_the_masses():
    """The simulation's mass over that of the FE run, 1 where that states none; a mode that is not listed stays."""
    results = fe(mass=(4.0, np.nan, 0.0))
    table = {1: (1.0, 9.0), 2: (5.0, 2.25), 4: (1.0, 1.0)}
    own, simulated = mode_masses(results, table)
    assert own.tolist() == [4.0, 1.0, 1.0]
    np.testing.assert_array_equal(simulated, [9.0, 2.25, np.nan])
    assert mode_scale(results, table).tolist() == [1.5, 1.5, 1.0]
    (warning,) = assumed_masses(results, table)
    assert warning.what.startswith("the file states no generalised masses of the modes 2;")
    assert assumed_masses(fe(mass=(4.0, 1.0, 1.0)), table) == []


@pytest.mark.parametrize(("normalisation", "expected"), [("mass", 1000.0 * 1e-3**0.5), ("length", 1000.0)])
def test_coordinates_of_static_modes_are_plain_numbers(normalisation, expected):
    """A mode of vibration has the unit of its normalisation, a load case none."""
    units = SYSTEMS["m-kg-s"]
    found = coordinate_units(fe(static_modes=(2,)), units, normalisation)
    assert found == pytest.approx([expected, 1.0, expected], rel=1e-12)
    assert coordinate_units(fe(analysis="static"), units, normalisation).tolist() == [1.0, 1.0, 1.0]
