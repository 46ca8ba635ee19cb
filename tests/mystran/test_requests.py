"""What users ask of MYSTRAN, and what it does not do: sets, missing shapes, thermal loads, drilling springs, stops."""

import json
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from fatigue.errors import DataError
from fatigue.readers.convert.audit.audit import audit
from fatigue.readers.convert.audit.tension_patch import DECK, convention_of
from fatigue.readers.foreign.read import read_forces, read_model
from tests.mystran import plates as joints
from tests.mystran.chain import chain
from tests.mystran.decks import plain
from tests.mystran.solver import needs_mystran, solve_text

pytestmark = needs_mystran


@pytest.fixture(scope="module")
def tee():
    """A T joint."""
    return joints.tee(np.random.default_rng(3))


def judged(text, folder):
    """Solve a deck; give its forces and the rows of their audit by name."""
    mesh, op2 = solve_text(text, folder, "run")
    results = read_forces(op2, None)
    found = audit(results, read_model(mesh))
    return results, {row.check: row for row in found.rows}


def test_tension_patch_proves_on_element(tmp_path):
    """The program's own patch."""
    assert convention_of(read_forces(solve_text(DECK, tmp_path, "patch")[1], None)) == "on_element"


def test_forces_of_a_set_of_grids(tee, tmp_path):
    """Shells with some of their grids in the set are told, and their parts of work prove nothing wrong."""
    text = plain(tee, 103).text().replace("GPFORCE(PLOT) = ALL", "SET 5 = 1 THRU 30\nGPFORCE(PLOT) = 5")
    _, rows = judged(text, tmp_path)
    assert "at some nodes only" in rows["completeness"].finding
    assert rows["sign"].light == "green"
    assert 0 < rows["sign"].value < 1
    assert rows["element balance"].light == "green"


def test_modes_without_shapes(tee, tmp_path):
    """The reactions prove the sign; frequencies stand beside the shapes, and without them nothing says them: red."""
    results, rows = judged(plain(tee, 103).text().replace("DISP(PLOT) = ALL\n", ""), tmp_path)
    assert np.isnan(results.frequency).all()
    assert rows["frequencies"].light == "red"
    assert (rows["sign"].light, rows["sign"].value) == ("green", pytest.approx(1, abs=1e-3))


def test_static_cases_without_displacements(tee, tmp_path):
    """Loads and reactions prove the sign."""
    _, rows = judged(plain(tee, 101).text().replace("DISP(PLOT) = ALL\n", ""), tmp_path)
    assert "1.00000 times the loads and reactions" in rows["sign"].finding
    assert "forces on_element" in rows["sign"].finding


def test_thermal_and_body_loads(tee, tmp_path):
    """Rows of thermal loads are loads, and stand in one subcase only."""
    text = plain(tee, 101, extra=("TEMPD,9,100.", "GRAV,101,,9810.,0.,0.,-1.")).text()
    results, rows = judged(text.replace("SUBCASE 2\n", "SUBCASE 2\nTEMP(LOAD) = 9\n"), tmp_path)
    assert "THERMAL" in results.kind
    assert {row.light for row in rows.values()} == {"green"}


def test_modes_of_another_normalisation(tee, tmp_path):
    """Shapes of unit displacement: the work over omega^2 is told as the generalised mass it is, and is no alarm."""
    text = plain(tee, 103).text().replace("EIGRL,1,,,6", "EIGRL,1,,,6,,,,MAX")
    _, rows = judged(text, tmp_path)
    assert rows["sign"].light == "green"
    assert rows["sign"].value < 0.01
    assert "the generalised mass, from" in rows["sign"].finding


def free_modes(tee, shift):
    """Modes of a joint that nothing holds."""
    free = plain(replace(tee, fixed=np.zeros(len(tee.xyz), bool)), 103, modes=9)
    return free, free.text().replace("EIGRL,1,,,9", f"EIGRL,1,,,9,,,{shift}")


def test_free_body(tee, tmp_path):
    """Rigid modes carry round-off: they prove no sign and are no imbalance, in the audit and in the assessment."""
    deck, text = free_modes(tee, -1.0e5)
    done = chain(deck, tmp_path, "free", text=text)
    results = read_forces(done.op2, None)
    assert (results.frequency < 1e-2).sum() == 6
    assert {name for name, row in done.lights.items() if row.light == "red"} == set()
    assert done.lights["element balance"].value < 1e-5
    assert done.lights["sign"].value == pytest.approx(1, abs=1e-3)
    assert "in 3 modes" in done.lights["sign"].finding
    kinds = pd.read_csv(done.conversion.folder / "modes.csv").kind
    assert kinds.tolist() == ["rigid"] * 6 + ["normal"] * 3


def test_modes_that_have_not_converged_are_red(tee, tmp_path):
    """With its default shift the solver misses modes of a free body by a fifth; its totals do not vanish."""
    deck, text = free_modes(tee, -1.0e5)
    good, _ = judged(text, tmp_path)
    bad, rows = judged(deck.text(), tmp_path)
    assert abs(bad.frequency.max() / good.frequency.max() - 1) > 0.05
    assert rows["grid totals"].light == "red"
    assert "not converged" in rows["grid totals"].remedy


def test_a_damaged_number_is_red(tee, tmp_path):
    """In a static case a total tells where; in a mode the shell is out of balance."""
    for sol, check in ((101, "grid totals"), (103, "element balance")):
        mesh, op2 = solve_text(plain(tee, sol).text(), tmp_path, f"run{sol}")
        results = read_forces(op2, None)
        at = int(np.flatnonzero(results.of_element)[40])
        force = results.force.copy()
        force[1, at, 2] += 0.02 * np.nanmax(np.abs(force[1, :, :3]))
        rows = {row.check: row for row in audit(replace(results, force=force), read_model(mesh)).rows}
        assert rows[check].light == "red"
        if sol == 101:
            assert f"grid {results.node[at]} in mode 2" in rows[check].finding


def test_drilling_springs_tied_to_the_ground(tee, tmp_path):
    """PARAM,K6ROT leaves shells out of balance about their normals; it is told, and the stress stays."""
    plainly = chain(plain(tee, 101), tmp_path, "plain")
    sprung = chain(plain(tee, 101, extra=("PARAM,K6ROT,100.",)), tmp_path, "sprung")
    row = sprung.lights["element balance"]
    assert (row.light, plainly.lights["element balance"].light) == ("amber", "green")
    assert row.value > 1e-2
    assert "without their moments about their own normals" in row.finding
    assert "K6ROT" in row.remedy
    for column in ("membrane_MPa", "bending_MPa"):
        wanted = plainly.stress()[column].to_numpy()
        assert np.allclose(sprung.stress()[column], wanted, rtol=0, atol=1e-2 * np.abs(wanted).max())


def test_warped_quads_are_assessed_with_a_doubt(tee, tmp_path):
    """Flat elements over warped corners miss their balance a little: amber, and a warning in the result, no refusal."""
    rng = np.random.default_rng(0)
    warped = replace(tee, xyz=tee.xyz + 0.3 * rng.normal(size=tee.xyz.shape))
    done = chain(plain(warped, 101), tmp_path, "warped")
    row = done.lights["element balance"]
    assert (row.light, done.conversion.audit.grounded_drilling) == ("amber", False)
    assert 1e-3 < row.value < 1e-2
    record = json.loads((done.result / "provenance.json").read_text())
    assert "imbalance" in {warning["code"] for warning in record["warnings"]}
    corrected = chain(plain(warped, 101, quad="MITC4"), tmp_path, "corrected")
    assert corrected.lights["element balance"].value < 1e-5


def test_thin_shells_and_line_elements_at_the_weld(tee, tmp_path):
    """Thin plates have cards of their own; springs, rods and bushes at the line are no part of a plate."""
    extra = (
        "CBUSH,900,91,27,40,,,,0", "PBUSH,91,K,1000.,1000.,1000.,1.E6,1.E6,1.E6",
        "CELAS1,901,92,28,1,29,1", "PELAS,92,500.", "CELAS2,904,100.,33,3,38,3",
        "CROD,902,93,30,45", "PROD,93,1,20.", "CONROD,905,27,50,1,10.", "CONM2,903,31,,0.001",
    )  # fmt: skip
    for name, model in (("quads", tee), ("triangles", joints.with_triangles(tee, np.random.default_rng(1), 1.0))):
        deck = plain(model, 101, extra=extra)
        thin = deck.text().replace("CQUAD4  ", "CQUAD4K ").replace("CTRIA3  ", "CTRIA3K ")
        done = chain(deck, tmp_path, name, text=thin)
        assert {row.light for row in done.lights.values()} == {"green"}
        assert {row.status for row in done.conversion.welds} == {"assess"}


@pytest.mark.parametrize("sol", [101, 103])
def test_forces_of_offset_plates_are_refused(tee, tmp_path, sol):
    """MYSTRAN recovers the forces of plates with ZOFFS wrongly; shells balance, but its own totals do not vanish."""
    lines = [
        f"{line:<64}3.0" if line.startswith("CQUAD4") and line.split()[2] == "1" else line
        for line in plain(tee, sol).text().splitlines()
    ]
    _, rows = judged("\n".join(lines), tmp_path)
    assert rows["element balance"].light == "green"
    assert rows["grid totals"].light == "red"
    assert rows["grid totals"].value > 0.1
    assert "ZOFFS" in rows["grid totals"].remedy


def test_runs_without_forces_say_so(tee, tmp_path):
    """Printed results leave no table; parabolic shells stop the solver at the force balance; buckling has none."""
    printed = plain(tee, 101).text().replace("(PLOT)", "")
    curved = plain(joints.parabolic(tee), 101, density=0.0).text()
    buckled = plain(tee, 101, extra=("EIGRL,1,,,3",)).text().replace("SOL 101", "SOL 105")
    buckled = buckled.replace("SUBCASE 2\nLOAD = 102", "SUBCASE 2\nMETHOD = 1")
    for text, found in (
        (printed, r"no grid point forces .*tables found: none"),
        (curved, r"no grid point forces .*tables found: OUGV1"),
        (buckled, r"Buckling shapes .* are no modes of vibration"),
    ):
        _, op2 = solve_text(text, tmp_path, "run", stops=text is curved)
        with pytest.raises(DataError, match=found):
            read_forces(op2, None)
