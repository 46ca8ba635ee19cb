"""How a resonance forms, from a whole case: classes, parts, what a swing costs and where, and what cannot be had."""

import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from fatigue.assess import assess
from fatigue.case import load_case
from fatigue.diagnose import diagnose
from fatigue.errors import CaseError
from fatigue.results import json_ready, read_provenance
from fatigue.vibration.excitation import quasi_static
from fatigue.why.findings import Diagnosis
from tests.small_case import STEP, SmallCase, small_case
from tests.unit_load_case import as_unit_load, write_with_loads
from tests.why.formation.swinging_case import BURST, HUNTING_HZ, ZETA, swinging_case

TABLES = ("resonance", "weld_resonance", "watch")
POINT = ["weld", "part", "order", "surface"]
STATIC = """
[[mission.event]]
name = "lift"
per_1000_km = 3
[[mission.event.unit_load]]
name = "pull"
unit = "kN"
values = [0.0, 60.0]
"""


@dataclass
class Formed:
    """A diagnosed result and its tables."""

    folder: Path
    said: Diagnosis
    resonance: pd.DataFrame
    weld_resonance: pd.DataFrame
    watch: pd.DataFrame

    def mode(self, event, mode):
        """Row of a mode in an event."""
        rows = self.resonance[(self.resonance["event"] == event) & (self.resonance["mode"] == mode)]
        assert len(rows) == 1
        return rows.iloc[0]


def run(case: SmallCase, folder: Path, **options: object) -> Formed:
    """Assess and diagnose a case."""
    assess(load_case(case.write(folder / "case")), folder / "result", threads=1, report=False)
    said = diagnose(folder / "result", **options)
    return Formed(folder / "result", said, *(pd.read_parquet(folder / "result" / f"{name}.parquet") for name in TABLES))


def life_of(case: SmallCase, folder: Path, point: pd.Series) -> float:
    """Life of one point, by an assessment."""
    assess(load_case(case.write(folder / "case")), folder / "result", threads=1, report=False)
    nodes = pd.read_parquet(folder / "result" / "nodes.parquet")
    return float(nodes.set_index(POINT).loc[tuple(point[POINT]), "life_km"])


@pytest.fixture(scope="module")
def formed(tmp_path_factory: pytest.TempPathFactory) -> Formed:
    """Diagnosis of the case with a mode that swings."""
    return run(swinging_case(), tmp_path_factory.mktemp("formed"))


def test_who_swings_and_who_follows(formed):
    """Mode 1 swings in the burst, not without it; mode 2 follows slow loads; the interface mode is far above."""
    assert formed.mode("worn", 1)["class"] == "resonant"
    assert formed.mode("worn", 1)["response_hz"] == pytest.approx(HUNTING_HZ, abs=0.15)
    assert formed.mode("worn", 1)["amplification"] > 2.0
    assert formed.mode("calm", 1)["class"] == "quasi_static"
    for event in ("worn", "calm"):
        row = formed.mode(event, 2)
        assert row["class"] == "quasi_static"
        assert row["dynamic_share"] == pytest.approx((1.1 / 12.0) ** 2, rel=0.5)
        assert row["excitation_hz"] == pytest.approx(row["response_hz"], abs=0.05)
        assert formed.mode(event, 7)["class"] == "quasi_static"
    assert (formed.resonance[formed.resonance["event"] == "load and unload"]["class"] == "not_assessed").all()


def test_every_mode_of_every_event_has_a_row_and_a_reason_for_what_is_empty(formed):
    """Three modes, three events; where a number is empty, the row says why."""
    assert len(formed.resonance) == 9
    numbers = ["rms_q", "dynamic_share", "half_power_share", "excitation_hz", "response_hz"]
    empty = formed.resonance[numbers].isna().any(axis=1)
    assert formed.resonance["reason"][empty].notna().all()
    assert pd.isna(formed.mode("worn", 7)["damping_source"])
    assert "no damping ratio" in formed.mode("worn", 7)["reason"]
    assert formed.mode("worn", 1)["damping_ratio"] == ZETA
    assert "2 samples" in formed.mode("load and unload", 1)["reason"]


def test_the_swing_that_costs_most(formed):
    """Rank 1 is mode 1 in the worn event, within its burst; an assessment without its swing has the life it says."""
    first = formed.watch[formed.watch["rank"] == 1].iloc[0]
    assert (first["event"], first["mode"], first["class"]) == ("worn", 1, "resonant")
    assert BURST[0] <= first["start_s"] < first["end_s"] <= BURST[1] + 3.0
    km_per_s = 180.0 / 3600.0
    assert first["start_km"] == pytest.approx((first["start_s"] - 2.0) * km_per_s, abs=1e-9)
    assert first["cost_km"] == pytest.approx(first["life_km_without"] - first["life_km"])
    assert first["cost_km"] > 0.0
    assert first["damage_share"] == pytest.approx(1.0 - first["life_km"] / first["life_km_without"])
    assert first["utilisation_cost"] == pytest.approx(1e6 * (1.0 / first["life_km"] - 1.0 / first["life_km_without"]))


def test_the_cost_by_a_second_assessment(formed, tmp_path):
    """The worn record with mode 1 replaced by its quasi-static part, through the whole pipeline: the same life."""
    first = formed.watch.sort_values("rank").iloc[0]
    case = swinging_case()
    worn = case.histories["worn"]
    kept = slice(round(2.0 / STEP), None)
    q = worn["q_1"].to_numpy().copy()
    q[kept] = quasi_static(q[None, kept], STEP, np.array([5.0]), np.array([ZETA]))[0]
    worn["q_1"] = q
    assert life_of(case, tmp_path, first) == pytest.approx(first["life_km_without"], rel=1e-9)


def test_both_parts_of_the_stress(formed):
    """The dominant frequency of the worn event is hunting; either part alone damages less than the whole there."""
    worn = formed.weld_resonance[formed.weld_resonance["event"] == "worn"]
    calm = formed.weld_resonance[formed.weld_resonance["event"] == "calm"]
    assert len(worn) == 2
    assert worn["dominant_hz"].to_numpy() == pytest.approx(HUNTING_HZ, abs=0.2)
    assert (worn["damage_per_km_dynamic"] > worn["damage_per_km_quasi_static"]).all()
    assert (worn["damage_per_km_quasi_static"] < worn["damage_per_km"]).all()
    assert (calm["dynamic_share"] < 0.1).all()
    assert calm["damage_per_km_quasi_static"].to_numpy() == pytest.approx(calm["damage_per_km"].to_numpy(), rel=0.2)
    total = formed.weld_resonance.groupby("weld")["damage_per_km"].sum()
    nodes = pd.read_parquet(formed.folder / "nodes.parquet").groupby("weld")["damage_per_km"].max()
    assert total.to_numpy() == pytest.approx(nodes.to_numpy(), rel=1e-9)


def test_what_is_said(formed):
    """A line for each weld and each event, the thresholds, and the same for machines."""
    text = " ".join(formed.said.as_text().split())
    assert "watch mode 1 (5 Hz, resonant) in worn, half of it at km" in text
    assert "worn: mode 1 (5 Hz) in resonance; 2 follow their loads" in text
    assert "load and unload: not available, the record of 2 samples is too short" in text
    assert "0.5 of its rms or more" in text
    assert "without damping ratio a mode is split as if it had none" in text
    record = json.loads(json.dumps(json_ready(formed.said.as_record())))
    assert record["findings"][0]["watch"][0]["mode"] == 1
    assert record["modes"][0]["resonant"] == [{"mode": 1, "frequency_hz": 5.0}]


def test_a_result_without_damping(tmp_path, formed):
    """Without damping ratios the lives are the same to a hundredth, and the half-power shares are empty."""
    case = swinging_case()
    del case.modes["damping_ratio"]
    found = run(case, tmp_path)
    key = ["weld", "event", "mode"]
    there, here = (one.watch.set_index(key)["life_km_without"].sort_index() for one in (formed, found))
    assert here.to_numpy() == pytest.approx(there.to_numpy(), rel=1e-2)
    assert found.resonance["half_power_share"].isna().all()
    assert found.resonance["damping_ratio"].isna().all()
    assert found.mode("worn", 1)["class"] == "resonant"
    assert np.isnan(found.mode("worn", 1)["excitation_hz"])
    assert "within 10% of its frequency" in found.mode("worn", 1)["reason"]
    assert found.mode("worn", 2)["excitation_hz"] == pytest.approx(formed.mode("worn", 2)["excitation_hz"], abs=0.01)


def test_an_assumed_damping_is_recorded_and_said(tmp_path):
    """It is of modes without their own; tables, provenance and text name it, and resonant shares are there."""
    found = run(swinging_case(), tmp_path, damping=0.03)
    assert found.mode("worn", 1)["damping_ratio"] == ZETA
    assert found.mode("worn", 7)["damping_ratio"] == 0.03
    assert found.mode("worn", 7)["damping_source"] == "assumed"
    said = read_provenance(found.folder)["diagnosis"]
    assert said["assumed_damping_ratio"] == 0.03
    assert said["class_thresholds"]["dynamic_share"] == 0.5
    assert "a damping ratio of 0.03 was assumed for 1 of 3 modes" in " ".join(found.said.as_text().split())
    attribution = pd.read_parquet(found.folder / "attribution.parquet")
    assert attribution[attribution["mode"] == 7]["resonant_share"].notna().all()


@pytest.mark.parametrize("damping", [-0.01, 1.0, 1.5, np.nan, "much"])
def test_a_senseless_damping_is_refused(tmp_path, damping):
    """One line that says what to give."""
    with pytest.raises(CaseError, match=r"1\.5 % are 0\.015"):
        diagnose(tmp_path, damping=damping)


@pytest.mark.parametrize("name", ["upsampled", "upsampled, single pass", "vertex", "mean stress", "knee"])
def test_costs_under_other_rules(name, tmp_path):
    """However cycles are counted, the swing costs what a second assessment says, and the place stays."""
    case = swinging_case()
    if name.startswith("upsampled"):
        case.counting |= {"upsample": 4}
    if name.endswith("single pass"):
        case.counting |= {"residue": "half"}
    if name == "vertex":
        case.counting |= {"reversals": "vertex"}
    if name == "mean stress":
        case.curve |= {"mean_stress": "asme", "yield_MPa": 200.0}
    if name == "knee":
        case.curve |= {"extension": "haibach", "knee_cycles": 1e6}
    found = run(case, tmp_path / "first")
    first = found.watch.sort_values("rank").iloc[0]
    assert (first["event"], first["mode"]) == ("worn", 1)
    assert BURST[0] - 0.5 <= first["start_s"] < first["end_s"] <= BURST[1] + 3.0
    q = case.histories["worn"]["q_1"].to_numpy().copy()
    kept = slice(round(2.0 / STEP), None)
    q[kept] = quasi_static(q[None, kept], STEP, np.array([5.0]), np.array([ZETA]))[0]
    case.histories["worn"]["q_1"] = q
    assert life_of(case, tmp_path / "second", first) == pytest.approx(first["life_km_without"], rel=1e-6)


def test_awkward_modes(tmp_path):
    """A rigid mode, one at rest, one slower than its record, one that nothing near it excites: a reason for each."""
    case = small_case()
    case.modes["frequency_hz"] = [0.0, 0.1, 60.0]
    case.modes["kind"] = ["rigid", "normal", "normal"]
    for history in case.histories.values():
        history["q_7"] = 0.0
    found = run(case, tmp_path)
    assert "rigid" in found.mode("noise", 1)["reason"]
    assert "fewer than 4 periods" in found.mode("noise", 2)["reason"]
    assert "does not move" in found.mode("noise", 7)["reason"]
    assert (found.resonance["class"] == "not_assessed").all()
    assert found.watch.empty
    assert "watch" in found.said.as_text()


def test_a_load_above_the_mode_is_held_back_by_inertia(tmp_path):
    """A sine of 5 Hz on a mode of 2 Hz: inertial, dynamic share r^2, and no resonance to watch."""
    case = small_case()
    case.modes["frequency_hz"] = [2.0, 12.0, 60.0]
    case.modes["damping_ratio"] = 0.02
    found = run(case, tmp_path)
    row = found.mode("sine", 1)
    assert row["class"] == "inertial"
    assert row["dynamic_share"] == pytest.approx(2.5**2, rel=0.01)
    assert row["amplification"] == pytest.approx(1.0 / (2.5**2 - 1.0), rel=0.01)
    assert not (found.watch["event"] == "sine").any()


def test_an_undamaged_result_has_tables_too(tmp_path):
    """Where nothing damages there is no weld to watch; the modes have their classes."""
    case = swinging_case()
    for history in case.histories.values():
        history[["q_1", "q_2", "q_7"]] = 0.0
    found = run(case, tmp_path)
    assert found.watch.empty
    assert found.weld_resonance.empty
    assert len(found.resonance) == 9


def test_costs_with_cycles_across_events(tmp_path):
    """In a loop of events the cycles across them are counted again as well: the life of a second assessment."""
    case = swinging_case()
    case.extra = '[[mission.sequence]]\norder = ["worn", "load and unload", "calm"]\nper_1000_km = 300\n'
    for event in case.events:
        for key in ("share", "speed_km_h"):
            event.pop(key, None)
        event["per_1000_km"] = 400.0
    found = run(case, tmp_path / "first")
    first = found.watch.sort_values("rank").iloc[0]
    assert (first["event"], first["mode"]) == ("worn", 1)
    q = case.histories["worn"]["q_1"].to_numpy().copy()
    kept = slice(round(2.0 / STEP), None)
    q[kept] = quasi_static(q[None, kept], STEP, np.array([5.0]), np.array([ZETA]))[0]
    case.histories["worn"]["q_1"] = q
    assert life_of(case, tmp_path / "second", first) == pytest.approx(first["life_km_without"], rel=1e-6)


def test_a_unit_load_is_its_own_quasi_static_part(tmp_path):
    """A load has no mode to watch and no row among the modes; a static load case follows entirely."""
    case = swinging_case()
    path = write_with_loads(case, tmp_path / "case", as_unit_load(case, 2, "pull"))
    path.write_text(path.read_text(encoding="utf-8") + STATIC, encoding="utf-8")
    assess(load_case(path), tmp_path / "result", threads=1, report=False)
    said = diagnose(tmp_path / "result")
    modes, welds, watch = (pd.read_parquet(tmp_path / "result" / f"{name}.parquet") for name in TABLES)
    assert set(modes["mode"]) == {1, 7}
    assert set(watch["mode"]) == {1}
    lift = welds[welds["event"] == "lift"]
    assert (lift["damage_per_km"] > 0.0).any()
    assert lift["damage_per_km_quasi_static"].to_numpy() == pytest.approx(lift["damage_per_km"].to_numpy())
    assert (lift["damage_per_km_dynamic"] == 0.0).all()
    assert lift["reason"].str.contains("static load case").all()
    assert (modes[modes["event"] == "lift"]["class"] == "not_assessed").all()
    assert "lift: not available, a static load case has no time" in " ".join(said.as_text().split())
