"""Stress points on the whole path: files, case, assessment, rows of checks.parquet, against closed forms and toes."""

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from fatigue.assess import Assessment, assess
from fatigue.check import check_case
from fatigue.errors import CaseError, DataError
from tests.small_case import SmallCase, sine_only, small_case
from tests.stress_point_case import curve_text, micro_example, point, stresses, write_points
from tests.unit_load_case import as_unit_load

ONE = {1: (1.0, 0.0, 0.0), 2: (0.0, 0.0, 0.0), 7: (0.0, 0.0, 0.0)}  # the stress of mode 1 is that across the weld
TOE = {"weld": "A", "order": 4}
KNEES = curve_text("points", 60.0, "structural", slopes=(3.0, 5.0), knees=(5e6,))
R_CURVE = curve_text("points", 60.0, "structural", more='mean_stress = "iiw_low"\ngamma_Mf = 1.15\ndamage_limit = 0.7')
LOOP = '[[mission.sequence]]\norder = ["sine", "noise"]\nper_1000_km = 3.0\n'


def run(path: Path, **options: object) -> tuple[Assessment, pd.DataFrame]:
    """The assessment of a case, and its rows of checks."""
    found = assess(path, path.parent / "out", report=False, **{"threads": 1} | options)
    return found, pd.read_parquet(path.parent / "out" / "checks.parquet")


def rows_of(checks: pd.DataFrame, **wanted: object) -> pd.DataFrame:
    """Rows with these values."""
    return checks[np.logical_and.reduce([checks[name] == value for name, value in wanted.items()])]


def one_row(checks: pd.DataFrame, **wanted: object) -> pd.Series:
    """The row with these values."""
    (row,) = (row for _, row in rows_of(checks, **wanted).iterrows())
    return row


def test_a_sine_by_hand(tmp_path):
    """Range, cycles, life and utilisation of a hot spot under a sine of 5 Hz at 180 km/h, of one slope 3."""
    case = sine_only()
    case.extra = curve_text("points", 90.0)
    at = (3.2, 8.0)
    field = {1: [(1.4, 0.0, 0.0), (2.0, 0.0, 0.0)], 2: (0.0, 0.0, 0.0), 7: (0.0, 0.0, 0.0)}
    path = write_points(case, tmp_path, [point("P", weld="A")], [stresses("P", field, at, ("top", "bottom"))])
    found, checks = run(path)
    hot_spot = 1.67 * 1.4 - 0.67 * 2.0
    range_MPa = 60.0 * hot_spot  # the sine has the amplitude 30
    cycles_per_km = 5.0 / (180.0 / 3.6) * 1000.0
    damage_per_km = cycles_per_km / (2e6 * (90.0 / range_MPa) ** 3)
    assert len(checks) == 4  # top and bottom, normal and planes_60
    assert checks["check"].eq("hot_spot").all()
    for _, row in checks.iterrows():
        assert row["range_max_MPa"] == pytest.approx(range_MPa, rel=1e-9)
        assert row["damage_per_km"] == pytest.approx(damage_per_km, rel=1e-9)
        assert row["life_km"] == pytest.approx(1.0 / damage_per_km, rel=1e-9)
        assert row["damage_sum"] == pytest.approx(1e6 * damage_per_km, rel=1e-9)
        assert row["utilisation_stress"] == pytest.approx((1e6 * damage_per_km) ** (1 / 3), rel=1e-9)
        assert row["fulfilled"] == (1e6 * damage_per_km <= 1.0)
        assert (row["weld"], row["direction_deg"], row["governing_event"]) == ("A", 0.0, "sine")
        assert row["note"] == "a fine (0.4 t, 1 t)"
    assert checks[["part", "order"]].isna().all(axis=None)
    welds = pd.read_parquet(path.parent / "out" / "welds.parquet").set_index("weld")
    assert welds.loc["A", "worst_check"] == "hot_spot"
    assert welds.loc["A", "worst_check_utilisation"] == pytest.approx(checks["utilisation_stress"].max())
    assert pd.isna(welds.loc["B", "worst_check"])
    assert found.fulfilled == welds["fulfilled"].all()


def test_micro_example(tmp_path):
    """The micro example of hot spots: 0.6236 on the plane of the weld, 0.6478 on the one at 5 deg."""
    tensors = {
        1: [(15.0, 4.0, 3.0), (12.0, 3.5, 2.5)],
        2: [(-2.0, 5.0, 6.0), (-1.5, 4.5, 5.5)],
        3: [(6.0, 1.0, 0.5), (5.0, 1.0, 0.5)],
    }
    case = micro_example()
    case.extra = curve_text("points", 36.0)
    points = [point("P", thickness_mm=6.0)]
    _, checks = run(write_points(case, tmp_path, points, [stresses("P", tensors, (2.4, 6.0))]))
    normal, planes = (one_row(checks, component=name) for name in ("normal", "planes_60"))
    assert normal["damage_sum"] == pytest.approx(0.623583688539, rel=1e-11)
    assert planes["damage_sum"] == pytest.approx(0.647794230046, rel=1e-11)
    assert (normal["direction_deg"], planes["direction_deg"]) == (0.0, 5.0)


def plain(case: SmallCase) -> tuple[SmallCase, list[str]]:
    """The three events, one of them with a factor on all stresses."""
    case.events[1]["stress_factor"] = 1.3
    return case, []


def loop(case: SmallCase) -> tuple[SmallCase, list[str]]:
    """Events in a known order, the noise on another level."""
    case.histories["noise"]["q_1"] += 60.0
    case.extra += LOOP
    return case, []


def constant_load(case: SmallCase) -> tuple[SmallCase, list[str]]:
    """A mode as a unit load that is constant in the whole mission."""
    forces = as_unit_load(case, 7, "force")
    case.histories = {name: table.drop(columns="u_force") for name, table in case.histories.items()}
    case.extra += '[[mission.unit_load]]\nname = "force"\nunit = "kN"\nconstant = 9.0\n'
    return case, [forces]


def static_load_case(case: SmallCase) -> tuple[SmallCase, list[str]]:
    """A static load case of a unit load beside the events, which have a constant of it."""
    case, forces = constant_load(case)
    case.extra += '[[mission.event]]\nname = "lift"\nper_1000_km = 50.0\n'
    case.extra += '[[mission.event.unit_load]]\nname = "force"\nunit = "kN"\nvalues = [0.0, 40.0]\n'
    return case, forces


@pytest.mark.parametrize("curve", [KNEES, R_CURVE], ids=["knees", "R"])
@pytest.mark.parametrize("of", [plain, loop, constant_load, static_load_case])
def test_a_hot_spot_with_the_stress_of_a_toe_has_its_mission(tmp_path, of, curve):
    """All that the engine knows is in the checks: factors, sequences, constants, static load cases, rules of curves."""

    def written(folder: Path, points=(), stress=()) -> Path:
        case, forces = of(small_case())
        case.curve = {"name": "points"}
        case.extra += curve
        folder.mkdir()
        for table in forces:
            table.to_csv(folder / "loads.csv", index=False)
        return write_points(case, folder, list(points), list(stress)) if points else case.write(folder)

    path = written(tmp_path / "toe")
    assess(path, path.parent / "out", report=False, threads=1)
    tables = {name: pd.read_parquet(path.parent / "out" / f"{name}.parquet") for name in ("structural_stress", "nodes")}
    tensors = {"top": {}, "bottom": {}}
    for _, row in rows_of(tables["structural_stress"], **TOE).iterrows():
        key = row["unit_load"] if pd.isna(row["mode"]) else int(row["mode"])
        for surface, sign in (("top", 1.0), ("bottom", -1.0)):
            tensors[surface][key] = (row["membrane_MPa"] + sign * row["bending_MPa"], 0.0, 0.0)
    stress = [stresses("P", of_surface, (3.2, 8.0), (surface,)) for surface, of_surface in tensors.items()]
    _, checks = run(written(tmp_path / "point", [point("P", weld="A")], stress))
    for surface in ("top", "bottom"):
        toe = one_row(tables["nodes"], surface=surface, **TOE)
        row = one_row(checks, surface=surface, component="normal")
        assert row["damage_per_km"] == pytest.approx(toe["damage_per_km"], rel=1e-9)
        assert row["range_max_MPa"] == pytest.approx(toe["max_range_MPa"], rel=1e-9)
        assert row["utilisation_damage"] == pytest.approx(toe["utilisation"], rel=1e-9)
        assert row["utilisation_stress"] == pytest.approx(1.0 / toe["load_factor"], rel=1e-6)
        assert row["governing_event"] == toe["governing_event"]


def test_constants_change_the_stress_ratio(tmp_path):
    """A constant of the mission changes no range; it changes the damage on a curve with f(R)."""
    damage = {}
    for constant in (0.0, 9.0):
        case, (forces,) = constant_load(small_case())
        case.extra = case.extra.replace("constant = 9.0", f"constant = {constant}") + R_CURVE
        folder = tmp_path / f"{constant}"
        folder.mkdir()
        forces.to_csv(folder / "loads.csv", index=False)
        field = {1: (1.0, 0.0, 0.0), 2: (0.0, 0.0, 0.0), "force": (20.0, 0.0, 0.0)}
        path = write_points(case, folder, [point("P", planes="normal")], [stresses("P", field, (3.2, 8.0))])
        row = one_row(run(path)[1], component="normal")
        damage[constant] = row["damage_per_km"]
        assert row["range_max_MPa"] == pytest.approx(damage.setdefault("range", row["range_max_MPa"]))
        assert row["damage_limit"] == 0.7
    assert damage[9.0] > 1.5 * damage[0.0]


def many_points(folder: Path, suffix: str = "parquet") -> Path:
    """Points of all kinds beside three groups of welds, some of them beside none."""
    case = small_case(pairs=8)
    rng = np.random.default_rng(3)
    case.curve = {"name": "points"}
    case.extra = KNEES + curve_text("plate", 90.0, "parent", slopes=(5.0,)) + curve_text("n", 71.0, "nominal")
    case.extra += curve_text("tau", 60.0, "parent", slopes=(5.0,), quantity="shear")
    points, tables = [], []
    for number, weld in enumerate(["B7", "A", "B7", "", "A3", "A"]):
        tensors = {mode: rng.normal(size=(2, 3)) for mode in (1, 2, 7)}
        at = {"x_mm": 30.0, "y_mm": 500.0 * case.welds["weld"].tolist().index(weld) + 5.0} if weld else {}
        points.append(point(f"hot {number}", weld=weld, **at))
        tables.append(stresses(f"hot {number}", tensors, (4.0, 12.0), ("top", "bottom")))
    for number, (kind, curve, shear) in enumerate(
        [("parent", "plate", "tau"), ("haz", "plate", ""), ("nominal", "n", ""), ("hot_spot_b", "points", "")]
    ):
        tensors = {mode: rng.normal(size=(2 if kind == "hot_spot_b" else 1, 3)) for mode in (1, 2, 7)}
        points.append(point(f"other {number}", kind, curve=curve, curve_shear=shear))
        edge = kind == "hot_spot_b"
        at, surfaces = ((5.0, 15.0), ("edge",)) if edge else ((0.0,), ("top", "bottom"))
        tables.append(stresses(f"other {number}", tensors, at, surfaces))
    return write_points(case, folder, points, tables, suffix)


@pytest.fixture(scope="module")
def many(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, pd.DataFrame]:
    """Many points: the case file and the rows of its checks."""
    path = many_points(tmp_path_factory.mktemp("many"))
    return path, run(path)[1]


def test_rows_of_all_kinds(many):
    """Each kind has its rows, with both surfaces; heat-affected zones are told, and shear where a curve is given."""
    _, checks = many
    assert checks["point"].drop_duplicates().tolist() == [
        *(f"hot {i}" for i in range(6)),
        *(f"other {i}" for i in range(4)),
    ]
    assert len(rows_of(checks, point="hot 3")) == 4
    of = {number: rows_of(checks, point=f"other {number}") for number in range(4)}
    assert of[0]["component"].tolist() == ["planes", "planes", "shear", "shear"]
    assert of[0]["curve"].tolist() == ["plate", "plate", "tau", "tau"]
    assert of[0]["surface"].tolist() == ["top", "bottom"] * 2
    assert of[0]["direction_deg"].between(0.0, 175.0).all()
    assert of[1]["note"].tolist() == ["HAZ", "HAZ"]
    assert of[2]["component"].tolist() == ["normal", "normal", "planes_60", "planes_60"]
    assert of[3][["check", "surface", "component"]].to_numpy().tolist() == [["hot_spot", "edge", "normal"]]
    assert set(of[0]["check"]) | set(of[1]["check"]) == {"parent"}
    assert checks["curve_status"].eq("user").all()


def test_the_critical_plane_is_never_better_than_that_of_the_weld(many):
    """Damage on the critical plane is at least that on the plane of the weld, at every toe and surface."""
    checks = many[1][many[1]["check"] != "parent"].set_index(["point", "surface"])
    planes = checks.loc[checks["component"] == "planes_60", "damage_sum"]
    normal = checks.loc[checks["component"] == "normal", "damage_sum"].reindex(planes.index)
    assert (planes >= normal * (1.0 - 1e-9)).all()
    assert (planes > 1.01 * normal).any()


def test_worst_checks_of_welds(many):
    """The worst of its points is at its weld; welds without points have none."""
    path, checks = many
    welds = pd.read_parquet(path.parent / "out" / "welds.parquet").set_index("weld")
    worst = checks.groupby("weld")["utilisation_stress"].max()
    assert set(worst.index) == {"A", "A3", "B7"}
    assert welds.loc[worst.index, "worst_check_utilisation"].to_numpy() == pytest.approx(worst.to_numpy())
    assert welds["worst_check"].notna().sum() == 3
    assert (welds["checks_not_assessed"] == 0).all()


def test_same_bytes_whatever_does_the_work(many, tmp_path):
    """Threads, other processes' orders and CSV in place of Parquet change no byte of the checks."""
    path, _ = many
    before = (path.parent / "out" / "checks.parquet").read_bytes()
    assess(path, tmp_path / "threads", threads=3, report=False)
    with ThreadPoolExecutor(2) as workers:
        assess(path, tmp_path / "orders", executor=workers, report=False)
    for folder in ("threads", "orders"):
        assert (tmp_path / folder / "checks.parquet").read_bytes() == before
    csv = many_points(tmp_path / "csv", "csv")
    pd.testing.assert_frame_equal(run(csv)[1], many[1])


def test_an_interrupted_run_ends_with_the_same_bytes(many, tmp_path):
    """Points are counted again when a run goes on, and stand where they would have stood."""

    def stop(label, done, total):
        raise KeyboardInterrupt

    path, _ = many
    with pytest.raises(KeyboardInterrupt):
        assess(path, tmp_path / "out", threads=1, report=False, progress=stop)
    done = assess(path, tmp_path / "out", threads=1, report=False)
    assert done.groups_reused > 0
    before = (path.parent / "out" / "checks.parquet").read_bytes()
    assert (tmp_path / "out" / "checks.parquet").read_bytes() == before


def test_points_are_told_by_check(many):
    """The number of points is among the sizes of a case."""
    found = check_case(many[0])
    assert found.as_record()["stress_points"] == 10
    assert "  stress points    10, not in the estimates" in found.as_text().splitlines()


def test_normal_turned_over(tmp_path):
    """With the normal on the other side top and bottom change places, txy its sign, and the plane that of its angle."""
    rng = np.random.default_rng(8)
    tensors = {mode: rng.normal(size=(2, 3)) for mode in (1, 2, 7)}
    over = {mode: tensor * (1.0, 1.0, -1.0) for mode, tensor in tensors.items()}
    case = small_case()
    case.extra = curve_text("points", 60.0)
    points = [point("P"), point("Q", normal_z=-1.0)]
    stress = [stresses("P", tensors, (4.0, 12.0)), stresses("Q", over, (4.0, 12.0), ("bottom",))]
    _, checks = run(write_points(case, tmp_path, points, stress))
    for component in ("normal", "planes_60"):
        p, q = (one_row(checks, point=name, component=component) for name in "PQ")
        assert (p["surface"], q["surface"]) == ("top", "bottom")
        assert q["damage_sum"] == pytest.approx(p["damage_sum"], rel=1e-9)
        assert q["direction_deg"] == -p["direction_deg"]
    assert q["direction_deg"] != 0.0


def test_planes_of_a_point_may_be_left_to_the_normal(tmp_path):
    """``planes = normal`` counts the plane of the weld alone; shear at a toe is that in its plane, along the weld."""
    case = sine_only()
    shear = curve_text("tau", 80.0, slopes=(5.0,), quantity="shear")
    case.extra = curve_text("points", 90.0) + shear
    points = [point("P", curve_shear="tau", planes="normal")]
    field = ONE | {1: (1.0, 0.4, 0.5)}
    _, checks = run(write_points(case, tmp_path, points, [stresses("P", field, (3.2, 8.0))]))
    assert checks["component"].tolist() == ["normal", "shear"]
    assert checks["range_max_MPa"].to_numpy() == pytest.approx([60.0, 30.0])
    assert checks["curve"].tolist() == ["points", "tau"]


def test_checks_that_count_decide(tmp_path):
    """A point that fails decides the verdict of its weld, and of the body where it has no weld, if its check counts."""
    for weld, counts, fulfilled in (("A", "", True), ("A", "hot_spot", False), ("", "hot_spot", False)):
        case = sine_only()
        case.mission["target_km"] = 1.0
        case.extra = curve_text("points", 1.0) + (f'[checks]\ncounts = ["{counts}"]\n' if counts else "")
        folder = tmp_path / f"{weld}-{counts}"
        path = write_points(case, folder, [point("P", weld=weld)], [stresses("P", ONE, (3.2, 8.0))])
        found, checks = run(path)
        assert not checks["fulfilled"].any()
        assert found.fulfilled is fulfilled
        welds = pd.read_parquet(folder / "out" / "welds.parquet").set_index("weld")
        assert welds["fulfilled"].tolist() == [fulfilled or not weld, True]


def test_what_check_refuses_is_refused_by_an_assessment(tmp_path):
    """A mistake in the stresses stops both before anything is counted."""
    case = sine_only()
    case.extra = curve_text("points", 90.0)
    path = write_points(case, tmp_path, [point("P")], [stresses("P", ONE, (3.0, 8.0))])
    for do in (check_case, lambda file: assess(file, tmp_path / "out", report=False)):
        with pytest.raises(DataError, match=r"modal_stresses.csv: point P: read-outs at 3, 8 mm are no set"):
            do(path)
    assert not (tmp_path / "out").exists()


def test_e1_along_the_weld_is_refused(tmp_path):
    """A frame turned by 90 degrees would count the stress along the weld."""
    case = sine_only()
    case.extra = curve_text("points", 90.0)
    path = write_points(case, tmp_path, [point("P", weld="A", e1_x=1.0, e1_y=0.0)], [stresses("P", ONE, (3.2, 8.0))])
    with pytest.raises(DataError, match=r"point P: e1: e1 is along weld A \(0 deg from its line\)"):
        check_case(path)


def test_tables_need_each_other_and_a_weld(tmp_path):
    """One table without the other is refused, and so is a body without welds."""
    case = sine_only()
    case.extra = curve_text("points", 90.0)
    path = write_points(case, tmp_path, [point("P")], [stresses("P", ONE, (3.2, 8.0))])
    text = path.read_text()
    path.write_text(text.replace('modal_stresses = "modal_stresses.csv"\n', ""))
    with pytest.raises(CaseError, match="stress_points and modal_stresses need each other"):
        check_case(path)
    path.write_text(text.replace('welds = "welds.csv"\n', ""))
    with pytest.raises(CaseError, match=r"body.welds: the key is missing"):
        check_case(path)
