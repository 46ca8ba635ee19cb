"""The page of a point: at a worst point what the report shows of it, figure by figure and cell by cell."""

import re

import pytest

from fatigue.diagnose import diagnose
from fatigue.point.page.story import point
from fatigue.report.page import report_page
from tests.point.cases import result_of
from tests.report.reading import Page, values
from tests.small_case import small_case

FIGURES = ("matrix", "exceedance", "sn", "history", "psd", "damage-modes", "damage-bands", "track")


@pytest.fixture(scope="module")
def pages(tmp_path_factory):
    """The report of a diagnosed result, and the page of the worst point of its first weld; ids begin with its own."""
    folder = tmp_path_factory.mktemp("pages")
    case = small_case(seconds=12.0)
    case.spectrum["segment_s"] = 1.0
    result = result_of(case.write(folder / "case"), folder / "result")
    diagnose(result)
    report = report_page(result)
    first = re.search(r'id="(weld-1)".*?<bdi>(\w+)</bdi>', report, re.DOTALL)
    point(result, first[2], output=folder / "page.html")
    return Page(report), Page((folder / "page.html").read_text(encoding="utf-8"))


@pytest.mark.parametrize("figure", FIGURES)
def test_figures_are_those_of_the_report(pages, figure):
    """The same data in the same axes."""
    report, page = pages
    of_report, of_point = report.figures[f"weld-1-{figure}"], page.figures[figure]
    assert of_point["layout"] == of_report["layout"]
    assert len(of_point["data"]) == len(of_report["data"])
    for one, other in zip(of_point["data"], of_report["data"], strict=True):
        assert one.keys() == other.keys()
        for axis in {"x", "y", "z"} & one.keys():
            if values(one[axis]).dtype.kind == "f":
                assert values(one[axis]) == pytest.approx(values(other[axis]), rel=1e-6, nan_ok=True)
            else:
                assert list(values(one[axis])) == list(values(other[axis]))


@pytest.mark.parametrize("table", ["events", "levers", "variants"])
def test_tables_are_those_of_the_report(pages, table):
    """Every cell."""
    report, page = pages
    assert page.tables[table] == report.tables[f"weld-1-{table}"]
    assert len(page.tables[table]) > 2


def test_facts_and_reasons_are_those_of_the_report(pages):
    """In the same words."""
    report, page = pages
    for name in ("Largest range", "Equivalent range at 2e6", "Life by Dirlik", "Trust in Dirlik"):
        fact = re.search(rf"{name} (.*?) (?=[A-Z][a-z]+ )", report.words)[0]
        assert fact in page.words
    for sentence in re.findall(r"Dirlik over rainflow .*?0\.\d+ Hz\.", report.words)[:1]:
        assert sentence in page.words
    assert "One percent more changes the life by: load" in page.words


def test_only_the_page_has_these(pages):
    """The point on its weld, the next cycles, both domains, every number with unit and meaning, what was compared."""
    _, page = pages
    assert {"along", "close-by", "methods", "domain-ranges"} <= page.figures.keys()
    named = [trace.get("name") for trace in page.figures["along"]["data"]]
    assert "this point, top face" in named or "this point, bottom face" in named
    numbers = {row[0]: row for row in page.tables["numbers"][1:]}
    assert numbers["thickness_mm"][1:3] == ["8.000", "mm"]
    assert "Miner sum per km of the mission" in numbers["damage_per_km"][3]
    assert len(page.tables["worst-cycles"]) == 13
    assert page.tables["both-domains"][1][-1] != ""
    assert page.words.count("✓ agrees") == 7
    assert "✕ differs" not in page.words


def test_numbers_of_both_domains_belong_together(pages):
    """The bars of all events together are the damage of the point: counted 100 %, of Dirlik his ratio."""
    _, page = pages
    bars = {trace["name"]: values(trace["y"]) for trace in page.figures["methods"]["data"]}
    assert bars["rainflow"][-1] == pytest.approx(1.0)
    assert bars["rainflow"][:-1].sum() == pytest.approx(1.0, rel=1e-6)
    rows = page.tables["numbers"]
    ratio = float(next(row[1] for row in rows if row[0] == "dirlik_ratio"))
    assert bars["Dirlik"][-1] / bars["rainflow, one bending ratio"][-1] == pytest.approx(ratio, rel=1e-3)


def test_it_asks_for_nothing(pages):
    """No address of another file or server."""
    _, page = pages
    links = [given.get("href") or given.get("src") for _, given in page.tags]
    assert all(link.startswith("#") for link in links if link)


def test_a_name_that_would_be_a_script(tmp_path):
    """Names stand on the page as texts."""
    case = small_case(seconds=6.0)
    name = "<script>alert(1)</script>"
    for table in (case.welds, case.weld_nodes, case.nodal_forces):
        table["weld"] = table["weld"].replace("A", name)
    result = result_of(case.write(tmp_path / "case"), tmp_path / "result")
    found = point(result, name, order=2, output=tmp_path / "page.html")
    assert "<script>alert" not in (tmp_path / "page.html").read_text(encoding="utf-8")
    assert name in found.as_text()
