"""Whose files are in a result folder, and what was done there."""

import json
import shutil

import pandas as pd
import pytest

from fatigue.errors import DataError
from fatigue.results.folder import refuse_foreign, remember_case, result_log, stale_files
from fatigue.results.publish import publish


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


def test_another_case_is_refused_and_the_same_edited_is_not(two_results, tmp_path):
    """By the file, not by its text."""
    old, _ = two_results
    case = old.parent / "case" / "case.toml"
    refuse_foreign(old, force=False, case_file=case)
    other = tmp_path / "case.toml"
    shutil.copy(case, other)
    with pytest.raises(DataError, match=r"the result of another case, .*case\.toml\. Give another folder"):
        refuse_foreign(old, force=False, case_file=other)
    refuse_foreign(old, force=True, case_file=other)


def test_unfinished_work_of_another_case_is_not_thrown_away(tmp_path):
    """Hours of counting of another case are in the folder: refused as well."""
    for name in ("a.toml", "b.toml"):
        (tmp_path / name).write_text(name)
    state = tmp_path / "result" / ".fatigue-state" / "key"
    state.mkdir(parents=True)
    remember_case(tmp_path / "result", tmp_path / "a.toml")
    refuse_foreign(tmp_path / "result", force=False, case_file=tmp_path / "b.toml")  # nothing is lost yet
    (state / "group-00000.npz").write_bytes(b"")
    refuse_foreign(tmp_path / "result", force=False, case_file=tmp_path / "a.toml")
    with pytest.raises(DataError, match=r"holds the unfinished assessment of another case, .*a\.toml"):
        refuse_foreign(tmp_path / "result", force=False, case_file=tmp_path / "b.toml")


@pytest.mark.parametrize("name", ["nodes.xlsx", "nodes.csv", "report.pdf", "report.html", "attribution.parquet"])
def test_a_file_of_the_users_own_at_the_name_of_an_export(two_results, tmp_path, name):
    """Refused without force, and gone with it: no other numbers beside these."""
    old, new = two_results
    folder = tmp_path / "result"
    shutil.copytree(old, folder)
    (folder / name).unlink(missing_ok=True)
    pd.DataFrame({"mine": [1]}).to_parquet(folder / name)
    with pytest.raises(
        DataError, match=f"{name}: is there already and was not written by fatigue, or was changed since"
    ):
        refuse_foreign(folder, force=False)
    refuse_foreign(folder, force=True)
    assert name in stale_files(folder)
    shutil.copytree(new, tmp_path / "new")
    publish(tmp_path / "new", folder, stale_files(folder))
    assert not (folder / name).exists()


def test_inputs_are_never_overwritten(tmp_path):
    """A mesh nodes.parquet of the case, assessed into its own folder: refused with force as well; welds.csv stays."""
    for name in ("nodes.parquet", "welds.csv"):
        (tmp_path / name).write_text("mesh")
    inputs = [tmp_path / "nodes.parquet", tmp_path / "welds.csv"]
    for force in (False, True):
        with pytest.raises(DataError, match=r"nodes\.parquet: is an input of this case"):
            refuse_foreign(tmp_path, force=force, inputs=inputs)
    (tmp_path / "nodes.parquet").unlink()
    refuse_foreign(tmp_path, force=False, inputs=inputs)
    assert stale_files(tmp_path, inputs) == []
