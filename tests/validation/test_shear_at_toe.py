"""Shear at the toe against numbers that were computed apart: a worked example, and points of the shipped car body."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from fatigue.assess import Assessment, assess
from fatigue.results import read_provenance
from tests.conftest import EXAMPLE
from tests.shear_at_toe import scaled, shear_at_toe

MISSION = {
    "utilisation": 0.815960499737,
    "utilisation_path_range": 0.943938966094,
    "utilisation_path_length": 1.66131811537,
    "utilisation_path_mlp": 2.52249163004,
    "multiaxial_bound": 1.98020726254,
}
HALF_CYCLES = {  # start and end in samples, range, path factor, moment, ds, dtau, R_b, R_b of the shear, x
    "track": [
        (0.0, 2.0, 66.8993273509, 1.30785494354, 0.488000576353, 64.8, 9.6, 2 / 9, 0.53125, 81.1616478476),
        (2.0, 6.0, 66.8993273509, 1.02035792485, 0.132218169146, 64.8, 9.6, 2 / 9, 0.53125, 81.1616478476),
        (4.0, 5.0, 35.6583790994, 1.0, 0.0, 33.0, 7.8, 3 / 11, 3 / 13, 43.2395447685),
        (
            5.0,
            5.83102904246,
            39.143849758,
            1.0,
            0.0,
            39.1414679001,
            0.249308712739,
            0.133757961783,
            19 / 39,
            47.6337612155,
        ),
    ],
    "load_unload": [(0.0, 1.0, 47.1028661548, 1.0, 0.0, 47.1, 0.3, 0.133757961783, 19 / 39, 57.3190090616)],
}
FIRST = {"track": 3, "load_unload": 0}  # sample at which counting begins
SAMPLES = {"track": 6, "load_unload": 2}

POINTS = [  # of the shipped car body: weld, order, face, sums by normal stress, range, length, mlp, ASME, and T1
    ("W1_roof_bracket_neg", 1, "top", 0.439038915, 0.6571934004, 0.8989804101, 1.370856723, 1.069330234, 6.955003461),
    ("W1_roof_bracket_pos", 1, "top", 0.3551933453, 0.5225465118, 0.7551627618, 1.190677634, 0.9938068767, 6.674349402),
    ("W2_hanger1_att", 1, "bottom", 5.149372622, 5.204400273, 5.215137594, 5.363929557, 5.243568623, 25.4873891),
    (
        "W4_roof_stub_loop",
        13,
        "top",
        8.822850913e-4,
        9.275604844e-4,
        1.227175398e-3,
        1.850513968e-3,
        1.489554775e-3,
        1.355942703e-2,
    ),
]
FAILING = {"normal": 5, "range": 5, "length": 5, "asme": 6, "mlp": 7}  # welds
FAILING_POINTS = {"normal": 58, "range": 58, "length": 58, "asme": 60, "mlp": 62}


def nodes_of(case: Path, folder: Path) -> tuple[Assessment, pd.DataFrame]:
    """An assessment and its toe points."""
    done = assess(case, folder, threads=1, report=False, histogram="none")
    nodes = pd.read_parquet(folder / "nodes.parquet")
    return done, nodes[nodes["toe"]]


@pytest.fixture(scope="module")
def worked(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Result of the worked example as it is reported."""
    folder = tmp_path_factory.mktemp("worked")
    assess(shear_at_toe().write(folder / "case"), folder / "result", threads=1, report=False)
    return folder / "result"


def test_sums_of_the_worked_example(worked: Path) -> None:
    """All of its nodes are alike; the bound leaves them open, and the counter says it depends on the model."""
    nodes = pd.read_parquet(worked / "nodes.parquet")
    toes, others = nodes[nodes["toe"]], nodes[~nodes["toe"]]
    for column, known in MISSION.items():
        assert toes[column].to_numpy() == pytest.approx(np.full(3, known), rel=1e-8)
    assert set(toes["multiaxial_status"]) == {"counted"}
    assert set(toes["multiaxial_verdict"]) == {"model_dependent"}
    assert toes["path_factor_largest"].to_numpy() == pytest.approx(np.full(3, 1.30785494354), rel=1e-8)
    assert toes["path_moment_largest"].to_numpy() == pytest.approx(np.full(3, 0.488000576353), abs=1e-8)
    assert toes["fulfilled"].all()
    assert (
        others[[*list(MISSION)[1:], "multiaxial_status", "multiaxial_verdict", "shear_required"]].isna().all(axis=None)
    )


def test_half_cycles_of_the_worked_example(worked: Path) -> None:
    """Ends, ranges, path factors and moments of one node, and what they do."""
    rows = pd.read_parquet(worked / "path_cycles.parquet")
    assert rows[["weld", "order", "surface"]].drop_duplicates().to_numpy().tolist() == [["T", 1, "top"]]
    for event, known in HALF_CYCLES.items():
        mine = rows[rows["event"] == event].sort_values(["range_MPa", "path_factor"])
        expected = np.array(sorted(known, key=lambda half: (round(half[2], 6), half[3])))
        at = (expected[:, :2] + FIRST[event]) % SAMPLES[event]
        found = mine[["start_s", "end_s"]].to_numpy() / 0.01
        np.testing.assert_allclose(found % SAMPLES[event], at, atol=1e-8)
        columns = ["range_MPa", "path_factor", "path_moment", "normal_range_MPa", "shear_range_MPa"]
        columns += ["bending_ratio", "shear_bending_ratio", "equivalent_range_dS"]
        np.testing.assert_allclose(mine[columns].to_numpy(), expected[:, 2:], rtol=1e-8, atol=1e-8)
    damage = rows.groupby("event")["damage"].sum()
    total = 150_000.0 * damage["track"] + 6.0 * damage["load_unload"]
    assert total == pytest.approx(MISSION["utilisation_path_range"], rel=1e-8)


@pytest.mark.parametrize("method", ["range", "length", "mlp", "asme"])
def test_a_named_method_decides(method: str, tmp_path: Path) -> None:
    """Life, verdict and the check rest on its sum; all stresses times the load factor just meet the target."""
    case = shear_at_toe(f'method = "{method}"\nalpha = 1.0')
    done, nodes = nodes_of(case.write(tmp_path / "case"), tmp_path / "result")
    column = "utilisation_asme" if method == "asme" else f"utilisation_path_{method}"
    known = nodes[column].iloc[0]
    assert known > MISSION["utilisation"]
    assert nodes["utilisation"].to_numpy() == pytest.approx(np.full(3, known), rel=1e-12)
    assert nodes["damage_per_km"].to_numpy() == pytest.approx(np.full(3, known / 1500.0), rel=1e-12)
    assert nodes["life_km"].to_numpy() == pytest.approx(np.full(3, 1500.0 / known), rel=1e-12)
    assert done.fulfilled == (known <= 1.0) == bool(nodes["fulfilled"].all())
    checks = pd.read_parquet(tmp_path / "result" / "checks.parquet")
    assert list(checks["check"]) == ["toe_multiaxial"] * 3
    assert set(checks["component"]) == {method}
    assert checks["damage_sum"].to_numpy() == pytest.approx(np.full(3, known), rel=1e-12)
    factor = float(nodes["load_factor"].iloc[0])
    assert checks["utilisation_stress"].to_numpy() == pytest.approx(np.full(3, 1.0 / factor), rel=1e-12)
    again = scaled(shear_at_toe(f'method = "{method}"\nalpha = 1.0'), factor)
    _, at_factor = nodes_of(again.write(tmp_path / "again"), tmp_path / "at factor")
    assert at_factor["utilisation"].to_numpy() == pytest.approx(np.ones(3), rel=1e-9)


@pytest.fixture(scope="module")
def example(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder with the shipped car body, its samples as they are, and a result with alpha."""
    folder = tmp_path_factory.mktemp("carbody")
    text = (EXAMPLE / "case.toml").read_text(encoding="utf-8")
    for key in ("modes", "welds", "weld_nodes", "nodal_forces", "nodes", "elements"):
        text = text.replace(f'\n{key} = "', f'\n{key} = "{EXAMPLE}/')
    text = text.replace('history = "', f'history = "{EXAMPLE}/')
    (folder / "case.toml").write_text(
        f"{text}\n[counting]\nupsample = 1\n[multiaxial]\nalpha = 1.0\n", encoding="utf-8"
    )
    assess(folder / "case.toml", folder / "result", threads=2, report=False, histogram="none")
    return folder


def test_points_of_the_car_body(example: Path) -> None:
    """Sums by every model and the bound, as they were computed apart."""
    nodes = pd.read_parquet(example / "result" / "nodes.parquet").set_index(["weld", "order", "surface"])
    columns = ["utilisation", "utilisation_path_range", "utilisation_path_length", "utilisation_path_mlp"]
    columns += ["utilisation_asme", "multiaxial_bound"]
    for weld, order, face, *known in POINTS:
        found = nodes.loc[(weld, order, face), columns].to_numpy(dtype=float)
        np.testing.assert_allclose(found, known, rtol=1e-6)


def test_what_settles_the_car_body(example: Path) -> None:
    """58 toe points fail by normal stress, 235 are proven to pass, 35 are counted; one weld depends on the model."""
    nodes = pd.read_parquet(example / "result" / "nodes.parquet")
    statuses = nodes.loc[nodes["toe"], "multiaxial_status"].value_counts().to_dict()
    assert statuses == {"settled_fails": 58, "settled_passes": 235, "counted": 35}
    record = read_provenance(example / "result")
    assert record["rules"]["multiaxial"]["toe_points"] == statuses
    (warning,) = [one for one in record["warnings"] if one["code"] == "model_dependent"]
    assert warning["count"] == 2  # with alpha; the ASME factor alone tells of the first
    assert "W1_roof_bracket_neg (node 9092, top: range 0.657, length 0.899, mlp 1.37, asme 1.07)" in warning["what"]


def test_welds_of_the_car_body_that_fail(example: Path, tmp_path: Path) -> None:
    """Number of welds and of points by every model, each named; no sum is smaller than that of the normal stress."""
    text = (example / "case.toml").read_text(encoding="utf-8")
    normal = pd.read_parquet(example / "result" / "nodes.parquet").query("toe")
    assert int((normal["utilisation"] > 1.0).sum()) == FAILING_POINTS["normal"]
    assert normal.loc[normal["utilisation"] > 1.0, "weld"].nunique() == FAILING["normal"]
    for method in ("range", "length", "mlp", "asme"):
        (tmp_path / f"{method}.toml").write_text(f'{text}method = "{method}"\n', encoding="utf-8")
        _, nodes = nodes_of(tmp_path / f"{method}.toml", tmp_path / method)
        assert int((nodes["utilisation"] > 1.0).sum()) == FAILING_POINTS[method]
        assert nodes.loc[nodes["utilisation"] > 1.0, "weld"].nunique() == FAILING[method]
        assert (nodes["utilisation"].to_numpy() >= normal["utilisation"].to_numpy()).all()
        if method != "asme":
            assert nodes[f"utilisation_path_{method}"].notna().all()
        settled = nodes[nodes["multiaxial_status"] == "settled_passes"]
        assert not (settled["utilisation_path_range"] > settled["multiaxial_bound"]).any()
