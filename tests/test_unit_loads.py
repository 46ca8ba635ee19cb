"""Unit loads from files to tables: one more coordinate each, equal to a mode; static load cases; published numbers."""

import json
import logging

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.assess import assess
from fatigue.check import check_case
from fatigue.errors import CaseError, DataError
from fatigue.life.curves import catalogue
from tests.small_case import BENDING, MEMBRANE, THICKNESS, SmallCase, small_case
from tests.unit_load_case import LOAD, as_unit_load, assert_same_tables, write_with_loads

COUNTED = ("damage_per_pass", "cycles_per_pass", "max_range_MPa", "max_equivalent_range_dS", "bending_ratio")


def plain(seconds: float = 4.0, pairs: int = 1, **counting) -> SmallCase:
    """The small case with the samples counted as they are; the band does not depend on the modes."""
    case = small_case(seconds, pairs)
    case.counting = {"upsample": 1, **counting}
    case.spectrum["upper_hz"] = 30.0
    return case


def assessed(path, folder, share=None, **options):
    """Assess quietly; return the folder."""
    assess(path, folder, threads=1, share=share, report=False, **options)
    return folder


@pytest.mark.parametrize(
    ("mode", "suffix", "share", "counting"),
    [
        (2, "csv", None, {}),
        (7, "parquet", None, {"upsample": 4}),
        (1, "csv", 0.1, {"residue": "half"}),
        (2, "parquet", 0.1, {"upsample": "auto"}),
    ],
)
def test_a_unit_load_equals_a_mode(tmp_path, mode, suffix, share, counting):
    """Every number of nodes, damage and cycles to 1e-12, screened or not, upsampled or not, in either format."""
    modal = assessed(plain(**counting).write(tmp_path / "modal", suffix), tmp_path / "a", share)
    case = plain(**counting)
    forces = as_unit_load(case, mode, "force", suffix)
    assert_same_tables(
        modal, assessed(write_with_loads(case, tmp_path / "u", forces, suffix), tmp_path / "b", share), 1e-12
    )


def test_a_unit_load_equals_a_mode_in_single_precision(tmp_path, monkeypatch):
    """To 3e-7, where the fast counter serves."""
    monkeypatch.setattr("fatigue.pipeline.mission.precision.SINGLE_FROM", 10.0)
    modal = assessed(plain().write(tmp_path / "modal", "parquet"), tmp_path / "a")
    case = plain()
    forces = as_unit_load(case, 2, "force", "parquet")
    assert_same_tables(
        modal, assessed(write_with_loads(case, tmp_path / "u", forces, "parquet"), tmp_path / "b"), 3e-7, ("nodes",)
    )


@settings(deadline=None, max_examples=4)
@given(
    mode=st.sampled_from([1, 2]),
    residue=st.sampled_from(["repeat", "half"]),
    upsample=st.sampled_from([1, 2, "auto"]),
    constant=st.none() | st.floats(-50.0, 50.0),
    factor=st.floats(0.5, 2.0),
    start_s=st.floats(0.0, 0.5),
)
def test_loads_equal_modes_whatever_the_case(tmp_path_factory, mode, residue, upsample, constant, factor, start_s):
    """Two modes as unit loads, mode 7 a constant or not: ranges, counts and damage are the same."""
    folder = tmp_path_factory.mktemp("case")

    def drawn() -> SmallCase:
        case = plain(2.0, residue=residue, upsample=upsample)
        for event in case.events:
            event.update({"stress_factor": factor} | ({"start_s": start_s} if event["history"] != "load" else {}))
        if constant is not None:
            for table in case.histories.values():
                table["q_7"] = constant
        return case

    modal, case = drawn(), drawn()
    forces = pd.concat([as_unit_load(case, one, f"load_{one}") for one in (mode, 7)])
    if constant is not None:  # given once for the mission in the place of columns that do not change
        case.histories = {k: table.drop(columns="u_load_7") for k, table in case.histories.items()}
        case.extra += f'[[mission.unit_load]]\nname = "load_7"\nunit = "kN"\nconstant = {constant}\n'
    a = assessed(modal.write(folder / "a"), folder / "out_a")
    b = assessed(write_with_loads(case, folder / "b", forces), folder / "out_b")
    one, other = (pd.read_parquet(out / "damage.parquet", columns=list(COUNTED)) for out in (a, b))
    for name in COUNTED:
        x, y = one[name].to_numpy(), other[name].to_numpy()
        np.testing.assert_allclose(y, x, rtol=1e-9, atol=1e-12 * np.nanmax(np.abs(x), initial=1e-300), err_msg=name)


def test_groups_of_welds(tmp_path):
    """A body that is cut into groups, its forces in no order: the same, file by file."""
    modal = assessed(plain(pairs=8).write(tmp_path / "modal"), tmp_path / "a")
    case = plain(pairs=8)
    forces = as_unit_load(case, 2, "force").sample(frac=1.0, random_state=3)
    assert_same_tables(modal, assessed(write_with_loads(case, tmp_path / "u", forces), tmp_path / "b"), 1e-12)


def test_a_history_of_its_own_equals_a_column(tmp_path):
    """The same samples in a file of their own, shifted in time and in another unit."""
    case = plain()
    forces = as_unit_load(case, 2, "force")
    own = assessed(write_with_loads(case, tmp_path / "u", forces), tmp_path / "a")
    given = ""
    for name, table in case.histories.items():
        load = pd.DataFrame({"time_s": table["time_s"] + 10.0, "N": 1000.0 * table.pop("u_force")})
        (tmp_path / "v").mkdir(exist_ok=True)
        load.to_csv(tmp_path / "v" / f"load_{name}.csv", index=False)
    events, case.events = case.events, []
    for event in events:
        keys = "\n".join(f"{k} = {json.dumps(v)}" for k, v in (event | {"history": f"{event['history']}.csv"}).items())
        given += f"[[mission.event]]\n{keys}\n[[mission.event.unit_load]]\nname = 'force'\nunit = 'kN'\n"
        given += f"history = 'load_{event['history']}.csv'\ncolumn = 'N'\nscale = 0.001\nshift_s = -10.0\n"
    case.extra += given
    assert_same_tables(own, assessed(write_with_loads(case, tmp_path / "v", forces), tmp_path / "b"), 1e-12)


def static_case(membrane: float, values: list[float], residue: str, per_1000_km: float, **load) -> SmallCase:
    """One static load case of a unit load that makes a membrane stress [MPa] in plates of 4 mm."""
    case = plain()
    case.weld_nodes["thickness_mm"] = 4.0
    scale = membrane / (MEMBRANE * THICKNESS / 4.0)
    forces = as_unit_load(case, 1, "force")
    forces[["mx_Nmm", "my_Nmm", "mz_Nmm"]] = 0.0
    forces[["fx_N", "fy_N", "fz_N"]] *= scale
    case.forces = forces  # type: ignore[attr-defined]
    case.histories, case.events = {}, []
    case.mission["target_km"] = 1.2e7
    more = "".join(f"{key} = {json.dumps(value)}\n" for key, value in load.items())
    case.extra += (
        f'[[mission.event]]\nname = "lift"\nper_1000_km = {per_1000_km}\nresidue = "{residue}"\n'
        f'[[mission.event.unit_load]]\nname = "force"\nunit = "kN"\nvalues = {values}\n{more}'
    )
    return case


def rows_of(case: SmallCase, tmp_path, table: str) -> pd.DataFrame:
    """Rows of weld A, top, of a result."""
    folder = assessed(write_with_loads(case, tmp_path / "case", case.forces), tmp_path / "out")
    rows = pd.read_parquet(folder / f"{table}.parquet")
    return rows[(rows["weld"] == "A") & (rows["surface"] == "top")]


@pytest.mark.parametrize(
    ("values", "residue", "damage"),
    [
        ([0.0, 1.0], "half", 3.215413545961564e-07),
        ([0.0, 1.0], "repeat", 6.430827091923128e-07),
        ([0.0, 1.0, 0.0], "half", 6.430827091923128e-07),
        ([0.0, 1.0, 0.0], "repeat", 6.430827091923128e-07),
    ],
)
@pytest.mark.parametrize("counting", [{"upsample": 1}, {"upsample": 8}, {"reversals": "vertex"}], ids=str)
def test_two_samples_count_half_a_cycle(tmp_path, values, residue, damage, counting):
    """Load or unload under half, both under repeat (A1 static_two_samples); values are no samples of a signal."""
    case = static_case(40.0, values, residue, 1000.0)
    case.counting |= counting
    rows = rows_of(case, tmp_path, "damage")
    np.testing.assert_allclose(rows["damage_per_pass"], damage, rtol=1e-9)
    np.testing.assert_allclose(rows["max_equivalent_range_dS"], 44.56310667237715, rtol=1e-9)


def test_a_vertical_load_after_en_12663(tmp_path):
    """Values of 0.85 and 1.15 g, 1e7 cycles at the target (A1 en12663_like)."""
    rows = rows_of(static_case(60.0, [0.85, 1.15], "repeat", 1e7 / 1.2e4), tmp_path, "nodes")
    np.testing.assert_allclose(rows["utilisation"], 0.3604695390671077, rtol=1e-9)
    np.testing.assert_allclose(rows["R_largest_cycle"], 0.7390, rtol=1e-3)
    assert (rows["dirlik_verdict"] == "not_assessed").all()


def test_scale_of_values(tmp_path):
    """Values in another unit."""
    rows = rows_of(static_case(40.0, [0.0, 1000.0], "half", 1000.0, scale=0.001), tmp_path, "damage")
    np.testing.assert_allclose(rows["damage_per_pass"], 3.215413545961564e-07, rtol=1e-9)


def test_stress_of_unit_loads_is_in_its_table(tmp_path):
    """Behind the modes of each station, by name; the mode is null there."""
    case = plain()
    folder = assessed(write_with_loads(case, tmp_path / "u", as_unit_load(case, 1, "force")), tmp_path / "out")
    rows = pd.read_parquet(folder / "structural_stress.parquet", dtype_backend="pyarrow")
    assert rows["mode"].isna().tolist()[:3] == [False, False, True]
    assert rows["unit_load"].fillna("").tolist()[:3] == ["", "", "force"]
    of_load = rows[rows["unit_load"] == "force"]
    np.testing.assert_allclose(of_load["membrane_MPa"], MEMBRANE)
    np.testing.assert_allclose(of_load["bending_MPa"], BENDING)
    record = json.loads((folder / "provenance.json").read_text())
    assert [load["name"] for load in record["unit_loads"]] == ["force"]
    assert {"loads.csv"} <= {entry["file"] for entry in record["inputs"]}


def test_check_says_what_every_event_counts(tmp_path):
    """The trap of two samples, of histories and of values; and the log of an assessment says the same."""
    case = static_case(40.0, [0.0, 1.0], "half", 3.0)
    path = write_with_loads(case, tmp_path / "case", case.forces)
    found = check_case(path)
    assert "'lift': 2 values, half: half a cycle (load or unload), 3.6e+04 passes at the target" in found.as_text()
    assert found.as_record()["counts"][0]["cycles"] == 0.5
    assert "no_spectrum" not in {warning.code for warning in found.warnings}


def test_the_log_says_what_every_event_counts(tmp_path, caplog):
    """As ``check`` does."""
    with caplog.at_level(logging.INFO):
        assessed(plain().write(tmp_path / "case"), tmp_path / "out")
    assert "'load and unload': 2 samples, half: half a cycle" in caplog.text


def test_a_load_that_no_event_gives_warns(tmp_path):
    """Once, with its name; a constant of the mission counts as given."""
    case = plain()
    forces = as_unit_load(case, 1, "force")
    idle = LOAD.format(name="idle", suffix="csv") + 'when_missing = "zero"\n'
    case.extra += idle + LOAD.format(name="dead", suffix="csv")
    case.extra += '[[mission.unit_load]]\nname = "dead"\nunit = "kN"\nconstant = 2.0\n'
    all_forces = pd.concat([forces.assign(unit_load=name) for name in ("force", "idle", "dead")])
    found = check_case(write_with_loads(case, tmp_path / "case", all_forces))
    (warning,) = [w for w in found.warnings if w.code == "unused_unit_load"]
    assert "no event gives the unit load 'idle'" in warning.what
    assert found.unit_loads == 3


def test_missing_loads_of_all_events_are_told_together(tmp_path):
    """Each event that does not give a load."""
    case = plain()
    forces = as_unit_load(case, 1, "force")
    case.histories = {name: table.drop(columns="u_force") for name, table in case.histories.items()}
    with pytest.raises((CaseError, DataError)) as refusal:
        check_case(write_with_loads(case, tmp_path / "case", forces))
    assert [problem.code for problem in refusal.value.problems] == ["missing_unit_load"] * 3


@pytest.mark.parametrize(
    ("spoil", "message"),
    [
        (
            lambda f: f.iloc[1:],
            "weld A, node 100, unit_load force: no forces are given (1 of the weld's 7 pairs of node",
        ),
        (lambda f: pd.concat([f, f.iloc[:1]]), "unit_load force repeats row 1"),
        (lambda f: f.assign(fy_N=f.fy_N.where(np.arange(len(f)) > 0)), "loads.csv: column fy_N, row 1: the value is"),
        (lambda f: f.assign(weld=f.weld.replace("A", "AA")), "'AA' is not one of the welds"),
        (lambda f: f.assign(unit_load="forces"), "the unit load 'force' has no forces. Write 'forces', there or here"),
        (lambda f: f.assign(unit_load=None), "column unit_load, row 1: the text is missing"),
        (lambda f: f.rename(columns={"unit_load": "mode"}), "column unit_load: the column is missing"),
        (lambda f: f[f.weld != "B"], "weld B, node 200, unit_load force: no forces are given"),
    ],
)
@pytest.mark.parametrize("pairs", [1, 8])
def test_spoilt_forces_are_refused(tmp_path, spoil, message, pairs):
    """As those of modes, with the name of the load, in a body of one group and of several."""
    case = plain(pairs=pairs)
    forces = as_unit_load(case, 1, "force").sort_values(["weld", "node"])
    path = write_with_loads(case, tmp_path / "case", spoil(forces))
    with pytest.raises(DataError) as refusal:
        assessed(path, tmp_path / "out")
    assert message in str(refusal.value)


def test_rows_of_other_loads_warn_once(tmp_path):
    """A file may hold more than the body uses; what is left out is named."""
    case = plain(pairs=8)
    forces = as_unit_load(case, 1, "force")
    more = pd.concat([forces, forces.assign(unit_load="spare"), forces.assign(unit_load="other")])
    found = check_case(write_with_loads(case, tmp_path / "case", more))
    (warning,) = [w for w in found.warnings if w.code == "unused_forces"]
    assert "rows of 'other', 'spare' are not used" in warning.what


def test_on_node_forces_turn_the_loads_too(tmp_path):
    """force_convention is that of the body."""
    case, turned = plain(), plain()
    forces, opposite = as_unit_load(case, 1, "force"), as_unit_load(turned, 1, "force")
    turned.body["force_convention"] = "on_node"
    components = [name for name in opposite.columns if name.endswith(("_N", "_Nmm"))]
    opposite[components] *= -1.0
    turned.nodal_forces[components] *= -1.0
    a = assessed(write_with_loads(case, tmp_path / "a", forces), tmp_path / "out_a")
    b = assessed(write_with_loads(turned, tmp_path / "b", opposite), tmp_path / "out_b")
    assert_same_tables(a, b, 1e-13)


def test_a_load_without_forces_at_any_weld_warns(tmp_path):
    """It makes no stress; the modes are not blamed."""
    case = plain()
    forces = as_unit_load(case, 1, "force")
    forces[[name for name in forces.columns if name.endswith(("_N", "_Nmm"))]] = 0.0
    codes = {w.code for w in check_case(write_with_loads(case, tmp_path / "case", forces)).warnings}
    assert "no_unit_load_force" in codes
    assert "no_mode_force" not in codes


def test_the_catalogue_has_the_curve_of_the_published_numbers():
    """Their slope is the first of master-aluminium."""
    assert catalogue()["master-aluminium"].slopes[0] == pytest.approx(3.60855, abs=1e-4)
