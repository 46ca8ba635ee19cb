"""Element forces of unit loads: summed like those of modes, balanced unless the elements carry the load."""

import numpy as np
import pandas as pd
import pytest

from fatigue.errors import DataError
from fatigue.pipeline.solve.model import read_model
from tests.small_case import SPACING, THICKNESS, small_case
from tests.test_assess import COMPONENTS, element_form, write_element_form

LENGTH, ELEMENTS, PRESSURE = 500.0, 20, 0.01  # mm, -, N/mm2: a cantilever strip under pressure (A1 loaded_elements)


def write(folder, spoil=lambda forces: forces, *, carries=False, forces=None):
    """The small case in element forces, mode 2 or other forces as a unit load; returns the case file."""
    case = small_case(2.0)
    table, sides, mesh = element_form(case)
    of_mode = table["mode"] == 2
    case.modes = case.modes[case.modes["mode"] != 2]
    case.nodal_forces = case.nodal_forces[case.nodal_forces["mode"] != 2]
    case.histories = {name: history.rename(columns={"q_2": "u_load"}) for name, history in case.histories.items()}
    case.extra = '[[body.unit_load]]\nname = "load"\nunit = "kN"\nelement_forces = "loads.csv"\n'
    case.extra += "elements_carry_load = true\n" * carries
    path = write_element_form(case, folder, table[~of_mode], sides, mesh)
    loads = table[of_mode].drop(columns="mode").assign(unit_load="load") if forces is None else forces(table[of_mode])
    spoil(loads).to_csv(folder / "loads.csv", index=False)
    return path


def test_the_stress_is_that_of_a_mode(tmp_path):
    """The same forces under either name."""
    case = small_case(2.0)
    modal = read_model(write_element_form(case, tmp_path / "a", *element_form(case))).stations.treated
    loaded = read_model(write(tmp_path / "b")).stations.treated
    for component in ("membrane", "bending", "in_plane_shear", "twist_shear"):
        expected = getattr(modal, component)[:, [0, 2, 1]]  # modes 1 and 7, then the load
        np.testing.assert_allclose(getattr(loaded, component), expected, atol=1e-12 * np.abs(expected).max())


@pytest.mark.parametrize(
    ("spoil", "message"),
    [
        (
            lambda f: f.assign(fx_N=f.fx_N.where(f.node < 5000, 0.0)),
            "unit load load: forces and moments are out",
        ),
        (lambda f: f[f.element != 100000], "unit load load: no row of element forces"),
        (lambda f: pd.concat([f, f.iloc[:1]]), "repeats row 1"),
        (lambda f: f.assign(unit_load="lode"), "the unit load 'load' has no forces. Write 'lode'"),
    ],
)
def test_spoilt_element_forces_are_refused(tmp_path, spoil, message):
    """With the name of the load."""
    with pytest.raises(DataError) as refusal:
        read_model(write(tmp_path, spoil))
    assert message in str(refusal.value)


def strip_forces() -> tuple[np.ndarray, np.ndarray]:
    """(force, moment) of K_e u_e and of the own load f_e at both ends of the element at the clamped end, per mm."""
    h, stiffness = LENGTH / ELEMENTS, 1e7
    rows = [[12, 6 * h, -12, 6 * h], [6 * h, 4 * h**2, -6 * h, 2 * h**2]]
    rows += [[-12, -6 * h, 12, -6 * h], [6 * h, 2 * h**2, -6 * h, 4 * h**2]]
    K_e = stiffness / h**3 * np.array(rows)
    f_e = PRESSURE * h / 2 * np.array([1.0, h / 6, 1.0, -h / 6])
    K, f = np.zeros((2 * ELEMENTS + 2,) * 2), np.zeros(2 * ELEMENTS + 2)
    for e in range(ELEMENTS):
        K[2 * e : 2 * e + 4, 2 * e : 2 * e + 4] += K_e
        f[2 * e : 2 * e + 4] += f_e
    u = np.concatenate([np.zeros(2), np.linalg.solve(K[2:, 2:], f[2:])])
    return K_e @ u[:4], f_e


def test_forces_of_a_loaded_element():
    """K_e u_e alone lacks l / 2L of the force and l^2 / 6L^2 of the moment (A1 loaded_elements)."""
    Ku, f_e = strip_forces()
    np.testing.assert_allclose(np.abs(Ku - f_e)[:2], [5.0, 1250.0], rtol=1e-7)
    np.testing.assert_allclose(np.abs(Ku)[:2], [4.875, 1249.479166652166], rtol=1e-7)


def without_mesh(path):
    """The case without nodes: forces are balanced, moments need coordinates."""
    path.write_text(path.read_text().replace('nodes = "nodes.csv"\n', ""))
    return path


@pytest.mark.parametrize(("own", "moment"), [(1.0, 1250.0), (0.0, 1249.479166652166)])
def test_a_load_on_the_assessed_elements(tmp_path, own, moment):
    """With its own load an element does not balance: refused with the way out, and right once that is taken."""
    Ku, f_e = strip_forces()
    ends = (Ku - own * f_e).reshape(2, 2)  # at the line and beyond it

    def forces(table):
        """The strip along the line of each weld; its span, length l, is along -y."""
        found = table.drop(columns="mode").assign(unit_load="load")
        near = (found.node < 5000).to_numpy()
        found[list(COMPONENTS)] = 0.0
        found.loc[:, "fz_N"] = SPACING / 2 * np.where(near, ends[0, 0], ends[1, 0])
        found.loc[:, "mx_Nmm"] = SPACING / 2 * np.where(near, ends[0, 1], ends[1, 1])
        return found

    if own:
        with pytest.raises(DataError, match="or set elements_carry_load = true if the load acts on the elements"):
            read_model(without_mesh(write(tmp_path / "refused", forces=forces)))
    path = without_mesh(write(tmp_path, forces=forces, carries=own == 1.0))
    stress = read_model(path).stations.treated
    np.testing.assert_allclose(np.abs(stress.bending[:, 2]), 6.0 * moment / THICKNESS**2, rtol=1e-6)
