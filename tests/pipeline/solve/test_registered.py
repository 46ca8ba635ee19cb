"""An edited register acts at the next check and assessment; what it cannot ask for is refused in one line."""

import csv
import json
import re
import shlex
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from click.testing import CliRunner

from fatigue.assess import assess
from fatigue.case import load_case
from fatigue.check import check_case
from fatigue.cli import cli
from fatigue.errors import DataError
from fatigue.pipeline.solve.model import read_model
from fatigue.readers.convert.convert import convert
from fatigue.readers.convert.options import ConvertOptions
from fatigue.verify.recount import recount
from tests.readers.op2_writer import modal_op2
from tests.readers.tee_model import bulk, tee
from tests.small_case import small_case

REGISTER = "welds_register.csv"
SECONDS = 3.0  # of the records that a case by hand counts


@pytest.fixture(scope="module")
def sources(tmp_path_factory):
    """Files of the T joint: bulk data, forces, coordinates."""
    folder = tmp_path_factory.mktemp("tee")
    (folder / "tee.bdf").write_text(bulk(tee()))
    (folder / "tee.op2").write_bytes(modal_op2(tee().results, word=8))
    time = np.arange(400) / 100
    rows = [f"{t:.9g}," + ",".join(f"{3 * np.sin((k + 1) * t):.9g}" for k in range(5)) for t in time]
    (folder / "q.csv").write_text("\n".join(["time,q_1,q_2,q_3,q_4,q_5", *rows]) + "\n")
    return folder


@pytest.fixture
def body(sources, tmp_path):
    """Convert the T joint: three lines, that of the upright the last one. Returns the options."""
    options = ConvertOptions(
        forces=sources / "tee.op2",
        mesh=sources / "tee.bdf",
        out=tmp_path / "body",
        coordinates=(sources / "q.csv",),
        interface_modes=(5,),
    )
    convert(options)
    return options


def rows_of(folder):
    """Rows of the register."""
    with (folder / REGISTER).open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def edited(folder, *changes):
    """Write changes of the rows, one dictionary for each from the first on."""
    rows = rows_of(folder)
    for row, change in zip(rows, changes, strict=False):
        row.update(change)
    with (folder / REGISTER).open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, rows[0])
        writer.writeheader()
        writer.writerows(rows)
    return rows


def case_of(folder):
    """Load the case of a folder."""
    return load_case(folder / "case.toml")


def refusal(folder):
    """What the check says; the command ends with 3 and one line for each mistake."""
    with pytest.raises(DataError) as caught:
        check_case(case_of(folder), strict=False)
    done = CliRunner().invoke(cli, ["check", str(folder / "case.toml")], standalone_mode=False)
    assert isinstance(done.exception, DataError)
    assert len(str(caught.value).splitlines()) == len(caught.value.problems)
    return str(caught.value)


def test_a_thickness_that_is_not_confirmed_is_told(body, tmp_path):
    """It does not act, and that is said with both values; as it was written, rounded or empty it is nothing to tell."""
    edited(body.out, {"thickness_mm": "12"}, {"thickness_mm": "8.001"}, {"thickness_mm": ""})
    (warning,) = [w for w in check_case(case_of(body.out)).warnings if w.code == "unconfirmed_thickness"]
    name = rows_of(body.out)[0]["weld"]
    assert str(warning).startswith(f"{REGISTER}: row 1 ({name}), column thickness_mm: 12 mm is not confirmed")
    assert "8 mm of the tables. Write true under confirmed" in str(warning)
    edited(body.out, {"confirmed": "true"})
    assert not [w for w in check_case(case_of(body.out)).warnings if w.code == "unconfirmed_thickness"]


def test_everything_that_can_be_edited_acts(body, tmp_path):
    """Name, face, curve, end, description, thickness and a reason: in the tables, and by the recount."""
    out = body.out
    edited(
        out,
        {"weld": "seam <b>ä</b>", "surface": "top", "curve": "master-steel", "description": "mine"},
        {"end_length_mm": "0", "thickness_mm": "7.5", "confirmed": "true"},
        {"status": "excluded", "reason": "ground flush, seen"},
    )
    found = check_case(case_of(out), strict=True)
    assert (found.welds, found.excluded, found.candidates) == (2, 1, 0)
    assert "not assessed     1 excluded, 0 candidates" in found.as_text()
    assess(case_of(out), tmp_path / "result", threads=1, report=False)
    welds = pd.read_parquet(tmp_path / "result" / "welds.parquet").set_index("weld")
    first, second, third = rows_of(out)
    assert welds.status.to_dict() == {first["weld"]: "assessed", second["weld"]: "assessed", third["weld"]: "excluded"}
    assert welds.loc[third["weld"], "reason"] == "ground flush, seen"
    row = welds.loc["seam <b>ä</b>"]
    assert (row.surface, row.curve, row.description) == ("top", "master-steel", "mine")
    assert (welds.loc[second["weld"], ["end_length_mm", "thickness_min_mm"]] == [0.0, 7.5]).all()
    nodes = pd.read_parquet(tmp_path / "result" / "nodes.parquet")
    assert not nodes[(nodes.weld == "seam <b>ä</b>") & (nodes.surface == "bottom")].toe.any()
    agreement = recount(tmp_path / "result", sample=None)
    assert agreement.passed, agreement.as_text()
    assert REGISTER in {i["file"] for i in json.loads((tmp_path / "result" / "provenance.json").read_text())["inputs"]}


def test_an_edited_register_is_worth_a_conversion(body, tmp_path):
    """Edited and assessed, and converted with the edited register: the same stresses, names and faces."""
    edited(
        body.out,
        {"weld": "b", "surface": "bottom", "curve": "master-steel"},
        {"weld": "a", "thickness_mm": "7.5", "confirmed": "true", "end_length_mm": "3.5"},
    )
    again = replace(body, out=tmp_path / "again", welds=replace(body.welds, register=body.out / REGISTER))
    convert(again)
    ours, theirs = (read_model(case_of(folder), strict=True) for folder in (body.out, again.out))
    assert ours.welds == theirs.welds
    assert np.array_equal(ours.stations.treated.bending, theirs.stations.treated.bending)
    assert np.array_equal(ours.stations.thickness, theirs.stations.thickness)


def test_a_weld_is_found_after_any_number_of_renames(body):
    """Two names exchanged; and the register of a conversion with one name edited to the next."""
    first, second, _ = (row["line"] for row in rows_of(body.out))
    before = read_model(case_of(body.out), strict=True)
    edited(body.out, {"weld": second}, {"weld": first})
    swapped = read_model(case_of(body.out), strict=True)
    assert [w.name for w in swapped.welds[:2]] == [second, first]
    assert np.array_equal(swapped.stations.treated.bending, before.stations.treated.bending)
    convert(body)
    edited(body.out, {"weld": "second name"})
    convert(body)
    assert "second name" in (body.out / "welds.csv").read_text()
    edited(body.out, {}, {}, {})
    by_line = {row["line"]: row for row in rows_of(body.out)}
    edited(body.out, *({"weld": f"third {k}"} for k in range(3)))
    third = read_model(case_of(body.out), strict=True)
    assert {w.name for w in third.welds} == {"third 0", "third 1", "third 2"}
    assert set(by_line) == {row["line"] for row in rows_of(body.out)}


@pytest.mark.parametrize("encoding", ["utf-8-sig", "cp1252", "utf-16"])
def test_a_register_saved_by_a_spreadsheet(body, encoding):
    """Semicolons, decimal commas, other encodings, CRLF, blank lines, flags in German: read as what they mean."""
    rows = edited(
        body.out, {"weld": "Träger; oben", "thickness_mm": "7.5", "confirmed": "WAHR", "end_length_mm": "2.5"}
    )
    for row in rows:
        row["confirmed"] = "WAHR" if row["confirmed"] == "WAHR" else "FALSCH"
        for name in ("thickness_mm", "end_length_mm", "length_mm"):
            row[name] = row[name].replace(".", ",")
    lines = [";".join(rows[0])] + [";".join(f'"{c}"' if ";" in c else c for c in row.values()) for row in rows]
    blank = ";" * (len(rows[0]) - 1)
    (body.out / REGISTER).write_bytes("\r\n".join([*lines[:2], "", blank, *lines[2:], blank, ""]).encode(encoding))
    found = read_model(case_of(body.out), strict=True)
    weld = next(w for w in found.welds if w.name == "Träger; oben")
    assert weld.end_length == 2.5
    assert found.stations.thickness[found.stations.weld == found.welds.index(weld)].tolist() == [7.5] * 7


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "the first line is empty"),
        ("weld,line,status\n", "the register has no rows"),
        ("weld;line;status\nx;y\n", "row 1: column status is missing or empty"),
        ("weld,line,status\nx,y,perhaps\n", "row 1: status is 'perhaps', not one of assess, candidate, excluded"),
        ("weld,line,status\nx,y,assess\nz,y,assess\n", "row 2: line y is given twice, in row 1 already"),
        ("weld,line,status,line\nx,y,assess,y\n", "column line appears twice"),
    ],
)
def test_a_register_that_makes_no_sense(body, text, words):
    """One line with file, row and value, at the check already."""
    (body.out / REGISTER).write_text(text)
    assert words in refusal(body.out)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ([{"status": "excluded"}, {"status": "excluded"}, {"status": "candidate"}],
         "no weld is left to assess: 2 excluded, 1 candidate"),
        ([{"curve": "steel?"}], "column curve: there is no curve 'steel?'. Choose one of "),
        ([{"weld": "one"}, {"weld": "one"}], "have the same nodes: they are two plate sides of one weld"),
        ([{"weld": "one", "surface": "top"}, {"weld": "one"}], "its lines have different surface: both (line tee_"),
        ([{"weld": "one", "end_length_mm": "3"}, {"weld": "one"}], "its lines have different end_length_mm: none ("),
        ([{"thickness_mm": "thick"}], "row 1: thickness_mm is 'thick', not a number"),
        ([{"thickness_mm": "-3", "confirmed": "true"}], "a confirmed thickness must be above 0"),
    ],
)  # fmt: skip
def test_edits_that_make_no_sense(body, changes, words):
    """Contradictions are refused at the check, each in one line."""
    edited(body.out, *changes)
    assert words in refusal(body.out)


def test_a_line_without_forces_names_the_command_that_gets_them(body, sources, tmp_path):
    """The exact command is run, with the edited case kept, and the line is assessed; without a status it is fine."""
    edited(body.out, {"status": "excluded", "reason": "not now"})
    convert(body)  # whose tables have two lines now
    case = body.out / "case.toml"
    case.write_text(case.read_text().replace("target_km = 1000000.0", "target_km = 5000000.0"))
    assert check_case(case_of(body.out), strict=True).excluded == 1
    excluded = next(k for k, row in enumerate(rows_of(body.out)) if row["status"] == "excluded")
    edited(body.out, *({"status": "assess"} if k == excluded else {} for k in range(3)))
    said = refusal(body.out)
    assert "is to be assessed, and the tables have no forces for it (reason given: not now). Run `fatigue conv" in said
    command = shlex.split(re.search(r"`fatigue (.*)`", said).group(1))
    done = CliRunner().invoke(cli, command, standalone_mode=False)
    assert done.exception is None, done.output
    assert check_case(case_of(body.out), strict=True).welds == 3
    assert case_of(body.out).mission.target_km == 5e6
    with pytest.raises(DataError, match="was changed since it was converted"):
        convert(body)


def test_several_lines_without_forces_are_one_command(body):
    """All are named, the command once; tables by hand get the name that was meant instead."""
    edited(body.out, {"status": "excluded"}, {"status": "candidate"})
    convert(body)
    changes = [{"status": "assess"} if row["status"] != "assess" else {} for row in rows_of(body.out)]
    edited(body.out, *changes)
    said = refusal(body.out)
    assert said.count("fatigue convert") == 1
    assert said.startswith(f"{REGISTER}: 2 lines are to be assessed, and the tables have no forces for them: tee_")
    (body.out / "convert.json").unlink()
    (body.out / REGISTER).write_text(f"weld,status\n{rows_of(body.out)[0]['line'][:-1]},assess\n")
    assert f"(meant is perhaps {pd.read_csv(body.out / 'welds.csv').weld[0]})" in refusal(body.out)


def test_a_weld_that_nobody_registered_is_assessed_with_a_warning(body):
    """A row taken out is no exclusion."""
    rows = rows_of(body.out)
    (body.out / REGISTER).write_text("\n".join([",".join(rows[0]), *(",".join(r.values()) for r in rows[1:])]) + "\n")
    found = check_case(case_of(body.out), strict=True)
    assert found.welds == 3
    (warning,) = (w for w in found.warnings if w.code == "unregistered_weld")
    assert (warning.where, warning.what) == (
        f"{REGISTER}: weld {rows[0]['weld']}",
        "the weld is not in the weld register and is assessed as the tables have it",
    )


def test_unknown_columns_are_a_warning_or_a_mistake(body):
    """With the name that was meant, where there is one."""
    text = (body.out / REGISTER).read_text().replace("end_length_mm,description", "end_lengt_mm,checked by")
    (body.out / REGISTER).write_text(text)
    warnings = [str(w) for w in check_case(case_of(body.out), strict=False).warnings if w.code == "unknown_column"]
    assert [w.split(": ", 1)[1] for w in warnings] == [
        "column end_lengt_mm: the column is unknown and not read. Rename it to 'end_length_mm'.",
        "column checked by: the column is unknown and not read. Remove it if it is not for yourself.",
    ]
    with pytest.raises(DataError, match="unknown and not read"):
        check_case(case_of(body.out), strict=True)


def test_a_thickness_that_was_confirmed_and_is_not_any_more(body):
    """The tables have the confirmed one only: the command that gets the other is named; another value is taken."""
    edited(body.out, {"thickness_mm": "7.5", "confirmed": "true"})
    convert(body)
    at = next(k for k, row in enumerate(rows_of(body.out)) if row["confirmed"] == "true")
    edited(body.out, *({"thickness_mm": "7"} if k == at else {} for k in range(3)))
    assert 7.0 in read_model(case_of(body.out), strict=True).stations.thickness
    edited(body.out, *({"confirmed": "false"} if k == at else {} for k in range(3)))
    assert "the tables do not tell the plate thickness that is asked for. Run `fatigue convert" in refusal(body.out)


def test_another_register_may_be_named(body):
    """The key of the case decides; a file that is not there is named with the key."""
    edited(body.out, {"status": "excluded"})
    (body.out / REGISTER).rename(body.out / "other.csv")
    case = body.out / "case.toml"
    assert f'register = "{REGISTER}"' in case.read_text()
    assert "case.toml: body.register: there is no file" in refusal(body.out)
    case.write_text(case.read_text().replace(f'"{REGISTER}"', '"other.csv"'))
    assert check_case(case_of(body.out), strict=True).excluded == 1


def hand_written(folder, rows, pairs=8, suffix="csv"):
    """Write a case by hand with summed nodal forces, and a register."""
    case = small_case(SECONDS, pairs)
    case.body["register"] = "mine.csv"
    case.welds["curve"] = "master-steel"
    path = case.write(folder, suffix)
    (folder / "mine.csv").write_text("\n".join(rows) + "\n")
    return load_case(path)


@pytest.mark.parametrize("suffix", ["csv", "parquet"])
@pytest.mark.parametrize("pairs", [1, 8])
@pytest.mark.parametrize("line", ["", "A"])
def test_tables_written_by_hand_are_registered_by_the_names_in_them(tmp_path, line, pairs, suffix):
    """`line` is the name in the tables or empty; cells left empty leave what the tables say; forces are found."""
    name = "long name" if line else "A"
    case = hand_written(
        tmp_path / "case", ["weld,line,status,surface", f"{name},{line},assess,top", "B,,excluded,"], pairs, suffix
    )
    assess(case, tmp_path / "result", threads=1, report=False)
    welds = pd.read_parquet(tmp_path / "result" / "welds.parquet").set_index("weld")
    assert welds.loc[name, "surface"] == "top"
    assert set(welds.curve.dropna()) == {"master-steel"}
    assert welds.loc["B", ["status", "reason"]].tolist() == ["excluded", "excluded"]
    assert (welds.status == "assessed").sum() == 2 * pairs - 1
    plain = small_case(SECONDS, pairs)
    plain.welds["curve"] = "master-steel"
    assess(load_case(plain.write(tmp_path / "plain")), tmp_path / "all", threads=1, report=False)
    every = pd.read_parquet(tmp_path / "all" / "nodes.parquet").set_index("weld")
    some = pd.read_parquet(tmp_path / "result" / "nodes.parquet").set_index("weld")
    assert np.allclose(some.loc[name, "damage_per_km"], every.loc["A", "damage_per_km"], rtol=1e-9)
    agreement = recount(tmp_path / "result")
    assert agreement.passed, agreement.as_text()


def test_summed_forces_are_not_joined(tmp_path):
    """Which elements the sums of both lines hold at the joint is not known: refused, with what would do."""
    case = small_case()
    case.body["register"] = "mine.csv"
    b = case.weld_nodes.weld == "B"
    case.weld_nodes.loc[b, ["y_mm", "x_mm"]] = [[0.0, 60.0 + x] for x in case.weld_nodes.loc[b, "x_mm"]]
    case.weld_nodes.loc[b, "node"] -= 94  # the first is the last of the other
    case.nodal_forces.loc[case.nodal_forces.weld == "B", "node"] -= 94
    path = case.write(tmp_path)
    (tmp_path / "mine.csv").write_text("weld,line,status,surface\nlong,A,assess,top\nlong,B,assess,top\n")
    with pytest.raises(DataError) as caught:
        check_case(load_case(path), strict=True)
    assert str(caught.value) == (
        "mine.csv: weld long: A and B cannot be joined: their nodal forces are summed, and which elements round node "
        "106 are in both sums is not known. Give element_forces and weld_elements, or write the forces of the whole "
        "line."
    )


def test_an_unknown_weld_among_the_forces_is_still_refused(tmp_path):
    """Welds of the tables that are left out may have forces, strangers may not."""
    case = small_case(pairs=8)
    case.body["register"] = "mine.csv"
    case.nodal_forces.loc[5, "weld"] = "stranger"
    path = case.write(tmp_path)
    (tmp_path / "mine.csv").write_text("weld,status\nB,excluded\n")
    with pytest.raises(DataError, match="'stranger' is not one of the welds"):
        check_case(load_case(path), strict=True)


def test_a_left_out_weld_may_be_as_bad_as_it_likes(tmp_path):
    """A line that no assessment takes, a curve nobody has, no forces: excluded, all this does not matter."""
    case = small_case()
    case.body["register"] = "mine.csv"
    b = case.weld_nodes.weld == "B"
    case.weld_nodes.loc[b, ["normal_x", "normal_z"]] = [1.0, 0.0]
    case.welds["curve"] = ["", "no such curve"]
    case.nodal_forces = case.nodal_forces[case.nodal_forces.weld == "A"]
    path = case.write(tmp_path)
    (tmp_path / "mine.csv").write_text("weld,status,reason\nA,assess,\nB,excluded,twisted\n")
    assert check_case(load_case(path), strict=True).welds == 1
    (tmp_path / "mine.csv").write_text("weld,status,reason\nA,assess,\nB,assess,\n")
    with pytest.raises(Exception, match=r"weld B.*|no curve 'no such curve'"):
        check_case(load_case(path), strict=True)


def test_rows_of_one_name_that_are_left_out_keep_names_of_their_own(body, tmp_path):
    """A weld of three lines of which two are excluded: no two rows of the result have one name."""
    edited(body.out, *({"weld": "one", "status": status} for status in ("assess", "excluded", "candidate")))
    assess(case_of(body.out), tmp_path / "result", threads=1, report=False)
    welds = pd.read_parquet(tmp_path / "result" / "welds.parquet")
    lines = [row["line"] for row in rows_of(body.out)]
    assert welds.weld.tolist() == ["one", *lines[1:]]


def test_columns_of_the_user_survive_a_conversion(body):
    """Nothing reads them, and nothing throws them away; a reason may have line breaks and the name a comma."""
    rows = rows_of(body.out)
    rows[0] |= {"reason": "seen,\nsigned", "status": "excluded", "weld": "a, b"}
    rows = [row | {"checked by": f"me {k}"} for k, row in enumerate(rows)]
    with (body.out / REGISTER).open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, rows[0])
        writer.writeheader()
        writer.writerows(rows)
    done = convert(body)
    assert "unknown_column" in {problem.code for problem in done.warnings}
    assert {r["line"]: r["checked by"] for r in rows_of(body.out)} == {r["line"]: r["checked by"] for r in rows}
    assert [r["reason"] for r in rows_of(body.out) if r["status"] == "excluded"] == ["seen,\nsigned"]
    assert check_case(case_of(body.out), strict=False).excluded == 1


def test_a_workbook_is_no_register(body):
    """Named as what it is."""
    (body.out / REGISTER).write_bytes(b"PK\x03\x04" + bytes(200))
    assert "this is a ZIP archive, or an Excel workbook" in refusal(body.out)


def test_a_folder_converted_before_lines_were_recorded(body):
    """Without the key, the lines and the command: found beside the welds, by the names in the tables."""
    case, record = body.out / "case.toml", body.out / "convert.json"
    case.write_text("\n".join(line for line in case.read_text().splitlines() if not line.startswith("register")))
    said = json.loads(record.read_text())
    record.write_text(json.dumps({k: v for k, v in said.items() if k not in ("welds", "command")}))
    edited(body.out, {"weld": "mine"}, {"status": "excluded"})
    assert next(w.name for w in read_model(case_of(body.out), strict=True).welds) == "mine"
    edited(body.out, {"line": "tee_1_2_p3a"}, {"status": "excluded"})
    assert f"Convert the files of {body.out} again with --register" in refusal(body.out)


def test_relative_paths(tmp_path, monkeypatch):
    """A register that no key names is found beside the welds from where the command runs, by the recount, too."""
    path = small_case().write(tmp_path / "case")
    (tmp_path / "case" / REGISTER).write_text("weld,status\nA,assess\nB,excluded\n")
    monkeypatch.chdir(tmp_path)
    assess(load_case(path.relative_to(tmp_path)), tmp_path.relative_to(tmp_path) / "result", threads=1, report=False)
    found = recount(tmp_path.relative_to(tmp_path) / "result", sample=3)
    assert found.passed, found.as_text()
