"""Unit loads in a diagnosis: a mode given as one has the same shares, and parts add up whatever its sampling."""

import json
import re

import numpy as np
import pandas as pd
import pytest

from fatigue.report.page import report_page
from fatigue.results import json_ready
from tests.report.reading import Page
from tests.small_case import STEP, SmallCase, small_case
from tests.test_diagnose import POINT, Diagnosed, run

EXACT = {"rtol": 1e-12, "atol": 1e-18}
LOAD = """
[[body.unit_load]]
name = "pull"
unit = "kN"
nodal_forces = "pull.csv"
"""


def as_modes() -> SmallCase:
    """The small case with damping, counted as it is sampled."""
    case = small_case()
    case.counting = {"upsample": 1}
    case.modes["damping_ratio"] = 0.02
    return case


def as_load(folder) -> SmallCase:
    """The same with mode 2 as a unit load, whose history is a column of the records."""
    case = as_modes()
    case.modes = case.modes[case.modes["mode"] != 2]
    own = case.nodal_forces["mode"] == 2
    folder.mkdir(parents=True)
    case.nodal_forces[own].drop(columns="mode").assign(unit_load="pull").to_csv(folder / "pull.csv", index=False)
    case.nodal_forces = case.nodal_forces[~own]
    case.histories = {name: table.rename(columns={"q_2": "u_pull"}) for name, table in case.histories.items()}
    case.extra = LOAD
    return case


@pytest.fixture(scope="module")
def modes(tmp_path_factory) -> Diagnosed:
    """The diagnosis of three modes."""
    return run(as_modes(), tmp_path_factory.mktemp("modes"))


@pytest.fixture(scope="module")
def loads(tmp_path_factory) -> Diagnosed:
    """The diagnosis of two modes and a unit load."""
    folder = tmp_path_factory.mktemp("loads")
    return run(as_load(folder / "case"), folder)


def keyed(table, *keys):
    """Rows in the order of their point and more keys, the load called as the mode it was."""
    table = table.copy()
    table["mode"] = table["mode"].where(table["unit_load"].isna(), 2.0).astype(float)
    table["kind"] = table["kind"].replace("unit_load", "mode") if "event" in table else table["kind"]
    return table.sort_values([*POINT, *keys], kind="stable").reset_index(drop=True)


def test_a_mode_given_as_a_unit_load_owes_the_same(modes, loads):
    """Damage, share and exponent to rounding in every event; no part of it in resonance."""
    keys = ("event", "kind", "mode", "low_hz")
    before, after = keyed(modes.attribution, *keys), keyed(loads.attribution, *keys)
    for name in ("damage_per_km", "share", "life_exponent"):
        np.testing.assert_allclose(after[name], before[name], **EXACT)
    is_load = after["unit_load"].notna()
    assert set(after["unit_load"][is_load]) == {"pull"}
    assert loads.attribution["mode"][loads.attribution["kind"] == "unit_load"].isna().all()
    assert after["resonant_share"][is_load].isna().all()
    assert before["resonant_share"][is_load].notna().any()
    np.testing.assert_allclose(after["resonant_share"][~is_load], before["resonant_share"][~is_load], **EXACT)
    np.testing.assert_allclose(loads.track["damage_per_km"], modes.track["damage_per_km"], **EXACT)


def test_parts_add_up_to_the_damage(loads):
    """Modes and unit loads together, in every event and at every point."""
    parts = loads.attribution[loads.attribution["kind"].isin(["mode", "unit_load"])]
    found = parts.groupby([*POINT, "event"])["damage_per_km"].sum()
    whole = loads.attribution[loads.attribution["kind"] == "event"].set_index([*POINT, "event"])["damage_per_km"]
    np.testing.assert_allclose(found[whole.index], whole, **EXACT)
    nodes = loads.nodes.set_index(POINT)["damage_per_km"]
    np.testing.assert_allclose(whole.groupby(level=POINT).sum()[nodes.index], nodes, **EXACT)


def test_a_smaller_load_buys_what_a_smaller_mode_buys(modes, loads):
    """Levers rank it alike, by name and without a frequency."""
    before, after = keyed(modes.levers, "rank"), keyed(loads.levers, "rank")
    for name in ("mode", "share", "life_exponent", "life_km", "life_km_estimated", "life_km_counted"):
        np.testing.assert_allclose(after[name], before[name], rtol=1e-11)
    own = loads.levers["unit_load"] == "pull"
    assert own.any()
    assert loads.levers["frequency_hz"][own].isna().all()
    assert set(loads.levers["kind"][own]) == {"unit_load"}


def test_what_is_said_of_a_load(modes, loads):
    """Its name in place of a mode's, in words and for machines."""
    assert "unit load" not in modes.summary.as_text()
    for before, after in zip(modes.summary.findings, loads.summary.findings, strict=True):
        assert after.life_km == pytest.approx(before.life_km, rel=1e-12)
        assert [m.mode or 2 for m in after.modes] == [m.mode for m in before.modes]
        assert [m.unit_load for m in after.modes] == ["pull" if m.mode is None else "" for m in after.modes]
    said = loads.summary.as_text()
    assert re.search(r"  loads .*\bunit load pull [\d.]+ %", said)
    assert "relieving modes and loads" in said
    record = json.loads(json.dumps(json_ready(loads.summary.as_record()), allow_nan=False))
    kinds = {mode["kind"]: mode for finding in record["findings"] for mode in finding["modes"]}
    assert kinds["unit_load"]["mode"] is None
    assert kinds["unit_load"]["frequency_hz"] is None


@pytest.fixture(scope="module")
def mixed(tmp_path_factory) -> Diagnosed:
    """A load from files of their own: as finely sampled as the record, twice as fine, and of a static load case."""
    folder = tmp_path_factory.mktemp("mixed")
    case = as_load(folder / "case")
    del case.events[2]
    for name in ("sine", "noise"):
        case.histories[name] = case.histories[name].drop(columns="u_pull")
    seconds = len(case.histories["sine"]) * STEP
    fine = np.arange(round(2 * seconds / STEP)) * STEP / 2
    frame = pd.DataFrame({"time_s": fine, "force": 15.0 * np.sin(2 * np.pi * 2.5 * fine + 0.3)})
    frame.to_csv(folder / "case" / "fine.csv", index=False)
    given = '[[mission.event.unit_load]]\nname = "pull"\nunit = "kN"\n'
    for event in case.events:
        event["unit_load"] = []
    case.extra = LOAD + "[[mission.event]]\n" + 'name = "lift"\nper_1000_km = 3.0\n' + given + "values = [0.0, 60.0]\n"
    path = case.write(folder / "case")
    text = path.read_text().replace("unit_load = []", given + 'history = "fine.csv"\ncolumn = "force"')
    case.write = lambda folder: path.write_text(text) and path
    return run(case, folder)


def test_parts_add_up_whatever_the_sampling(mixed):
    """They are of the coordinates as they were counted."""
    test_parts_add_up_to_the_damage(mixed)
    share = mixed.attribution[mixed.attribution["kind"] == "unit_load"].groupby("event")["share"].sum()
    assert share.index.tolist() == ["lift", "noise", "sine"]
    assert (share.abs() > 1e-5).all()


def test_a_static_load_case(mixed):
    """No bands, no place, and a reason of its own; all of its damage is owed to its load."""
    own = mixed.attribution[mixed.attribution["event"] == "lift"]
    by_kind = own.groupby("kind")["damage_per_km"].sum()
    assert by_kind["unit_load"] == pytest.approx(by_kind["event"], rel=1e-12)
    assert by_kind["band"] == pytest.approx(by_kind["event"], rel=1e-12)
    assert mixed.track[mixed.track["event"] == "lift"]["start_km"].isna().all()
    assert set(mixed.diagnosis[mixed.diagnosis["event"] == "lift"]["reason"]) == {
        "A static load case has no spectrum, so there is no frequency-domain estimate to judge."
    }
    assert any("'lift' is a static load case" in note for note in mixed.summary.notes)


def test_the_page_names_loads(mixed):
    """What each event gives of it, its share in the damage, and the rule of the method."""
    page = Page(report_page(mixed.folder))
    table = page.tables["unit-loads"]
    assert table[1:] == [
        ["pull", "kN", "load beside the modes", "sine, noise", "column force of fine.csv"],
        ["pull", "kN", "load beside the modes", "lift", "values 0, 60 kN"],
    ]
    names = {
        text
        for id_, fig in page.figures.items()
        if id_.endswith("damage-modes")
        for text in fig["layout"]["yaxis"]["ticktext"]
    }
    assert "unit load pull" in names
    assert "Unit load pull" in page.words
    assert "forces per kN, one more coordinate beside the modes, role other" in page.words
    assert "Which mode or unit load, if 10 % smaller" in page.words
