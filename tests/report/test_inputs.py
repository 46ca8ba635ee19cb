"""The inputs of a result, found again only where they are what was assessed."""

import pytest

from fatigue.errors import DataError
from fatigue.report.inputs import find_inputs
from fatigue.results import read_provenance
from tests.report.tiny_result import MODES, SAMPLES, STEP, Recipe, write_result


def found(folder, case_path=None):
    """Inputs of the result in a folder."""
    return find_inputs(read_provenance(folder), folder, case_path)


def test_a_record_is_read_as_it_was_assessed(result_folder):
    """All modes in the order of the result, with the step of the file."""
    inputs = found(result_folder)
    history = inputs.history(inputs.case.mission.event[0])
    assert tuple(history.mode) == MODES
    assert history.q.shape == (len(MODES), SAMPLES)
    assert history.step == pytest.approx(STEP)


def test_without_mesh_in_the_case_there_is_none(result_folder):
    """None, and no error."""
    assert found(result_folder).mesh() is None


def test_a_mesh_is_read(tmp_path):
    """Nodes and elements of the case."""
    mesh = found(write_result(tmp_path, Recipe(mesh=True))).mesh()
    assert (len(mesh.node), len(mesh.element)) == (6, 2)


def test_a_damaged_record_of_the_case_is_refused(result_folder):
    """A provenance whose case text is no case says so."""
    record = {**read_provenance(result_folder), "case_text": "title = "}
    with pytest.raises(DataError, match=r"provenance\.json: holds no valid case"):
        find_inputs(record, result_folder, None)


def test_a_case_that_is_not_readable_counts_as_missing(tmp_path):
    """A folder or binary file in its place is not the case."""
    folder = write_result(tmp_path)
    (tmp_path / "case.toml").write_bytes(b"\xff\xfe")
    inputs = found(folder)
    assert inputs.root is None
    with pytest.raises(DataError, match="not where it was"):
        inputs.history(inputs.case.mission.event[0])
    assert found(folder, tmp_path).root is None
