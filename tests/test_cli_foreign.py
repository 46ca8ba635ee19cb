"""Foreign files on the command line: convert, assess, and the weld lines of a mesh."""

import json
import re
import shlex
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from tests.command_line import assess, fatigue
from tests.readers.convert.audit.test_audit import static_results
from tests.readers.op2_writer import modal_op2
from tests.readers.static_files import static_files

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


PLATE = """BEGIN BULK
MAT1,1,70000.,,0.33
PSHELL,1,1,5.,1,,1
GRID,1,,0.,0.,0.
GRID,2,,10.,0.,0.
GRID,3,,10.,10.,0.
GRID,4,,0.,10.,0.
CQUAD4,1,1,1,2,3,4
ENDDATA
"""


@pytest.mark.parametrize(
    "options", [(), ("--json",), ("-o", "r.csv"), ("--vtp", "p.vtp"), ("-o", "r.csv", "--vtp", "p.vtp")]
)
def test_a_mesh_without_welds_says_so(tmp_path, options):
    """One line and what to do; neither register nor picture is written."""
    (tmp_path / "plate.bdf").write_text(PLATE)
    done = fatigue("welds", tmp_path / "plate.bdf", *(tmp_path / o if "." in o else o for o in options))
    assert done.returncode == 3
    assert done.stderr.count("\n") == 1
    assert "plate.bdf: the mesh has no weld lines" in done.stderr
    assert "Mark the lines with --node-lists, --set or --marker" in done.stderr
    assert [p.name for p in tmp_path.iterdir()] == ["plate.bdf"]


def test_names_that_no_line_has(tmp_path):
    """`--only` with a text in no name: said, with a name there is; the register is whole all the same."""
    out = tmp_path / "r.csv"
    done = fatigue("welds", NASTRAN / f"{WING}.bdf", "--only", "nonsense", "-o", out, "--vtp", tmp_path / "p.vtp")
    assert done.returncode == 3
    assert "none of the 30 weld lines has 'nonsense' in its name" in done.stderr
    assert len(pd.read_csv(out)) == 30


def test_convert_tells_all_kinds_of_reasons_with_their_counts(converted, tmp_path):
    """Of the lines left out when it goes well, and of all when nothing can be assessed: nothing is cut off."""
    _, said = converted
    assert "6 weld lines not assessed: a fold of one property: perhaps bent sheet (line fold_18_382_p2a)" in said
    register = tmp_path / "r.csv"
    assert fatigue("welds", NASTRAN / f"{WING}.bdf", "-o", register).returncode == 0
    table = pd.read_csv(register)
    kinds = ["bolted", "glued", "ground flush", "no weld at all", "see drawing"]
    tee = table.index[table.kind == "tee"]
    table.loc[tee, "status"] = "excluded"
    table.loc[tee, "reason"] = [f"{kinds[k % 5]} {k}" for k in range(len(tee))]
    table.to_csv(register, index=False)
    done = fatigue(
        "convert", "--mesh", NASTRAN / f"{WING}.bdf", "--forces", NASTRAN / f"{WING}.op2", "-o", tmp_path / "body",
        "--register", register,
    )  # fmt: skip
    assert done.returncode == 3
    assert "none of the 30 weld lines can be assessed: " in done.stderr
    for number, kind in zip((5, 5, 5, 5, 4), kinds, strict=True):
        assert f"{number} because {kind} " in done.stderr
    assert "6 because a fold of one property: perhaps bent sheet (line fold_18_382_p2a)" in done.stderr


def test_register_and_case_edited_then_assessed(converted, tmp_path):
    """What `convert` prints is true: excluded, renamed and a fold assessed after the one command that is named."""
    folder, _ = converted
    shutil.copytree(folder / "body", tmp_path / "body")
    register = tmp_path / "body" / "welds_register.csv"
    table = pd.read_csv(register, dtype=str, keep_default_na=False)
    table.loc[0, ["status", "reason"]] = ["excluded", "ground flush"]
    table.loc[1, "weld"] = "front spar, lower"
    table.to_csv(register, index=False, sep=";", encoding="cp1252")
    done = assess(tmp_path / "body" / "case.toml", "-o", tmp_path / "result", "--exit-zero")
    assert done.returncode == 0, done.stderr
    assert "front spar, lower" in done.stdout
    assert f"{table.loc[0, 'weld']}  ground flush" in done.stdout.replace("   ", "  ")
    fold = table.index[table.kind == "fold"][0]
    table.loc[fold, "status"] = "assess"
    table.to_csv(register, index=False)
    checked = fatigue("check", tmp_path / "body" / "case.toml")
    assert checked.returncode == 3
    command = shlex.split(re.search(r"`fatigue (convert .*)`", checked.stderr).group(1))
    assert fatigue(*command).returncode == 0
    checked = fatigue("check", tmp_path / "body" / "case.toml")
    assert checked.returncode == 0, checked.stderr
    assert "welds            24 in 24 straight parts" in checked.stdout
    assert "not assessed     1 excluded, 5 candidates" in checked.stdout


def test_static_subcases_become_unit_loads(tmp_path):
    """What is said of them, and the case that is refused until it says what events have of them."""
    static_files(tmp_path)
    done = fatigue(
        "convert", "--mesh", tmp_path / "tee.bdf", "--forces", tmp_path / "modes.op2", "--unit-loads",
        tmp_path / "static.op2", "--coordinates", tmp_path / "straight.csv", "--interface-modes", "5",
        "--unit-load-name", "1", "tunnel", "5", "kPa", "-o", tmp_path / "body",
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert f"unit load tunnel: 5 kPa is the load of subcase 1 of {tmp_path / 'static.op2'}" in done.stdout
    assert "unit load coupler_draft is the load of subcase 2" in done.stdout
    assert "5 modes, 704 force rows, 3 of 3 weld lines assessed" in done.stdout
    refused = fatigue("check", tmp_path / "body" / "case.toml")
    assert refused.returncode == 3
    assert "the unit load 'tunnel' is not given" in refused.stderr
