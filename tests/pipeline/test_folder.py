"""Whose files are in a result folder, and how a finished result gets there."""

import json

import pytest

from fatigue.errors import DataError
from fatigue.pipeline.folder import publish, refuse_foreign, result_log


def test_an_empty_or_new_folder_is_free(tmp_path):
    """Nothing there, nothing to refuse; other people's other files do not matter."""
    refuse_foreign(tmp_path / "new", force=False)
    (tmp_path / "notes.txt").write_text("mine")
    refuse_foreign(tmp_path, force=False)


def test_a_file_is_no_folder(tmp_path):
    """-o names a file, even with --force."""
    (tmp_path / "x").write_text("")
    with pytest.raises(DataError, match="is a file, not a folder"):
        refuse_foreign(tmp_path / "x", force=True)


@pytest.mark.parametrize("name", ["nodes.parquet", "report.html", "fatigue.log", "provenance.json", "weld_lines.vtp"])
def test_foreign_files_of_our_names_are_refused(tmp_path, name):
    """Unless the folder holds a result of ours, or --force is given."""
    (tmp_path / name).write_text("{}")
    with pytest.raises(DataError, match=name):
        refuse_foreign(tmp_path, force=False)
    refuse_foreign(tmp_path, force=True)
    (tmp_path / "provenance.json").write_text(json.dumps({"program": "fatigue"}))
    refuse_foreign(tmp_path, force=False)


def test_publish_moves_provenance_last(tmp_path):
    """A folder never looks finished before it is."""
    finished, folder = tmp_path / "finished", tmp_path / "folder"
    finished.mkdir()
    folder.mkdir()
    for name in ("provenance.json", "nodes.parquet", "welds.parquet"):
        (finished / name).write_text(name)
    (folder / "provenance.json").write_text("old")
    publish(finished, folder)
    assert sorted(p.name for p in folder.iterdir()) == ["nodes.parquet", "provenance.json", "welds.parquet"]
    assert (folder / "provenance.json").read_text() == "provenance.json"
    assert not list(finished.iterdir())


def test_log_is_appended_and_closed(tmp_path):
    """Two runs, one file; nothing is logged after the run."""
    import logging  # noqa: PLC0415

    for text in ("first", "second"):
        with result_log(tmp_path):
            logging.getLogger("fatigue.somewhere").info(text)
    logging.getLogger("fatigue.somewhere").error("after")
    written = (tmp_path / "fatigue.log").read_text()
    assert "INFO first" in written
    assert "INFO second" in written
    assert "after" not in written
