"""Doubts about lines and mesh travel from the files into ``check``, the results, the report and ``show``."""

import json

import numpy as np
import pandas as pd
import pytest

from fatigue.assess import assess
from fatigue.check import check_case
from fatigue.results.summary import result_summary
from tests.small_case import SPACING, THICKNESS, small_case

QUIET = {"end_unresolved", "few_segments", "sampling", "no_spectrum"}  # of short records and lines


def with_mesh(case, folder):
    """Write a case with a row of shells behind each weld, of the plate's thickness."""
    nodes = case.weld_nodes[["node", "x_mm", "y_mm", "z_mm"]].copy()
    behind = nodes.assign(node=nodes.node + 1000, y_mm=nodes.y_mm - SPACING)
    rows = [
        {"element": i, "n1": a + 1000, "n2": b + 1000, "n3": b, "n4": a, "thickness_mm": THICKNESS}
        for i, (a, b) in enumerate(zip(nodes.node, nodes.node[1:], strict=False), start=1)
        if b == a + 1
    ]
    case.body |= {"nodes": "nodes.csv", "elements": "elements.csv"}
    path = case.write(folder)
    pd.concat([nodes, behind]).to_csv(folder / "nodes.csv", index=False)
    pd.DataFrame(rows).to_csv(folder / "elements.csv", index=False)
    return path


def change(folder, file, **columns):
    """Multiply columns of a table that is written already."""
    table = pd.read_csv(folder / file)
    for name, factor in columns.items():
        table[name] = table[name] * factor
    table.to_csv(folder / file, index=False)


def codes(warnings):
    """Codes of warnings that are about the body."""
    return {w.code for w in warnings} - QUIET


def bent_case():
    """Weld A turns by 90 degrees at its fourth node, and is loaded there alone."""
    case = small_case()
    of_a = (case.weld_nodes.weld == "A").to_numpy()
    step = SPACING * np.arange(7)
    outward = np.repeat([[0.0, 1.0], [-1.0, 1.0], [-1.0, 0.0]], [3, 1, 3], axis=0)
    case.weld_nodes.loc[of_a, "x_mm"] = np.minimum(step, 3 * SPACING)
    case.weld_nodes.loc[of_a, "y_mm"] = np.maximum(step - 3 * SPACING, 0.0)
    case.weld_nodes.loc[of_a, ["outward_x", "outward_y"]] = outward
    forces = case.nodal_forces
    elsewhere = (forces.weld == "A") & (forces.node != 103)
    forces.loc[elsewhere, [c for c in forces if c[0] in "fm" and c != "mode"]] = 0.0
    return case


def test_a_case_that_agrees_with_its_mesh_is_silent(tmp_path):
    """Weld tables, nodes and elements of one model."""
    assert codes(check_case(with_mesh(small_case(), tmp_path)).warnings) == set()


@pytest.mark.parametrize(
    ("file", "columns", "code", "words"),
    [
        ("weld_nodes.csv", {"thickness_mm": 2.0}, "other_thickness", "thickness_mm is 16, and 8 in elements.csv"),
        ("weld_nodes.csv", {"x_mm": 1.5, "y_mm": 1.5}, "moved_in_mesh", "1.5 times as long here"),
        ("elements.csv", {"thickness_mm": 1 / 25.4}, "other_thickness", "elements.csv looks like inches"),
        ("nodes.csv", {"x_mm": 1e-3, "y_mm": 1e-3}, "moved_in_mesh", "nodes.csv looks like m"),
        ("weld_nodes.csv", {"outward_y": -1.0}, "outward_into_plate", "points into the nearest shell"),
    ],
)
def test_tables_that_contradict_the_mesh(tmp_path, file, columns, code, words):
    """``check`` and ``assess`` say so, once for each weld, and the results keep it."""
    path = with_mesh(small_case(), tmp_path)
    change(tmp_path, file, **columns)
    checked = [w for w in check_case(path).warnings if w.code not in QUIET]
    assert [w.code for w in checked] == [code, code]
    assert words in checked[0].what
    if code == "other_thickness" and file == "weld_nodes.csv":
        assess(path, tmp_path / "result", threads=1, report=False)
        record = json.loads((tmp_path / "result" / "provenance.json").read_text())
        assert [w["code"] for w in record["warnings"]].count(code) == 2


def test_a_thickness_confirmed_in_the_register_is_silent(tmp_path):
    """The register gives the weld that thickness, and nobody asks again."""
    path = with_mesh(small_case(), tmp_path)
    rows = [("A", "A", "assess", 16.0, "true"), ("B", "B", "assess", "", "")]
    columns = ["weld", "line", "status", "thickness_mm", "confirmed"]
    pd.DataFrame(rows, columns=columns).to_csv(tmp_path / "welds_register.csv", index=False)
    assert codes(check_case(path).warnings) == set()
    change(tmp_path, "weld_nodes.csv", thickness_mm=2.0)
    (warning,) = [w for w in check_case(path).warnings if w.code not in QUIET]
    assert warning.code == "other_thickness"
    assert "weld B," in warning.where


def test_a_corner_of_summed_forces_is_told_everywhere(tmp_path):
    """Before the run, at the point, at the weld it governs, on page one, and in what ``show`` prints."""
    path = bent_case().write(tmp_path)
    (warning,) = [w for w in check_case(path).warnings if w.code == "summed_corner"]
    assert "weld A, node 103 (90 degrees)" in warning.where
    assert "(life x 3.49)" in warning.what
    folder = tmp_path / "result"
    found = assess(path, folder, threads=1)
    assert {"summed_corner", "worst_at_corner"} <= {w.code for w in found.warnings}
    nodes, welds = (pd.read_parquet(folder / f"{name}.parquet") for name in ("nodes", "welds"))
    assert set(nodes.loc[nodes.summed_corner, "node"]) == {103}
    assert (nodes.summed_corner <= nodes.at_corner).all()
    assert welds.set_index("weld").worst_summed_corner.to_dict() == {"A": True, "B": False}
    (worst,) = [w for w in found.warnings if w.code == "worst_at_corner"]
    life = welds.set_index("weld").life_km["A"]
    assert worst.where.startswith("weld A, node 103, ")
    assert f"its life of {life:.4g} km is no lower bound" in worst.what
    assert "Worst at a corner whose nodal forces are one sum of both legs" in result_summary(folder).as_text()
    page = (folder / "report.html").read_text()
    assert page.count("corner, summed") >= 2
    assert "summed corner</a>:" in page
    assert "corner whose nodal forces are one sum of both legs" in page
