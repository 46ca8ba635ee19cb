"""Reduction of the frame body against another program: every number of ``body_and_reduction.json``.

Tolerances are those of the numbers: 2e-4, or half a unit of their last digit, and 5e-3 for the highest frequency.
"""

import json
from pathlib import Path

import numpy as np
import pytest
from scipy.linalg import eigh

from fatigue.flexbody.condensation.completeness import effective_masses, flexibility_ratio
from fatigue.flexbody.condensation.craig_bampton import craig_bampton
from fatigue.flexbody.condensation.free_interface import free_interface, shared_load
from fatigue.flexbody.condensation.guyan import guyan
from fatigue.flexbody.condensation.kuhar import kuhar
from fatigue.flexbody.condensation.orthonormal import orthonormal, reduced
from fatigue.flexbody.factor import free_body
from fatigue.flexbody.mass import dynamic_mass
from fatigue.flexbody.modes import free_modes
from fatigue.flexbody.structure import Basis
from fatigue.vehicle.frame_body import EXTERNAL, INTERNAL, frame_structure, masters_of, node_at

ORACLES = json.loads((Path(__file__).parents[1] / "data/vehicle/body_and_reduction.json").read_text())
NODES = {"external6": (EXTERNAL,), "all18": (EXTERNAL, INTERNAL)}
PLACES = {
    "conv_z": (1, 2, 2), "conv_y": (1, 2, 1), "trafo_z": (3, 1, 2), "roof_z": (-2, 5, 2), "bolster_z": (5, 2, 2),
    "mid_floor_z": (0, 0, 2),
}  # fmt: skip
Z = 0.015


@pytest.fixture(scope="module")
def body():
    """The free frame body."""
    return free_body(frame_structure())


@pytest.fixture(scope="module")
def loads(body):
    """A unit force at each place whose flexibility is tabled."""
    return np.column_stack([shared_load(body.structure, [node_at(s, k)], d) for s, k, d in PLACES.values()])


@pytest.fixture(scope="module", params=NODES)
def interface(request, body):
    """Name, masters, and all fixed-interface modes of the 6 external nodes and of all 18."""
    masters = masters_of(*NODES[request.param])
    mass = body.structure.M.diagonal()[~masters]  # lumped
    K = body.structure.K[~masters][:, ~masters].toarray()
    w2, vectors = eigh(K / np.sqrt(np.outer(mass, mass)), driver="evd")
    shapes = np.zeros((len(masters), len(w2)))
    shapes[~masters] = vectors / np.sqrt(mass)[:, None]
    return request.param, masters, Basis(shapes, np.sqrt(w2) / (2 * np.pi), np.ones(len(w2), dtype=bool))


def near(values, known, rel=2e-4, digits=4):
    """Hold values against those of a table, printed with some digits after the point."""
    known = np.asarray(known, dtype=float)
    assert np.asarray(values) == pytest.approx(known, rel=rel, abs=0.5 * 10.0**-digits)


def test_modes_of_the_body(body):
    """The first twenty elastic modes, from 11.71 Hz."""
    near(free_modes(body, count=20).frequency, ORACLES["body"]["elastic_hz"], rel=1e-6, digits=5)


def test_flexibility_of_the_body(body, loads):
    """Static answers of the free body where loads enter are those of all its modes."""
    known = ORACLES["flexibility_full_m_per_N"]
    assert tuple(known) == tuple(PLACES)
    own = np.einsum("ij,ij->j", loads, body.elastic(loads))
    assert own == pytest.approx(list(known.values()), rel=1e-5)


def test_guyan_and_kuhar(body, interface):
    """Eigenvalues of the reduced pairs, those above the first six.

    Kuhar's pair has no rigid motions, and what the table drops is the six lowest by number: with six nodes the mode at
    11.709 Hz, that the condensation is exact for, is among them.
    """
    name, masters, _ = interface
    known, S = ORACLES["condensation"][name], body.structure
    first = free_modes(body, count=1).frequency[0]
    for method, T in (
        ("guyan", guyan(S, masters)),
        ("kuhar_at_mode1", kuhar(S, masters, first)),
        ("kuhar_at_10Hz", kuhar(S, masters, 10.0)),
    ):
        hz = np.sqrt(np.abs(eigh(*reduced(S, T), eigvals_only=True))) / (2 * np.pi)
        near(hz[6:14], known[method], rel=1e-5)
        if method == "guyan":
            assert orthonormal(S, T, 60.0).basis.frequency[:8] == pytest.approx(hz[6:14], rel=1e-9)
        if method == "kuhar_at_mode1":
            assert abs(hz - first).min() < 1e-6
            assert orthonormal(S, T, 60.0).basis.frequency[0] == pytest.approx(first, rel=1e-9)


def test_trace_of_a_weakened_stiffness(body):
    """Guyan's stiffness of 18 nodes has 0.34 of the trace of K_mm."""
    masters = masters_of(EXTERNAL, INTERNAL)
    K_r, _ = reduced(body.structure, guyan(body.structure, masters))
    ratio = np.trace(K_r) / body.structure.K.diagonal()[masters].sum()
    near(ratio, ORACLES["guyan_trace_ratio_all18"], rel=2e-5, digits=5)


@pytest.mark.parametrize("cut", [15, 30, 60])
def test_craig_bampton(body, loads, interface, cut):
    """Columns, frequencies and flexibility of strong and weak bases at three cuts."""
    name, masters, _ = interface
    known = ORACLES["condensation"][name][f"craig_bampton_{cut}Hz"]
    T = craig_bampton(body.structure, masters, upto_hz=float(cut))
    assert T.shape[1] == known["n_columns"]
    assert T.shape[1] - masters.sum() == known["n_fixed_modes"]
    found = orthonormal(body.structure, T, float(cut))
    assert found.dependent == 0
    assert len(found.basis.frequency) == known["n_columns"] - 6
    near(found.basis.frequency[:10], known["elastic_hz"], rel=1e-5)
    assert found.basis.frequency[-1] == pytest.approx(known["highest_hz"], rel=5e-3)
    near(flexibility_ratio(body, found.basis, loads), list(known["flexibility_over_full"].values()))


def test_free_interface(body, loads, interface):
    """Free modes up to 30 Hz and residual attachments of translations: complete where loads enter."""
    name, masters, _ = interface
    known = ORACLES["free_interface"][f"{name}_translations_30Hz"]
    columns = np.eye(len(masters))[:, masters & (body.structure.direction < 3)]
    assert columns.shape[1] == known["n_residual"]
    found = orthonormal(body.structure, free_interface(body, columns, upto_hz=30.0), 30.0)
    basis = found.basis
    assert (found.dependent, basis.normal.sum(), len(basis.normal)) == (0, known["n_normal"], known["n_columns"])
    near(basis.frequency[:10], known["elastic_hz"], rel=1e-5)
    near(basis.frequency[~basis.normal][0], known["first_residual_hz"])
    assert basis.frequency[-1] == pytest.approx(known["highest_hz"], rel=5e-3)
    near(flexibility_ratio(body, basis, loads), list(known["flexibility_over_full"].values()), digits=5)
    assert flexibility_ratio(body, basis, columns) == pytest.approx(np.ones(columns.shape[1]), rel=1e-9)


def test_effective_mass(body, interface):
    """Effective masses of the first ten fixed-interface modes, of all, of the interface, and the share below 60 Hz."""
    name, masters, fixed = interface
    known = ORACLES["effective_mass"][name]
    found = effective_masses(body.structure, masters, fixed)
    assert found.total == pytest.approx(known["total"], rel=1e-7)
    assert found.boundary == pytest.approx(known["boundary"], rel=1e-7)
    assert found.effective.sum(axis=0) == pytest.approx(known["sum_modes"], rel=1e-7)
    assert found.effective.sum(axis=0) + found.boundary == pytest.approx(found.total, rel=1e-9)
    assert found.share(60.0) == pytest.approx(known["share_below_60Hz"], rel=2e-5)
    for i, mode in enumerate(known["first_modes"]):
        assert found.frequency[i] == pytest.approx(mode["hz"], rel=1e-5)
        assert found.effective[i] == pytest.approx(mode["m_eff"], rel=1e-4, abs=1e-9 * max(mode["m_eff"]))


def test_dynamic_mass(body, interface):
    """What a moving interface feels at some frequencies, with 1.5 % of damping and with none."""
    name, masters, fixed = interface
    carried = effective_masses(body.structure, masters, fixed)
    checked = 0
    for direction, rows in ORACLES["dynamic_mass"][name].items():
        axis = "xyz".index(direction)
        for row in rows:
            f = np.array([row["hz"]])
            for damping, key in ((Z, "damped_re_im"), (0.0, "undamped")):
                if key in row:
                    z = np.full(len(fixed.frequency), damping)
                    mass = dynamic_mass(f, fixed.frequency, z, carried.effective, carried.total)[0, axis]
                    value = complex(*np.atleast_1d(row[key]))
                    assert abs(mass - value) < 2e-4 * abs(value)
                    checked += 1
    assert checked == 39
