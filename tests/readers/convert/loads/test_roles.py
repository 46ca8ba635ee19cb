"""Which static subcases are modes of the basis, and which are loads."""

from dataclasses import replace

import pytest

from fatigue.errors import CaseError, DataError
from fatigue.readers.convert.inputs import read_inputs
from fatigue.readers.convert.loads.names import LoadName
from fatigue.readers.foreign.fe.static_case import APART
from tests.readers.static_files import MODES, both_in_one, history, static_files


def roles(options):
    """Modes of the basis, interface modes, and names of the loads."""
    read = read_inputs(options)
    assert set(read.results.unit_loads.values()) == {load.name for load in read.unit_loads}
    return (
        read.results.mode[read.results.of_basis].tolist(),
        list(read.interface_modes),
        [load.name for load in read.unit_loads],
    )


LOADS = ["tunnel_pressure", "coupler_draft", "load_1_g_vertical"]


def test_subcases_without_coordinates_are_loads(tmp_path):
    """Their numbers may be those of modes; the same from a file of their own and from the file of the modes."""
    options = static_files(tmp_path)
    assert roles(options) == ([1, 2, 3, 4, 5], [5], LOADS)
    one = replace(options, unit_loads=(), forces=both_in_one(tmp_path))
    assert roles(one) == ([1, 2, 3, 4, 5], [5], LOADS)
    assert read_inputs(one).results.mode[5:].tolist() == [APART, APART + 1, APART + 2]


def test_subcases_with_coordinates_are_interface_modes(tmp_path):
    """A column of their number in any event makes them modes, the others stay loads."""
    options = static_files(tmp_path, (21, 22, 23), (*MODES, "q_21", "q_23"))
    assert roles(options) == ([1, 2, 3, 4, 5, 21, 23], [5, 21, 23], ["coupler_draft"])
    one = replace(options, unit_loads=(), forces=both_in_one(tmp_path, (21, 22, 23)))
    assert roles(one) == ([1, 2, 3, 4, 5, 21, 23], [5, 21, 23], ["coupler_draft"])


def test_columns_in_order(tmp_path):
    """As many columns as modes and subcases: all are modes; as many as modes: the subcases are loads."""
    names = [f"amplitude {k}" for k in "abcdefgh"]
    options = replace(static_files(tmp_path, (21, 22, 23), names), match="order")
    assert roles(options) == ([1, 2, 3, 4, 5, 21, 22, 23], [5, 21, 22, 23], [])
    history(tmp_path / "straight.csv", names[:5])
    assert roles(options)[2] == LOADS


def test_what_the_user_says_wins(tmp_path):
    """All modes, all loads, or left out; named ones are what they are named as."""
    options = static_files(tmp_path, (21, 22, 23), (*MODES, "q_21"))
    modes = [1, 2, 3, 4, 5]
    assert roles(replace(options, static_subcases="interface_modes"))[0] == [*modes, 21, 22, 23]
    assert roles(replace(options, static_subcases="unit_loads"))[2] == LOADS
    assert roles(replace(options, static_subcases="leave_out")) == (modes, [5], [])
    assert roles(replace(options, interface_modes=(5, 22)))[1:] == ([5, 21, 22], ["load_1_g_vertical"])
    pressure = (LoadName(21, "p", 5.0, "kPa"),)
    assert roles(replace(options, unit_load_names=pressure))[2] == ["p", "coupler_draft", "load_1_g_vertical"]
    only = replace(options, unit_load_names=pressure, static_subcases="leave_out")
    assert roles(only) == (modes, [5], ["p"])
    assert roles(replace(only, unit_loads=(), forces=both_in_one(tmp_path, (21, 22, 23)))) == (modes, [5], ["p"])
    with pytest.raises(CaseError, match="--unit-load-name 21: --interface-modes makes the subcase a mode"):
        roles(replace(options, unit_load_names=pressure, interface_modes=(21,)))


def test_a_subcase_with_the_number_of_a_mode_cannot_be_one(tmp_path):
    """Its coordinate would be that of the mode."""
    with pytest.raises(DataError, match=r"static.op2: subcase 1 has the number of a mode and is to be an interface"):
        roles(replace(static_files(tmp_path), static_subcases="interface_modes"))


def test_a_run_of_static_subcases_alone(tmp_path):
    """They are its modes, unless the user says otherwise; a body has one mode at least."""
    options = static_files(tmp_path, (21, 22, 23), ("q_21", "q_22", "q_23"))
    alone = replace(options, forces=tmp_path / "static.op2", unit_loads=(), interface_modes=())
    assert roles(alone) == ([21, 22, 23], [21, 22, 23], [])
    assert roles(replace(alone, coordinates=())) == ([21, 22, 23], [21, 22, 23], [])
    history(tmp_path / "straight.csv", ("q_21", "u_coupler_draft"))
    assert roles(alone) == ([21], [21], ["coupler_draft", "load_1_g_vertical"])


def test_modes_to_ignore(tmp_path):
    """A subcase that no mode has the number of is left out by it; numbers of modes mean modes."""
    options = static_files(tmp_path, (3, 22, 23))
    assert roles(replace(options, ignore_modes=(3, 22))) == ([1, 2, 4, 5], [5], [LOADS[0], LOADS[2]])


def test_a_subcase_nobody_asked_for_that_cannot_stand_beside_the_modes(tmp_path):
    """Other elements than the modes, or given twice: it is left out and told, and the conversion goes on."""
    from tests.readers.op2_writer import Op2Writer, modal_tables  # noqa: PLC0415
    from tests.readers.static_files import static_tables  # noqa: PLC0415
    from tests.readers.tee_model import tee  # noqa: PLC0415
    from tests.readers.unit_loads import unit_loads  # noqa: PLC0415

    writer = static_tables(modal_tables(Op2Writer(8), tee().results), (1, 2, 3))
    head = writer.identification(1, 19, 0, 10, subcase=9)
    writer.table("OGPFB1", [head, writer.forces(unit_loads()[0].rows[40:])])
    (tmp_path / "both.op2").write_bytes(writer.close())
    options = replace(static_files(tmp_path), unit_loads=(), forces=tmp_path / "both.op2")
    assert roles(options)[2] == LOADS
    (told,) = [w for w in read_inputs(options).results.warnings if w.code == "static_left_out"]
    assert "1 static subcases cannot stand beside the modes and are left out; subcase 9: its 440 element" in told.what
