"""Tables that are added to a finished result: all of them with what is said of them, or none."""

import shutil

import pytest

from fatigue.errors import DataError
from fatigue.results import ASSESSED, SHIFTED, adding, finished_result, read_provenance, refuse_mixed
from fatigue.results.provenance import is_same_result


@pytest.fixture
def folder(two_results, tmp_path):
    """A copy of a finished result."""
    return shutil.copytree(two_results[0], tmp_path / "result")


def test_added_tables_are_of_the_result(folder):
    """They carry its hash and join its record, and it stays the same result."""
    before = finished_result(folder, ASSESSED, ("nodes",), no_lock=False)
    with adding(folder, before, SHIFTED, no_lock=False) as addition:
        with addition.table("shift"):
            pass
        addition.publish({"shift_study": "said"})
    after = read_provenance(folder)
    assert (after["shift_study"], is_same_result(before, after)) == ("said", True)
    refuse_mixed(folder, after, SHIFTED)
    assert not [path.name for path in folder.iterdir() if path.name.startswith(".")]


def test_what_fails_before_it_is_published_leaves_the_result_as_it_was(folder):
    """Neither a table nor the folder that it waited in stays."""
    before = finished_result(folder, ASSESSED, (), no_lock=False)
    files = {path.name for path in folder.iterdir()}
    with (
        pytest.raises(MemoryError),
        adding(folder, before, SHIFTED, no_lock=False) as addition,
        addition.table("shift"),
    ):
        raise MemoryError
    assert read_provenance(folder) == before
    assert {path.name for path in folder.iterdir()} == files


def test_a_result_replaced_meanwhile_gets_no_tables(two_results, folder):
    """The folder has to hold the result that was read before it was locked."""
    another = read_provenance(two_results[1])
    with pytest.raises(DataError, match="replaced by another run"), adding(folder, another, SHIFTED, no_lock=False):
        pytest.fail("was held")
