"""Quality data travel from the welds table and the register into the result, with the category of the stress."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow.parquet as pq
import pytest

from fatigue.assess import assess
from fatigue.case import load_case
from fatigue.errors import CaseError
from fatigue.life.quality import shipped_categories
from fatigue.pipeline.tables.register import quality_rows
from fatigue.readers.neutral.body.welds import Weld
from fatigue.readers.neutral.register.conversion import ConvertRecord
from fatigue.readers.neutral.register.register_file import open_register, register_text
from fatigue.readers.neutral.register.registered import registered
from fatigue.readers.neutral.register.weld_register import Register, RegisterRow, contradictions, merged
from fatigue.results.weld_table import read_welds
from tests.small_case import small_case

LIMITS = "[checks.stress_category]\nmedium_from = {}\nhigh_from = {}\nsource = 'house rule 7'\n"


def weld(name="A", **quality):
    """A weld with quality data."""
    return Weld(name, False, "both", None, None, "", **quality)


def test_the_larger_utilisation_gives_the_category():
    """Toe or check, whichever is larger; a check that was not made says nothing, and neither does a missing factor."""
    welds = [weld(str(k)) for k in range(5)]
    factor = np.array([2.0, 1.25, np.inf, np.nan, np.nan])
    checks = np.array([np.nan, 0.95, 0.8, 0.76, np.nan])
    rows = quality_rows(welds, factor, checks, shipped_categories())
    assert rows["stress_utilisation"].tolist()[:4] == [0.5, 0.95, 0.8, 0.76]
    assert rows["stress_category"] == ["low", "high", "medium", "medium", None]
    assert quality_rows(welds, factor, None, shipped_categories())["stress_category"][1] == "medium"


def with_quality(**more):
    """The small case with quality data of its first weld."""
    case = small_case()
    case.welds["joint_type"] = ["fillet, tee", ""]
    case.welds["performance_class"] = ["CP C2", ""]
    case.welds["inspection_class"] = ["CT 3", ""]
    for name, value in more.items():
        case.welds.loc[0, name] = value
    return case


def assessed(case, folder):
    """Assess a case; give its table of welds and its provenance."""
    done = assess(load_case(case.write(folder / "case")), folder / "result", report=False)
    record = json.loads((folder / "result" / "provenance.json").read_text())
    return read_welds(folder / "result").set_index("weld"), record, done


def test_from_the_welds_table_into_the_result(tmp_path):
    """As given, empty where nothing is given; category, number and rule stand in the result, unit and meaning too."""
    welds, record, done = assessed(with_quality(), tmp_path)
    assert welds.loc["A", ["joint_type", "performance_class", "inspection_class"]].tolist() == [
        "fillet, tee", "CP C2", "CT 3",
    ]  # fmt: skip
    assert welds.loc["B", ["joint_type", "performance_class", "inspection_class"]].isna().all()
    assert np.allclose(welds.stress_utilisation, 1 / welds.load_factor)
    assert welds.stress_category.tolist() == shipped_categories().of(welds.stress_utilisation.to_numpy())
    assert record["rules"]["stress_category"]["limits"] == [0.75, 0.9]
    assert record["rules"]["stress_category"]["status"] == "unverified"
    assert "unknown_class" not in {problem.code for problem in done.warnings}
    meta = pq.read_schema(tmp_path / "result" / "welds.parquet").field("stress_category").metadata
    assert b"provenance" in b"".join(meta.values())


def test_limits_of_the_case(tmp_path):
    """Other limits change the category and nothing else, and are said to be the user's."""
    case = with_quality()
    case.extra = LIMITS.format(1e-6, 1e6)
    welds, record, _ = assessed(case, tmp_path)
    assert set(welds.stress_category) == {"medium"}
    assert record["rules"]["stress_category"] == {
        "names": ["low", "medium", "high"], "limits": [1e-6, 1e6], "source": "house rule 7", "status": "user",
    }  # fmt: skip


def test_limits_in_the_wrong_order_are_refused(tmp_path):
    """The key and its value are named."""
    case = small_case()
    case.extra = LIMITS.format(0.9, 0.75)
    with pytest.raises(CaseError, match=r"stress_category.*high_from.*0.75 is not above medium_from = 0.9"):
        load_case(case.write(tmp_path))


def test_unknown_classes_are_one_warning_of_each_kind(tmp_path):
    """They are told with the known ones, and kept as they are given."""
    case = with_quality(performance_class="CP X")
    case.welds.loc[1, "performance_class"] = "E9"
    welds, _, done = assessed(case, tmp_path)
    (found,) = [problem for problem in done.warnings if problem.code == "unknown_class"]
    assert "'CP X' of A" in found.what
    assert "'E9' of B" in found.what
    assert "CP C1" in found.what
    assert (found.count, found.where) == (2, "welds.csv: column performance_class")
    assert welds.loc["A", "performance_class"] == "CP X"


def register(folder, *rows):
    """Write a register with quality columns beside the case."""
    columns = ["weld", "line", "status", "joint_type", "performance_class", "inspection_class"]
    pd.DataFrame(rows, columns=columns).to_csv(folder / "welds_register.csv", index=False)


def test_the_register_wins_over_the_table(tmp_path):
    """What the register gives holds; what it leaves open is that of the table; an excluded weld keeps its own."""
    path = with_quality().write(tmp_path / "case")
    register(path.parent, ("A", "A", "assess", "", "CP B1", ""), ("B", "B", "excluded", "butt", "", "CT 4"))
    assess(load_case(path), tmp_path / "result", report=False)
    welds = read_welds(tmp_path / "result").set_index("weld")
    columns = ["joint_type", "performance_class", "inspection_class"]
    assert welds.loc["A", columns].tolist() == ["fillet, tee", "CP B1", "CT 3"]
    assert welds.loc["B", columns].fillna("").tolist() == ["butt", "", "CT 4"]
    assert pd.isna(welds.loc["B", "stress_category"])


def line(name, **quality):
    """A line of weld W in a register."""
    return RegisterRow("W", name, "assess", "", "tee", "1/2", 1, 5, 40.0, 6.0, **quality)


def test_lines_of_one_weld_have_one_class():
    """Two different ones contradict each other, one and none are one; the weld has what any of its lines has."""
    for column in ("joint_type", "performance_class", "inspection_class"):
        (found,) = contradictions([line("a", **{column: "x"}), line("b", **{column: "y"})], "register.csv: weld W")
        assert found.what == f"its lines have different {column}: x (line a) and y (line b)"
        rows = (line("a"), line("b", **{column: "y"}))
        assert not list(contradictions(rows, ""))
        conversion = ConvertRecord({"old": {"a": np.nan, "b": np.nan}})
        done = registered(Register(Path("r.csv"), rows), [weld("old", **{column: "z"})], conversion, ())
        assert getattr(done.welds[0], column) == "y"


def test_the_register_keeps_them(tmp_path):
    """Written where a weld has some, read back, carried over to the next conversion; else there are no such columns."""
    given = replace(line("a", joint_type="lap, one side", inspection_class="CT 2"), others={})
    path = tmp_path / "r.csv"
    path.write_text(register_text([given, line("b")]))
    read = open_register(path, strict=True)
    assert [(row.joint_type, row.performance_class, row.inspection_class) for row in read.rows] == [
        ("lap, one side", "", "CT 2"), ("", "", ""),
    ]  # fmt: skip
    rows, warnings = merged([line("a"), line("b")], read)
    assert rows[0].joint_type == "lap, one side"
    assert not warnings
    assert "joint_type" not in register_text([line("b")])
