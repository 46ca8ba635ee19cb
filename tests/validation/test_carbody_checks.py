"""The shipped car body with checks beside the toe: its files belong together, and the case says what is invented."""

import shutil
from pathlib import Path

import numpy as np
import pandas as pd

from fatigue.assess import assess
from fatigue.case import load_case
from fatigue.pipeline.solve.body import read_body

MULTIAXIAL_OFF = '[multiaxial]\nmethod = "off"\n[mission]'
FOLDER = Path(__file__).parents[2] / "data" / "carbody"


def test_the_case_with_checks_is_whole():
    """Every curve that throats and points name is there, and only unverified or invented ones."""
    case = load_case(FOLDER / "case_checks.toml")
    body = read_body(case, strict=True)
    status = {name: rated.curve.status for name, rated in body.curves.items() if name != "master-aluminium"}
    assert set(status.values()) == {"user", "unverified"}
    assert all("invented" in case.curves[name].source for name, is_from in status.items() if is_from == "user")


def test_static_cases_are_compared_with_one_command(tmp_path):
    """Corners and pairs of the shipped load cases are those of the stress per unit load, by hand."""
    shutil.copytree(FOLDER, tmp_path / "body", ignore=shutil.ignore_patterns("q_*9hz*", "q_380*", "modal_stresses*"))
    case = tmp_path / "body" / "case_endurance.toml"
    text = case.read_text().replace("[counting]", "[counting]\nupsample = 1").replace("[mission]", MULTIAXIAL_OFF)
    case.write_text(text)
    assess(case, tmp_path / "result", report=False, threads=1)
    checks = pd.read_parquet(tmp_path / "result" / "checks.parquet")
    assert set(checks["check"]) == {"endurance"}

    per_unit = pd.read_parquet(tmp_path / "result" / "structural_stress.parquet").dropna(subset=["unit_load"])
    at = ["weld", "order", "unit_load"]
    membrane, bending = (per_unit.set_index(at)[f"{part}_MPa"].unstack() for part in ("membrane", "bending"))  # noqa: PD010
    across = checks[checks["component"] == "perp"].set_index(at[:2])
    side = np.where(across["surface"] == "bottom", -1.0, 1.0)
    stress = membrane.loc[across.index] + bending.loc[across.index].mul(side, axis=0)
    g, payload, kPa, kN = (stress[name].to_numpy() for name in ("gravity", "payload", "tunnel_pressure", "coupler"))

    rides = across["governing_event"].str.contains("bounce").to_numpy()
    of_ride = 0.15 * abs(g + 8.0 * payload) + 100.0 * abs(kN) + 0.5 * abs(kPa)
    mean = g + 8.0 * payload
    of_stops = np.stack([g, mean, mean + 250.0 * kN, mean - 250.0 * kN])
    amplitude, R = across["amplitude_MPa"].to_numpy(), across["R"].to_numpy()
    np.testing.assert_allclose(amplitude[rides], of_ride[rides], rtol=1e-9)
    np.testing.assert_allclose(R[rides], ((mean - of_ride) / (mean + of_ride))[rides], rtol=1e-9)
    assert (amplitude[~rides] <= 0.5 * np.ptp(of_stops, axis=0)[~rides] * (1.0 + 1e-9)).all()
