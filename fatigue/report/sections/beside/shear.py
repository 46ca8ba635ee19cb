"""Shear at the toe: every model of it side by side, at the points where they differ."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from fatigue.report.result import ShownResult
from fatigue.report.sections.cells import Cell, Heading, PageTable, integer, linked, num, text
from fatigue.report.wording import NOT_AVAILABLE, number, whole

MOST = 60  # welds listed

SUMS = ("utilisation", "utilisation_path_range", "utilisation_path_length", "utilisation_path_mlp", "utilisation_asme")
VERDICTS: dict[str, str] = {
    "passes": "passes by every model",
    "fails": "fails by the range of the path",
    "model_dependent": "depends on the model",
    "settled_passes": "passes, proven by a bound",
    "settled_fails": "fails on the normal stress alone",
}
STATUSES: dict[str, str] = {
    "settled_fails": "fail on the normal stress alone",
    "settled_passes": "pass by a proven bound and the ASME factor",
    "fails": "fail by one pair of instants",
    "counted": "had their paths counted",
    "not_counted": "are not decided",
}


def shear(result: ShownResult, links: Mapping[str, str]) -> dict[str, Any]:
    """What the page says of shear at the toes; ``shear`` is None where it was not looked at."""
    nodes = result.nodes
    if "multiaxial_verdict" not in nodes or nodes["multiaxial_verdict"].isna().all():
        return {"shear": None}
    points = worst_by_shear(nodes)
    doubtful = points["weld"][points["multiaxial_verdict"] == "model_dependent"]
    rule = result.record["rules"].get("multiaxial", {})
    toes = rule.get("toe_points", {})
    return {
        "shear": {
            "method": rule.get("method", "report"),
            "decides": rule.get("decides", "the normal stress alone"),
            "alpha": rule.get("alpha"),
            "beta": rule.get("beta"),
            "settled": [f"{whole(number_)} {STATUSES.get(name, name)}" for name, number_ in toes.items()],
            "table": _table(points.head(MOST), links, with_mlp=bool(points["utilisation_path_mlp"].notna().any())),
            "left_out": max(0, len(points) - MOST),
            "model_dependent": doubtful.tolist(),
        }
    }


def worst_by_shear(nodes: pd.DataFrame) -> pd.DataFrame:
    """Of each weld the toe point that shear makes worst, of those with any number; the worst weld first."""
    toes = nodes[nodes["toe"] & nodes["multiaxial_verdict"].notna()]
    sums = toes[list(SUMS)].to_numpy(dtype=np.float64)
    largest = np.nanmax(sums, axis=1, initial=-1.0)
    order = np.lexsort((np.arange(len(toes)), -largest))
    return toes.iloc[order].drop_duplicates("weld")


def _table(points: pd.DataFrame, links: Mapping[str, str], *, with_mlp: bool) -> PageTable:
    """Welds with every sum at their worst point."""
    models = [name for name in SUMS if with_mlp or name != "utilisation_path_mlp"]
    rows = tuple(
        (
            linked(row["weld"], links),
            verdict_cell(row["multiaxial_verdict"]),
            *(num(row[name]) for name in models),
            num(row["multiaxial_bound"]),
            num(row["path_factor_largest"]),
            num(row["path_moment_largest"]),
            text({True: "yes", False: "no"}.get(row["shear_required"])),
            integer(row["node"]),
            text(row["surface"]),
        )
        for row in points.to_dict("records")
    )
    names = {
        "utilisation": "normal stress",
        "utilisation_path_range": "path, range",
        "utilisation_path_length": "path, length",
        "utilisation_path_mlp": "path, moment",
        "utilisation_asme": "ASME factor",
    }
    headings = (
        Heading("weld", numeric=False),
        Heading("shear", numeric=False),
        *(Heading(names[name]) for name in models),
        Heading("bound of range"),
        Heading("path factor"),
        Heading("path moment"),
        Heading("shear required", numeric=False),
        Heading("node"),
        Heading("face", numeric=False),
    )
    return PageTable("shear", headings, rows)


def verdict_cell(verdict: Any) -> Cell:
    """Cell of a verdict about shear: in words, and amber where it depends on the model."""
    words = VERDICTS.get(verdict, NOT_AVAILABLE)
    mark = {"model_dependent": "doubt", "fails": "missed", "settled_fails": "missed"}.get(verdict, "met")
    sign = {"doubt": "△ ", "missed": "✕ ", "met": "✓ "}[mark] if verdict in VERDICTS else ""
    return Cell(f"{sign}{words}", mark=mark)


def shear_facts(point: pd.Series) -> list[tuple[str, str]]:
    """What is known of shear at a point, in words; nothing where it was not looked at."""
    if "multiaxial_verdict" not in point or pd.isna(point["multiaxial_verdict"]):
        return []
    named = (
        ("range", "utilisation_path_range"),
        ("length", "utilisation_path_length"),
        ("moment", "utilisation_path_mlp"),
        ("ASME factor", "utilisation_asme"),
    )
    sums = [f"{name} {number(point[column])}" for name, column in named if pd.notna(point[column])]
    bound = f"range at most {number(point['multiaxial_bound'])} (bound)"
    return [
        ("With shear", VERDICTS[point["multiaxial_verdict"]]),
        ("Utilisation with shear, by", ", ".join([*sums, bound])),
    ]
