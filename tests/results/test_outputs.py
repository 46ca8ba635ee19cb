"""Hashes of outputs: what is recorded, what is found, and results without them."""

import json
import shutil
import subprocess

import pandas as pd
import pytest

from fatigue.errors import DataError
from fatigue.report.files.export import write_csv
from fatigue.results import read_provenance, read_table, refuse_mixed, write_provenance
from fatigue.results.outputs import altered, damage_told, recorded
from fatigue.results.provenance import hashes_on_record, is_same_result
from fatigue.results.summary import result_summary
from tests.older_result import without_hashes


@pytest.fixture
def folder(two_results, tmp_path):
    """A copy of a result with a picture and CSV files."""
    return shutil.copytree(two_results[0], tmp_path / "result")


def test_every_output_is_on_record_and_sha256sum_agrees(folder):
    """All files but the log and the two that hold the hashes; the same by a program of somebody else."""
    record = read_provenance(folder)
    there = {path.name for path in folder.iterdir()}
    assert set(hashes_on_record(record)) == there - {"fatigue.log", "provenance.json", "provenance.json.sha256"}
    command = ["sha256sum", "-c", "provenance.json.sha256"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=True)
    assert done.stdout.count(": OK") == len(hashes_on_record(record)) + 1


def test_a_document_written_later_joins_the_record(folder):
    """Its hash is new, all else of the record stays."""
    before = read_provenance(folder)
    with (folder / "nodes.csv").open("a") as file:
        file.write("mine")
    assert "was changed since it was written: it has" in altered(folder, before, ["nodes.csv"])["nodes.csv"]
    write_csv(folder)
    after = read_provenance(folder)
    assert altered(folder, after, hashes_on_record(after)) == {}
    assert is_same_result(before, after)
    later = ("diagnosis", "load_spectra", "ride", "shift_study")
    assert is_same_result(before, {**after, **dict.fromkeys(later, "said")})
    assert recorded(after, []) == after


def test_size_is_looked_at_before_content(folder, monkeypatch):
    """A file that lost its end is not read."""
    path = folder / "nodes.parquet"
    path.write_bytes(path.read_bytes()[:-1])
    monkeypatch.setattr("fatigue.results.outputs.sha256", lambda _: pytest.fail("was read"))
    assert "bytes, provenance.json has" in altered(folder, read_provenance(folder), ["nodes.parquet"])["nodes.parquet"]


def test_only_what_is_read_is_compared(folder):
    """``show`` reads points and welds: a damaged table of cycles does not stop it."""
    path = folder / "cycles.parquet"
    path.write_bytes(bytes(path.stat().st_size))
    assert result_summary(folder).welds["weld"].tolist()
    with pytest.raises(DataError, match=r"cycles\.parquet: was changed since it was written: its SHA-256 begins"):
        refuse_mixed(folder, read_provenance(folder))


@pytest.mark.parametrize("text", ["[]", "{", "[" * 100_000, '{"program": "fatigue"}', ""])
def test_a_changed_record_is_refused(folder, text):
    """Whatever its shape: one line with both hashes."""
    (folder / "provenance.json").write_text(text)
    with pytest.raises(DataError, match=r"provenance\.json: was changed or damaged since it was written") as refusal:
        read_provenance(folder)
    assert len(str(refusal.value).splitlines()) == 1
    (folder / "provenance.json.sha256").write_text("what?")
    with pytest.raises(DataError, match=r"sha256: does not tell the SHA-256 of provenance\.json"):
        read_provenance(folder)


def test_a_record_without_its_hash_is_refused(folder):
    """The record lists hashes, so there was one."""
    (folder / "provenance.json.sha256").unlink()
    with pytest.raises(DataError, match=r"provenance\.json\.sha256: is missing"):
        read_provenance(folder)


@pytest.mark.parametrize(
    "change",
    [lambda r: r.pop("rules"), lambda r: r.update(mission=None), lambda r: r.update(title=3, rules={"survival": []})],
)
def test_an_older_result_opens_and_is_warned_of(folder, caplog, change):
    """No hashes on record; where its record makes no sense it is damaged, not a traceback."""
    without_hashes(folder)
    with damage_told(folder):
        assert result_summary(folder).as_text()
    assert "no hashes on record" in caplog.text
    record = json.loads((folder / "provenance.json").read_text())
    change(record)
    (folder / "provenance.json").write_text(json.dumps(record))
    with pytest.raises(DataError, match="holds what does not fit together"), damage_told(folder):
        result_summary(folder).as_text()


def test_a_failure_of_a_sound_result_is_not_called_damage(folder):
    """It is the program's fault, and told as such."""
    with pytest.raises(ZeroDivisionError), damage_told(folder):
        1 / 0  # noqa: B018


def test_a_flipped_bit_changes_no_number(folder):
    """A reader that knows no hashes finds it by the checksum of its page, or it stands where nothing is read."""
    path = folder / "nodes.parquet"
    sound, data = read_table(folder, "nodes"), bytearray(path.read_bytes())
    refused = 0
    for at in range(4, len(data), max(1, len(data) // 150)):
        data[at] ^= 1 << at % 8
        path.write_bytes(data)
        data[at] ^= 1 << at % 8
        try:
            assert read_table(folder, "nodes").equals(sound), at
        except DataError:
            refused += 1
    assert refused > 30


def test_columns_of_another_kind_are_damage(folder):
    """Texts where numbers belong; a table written by somebody else may have whole numbers for others."""
    path = folder / "nodes.parquet"
    frame = pd.read_parquet(path)
    frame.assign(part=frame["part"].astype(float)).to_parquet(path)
    assert read_table(folder, "nodes", ["part"]).num_rows == len(frame)
    frame.assign(life_km="long").to_parquet(path)
    with pytest.raises(DataError, match=r"its column life_km holds .*string, not numbers"):
        read_table(folder, "nodes", ["life_km"])


def test_the_record_may_be_written_anew(folder):
    """As a provenance of another run: the tables beside it are strangers."""
    write_provenance(folder, read_provenance(folder) | {"result": "0" * 32})
    with pytest.raises(DataError, match=r"nodes\.parquet: belongs to the result"):
        result_summary(folder)
