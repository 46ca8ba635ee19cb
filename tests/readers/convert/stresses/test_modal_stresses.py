"""From files of a solver to the table of modal stresses: closed forms, numbers, units, loads, and what is refused."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from fatigue.assess import assess
from fatigue.case import load_case
from fatigue.errors import CaseError, DataError
from fatigue.readers.convert.convert import convert
from fatigue.readers.convert.loads.names import LoadName
from fatigue.readers.convert.options import ConvertOptions
from fatigue.readers.foreign.nastran.results.op2_records import read_records
from fatigue.readers.foreign.nastran.results.op2_stresses import read_op2_stresses
from fatigue.results.tables import read_table
from tests.command_line import fatigue
from tests.mystran.strip import T, stress_along
from tests.readers.op2_writer import Op2Writer

STRIP = Path("tests/data/nastran/mystran").resolve()
POINTS = pd.DataFrame(
    [
        ("nominal", "nominal", 30, 20, 0, (1, 0, 0), (0, 0, 1)),
        ("turned", "parent", 52, 11, 2.5, (1, 1, 0), (0, 0, -1)),
        ("toe", "hot_spot_a", 30, 20, 0, (1, 0, 0.3), (0, 0, 1)),
        ("edge", "hot_spot_b", 60, 40, 0, (-1, 0, 0), (0, 0, 1)),
    ],
    columns=["point", "kind", "x_mm", "y_mm", "z_mm", "e1", "normal"],
)


def points_table(points=POINTS):
    """Table of stress points as a case has it."""
    table = points.drop(columns=["e1", "normal"]).assign(thickness_mm=T, curve="iiw-steel-100", weld="")
    for name in ("e1", "normal"):
        table[[f"{name}_{a}" for a in "xyz"]] = np.array(points[name].tolist(), float)
    return table


def options(folder, points=None, results="static", **more):
    """Options of a conversion of the strip, whose weld line is across it."""
    folder.mkdir(exist_ok=True)
    (points_table() if points is None else points).to_csv(folder / "points.csv", index=False)
    lines = pd.DataFrame({"weld": "W", "order": range(1, 6), "node": range(11, 16)})
    lines.to_csv(folder / "lines.csv", index=False)
    given = ConvertOptions(STRIP / f"strip_{results}.op2", STRIP / f"strip_{results}.dat", folder / "body")
    welds = replace(given.welds, node_lists=folder / "lines.csv")
    return replace(given, **{"stress_points": folder / "points.csv", "welds": welds} | more)


def table_of(done):
    """Table of modal stresses of a conversion."""
    return pd.read_parquet(done.folder / "modal_stresses.parquet")


def test_tension_and_bending_of_a_strip(tmp_path):
    """Cases 1 and 2 are exact on distorted, turned and flipped elements, in every frame, on both faces."""
    done = convert(options(tmp_path))
    assert {row.check: row.light for row in done.audit.rows}["shell stresses"] == "green"
    table = table_of(done)
    assert done.read_outs == 1 + 1 + 2 + 3
    assert len(table) == 3 * (2 + 2 + 4 + 3)
    assert list(table.columns) == [
        "point", "read_out", "distance_mm", "mode", "surface", "sx_MPa", "sy_MPa", "txy_MPa",
    ]  # fmt: skip
    for row in table[table["mode"] < 3].itertuples():
        top = {"top": 1, "bottom": -1, "edge": 0}[row.surface] * (-1 if row.point == "turned" else 1)
        s = stress_along(row.mode - 1, 0.0, top)
        wanted = {"turned": (s / 2, s / 2, s / 2)}.get(row.point, (s, 0, 0))  # 45 degrees, seen from below
        assert (row.sx_MPa, row.sy_MPa, row.txy_MPa) == pytest.approx(wanted, abs=2e-4), row
    toe = table[(table.point == "toe") & (table["mode"] == 3) & (table.surface == "top")]
    assert toe.distance_mm.tolist() == pytest.approx([2.0, 5.0])
    wanted = [stress_along(2, 30 + d, 1) for d in (2, 5)]
    assert toe.sx_MPa.to_numpy() == pytest.approx(wanted, rel=0.03)  # of a mesh of 10 mm


def test_the_folder_is_a_case(tmp_path):
    """Points are copied, the case names both files, the record has their hashes; the same conversion may come again."""
    asked = options(tmp_path)
    done = convert(asked)
    text = (done.folder / "case.toml").read_text()
    assert 'stress_points = "stress_points.csv"\nmodal_stresses = "modal_stresses.parquet"\n' in text
    assert (done.folder / "stress_points.csv").read_text() == (tmp_path / "points.csv").read_text()
    record = json.loads((done.folder / "convert.json").read_text())
    assert {"stress_points.csv", "modal_stresses.parquet"} <= set(record["files"])
    assert str(tmp_path / "points.csv") in record["inputs"]
    assert "shell stresses" in {row["check"] for row in record["audit"]}
    convert(asked)


def test_points_may_be_edited_in_the_folder(tmp_path):
    """The copy is given itself: it is read, and not written over."""
    done = convert(options(tmp_path))
    own = done.folder / "stress_points.csv"
    table = pd.read_csv(own)
    table.loc[0, "x_mm"] = 45.0
    table.to_csv(own, index=False)
    again = convert(options(tmp_path, stress_points=own))
    assert pd.read_csv(own).x_mm[0] == 45.0
    assert again.read_outs == done.read_outs


def test_a_kept_case_that_does_not_name_the_points_is_told(tmp_path):
    """One warning says what to add."""
    asked = options(tmp_path)
    convert(replace(asked, stress_points=None))
    done = convert(replace(asked, keep_case=True))
    (found,) = [problem for problem in done.warnings if problem.code == "stress_points_not_in_case"]
    assert "stress_points = 'stress_points.csv'" in found.remedy


def test_modes_and_unit_loads(tmp_path):
    """Modes by number, subcases of a file of their own by the name of their load, per unit of it."""
    asked = options(tmp_path, results="modes", unit_loads=(STRIP / "strip_static.op2",))
    asked = replace(asked, unit_load_names=_names((1, "tension", 100.0), (2, "both", 1.0), (3, "shear", 2.0)))
    table = table_of(convert(asked))
    assert table["mode"].dropna().unique().tolist() == [1, 2]
    assert table.unit_load.dropna().unique().tolist() == ["tension", "both", "shear"]
    assert (table["mode"].isna() == table.unit_load.notna()).all()
    own = table[(table.unit_load == "tension") & (table.point == "nominal")]
    assert own.sx_MPa.to_numpy() == pytest.approx([0.2, 0.2], rel=1e-5)


def test_a_file_that_is_left_out_needs_no_stresses(tmp_path):
    """Static subcases beside the modes are loads or nothing: only what is used has to have stresses."""
    static = Op2Writer(4)
    (tmp_path / "bare.op2").write_bytes(_without_stresses(STRIP / "strip_static.op2", static))
    asked = options(tmp_path, results="modes", unit_loads=(tmp_path / "bare.op2",))
    with pytest.raises(DataError, match=r"bare.op2: no stresses of these shells .*tables found: .*OGPFB1"):
        convert(asked)
    assert convert(replace(asked, static_subcases="leave_out")).modes == 2


def _without_stresses(path, writer):
    """Bytes of an OP2 file without its tables of stresses."""
    op2 = read_records(path)
    for table in op2.tables:
        if not table.name.startswith("OES"):
            writer.table(table.name, [op2.record(record).tobytes() for record in table.records])
    return writer.close()


CURVES = """
[curves.nominal-71]
slopes = [3.0]
knees_cycles = []
range_at_2e6_MPa = 71.0
applies = "nominal"
source = "made up"
[curves.metal-71]
slopes = [5.0]
knees_cycles = []
range_at_2e6_MPa = 71.0
applies = "parent"
source = "made up"
"""


def test_from_the_solver_to_the_check(tmp_path):
    """Tension that swings by 3 of its load: 6 x 20 MPa at every point, in the parent metal on the plane across it."""
    table = points_table()
    table.loc[0, "curve"], table.loc[1, "curve"] = "nominal-71", "metal-71"
    time = np.arange(400) * 0.005
    waves = {"time_s": time, "q_1": 3 * np.cos(2 * np.pi * 2.5 * time), "q_2": 0 * time, "q_3": 0 * time}
    pd.DataFrame(waves).to_csv(tmp_path / "q.csv", index=False)
    done = convert(options(tmp_path, points=table, coordinates=(tmp_path / "q.csv",)))
    case = done.folder / "case.toml"
    case.write_text(case.read_text().replace('upsample = "auto" ', "upsample = 1 ") + CURVES)
    result = assess(load_case(case), tmp_path / "result", report=False)
    rows = read_table(result.folder, "checks").to_pandas()
    worst = rows.sort_values("range_max_MPa").groupby("point").last()
    assert worst.range_max_MPa.to_numpy() == pytest.approx([120.0] * 4, rel=1e-5)
    assert worst.check.to_dict() == {"edge": "hot_spot", "nominal": "nominal", "toe": "hot_spot", "turned": "parent"}
    assert worst.direction_deg["turned"] % 180 == 45  # e1 is at 45 degrees to the tension


def _names(*loads):
    """Names and amounts of subcases."""
    return tuple(LoadName(subcase, name, amount, "N/mm") for subcase, name, amount in loads)


def test_units(tmp_path):
    """The same numbers as m, kg, s: pascals become MPa, a coordinate sqrt(kg) m one of sqrt(t) mm; points are in mm."""
    small = points_table()
    small[["x_mm", "y_mm", "z_mm"]] *= 1000
    small["thickness_mm"] *= 1000
    first = table_of(convert(options(tmp_path / "a", results="modes")))
    second = table_of(convert(options(tmp_path / "b", points=small, results="modes", force_units="m-kg-s")))
    same = first.point != "edge"  # whose read-outs are at fixed distances
    coordinate = 1000 * 1e-3**0.5
    assert np.allclose(second[same].sx_MPa, first[same].sx_MPa * 1e-6 / coordinate, rtol=1e-9)


def copy_of(path, blocks, **head):
    """A stress file of its own."""
    writer = Op2Writer(8)
    writer.stress_table(blocks, **head)
    path.write_bytes(writer.close())
    return path


def own_blocks(name):
    """Stress blocks of a file of the strip."""
    return list(read_op2_stresses(STRIP / f"strip_{name}.op2", np.arange(1, 999)).blocks)


def test_stresses_in_a_file_of_their_own(tmp_path):
    """The same blocks in another file, 64 bits: the same table."""
    stresses = copy_of(tmp_path / "s.op2", own_blocks("static"))
    ours = table_of(convert(options(tmp_path / "a", stresses=(stresses,))))
    assert ours.equals(table_of(convert(options(tmp_path / "b"))))


def test_stresses_of_another_run_are_refused(tmp_path):
    """Modes with another frequency; all of the subcases halved, which only the forces show."""
    other = [replace(b, eigenvalue=1e6) for b in own_blocks("modes")]
    asked = options(tmp_path, results="modes", stresses=(copy_of(tmp_path / "o.op2", other),))
    with pytest.raises(
        DataError, match=r"stresses of mode 1 are of 159.155 Hz, its forces of .*Give forces and stresses of"
    ):
        convert(asked)
    half = [replace(b, stress=b.stress / 2) for b in own_blocks("static")]
    asked = options(tmp_path, stresses=(copy_of(tmp_path / "h.op2", half),))
    with pytest.raises(
        DataError, match=r"h.op2, shell stresses: stresses of \d+ shells differ .* by 0.5 of the membrane"
    ):
        convert(asked)
    assert convert(replace(asked, accept=("shell stresses",))).read_outs == 7


def test_modes_without_stresses_are_refused(tmp_path):
    """Named, with why blocks of the file are not used."""
    first = [b for b in own_blocks("modes") if b.mode == 1]
    asked = options(tmp_path, results="modes", stresses=(copy_of(tmp_path / "f.op2", first),))
    with pytest.raises(DataError, match=r"mode 2 have forces and no stresses of the shells"):
        convert(asked)
    asked = replace(asked, stresses=(copy_of(tmp_path / "m.op2", own_blocks("modes"), stress=17),))
    with pytest.raises(DataError, match=r"mode 1, mode 2 have forces and no stresses(?s:.*)material system .*OMID,NO"):
        convert(asked)


def test_several_subcases_and_files(tmp_path):
    """Modes of two subcases need a choice; a static subcase in two files that are not its own is not chosen."""
    twice = [replace(b, subcase=s) for s in (1, 2) for b in own_blocks("modes")]
    asked = options(tmp_path, results="modes", stresses=(copy_of(tmp_path / "t.op2", twice),))
    with pytest.raises(DataError, match=r"stresses of modes of several subcases: \[1, 2\].*--subcase"):
        convert(asked)
    assert convert(replace(asked, subcase=1)).read_outs == 7
    files = tuple(copy_of(tmp_path / f"{k}.op2", own_blocks("static")) for k in "ab")
    with pytest.raises(DataError, match=r"subcase 1 has stresses in several files"):
        convert(options(tmp_path, stresses=files))


def test_outside_of_any_plate(tmp_path):
    """The point, the read-out, its place and how far away the nearest plate is; all of them at once."""
    table = points_table()
    table.loc[0, "y_mm"], table.loc[1, "z_mm"] = 43.0, 9.0
    table.loc[2, "x_mm"], table.loc[3, "y_mm"] = 78.0, 30.0
    with pytest.raises(DataError) as caught:
        convert(options(tmp_path, points=table))
    told = [str(problem) for problem in caught.value.problems]
    assert "row 1, point nominal: read-out 1 at 0 mm (30, 43, 0) lies in no shell" in told[0]
    assert "is 3 mm away" in told[0]
    assert "row 2, point turned: read-out 1 at 0 mm (52, 11, 9)" in told[1]
    assert "row 3, point toe: read-out 2 at 5 mm (83, 20, 0)" in told[2]
    assert "is 3 mm away" in told[2]
    assert "turn e1 round" in told[2]
    assert "row 4, point edge: the point lies on no free edge" in told[3]
    assert "the nearest is 10 mm away" in told[3]


def test_an_edge_that_ends_is_told(tmp_path):
    """Type b with the read-outs beyond the corner of the plate."""
    table = points_table()
    table.loc[3, "x_mm"] = 7.0
    with pytest.raises(DataError, match=r"point edge: read-out 2 at 8 mm: the edge ends or turns 1 mm before it"):
        convert(options(tmp_path, points=table))


def test_doubts_are_told_once(tmp_path):
    """Coarse elements, another thickness; a sound table of points of their own size says nothing of either."""
    table = points_table()
    table["thickness_mm"] = 6.0
    codes = {problem.code: problem for problem in convert(options(tmp_path / "a", points=table)).warnings}
    assert codes["point_thickness"].count == 4
    assert "6 mm at point nominal, 5 mm in element" in codes["point_thickness"].what
    assert codes["coarse_elements"].count == 2
    assert "at most 2.4 mm" in codes["coarse_elements"].what
    assert codes["centre_stresses"].count == 1
    table = points_table(POINTS[POINTS.point == "turned"])
    codes = {problem.code for problem in convert(options(tmp_path / "b", points=table)).warnings}
    assert not codes & {"point_thickness", "coarse_elements", "across_plates"}


@pytest.mark.parametrize(
    ("column", "value", "words"),
    [
        ("kind", "hot_spot_c", "'hot_spot_c' is not one of hot_spot_a"),
        ("thickness_mm", 0.0, "0 is not above 0"),
        ("x_mm", np.nan, "the value is missing or NaN"),
        ("point", "toe", "point toe repeats"),
    ],
)
def test_bad_tables(tmp_path, column, value, words):
    """File, column and row are named."""
    table = points_table()
    table.loc[1, column] = value
    with pytest.raises(DataError, match=words):
        convert(options(tmp_path, points=table))


def test_e1_along_the_normal(tmp_path):
    """There is no frame."""
    table = points_table()
    table.loc[1, ["e1_x", "e1_y", "e1_z"]] = 0.0, 0.0, 2.0
    with pytest.raises(DataError, match=r"points.csv: row 2: e1 is zero or along the normal"):
        convert(options(tmp_path, points=table))


def test_on_the_command_line(tmp_path):
    """What is read is said; stresses without points, and files that are not there, are refused at once."""
    options(tmp_path)
    own = ["convert", "--mesh", STRIP / "strip_static.dat", "--forces", STRIP / "strip_static.op2"]
    own += ["--node-lists", tmp_path / "lines.csv", "-o", tmp_path / "body"]
    done = fatigue(*own, "--stress-points", tmp_path / "points.csv", "--read-outs", "coarse")
    assert done.returncode == 0, done.stderr
    assert "stresses at 6 read-outs of stress points" in done.stdout
    assert "green  shell stresses: " in done.stdout
    for words, said in (
        (["--stresses", STRIP / "strip_static.op2"], "Give --stress-points"),
        (["--stress-points", tmp_path / "none.csv"], "none.csv"),
        (["--stress-points", tmp_path / "points.csv", "--stresses", tmp_path / "none.op2"], "none.op2"),
        (["--stress-points", tmp_path / "points.csv", "--stresses", STRIP / "strip_static.dat"], "no shell stresses"),
    ):
        refused = fatigue(*own, *words)
        assert refused.returncode == 3, refused.stderr
        assert said in refused.stderr
        assert refused.stderr.count("error: ") == 1


def test_options_are_refused_by_python_too(tmp_path):
    """A density that is none."""
    with pytest.raises(CaseError, match=r"'finest' is none.*fine, quadratic, coarse"):
        convert(options(tmp_path, read_outs="finest"))
