"""A reduced body as the car body of a vehicle: energy and force are the same in mm, t, s and in SI."""

import json
import shutil

import numpy as np
import pandas as pd
import pytest

from fatigue.errors import DataError
from fatigue.reduce.bases import Recipe
from fatigue.reduce.story import reduce
from fatigue.study.reduced_body import coordinates_of_folder, reduced_body
from tests.reduce.small_body import FORCES, vehicle_interface, write_model

FLOOR = 1.15


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """The small body with all points that a vehicle needs, two of them with rotations."""
    model = write_model(tmp_path_factory.mktemp("model"))
    out = tmp_path_factory.mktemp("reduced") / "body"
    reduce(model, vehicle_interface(model), out, Recipe(cut_hz=300.0))
    return out


def test_energy_displacement_and_force_agree(folder):
    """The same motion has the same displacement, kinetic and elastic energy and weld force in both unit systems."""
    body, modes = reduced_body(folder, FLOOR), pd.read_csv(folder / "modes.csv")
    p = np.random.default_rng(5).standard_normal(len(body.frequency_hz))  # SI: m sqrt(kg)
    q = coordinates_of_folder(p)
    w = 2.0 * np.pi * modes["frequency_hz"].to_numpy()
    joule = 1e-3  # of N mm, which is t mm2/s2
    assert 0.5 * np.sum(p**2) == pytest.approx(joule * 0.5 * np.sum(q**2), rel=1e-12)  # per (rad/s)^2
    assert 0.5 * np.sum((w * p) ** 2) == pytest.approx(joule * 0.5 * np.sum((w * q) ** 2), rel=1e-12)
    table = pd.concat([pd.read_csv(folder / f"{name}_shapes.csv") for name in ("interface", "observed")])
    for (point, direction), of in table.groupby(["point", "direction"]):
        in_mm = of["value"].to_numpy() @ q
        in_si = body.points[point].shape[("x", "y", "z", "rx", "ry", "rz").index(direction)] @ p
        assert in_si == pytest.approx(in_mm * (1e-3 if len(direction) == 1 else 1.0), rel=1e-9)
    forces = pd.read_parquet(folder / "nodal_forces.parquet")
    one = forces[forces["node"] == forces["node"].iloc[0]][FORCES].to_numpy().astype(float)
    power_mm, power_si = one.T @ q, (one * np.sqrt(1000.0)).T @ p  # force per SI coordinate = force sqrt(1000)
    assert power_si == pytest.approx(power_mm, rel=1e-12)


def test_work_of_a_unit_force_is_its_flexibility(folder):
    """``sum psi^2/w^2`` in m/N is the flexibility of the folder in mm/N: shapes and energies belong together."""
    body, static = reduced_body(folder, FLOOR), pd.read_csv(folder / "flexibility.csv")
    w2 = (2.0 * np.pi * body.frequency_hz) ** 2
    for row in static.itertuples():
        shape = body.points[row.point].shape["xyz".index(row.direction)]
        assert np.sum(shape**2 / w2) == pytest.approx(1e-3 * row.value_mm_per_N, rel=1e-6)


def test_rigid_part_and_places(folder):
    """Mass in kg, inertia in kg m2, places in m above rail top; a rotation nobody asked for is NaN."""
    body, record = reduced_body(folder, FLOOR), json.loads((folder / "reduce.json").read_text())
    assert body.mass == pytest.approx(1e3 * record["mass_t"])
    assert body.cg[2] == pytest.approx(FLOOR + 1e-3 * record["cg_mm"][2])
    # a box: the sum of two moments of inertia is above the third, and of the size m l^2 / 12
    assert body.inertia[1, 1] == pytest.approx(body.mass * (1.2**2 + 0.3**2) / 12.0, rel=0.3)
    assert body.points["converter_1"].place == pytest.approx([0.6, 0.1, FLOOR - 0.08])
    assert np.isnan(body.points["converter_1"].shape[3:]).all()
    assert np.isfinite(body.points["roof_mid"].shape).all()


def test_points_that_a_vehicle_needs(tmp_path):
    """A body without them is refused with their names."""
    model = write_model(tmp_path / "model")
    reduce(model, model / "interface.csv", tmp_path / "body", Recipe(cut_hz=300.0))
    with pytest.raises(DataError, match=r"lacks the points converter_2, .* transformer_4, where the suspension"):
        reduced_body(tmp_path / "body", FLOOR)


def test_folders_of_others(folder, tmp_path):
    """No record, or tables that were changed since, are no reduced body."""
    with pytest.raises(DataError, match="no reduced body"):
        reduced_body(tmp_path, FLOOR)
    copy = tmp_path / "copy"
    shutil.copytree(folder, copy)
    modes = (copy / "modes.csv").read_text()
    (copy / "modes.csv").write_text(modes.replace("normal", "interface"))
    with pytest.raises(DataError, match=r"modes.csv: was changed since fatigue reduce wrote it"):
        reduced_body(copy, FLOOR)
    (copy / "modes.csv").unlink()
    with pytest.raises(DataError, match=r"modes.csv: is not there any more"):
        reduced_body(copy, FLOOR)
