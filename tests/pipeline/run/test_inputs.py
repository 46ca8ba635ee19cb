"""An input that is replaced while the run goes on is found before the result is put in place."""

import os
import shutil
import time
from functools import partial

import pytest

from fatigue import assess as story
from fatigue.assess import assess
from fatigue.case import load_case
from fatigue.errors import DataError
from fatigue.pipeline.run import inputs as of_run
from fatigue.pipeline.tables import written
from fatigue.results import read_provenance
from tests.small_case import sine_only


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """Files of a case that is small."""
    case = sine_only()
    case.weld_nodes = case.weld_nodes[case.weld_nodes["order"] <= 3]
    case.nodal_forces = case.nodal_forces[case.nodal_forces["node"] % 100 < 3]
    case.histories["sine"] = case.histories["sine"][:600]
    return case.write(tmp_path_factory.mktemp("made") / "case").parent


@pytest.fixture
def case_file(made, tmp_path):
    """A copy of them."""
    return shutil.copytree(made, tmp_path / "case") / "case.toml"


def rewritten(path):
    """Another content of the same size, written in place."""
    content = path.read_bytes()
    head, found, tail = content.rpartition(b"0.0")
    path.write_bytes(head + b"0.1" + tail if found else content.replace(b"s", b"S", 1))


def replaced(path):
    """Another file moved to its place, with the time of the old one."""
    was, other = path.stat(), path.with_suffix(".new")
    shutil.copyfile(path, other)
    rewritten(other)
    os.utime(other, ns=(was.st_atime_ns, was.st_mtime_ns))
    other.replace(path)


def rewritten_with_its_time(path):
    """Another content of the same size in the same file, its time set back."""
    was = path.stat()
    rewritten(path)
    os.utime(path, ns=(was.st_atime_ns, was.st_mtime_ns))


def grown(path):
    """A line more."""
    with path.open("ab") as file:
        file.write(b"\n")


def removed(path):
    """Nothing."""
    path.unlink()


def meanwhile(monkeypatch, do):
    """Do something when all is counted and the tables are written."""
    write = story.write_records

    def write_records(*args):
        time.sleep(0.02)  # the clock of a file system is coarse
        do()
        return write(*args)

    monkeypatch.setattr(story, "write_records", write_records)


FILES = ["case.toml", "modes.csv", "welds.csv", "weld_nodes.csv", "nodal_forces.csv", "sine.csv"]


@pytest.mark.parametrize("name", FILES)
def test_every_input_is_looked_at(case_file, tmp_path, monkeypatch, name):
    """Exit code 3 with the name, nothing published, and what is finished is kept."""
    path = case_file.parent / name
    meanwhile(monkeypatch, lambda: rewritten(path))
    with pytest.raises(DataError, match=rf"{name}: was replaced while the run was going on\. Put the file back"):
        assess(load_case(case_file), tmp_path / "result", threads=1, report=False)
    assert not (tmp_path / "result" / "provenance.json").exists()
    assert list((tmp_path / "result" / ".fatigue-state").rglob("*.npz"))


@pytest.mark.parametrize("change", [replaced, rewritten_with_its_time, grown, removed])
def test_every_way_of_replacing_is_seen(case_file, tmp_path, monkeypatch, change):
    """Moved there, written in place, with the old time and size, or gone."""
    meanwhile(monkeypatch, lambda: change(case_file.parent / "sine.csv"))
    with pytest.raises(DataError, match=r"sine\.csv: was (replaced|taken away) while the run was going on"):
        assess(load_case(case_file), tmp_path / "result", threads=1, report=False)


def test_a_touched_file_and_an_equal_one_pass(case_file, tmp_path, monkeypatch):
    """Another time, another file of the same content: the result is that of the inputs."""

    def touch():
        os.utime(case_file.parent / "sine.csv")
        (case_file.parent / "modes.csv").write_bytes((case_file.parent / "modes.csv").read_bytes())
        shutil.copyfile(case_file, tmp_path / "copy.toml")
        (tmp_path / "copy.toml").replace(case_file)

    meanwhile(monkeypatch, touch)
    assess(load_case(case_file), tmp_path / "result", threads=1, report=False)
    assert read_provenance(tmp_path / "result")["program"] == "fatigue"


def test_only_what_changed_is_hashed_again(case_file, tmp_path, monkeypatch):
    """Of unchanged files the file system is asked, and nothing is read."""
    hashed = []
    monkeypatch.setattr(of_run, "sha256", lambda path: hashed.append(path.name) or "")
    assess(load_case(case_file), tmp_path / "result", threads=1, report=False)
    assert hashed == []


def test_a_link_that_leads_elsewhere_is_seen(case_file, tmp_path, monkeypatch):
    """The file behind the link is looked at; a link to an equal file passes."""
    record = case_file.parent / "sine.csv"
    for name in ("one", "two", "three"):
        shutil.copyfile(record, tmp_path / f"{name}.csv")
    rewritten(tmp_path / "three.csv")
    record.unlink()
    record.symlink_to(tmp_path / "one.csv")

    def lead_to(name):
        record.unlink()
        record.symlink_to(tmp_path / f"{name}.csv")

    with monkeypatch.context() as patch:
        meanwhile(patch, lambda: lead_to("two"))
        assess(load_case(case_file), tmp_path / "result", threads=1, report=False)
    meanwhile(monkeypatch, lambda: lead_to("three"))
    with pytest.raises(DataError, match=r"sine\.csv: was replaced while the run was going on"):
        assess(load_case(case_file), tmp_path / "result", threads=1, report=False)


def test_a_register_that_comes_is_seen(case_file, tmp_path, monkeypatch):
    """The welds of the result would not be those of the case."""
    register = case_file.parent / "welds_register.csv"
    meanwhile(monkeypatch, lambda: register.write_text("weld,status\nA,assess\n"))
    with pytest.raises(DataError, match=r"welds_register\.csv: came while the run was going on"):
        assess(load_case(case_file), tmp_path / "result", threads=1, report=False)


def test_a_failure_of_half_replaced_inputs_names_them(case_file, tmp_path, monkeypatch):
    """Whatever goes wrong with rows of two files: the file is named, not what went wrong."""

    def fail(*_args):
        raise IndexError

    def replace_and_fail(*_args):
        rewritten(case_file.parent / "nodal_forces.csv")
        raise IndexError

    monkeypatch.setattr(written, "write_group", replace_and_fail)
    with pytest.raises(DataError, match=r"nodal_forces\.csv: was replaced while the run was going on"):
        assess(load_case(case_file), tmp_path / "result", threads=1, report=False)
    monkeypatch.setattr(written, "write_group", fail)
    with pytest.raises(IndexError):
        assess(load_case(case_file), tmp_path / "result", threads=1, report=False)


def test_a_case_that_was_edited_after_it_was_read_is_refused(case_file, tmp_path):
    """Its text would stand in the provenance beside the hash of another."""
    case = load_case(case_file)
    grown(case_file)
    with pytest.raises(DataError, match=r"case\.toml: was changed since it was read"):
        assess(case, tmp_path / "result", threads=1, report=False)


def test_inputs_that_change_while_they_are_read_are_read_again(case_file, tmp_path, monkeypatch):
    """Once: the second reading counts; again and again: refused."""
    read, times = story.read_case, []

    def restless(case, threads, *, strict, require_verified, changes):
        found = read(case, threads, strict=strict, require_verified=require_verified)
        times.append(1)
        if len(times) <= changes:
            grown(case_file.parent / "modes.csv")
        return found

    monkeypatch.setattr(story, "read_case", partial(restless, changes=1))
    assess(load_case(case_file), tmp_path / "result", threads=1, report=False)
    assert len(times) == 2
    monkeypatch.setattr(story, "read_case", partial(restless, changes=99))
    with pytest.raises(DataError, match=r"modes\.csv: is being written while it is read"):
        assess(load_case(case_file), tmp_path / "result", threads=1, report=False)


def test_an_input_replaced_between_two_tries_begins_anew(case_file, tmp_path, monkeypatch):
    """What the first try had finished is of the old file; with the old file back it is used."""
    old = (case_file.parent / "sine.csv").read_bytes()
    with monkeypatch.context() as patch:
        meanwhile(patch, lambda: rewritten(case_file.parent / "sine.csv"))
        with pytest.raises(DataError):
            assess(load_case(case_file), tmp_path / "result", threads=1, report=False)
    shutil.copytree(tmp_path / "result", tmp_path / "again")
    assert assess(load_case(case_file), tmp_path / "result", threads=1, report=False).groups_reused == 0
    (case_file.parent / "sine.csv").write_bytes(old)
    assert assess(load_case(case_file), tmp_path / "again", threads=1, report=False).groups_reused == 1
