"""Unit loads in the folder of a conversion: forces per unit, the first case, the record and what is said of them."""

import json
import tomllib
from dataclasses import replace

import numpy as np
import pyarrow.parquet as pq
import pytest

from fatigue.assess import assess
from fatigue.case import load_case
from fatigue.errors import DataError
from fatigue.readers.convert.convert import convert
from fatigue.readers.convert.loads.names import LoadName
from tests.readers.static_files import MODES, static_files
from tests.readers.tee_model import tee
from tests.readers.unit_loads import unit_loads


def test_forces_are_those_of_the_model_per_unit(tmp_path):
    """On the node, in basic axes, over the amount applied; the modes' table has the modes alone."""
    options = replace(static_files(tmp_path), unit_load_names=(LoadName(2, "coupler", -4.0, "kN"),))
    done = convert(options)
    assert (done.modes, [load.name for load in done.unit_loads]) == (
        5,
        ["tunnel_pressure", "coupler", "load_1_g_vertical"],
    )
    modes = pq.read_table(options.out / "element_forces.parquet")
    assert set(modes["mode"].to_pylist()) == {1, 2, 3, 4, 5}
    found = pq.read_table(options.out / "unit_loads.parquet").to_pandas()
    assert list(found)[:3] == ["unit_load", "node", "element"]
    for name, case, amount in zip(("tunnel_pressure", "coupler"), unit_loads(), (1.0, -4.0), strict=False):
        wanted = -tee().model.element_forces(case.displacement) / amount
        part = found[found["unit_load"] == name]
        assert len(part) * 5 == modes.num_rows
        for row in part.itertuples():
            corner = (tee().model.quads[row.element - 1] + 1).tolist().index(row.node)
            assert (row.fx_N, row.fy_N, row.fz_N) == pytest.approx(wanted[row.element - 1, corner, :3], abs=1e-9)


def test_the_first_case_names_them(tmp_path):
    """With the unit, or the subcase where nobody gave one; what no event gives is there to be uncommented."""
    options = replace(static_files(tmp_path), unit_load_names=(LoadName(1, "p", 5.0, "kPa"),))
    convert(options)
    text = (options.out / "case.toml").read_text()
    loads = tomllib.loads(text)["body"]["unit_load"]
    assert [(load["name"], load["unit"]) for load in loads] == [
        ("p", "kPa"),
        ("coupler_draft", "subcase 2"),
        ("load_1_g_vertical", "subcase 3"),
    ]
    assert {load["element_forces"] for load in loads} == {"unit_loads.parquet"}
    assert {load["when_missing"] for load in loads} == {"error"}
    assert '# subcase 1 "TUNNEL PRESSURE", run with 5 kPa' in text
    assert '# subcase 2 "Coupler, draft"; EDIT the unit: one is the load as it was run' in text
    at = text.index("# [[mission.unit_load]]")
    full = text[:at] + text[at:].replace("# ", "")
    assert [load["name"] for load in tomllib.loads(full)["mission"]["unit_load"]] == [load["name"] for load in loads]


def test_what_is_said_of_them(tmp_path):
    """Units that nobody gave, and loads that no event gives, each once."""
    done = convert(static_files(tmp_path))
    found = {w.code: w for w in done.warnings if w.code.startswith("unit_load")}
    assert found["unit_load_unit"].count == found["unit_load_not_given"].count == 3
    assert "--unit-load-name 1 tunnel_pressure AMOUNT UNIT" in found["unit_load_unit"].remedy
    given = replace(
        static_files(tmp_path, columns=(*MODES, "u_a", "u_b", "u_c")),
        unit_load_names=tuple(LoadName(k, name, 1.0, "kN") for k, name in ((1, "a"), (2, "b"), (3, "c"))),
    )
    done = convert(given)
    assert not [w for w in done.warnings if w.code.startswith("unit_load")]
    assert "mission.unit_load" not in (given.out / "case.toml").read_text()


def test_the_record_has_what_they_were_made_of(tmp_path):
    """Name, unit, amount, subcase, file and titles; the command that would do it again names them."""
    options = replace(static_files(tmp_path), unit_load_names=(LoadName(1, "p", 5.0, "kPa"),))
    convert(options)
    record = json.loads((options.out / "convert.json").read_text())
    assert record["unit_loads"][0] == {
        "name": "p",
        "unit": "kPa",
        "is_unit_known": True,
        "amount": 5.0,
        "subcase": 1,
        "file": str(tmp_path / "static.op2"),
        "title": "CAR BODY",
        "subtitle": "TUNNEL PRESSURE",
        "label": "",
    }
    assert "unit_loads.parquet" in record["files"]
    words = record["command"]
    at = words.index("--unit-load-name")
    assert words[at : at + 5] == ["--unit-load-name", "1", "p", "5.0", "kPa"]


def test_a_case_that_is_kept_is_asked_for_its_loads(tmp_path):
    """Loads that it does not name are told."""
    options = static_files(tmp_path)
    convert(replace(options, static_subcases="leave_out"))
    kept = replace(options, keep_case=True)
    (told,) = [w for w in convert(kept).warnings if w.code == "unit_load_not_in_case"]
    assert "the case that is kept does not name unit loads tunnel_pressure, coupler_draft" in told.what
    case = options.out / "case.toml"
    for text in ("[body", "body = 3", "[body]\nunit_load = [3]"):
        case.write_text(text)
        assert [w for w in convert(kept).warnings if w.code == "unit_load_not_in_case"]


def test_forces_of_the_modes_do_not_change(tmp_path):
    """The table of the modes is the same to the last bit with and without loads beside them."""
    options = static_files(tmp_path)
    convert(options)
    before = pq.read_table(options.out / "element_forces.parquet")
    alone = replace(options, unit_loads=(), out=tmp_path / "alone")
    convert(alone)
    after = pq.read_table(alone.out / "element_forces.parquet")
    assert before.equals(after)
    assert np.array_equal((options.out / "modes.csv").read_bytes(), (alone.out / "modes.csv").read_bytes())


def test_the_case_is_assessed_once_its_loads_are_given(tmp_path):
    """The lines at its end uncommented: every load is in the stresses, under its name."""
    options = static_files(tmp_path)
    convert(options)
    case = options.out / "case.toml"
    text = case.read_text()
    with pytest.raises(DataError, match="the unit load 'tunnel_pressure' is not given"):
        assess(load_case(case), tmp_path / "result", threads=1, report=False)
    at = text.index("# [[mission.unit_load]]")
    case.write_text(text[:at] + text[at:].replace("# ", ""))
    assess(load_case(case), tmp_path / "result", threads=1, report=False)
    stress = pq.read_table(tmp_path / "result" / "structural_stress.parquet").to_pandas()
    own = stress.dropna(subset="unit_load")
    assert set(own["unit_load"]) == {"tunnel_pressure", "coupler_draft", "load_1_g_vertical"}
    assert own["mode"].isna().all()
    assert (own.groupby("unit_load")["membrane_MPa"].max() > 0.0).all()
