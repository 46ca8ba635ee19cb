"""What users ask of MYSTRAN, and what it does not do: sets, missing shapes, thermal loads, drilling springs, stops."""

from dataclasses import replace

import numpy as np
import pytest

from fatigue.errors import DataError
from fatigue.readers.audit import audit
from fatigue.readers.formats import read_forces, read_model
from fatigue.readers.tension_patch import DECK, convention_of
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


def test_free_body(tee, tmp_path):
    """Rigid modes prove no sign; the elastic ones beside them do (their values are no better than the solver's)."""
    free = replace(tee, fixed=np.zeros(len(tee.xyz), bool))
    results, rows = judged(plain(free, 103, modes=9).text(), tmp_path)
    assert (results.frequency < 1).sum() == 6
    assert rows["sign"].light == "green"
    assert "forces on_element" in rows["sign"].finding
    assert not [row for row in rows.values() if row.light == "red"]


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


def test_runs_without_forces_say_so(tee, tmp_path):
    """Printed results leave no table; parabolic shells stop the solver at the force balance; buckling has none."""
    printed = plain(tee, 101).text().replace("(PLOT)", "")
    curved = plain(joints.parabolic(tee), 101, density=0.0).text()
    buckled = plain(tee, 101, extra=("EIGRL,1,,,3",)).text().replace("SOL 101", "SOL 105")
    buckled = buckled.replace("SUBCASE 2\nLOAD = 102", "SUBCASE 2\nMETHOD = 1")
    for text, found in ((printed, "tables found: none"), (curved, "tables found: OUGV1"), (buckled, "OUGV1")):
        _, op2 = solve_text(text, tmp_path, "run", stops=text is curved)
        with pytest.raises(DataError, match="no grid point forces") as caught:
            read_forces(op2, None)
        assert found in str(caught.value)
