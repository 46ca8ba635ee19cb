"""A folder claimed for an assessment: locked, completed, and refused where an input of the case is in the way."""

import pytest

from fatigue.errors import DataError
from fatigue.results.lock import claimed, locked


@pytest.mark.parametrize("force", [False, True])
def test_an_input_in_the_way_is_refused_whatever_is_forced(tmp_path, force):
    """An input that bears the name of a table is left as it is, and the folder is free again."""
    given = tmp_path / "nodes.parquet"
    given.write_bytes(b"an input")
    case = tmp_path / "case.toml"
    wanted = claimed(tmp_path, force=force, case_file=case, inputs=[given])
    with pytest.raises(DataError, match="is an input of this case"), wanted:
        pass
    assert given.read_bytes() == b"an input"
    with locked(tmp_path):
        pass


def test_what_fatigue_did_not_write_is_refused_unless_forced(tmp_path):
    """And a claimed folder is locked while it is claimed."""
    (tmp_path / "nodes.csv").write_text("mine")
    case = tmp_path / "case.toml"
    refused = claimed(tmp_path, force=False, case_file=case, inputs=[])
    with pytest.raises(DataError, match="was not written by fatigue"), refused:
        pass
    busy = pytest.raises(DataError, match="another run is writing to this folder")
    with claimed(tmp_path, force=True, case_file=case, inputs=[]), busy, locked(tmp_path):
        pass
