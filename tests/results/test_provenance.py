"""Provenance: inputs with their hashes, versions of the software, and records of somebody else."""

import pytest

from fatigue.errors import DataError
from fatigue.files.hashes import sha256
from fatigue.results.provenance import input_register, read_provenance, software_versions


@pytest.mark.parametrize(
    ("text", "message"),
    [("{", "cannot be read"), ("[]", "was not written by fatigue"), ('{"program": "other"}', "was not written by")],
)
def test_provenance_of_somebody_else(tmp_path, text, message):
    """A provenance.json that is damaged or foreign is not taken for ours."""
    (tmp_path / "provenance.json").write_text(text)
    with pytest.raises(DataError, match=message):
        read_provenance(tmp_path)


def test_inputs_are_named_relative_to_the_case_with_their_hash(tmp_path):
    """Name, size, SHA-256; a file elsewhere keeps its path."""
    (tmp_path / "case").mkdir()
    inside, outside = tmp_path / "case" / "a.csv", tmp_path / "b.csv"
    inside.write_text("x")
    outside.write_text("xy")
    found = input_register([inside, outside], tmp_path / "case")
    assert found[0] == {"file": "a.csv", "bytes": 1, "sha256": sha256(inside)}
    assert found[1]["file"] == outside.as_posix()
    assert sha256(inside) == "2d711642b726b04401627ca9fbac32f5c8530fb1903cc4db02258717921a4881"


def test_versions_of_what_the_numbers_rest_on():
    """Program, Python, and the numerical packages."""
    assert {"fatigue", "python", "numpy", "scipy", "numba", "pyarrow"} <= set(software_versions())
