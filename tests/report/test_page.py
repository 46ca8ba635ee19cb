"""The report as a whole: what it says, what it leaves out and why, what no input may do to it."""

import json
import re
import unicodedata

import numpy as np
import pandas as pd
import pytest

from fatigue.errors import DataError
from fatigue.report.page import report_page, write_report
from fatigue.report.wording import life, result
from tests.report.reading import Page, values
from tests.report.tiny_result import TARGET_KM, Recipe, write_result

HOSTILE = (
    "<script>alert(1)</script>",
    "</script><img src=x onerror=alert(1)>",
    '" onmouseover="alert(1)',
    "../../etc/passwd",
    "=1+1",
    "שלום עולם",
    "%{x} {{ 7 * 7 }} ${HOME}",
    "<b>bold</b> & <a href='javascript:alert(1)'>link</a>",
    "x" * 300,
    "two\nlines\u2028more",
)


def made(tmp_path, **recipe):
    """Page of a result with this recipe."""
    return Page(report_page(write_result(tmp_path, Recipe(**recipe))))


def test_the_first_words_are_the_verdict(page):
    """Fulfilled or not, how many welds, the target in km and years."""
    assert "Target not fulfilled" in page.words
    assert "1 of 2 welds misses the target of 12 000 000 km (24 years at 500 000 km per year)" in page.words


def test_worst_welds_equal_the_register(page, result_folder):
    """Every number of the table of welds is that of welds.parquet, worst weld first; three digits, millions."""
    welds = pd.read_parquet(result_folder / "welds.parquet").sort_values("utilisation", ascending=False)
    rows = page.tables["worst-welds"][1:]
    for row, (_, weld) in zip(rows, welds.iterrows(), strict=True):
        lives = [weld["life_km"] / 1e6, weld["life_years"]]
        expected = [*map(life, lives), *map(result, weld[["utilisation", "load_factor"]])]
        assert row[0] == weld["weld"]
        assert row[2:6] == expected
        assert row[6] == str(weld["worst_node"])


def test_worst_hot_spots_are_points_of_the_table_of_nodes(page, result_folder):
    """One of each face of each weld, whose damage falls along the line: the worst toe point there with its life."""
    nodes = pd.read_parquet(result_folder / "nodes.parquet")
    worst = nodes.loc[nodes[nodes["toe"]].groupby(["weld", "surface"])["utilisation"].idxmax()]
    worst = worst.sort_values("utilisation", ascending=False, kind="stable")
    rows = page.tables["worst-ten"][1:]
    assert len(rows) == 4
    for row, (_, point) in zip(rows, worst.iterrows(), strict=True):
        assert row[1:3] == [point["weld"], point["surface"]]
        assert row[4:7] == [str(point["node"]), life(point["life_km"] / 1e6), life(point["life_years"])]


def test_life_along_the_weld_equals_the_table(page, result_folder):
    """The drawn lives of both faces are those of nodes.parquet in single precision."""
    nodes = pd.read_parquet(result_folder / "nodes.parquet")
    of_weld = nodes[nodes["weld"] == "W1 bracket"]
    drawn = [t for t in page.figures["weld-1-along"]["data"] if t["name"].endswith("face")]
    for face, trace in zip(("top", "bottom"), (t for t in drawn if t.get("yaxis") is None), strict=True):
        expected = of_weld.loc[of_weld["surface"] == face, "life_km"].to_numpy(dtype=np.float32)
        np.testing.assert_array_equal(values(trace["y"]), expected)


def test_all_figures_of_the_page_are_numbered_in_reading_order(html):
    """Figure 1, 2, 3 ... from top to bottom."""
    numbers = [int(n) for n in re.findall(r"<b>Figure (\d+)</b>", html)]
    assert numbers == list(range(1, len(numbers) + 1))


def test_the_page_needs_nothing_but_itself(page, html):
    """No element that loads anything, one copy of plotly.js, no upload button."""
    assert not [t for t, a in page.tags if t in ("link", "img", "iframe", "object", "embed", "base")]
    assert not [a for t, a in page.tags if "src" in a or a.get("href", "#")[0] != "#"]
    assert html.count("plotly.js v") == 1
    assert '"showSendToCloud":false' in html
    assert '"displaylogo":false' in html


def test_the_same_result_gives_the_same_bytes(result_folder, html):
    """No clock and no chance in the page."""
    assert report_page(result_folder) == html


def test_what_was_assumed_and_where_it_comes_from_is_on_the_page(page):
    """Curve with edition, survival, thickness rule, residue, ends, hashes, versions."""
    for words in (
        "97.7 % survival",
        "edition 2007",
        "actual plate thickness",
        "every cycle closes",
        "mean over the plate",
    ):
        assert words in page.words
    assert any(re.fullmatch(r"[0-9a-f]{64}", cell) for row in page.tables["inputs"] for cell in row)
    assert "numpy 2.4.6" in page.words


def test_every_weld_is_in_the_register(page):
    """Register rows carry status, length, plate and curve."""
    rows = page.tables["weld-register"]
    assert [row[0] for row in rows[1:]] == ["W1 bracket", "W2 hanger"]
    assert all("assessed" in row for row in rows[1:])


def test_units_are_in_the_axes_and_columns(page):
    """Every axis title of every figure names its unit, except that of names."""
    for name, fig in page.figures.items():
        for axis, given in fig["layout"].items():
            title = given.get("title", {}).get("text", "") if axis.startswith(("xaxis", "yaxis")) else ""
            assert not title or "[" in title, f"{name}: {title}"
    assert "life [million km]" in page.tables["worst-welds"][0]
    assert "life [years]" in page.tables["worst-welds"][0]


def test_recomputed_checks_agree(page):
    """Damage from the listed cycles and from the events is that of the table."""
    assert page.words.count("✓ agrees") == 2
    assert "✕ differs" not in page.words


def test_a_spoiled_result_is_noticed(tmp_path):
    """A life that its own cycles contradict is marked on the page."""
    folder = write_result(tmp_path)
    nodes = pd.read_parquet(folder / "nodes.parquet")
    nodes["damage_per_km"] *= 1.01
    nodes.to_parquet(folder / "nodes.parquet")
    assert "✕ differs" in Page(report_page(folder)).words


def test_lives_under_other_assumptions(page):
    """Mean curve above, mean minus three sigma below, and the used choices at factor 1."""
    rows = {row[1]: row for row in page.tables["weld-1-variants"][1:]}
    assert rows["mean-2sigma (used)"][4] == "1.00"
    assert float(rows["mean"][4]) < 1.0 < float(rows["mean-3sigma"][4])
    assert float(rows["ASME, at least 16 mm"][4]) > 1.0


def test_no_name_can_harm_the_page(tmp_path):
    """Markup, scripts, templates, paths and other writing are shown as they are, and add no element to the page."""

    def build(folder, names):
        doubts = tuple({"code": "doubt", "where": n, "what": n, "remedy": n} for n in names)
        recipe = Recipe(names, 2, names, title=" ".join(names), description=names[0], warnings=doubts)
        return Page(report_page(write_result(tmp_path / folder, recipe)))

    page = build("hostile", HOSTILE)
    plain = build("plain", tuple(f"name {i}" for i in range(len(HOSTILE))))
    assert [tag for tag, _ in page.tags] == [tag for tag, _ in plain.tags]
    assert not [given for _, given in page.tags if any(key.startswith("on") for key in given)]
    assert {row[0] for row in page.tables["weld-register"][1:]} == {name.strip() for name in HOSTILE}
    for fig in page.figures.values():
        assert "<script" not in json.dumps(fig)
        assert "<a " not in json.dumps(fig)
        assert "<b>" not in json.dumps(fig)


def test_nothing_damaged_at_all(tmp_path):
    """Infinite lives are written as beyond 1e12 km; nothing says inf, nan or none."""
    page = made(tmp_path, level=0.0)
    assert "Target fulfilled" in page.words
    assert "> 1e12" in page.tables["worst-welds"][1]
    assert not re.search(r"\b(inf|infinity|nan|NaN|None|null)\b", page.words)


def test_everything_damaged(tmp_path):
    """Ranges far beyond the curve give short lives and a page that says so."""
    page = made(tmp_path, level=3000.0)
    assert "Target not fulfilled" in page.words
    assert not re.search(r"\b(inf|nan|None)\b", page.words)


def test_one_weld_one_station_one_event(tmp_path):
    """The smallest result there is has a complete page."""
    page = made(tmp_path, welds=("only",), stations=1, events=("run",))
    assert {"lives", "scene", "strips", "weld-1-along", "weld-1-matrix", "weld-1-psd", "domains"} <= page.figures.keys()


def test_without_spectrum_there_is_no_comparison(tmp_path):
    """The page says why instead of showing an empty figure."""
    page = made(tmp_path, spectrum=False)
    assert "domains" not in page.figures
    assert "there is no frequency-domain estimate" in page.words


def test_a_face_without_toe_is_marked(tmp_path):
    """It is drawn thin and named so, and is never among the worst points."""
    page = made(tmp_path, toes="bottom")
    assert "top face, no toe" in [t["name"] for t in page.figures["weld-1-along"]["data"]]
    assert {row[2] for row in page.tables["worst-ten"][1:]} == {"bottom"}


@pytest.mark.parametrize(("spoil", "reason"), [("gone", "is not there any more"), ("changed", "has changed since")])
def test_missing_or_changed_histories_are_named(tmp_path, spoil, reason):
    """Figures that need them are left out, with the file and the reason; everything else is there."""
    folder = write_result(tmp_path)
    history = tmp_path / "q_1.parquet"
    history.unlink() if spoil == "gone" else history.write_bytes(history.read_bytes() + b" ")
    page = Page(report_page(folder))
    assert f"q_1.parquet: {reason}" in page.words
    assert "weld-1-psd" not in page.figures
    assert "weld-1-along" in page.figures


def test_a_moved_case_can_be_named(tmp_path):
    """Without its case the page leaves the records out; with the path of the case it has them."""
    folder = write_result(tmp_path / "work")
    elsewhere = tmp_path / "elsewhere"
    folder.rename(elsewhere)
    assert "the case file is not where it was" in Page(report_page(elsewhere)).words
    assert "weld-1-psd" in Page(report_page(elsewhere, tmp_path / "work" / "case.toml")).figures


def test_an_edited_case_is_not_taken_for_the_assessed_one(tmp_path):
    """Its histories may be others, so they are not shown."""
    folder = write_result(tmp_path)
    case = tmp_path / "case.toml"
    case.write_text(case.read_text().replace("speed_km_h = 300.0", "speed_km_h = 299.0", 1))
    assert "has changed" in Page(report_page(folder)).words


def test_warnings_are_on_the_first_page_and_in_full_below(tmp_path):
    """The first of each kind with the number of the others, all of them with remedies at the end."""
    warnings = tuple(
        {"code": "end_unresolved", "where": f"weld {i}", "what": "coarse", "remedy": "Refine"} for i in range(3)
    )
    words = made(tmp_path, warnings=warnings).words
    assert "and 2 more of this kind" in words
    assert "End unresolved (3, end_unresolved )" in words
    assert "Mend the model" in words
    assert words.count("Refine") == 3


def test_a_warning_that_sums_up_others_counts_for_them(tmp_path, monkeypatch):
    """Their number is in all numbers of the kind, their welds are named as far as there is room."""
    monkeypatch.setattr("fatigue.report.sections.evidence.warnings.LONGEST_PLACE", 40)
    one = {"code": "end_unresolved", "where": "n.csv: weld A", "what": "coarse", "remedy": "Refine", "count": 1}
    some = one | {"where": "n.csv: weld B, C", "what": "2 more of this kind", "count": 2}
    many = one | {"where": "n.csv: weld " + ", ".join(["D1"] * 10), "what": "10 more of this kind", "count": 10}
    words = made(tmp_path, warnings=(one, some, many)).words
    assert "and 12 more of this kind" in words
    assert "End unresolved (13, end_unresolved )" in words
    assert "n.csv: weld B, C : 2 more" in words
    assert "n.csv: weld D1, D1, D1, D1, D1, D1, D1 and others, see provenance.json : 10 more" in words


def test_many_welds_have_their_rows_and_few_their_figures(tmp_path, monkeypatch):
    """Beyond a number of welds, details are for the worst; the page says how many are not shown."""
    monkeypatch.setattr("fatigue.report.page.MOST_DETAILED", 3)
    page = made(tmp_path, welds=tuple(f"W{i}" for i in range(8)), stations=2)
    assert len([f for f in page.figures if f.endswith("-along")]) == 3
    assert len(page.tables["weld-register"]) == 9
    assert "the other 5 have their row" in page.words


def test_of_very_many_welds_the_worst_are_drawn_and_listed(tmp_path, monkeypatch):
    """Lines and register have a limit each; the page says what is left out and where it is."""
    for limit, value in (("MOST_DETAILED", 2), ("MOST_STATIONS", 9), ("MOST_LISTED", 5)):
        monkeypatch.setattr(f"fatigue.report.page.{limit}", value)
    page = made(tmp_path, welds=tuple(f"W{i}" for i in range(8)), stations=3)
    assert "Weld lines, coloured by the shorter life of the toe faces, the 3 worst of 8 welds" in page.words
    assert len(values(page.figures["scene"]["data"][0]["x"])) == 3 * (3 + 1)
    assert [row[0] for row in page.tables["weld-register"][1:]] == [f"W{i}" for i in range(5)]
    assert "The 3 assessed welds with the longest lives are left out here; they are in welds.parquet" in page.words
    assert "the other 6 have all their numbers in the tables" in page.words
    assert "48 toe points were assessed" in page.words


def test_a_weld_without_listed_cycles_has_its_page(tmp_path):
    """The cycles of welds far from the limit are not kept: what needs them is left out, nothing is taken for wrong."""
    folder = write_result(tmp_path)
    cycles = pd.read_parquet(folder / "cycles.parquet")
    cycles[cycles["weld"] != "W2 hanger"].to_parquet(folder / "cycles.parquet", index=False)
    page = Page(report_page(folder))
    assert {"weld-2-along", "weld-2-psd"} <= page.figures.keys()
    assert "weld-2-matrix" not in page.figures
    assert "✕ differs" not in page.words
    assert not re.search(r"\b(inf|nan|None)\b", page.words)


def test_the_report_is_written_beside_the_tables(tmp_path):
    """The file is UTF-8 and small enough to send."""
    path = write_report(write_result(tmp_path))
    assert path.name == "report.html"
    assert path.stat().st_size < 6e6
    assert path.read_text(encoding="utf-8").startswith("<!DOCTYPE html>")


def test_a_folder_without_result_is_refused(tmp_path):
    """The message names the folder and what to do."""
    with pytest.raises(DataError, match="no finished result in this folder"):
        report_page(tmp_path)


def test_target_line_of_the_weld_figure(page):
    """The target is drawn at its mileage."""
    shapes = page.figures["weld-1-along"]["layout"]["shapes"]
    assert TARGET_KM in [s["y0"] for s in shapes]


def test_the_verification_table_is_shown_where_it_was_made(result_folder, page):
    """Known answers, what was found, the difference and the source; a wrong one is marked."""
    check = {
        "topic": "rainflow", "case": "ASTM example", "quantity": "cycles of range 4", "unit": "-", "expected": 1.5,
        "found": 1.5, "difference": 0.0, "tolerance": 1e-9, "passed": True, "source": "ASTM E1049-85",
    }  # fmt: skip
    wrong = {**check, "found": 2.0, "difference": 0.33, "passed": False}
    rows = Page(report_page(result_folder, verification=[check, wrong])).tables["verification"][1:]
    assert rows[0] == [
        "rainflow",
        "ASTM example",
        "cycles of range 4",
        "1.500",
        "1.500",
        "0.0e+00",
        "1e-09",
        "✓",
        "ASTM E1049-85",
    ]
    assert rows[1][7] == "✕ wrong"
    assert "verification" not in page.tables


def test_the_audit_of_converted_files_is_shown(tmp_path, page):
    """Lights, numbers and remedies of the conversion, and the sign it took; nothing of it without a conversion."""
    folder = write_result(tmp_path, Recipe())
    record = json.loads((folder / "provenance.json").read_text())
    row = {"check": "sign", "light": "amber", "value": -0.98, "finding": "forces <on> node", "remedy": "State it"}
    record["conversion"] = {
        "convention": "on_node",
        "audit": [row],
        "inputs": {},
        "remarks": ["a.bdf: 2 <FORCE> are left out."],
    }
    (folder / "provenance.json").write_text(json.dumps(record))
    shown = Page(report_page(folder))
    assert shown.tables["audit"][-1] == ["sign", "amber", "−0.9800", "forces <on> node", "State it"]
    assert "Forces were taken as on_node." in shown.words
    assert "a.bdf: 2 <FORCE> are left out." in shown.words
    assert "audit" not in page.tables


def test_excluded_welds_keep_their_row_and_their_reason(tmp_path):
    """An excluded weld is in the register and nowhere among the results."""
    folder = write_result(tmp_path)
    welds = pd.read_parquet(folder / "welds.parquet")
    excluded = dict.fromkeys(welds.columns) | {
        "weld": "W9",
        "status": "excluded",
        "reason": "solid elements",
        "description": "",
        "closed": False,
        "parts": 0,
        "nodes": 0,
        "surface": "both",
        "fulfilled": False,
    }
    pd.concat([welds, pd.DataFrame([excluded]).dropna(axis=1)]).to_parquet(folder / "welds.parquet")
    page = Page(report_page(folder))
    row = next(row for row in page.tables["weld-register"] if row[0] == "W9")
    assert "excluded: solid elements" in row
    assert "1 of 2 welds misses" in page.words
    assert "1 weld is excluded" in page.words


def test_the_body_is_drawn_when_the_case_names_its_mesh(tmp_path, page):
    """Shaded and with its outline in space, as lines on paper; without a mesh only the weld lines are drawn."""
    folder = write_result(tmp_path, Recipe(mesh=True))
    page_with_body = Page(report_page(folder))
    assert [trace["name"] for trace in page_with_body.figures["scene"]["data"]] == ["body", "outline", "weld lines"]
    assert len(page_with_body.figures["views"]["data"]) == len(page.figures["views"]["data"]) + 2
    (tmp_path / "elements.csv").unlink()
    without = Page(report_page(folder))
    assert "elements.csv: is not there any more" in without.words
    assert [trace["name"] for trace in without.figures["scene"]["data"]] == ["weld lines"]


def test_of_many_events_those_that_damage_most_are_listed(tmp_path):
    """Twenty rows for a point, the leading event first, and how many are not listed."""
    page = made(tmp_path, welds=("W1",), stations=1, events=tuple(f"event {i}" for i in range(23)))
    rows = page.tables["weld-1-events"][1:]
    assert len(rows) == 20
    assert rows[0][0] == "event 0"
    assert "3 others are in damage.parquet" in page.words


def test_what_cannot_be_seen_in_a_name_is_spelled_out(tmp_path):
    """Nothing turns the direction of the page or is hidden in it; a name of 5000 letters does not fill it."""
    names = ("A\u202eB\x1b[31m\u200b", "x" * 5000)
    doubt = {"code": "doubt", "where": names[0], "what": names[0], "remedy": names[0]}
    recipe = Recipe(names, 2, names, title=names[0], description=names[0], warnings=(doubt,))
    text = report_page(write_result(tmp_path, recipe))
    own = text[: text.index("plotly-source")] + text[text.index("</script>", text.index("plotly-source")) :]
    assert not {c for c in own if unicodedata.category(c) in ("Cc", "Cf")} - set("\n\t")
    page = Page(text)
    assert [row[0] for row in page.tables["weld-register"][1:]].count(r"A\u202eB\x1b[31m\u200b") == 1
    assert max(len(row[0]) for row in page.tables["weld-register"]) == 400
    assert r"A\u202eB\x1b[31m\u200b" in json.dumps(page.figures["scene"]["data"]).encode().decode("unicode_escape")
    assert "\u202e" not in json.dumps(page.figures, ensure_ascii=False)
