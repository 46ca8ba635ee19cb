"""All loads of the proof recounted: unit loads, what is constant, cycles across events, vertices, classes of ranges."""

import shutil
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from fatigue.assess import assess
from fatigue.case import load_case
from fatigue.verify.recount import recount
from tests.older_result import without_hashes
from tests.verify.test_recount import differing, edit
from tests.verify.vanishing import case

FORCES = ["fx_N", "fy_N", "fz_N", "mx_Nmm", "my_Nmm", "mz_Nmm"]
BODY = """[[body.unit_load]]
name = "pressure"
unit = "kPa"
nodal_forces = "loads.csv"
when_missing = "zero"
[[body.unit_load]]
name = "gravity"
unit = "g"
nodal_forces = "loads.csv"
"""
GRAVITY = """
[[mission.unit_load]]
name = "gravity"
unit = "g"
constant = 1.0
"""
PASSING = """
[[mission.event]]
name = "passing"
history = "noise.csv"
per_1000_km = 3.0
start_s = 0.6
stress_factor = 1.2
{event}
[[mission.event.unit_load]]
name = "pressure"
unit = "kPa"
history = "p.csv"
scale = -2.0
{load}
"""
PAYLOAD = """
[[mission.event]]
name = "payload"
per_1000_km = 2.0
[[mission.event.unit_load]]
name = "gravity"
unit = "g"
values = [1.0, 1.4, 0.9]
scale = 1.5
[[mission.event.unit_load]]
name = "pressure"
unit = "kPa"
constant = 2.0
"""
LOOP = """
[[mission.sequence]]
order = ["sine", "load and unload", "noise", "passing"]
per_1000_km = 0.4
[[mission.sequence]]
order = ["noise", "sine", "noise"]
per_1000_km = 0.2
"""
BENT = {"name": "master-steel", "extension": "haibach", "mean_stress": "asme", "yield_MPa": 20.0}


def pressure(step: float, samples: int) -> pd.DataFrame:
    """A load over time in a file of its own."""
    noise = np.random.default_rng(5).standard_normal(samples)
    return pd.DataFrame({"time_s": step * np.arange(samples), "u_pressure": np.convolve(noise, np.ones(9) / 3, "same")})


def written(folder: Path, load: pd.DataFrame, mission: str, counting: dict, curve: dict) -> Path:
    """Write the small case with two unit loads, and levels of its events that differ."""
    made = case(seconds=2.4)
    made.counting, made.curve = {"upsample": 1, **counting}, {**made.curve, **curve}
    for name, level in (("sine", 40.0), ("noise", 90.0)):
        made.histories[name]["q_1"] += level
    made.histories["sine"]["q_1"] *= 1.0 + 0.01 * made.histories["sine"]["time_s"]  # of equal peaks any may be paired
    made.events[0]["mean_of_q"] = "remove"
    rng = np.random.default_rng(11)
    of_mode = made.nodal_forces[made.nodal_forces["mode"] == 1].drop(columns="mode")
    parts = [of_mode.assign(unit_load=name) for name in ("pressure", "gravity")]
    for part, factor in zip(parts, (-0.2, 0.3), strict=True):
        part[FORCES] = factor * part[FORCES] + rng.normal(0.0, 15.0, (len(part), 6))
    path = made.write(folder)
    pd.concat(parts).to_csv(folder / "loads.csv", index=False)
    load.to_csv(folder / "p.csv", index=False)
    path.write_text(path.read_text().replace("[curve]", f"{BODY}[curve]", 1) + GRAVITY + mission)
    return path


def assessed(folder: Path, load: pd.DataFrame, mission: str, counting: dict, curve: dict) -> Path:
    """Assess such a case and return its result folder."""
    made = load_case(written(folder / "case", load, mission, counting, curve))
    assess(made, folder / "result", threads=1, report=False)
    return folder / "result"


CASES = {
    "load at the instants of the event": (pressure(0.005, 480), PASSING.format(event="", load=""), {}, {}),
    "finer, asme, a loop": (pressure(0.002, 1210), PASSING.format(event="", load="") + LOOP, {}, BENT),
    "coarser, upsampled, half": (
        pressure(0.016, 152),
        PASSING.format(event='residue = "repeat"', load="") + PAYLOAD,
        {"upsample": 4, "residue": "half"},
        {},
    ),
    "linear, cut-off, loops": (
        pressure(0.003, 900),
        PASSING.format(event="", load='interpolation = "linear"\nshift_s = -0.1') + PAYLOAD + LOOP,
        {"mean_of_q": "remove"},
        {"name": "master-steel", "extension": "cutoff"},
    ),
    "stints in an order that is not known": (
        pressure(0.005, 480),
        PASSING.format(event="stints_per_1000_km = 1.5", load="")
        + PAYLOAD.replace("per_1000_km = 2.0", "per_1000_km = 2.0\nstints_per_1000_km = 0.5"),
        {},
        BENT,
    ),
}


@pytest.mark.parametrize("name", CASES)
def test_pipeline_and_recount_agree(tmp_path, name):
    """Every column of every point, and all rows with one another."""
    result = assessed(tmp_path, *CASES[name])
    found = recount(result, sample=None)
    assert found.passed, found.as_text()
    of_few = recount(result, sample=1, most_samples=1)
    assert of_few.passed, of_few.as_text()
    wider = ("load_factor", "power_sum_per_pass", "multiaxial_bound")  # the last is raised by 1e-9 of the range
    assert max(c.difference for c in found.columns if c.column not in wider) < 1e-9


# ------------------------------------------------------------------------------------------------ spoiled results

SPOILED = [  # a value of each table at a time, so that few recounts tell of all
    {("nodes", "damage_per_km_transitions"): None, ("damage", "damage_per_pass"): "(sequence 1)"}
    | {("cycles", "start_s"): "(sequence 1)", ("histogram", "power_sum_per_pass"): "passing"}
    | {("structural_stress", "membrane_MPa"): "gravity"},
    {("damage", "cycles_per_pass"): "(sequence 2)", ("cycles", "range_MPa"): "(sequence 2)"},
    {("damage", "max_range_MPa"): "(sequence 1)", ("cycles", "count"): "(sequence 1)"},
    {("damage", "max_equivalent_range_dS"): "(sequence 2)", ("cycles", "damage"): "(sequence 1)"},
    {("damage", "mean_stress_MPa"): "payload", ("cycles", "mean_MPa"): "payload"},  # a mean that exceeds the range
    {("cycles", "start_event"): "(sequence 1)"},
    {("cycles", "end_event"): "noise"},
]


@pytest.fixture(scope="module")
def sound(tmp_path_factory) -> Path:
    """Result with loops and unit loads."""
    load, mission, counting, _ = CASES["linear, cut-off, loops"]
    return assessed(tmp_path_factory.mktemp("loads"), load, mission, counting, {"yield_MPa": 20.0})


@pytest.mark.parametrize("values", SPOILED, ids=lambda values: ",".join(".".join(column) for column in values))
def test_wrong_values_are_found(tmp_path, sound, values):
    """Values of an event or a load, by a hundred-thousandth of themselves; texts."""
    folder = copied(sound, tmp_path)
    for (table, column), of in values.items():
        edit(folder, table, lambda frame, table=table, column=column, of=of: spoiled(frame, table, column, of))
    assert differing(recount(folder, sample=None)) >= {f"{table}.{column}" for table, column in values}


def test_a_load_that_is_not_there_is_found(tmp_path, sound):
    """The name of a unit load, which is part of the key of a row."""
    folder = copied(sound, tmp_path)
    edit(folder, "structural_stress", lambda frame: spoiled(frame, "structural_stress", "unit_load", "gravity"))
    assert not recount(folder, sample=None).passed


def copied(sound: Path, into: Path) -> Path:
    """Copy of the result and its inputs, to be spoiled."""
    shutil.copytree(sound.parent, into / "copy")
    return without_hashes(into / "copy" / "result")


def spoiled(frame: pd.DataFrame, table: str, column: str, of: str | None) -> pd.DataFrame:
    """Largest value of a column in rows of one event or load, changed; a text becomes another."""
    name = "unit_load" if table == "structural_stress" else "event"
    rows = frame if of is None else frame[frame[name] == of]
    values = rows[column]
    if values.dtype.kind == "f":
        row = values.abs().idxmax()
        frame.loc[row, column] = values[row] * 1.00001
    else:
        frame.loc[values.index[0], column] = "nothing"
    return frame


@pytest.mark.parametrize("table", ["cycles", "damage", "histogram"])
def test_a_missing_row_of_a_loop_is_found(tmp_path, sound, table):
    """The last row of a loop, or of an event, taken out."""
    folder = copied(sound, tmp_path)
    edit(folder, table, lambda frame: frame[:-1])
    assert not recount(folder, sample=None).passed


@pytest.mark.parametrize("residue", ["repeat", "half"])
@pytest.mark.parametrize("upsample", [1, '"auto"'])
def test_vertices_agree(tmp_path, residue, upsample):
    """Reversals at vertices, sampled as they are and automatically."""
    made = case()
    made.counting = {"upsample": 1, "reversals": "vertex", "residue": residue}
    path = made.write(tmp_path / "case")
    path.write_text(path.read_text().replace("upsample = 1", f"upsample = {upsample}"))
    assess(load_case(path), tmp_path / "result", threads=1, report=False)
    found = recount(tmp_path / "result", sample=None)
    assert found.passed, found.as_text()
