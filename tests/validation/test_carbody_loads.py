"""The unit loads of the shipped car body: complete, in balance, and what the multibody simulation has in its mean."""

import numpy as np
import pandas as pd
import pytest

from fatigue.assess import assess
from fatigue.pipeline.solve.model import read_model
from fatigue.results import read_provenance
from fatigue.verify.recount import recount
from tests.carbody_loads import (
    CONVERTER_T,
    FOLDER,
    FORCES,
    LOADS,
    G,
    applied_forces,
    areas,
    car_body,
    element_loads,
    outward,
    tunnel_pressure,
    unit_loads,
    windows,
)


@pytest.fixture(scope="module")
def body():
    """The shell model."""
    return car_body()


@pytest.fixture(scope="module")
def shipped():
    """Forces of the unit loads, as shipped."""
    return pd.read_parquet(FOLDER / "unit_loads.parquet")


def test_applied_forces_have_the_resultants_of_their_loads(body):
    """Weight of body and converter, weight of 1 t, no net pressure, no net coupler force."""
    total = applied_forces(body, element_loads(body))[:, :, :3].sum(axis=1)
    weight = (areas(body.model.xyz[body.model.quads]) * body.area_mass).sum() + CONVERTER_T
    assert weight - CONVERTER_T == pytest.approx(33.8, abs=0.01)
    np.testing.assert_allclose(total[:, 2], [-G * weight, -G, 0.0, 0.0], atol=1e-6 * G, rtol=1e-6)
    np.testing.assert_allclose(total[:, :2], 0.0, atol=1e-3)


def test_hull_is_the_closed_box(body):
    """Ends, sides with their panes, floor and roof have the areas of the box."""
    corners = body.model.xyz[body.model.quads].astype(float)
    of_side = areas(corners) @ abs(outward(corners.mean(axis=1)))
    of_side[1] += sum(area for _, area, _ in windows(body.model))
    np.testing.assert_allclose(of_side, [2 * 3000 * 2600, 2 * 24500 * 2600, 2 * 24500 * 3000], rtol=1e-4)


def test_every_weld_node_has_every_load(shipped):
    """One row per load and weld node, each with force."""
    nodes = pd.read_csv(FOLDER / "weld_nodes.csv")[["weld", "node"]]
    assert len(shipped) == len(LOADS) * len(nodes)
    for load, rows in shipped.groupby("unit_load", sort=False):
        assert load in LOADS
        pd.testing.assert_frame_equal(rows[["weld", "node"]].reset_index(drop=True), nodes, check_dtype=False)
        assert (rows[FORCES[:3]].abs().max(axis=1) > 0.0).all()


def test_mean_of_the_modal_coordinates_is_the_stress_under_gravity(shipped):
    """Two programs, one dead load: the mean of q gives the stress that the shell model has under gravity."""
    model = read_model(FOLDER / "case.toml")
    stations = model.stations
    record = pd.read_parquet(FOLDER / "q_350_sound_14hz.parquet")
    mean = record.iloc[250:][[f"q_{mode}" for mode in model.modes.mode]].mean().to_numpy()
    gravity = shipped[shipped["unit_load"] == "gravity"].set_index(["weld", "node"])
    index = pd.MultiIndex.from_arrays([[stations.names[i] for i in stations.weld], stations.node])
    force = gravity.loc[index, FORCES[:3]].to_numpy()
    modal = pd.read_parquet(FOLDER / "nodal_forces.parquet").set_index(["weld", "node", "mode"]).sort_index()
    of_mean = np.stack([mean @ modal.loc[key, FORCES[:3]].loc[model.modes.mode].to_numpy() for key in index])
    assert (of_mean * force).sum() / (force**2).sum() == pytest.approx(1.0, abs=0.05)
    assert (of_mean * force).sum() / np.sqrt((of_mean**2).sum() * (force**2).sum()) > 0.95


def test_pressure_of_the_tunnel_is_what_is_written_down():
    """The shipped record is the one of the formula, from rest."""
    pd.testing.assert_frame_equal(pd.read_csv(FOLDER / "p_tunnel.csv"), tunnel_pressure())
    assert abs(tunnel_pressure()["u_tunnel_pressure"].iloc[:100]).max() < 0.02


@pytest.mark.slow
def test_shipped_forces_are_those_of_the_shell_model(shipped):
    """The file holds what the static solutions give, in single precision."""
    again = unit_loads()
    for (load, weld), rows in again.groupby(["unit_load", "weld"]):
        old = shipped[(shipped["unit_load"] == load) & (shipped["weld"] == weld)]
        numbers = rows.columns[3:]
        size = np.abs(rows[numbers]).to_numpy().max(axis=0)
        np.testing.assert_allclose(old[numbers], rows[numbers], rtol=1e-4, atol=1e-4 * size.max())


@pytest.mark.slow
def test_the_body_with_all_its_loads_is_recounted(tmp_path):
    """Offsets, a tunnel on a grid of its own, a static load case and a sequence: the independent recount agrees."""
    assess(FOLDER / "case_loads.toml", tmp_path, report=False)
    found = recount(tmp_path)
    assert found.passed, found.as_text()
    nodes = pd.read_parquet(tmp_path / "nodes.parquet")
    assert (nodes.loc[nodes["weld"].str.startswith("W3"), "governing_event"] == "tunnel").any()
    gravity = read_provenance(tmp_path)["gravity"]
    assert {one["verdict"] for one in gravity} == {"contained", "absent"}
