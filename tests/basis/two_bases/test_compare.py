"""Two bases of one body: where the answer is known, and what cannot be compared."""

import numpy as np
import pytest

from fatigue.basis.counted import opened
from fatigue.basis.truncation import truncation
from fatigue.basis.two_bases.compare import A_TRUNCATION, ONE_BASIS, two_bases
from fatigue.case import load_case
from fatigue.pipeline.solve.body import read_body
from tests.small_case import small_case


def strong():
    """The small case: two normal modes and an interface mode."""
    return small_case(seconds=4.0)


def weak():
    """The same body reduced without the interface mode, which has the number 7."""
    case = strong()
    case.modes = case.modes[case.modes["mode"] != 7]
    case.nodal_forces = case.nodal_forces[case.nodal_forces["mode"] != 7]
    case.histories = {name: table.drop(columns="q_7") for name, table in case.histories.items()}
    return case


def compared(first, second, tmp_path):
    """Findings of two cases by the name of their table."""
    paths = first.write(tmp_path / "first"), second.write(tmp_path / "second")
    bodies = [read_body(load_case(path), strict=True) for path in paths]
    with opened(bodies[0], threads=1) as one, opened(bodies[1], threads=1) as other:
        return {finding.table: finding for finding in two_bases(one, other)}


def test_a_weak_basis_is_the_strong_one_without_its_interface_modes(tmp_path):
    """Each weld has the life ratio that leaving the interface modes out of the strong basis has."""
    found = compared(strong(), weak(), tmp_path)
    with opened(read_body(load_case(tmp_path / "first" / "case.toml"), strict=True), threads=1) as case:
        without = [row for row in truncation(case).rows if (row.modes, row.interface_modes) == (1, 1)]
    rows = found["bases"].rows
    assert len(rows) == 2
    for row, same in zip(rows, without, strict=True):
        assert (row.weld, row.order, row.surface) == (same.weld, same.order, same.surface)
        assert row.life_ratio == pytest.approx(same.life_ratio, rel=1e-12)
        assert row.shortest_life_ratio == pytest.approx(same.shortest_life_ratio, rel=1e-12)
    assert found["bases"].said[0] == A_TRUNCATION
    assert not found["bases"].notes


def test_stress_above_20_hz_is_what_the_interface_mode_makes(tmp_path):
    """The fast part falls where the interface mode carries it alone, and stays where both bases are alike."""
    first = strong()
    t = first.histories["noise"]["time_s"].to_numpy()
    for case in (first, second := weak()):
        case.histories["noise"][["q_1", "q_2"]] = 0.0
        case.histories["noise"]["q_1"] = 3.0 * np.sin(2 * np.pi * 5.0 * t)
    first.histories["noise"]["q_7"] = 2.0 * np.sin(2 * np.pi * 60.0 * t)
    rows = compared(first, second, tmp_path)["bases_content"].rows
    noise = [row for row in rows if row.event == "noise"]
    assert all(row.ratio_above < 0.02 for row in noise)
    for row in noise:
        assert row.rms_MPa**2 - row.rms_above_MPa**2 == pytest.approx(row.other_rms_MPa**2, rel=0.02)
    sine = [row for row in rows if row.event == "sine"]
    assert all(row.rms_MPa == pytest.approx(row.other_rms_MPa, rel=1e-12) for row in sine)
    (load,) = {row.reason for row in rows if row.event == "load and unload"}
    assert "ends at 0.5 Hz" in load


def test_modes_have_their_partners_whatever_their_number_and_size(tmp_path):
    """Modes are matched by their stress: other numbers, another sign and size, another frequency."""
    second = weak()
    number = {1: 22, 2: 11}
    second.modes = second.modes.replace({"mode": number}).assign(frequency_hz=[5.1, 12.0])
    second.nodal_forces = second.nodal_forces.replace({"mode": number})
    forces = ["fx_N", "fy_N", "fz_N", "mx_Nmm", "my_Nmm", "mz_Nmm"]
    second.nodal_forces[forces] *= -4.0
    second.histories = {
        name: table.rename(columns={"q_1": "q_22", "q_2": "q_11"}) for name, table in second.histories.items()
    }
    for table in second.histories.values():
        table[["q_22", "q_11"]] /= -4.0
    found = compared(strong(), second, tmp_path)
    rows = [(row.mode, row.other_mode, row.frequency_ratio) for row in found["bases_modes"].rows]
    assert rows == [(1, 22, pytest.approx(1.02)), (2, 11, 1.0)]
    assert all(row.likeness == pytest.approx(1.0) for row in found["bases_modes"].rows)
    assert "most differs mode 1" in found["bases_modes"].said[0]


def test_one_basis_under_two_records_is_told(tmp_path):
    """The same modes twice: lives differ by the records alone, and that is said in place of the truncation."""
    second = strong()
    second.histories["noise"]["q_1"] *= 2.0
    found = compared(strong(), second, tmp_path)
    assert found["bases"].said[0] == ONE_BASIS
    (said,) = found["bases_modes"].said
    assert said == "2 of 2 normal modes have a partner in the other case, all at the same frequency."
    assert all(row.life_ratio < 1.0 for row in found["bases"].rows)


def test_what_cannot_be_compared_is_named(tmp_path):
    """A weld that the other case lacks, one that only it has, and a mesh that is another one."""
    first, second = strong(), small_case(seconds=4.0)
    second.welds["weld"] = second.welds["weld"].replace({"A": "C"})
    second.weld_nodes["weld"] = second.weld_nodes["weld"].replace({"A": "C"})
    second.nodal_forces["weld"] = second.nodal_forces["weld"].replace({"A": "C"})
    second.weld_nodes["y_mm"] += np.where(second.weld_nodes["weld"] == "B", 5.0, 0.0)
    found = compared(first, second, tmp_path)["bases"]
    reason = {row.weld: row.reason for row in found.rows}
    assert reason["A"] == "the other case does not have this weld"
    assert "lies 5 mm away" in reason["B"]
    assert np.isnan(next(row for row in found.rows if row.weld == "B").life_ratio)
    assert any("Only the other case has the welds C" in note for note in found.notes)


def test_missions_curves_and_records_that_do_not_belong_are_told(tmp_path):
    """What else differs stands beside the lives; a record of both cases with other modes is doubted."""
    first, second = strong(), strong()
    second.events[0]["share"], second.events[1]["share"] = 0.5, 0.5
    second.curve = {"name": "master-aluminium", "survival": "mean"}
    second.modes["frequency_hz"] *= 1.1
    for event in second.events:
        event["history"] = f"../first/{event['history']}"
    second.histories = {}
    notes = " ".join(compared(first, second, tmp_path)["bases"].notes)
    assert "The missions differ" in notes
    assert "Curve or counting differ" in notes
    assert "Both cases read the record" in notes
    assert "although the modes 1, 2, 7 differ" in notes
