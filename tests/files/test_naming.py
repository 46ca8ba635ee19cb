"""Files and names that are not found as they are written."""

import subprocess
import sys
import unicodedata
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from fatigue.files.naming import composed, missing_file
from fatigue.readers.neutral.tables import open_table

DECOMPOSED = unicodedata.normalize("NFD", "Träger")


@pytest.fixture
def folder(tmp_path) -> Path:
    """A folder with some files to be missed."""
    (tmp_path / "sub").mkdir()
    for name in ("modes.csv", "sub/Modes.CSV", f"{DECOMPOSED}.csv"):
        (tmp_path / name).touch()
    (tmp_path / "link.csv").symlink_to("gone.csv")
    return tmp_path


@pytest.mark.parametrize(
    ("name", "message"),
    [
        (r"sub\Modes.CSV", r"there is no file {}. Write 'sub/Modes.CSV'."),
        (r"SUB\modes.csv", r"there is no file {}. Write 'sub/Modes.CSV'."),
        ("Sub/modes.csv", "there is no file {}. Write 'sub/Modes.CSV'."),
        ("modes.csv ", "there is no file {}. Write 'modes.csv'."),
        ("mode.csv", "there is no file {}. Correct the path; 'modes.csv' is there."),
        ("zzz.parquet", "there is no file {}. Correct the path."),
        (
            r"C:\data\modes.csv",
            "there is no file {}, a path of Windows. Give a path of this computer; 'modes.csv' is there.",
        ),
        ("D:/q.parquet", "there is no file {}, a path of Windows. Give a path of this computer."),
        ("C:\temp.csv", "a path with a tab (\\t) in it. Write / between folders, or put the path into single quotes."),
        ("https://host/q.csv", "an address. Give a path of this computer."),
        ("link.csv", "there is no file {}: it is a link to gone.csv, which is gone. Give the file itself."),
        ("none/q.csv", "nor a folder {0.parent}. Correct the path."),
        ("sub", "this is a folder with Modes.CSV. Give a .parquet or .csv file."),
    ],
)
def test_what_is_there_instead(folder, name, message):
    """The remedy names the file that was meant, spelt as the place that names it would."""
    path = folder / name
    problem = str(missing_file(path, "case.toml: body.modes", base=folder))
    assert problem.startswith("case.toml: body.modes: ")
    assert problem.endswith(message.format(path))


def test_accents_of_a_file_name(folder):
    """The file whose name differs only in how its accents are stored is named."""
    problem = missing_file(folder / "Träger.csv", "case.toml: body.modes", base=folder)
    assert problem.remedy.startswith(f"Rename '{DECOMPOSED}.csv': its accents are separate characters")


def test_a_home_folder_that_is_not_written_out(folder, monkeypatch):
    """A tilde means nothing in a case."""
    monkeypatch.setenv("HOME", str(folder))
    problem = missing_file(folder / "~/sub/Modes.CSV", "case.toml: body.modes", base=folder)
    assert problem.remedy == "Write 'sub/Modes.CSV'"


@pytest.mark.parametrize(
    ("files", "what", "remedy"),
    [
        (
            ["_SUCCESS", "part-0.parquet", "part-1.parquet", ".part-0.parquet.crc"],
            "a folder of 2 Parquet parts",
            "Join them",
        ),
        (["year=1/part-0.parquet"], "a folder of 1 Parquet part,", "Join them"),
        (["_SUCCESS"], "a folder of 0 Parquet parts", "Write the table again, into one file"),
        ([], "this is a folder", "Give a .parquet or .csv file"),
        (["a.txt", "b.txt", "c.txt", "d.txt"], "a folder with a.txt, b.txt, c.txt ...", "Give a .parquet or .csv file"),
    ],
)
def test_folders_of_parts(tmp_path, files, what, remedy):
    """What Spark and Dask write is no file, and is not taken for one."""
    path = tmp_path / "q.parquet"
    path.mkdir()
    for name in files:
        (path / name).parent.mkdir(exist_ok=True)
        (path / name).touch()
    problem = missing_file(path)
    assert what in problem.what
    assert problem.remedy.startswith(remedy)


def test_the_command_that_joins_parts_works(tmp_path):
    """The command in the message, run as it stands, gives one table."""
    folder = tmp_path / "q.parquet"
    folder.mkdir()
    for part in (0, 1):
        pq.write_table(pa.table({"mode": [2 * part, 2 * part + 1]}), folder / f"part-{part}.parquet")
    code = missing_file(folder).remedy.split('"')[1]
    subprocess.run([sys.executable, "-c", code], check=True)
    assert open_table(tmp_path / "q.parquet-joined.parquet").integers("mode").tolist() == [0, 1, 2, 3]


def test_names_are_composed():
    """Letter and accent are one character, blanks around a name are none of it."""
    assert composed(f" {DECOMPOSED} ") == "Träger"


def test_a_weld_has_one_name_in_either_spelling(tmp_path):
    """Two spellings of a name are one weld; of a column, one column."""
    path = tmp_path / "t.csv"
    path.write_text(f"weld,Höhe\n{DECOMPOSED},1\nTräger,2\n", encoding="utf-8")
    table = open_table(path, texts=("weld",))
    assert table.groups("weld")[0] == ("Träger",)
    path.write_text(unicodedata.normalize("NFD", "Höhe\n1\n"), encoding="utf-8")
    assert open_table(path).numbers("Höhe").tolist() == [1.0]
