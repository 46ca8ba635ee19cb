"""Element forces under gauges: of unit loads, out of balance by little, and of a large table."""

import numpy as np
import pytest

from fatigue.case import load_case
from fatigue.errors import DataError
from fatigue.gauges.forces import imbalance
from fatigue.gauges.histories.story import histories
from fatigue.results.origin import is_assessed_case
from tests.gauge_case import SHEAR, gauge_case
from tests.gauges.test_rows import rows_of, table
from tests.unit_load_case import as_unit_load

TEXT = table("g,element,101,,,,,,,45,,,,top,,,,,,,,", "t,toe,,,,,,,,,,,,top,,A,2,,,,,")
CONSTANT = '[[mission.unit_load]]\nname = "wind"\nunit = "kN"\nconstant = 2.0\n'


def with_load(folder, *, gauge_forces, moves):
    """A case whose mode 7 is a unit load, with or without element forces, constant or over time."""
    case = gauge_case(TEXT)
    of_mode = case.forces["mode"] == 7
    load = case.forces[of_mode].drop(columns="mode").assign(unit_load="wind")
    case.forces = case.forces[~of_mode]
    nodal = as_unit_load(case.case, 7, "wind")
    if gauge_forces:
        case.case.extra += 'gauge_forces = "wind.csv"\n'
    if not moves:
        case.case.histories = {name: one.drop(columns="u_wind") for name, one in case.case.histories.items()}
        case.case.extra += CONSTANT
    case_file, gauges = case.write(folder)
    nodal.to_csv(folder / "loads.csv", index=False)
    load.to_csv(folder / "wind.csv", index=False)
    return case_file, gauges


@pytest.mark.parametrize("moves", [True, False])
def test_a_unit_load_is_one_more_coordinate_of_a_gauge(tmp_path, moves):
    """The row behind the modes is that of the mode which the load was: half the shear at 45 degrees."""
    rows, warnings = rows_of(*with_load(tmp_path, gauge_forces=True, moves=moves))
    assert warnings == []
    assert rows.strain.shape == (2, 3)
    assert rows.strain[0, 2] == pytest.approx(0.5e6 * SHEAR)
    assert rows.strain[1, 2] != 0.0  # of the stand-in, from its nodal forces


def test_constant_loads_shift_readings_and_static_cases_are_events(tmp_path):
    """2 kN in every event move the mean by twice the row; a static load case of 0 and 3 kN is half a cycle of three."""
    case_file, gauges = with_load(tmp_path, gauge_forces=True, moves=False)
    static = '[[mission.event]]\nname = "gust"\nper_1000_km = 1.0\n[[mission.event.unit_load]]\n'
    static += 'name = "wind"\nunit = "kN"\nvalues = [0.0, 3.0]\n'
    case_file.write_text(case_file.read_text("utf-8") + static, encoding="utf-8")
    found = histories(case_file, gauges)
    of = {(row.gauge, row.event): row for row in found.events}
    shear = 0.5e6 * SHEAR
    sine, gust = of["g", "sine"], of["g", "gust"]
    assert sine.mean_ue == pytest.approx(2.0 * shear, rel=1e-6)
    assert (gust.min_ue, gust.max_ue) == pytest.approx((0.0, 3.0 * shear), abs=1e-6)
    assert (gust.cycles_per_pass, gust.largest_range_ue) == pytest.approx((0.5, 3.0 * shear))


def test_a_load_without_element_forces_is_told_where_it_is_constant(tmp_path):
    """Only means are wrong: a warning, and nothing in the row."""
    rows, warnings = rows_of(*with_load(tmp_path, gauge_forces=False, moves=False))
    assert rows.strain[0, 2] == 0.0
    (problem,) = warnings
    assert problem.code == "load_not_in_gauges"
    assert "wind has no element forces: gauges on elements do not read it" in str(problem)


def test_a_load_that_moves_without_element_forces_is_refused(tmp_path):
    """Changes would be wrong."""
    with pytest.raises(DataError, match="wind changes over an event, and has no element forces under gauges"):
        rows_of(*with_load(tmp_path, gauge_forces=False, moves=True))


def test_a_little_out_of_balance_is_a_warning(tmp_path):
    """Half a percent of the largest term is told with the element; more than a percent is refused elsewhere."""
    case = gauge_case(TEXT)
    of_one = ((case.forces.element == 101) & (case.forces.node == 12)).to_numpy()
    case.forces.loc[of_one, "fx_N"] *= 1.005
    rows, (problem,) = rows_of(*case.write(tmp_path))
    assert problem.code == "imbalance"
    assert "the forces of element 101 in gauge_forces.csv are out of balance by 0.00" in str(problem)
    assert len(rows) == 2


def test_rigid_modes_need_no_balance(tmp_path):
    """Their forces are round-off; a rigid mode that carries some is read as it is."""
    case = gauge_case(TEXT)
    case.case.modes.loc[case.case.modes["mode"] == 2, "kind"] = "rigid"
    noise = (case.forces["mode"] == 2).to_numpy()
    case.forces.loc[noise, ["fx_N", "my_Nmm"]] = np.random.default_rng(1).standard_normal((noise.sum(), 2))
    _, warnings = rows_of(*case.write(tmp_path))
    assert warnings == []


def test_balance_is_measured_in_the_plane_of_the_element_only():
    """A moment about the normal is none of it; one about an axis in the plane is."""
    nodes = np.array([[0.0, 0.0, 0.0], [20.0, 0.0, 0.0], [20.0, 10.0, 0.0], [0.0, 10.0, 0.0]])
    force = np.zeros((4, 1, 6))
    force[:, 0, 0] = [-50.0, 50.0, 50.0, -50.0]
    none = np.zeros((1, 2))
    force[0, 0, 5] = 1000.0
    assert imbalance(nodes, 4, force, none) == pytest.approx([0.0])
    force[0, 0, 4] = 1000.0
    assert imbalance(nodes, 4, force, none) == pytest.approx([1.0 / np.sqrt(2.0)])  # 1000 N mm of the row's 1414
    assert imbalance(nodes, 4, force, np.array([[1e9, 1e9]]))[0] < 1e-2  # little beside what the others carry


def test_files_of_gauges_are_no_part_of_an_assessment(tmp_path):
    """Neither key is among the input files, and a case without them is the same case of a result."""
    case_file, _ = gauge_case(TEXT).write(tmp_path)
    assert not {"body.gauge_forces", "body.properties"} & set(load_case(case_file).input_files())
    text = case_file.read_text("utf-8")
    other = tmp_path / "other.toml"
    kept = [line for line in text.splitlines() if not line.startswith(("gauge_forces", "properties"))]
    other.write_text("\n".join(kept) + "\n", encoding="utf-8")
    assert is_assessed_case({"case_text": text}, other)
