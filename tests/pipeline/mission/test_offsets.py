"""Constants of an event: the mean of the kept samples, whatever is counted between them, and what the case gives."""

import numpy as np
import pandas as pd
import pytest

from fatigue.case import load_case
from fatigue.pipeline.mission.events import event_load, mean_levels
from fatigue.pipeline.mission.offsets import _mean_of_every, face_offset
from fatigue.pipeline.solve.body import read_body
from tests.small_case import SmallCase, small_case


def with_load(folder, given: str) -> SmallCase:
    """The small case with a unit load, whose forces are those of mode 1; ``given`` by the first event."""
    case = small_case()
    folder.mkdir(parents=True, exist_ok=True)
    forces = case.nodal_forces[case.nodal_forces["mode"] == 1].drop(columns="mode")
    forces.assign(unit_load="door").to_csv(folder / "door.csv", index=False)
    case.events = [{"name": "sine", "history": "sine", "residue": "half", "per_1000_km": 3.0, "stress_factor": 1.5}]
    case.counting = {"upsample": 1, "mean_of_q": "remove"}
    case.extra = '[[mission.event.unit_load]]\nname = "door"\nunit = "kN"\n' + given
    case.extra += '[[body.unit_load]]\nname = "door"\nunit = "kN"\nnodal_forces = "door.csv"\n'
    return case


def load_of(case: SmallCase, folder):
    """What the event brings, and the body."""
    body = read_body(load_case(case.write(folder)), strict=False)
    return event_load(body, body.case.mission.event[0], 1), body


@pytest.mark.parametrize("factor", [2, 8])
def test_mean_of_every_so_many_samples(factor):
    """Across chunks of any length."""
    q = np.random.default_rng(3).normal(2.0, 1.0, (3, 100_001))
    np.testing.assert_allclose(_mean_of_every(factor, q), q[:, ::factor].mean(axis=1), rtol=1e-12)


def test_given_constants_and_means_of_modes(tmp_path):
    """Times its scale; the mean of every mode is taken off. The faces get both, with the factor of the event."""
    case = with_load(tmp_path, "constant = 3.0\nscale = 2.0\n")
    case.histories["sine"]["q_2"] += 7.0
    load, body = load_of(case, tmp_path)
    q = case.histories["sine"][["q_1", "q_2", "q_7"]].to_numpy()
    np.testing.assert_allclose(load.offset, [*-q.mean(axis=0), 6.0], atol=1e-12)
    np.testing.assert_allclose(load.level, [0.0, 0.0, 0.0, 6.0], atol=1e-12)
    membrane, bending = 1.5 * np.array([[1.0, 2.0, 0.0, 4.0]]), 1.5 * np.array([[0.0, 0.0, 0.0, 1.0]])
    found = face_offset(membrane, bending, load)
    np.testing.assert_allclose(found, 1.5 * np.array([[24.0, 24.0]]) - 21.0 + [[9.0, -9.0]])
    (level,) = mean_levels(body, tmp_path)
    np.testing.assert_allclose(level.mean, [*q.mean(axis=0), 0.0], atol=1e-12)
    np.testing.assert_array_equal(level.constant, [0.0, 0.0, 0.0, 6.0])


def test_a_load_over_time_keeps_its_mean(tmp_path):
    """And where it is finer than a single pass, the mean of q is still that of the samples of the file."""
    case = with_load(tmp_path, 'history = "door_history.csv"\n')
    t = case.histories["sine"]["time_s"].to_numpy()
    case.histories["sine"]["q_1"] = 40.0 + 5.0 * t
    fine = np.arange(4 * (len(t) - 1) + 1) * (t[1] - t[0]) / 4
    pd.DataFrame({"time_s": fine, "u_door": 2.0 + np.sin(fine)}).to_csv(tmp_path / "door_history.csv", index=False)
    load, _ = load_of(case, tmp_path)
    assert load.counted.q.shape[1] == len(fine)
    assert load.offset[0] == pytest.approx(-(40.0 + 5.0 * t).mean(), rel=1e-12)
    assert load.offset[3] == 0.0
    assert load.level[3] == pytest.approx((2.0 + np.sin(fine)).mean(), rel=1e-9)


def test_nothing_constant_costs_nothing(tmp_path):
    """No array of offsets is made where nothing is constant."""
    case = small_case()
    load, _ = load_of(case, tmp_path)
    assert not load.offset.any()
    assert face_offset(np.ones((4, 3)), np.ones((4, 3)), load) is None
