"""Throats from files to tables: numbers by hand, the verdict where they count, and the same bytes however it is run."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pandas as pd
import pytest

from fatigue.assess import assess
from fatigue.errors import CaseError
from fatigue.life.curves import catalogue, damage_law
from fatigue.life.rule import cycle_damage, equivalent_range, ratio_factor, size_factor
from fatigue.results.summary import result_summary
from tests.small_case import MEMBRANE, THICKNESS, sine_only, small_case
from tests.throat_case import A_MM, CLASS, row, with_throats

RANGE = 60.0  # of q_1, from -30 to 30
CYCLES_PER_KM = 60.0 / 0.6  # 5 Hz for 12 s at 180 km/h
Z_C = 0.5 * THICKNESS + 0.5 * A_MM / np.sqrt(2.0)


def tension_only():
    """The small case under a sine, its plates in tension alone: N of 8 N/mm per unit of mode 1."""
    case = sine_only()
    force = case.nodal_forces
    force.loc[force["mode"] == 1, "mx_Nmm"] = 0.0
    return case


def table(folder, name="checks"):
    """A result table."""
    return pd.read_parquet(folder / f"{name}.parquet")


@pytest.fixture(scope="module")
def by_hand(tmp_path_factory):
    """Tension across two tees, of two welds and of one."""
    folder = tmp_path_factory.mktemp("by_hand")
    case = with_throats(tension_only(), folder / "case", [row("A", "both", "throat"), row("B", "top", "throat")])
    return assess(case, folder / "out", threads=1, report=False), folder / "out"


def test_a_tee_in_tension_by_hand(by_hand):
    """N / 2a in the direction of the force, 135 deg from the throat normal; life, utilisation and factor follow."""
    checks = table(by_hand[1])
    N = MEMBRANE * THICKNESS
    for weld, share, sides in (("A", 0.5, ["top", "bottom"]), ("B", 1.0, ["top"])):
        rows = checks[(checks.weld == weld) & (checks.check == "throat_perp")]
        assert rows.side.drop_duplicates().tolist() == sides
        assert rows.order.tolist() == list(range(1, 8)) * len(sides)
        assert set(rows.direction_deg) == {135.0}
        assert set(rows.governing_event) == {"sine"}
        S = share * N * RANGE / A_MM  # sigma_perp = N / (2 sqrt2 a), and as much across: together N / 2a
        np.testing.assert_allclose(rows.range_max_MPa, S, rtol=1e-9)
        damage = CYCLES_PER_KM * S**3 / (2e6 * CLASS**3)
        np.testing.assert_allclose(rows.damage_per_km, damage, rtol=1e-9)
        np.testing.assert_allclose(rows.life_km, 1.0 / damage, rtol=1e-9)
        np.testing.assert_allclose(rows.damage_sum, damage * 1e6, rtol=1e-9)
        np.testing.assert_allclose(rows.utilisation_damage, damage * 1e6, rtol=1e-9)
        np.testing.assert_allclose(rows.utilisation_stress, (damage * 1e6) ** (1.0 / 3.0), rtol=1e-9)
        assert not rows.fulfilled.any()


def test_the_root_of_one_weld_opens_by_hand(by_hand):
    """sigma_root is N/(sqrt2 a) + 6 z_c N / a^2 where one weld holds the plate, sigma_perp where two do."""
    checks = table(by_hand[1])
    roots = checks[checks.check == "throat_root"].groupby(["weld", "side"]).range_max_MPa.max()
    N = MEMBRANE * THICKNESS * RANGE
    assert roots["A", "top"] == pytest.approx(N / (2.0 * np.sqrt(2.0) * A_MM), rel=1e-9)
    assert roots["B", "top"] == pytest.approx(N / (np.sqrt(2.0) * A_MM) + 6.0 * Z_C * N / A_MM**2, rel=1e-9)
    assert set(checks.surface[checks.check == "throat_root"]) == {"root"}


def test_shear_along_the_weld_below_the_cut_off_does_nothing(by_hand):
    """Without cycles above the cut-off there is no damage, and the factor is where the largest one reaches it."""
    rows = table(by_hand[1]).query("check == 'throat_par'")
    assert set(rows.damage_per_km) == {0.0}
    assert np.isinf(rows.life_km).all()
    assert rows.fulfilled.all()
    assert not rows.governing_event.notna().any()


def test_rows_say_what_they_rest_on(by_hand):
    """Curve, its status and edition, and the assumptions of the statics."""
    checks = table(by_hand[1])
    assert set(checks.curve_status) == {"user"}
    assert checks.loc[checks.check == "throat_perp", "edition"].unique().tolist() == ["first"]
    notes = checks.groupby("weld").note.agg(set)
    assert notes["A"] == {"f_z shared equally; moment as a couple; line offset 0 mm"}
    assert notes["B"] == {"twist neglected; plate free but for this weld; line offset 0 mm"}


def test_checks_decide_nothing_unless_they_count(by_hand, tmp_path):
    """The verdict is that of the toe; a check that counts and fails sets it, for its weld and for all."""
    case = tension_only()
    case.mission["target_km"] = 100.0  # the toes last
    rows = [row("A", "both"), row("B", "top", "throat")]
    free = with_throats(case, tmp_path / "free", rows)
    assert assess(free, tmp_path / "a", threads=1, report=False).fulfilled
    welds = table(tmp_path / "a", "welds").set_index("weld")
    assert welds.fulfilled.tolist() == [True, True]
    assert welds.worst_check.to_dict() == {"A": "throat_perp", "B": "throat_root"}
    checks = table(tmp_path / "a")
    for weld in "AB":
        worst = checks[checks.weld == weld].utilisation_stress.max()
        assert welds.loc[weld, "worst_check_utilisation"] == worst
    assert welds.checks_not_assessed.tolist() == [0, 0]
    assert checks[checks.fulfilled == False].weld.unique().tolist() == ["B"]  # noqa: E712
    case.extra = ""
    counted = with_throats(case, tmp_path / "counted", rows[1:], '[checks]\ncounts = ["throat_root"]\n')
    assert not assess(counted, tmp_path / "b", threads=1, report=False).fulfilled  # exit code 1 of the command line
    assert "1 of 2 welds miss their target" in result_summary(tmp_path / "b").as_text()
    welds = table(tmp_path / "b", "welds").set_index("weld")
    assert welds.fulfilled.to_dict() == {"A": True, "B": False}
    assert (welds.utilisation <= 1.0).all()
    assert welds.worst_check.isna().to_dict() == {"A": True, "B": False}


def test_a_bent_weld_without_a_curve_for_its_root_is_told(tmp_path):
    """One weld without curve_root has a row without a verdict, which counts as not assessed."""
    case = with_throats(tension_only(), tmp_path / "case", [row("A", "both"), row("B", "top")])
    assess(case, tmp_path / "out", threads=1, report=False)
    (missing,) = table(tmp_path / "out").query("check == 'throat_root'").to_dict("records")
    assert (missing["weld"], missing["side"], missing["fulfilled"]) == ("B", "top", None)
    assert "give curve_root" in missing["note"]
    welds = table(tmp_path / "out", "welds").set_index("weld")
    assert welds.checks_not_assessed.to_dict() == {"A": 0, "B": 1}
    case = tension_only()
    counts = '[checks]\ncounts = ["throat_root"]\n'
    found = assess(with_throats(case, tmp_path / "counts", [row("B", "top")], counts), tmp_path / "c", report=False)
    (warning,) = [one for one in found.warnings if one.code == "check_not_assessed"]
    assert "throat_root counts, but is not assessed at B" in warning.what


def test_a_throat_on_the_master_curve_has_the_bending_ratio_of_each_cycle(tmp_path):
    """In dS a root has its bending ratio and the throat as thickness, and says that the curve is not for throats."""
    rows = [row("A", "both", "master-aluminium"), row("B", "bottom", "master-aluminium")]
    case = with_throats(tension_only(), tmp_path / "case", rows)
    assess(case, tmp_path / "out", threads=1, report=False)
    checks = table(tmp_path / "out").query("check == 'throat_root'")
    N = MEMBRANE * THICKNESS * RANGE
    perp, bend = N / (np.sqrt(2.0) * A_MM), 6.0 * Z_C * N / A_MM**2
    curve = catalogue()["master-aluminium"]
    size, law = float(size_factor(np.array(A_MM), curve, "actual")), damage_law(curve, None, "none", 1e7)
    for weld, S, r in (("A", perp / 2.0, 0.0), ("B", perp + bend, bend / (perp + bend))):
        dS = equivalent_range(S, size, ratio_factor(r), 1.0)
        expected = CYCLES_PER_KM * float(cycle_damage(np.array(dS), law))
        np.testing.assert_allclose(checks[checks.weld == weld].damage_per_km, expected, rtol=1e-9)
    assert checks.note.str.contains("a curve for dS stress, not for throats").all()


def test_the_bytes_do_not_depend_on_how_it_is_run(tmp_path):
    """Threads, an executor and a run that goes on give the same table of checks."""
    names = [f"{side}{pair or ''}" for pair in range(4) for side in "AB"]
    rows = [row(weld, "both" if weld[0] == "A" else "bottom", "throat", offset=-5.0) for weld in names]
    case = with_throats(small_case(seconds=6.0, pairs=4), tmp_path / "case", rows)
    assess(case, tmp_path / "one", threads=1, report=False)
    assess(case, tmp_path / "two", threads=3, report=False)
    with ThreadPoolExecutor(2) as executor:
        assess(case, tmp_path / "three", executor=executor, report=False)

    def stop(label, done, total):
        raise RuntimeError

    with pytest.raises(RuntimeError):
        assess(case, tmp_path / "four", threads=1, report=False, progress=stop)
    assert assess(case, tmp_path / "four", threads=1, report=False).groups_reused > 0
    for name in ("checks", "welds"):
        one, *others = ((tmp_path / run / f"{name}.parquet").read_bytes() for run in ("one", "two", "three", "four"))
        assert all(one == other for other in others)
    assert table(tmp_path / "one").weld.drop_duplicates().tolist() == names


def test_curves_are_asked_for_with_their_place(tmp_path):
    """An unknown curve is refused with the weld and the column of the table."""
    case = with_throats(tension_only(), tmp_path, [row("A", "both", "nothing")])
    with pytest.raises(CaseError) as refusal:
        assess(case, tmp_path / "out", report=False)
    assert "weld_throats.csv: weld A: curve_root: there is no curve 'nothing'" in str(refusal.value)


def test_a_corner_whose_forces_are_one_sum_says_so(tmp_path):
    """At a kink the note tells that the forces are of both legs, and nowhere else."""
    case = tension_only()
    line = case.weld_nodes
    turned = (line.weld == "A") & (line.order > 4)
    line["y_mm"] = line["y_mm"].astype(float)
    line.loc[turned, "y_mm"] -= 10.0 * (line.loc[turned, "order"] - 4)
    line.loc[turned, "x_mm"] = 30.0
    line.loc[turned, ["outward_x", "outward_y"]] = [1.0, 0.0]
    assess(with_throats(case, tmp_path / "case", [row("A", "both")]), tmp_path / "out", threads=1, report=False)
    nodes = table(tmp_path / "out", "nodes").query("weld == 'A' and surface == 'top'").set_index("order")
    checks = table(tmp_path / "out").query("check == 'throat_perp' and side == 'top'").set_index("order")
    assert nodes.summed_corner.sum() == 1
    told = checks.note.str.contains("forces of both legs of a corner in one sum")
    assert told.to_dict() == nodes.summed_corner.to_dict()
