"""Throats of fillet welds: what the table says arrives, and what cannot be is refused with its place."""

from dataclasses import replace

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from fatigue.errors import DataError
from fatigue.readers.neutral.body.throats import WeldThroat, assessed_throats, check_throats, read_throats
from tests.readers.neutral_tables import changed, refusal_of, without, write
from tests.weld_lines import weld_line

SUFFIXES = pytest.mark.parametrize("suffix", [".csv", ".parquet"])
WELDS = {"web", "lap", "special"}
THROATS = {
    "weld": ["web", "lap", "special"],
    "joint": ["tee", "lap", "custom"],
    "sides": ["both", "bottom", "top"],
    "throat_mm": [4.0, 3.5, 5.0],
    "penetration_mm": [1.0, None, None],
    "line_offset_mm": [-5.0, 0.0, 0.0],
    "angle_deg": [None, None, 30.0],
    "root_y_mm": [None, None, -1.0],
    "root_z_mm": [None, None, 3.0],
    "lever": ["t", None, None],
    "combination": ["path", None, "direction"],
    "curve": ["c36", "c36", "c40"],
    "curve_shear": ["c80", "c80", "c80"],
    "curve_root": [None, "master-steel", None],
    "ended_plate": [True, True, True],
}


@SUFFIXES
def test_throats(tmp_path, suffix):
    """Every column arrives, by the name of the weld; what is empty takes its default."""
    throats, warnings = read_throats(write(tmp_path / f"t{suffix}", THROATS), WELDS, strict=True)
    assert warnings == []
    nan = pytest.approx(np.nan, nan_ok=True)
    web = throats["web"]
    assert (web.joint, web.sides, web.lever, web.curve_root) == ("tee", ("top", "bottom"), "t", None)
    assert [one.combination for one in throats.values()] == ["path", "direction", "direction"]
    assert (web.throat, web.penetration, web.line_offset, web.angle_deg) == (4.0, 1.0, -5.0, nan)
    lap = throats["lap"]
    assert (lap.sides, lap.penetration, lap.lever, lap.curve_root) == (("bottom",), 0.0, "throats", "master-steel")
    special = throats["special"]
    assert (special.angle_deg, special.root_y, special.root_z, special.curve) == (30.0, -1.0, 3.0, "c40")


def test_sections_are_those_of_the_joint(tmp_path):
    """A tee has its root at half the thickness less the penetration, a lap on the face of the other plate."""
    throats, _ = read_throats(write(tmp_path / "t.csv", THROATS), WELDS, strict=True)
    t = np.array([6.0, 10.0])
    web, lap, special = (throats[name].section(t) for name in ("web", "lap", "special"))
    assert (web.angle_deg, web.root_y.tolist(), web.root_z.tolist()) == (45.0, [-5.0, -5.0], [2.0, 4.0])
    assert (lap.angle_deg, lap.root_y.tolist(), lap.root_z.tolist()) == (-45.0, [0.0, 0.0], [-3.0, -5.0])
    assert (special.angle_deg, special.root_y.tolist(), special.root_z.tolist()) == (30.0, [-1.0, -1.0], [3.0, 3.0])


@SUFFIXES
@pytest.mark.parametrize(
    ("columns", "message"),
    [
        (without(THROATS, "line_offset_mm"), "column line_offset_mm: the column is missing."),
        (without(THROATS, "ended_plate"), "column ended_plate: the column is missing."),
        (without(THROATS, "curve_shear"), "column curve_shear: the column is missing."),
        (changed(THROATS, "line_offset_mm", 1, None), "column line_offset_mm, row 1: the value is missing or NaN."),
        (changed(THROATS, "weld", 3, "webb"), "column weld, row 3: 'webb' is not one of the welds. Write 'web'."),
        (changed(THROATS, "weld", 2, "web"), "column weld, row 2: weld web repeats row 1. Keep one of the rows."),
        (changed(THROATS, "joint", 1, "butt"), "column joint, row 1: 'butt' is not one of tee, lap, custom."),
        (changed(THROATS, "sides", 1, "left"), "column sides, row 1: 'left' is not one of both, top, bottom."),
        (changed(THROATS, "sides", 2, "both"), "column sides, row 2: both does not go with joint lap"),
        (changed(THROATS, "combination", 1, "sum"), "column combination, row 1: 'sum' is not one of direction, path."),
        (changed(THROATS, "lever", 2, "t"), "column lever, row 2: the lever t does not go with a weld on one side"),
        (changed(THROATS, "throat_mm", 2, 0.5), "column throat_mm, row 2: 0.5 is below 1. Give at least 1."),
        (changed(THROATS, "throat_mm", 2, None), "column throat_mm, row 2: the value is missing or NaN."),
        (changed(THROATS, "penetration_mm", 1, -1.0), "column penetration_mm, row 1: -1 is below 0."),
        (changed(THROATS, "ended_plate", 2, False), "column ended_plate, row 2: the cut is not said to be through"),
        (changed(THROATS, "ended_plate", 2, None), "column ended_plate, row 2: the cut is not said to be through"),
        (changed(THROATS, "angle_deg", 1, 45.0), "column angle_deg, row 1: the value is given although joint is not"),
        (changed(THROATS, "root_z_mm", 2, 1.0), "column root_z_mm, row 2: the value is given although joint is not"),
        (changed(THROATS, "root_y_mm", 3, None), "column root_y_mm, row 3: the value is missing although joint is"),
        (changed(THROATS, "angle_deg", 3, 135.0), "column angle_deg, row 3: 135 is not from -90 to 90. Give the angle"),
        (changed(THROATS, "penetration_mm", 3, 2.0), "column penetration_mm, row 3: 2 is given, but the root of a"),
        (changed(THROATS, "line_offset_mm", 3, 2.0), "column line_offset_mm, row 3: 2 is given, but root_y_mm of a"),
        (changed(THROATS, "curve", 2, None), "column curve, row 2: the text is missing."),
        (changed(THROATS, "curve_shear", 2, None), "column curve_shear, row 2: the text is missing."),
    ],
)
def test_refusals(tmp_path, suffix, columns, message):
    """Each mistake is told once, with file, column and row."""
    told = refusal_of(read_throats, write(tmp_path / f"t{suffix}", columns), WELDS)
    assert f"t{suffix}: {message}" in told
    assert "\n" not in told


def test_every_mistake_is_told_at_once(tmp_path):
    """Mistakes in several rows and columns come together."""
    columns = changed(changed(THROATS, "throat_mm", 1, 0.1), "ended_plate", 3, False)
    told = refusal_of(read_throats, write(tmp_path / "t.csv", columns), WELDS)
    assert len(told.splitlines()) == 2


@pytest.mark.parametrize(("name", "unit"), [("throat_mm", "m"), ("line_offset_mm", "inch"), ("angle_deg", "rad")])
def test_other_units_are_refused(tmp_path, name, unit):
    """A row of units below the names, or units of a Parquet file, must be those of the names."""
    units = {"throat_mm": "mm", "penetration_mm": "[mm]", "line_offset_mm": "mm", "angle_deg": "°"}
    for given, fits in ((units, True), (units | {name: unit}, False)):
        path = write(tmp_path / "t.csv", THROATS)
        head, *rows = path.read_text().splitlines()
        path.write_text("\n".join([head, ",".join(given.get(n, "-") for n in THROATS), *rows]) + "\n")
        table = pa.table({n: pa.array(values) for n, values in THROATS.items()})
        fields = [f.with_metadata({"unit": given.get(f.name, "")}) for f in table.schema]
        pq.write_table(table.cast(pa.schema(fields)), tmp_path / "t.parquet")
        for file in (path, tmp_path / "t.parquet"):
            if fits:
                assert read_throats(file, WELDS, strict=True)[1] == []
            else:
                assert f"the unit is {unit}" in refusal_of(read_throats, file, WELDS)


def one(**changes):
    """A tee with welds on both sides."""
    given = {
        "weld": "web",
        "joint": "tee",
        "sides": ("top", "bottom"),
        "throat": 4.0,
        "penetration": 0.0,
        "line_offset": 0.0,
        "angle_deg": np.nan,
        "root_y": np.nan,
        "root_z": np.nan,
        "lever": "throats",
        "combination": "direction",
        "curve": "c36",
        "curve_shear": "c80",
        "curve_root": None,
    }
    return {"web": WeldThroat(**(given | changes))}


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"throat": 6.1}, "weld web: throat_mm: 6.1 is above 1.5 times the thickness of 4 mm"),
        ({"penetration": 2.1}, "weld web: penetration_mm: 2.1 is above half the thickness of 4 mm"),
        (
            {"joint": "custom", "angle_deg": 0.0, "root_y": 0.0, "root_z": -3.0},
            "weld web: root_z_mm: the centroid of the throat lies -1 mm above the mid-surface",
        ),
    ],
)
def test_a_throat_has_to_fit_its_plate(changes, message):
    """The thinnest place of the plate is what a throat is compared with."""
    xyz = [[0.0, 0.0, 0.0], [10.0, 0.0, 0.0], [20.0, 0.0, 0.0]]
    line = weld_line(np.array(xyz), thickness=np.array([8.0, 4.0, 8.0]))
    line = replace(line, weld="web")
    check_throats(one(throat=6.0, penetration=2.0), [line], "t.csv")
    check_throats({}, [line], "t.csv")
    with pytest.raises(DataError) as refusal:
        check_throats(one(**changes), [line], "t.csv")
    assert f"t.csv: {message}" in str(refusal.value)


def test_doubts(tmp_path):
    """A base plate beyond the line is doubtful, and a throat of a weld that is not assessed is told."""
    table = changed(THROATS, "line_offset_mm", 1, 5.0)
    throats, (warning,) = read_throats(write(tmp_path / "t.csv", table), WELDS, strict=True)
    assert (warning.code, warning.where) == ("line_offset", "t.csv: weld web: line_offset_mm")
    some, (warning,) = assessed_throats(throats, {"web"}, "t.csv")
    assert list(some) == ["web"]
    assert (warning.code, warning.count) == ("throat_not_assessed", 2)
    assert "lap, special" in warning.what
