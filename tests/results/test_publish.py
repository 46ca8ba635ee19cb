"""How a finished result gets into its folder: all of it or nothing, wherever the process ends."""

import contextlib
import shutil
from pathlib import Path

import pytest

from fatigue.errors import DataError
from fatigue.results import JOURNAL, read_provenance, strangers
from fatigue.results.folder import stale_files
from fatigue.results.lock import settle_folder
from fatigue.results.publish import publish


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


@pytest.mark.parametrize("steps", range(28))
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
    if steps == 27:
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


def test_a_folder_in_the_way_is_named_before_anything_is_moved(two_results, tmp_path):
    """The old result stays whole and can be read; without the folder the new one comes."""
    folder, finished = tmp_path / "result", tmp_path / "new"
    shutil.copytree(two_results[0], folder)
    shutil.copytree(two_results[1], finished)
    (folder / "nodes.csv").unlink()
    (folder / "nodes.csv").mkdir()
    with pytest.raises(DataError, match=r"nodes\.csv: is a folder where a file of the result has its place"):
        publish(finished, folder, stale_files(folder))
    assert read_provenance(folder) == read_provenance(two_results[0])
    assert not (folder / JOURNAL).exists()
    (folder / "nodes.csv").rmdir()
    publish(finished, folder, stale_files(folder))
    assert read_provenance(folder) == read_provenance(two_results[1])


def test_a_damaged_journal_is_told(two_results, tmp_path):
    """One line instead of a guess."""
    shutil.copytree(two_results[0], tmp_path / "result")
    for text in ("{", "[]", '{"from": 3, "remove": []}', "null"):
        (tmp_path / "result" / JOURNAL).write_text(text)
        with pytest.raises(DataError, match=r"says what was being put in place .* cannot be read"):
            settle_folder(tmp_path / "result")


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
