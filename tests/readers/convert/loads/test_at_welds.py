"""Loads on the elements beside welds: files hold K u, which balances and lacks the elements' own load."""

from dataclasses import replace

import numpy as np
import pytest

from fatigue.readers.convert.audit.audit import audit
from fatigue.readers.convert.loads.at_welds import loads_at_welds
from fatigue.readers.convert.options import WeldSources
from fatigue.readers.convert.weld_lines import find_welds
from fatigue.readers.foreign.nastran.deck.bdf import read_bdf
from tests.readers.tee_model import bulk, tee, turned_frames

PRESSURE = 0.01  # MPa on the base plate, elements 1 to 96 of 10 x 10 mm


def under_pressure(loaded):
    """A static run under a pressure along z on some elements, as NASTRAN writes it, and the forces on elements."""
    case = tee()
    model = case.model
    load = np.zeros((len(model.xyz), 6))
    np.add.at(load[:, 2], model.quads[loaded].ravel(), PRESSURE * 100 / 4)
    fixed = np.zeros_like(load, bool)
    fixed[(model.xyz[:, 0] < 1) | (model.xyz[:, 0] > 119)] = True
    u = model.solve(load, fixed)
    force = model.element_forces(u)
    node = (model.quads + 1).ravel()
    grids = np.flatnonzero(load.any(axis=1)) + 1
    rows = np.concatenate([-force.reshape(-1, 6), load[grids - 1]])[None]
    results = replace(
        case.results,
        analysis="static",
        mode=np.array([1]),
        frequency=np.array([np.nan]),
        modal_mass=np.array([np.nan]),
        node=np.concatenate([node, grids]),
        element=np.concatenate([np.repeat(np.arange(1, len(model.quads) + 1), 4), np.zeros(grids.size, np.int64)]),
        kind=np.array(["QUAD4"] * node.size + ["APP-LOAD"] * grids.size),
        force=turned_frames(rows, np.concatenate([node, grids])),
        shape_node=np.empty(0, np.int64),
        shape=np.empty((1, 0, 6)),
        unit_loads={1: "pressure"},
    )
    return results, force


@pytest.fixture
def model(tmp_path):
    """The deck of the joint."""
    (tmp_path / "tee.bdf").write_text(bulk(tee()))
    return read_bdf(tmp_path / "tee.bdf")


def test_forces_of_loaded_elements_balance(model):
    """A grid point force balance has K u for the element; the pressure stands at the grid: the audit is green."""
    results, force = under_pressure(np.arange(96))
    assert np.abs(force.sum(axis=1)[:, :3]).max() < 1e-9 * np.abs(force).max()
    lights = {row.check: row for row in audit(results, model, "on_node").rows}
    assert lights["element balance"].light == "green"
    assert "in unit load pressure" in lights["element balance"].finding


def test_the_share_of_the_elements_own_load_is_told(model):
    """It is their load at the line over their forces there; the upright, which carries none, is not told."""
    results, force = under_pressure(np.arange(96))
    found = find_welds(model, WeldSources())
    wanted = {}
    quads = tee().model.quads
    for row, cut in found.assessed():
        own = quads[cut.elements - 1]
        here = np.isin(own, cut.line.node - 1)
        load = PRESSURE * 100 / 4 * here[cut.elements <= 96].sum()
        total = np.zeros((len(tee().model.xyz), 3))
        np.add.at(total, own[here], force[cut.elements - 1][here][:, :3])
        wanted[row.weld] = load / np.linalg.norm(total, axis=1).sum()
    (told,) = loads_at_welds(results, model, found)
    worst = max(wanted, key=wanted.get)
    assert told.count == sum(share > 0.01 for share in wanted.values()) == 2
    assert f"acts on the elements beside weld {worst}: their own load is about {wanted[worst]:.1%} of the" in told.what


def test_a_load_at_a_grid_or_elsewhere_is_no_load_on_the_elements(model):
    """A force at grids of the line, and a pressure away from the welds."""
    found = find_welds(model, WeldSources())
    results, _ = under_pressure(np.arange(12))
    assert loads_at_welds(results, model, found) == []
    results, _ = under_pressure(np.arange(96))
    single = (results.kind == "APP-LOAD") & ~np.isin(results.node, found.assessed()[0][1].line.node)
    lone = replace(results, force=np.where(single[None, :, None], 0.0, results.force))
    assert loads_at_welds(lone, model, found) == []
    assert loads_at_welds(replace(results, unit_loads={}), model, found) == []
