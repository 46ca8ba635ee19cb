"""Foreign files on the command line: convert, assess, and the weld lines of a mesh."""

import json
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from tests.readers.op2_writer import modal_op2
from tests.readers.test_audit import static_results
from tests.test_cli import assess, fatigue

NASTRAN = Path(__file__).parents[1] / "data" / "nastran"
WING = "wingbox_stitched_together-000"


@pytest.fixture(scope="module")
def converted(tmp_path_factory):
    """The wing box, converted, with a history for its one static subcase."""
    folder = tmp_path_factory.mktemp("wing")
    t = np.arange(400) * 0.01
    pd.DataFrame({"time": t, "q1": np.sin(2 * np.pi * 2 * t)}).to_csv(folder / "q.csv", index=False)
    done = fatigue(
        "convert", "--mesh", NASTRAN / f"{WING}.bdf", "--forces", NASTRAN / f"{WING}.op2",
        "--coordinates", folder / "q.csv", "-o", folder / "body",
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return folder, done.stdout


def test_convert_prints_its_audit_and_what_it_wrote(converted):
    """One line per check with its light and number, then where to go on."""
    _, said = converted
    assert "green  element balance: 7.18e-07" in said
    assert "forces on_node" in said
    assert "24 of 30 weld lines assessed" in said
    assert "edit case.toml and welds_register.csv" in said


def test_a_converted_folder_can_be_assessed_and_keeps_its_audit(converted):
    """The audit of the conversion and the lines left out are in the result."""
    folder, _ = converted
    done = assess(folder / "body" / "case.toml", "-o", folder / "result", "--exit-zero")
    assert done.returncode == 0, done.stderr
    record = json.loads((folder / "result" / "provenance.json").read_text())
    assert record["conversion"]["convention"] == "on_node"
    assert "193 CBUSH (line 6849)" in " ".join(record["conversion"]["remarks"])
    assert {row["light"] for row in record["conversion"]["audit"]} == {"green"}
    welds = pd.read_parquet(folder / "result" / "welds.parquet")
    assert welds.status.value_counts().to_dict() == {"assessed": 24, "excluded": 6}
    assert welds[welds.status == "excluded"].reason.ne("").all()


def test_a_damaged_record_of_a_conversion_is_named(converted, tmp_path):
    """convert.json cut short: which file, and what to do."""
    folder, _ = converted
    shutil.copytree(folder / "body", tmp_path / "body")
    record = tmp_path / "body" / "convert.json"
    record.write_text(record.read_text()[:100])
    done = assess(tmp_path / "body" / "case.toml", "-o", tmp_path / "result")
    assert done.returncode == 3
    assert "convert.json: is no record of a conversion" in done.stderr


def test_convert_does_not_overwrite_what_it_did_not_write(converted, tmp_path):
    """A foreign file of the same name is refused; the folder stays as it was."""
    (tmp_path / "modes.csv").write_text("mine")
    done = fatigue(
        "convert", "--mesh", NASTRAN / f"{WING}.bdf", "--forces", NASTRAN / f"{WING}.op2", "-o", tmp_path
    )  # fmt: skip
    assert done.returncode == 3
    assert "modes.csv: the file exists and is not the work of an earlier conversion" in done.stderr
    assert [p.name for p in tmp_path.iterdir()] == ["modes.csv"]


def test_convert_refuses_a_truncated_op2(tmp_path):
    """Cut in the middle: file, place, remedy; nothing written."""
    whole = (NASTRAN / "modes_elements.op2").read_bytes()
    (tmp_path / "cut.op2").write_bytes(whole[: len(whole) // 2])
    done = fatigue(
        "convert", "--mesh", NASTRAN / "modes_elements.bdf", "--forces", tmp_path / "cut.op2", "-o", tmp_path / "out"
    )  # fmt: skip
    assert done.returncode == 3
    assert "cut.op2" in done.stderr
    assert "Traceback" not in done.stderr
    assert not (tmp_path / "out").exists()


def test_convert_as_json_and_where_it_cannot_write(tmp_path):
    """Machines get the audit as records; a folder that cannot be made is named."""
    common = ("convert", "--mesh", NASTRAN / f"{WING}.bdf", "--forces", NASTRAN / f"{WING}.op2", "--json")
    record = json.loads(fatigue(*common, "-o", tmp_path / "out").stdout)
    assert record["folder"] == str(tmp_path / "out")
    assert (record["welds_assessed"], record["welds_listed"]) == (24, 30)
    assert record["audit"][0]["light"] == "green"
    (tmp_path / "file").write_text("")
    done = fatigue(*common, "-o", tmp_path / "file" / "out")
    assert done.returncode == 3
    assert str(tmp_path / "file") in done.stderr


def test_welds_lists_writes_and_pictures_the_lines(tmp_path):
    """The eight T lines of the wing box, from all three sides; register and picture are written once."""
    register, picture = tmp_path / "register.csv", tmp_path / "lines.vtp"
    arguments = ("welds", NASTRAN / f"{WING}.bdf", "-o", register, "--vtp", picture)
    done = fatigue(*arguments)
    assert done.returncode == 0, done.stderr
    assert sum(line.startswith("assess") and " 33 nodes" in line for line in done.stdout.splitlines()) == 24
    assert 'NumberOfPoints="' in picture.read_text()
    assert len(pd.read_csv(register)) == 30
    again = fatigue(*arguments)
    assert again.returncode == 3
    assert "the file exists" in again.stderr
    listed = json.loads(fatigue("welds", NASTRAN / f"{WING}.bdf", "--only", "p3a", "--json").stdout)
    assert {row["nodes"] for row in listed} == {33}


@pytest.mark.parametrize(("sign", "convention"), [(1, "on_element"), (-1, "on_node")])
def test_the_tension_patch_tells_the_sign_of_a_solver(tmp_path, sign, convention):
    """The deck is written once; the solver's forces of it answer with the line for the case."""
    deck = tmp_path / "patch.bdf"
    assert fatigue("tension-patch", deck).returncode == 0
    assert "CQUAD4,1,1,1,2,3,4" in deck.read_text()
    assert "is there already" in fatigue("tension-patch", deck).stderr
    solved = replace(static_results(sign), frequency=np.array([1.0]), modal_mass=np.array([1.0]))
    (tmp_path / "patch.op2").write_bytes(modal_op2(solved))
    done = fatigue("tension-patch", tmp_path / "patch.op2", "--results")
    assert done.stdout == f'force_convention = "{convention}"\n'
