"""The weld register: worst points, and lines listed but not assessed."""

import json

import pandas as pd

from fatigue.assess import assess
from fatigue.case import load_case
from fatigue.pipeline.count.worst import EQUAL
from fatigue.readers.neutral.register.register_file import register_text
from fatigue.readers.neutral.register.weld_register import REGISTER, RegisterRow
from fatigue.results.summary import result_summary
from tests.small_case import small_case


def test_every_weld_is_listed_with_its_worst_toe_point(small_result):
    """The register repeats the row of the worst toe point of every weld, the first of those equal but for rounding."""
    welds = pd.read_parquet(small_result / "welds.parquet").set_index("weld")
    nodes = pd.read_parquet(small_result / "nodes.parquet")
    for weld, row in welds.iterrows():
        points = nodes[(nodes.weld == weld) & nodes.toe]
        worst = points[points.utilisation >= EQUAL * points.utilisation.max()].iloc[0]
        assert (row.worst_node, row.worst_surface) == (worst.node, worst.surface)
        assert (row.life_km, row.load_factor, row.governing_event) == (
            worst.life_km,
            worst.load_factor,
            worst.governing_event,
        )
        assert (row.nodes, row.length_mm, row.thickness_min_mm) == (7, 60.0, 8.0)
        assert (row.curve, row.survival, row.status) == ("master-aluminium", "mean-2sigma", "assessed")


def test_lines_listed_but_not_assessed_keep_a_row_with_the_reason(tmp_path):
    """An excluded line of the converter's register is in the result, in the inputs, and decides nothing."""
    case = small_case().write(tmp_path / "case")
    rows = [
        RegisterRow("A", "line_1", "assess", "", "tee", "1/2", 1, 7, 60.0, 8.0),
        RegisterRow("seam", "line_2", "excluded", "no weld, bent sheet", "fold", "3", 3, 9, 80.0, 4.0),
        RegisterRow("edge", "line_3", "candidate", "", "flat", "3/4", 3, 5, 40.0, 4.0),
    ]
    (case.parent / REGISTER).write_text(register_text(rows))
    assess(load_case(case), tmp_path / "result", report=False)
    welds = pd.read_parquet(tmp_path / "result" / "welds.parquet").set_index("weld")
    assert welds.status.to_dict() == {"A": "assessed", "B": "assessed", "seam": "excluded", "edge": "excluded"}
    assert welds.loc["seam", "reason"] == "no weld, bent sheet"
    assert welds.loc["edge", "reason"] == "candidate"
    assert pd.isna(welds.loc["seam", "life_km"])
    record = json.loads((tmp_path / "result" / "provenance.json").read_text())
    assert REGISTER in {entry["file"] for entry in record["inputs"]}
    assert set(result_summary(tmp_path / "result", top=3).welds.weld) == {"A", "B"}
