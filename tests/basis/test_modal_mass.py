"""What is said of modal mass: a chain by factors and by its mass matrix, what is doubtful, what is not given."""

import numpy as np
import pandas as pd
import pytest

from fatigue.basis.mass.findings import modal_mass
from fatigue.case import load_case
from fatigue.errors import CaseError, DataError
from fatigue.pipeline.solve.body import read_body
from tests.beam_frame import frame
from tests.chain_case import HELD, MASS, TOTAL, by_factors, by_matrix, chain, write_matrix
from tests.small_case import small_case


def findings_of(case, band_hz=None, damping=None, strict=False):
    """Findings about the modal mass of a case file."""
    return list(modal_mass(read_body(load_case(case), strict=strict), band_hz, damping))


def found(case, **asked):
    """The same by the name of their table."""
    return {finding.table: finding for finding in findings_of(case, **asked)}


def warnings_of(case):
    """Warnings of all of them."""
    return [warning for finding in findings_of(case) for warning in finding.warnings]


def sums(findings):
    """Rows of ``mass_sum`` by direction."""
    return {row.direction: row for row in findings["mass_sum"].rows}


def code_of(error):
    """Code of the one refusal."""
    (problem,) = error.value.problems
    return problem.code


def test_factors_and_matrix_say_the_same(tmp_path):
    """A chain carries its three swinging masses along x, and the mass on its boundary is missing in no mode."""
    given = sums(found(by_factors(tmp_path / "factors").write(tmp_path / "factors")))["x"]
    computed = sums(found(by_matrix(tmp_path / "matrix").write(tmp_path / "matrix")))["x"]
    assert given.summed_mass == pytest.approx(3 * MASS, rel=1e-12)
    for name in ("body_mass", "boundary_mass", "summed_mass", "band_hz", "mass_in_band", "share_in_band"):
        assert getattr(computed, name) == pytest.approx(getattr(given, name), rel=1e-9)
    assert (given.body_mass, given.boundary_mass) == (TOTAL, HELD)
    assert given.missing_share == pytest.approx(0.0, abs=1e-12)
    assert computed.missing_share == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("kind", ["mtx", "npz"])
def test_centre_of_mass_and_inertia_of_a_matrix(tmp_path, kind):
    """Rotations are about the centre of mass, and what no mode moves is in no mode."""
    findings = found(by_matrix(tmp_path, kind).write(tmp_path))
    x = np.array([0.0, 500.0, 1000.0, 1500.0])
    m = np.array([HELD, MASS, MASS, MASS])
    centre = (m * x).sum() / TOTAL
    row = sums(findings)["ry"]
    assert row.body_mass == pytest.approx((m * (x - centre) ** 2).sum(), rel=1e-12)
    assert row.unit == "t mm2"
    assert sums(findings)["z"].missing_share == pytest.approx(3 * MASS / TOTAL, rel=1e-12)
    assert any(f"{centre:.5g}, 20, -300 mm" in note for note in findings["mass_sum"].notes)


def test_band_and_rule_of_thumb(tmp_path):
    """A mode above the band counts as above it; the rule is printed with its source and is no verdict."""
    case = by_factors(tmp_path).write(tmp_path)
    f, shapes = chain()
    first = (MASS * shapes[:, 0].sum()) ** 2
    row = sums(found(case, band_hz=float(f[0])))["x"]
    assert row.mass_in_band == pytest.approx(first, rel=1e-12)
    assert row.share_in_band == pytest.approx(first / TOTAL, rel=1e-12)
    assert row.enough is True  # 73 % of the body are 91 % of what is not on the boundary
    said = " ".join(found(case, band_hz=float(f[0]))["mass_sum"].said)
    assert "rule of thumb" in said
    case.write_text(case.read_text(encoding="utf-8").replace(f"boundary_mass_t = {HELD}\n", ""), encoding="utf-8")
    row = sums(found(case, band_hz=float(f[0])))["x"]
    assert np.isnan(row.boundary_mass)
    assert (row.enough, row.share_in_band) == (False, pytest.approx(first / TOTAL, rel=1e-12))
    assert "recalled" in said
    assert f"mode 1 ({f[0]:.4g} Hz)" in said


def test_a_body_that_is_all_boundary(tmp_path):
    """A direction in which everything is on the boundary is no lack of the modes: nothing is said to be short."""
    case = by_matrix(tmp_path).write(tmp_path)
    rows = pd.read_csv(tmp_path / "mass_rows.csv")
    rows.loc[rows["direction"] == "y", "held"] = True
    rows.to_csv(tmp_path / "mass_rows.csv", index=False)
    findings = found(case)
    row = sums(findings)["y"]
    assert (row.enough, row.reason) == (None, "all of it is on the boundary")
    assert row.boundary_mass == pytest.approx(TOTAL, rel=1e-12)
    assert row.missing_share == pytest.approx(0.0, abs=1e-12)
    assert not warnings_of(case)


def test_normalisation_does_not_count(tmp_path):
    """Factors of shapes of another modal mass, and of another sign, give the same effective mass."""
    case = by_factors(tmp_path)
    expected = sums(found(case.write(tmp_path)))["x"].summed_mass
    table = pd.read_csv(tmp_path / "participation.csv")
    table["l_x"] *= [-3.0, 0.5, 1.0]
    table.to_csv(tmp_path / "participation.csv", index=False)
    case.modes["modal_mass"] = [9.0, 0.25, 1.0]
    assert sums(found(case.write(tmp_path)))["x"].summed_mass == pytest.approx(expected, rel=1e-12)


def test_scale_of_forces_is_not_applied_and_said(tmp_path):
    """The scale of a mode is for its forces; the effective mass stays and a note says so."""
    case = by_factors(tmp_path)
    before = sums(found(case.write(tmp_path)))["x"].summed_mass
    case.modes["scale"] = [1.0, 1000.0, 1.0]
    findings = found(case.write(tmp_path))
    assert sums(findings)["x"].summed_mass == before
    assert any("scale of mode 2" in note for note in findings["mass_sum"].notes)


def test_directions_and_masses_that_are_not_given(tmp_path):
    """Empty numbers stand beside their reason: a direction without factors, a body without inertia or mass."""
    case = by_factors(tmp_path, l_rx=[1.0, 2.0, 3.0])
    rows = sums(found(case.write(tmp_path)))
    assert rows["y"].reason == "l_y is not given"
    assert np.isnan(rows["y"].summed_mass)
    assert rows["rx"].summed_mass == 14.0
    assert np.isnan(rows["rx"].share_in_band)
    assert rows["rx"].reason == "inertia_t_mm2 is not given"
    assert rows["rx"].enough is None
    for key in ("total_mass_t", "boundary_mass_t"):
        case.body.pop(key)
    row = sums(found(case.write(tmp_path)))["x"]
    assert (row.summed_mass, row.reason) == (pytest.approx(3 * MASS), "total_mass_t is not given")


def test_modes_without_a_row_are_named(tmp_path):
    """A table may lack modes: what they carry is missing, and the note names them."""
    case = by_factors(tmp_path).write(tmp_path)
    pd.read_csv(tmp_path / "participation.csv").iloc[:2].to_csv(tmp_path / "participation.csv", index=False)
    findings = found(case)
    assert sums(findings)["x"].missing_share > 0.0
    assert any("mode 7" in note for note in findings["mass_sum"].notes)


def test_an_empty_cell_counts_as_nothing_and_is_named(tmp_path):
    """A factor that is not given of one mode is said."""
    case = by_factors(tmp_path, l_y=[1.0, None, 0.0]).write(tmp_path)
    findings = found(case)
    assert sums(findings)["y"].summed_mass == 1.0
    assert any("l_y of mode 2 is empty" in note for note in findings["mass_sum"].notes)


def test_rigid_modes_are_not_summed(tmp_path):
    """A rigid mode carries the whole body and would make any basis complete."""
    case = by_factors(tmp_path)
    case.modes.loc[0, ["frequency_hz", "kind"]] = [0.0, "rigid"]
    findings = found(case.write(tmp_path))
    assert sums(findings)["x"].summed_mass < MASS
    assert any("Rigid mode 1" in note for note in findings["mass_sum"].notes)


@pytest.mark.parametrize(
    ("total", "code"), [(TOTAL * 1000.0, "effective_mass_small"), (TOTAL / 1000.0, "effective_mass_too_large")]
)
def test_kg_beside_t_is_doubted(tmp_path, total, code):
    """A mass in other units than the factors is told once, and shares that cannot be are empty."""
    case = by_factors(tmp_path)
    case.body.pop("boundary_mass_t")
    case.body["total_mass_t"] = total
    (warning,) = warnings_of(case.write(tmp_path))
    assert warning.code == code
    row = sums(found(case.write(tmp_path)))["x"]
    assert np.isnan(row.share_in_band) == (code == "effective_mass_too_large")


def test_free_modes_have_no_effective_mass(tmp_path):
    """Factors that are 0 to rounding are those of free-free modes, which have none: what to give is said."""
    findings = found(by_factors(tmp_path, l_x=[1e-7, -2e-9, 0.0]).write(tmp_path))
    assert "modal_mass" not in findings
    assert findings["mass_sum"].rows == ()
    assert "orthogonal to rigid motions" in findings["mass_sum"].notes[0]


def test_free_modes_of_a_matrix(tmp_path):
    """The same by the mass matrix of a frame of which nothing is held."""
    case, model = small_case(), frame()
    f, shapes = model.free_modes()
    case.modes["frequency_hz"] = f[:3]
    write_matrix(tmp_path, model.M)
    nodes = np.arange(1, 9)
    rows = pd.DataFrame({"row": np.arange(1, 49), "node": np.repeat(nodes, 6)})
    rows["direction"] = ["x", "y", "z", "rx", "ry", "rz"] * 8
    rows[["x_mm", "y_mm", "z_mm"]] = model.place
    rows.to_csv(tmp_path / "rows.csv", index=False)
    columns = ["ux_mm", "uy_mm", "uz_mm", "rx_rad", "ry_rad", "rz_rad"]
    of_modes = [
        pd.DataFrame(shapes[:, i].reshape(-1, 6), columns=columns).assign(mode=mode, node=nodes)
        for i, mode in enumerate((1, 2, 7))
    ]
    pd.concat(of_modes).to_csv(tmp_path / "shapes.csv", index=False)
    case.body |= {"mass_matrix": "mass.mtx", "mass_rows": "rows.csv", "mode_shapes": "shapes.csv"}
    (finding,) = findings_of(case.write(tmp_path))
    assert finding.rows == ()
    assert not finding.warnings
    assert "orthogonal to rigid motions" in finding.notes[0]


def test_nothing_given_says_what_to_give(tmp_path):
    """A case without masses is no error: the reason names the keys."""
    findings = found(small_case().write(tmp_path))
    assert findings["mass_sum"].rows == ()
    for key in ("participation", "total_mass_t", "mass_matrix", "mass_rows", "mode_shapes"):
        assert key in findings["mass_sum"].notes[0]


def test_dynamic_mass_needs_damping(tmp_path):
    """Modes without damping have no dynamic mass until a ratio is given, and that is printed."""
    case = by_factors(tmp_path).write(tmp_path)
    assert found(case)["dynamic_mass"].rows == ()
    assert "--damping" in found(case)["dynamic_mass"].notes[0]
    finding = found(case, damping=0.015)["dynamic_mass"]
    assert any("0.015" in note for note in finding.notes)
    rows = [row for row in finding.rows if row.direction == "x"]
    f, shapes = chain()
    at = min(rows, key=lambda row: abs(row.frequency_hz - f[0]))
    assert at.frequency_hz == f[0]
    assert at.elastic_mass == pytest.approx((MASS * shapes[:, 0].sum()) ** 2 / 0.03, rel=2e-3)
    assert rows[0].frequency_hz == 0.0
    assert rows[0].dynamic_mass == TOTAL
    assert {row.direction for row in finding.rows} == {"x"}


def test_damping_of_the_modes_goes_before_the_one_given(tmp_path):
    """What the table of modes says is not replaced."""
    case = by_factors(tmp_path)
    case.modes["damping_ratio"] = [0.03, None, 0.03]
    rows = found(case.write(tmp_path), damping=0.5)["dynamic_mass"].rows
    f, shapes = chain()
    at = min(rows, key=lambda row: abs(row.frequency_hz - f[0]))
    assert at.elastic_mass == pytest.approx((MASS * shapes[:, 0].sum()) ** 2 / 0.06, rel=1e-2)


def test_matrix_in_kg_is_refused(tmp_path):
    """A matrix that has another mass than the case says is a contradiction."""
    case = by_matrix(tmp_path)
    case.body["total_mass_t"] = TOTAL / 1000.0
    with pytest.raises(CaseError) as error:
        found(case.write(tmp_path))
    assert code_of(error) == "contradiction"


def test_shapes_that_are_no_modes_of_the_matrix_are_doubted(tmp_path):
    """Shapes that are not orthogonal, and a boundary that moves, are told once each."""
    case = by_matrix(tmp_path).write(tmp_path)
    table = pd.read_csv(tmp_path / "mode_shapes.csv")
    table.loc[table["mode"] == 2, "ux_mm"] += 0.1
    table.to_csv(tmp_path / "mode_shapes.csv", index=False)
    assert [warning.code for warning in warnings_of(case)] == ["modes_not_orthogonal", "boundary_moves"]


def test_a_matrix_without_some_directions_is_doubted(tmp_path):
    """A body has one mass in all directions."""
    case = by_matrix(tmp_path).write(tmp_path)
    rows = pd.read_csv(tmp_path / "mass_rows.csv")
    matrix = np.diag(np.where(np.arange(12) % 3 == 1, 1.0, 2.0))
    matrix[0, 0] = 1.5
    write_matrix(tmp_path, matrix)
    assert len(rows) == 12
    case.write_text(case.read_text(encoding="utf-8").replace(f"total_mass_t = {TOTAL}\n", ""), encoding="utf-8")
    assert "mass_directions" in [warning.code for warning in warnings_of(case)]


def test_strict_takes_unknown_columns_for_errors(tmp_path):
    """An unknown column warns, and is refused where strict."""
    case = by_factors(tmp_path, l_q=1.0).write(tmp_path)
    assert [warning.code for warning in warnings_of(case)] == ["unknown_column"]
    with pytest.raises(DataError) as error:
        found(case, strict=True)
    assert code_of(error) == "unknown_column"
