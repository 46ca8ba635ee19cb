"""Unit loads in a file of their own, joined to the modes of another."""

from dataclasses import replace

import numpy as np
import pytest

from fatigue.errors import DataError
from fatigue.readers.convert.audit.audit import audit
from fatigue.readers.convert.inputs import read_inputs
from fatigue.readers.convert.options import ConvertOptions
from fatigue.readers.convert.unit_loads import with_unit_loads
from fatigue.readers.foreign.nastran.deck.bdf import read_bdf
from tests.readers.convert.audit.test_audit import only
from tests.readers.op2_writer import modal_op2
from tests.readers.tee_model import bulk, tee
from tests.readers.unit_loads import SUBCASES, unit_load_op2


def static_cases(sign=1.0):
    """Two of the joint's shapes taken for static subcases 21 and 22, with a load row of their own."""
    results = tee().results
    force = np.concatenate([sign * results.force[:2], np.ones((2, 1, 6))], axis=1)
    return replace(
        results,
        source="loads",
        analysis="static",
        mode=np.array([21, 22]),
        frequency=np.full(2, np.nan),
        modal_mass=np.full(2, np.nan),
        node=np.append(results.node, 7),
        element=np.append(results.element, 0),
        kind=np.append(results.kind, "APP-LOAD"),
        force=force,
        shape=results.shape[:2],
    )


def test_joined_modes_keep_their_forces_and_shapes():
    """Element rows agree; the load row belongs to the static cases only."""
    loads = static_cases()
    joined = with_unit_loads(tee().results, loads)
    assert joined.mode.tolist() == [1, 2, 3, 4, 5, 21, 22]
    assert joined.static_modes == (21, 22)
    assert joined.analysis == "modal"
    for part, rows in ((tee().results, slice(0, 5)), (loads, slice(5, 7))):
        for node, element in ((1, 1), (40, 33)):
            own = (part.node == node) & (part.element == element)
            at = (joined.node == node) & (joined.element == element)
            assert np.array_equal(joined.force[rows, at], part.force[:, own])
    at = joined.kind == "APP-LOAD"
    assert np.isnan(joined.force[:5, at]).all()
    assert (joined.force[5:, at] == 1).all()
    assert np.array_equal(joined.shape[5:], loads.shape)


def test_shapes_that_one_file_lacks_are_not_invented():
    """Then no mode has a shape."""
    bare = replace(static_cases(), shape_node=np.empty(0, np.int64), shape=np.empty((2, 0, 6)))
    joined = with_unit_loads(tee().results, bare)
    assert joined.shape.shape == (7, 0, 6)


def test_files_of_opposite_signs_prove_nothing(tmp_path):
    """Modes of one solver and unit loads of another."""
    path = tmp_path / "tee.bdf"
    path.write_text(bulk(tee()))
    model = read_bdf(path)
    assert audit(with_unit_loads(tee().results, static_cases()), model).convention == "on_node"
    found = audit(with_unit_loads(tee().results, static_cases(-1.0)), model)
    assert found.convention is None
    assert "the forces of mode 21 have the other sign" in next(r for r in found.rows if r.check == "sign").finding


def test_what_does_not_belong_together_is_refused():
    """Modes for unit loads, other elements."""
    loads = static_cases()
    for second, said in (
        (tee().results, "it holds modes, no static subcases"),
        (only(loads, loads.element != 33), "element rows are not those of"),
    ):
        with pytest.raises(DataError, match=said):
            with_unit_loads(tee().results, second)


def test_unit_loads_of_their_own_file_may_be_named_as_interface_modes(tmp_path):
    """They are there, in the other file; only names that are in neither file are told."""
    (tmp_path / "tee.bdf").write_text(bulk(tee()))
    (tmp_path / "modes.op2").write_bytes(modal_op2(tee().results, 8))
    (tmp_path / "loads.op2").write_bytes(unit_load_op2().close())
    options = ConvertOptions(
        forces=tmp_path / "modes.op2",
        mesh=tmp_path / "tee.bdf",
        out=tmp_path / "body",
        coordinates=(),
        unit_loads=(tmp_path / "loads.op2",),
    )
    as_ever = replace(options, static_subcases="interface_modes")
    absent = "of the interface modes named, 1 have no forces, 99 the first"
    for named, told in (((21, 22, 23), []), ((21, 99), [absent])):
        run = read_inputs(replace(as_ever, interface_modes=named))
        assert [r.what for r in run.results.warnings] == told
        assert sorted(run.interface_modes) == sorted({*named, *SUBCASES})
        assert run.results.mode.tolist() == [1, 2, 3, 4, 5, *SUBCASES]
