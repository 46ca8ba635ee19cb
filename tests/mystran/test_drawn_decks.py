"""Thirty models drawn from a seed, statically and in modes, from the deck through a solver to the lives of welds."""

from functools import cache

import numpy as np
import pandas as pd
import pytest

from fatigue.readers.foreign.read import read_forces
from tests.mystran.chain import chain
from tests.mystran.drawn import drawn
from tests.mystran.solver import listed_modes, needs_mystran

SEEDS = range(30)
RUNS = [(seed, sol) for seed in SEEDS for sol in ("static", "modal")]

pytestmark = needs_mystran


@pytest.fixture(scope="session")
def run(tmp_path_factory):
    """Give the chain of a seed's run, each made once."""
    folder = tmp_path_factory.mktemp("drawn")

    @cache
    def made(seed, which):
        return chain(getattr(drawn(seed), which), folder, f"{which}{seed}")

    return made


@pytest.mark.parametrize(("seed", "sol"), RUNS)
def test_no_false_alarm_and_a_proven_sign(run, seed, sol):
    """Shells balance to single precision, work or loads prove the sign, nothing is red, every line is assessed."""
    done = run(seed, sol)
    story = drawn(seed).story
    assert {name for name, row in done.lights.items() if row.light == "red"} == set(), story
    assert done.lights["element balance"].value < 1e-4, story
    assert (done.lights["sign"].light, done.conversion.audit.convention) == ("green", "on_element"), story
    assert done.lights["sign"].value == pytest.approx(1, abs=1e-3), story
    assert {row.status for row in done.conversion.welds} == {"assess"}, story


@pytest.mark.parametrize("seed", SEEDS)
def test_totals_are_a_checksum_of_static_cases_only(run, seed):
    """Loads less forces on elements are the totals; in modes the totals hold an inertia force that has no row."""
    assert run(seed, "static").lights["grid totals"].light == "green"
    assert run(seed, "static").lights["grid totals"].value < 1e-5
    assert run(seed, "modal").lights["grid totals"].light == "amber"
    assert run(seed, "modal").lights["grid totals"].value is None


@pytest.mark.parametrize("seed", SEEDS)
def test_frequencies_are_those_of_the_listing(run, seed):
    """The eigenvalues that stand beside the shapes are those the solver prints."""
    done = run(seed, "modal")
    results = read_forces(done.op2, None)
    listed = listed_modes(done.op2)
    assert results.mode.tolist() == list(listed)
    assert results.frequency == pytest.approx(np.array(list(listed.values())), rel=1e-6)
    assert pd.read_csv(done.conversion.folder / "modes.csv").frequency_hz.to_numpy() == pytest.approx(results.frequency)


@pytest.mark.parametrize(("seed", "sol"), RUNS)
def test_frames_units_numbers_and_directions_do_not_matter(run, seed, sol):
    """A model turned, renumbered, with displacement frames and in other units has the stresses of its plain twin."""
    model = drawn(seed)
    deck = getattr(model, sol)
    ours, theirs = (
        faces(run(seed, which).stress(), which_deck.node_ids, sol == "modal")
        for which, which_deck in ((sol, deck), (f"{sol}_twin", getattr(model, f"{sol}_twin")))
    )
    assert ours.keys() == theirs.keys(), model.story
    largest = {mode: max(np.abs(v).max() for (m, _), v in theirs.items() if m == mode) for mode, _ in theirs}
    for (mode, node), values in ours.items():
        assert np.allclose(values, theirs[mode, node], rtol=0, atol=2e-3 * largest[mode]), (model.story, mode, node)


def faces(table, node_ids, is_modal):
    """Stresses of both faces of all sides of a node in ascending order, by mode and position of the node in the model.

    A mode has no sign.
    """
    position = {int(n): k for k, n in enumerate(node_ids)}
    found = {}
    for mode, node, *parts in table[["mode", "node", "membrane_MPa", "bending_MPa"]].itertuples(index=False):
        membrane, bending = parts
        values = found.setdefault((mode, position[node]), [])
        values += [membrane + bending, membrane - bending]
    return {key: np.sort(np.abs(v) if is_modal else v) for key, v in found.items()}
