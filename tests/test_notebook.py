"""The notebook of the examples runs from its first cell to its last on the shipped example, and shows what it says."""

import ast
import json
from pathlib import Path

import pandas as pd
import plotly.graph_objects as go
import pytest

from fatigue.point.result import Result

NOTEBOOK = Path(__file__).parents[1] / "examples" / "notebook" / "result.ipynb"


def shown(code: str, names: dict[str, object]) -> object:
    """Run a cell and return what it shows, the value of its last line."""
    *lines, last = ast.parse(code).body
    exec(compile(ast.Module(lines, []), NOTEBOOK.name, "exec"), names)
    assert isinstance(last, ast.Expr)
    return eval(compile(ast.Expression(last.value), NOTEBOOK.name, "eval"), names)


@pytest.fixture
def cells():
    """Code of the cells."""
    notebook = json.loads(NOTEBOOK.read_text(encoding="utf-8"))
    assert notebook["nbformat"] == 4
    assert all(cell["cell_type"] == "code" and not cell["outputs"] for cell in notebook["cells"])
    return ["".join(cell["source"]) for cell in notebook["cells"]]


def test_the_notebook_runs(cells, example_result, monkeypatch):
    """Five cells: a result, two figures, ranges as assessed, cycles that add up to the damage."""
    monkeypatch.chdir(example_result.parent)
    names: dict[str, object] = {}
    result, along, history, ranges, classes = [shown(code, names) for code in cells]
    assert isinstance(result, Result)
    assert "miss the target of" in result._repr_html_()
    assert isinstance(along, go.Figure)
    assert isinstance(history, go.Figure)
    worst = names["worst"]
    key = f"weld == '{worst['weld']}' and order == 3"
    damage = pd.read_parquet(example_result / "damage.parquet").query(key)
    for face in ("top", "bottom"):
        expected = damage[damage["surface"] == face].set_index("event")["max_range_MPa"]
        assert ranges[f"structural_{face}_MPa"].to_numpy() == pytest.approx(
            expected[ranges.index].to_numpy(), rel=1e-12
        )
    nodes = pd.read_parquet(example_result / "nodes.parquet").query(key)
    decides = nodes.loc[nodes["utilisation"].idxmax()]
    assert names["cycles"]["damage_at_target"].sum() == pytest.approx(decides["utilisation"], rel=1e-9)
    assert classes["damage_at_target"].is_monotonic_decreasing
