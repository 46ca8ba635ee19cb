"""Answers put back through a whole assessment of a changed case."""

import pandas as pd
import pytest

from fatigue.assess import assess
from fatigue.decide.backsolve.story import backsolve
from fatigue.errors import DataError
from tests.small_case import SmallCase, sine_only, small_case
from tests.test_sequences import LOOP, empty_and_laden

END = 5.0  # mm: an end treatment that does not follow the thickness
OWN = {"slopes": [3.0], "knees_cycles": [], "range_at_2e6_MPa": 40.0, "applies": "structural", "source": "test"}


def made(case: SmallCase, folder, **options):
    """Result of a case."""
    assess(case.write(folder / "case"), folder / "out", threads=1, report=False, **options)
    return folder / "out"


def short(**changes) -> SmallCase:
    """The small case with short records; ends are treated over a fixed length."""
    case = small_case(seconds=4.0)
    case.welds["end_length_mm"] = END
    for name, value in changes.items():
        setattr(case, name, getattr(case, name) | value)
    return case


def own_curve(case: SmallCase, range_MPa: float = 40.0, **more) -> SmallCase:
    """On a curve of the user, which can be scaled."""
    case.curve = {"name": "own"}
    table = OWN | {"range_at_2e6_MPa": range_MPa} | more
    lines = [f"{key} = {value!r}".replace("'", '"') for key, value in table.items()]
    case.extra += "\n".join(["[curves.own]", *lines]) + "\n"
    return case


def utilisations(folder) -> pd.Series:
    """Utilisation of every weld."""
    return pd.read_parquet(folder / "welds.parquet").set_index("weld")["utilisation"]


def scaled(case: SmallCase, factor: float) -> SmallCase:
    """All stresses times a factor."""
    case.events = [event | {"stress_factor": factor} for event in case.events]
    return case


def thicker(case: SmallCase, factors: dict[str, float]) -> SmallCase:
    """Plates of each weld times a factor, under the same nodal forces."""
    nodes = case.weld_nodes
    case.weld_nodes = nodes.assign(thickness_mm=nodes["thickness_mm"] * nodes["weld"].map(factors))
    return case


@pytest.fixture(scope="module")
def result(tmp_path_factory):
    """The small case on the aluminium curve."""
    return made(short(), tmp_path_factory.mktemp("base"))


def rows_of(found):
    """Answers by weld."""
    return {row.weld: row for row in found.rows}


def proved(found):
    """Every answer is at most 1e-6 beside the target."""
    solved = [row for row in found.rows if row.state == "solved"]
    assert solved
    assert all(row.deviation <= 1e-6 for row in solved)
    return rows_of(found)


@pytest.mark.parametrize("weld", ["A", "B", ""])
def test_load(result, tmp_path, weld):
    """The load factor of a weld, and that of the body, which is the smallest."""
    rows = proved(backsolve(result, "load"))
    assert rows[""].answer == min(rows["A"].answer, rows["B"].answer)
    assert rows[weld].basis == "exact"
    u = utilisations(made(scaled(short(), rows[weld].answer), tmp_path))
    assert (u[weld] if weld else u.max()) == pytest.approx(1.0, abs=1e-6)


def test_another_target(result, tmp_path):
    """Years at the mileage of the case."""
    rows = proved(backsolve(result, "load", target="12 years"))
    case = scaled(short(mission={"target_km": 12 * 2e5}), rows[""].answer)
    assert utilisations(made(case, tmp_path)).max() == pytest.approx(1.0, abs=1e-6)


def test_curve(tmp_path):
    """A curve whose range at 2e6 cycles is scaled by the answer."""
    rows = proved(backsolve(made(own_curve(short()), tmp_path / "base"), "curve"))
    assert rows[""].sense == "at_least"
    case = own_curve(short(), 40.0 * rows[""].answer)
    assert utilisations(made(case, tmp_path / "again")).max() == pytest.approx(1.0, abs=1e-6)


@pytest.mark.parametrize("question", ["load", "curve"])
def test_knee(tmp_path, question):
    """Low and high hold the answer that a rerun would find; the value is close to it."""
    knees = {"slopes": [3.0, 5.0], "knees_cycles": [1e7]}
    base = made(own_curve(short(), **knees), tmp_path / "base")
    row = proved(backsolve(base, question))[""]
    assert row.basis == "histogram"
    assert row.low <= row.answer <= row.high
    assert row.high / row.low - 1.0 < 0.01
    for at, factor in (("low", row.low), ("answer", row.answer), ("high", row.high)):
        case = scaled(short(), factor) if question == "load" else short()
        case = own_curve(case, 40.0 * (factor if question == "curve" else 1.0), **knees)
        u = utilisations(made(case, tmp_path / at)).max()
        if at == "answer":
            assert u == pytest.approx(1.0, abs=1e-3)
        elif (at == "low") == (question == "load"):
            assert u <= 1.0 + 1e-9
        else:
            assert u >= 1.0 - 1e-9


@pytest.mark.parametrize("factor", [1.0, 0.1])
def test_points_without_ranges_are_counted(tmp_path, factor):
    """Without histograms the answer on a curve with a knee is counted, and exact: whether the target is met or not."""
    knees = {"slopes": [3.0, 5.0], "knees_cycles": [1e7]}
    base = made(own_curve(scaled(short(), factor), **knees), tmp_path / "base", histogram="none")
    assert (utilisations(base).max() > 1.0) == (factor == 1.0)
    row = proved(backsolve(base, "load"))[""]
    assert row.basis == "recount"
    case = own_curve(scaled(short(), factor * row.answer), **knees)
    assert utilisations(made(case, tmp_path / "again")).max() == pytest.approx(1.0, abs=1e-6)


@pytest.mark.parametrize("slopes", [[3.0], [3.0, 5.0]])
def test_curve_under_mean_stress(tmp_path, slopes):
    """f_M is of the stress and not of the curve: exact on one slope, counted with a knee."""
    knees = {"slopes": slopes, "knees_cycles": [1e7] * (len(slopes) - 1), "applies": "dS"}

    def case(factor=1.0):
        one = own_curve(short(), 60.0 * factor, **knees)
        one.curve |= {"mean_stress": "asme", "yield_MPa": 30.0}
        for history in one.histories.values():
            history["q_1"] += 60.0
        return one

    row = proved(backsolve(made(case(), tmp_path / "base"), "curve"))[""]
    assert row.basis == ("exact" if len(slopes) == 1 else "recount")
    u = utilisations(made(case(row.answer), tmp_path / "again")).max()
    assert u == pytest.approx(1.0, abs=1e-6)


def test_load_under_mean_stress(tmp_path):
    """Its conditions do not scale, so that the load is counted at every trial."""

    def case(factor=1.0):
        one = short(curve={"mean_stress": "asme", "yield_MPa": 30.0})
        for history in one.histories.values():
            history["q_1"] += 60.0
        return scaled(one, factor)

    base = made(case(), tmp_path / "base")
    found = backsolve(base, "load")
    row = rows_of(found)[""]
    assert row.basis == "recount"
    assert "points were counted again" in found.as_text()
    u = utilisations(made(case(row.answer), tmp_path / "again")).max()
    if row.note:
        assert u <= 1.0 + 1e-6
    else:
        assert u == pytest.approx(1.0, abs=1e-6)


def test_mileage(result, tmp_path):
    """The pace at which the shortest life lasts 12 years."""
    rows = proved(backsolve(result, "km_per_year", target="12 years"))
    pace = rows[""].answer
    case = short(mission={"km_per_year": pace, "target_km": 12.0 * pace})
    assert utilisations(made(case, tmp_path)).max() == pytest.approx(1.0, abs=1e-6)


@pytest.mark.parametrize("weld", ["A", "B", ""])
def test_share(result, tmp_path, weld):
    """The others keep their proportions; events by number are held; the body has the narrowest span."""
    table = pd.read_parquet(result / "damage.parquet").set_index(["weld", "surface", "order"]).sort_index()
    d = table.loc[(weld or "A", "top", 4)].set_index("event")
    per_km = 0.5 * d.loc["sine", "damage_per_km"] + 0.5 * d.loc["noise", "damage_per_km"]
    target = float(1.0 / (per_km + 2e-3 * d.loc["load and unload", "damage_per_pass"]))
    rows = proved(backsolve(result, "share:noise", target=target))
    row = rows[weld]
    assert row.state == "solved"
    assert 0.0 < row.answer < 1.0
    case = short(mission={"target_km": target})
    case.events[0]["share"], case.events[1]["share"] = 1.0 - row.answer, row.answer
    u = utilisations(made(case, tmp_path))
    assert (u[weld] if weld else u.max()) == pytest.approx(1.0, abs=1e-6)
    for s, u in ((0.0, row.utilisation_at_0), (1.0, row.utilisation_at_1)):
        case.events[0]["share"], case.events[1]["share"] = 1.0 - s, s
        again = utilisations(made(case, tmp_path / str(s)))
        assert (again[weld] if weld else again.max()) == pytest.approx(u, rel=1e-9)


def test_no_share_will_do(result):
    """None, with the utilisations at 0 and at 1."""
    found = backsolve(result, "share:noise", target=1e12)
    assert not found.solved
    row = found.body
    assert (row.state, row.answer != row.answer) == ("none", True)
    assert min(row.utilisation_at_0, row.utilisation_at_1) > 1.0
    assert "no share of 'noise' meets 1.000e12 km; utilisation" in found.verdict
    found = backsolve(result, "share:noise", target=1.0)
    assert found.body.state == "any"
    assert (found.body.share_at_least, found.body.share_at_most) == (0.0, 1.0)


@pytest.mark.parametrize("rule", ["actual", "asme"])
def test_thickness(tmp_path, rule):
    """Plates of the answer under the same nodal forces, every weld its own, and one factor for the body."""
    base = made(short(curve={"thickness_rule": rule}), tmp_path / "base")
    target = float(2e6 / utilisations(base).max())
    found = backsolve(base, "thickness", target=target)
    rows = proved(found)
    assert "a new FE run decides" in found.held
    more = {"curve": {"thickness_rule": rule}, "mission": {"target_km": target}}
    factors = {name: rows[name].factor for name in "AB"}
    u = utilisations(made(thicker(short(**more), factors), tmp_path / "own"))
    assert u.to_dict() == pytest.approx({"A": 1.0, "B": 1.0}, abs=1e-6)
    assert rows["A"].answer == pytest.approx(8.0 * factors["A"], rel=1e-12)
    whole = dict.fromkeys("AB", rows[""].factor)
    assert utilisations(made(thicker(short(**more), whole), tmp_path / "body")).max() == pytest.approx(1.0, abs=1e-6)


@pytest.mark.parametrize("length", [None, END])
def test_ends_that_are_treated_over_the_thickness(tmp_path, length):
    """The note is there where a rerun would treat the end over another length."""
    case = short()
    case.welds["end_length_mm"] = length
    forces = case.nodal_forces
    ends = forces["node"].isin([100, 106, 200, 206])
    forces.loc[ends, ["fy_N", "mx_Nmm"]] *= 1.5  # the worst points are ends
    base = made(case, tmp_path)
    target = float(2e6 / utilisations(base).max())
    rows = rows_of(backsolve(base, "thickness", target=target))
    assert rows["A"].order in (1, 7)
    assert ("treated over the plate thickness" in rows["A"].note) == (length is None)


def test_thickness_of_a_mixed_cycle(tmp_path):
    """Oracle [B3 mixed]: membrane to bending 2 to 1, utilisation 3: 5.312856552421842 of 4 mm, on the top face."""
    case = sine_only()
    case.welds["surface"] = "top"
    base = made(case, tmp_path)
    target = 3e6 / utilisations(base).max()
    row = proved(backsolve(base, "thickness", target=target))["A"]
    assert row.factor == pytest.approx(5.312856552421842 / 4.0, rel=1e-7)


def test_thickness_that_is_not_monotonic(tmp_path):
    """Membrane and bending oppose each other at the bottom: the plate as it is would do, a thicker one would not."""
    case = sine_only()
    case.welds["surface"] = "bottom"
    of_mode = case.nodal_forces["mode"] == 1
    case.nodal_forces.loc[of_mode, "mx_Nmm"] *= 0.9 / 0.5
    base = made(case, tmp_path)
    now = utilisations(base).max()
    found = backsolve(base, "thickness", target=0.5e6 / now)
    row = rows_of(found)["A"]
    assert (row.state, row.not_monotonic) == ("none", True)
    found = backsolve(base, "thickness", target=0.01e6 / now)
    row = proved(found)["A"]
    assert row.not_monotonic
    assert row.factor < 1.0
    assert "not monotonic" in row.note
    assert "not monotonic" in found.as_text()


@pytest.mark.parametrize("question", ["load", "thickness", "share:laden", "km_per_year"])
def test_cycles_across_events(tmp_path, question):
    """A loop of events goes along: its cycles are held, scaled or counted again."""

    def case():
        one = empty_and_laden()
        one.welds["end_length_mm"] = END
        one.extra = LOOP
        return one

    base = made(case(), tmp_path / "base")
    now = utilisations(base)
    target = float((1.1e6 if question.startswith("share") else 2e6) / now.max())
    found = backsolve(base, question, target=target)
    rows = rows_of(found)
    row = rows["A"]
    assert row.state == "solved"
    assert row.deviation <= 1e-6
    again = case()
    again.mission = again.mission | {"target_km": target}
    if question == "load":
        scaled(again, row.answer)
    elif question == "thickness":
        thicker(again, {name: rows[name].factor if rows[name].state == "solved" else 1.0 for name in "AB"})
    elif question == "km_per_year":
        again.mission |= {"km_per_year": row.answer, "target_km": row.answer * found.asked.years}
    else:
        again.events[0]["share"], again.events[2]["share"] = 1.0 - row.answer, row.answer
    assert utilisations(made(again, tmp_path / "again"))["A"] == pytest.approx(1.0, abs=1e-6)


def test_bounds_that_could_govern_are_counted(tmp_path):
    """Screened points take part where their bound is above the target: the answer is that of the exact result."""
    case = scaled(short(), 0.05)
    exact = made(case, tmp_path / "exact", share=0.0)
    screened = made(scaled(short(), 0.05), tmp_path / "screened", share=1.0, proves_worst=False)
    tiers = pd.read_parquet(screened / "nodes.parquet")["screened"].fillna("")
    assert (tiers != "").any()
    for question in ("load", "km_per_year", "share:noise"):
        target = None if question != "share:noise" else 0.97e6 / utilisations(exact).max()
        ours, theirs = (rows_of(backsolve(folder, question, target=target)) for folder in (screened, exact))
        for weld in ("A", "B", ""):
            assert ours[weld].state == theirs[weld].state
            if ours[weld].state == "solved":
                assert ours[weld].answer == pytest.approx(theirs[weld].answer, rel=1e-9)


def test_nothing_damages(tmp_path):
    """Any load, curve, mileage; the target is met whatever it is."""
    case = sine_only()
    case.histories["sine"] = case.histories["sine"].assign(q_1=0.0)
    base = made(case, tmp_path)
    for question in ("load", "curve", "km_per_year", "thickness"):
        found = backsolve(base, question)
        assert {row.state for row in found.rows} == {"any"}
        assert found.solved
        assert "are met whatever" in found.verdict


def test_cut_off(tmp_path):
    """A jump at the cut-off: the side that meets the target, and the text says so."""
    base = made(short(curve={"extension": "cutoff", "knee_cycles": 1e6}), tmp_path / "base")
    found = backsolve(base, "load")
    for row in found.rows[1:]:
        assert row.state == "solved"
        assert row.deviation <= 1e-6 or "in a jump" in row.note


def test_refusals(result, tmp_path):
    """Shear that decides, inputs that are gone, a folder that is the result."""
    with pytest.raises(DataError, match="is one of the results that are read"):
        backsolve(result, "load", into=result)
    case = short()
    case.extra += '[multiaxial]\nmethod = "range"\n'
    shear = made(case, tmp_path / "shear")
    with pytest.raises(DataError, match="verdicts rest on normal stress and shear"):
        backsolve(shear, "load")
    case.extra = case.extra.replace('"range"', '"off"')
    assert backsolve(made(case, tmp_path / "off"), "load").solved
    base = made(short(), tmp_path / "gone")
    (tmp_path / "gone" / "case" / "noise.csv").unlink()
    backsolve(base, "load")  # nothing is counted
    with pytest.raises(DataError, match=r"noise\.csv"):
        backsolve(base, "thickness")


def test_written(result, tmp_path):
    """Table, page and record; a second run replaces them."""
    found = backsolve(result, "thickness", into=tmp_path / "out", csv=True)
    names = {path.name for path in (tmp_path / "out").iterdir()}
    assert names == {"backsolve.parquet", "backsolve.csv", "backsolve.html", "backsolve.json"}
    table = pd.read_parquet(tmp_path / "out" / "backsolve.parquet")
    assert table["weld"].tolist() == [row.weld for row in found.rows]
    assert (tmp_path / "out" / "backsolve.html").read_text(encoding="utf-8").count("a new FE run decides") == 1
    backsolve(result, "load", into=tmp_path / "out")
    assert not (tmp_path / "out" / "backsolve.csv").exists()
