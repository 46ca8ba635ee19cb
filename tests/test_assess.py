"""The whole path on small cases: closed forms, bytes, resume, and what must never be overwritten."""

import hashlib
import json
import os
import signal
import subprocess
import sys
import time
import zipfile
from dataclasses import asdict
from functools import partial
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from fatigue.assess import assess as assess_and_report
from fatigue.case import load_case
from fatigue.check import check_case
from fatigue.errors import DataError, NumericalError
from fatigue.life.curves import catalogue
from tests.small_case import BENDING, MEMBRANE, THICKNESS, sine_only, small_case

assess = partial(assess_and_report, report=False)
TABLES = ("nodes", "damage", "cycles", "histogram", "structural_stress", "welds")


def run(case, folder, **options):
    """Write, load and assess a case; give the tables as data frames."""
    done = assess(load_case(case.write(folder / "case")), folder / "result", **options)
    return done, {name: pd.read_parquet(folder / "result" / f"{name}.parquet") for name in TABLES}


def digests(folder):
    """SHA-256 of every result table."""
    return {name: hashlib.sha256((folder / f"{name}.parquet").read_bytes()).hexdigest() for name in TABLES}


def warnings_of(folder):
    """Warnings of a result."""
    return json.loads((folder / "provenance.json").read_text())["warnings"]


def case_welds(case):
    """Names of the welds of a case, in its order."""
    return pd.read_csv(case.resolve(case.body.welds))["weld"].tolist()


def equivalent_range(stress_range, r, thickness=THICKNESS):
    """Dong's equivalent range by hand, actual thickness."""
    I = (1.23 - 0.364 * r - 0.17 * r**2) / (1.007 - 0.306 * r - 0.178 * r**2)  # noqa: E741
    return stress_range * thickness ** (1.6 / 7.2) / I


def test_constant_amplitude_life_by_hand(tmp_path):
    """A sine of one mode: life = km per cycle x N(dS), on both faces, at every node."""
    _, tables = run(sine_only(), tmp_path)
    amplitude, frequency, speed = 30.0, 5.0, 180.0
    r = BENDING / (MEMBRANE + BENDING)
    km_per_cycle = speed / 3600.0 / frequency
    C, h = catalogue()["master-aluminium"].reference_range["mean-2sigma"], 0.27712
    nodes = tables["nodes"]
    for face, stress in (("top", MEMBRANE + BENDING), ("bottom", MEMBRANE - BENDING)):
        dS = equivalent_range(2 * amplitude * stress, r)
        expected = km_per_cycle * (C / dS) ** (1 / h)
        assert nodes.loc[nodes.surface == face, "life_km"].to_numpy() == pytest.approx(expected, rel=1e-9)


def test_constant_amplitude_columns_by_hand(tmp_path):
    """Range, equivalent range, ratio, load factor and years of the sine, in the units the names say."""
    _, tables = run(sine_only(), tmp_path)
    top = tables["nodes"].query("surface == 'top'").iloc[3]
    assert top.max_range_MPa == pytest.approx(60.0 * (MEMBRANE + BENDING), rel=1e-9)
    assert top.bending_ratio == pytest.approx(1 / 3, rel=1e-9)
    assert top.life_years == pytest.approx(top.life_km / 2e5, rel=1e-12)
    assert top.utilisation == pytest.approx(1e6 / top.life_km, rel=1e-12)
    assert top.load_factor == pytest.approx(top.utilisation**-0.27712, rel=1e-9)
    cycles_at_target = 1e6 / (180.0 / 3600.0 / 5.0)
    assert top.equivalent_range_2e6_MPa == pytest.approx(90.0 * (cycles_at_target / 2e6) ** 0.27712, rel=1e-9)
    assert top.life_km_same_ratio == pytest.approx(top.life_km, rel=1e-9)
    assert top.governing_event == "sine"
    assert top.R_largest_cycle == pytest.approx(-1.0, rel=1e-9)
    assert tables["cycles"]["count"].sum() == pytest.approx(2 * 60.0)
    event = tables["damage"].query("surface == 'top'").iloc[3]
    assert event.cycles_per_km == pytest.approx(100.0, rel=1e-9)
    assert event.max_equivalent_range_dS == pytest.approx(equivalent_range(90.0, 1 / 3), rel=1e-9)
    assert event["kurtosis"] == pytest.approx(1.5, rel=1e-6)


def test_damage_of_the_tables_is_that_of_the_cycles(small_result):
    """The cycle table of a weld's worst point sums to the damage the other tables give it, event by event."""
    cycles = pd.read_parquet(small_result / "cycles.parquet")
    damage = pd.read_parquet(small_result / "damage.parquet")
    key = ["weld", "part", "order", "surface", "event"]
    summed = cycles.groupby(key)[["damage", "count"]].sum()
    joined = damage.set_index(key).join(summed, how="inner")
    assert len(joined) == 2 * 3
    assert joined["damage"].to_numpy() == pytest.approx(joined["damage_per_pass"].to_numpy(), rel=1e-12)
    assert joined["count"].to_numpy() == pytest.approx(joined["cycles_per_pass"].to_numpy(), rel=1e-12)


def test_mission_weights_shares_and_numbers(small_result):
    """damage_per_km of a point = sum of share x damage per km of its events, plus events by number / 1000."""
    nodes = pd.read_parquet(small_result / "nodes.parquet").set_index(["weld", "part", "order", "surface"])
    damage = pd.read_parquet(small_result / "damage.parquet")
    by_share = damage[damage.event != "load and unload"]
    weighted = by_share.damage_per_km * by_share.event.map({"sine": 0.75, "noise": 0.25})
    total = weighted.groupby([damage.weld, damage.part, damage.order, damage.surface]).sum()
    by_number = damage[damage.event == "load and unload"].set_index(["weld", "part", "order", "surface"])
    total = total + by_number.damage_per_pass * 2.0 / 1000.0
    assert nodes.damage_per_km.to_numpy() == pytest.approx(total.loc[nodes.index].to_numpy(), rel=1e-12)
    assert by_number.damage_per_km.isna().all()


def test_two_samples_are_one_half_cycle(small_result):
    """An event counted by number may have two samples: one half cycle, no spectrum, not an error."""
    event = pd.read_parquet(small_result / "damage.parquet").query("event == 'load and unload'")
    assert (event.cycles_per_pass == 0.5).all()
    assert event.damage_dirlik_per_pass.isna().all()


def test_a_face_without_toe_never_governs(tmp_path):
    """Weld B has its toe on top: its bottom keeps its rows, marked, and decides nothing."""
    case = sine_only()
    case.nodal_forces.loc[case.nodal_forces["mode"] == 1, "mx_Nmm"] *= -1.0  # the bottom is now the worse face
    _, tables = run(case, tmp_path)
    nodes, welds = tables["nodes"], tables["welds"].set_index("weld")
    b = nodes[nodes.weld == "B"]
    assert b.toe.tolist() == [True, False] * 7
    assert welds.loc["A", "worst_surface"] == "bottom"
    assert welds.loc["B", "worst_surface"] == "top"
    assert welds.loc["B", "life_km"] == b[b.toe].life_km.min() > b[~b.toe].life_km.min()


@pytest.mark.parametrize("factor", [1.25, 0.5])
def test_stress_factor_scales_all_stresses(tmp_path, factor):
    """A factor on the stresses of an event costs factor^k of its life."""
    plain, scaled = sine_only(), sine_only()
    scaled.events[0]["stress_factor"] = factor
    life = [run(c, tmp_path / str(i))[1]["nodes"].life_km.to_numpy() for i, c in enumerate((plain, scaled))]
    assert life[0] / life[1] == pytest.approx(factor ** (1 / 0.27712), rel=1e-9)


def test_on_node_forces_are_turned_round(tmp_path):
    """Forces on the nodes are minus those on the elements: same stresses once the case says so."""
    a, b = small_case(), small_case()
    for column in ("fx_N", "fy_N", "fz_N", "mx_Nmm", "my_Nmm", "mz_Nmm"):
        b.nodal_forces[column] *= -1.0
    b.body["force_convention"] = "on_node"
    stress = [run(c, tmp_path / str(i))[1]["structural_stress"] for i, c in enumerate((a, b))]
    pd.testing.assert_frame_equal(stress[0], stress[1])


def test_mode_scale_multiplies_the_forces_of_its_mode(tmp_path):
    """Scale 2 on mode 1 doubles the stress of the sine."""
    case = sine_only()
    case.modes["scale"] = [2.0, 1.0, 1.0]
    _, tables = run(case, tmp_path)
    assert tables["nodes"].query("surface == 'top'").max_range_MPa.to_numpy() == pytest.approx(180.0, rel=1e-9)


def test_end_treatment_and_raw_value(tmp_path):
    """Life uses the mean over the end length; the raw life is kept beside it, and equals it away from the ends."""
    case = sine_only()
    end = (case.nodal_forces.node == 100) & (case.nodal_forces["mode"] == 1)
    case.nodal_forces.loc[end, "fy_N"] *= 3.0
    _, tables = run(case, tmp_path)
    a = tables["nodes"].query("weld == 'A' and surface == 'top'").set_index("order")
    assert a.at_end.tolist() == [True] + [False] * 5 + [True]
    assert a.life_km_raw_end[1] < a.life_km[1]
    assert (a.life_km_raw_end[2:6] == a.life_km[2:6]).all()
    case.welds["end_length_mm"] = [0.0, 0.0]
    _, untreated = run(case, tmp_path / "none")
    bare = untreated["nodes"].query("weld == 'A' and surface == 'top'").set_index("order")
    assert bare.life_km[1] == pytest.approx(a.life_km_raw_end[1], rel=1e-12)


def test_upsampling_counts_the_peaks_between_the_samples(tmp_path):
    """5 samples per period miss 5 % of the range; upsampled, the sine has its true range again."""
    case = sine_only()
    t = np.arange(500) * 0.04
    case.histories["sine"] = pd.DataFrame(
        {"time_s": t, "q_1": 30 * np.sin(2 * np.pi * 5 * t + 0.3), "q_2": 0.0, "q_7": 0.0}
    )
    case.spectrum["segment_s"] = 2.0
    coarse = run(case, tmp_path / "1")[1]["nodes"].max_range_MPa.max()
    case.counting["upsample"] = "auto"
    done, tables = run(case, tmp_path / "auto")
    assert coarse < 0.97 * 90.0
    assert tables["nodes"].max_range_MPa.max() == pytest.approx(90.0, rel=0.005)
    assert (tables["damage"].samples_per_peak > 19.0).all()
    assert not any(w.code == "sampling" for w in done.warnings)


def test_coarse_sampling_is_a_warning(tmp_path):
    """Fewer than 10 samples per peak: the warning tells the expected loss."""
    case = sine_only()
    case.histories["sine"] = case.histories["sine"].iloc[::5].reset_index(drop=True)
    done, _ = run(case, tmp_path)
    (warning,) = [w for w in done.warnings if w.code == "sampling"]
    assert "samples per peak" in warning.what
    assert "% low" in warning.what


def test_threads_do_not_change_a_byte(tmp_path, small_result):
    """One, two and three threads write the same tables."""
    for threads in (1, 3):
        run(small_case(), tmp_path / str(threads), threads=threads)
        assert digests(tmp_path / str(threads) / "result") == digests(small_result)


def test_order_of_rows_and_columns_does_not_matter(tmp_path, small_result):
    """Shuffled tables, in Parquet instead of CSV, give the same numbers."""
    case = small_case()
    for name in ("modes", "weld_nodes", "nodal_forces"):
        table = getattr(case, name).sample(frac=1.0, random_state=3).reset_index(drop=True)
        setattr(case, name, table[sorted(table.columns)])
    run(case, tmp_path, threads=1)
    for name in TABLES:
        shuffled, straight = (pd.read_parquet(f / f"{name}.parquet") for f in (tmp_path / "result", small_result))
        pd.testing.assert_frame_equal(shuffled, straight, rtol=1e-12)


@pytest.mark.parametrize("suffix", ["csv", "parquet"])
def test_groups_of_welds_do_not_change_a_number(tmp_path, monkeypatch, suffix):
    """Welds solved one after the other, their forces cut from a shuffled table, give the same rows."""
    case = small_case()
    hot = case.nodal_forces.node.isin([103, 204])  # so that no rounding decides which point is worst
    case.nodal_forces.loc[hot, "fy_N"] *= 1.2
    assess(load_case(case.write(tmp_path / "whole", suffix)), tmp_path / "one group")
    monkeypatch.setattr("fatigue.pipeline.solve.weld_groups.SMALLEST_GROUP", 7)
    case.nodal_forces = case.nodal_forces.sample(frac=1.0, random_state=1)
    assess(load_case(case.write(tmp_path / "case", suffix)), tmp_path / "result", threads=2)
    for name in TABLES:
        cut, whole = (pd.read_parquet(tmp_path / f / f"{name}.parquet") for f in ("result", "one group"))
        key = [c for c in ("weld", "part", "order", "surface", "event", "mode", "start_s", "end_s") if c in whole]
        cut, whole = (t.sort_values(key, kind="stable").reset_index(drop=True) for t in (cut, whole))
        pd.testing.assert_frame_equal(cut, whole, rtol=1e-12)


def test_large_jobs_count_in_single_precision_and_say_so(tmp_path, small_result, monkeypatch):
    """Above the limit single precision counts; lives agree to 1e-6 and the record names the precision."""
    monkeypatch.setattr("fatigue.pipeline.mission.precision.SINGLE_FROM", 0.0)
    assess(load_case(small_case().write(tmp_path / "case")), tmp_path / "result")
    single, double = (pd.read_parquet(f / "nodes.parquet") for f in (tmp_path / "result", small_result))
    assert single.life_km.to_numpy() == pytest.approx(double.life_km.to_numpy(), rel=1e-6)
    for folder, word in ((tmp_path / "result", "single"), (small_result, "double")):
        assert json.loads((folder / "provenance.json").read_text())["rules"]["precision"].startswith(word)


def test_a_mistake_in_the_forces_of_the_last_group_is_refused_at_once(tmp_path, monkeypatch):
    """Nothing is counted and nothing is left when a later group is wrong; the row is that of the file."""
    monkeypatch.setattr("fatigue.pipeline.solve.weld_groups.SMALLEST_GROUP", 7)
    case = small_case()
    row = int(np.flatnonzero(case.nodal_forces.weld == "B")[5])
    case.nodal_forces.loc[row, "mx_Nmm"] = np.inf
    with pytest.raises(DataError, match=rf"nodal_forces\.csv: column mx_Nmm, row {row + 1}: inf is not finite"):
        assess(load_case(case.write(tmp_path / "case")), tmp_path / "result")
    assert not (tmp_path / "result").exists()


def element_form(case):
    """The small case in element forces: the elements beside each line, balanced by their far side."""
    rows, sides, mesh = [], [], {}
    for weld, nodes in case.weld_nodes.groupby("weld"):
        ids = nodes.node.to_numpy()
        line = case.nodal_forces[case.nodal_forces.weld == weld].set_index(["node", "mode"])
        for i in range(len(ids) - 1):
            element, far = 1000 * int(ids[0]) + i, [int(ids[i]) + 5000, int(ids[i + 1]) + 5000]
            sides.append({"weld": weld, "element": element})
            for near, other in zip(ids[i : i + 2], far, strict=True):
                at = nodes[nodes.node == near].iloc[0]
                mesh[int(near)] = (at.x_mm, at.y_mm, at.z_mm)
                mesh[other] = (at.x_mm, at.y_mm - 10.0, at.z_mm)
                half = 1.0 if near in (ids[0], ids[-1]) else 0.5
                for mode in (1, 2, 7):
                    f = half * line.loc[(near, mode), list(COMPONENTS)].to_numpy(dtype=float)
                    arm = np.array(mesh[int(near)]) - np.array(mesh[other])
                    g = -np.concatenate([f[:3], f[3:] + np.cross(arm, f[:3])])
                    rows += [
                        dict(zip(COMPONENTS, v, strict=True)) | {"mode": mode, "node": n, "element": element}
                        for n, v in ((int(near), f), (other, g))
                    ]
    return (
        pd.DataFrame(rows),
        pd.DataFrame(sides),
        pd.DataFrame([{"node": n, "x_mm": x, "y_mm": y, "z_mm": z} for n, (x, y, z) in mesh.items()]),
    )


COMPONENTS = ("fx_N", "fy_N", "fz_N", "mx_Nmm", "my_Nmm", "mz_Nmm")


def write_element_form(case, folder, forces, sides, mesh):
    """Write the case with element forces in place of nodal forces."""
    path = case.write(folder)
    for name, table in (("element_forces", forces), ("weld_elements", sides), ("nodes", mesh)):
        table.to_csv(folder / f"{name}.csv", index=False)
    text = path.read_text().replace(
        'nodal_forces = "nodal_forces.csv"',
        'element_forces = "element_forces.csv"\nweld_elements = "weld_elements.csv"\nnodes = "nodes.csv"',
    )
    path.write_text(text)
    return path


def test_element_forces_give_what_their_sums_give(tmp_path, small_result):
    """The raw form: the program sums the assessed side itself, after checking every element's balance."""
    path = write_element_form(small_case(), tmp_path / "case", *element_form(small_case()))
    assess(load_case(path), tmp_path / "result")
    summed, raw = (pd.read_parquet(f / "nodes.parquet") for f in (small_result, tmp_path / "result"))
    pd.testing.assert_frame_equal(raw, summed, rtol=1e-9)


def test_an_element_out_of_balance_is_refused(tmp_path):
    """A force that misses its counterpart: element, mode and how far off."""
    forces, sides, mesh = element_form(small_case())
    forces.loc[10, "fy_N"] += 20.0
    path = write_element_form(small_case(), tmp_path / "case", forces, sides, mesh)
    place = rf"element {forces.element[10]}, mode {forces['mode'][10]}"
    with pytest.raises(DataError, match=rf"element_forces\.csv: {place}: forces and moments are out of balance by"):
        assess(load_case(path), tmp_path / "result")


class Stop(Exception):
    """Stands for whatever ends a run in the middle."""


def stop_after(blocks):
    """Give a progress callback that ends the run after so many blocks."""
    seen = []

    def progress(label, done, total):
        seen.append(label)
        if len(seen) >= blocks:
            raise Stop

    return progress


@pytest.fixture(scope="module")
def many_welds(tmp_path_factory):
    """A case of seven groups of welds, and the result of an undisturbed run."""
    folder = tmp_path_factory.mktemp("many")
    case = load_case(small_case(pairs=16).write(folder / "case"))
    assess(case, folder / "result", threads=2)
    return case, folder / "result"


@pytest.mark.parametrize("groups", [1, 2, 4])
def test_an_interrupted_run_goes_on_and_ends_with_the_same_bytes(tmp_path, many_welds, groups):
    """What was finished is reused, and the tables are those of an undisturbed run."""
    case, undisturbed = many_welds
    with pytest.raises(Stop):
        assess(case, tmp_path / "result", threads=1, progress=stop_after(groups))
    assert not (tmp_path / "result" / "nodes.parquet").exists()
    done = assess(case, tmp_path / "result", threads=1)
    assert 0 < groups <= done.groups_reused <= groups + 3 < done.groups + 1
    assert digests(tmp_path / "result") == digests(undisturbed)
    assert not (tmp_path / "result" / ".fatigue-state").exists()
    assert f"{done.groups_reused} of {done.groups} groups" in (tmp_path / "result" / "fatigue.log").read_text()
    assert warnings_of(tmp_path / "result") == warnings_of(undisturbed)


def test_warnings_of_many_welds_are_summed_up(many_welds):
    """Twenty one by one, one for the other welds; the dry run says the same before a cycle is counted."""
    case, folder = many_welds
    found = warnings_of(folder)
    *first, others = [warning for warning in found if warning["code"] == "end_unresolved"]
    assert [warning["where"].rpartition(" ")[2] for warning in first] == case_welds(case)[:20]
    assert others["count"] == 12
    assert others["where"] == f"weld_nodes.csv: weld {', '.join(case_welds(case)[20:])}"
    foretold = [asdict(warning) for warning in check_case(case, strict=False).warnings]
    of_spectra = {"outside_band", "sampling"}  # known once every point was counted; foretold from some of them
    assert {warning["code"] for warning in found} & of_spectra == of_spectra
    assert [one for one in foretold if one["code"] not in of_spectra] == [
        one for one in found if one["code"] not in of_spectra
    ]
    assert [one["where"] for one in foretold if one["code"] in of_spectra] == ["event 'noise'"]


def test_a_damaged_part_is_computed_again(tmp_path, many_welds):
    """A part cut short or with a flipped bit, as a power cut leaves it, is not used."""
    case, undisturbed = many_welds
    with pytest.raises(Stop):
        assess(case, tmp_path / "result", threads=1, progress=stop_after(4))
    parts = sorted((tmp_path / "result" / ".fatigue-state").rglob("*.npz"))
    parts[0].write_bytes(parts[0].read_bytes()[:200])
    flipped = bytearray(parts[1].read_bytes())
    flipped[len(flipped) // 2] ^= 0x10
    parts[1].write_bytes(flipped)
    done = assess(case, tmp_path / "result", threads=1)
    assert done.groups_reused == len(parts) - 2
    assert digests(tmp_path / "result") == digests(undisturbed)


def test_changed_inputs_are_noticed(tmp_path):
    """After any change of an input nothing stale is reused."""
    case = small_case(pairs=16)
    loaded = load_case(case.write(tmp_path / "case"))
    with pytest.raises(Stop):
        assess(loaded, tmp_path / "result", threads=1, progress=stop_after(3))
    case.histories["noise"].loc[100, "q_1"] += 1e-3
    done = assess(load_case(case.write(tmp_path / "case")), tmp_path / "result", threads=1)
    assert done.groups_reused == 0


def test_a_full_disk_is_one_clear_error_and_loses_nothing(tmp_path, monkeypatch, many_welds):
    """ENOSPC while a part is written: no half part, an error that says so, and the next run goes on."""
    case, undisturbed = many_welds
    written = []

    class Full(zipfile.ZipFile):
        """The third part finds no space in the middle."""

        def open(self, name, mode="r", **options):
            """Open an array for writing, if there is space."""
            written.extend([name] * (mode == "w"))
            if written.count("event_columns.npy") == 3 and mode == "w":
                self.fp.write(b"half")
                raise OSError(28, "No space left on device")
            return super().open(name, mode, **options)

    monkeypatch.setattr(zipfile, "ZipFile", Full)
    with pytest.raises(DataError, match=r"the disk is full\. Free some space and run the same command again"):
        assess(case, tmp_path / "result", threads=1)
    assert not list((tmp_path / "result").rglob("*.unfinished"))
    done = assess(case, tmp_path / "result", threads=1)
    assert 2 <= done.groups_reused < done.groups
    assert digests(tmp_path / "result") == digests(undisturbed)


def test_two_runs_into_one_folder_do_not_spoil_each_other(tmp_path):
    """The second run is refused while the first holds the folder."""
    case = load_case(small_case().write(tmp_path / "case"))
    refused = []

    def second_run(label, done, total):
        with pytest.raises(DataError, match="another run is writing to this folder") as error:
            assess(case, tmp_path / "result")
        refused.append(error)

    assess(case, tmp_path / "result", threads=1, progress=second_run)
    assert refused


def test_foreign_files_are_not_overwritten(tmp_path):
    """A file of that name that is not ours stops the run before anything is written; --force goes on."""
    case = load_case(small_case().write(tmp_path / "case"))
    (tmp_path / "result").mkdir()
    (tmp_path / "result" / "nodes.parquet").write_text("mine")
    with pytest.raises(DataError, match=r"nodes\.parquet: is there already and was not written by fatigue"):
        assess(case, tmp_path / "result")
    assert (tmp_path / "result" / "nodes.parquet").read_text() == "mine"
    assess(case, tmp_path / "result", force=True)
    assess(case, tmp_path / "result")  # our own result may be replaced


@pytest.mark.parametrize(("size", "place"), [(1e200, "noise.csv"), (1e90, "event 'noise', welds A to B")])
def test_numbers_beyond_double_precision_are_a_numerical_failure(tmp_path, size, place):
    """A coordinate of 1e200, or a damage of 1e300: exit code 4 and where to look, not infinity in a table."""
    case = small_case()
    case.histories["noise"].loc[500, "q_1"] = size
    with pytest.raises(NumericalError, match=place) as error:
        assess(load_case(case.write(tmp_path / "case")), tmp_path / "result", threads=1)
    assert error.value.exit_code == 4
    assert "far too large" in str(error.value)
    assert size < 1e100 or "q_1 is 1e+200 at 2.5 s" in str(error.value)


def test_a_bad_case_leaves_nothing_behind(tmp_path):
    """Refused input: no result folder, not even an empty one."""
    case = small_case()
    case.histories["noise"].loc[7, "q_2"] = np.nan
    with pytest.raises(DataError, match=r"noise\.csv: column q_2, row 8"):
        assess(load_case(case.write(tmp_path / "case")), tmp_path / "result")
    assert not (tmp_path / "result").exists()


@pytest.mark.skipif(os.name == "nt", reason="SIGKILL is not a thing there")
def test_killed_between_any_two_groups(tmp_path):
    """SIGKILL as soon as one, then three parts are there: the last run reuses them and ends with the same bytes."""
    case = small_case(seconds=80.0, pairs=16)
    path = case.write(tmp_path / "case")
    assess(load_case(path), tmp_path / "undisturbed", threads=1)
    command = [
        sys.executable,
        "-m",
        "fatigue",
        "-q",
        "assess",
        str(path),
        "-o",
        str(tmp_path / "result"),
        "--threads",
        "1",
        "--no-report",
    ]
    for parts in (1, 3):
        process = subprocess.Popen(command, cwd=Path(__file__).parents[1], stdout=subprocess.DEVNULL)
        while process.poll() is None and len(list((tmp_path / "result").rglob("*.npz"))) < parts:
            time.sleep(0.0005)
        process.send_signal(signal.SIGKILL)
        assert process.wait() == -signal.SIGKILL
    done = assess(load_case(path), tmp_path / "result", threads=1)
    assert 3 <= done.groups_reused < done.groups
    assert digests(tmp_path / "result") == digests(tmp_path / "undisturbed")
