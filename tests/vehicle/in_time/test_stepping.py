"""One step: exact where it is linear, and right where it is not."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatigue.vehicle.in_time.contact import Contact, remainder
from fatigue.vehicle.in_time.stepping import CHUNK, AxleRows, Met, exact_step, product, states

LINEAR = Contact(0.1, 0.1, 0.002, 10e6, 9e6, 0.7465, 0.46, 0.008, 0.0, np.inf, 97.0)
WORN = LINEAR._replace(worn_conicity=1.2, flange=5e6)
ROWS = AxleRows(*(np.array([row]) for row in range(4)))  # one axle: y, psi, y', psi'


def oscillators(hz, damping):
    """State matrix of oscillators, and the column of a force on all of them."""
    w = 2 * np.pi * np.asarray(hz, np.float64)
    n = len(w)
    A = np.block([[np.zeros((n, n)), np.eye(n)], [-np.diag(w**2), -np.diag(2 * np.asarray(damping) * w)]])
    return A, np.concatenate([np.zeros(n), np.ones(n)])[:, None]


@given(st.integers(0, 1000), st.floats(1e-4, 1e-2))
def test_two_steps_are_one_of_twice_the_length(seed, step):
    """``Ad(2h) = Ad(h)^2``, and ``Bd(2h) = (Ad(h) + I) Bd(h)`` as the input is held."""
    rng = np.random.default_rng(seed)
    A, B = 30.0 * rng.normal(size=(6, 6)), rng.normal(size=(6, 2))
    once, twice = exact_step(A, B, step), exact_step(A, B, 2 * step)
    Ad, Bd = once[:, :6], once[:, 6:]
    np.testing.assert_allclose(twice, np.hstack([Ad @ Ad, (Ad + np.eye(6)) @ Bd]), rtol=1e-9, atol=1e-12)


def test_a_step_is_that_of_an_oscillator():
    """Free decay and response to a step of the force, in closed form."""
    hz, z, step = 8.0, 0.05, 1e-3
    A, B = oscillators([hz], [z])
    found = exact_step(A, B, step)
    w, v = 2 * np.pi * hz, 2 * np.pi * hz * np.sqrt(1 - z**2)
    e, c, s = np.exp(-z * w * step), np.cos(v * step), np.sin(v * step)
    assert found[0, 0] == pytest.approx(e * (c + z * w / v * s), rel=1e-12)
    assert found[0, 1] == pytest.approx(e * s / v, rel=1e-12)
    assert found[0, 2] == pytest.approx((1 - e * (c + z * w / v * s)) / w**2, rel=1e-9)


@pytest.mark.parametrize(("hz", "damping"), [(900.0, 0.1), (5e3, 1.0), (4e4, 1.0), (4e4, 0.1)])
def test_modes_far_above_the_step_stay_where_their_load_puts_them(hz, damping):
    """A mode of 40 kHz under a load of 9 Hz in steps of 1 ms: it is stable, and ``q = f/w^2``."""
    A, B = oscillators([hz], [damping])
    step = exact_step(A, np.hstack([B, np.zeros((2, 2))]), 1e-3)
    assert np.abs(np.linalg.eigvals(step[:, :2])).max() < 1.0
    load = np.sin(2 * np.pi * 9.0 * 1e-3 * np.arange(3000))
    met = Met(load[:, None], np.zeros((3000, 1)), np.zeros((3000, 1)))
    rows = AxleRows(*(np.array([row]) for row in (0, 0, 1, 1)))
    (found,) = states(step, np.zeros(2), met, rows, LINEAR)
    q = found[201:, 0] * (2 * np.pi * hz) ** 2
    np.testing.assert_allclose(q, load[200:-1], atol=0.06 if hz < 1e3 else 1e-6)  # a step of the load rings at 900 Hz


@given(st.integers(1, 9), st.integers(1, 9), st.integers(0, 100))
def test_a_product_is_a_product(n, m, seed):
    """Four columns at a time, and what is left over."""
    rng = np.random.default_rng(seed)
    A, z, y = rng.normal(size=(n, m)), rng.normal(size=m), np.full(n, np.nan)
    product(np.ascontiguousarray(A.T), z, y)
    np.testing.assert_allclose(y, A @ z, rtol=1e-12, atol=1e-14)


def wheelset(contact):
    """A wheelset on two springs with damping, small and stable: state matrix, lateral force and moment."""
    m, inertia, k, c, V = 1900.0, 1029.0, 2e7, 4e5, contact.speed
    K = np.array([[k, -2 * contact.f22], [2 * contact.f11 * contact.half_gauge * contact.conicity / contact.radius, k]])
    C = np.array([[c + 2 * contact.f22 / V, 0.0], [0.0, c + 2 * contact.f11 * contact.half_gauge**2 / V]])
    M = np.diag([m, inertia])
    A = np.block([[np.zeros((2, 2)), np.eye(2)], [-np.linalg.solve(M, K), -np.linalg.solve(M, C)]])
    return A, np.vstack([np.zeros((2, 2)), np.linalg.inv(M)])


def test_states_by_the_recipe():
    """``x(k+1) = Ad x(k) + Bd u(k) + Gd (1.5 g(k) - 0.5 g(k-1))``, first step g(0), over more than one chunk."""
    contact, rng = WORN._replace(friction=0.35 * 65e3), np.random.default_rng(3)
    A, G = wheelset(contact)
    B, n = np.vstack([np.zeros((2, 3)), rng.normal(size=(2, 3))]), CHUNK + 50
    met = Met(100 * rng.normal(size=(n, 3)), 2e-3 * rng.normal(size=(n, 1)), rng.random((n, 1)))
    step, start = exact_step(A, np.hstack([B, G]), 1e-3), np.array([9e-3, 1e-3, 0.1, -0.1])
    chunks = list(states(step, start, met, ROWS, contact))
    assert [len(chunk) for chunk in chunks] == [CHUNK, 50]
    found = np.concatenate(chunks)
    x, before = start, None
    for k in range(n):
        np.testing.assert_allclose(found[k], x, rtol=1e-9, atol=1e-12)
        y, psi, y_rate, psi_rate = x
        g = np.array(remainder(y - met.lateral[k, 0], psi, y_rate, psi_rate, met.worn[k, 0], contact))
        held = g if before is None else 1.5 * g - 0.5 * before
        x, before = step @ np.concatenate([x, met.u[k], held]), g


@pytest.mark.parametrize("friction", [np.inf, 0.35 * 65e3])
def test_worn_contact_is_integrated_to_the_second_order(friction):
    """Half the step, a quarter of the error: against steps of 1/32 ms."""
    contact = WORN._replace(friction=friction)
    A, G = wheelset(contact)
    start, ends = np.array([4e-3, 0.0, 0.0, 0.0]), {}
    for parts in (1, 2, 32):
        n = 50 * parts + 1
        met = Met(np.zeros((n, 0)), np.zeros((n, 1)), np.ones((n, 1)))
        step = exact_step(A, G, 1e-3 / parts)
        ends[parts] = np.concatenate(list(states(step, start, met, ROWS, contact)))[-1]
    coarse, fine = (np.abs(ends[parts] - ends[32])[:2] for parts in (1, 2))
    assert (coarse < 2e-2 * np.abs(start).max()).all()
    assert (coarse > 2.5 * fine).all()
