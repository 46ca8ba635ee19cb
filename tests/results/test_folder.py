"""Whose files are in a result folder, and how a finished result gets there."""

import contextlib
import json
import shutil
from pathlib import Path

import pandas as pd
import pytest

from fatigue.assess import assess
from fatigue.case import load_case
from fatigue.errors import DataError
from fatigue.report.files.export import write_csv
from fatigue.report.files.vtp import write_vtp
from fatigue.results import JOURNAL, read_provenance, strangers
from fatigue.results.folder import refuse_foreign, remember_case, result_log, stale_files
from fatigue.results.lock import settle_folder
from fatigue.results.publish import publish
from tests.small_case import sine_only


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


# ---------------------------------------------------------------------------------- one folder, one result


@pytest.fixture(scope="module")
def two_results(tmp_path_factory):
    """An old result with documents, and a finished one of the edited case that is to take its place."""
    folder = tmp_path_factory.mktemp("two")
    case = sine_only()
    path = case.write(folder / "case")
    assess(load_case(path), folder / "old", report=False)
    for write in (write_vtp, write_csv):
        write(folder / "old")
    case.mission["target_km"] = 2e6
    assess(load_case(case.write(folder / "case")), folder / "new", report=False)
    (folder / "new" / "fatigue.log").unlink()
    return folder / "old", folder / "new"


class Killed(BaseException):
    """Stands for the end of the process."""


def killed_after(steps, monkeypatch):
    """Let so many files be moved or removed, and then kill."""
    left = [steps]

    def counted(function):
        def step(*args, **kwargs):
            if left[0] == 0:
                raise Killed
            left[0] -= 1
            return function(*args, **kwargs)

        return step

    for name in ("replace", "unlink"):
        monkeypatch.setattr(Path, name, counted(getattr(Path, name)))
    return left


@pytest.mark.parametrize("steps", range(17))
def test_killed_while_it_is_put_in_place(two_results, tmp_path, monkeypatch, steps):
    """At whatever file: the next command finds the old result whole or the new one whole, and nothing between."""
    old, new = two_results
    shutil.copytree(old, tmp_path / "result")
    shutil.copytree(new, tmp_path / "result" / ".fatigue-staging")
    folder, finished = tmp_path / "result", tmp_path / "result" / ".fatigue-staging"
    (folder / "notes.txt").write_text("mine")
    with monkeypatch.context() as patch:
        left = killed_after(steps, patch)
        with contextlib.suppress(Killed):
            publish(finished, folder, stale_files(folder))
    before, after = (read_provenance(result)["result"] for result in two_results)
    if (folder / "provenance.json").exists():  # what a reader sees who does not know of journals
        assert read_provenance(folder)["result"] in (before, after)
    settle_folder(folder)
    record = read_provenance(folder)
    assert record["result"] == (before if steps == 0 else after)
    assert not strangers(folder, record)
    assert (folder / "nodes.csv").exists() == (steps == 0)
    assert (folder / "notes.txt").read_text() == "mine"
    assert not (folder / JOURNAL).exists()
    if steps == 16:
        assert left[0] > 0  # the whole way was killed at every step


def test_a_cut_off_publication_is_told(two_results, tmp_path, monkeypatch):
    """Whoever reads the folder in between learns what happened and what completes it."""
    shutil.copytree(two_results[0], tmp_path / "result")
    shutil.copytree(two_results[1], tmp_path / "result" / ".fatigue-staging")
    with monkeypatch.context() as patch, pytest.raises(Killed):
        killed_after(6, patch)
        publish(tmp_path / "result" / ".fatigue-staging", tmp_path / "result")
    with pytest.raises(DataError, match="was being put in place when the program was stopped"):
        read_provenance(tmp_path / "result")


def test_a_file_in_use_is_named_and_the_result_stays(two_results, tmp_path, monkeypatch):
    """As on Windows, where what is open cannot be removed: the old result stays; later the new one comes."""
    folder, finished = tmp_path / "result", tmp_path / "new"
    shutil.copytree(two_results[0], folder)
    shutil.copytree(two_results[1], finished)
    unlink = Path.unlink

    def open_elsewhere(path, **options):
        if path.name == "nodes.csv":
            raise PermissionError(13, "The process cannot access the file", str(path))
        unlink(path, **options)

    with monkeypatch.context() as patch:
        patch.setattr(Path, "unlink", open_elsewhere)
        with pytest.raises(DataError, match=r"nodes\.csv: cannot be replaced .* Close the program that has it open"):
            publish(finished, folder, stale_files(folder))
    assert read_provenance(folder) == read_provenance(two_results[0])
    settle_folder(folder)
    assert read_provenance(folder) == read_provenance(two_results[1])
    assert not (folder / "nodes.csv").exists()


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
