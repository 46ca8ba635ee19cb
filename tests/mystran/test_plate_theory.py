"""Structural stress along weld lines of static cases that plate theory solves, from a genuine solver's forces."""

from dataclasses import replace

import numpy as np
import pytest

from tests.mystran.chain import chain
from tests.mystran.decks import plain
from tests.mystran.plates import X, Y, Z, assembled, sheet
from tests.mystran.solver import needs_mystran

pytestmark = needs_mystran

LENGTH, WIDTH, HEIGHT, LOAD_N = 200.0, 100.0, 50.0, 1000.0
BASE_MM, UPRIGHT_MM = 10.0, 8.0


def edge_load(plates, at, force):
    """Spread a force evenly along the width: half at both ends of evenly spaced nodes."""
    nodes = np.flatnonzero(at(plates.xyz))
    y = plates.xyz[nodes, 1]
    share = np.where((y < 1e-6) | (y > WIDTH - 1e-6), 0.5, 1.0)
    return {int(n): np.append(force, np.zeros(3)) * s / share.sum() for n, s in zip(nodes, share, strict=True)}


def with_loads(plates, *cases):
    """Give plates load cases of (where, force)."""
    return replace(plates, loads=[edge_load(plates, at, force) for at, force in cases])


def is_top(p):
    """Upper edge of the upright."""
    return p[:, 2] > HEIGHT - 1e-6


def is_right(p):
    """Right edge of the base plate."""
    return p[:, 0] > LENGTH - 1e-6


@pytest.fixture(scope="module")
def tee(tmp_path_factory):
    """A T joint of shells for which constant bending is exact."""
    return solved_tee(tmp_path_factory.mktemp("tee"), "MITC4")


def solved_tee(folder, quad):
    """A T joint whose base is clamped at both ends, free to slide at the right one; no lateral contraction.

    Load cases: 1 the upright pushed along the base, 2 lifted, 3 the base pulled. Gives the stresses by property.
    """
    ys = np.linspace(0, WIDTH, 6)
    base = sheet((0, 0, 0), X, np.linspace(0, LENGTH, 11), Y, ys)
    upright = sheet((LENGTH / 2, 0, 0), Z, np.linspace(0, HEIGHT, 4), Y, ys)
    plates = assembled([(1, *base), (2, *upright)], (BASE_MM, UPRIGHT_MM), lambda p: p[:, 0] < 1e-6)
    plates = with_loads(plates, (is_top, LOAD_N * X), (is_top, LOAD_N * Z), (is_right, LOAD_N * X))
    slides = tuple(f"SPC1,1,3456,{k + 1}" for k in np.flatnonzero(is_right(plates.xyz)))
    done = chain(plain(plates, 101, poisson=0.0, quad=quad, extra=slides), folder, "tee")
    table = done.stress()
    sides = {}
    for weld, rows in table.groupby("weld"):
        register = next(row for row in done.conversion.welds if row.weld == weld)
        sides.setdefault(register.pid, []).append(rows)
    return sides


def values(rows, case):
    """Membrane and bending stress of a load case along a line."""
    own = rows[rows["mode"] == case]
    return own.membrane_MPa.to_numpy(), own.bending_MPa.to_numpy()


def both_sides(tee, case):
    """Membrane and bending stress of the two sides of the base, the left one first, which the slide holds."""
    found = [values(rows, case) for rows in tee[1]]
    return sorted(found, key=lambda pair: -abs(pair[0].mean()))


def test_pushed_upright_bends_the_base_and_pulls_one_side(tee):
    """Half the moment F h to either side, sigma_b = 6 m / t^2 = 15 MPa; the force goes to the clamped end."""
    (left_m, left_b), (right_m, right_b) = both_sides(tee, 1)
    assert left_m == pytest.approx(LOAD_N / (WIDTH * BASE_MM), rel=1e-4)
    assert right_m == pytest.approx(0, abs=1e-3)
    bending = 6 * LOAD_N * HEIGHT / 2 / WIDTH / BASE_MM**2
    assert bending == 15
    assert np.abs(left_b) == pytest.approx(bending, rel=1e-4)
    assert right_b == pytest.approx(-left_b, rel=1e-4)
    (upright,) = tee[2]
    membrane, bending = values(upright, 1)
    assert membrane == pytest.approx(0, abs=1e-3)
    assert np.abs(bending) == pytest.approx(6 * LOAD_N * HEIGHT / WIDTH / UPRIGHT_MM**2, rel=1e-4)


def test_lifted_upright_bends_the_base_as_a_clamped_beam(tee):
    """A load in the middle of a clamped beam: m = P L / (8 b) on both sides, of one sign; the upright is in tension."""
    (_, left_b), (_, right_b) = both_sides(tee, 2)
    bending = 6 * LOAD_N * LENGTH / 8 / WIDTH / BASE_MM**2
    assert np.abs(left_b) == pytest.approx(bending, rel=1e-4)
    assert right_b == pytest.approx(left_b, rel=1e-4)
    membrane, bending = values(tee[2][0], 2)
    assert membrane == pytest.approx(LOAD_N / (WIDTH * UPRIGHT_MM), rel=1e-4)
    assert bending == pytest.approx(0, abs=1e-3)


def test_pulled_base_is_in_tension_on_both_sides(tee):
    """Force over section, nothing in the upright."""
    for membrane, bending in both_sides(tee, 3):
        assert membrane == pytest.approx(LOAD_N / (WIDTH * BASE_MM), rel=1e-4)
        assert bending == pytest.approx(0, abs=1e-3)
    assert np.abs(values(tee[2][0], 3)).max() < 1e-3


def test_triangles_behind_the_quads_scatter_about_theory(tmp_path):
    """The default quad of the solver is no exact beam: a row of five holds the moment within 3 %, its sum exactly."""
    for rows in solved_tee(tmp_path, "MIN4")[1]:
        assert np.abs(values(rows, 1)[1]) == pytest.approx(15, rel=0.03)
        own = rows[rows["mode"] == 1].sort_values("order")
        line_force = np.trapezoid(own.membrane_raw_MPa, dx=WIDTH / 5) * BASE_MM
        assert min(abs(line_force), abs(line_force - LOAD_N)) < 1e-3 * LOAD_N


def test_lap_joint_bends_by_its_eccentricity(tmp_path):
    """One lap pulled: the clamped plate carries the force times the distance of the two mid-surfaces at its weld."""
    t, over = (10.0, 8.0, 9.0), 40.0
    gap = (t[0] + t[1]) / 2
    ys = np.linspace(0, WIDTH, 6)
    xs = np.linspace(0, 120, 7)
    lower = sheet((0, 0, 0), X, xs, Y, ys)
    upper = sheet((120 - over, 0, gap), X, xs, Y, ys)
    rows = [sheet((x, 0, 0), Z, (0, gap), Y, ys) for x in (120 - over, 120)]
    plates = assembled([(1, *lower), (2, *upper), *((3, *row) for row in rows)], t, lambda p: p[:, 0] < 1e-6)
    plates = with_loads(plates, (lambda p: p[:, 0] > 240 - over - 1e-6, LOAD_N * X))
    done = chain(plain(plates, 101, poisson=0.0, quad="MITC4"), tmp_path, "lap")
    table = done.stress()
    free = {1: 0, 2: 0}  # sides that carry all of the force: those outside the overlap
    for row in done.conversion.welds:
        membrane, bending = values(table[table.weld == row.weld], 1)
        if row.pid in free and np.allclose(membrane, LOAD_N / (WIDTH * t[row.pid - 1]), rtol=1e-3):
            free[row.pid] += 1
            moment = LOAD_N * gap / WIDTH if row.pid == 1 else 0.0
            assert np.abs(bending) == pytest.approx(6 * moment / t[row.pid - 1] ** 2, rel=1e-4, abs=1e-3)
    assert free == {1: 1, 2: 1}
