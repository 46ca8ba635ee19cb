"""Stress beside the roof bracket of the shipped body: recovered from forces of elements, and assessed."""

import numpy as np
import pandas as pd
import pytest

from fatigue.case import load_case
from fatigue.pipeline.checks.points import point_rows
from fatigue.pipeline.mission.plan import mission_plan
from fatigue.pipeline.run.work import ScreeningOptions, open_work
from fatigue.pipeline.solve.body import read_body
from fatigue.pipeline.solve.model import read_model
from fatigue.pipeline.solve.point_stress import point_stress
from fatigue.pipeline.solve.weld_groups import one_group
from tests.carbody_loads import FOLDER, car_body
from tests.carbody_stresses import DATA, FORCES, tables
from tests.stress_point_case import curve_text

MIDDLE = ("toe_neg_500", "toe_pos_500")


@pytest.fixture(scope="module")
def written():
    """The tables as they follow from the forces of the elements."""
    return tables()


def test_shipped_tables_are_those_of_the_forces(written):
    """The shipped tables are written again, to single precision."""
    points, stress = written
    pd.testing.assert_frame_equal(pd.read_csv(FOLDER / "stress_points.csv"), points, check_dtype=False)
    shipped = pd.read_parquet(FOLDER / "modal_stresses.parquet")
    pd.testing.assert_frame_equal(shipped, stress, check_dtype=False, rtol=1e-6, atol=1e-6)


def test_forces_are_those_of_the_stiffness():
    """The forces of an element lie in the range of its stiffness, so that its strains follow from them."""
    body = car_body()
    forces = pd.read_parquet(DATA / "carbody_element_forces.parquet").sort_values(["element", "node", "mode"])
    for element, of_element in list(forces.groupby("element"))[::9]:
        k = int(np.searchsorted(body.element, element))
        by_node = of_element.set_index("node")
        f = np.stack([by_node.loc[node, FORCES].to_numpy(float).T for node in body.node[body.model.quads[k]]])
        f, K = f.reshape(24, -1), body.model.stiffness[k]
        assert np.abs(K @ np.linalg.pinv(K, rcond=1e-9) @ f - f).max() < 1e-7 * np.abs(f).max()


def test_hot_spots_in_the_middle_have_the_structural_stress(written):
    """Mode by mode the extrapolated stress across the weld is that of the line forces there, 7 % lower."""
    points, stress = written
    model = read_model(FOLDER / "case.toml")
    stations, names = model.stations, [weld.name for weld in model.stations.welds]
    for point in points[points["point"].isin(MIDDLE)].itertuples():
        at = stress[stress["point"] == point.point].pivot_table(index="mode", columns="read_out", values="sx_MPa")
        hot_spot = (1.5 * at[1] - 0.5 * at[2]).to_numpy()
        near = (stations.weld == names.index(point.weld)) & (np.abs(stations.xyz[:, 1] - point.y_mm) < 13.0)
        structural = (stations.treated.membrane + stations.treated.bending)[near].mean(axis=0)
        assert np.linalg.norm(hot_spot) / np.linalg.norm(structural) == pytest.approx(0.93, abs=0.01)
        assert np.corrcoef(hot_spot, structural)[0, 1] > 0.9998


def test_points_of_the_body_are_assessed(tmp_path):
    """Tables, frames and curves pass without a warning under an event of the example."""
    text = (FOLDER / "case.toml").read_text(encoding="utf-8")
    files = 'stress_points = "stress_points.csv"\nmodal_stresses = "modal_stresses.parquet"'
    text = text.replace("[body]", f"[body]\n{files}").replace("share = 0.70", "share = 1.0")
    text = "[[mission.event]]".join(text.split("[[mission.event]]")[:2]) + "[counting]\nupsample = 1\n"
    text += curve_text("hot_spot", 40.0, slopes=(3.4,)) + curve_text("plate", 71.0, "parent", slopes=(5.0,))
    for file in FOLDER.iterdir():
        (tmp_path / file.name).symlink_to(file)
    path = tmp_path / "case_points.toml"
    path.write_text(text, encoding="utf-8")
    body = read_body(load_case(path), strict=True)
    assert not [warning for warning in body.warnings if "stress" in warning.where]
    stress, warnings = point_stress(body)
    assert warnings == []
    plan, _ = mission_plan(body)
    work = open_work(one_group(body, tmp_path / "f"), plan, ScreeningOptions(0.0), tmp_path, threads=1)
    rows = pd.DataFrame(point_rows(body.points, stress, body.curves, work.loads, plan, 1))
    assert len(rows) == 8 * 2 + 4 * 2
    planes = rows[rows["component"] == "planes_60"].set_index("point")["damage_sum"]
    normal = rows[rows["component"] == "normal"].set_index("point")["damage_sum"]
    assert (planes >= normal).all()
    assert (planes[[*MIDDLE]] < 1.1 * normal[[*MIDDLE]]).all()  # far from the ends the stress is across the weld
    assert (rows["damage_sum"] > 0.0).all()
