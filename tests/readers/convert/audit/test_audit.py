"""The audit of foreign forces: each trap raises its light, with a number."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fatigue.errors import DataError
from fatigue.readers.convert.audit.audit import audit
from fatigue.readers.convert.audit.tension_patch import DECK, convention_of
from fatigue.readers.foreign.fe.results import TOTALS, FeResults
from fatigue.readers.foreign.nastran.deck.bdf import read_bdf
from fatigue.readers.foreign.nastran.results.op2 import read_op2
from tests.readers.tee_model import bulk, tee
from tests.shell_fe import ShellModel

NASTRAN = Path("data/nastran")


@pytest.fixture
def model(tmp_path):
    """The T joint's geometry with its displacement frames."""
    path = tmp_path / "tee.bdf"
    path.write_text(bulk(tee()))
    return read_bdf(path)


def rows(results, model, **options):
    """Audit rows by check."""
    return {row.check: row for row in audit(results, model, **options).rows}


def only(results, keep):
    """Results with some of the rows."""
    return replace(
        results,
        node=results.node[keep],
        element=results.element[keep],
        kind=results.kind[keep],
        force=results.force[:, keep],
    )


def test_sound_forces_are_green(model):
    """A whole modal run passes everything; work over omega^2 m is -1 for forces on nodes, +1 on elements."""
    found = rows(tee().results, model, interface_modes=[5])
    assert {row.light for row in found.values()} == {"green"}
    assert found["sign"].value == pytest.approx(-1, abs=1e-6)
    assert found["element balance"].value < 1e-9
    turned = replace(tee().results, force=-tee().results.force)
    assert audit(turned, model).convention == "on_element"
    assert rows(turned, model)["sign"].value == pytest.approx(1, abs=1e-6)


def test_wrong_sign_is_red(model):
    """A stated convention that the work contradicts."""
    assert rows(tee().results, model, stated="on_element")["sign"].light == "red"
    assert rows(tee().results, model, stated="on_node")["sign"].light == "green"


def test_ignored_frames_are_red(model):
    """Forces in displacement frames taken for basic ones do not balance, and basic ones rotated once more do not."""
    plain = replace(model, frame_node=np.empty(0, np.int64), frame=np.empty((0, 3, 3)))
    assert rows(tee().results, plain)["element balance"].light == "red"
    case = tee()
    basic = case.results.force.copy()
    on_node = -case.element_force.reshape(len(case.frequency), -1, 6)
    basic[:, : on_node.shape[1]] = on_node
    found = rows(replace(case.results, force=basic), model)
    assert found["displacement frames"].light == "red"
    assert found["displacement frames"].value == case.turned.size
    assert "0 after" not in rows(case.results, model)["displacement frames"].finding


def test_inertia_is_red(model):
    """Elements that carry their inertia force are out of balance."""
    case = tee()
    force = case.results.force.copy()
    omega = (2 * np.pi * case.frequency) ** 2
    mass = 7.85e-9 * 8 * 100 / 4
    count = case.model.quads.size
    at = case.results.node[:count] - 1
    force[:, :count, :3] += omega[:, None, None] * mass * case.results.shape[:, at, :3]
    assert rows(replace(case.results, force=force), model)["element balance"].light == "red"


def test_damaged_number_is_red(model):
    """One force changed by a percent of the largest shows in balance and totals."""
    results = tee().results
    force = results.force.copy()
    force[2, 40, 1] += 0.01 * np.abs(force[2, :, :3]).max()
    found = rows(replace(results, force=force), model)
    assert found["grid totals"].light == "red"
    assert f"grid {results.node[40]} in mode 3" in found["grid totals"].finding
    assert found["element balance"].light == "red"


def test_missing_totals_are_amber(model):
    """Without totals there is no checksum."""
    assert rows(only(tee().results, tee().results.kind != TOTALS), model)["grid totals"].light == "amber"


def test_part_of_the_model(model):
    """Forces of a part prove the sign by less than all work; welds elsewhere are left out; half an element is told."""
    results = tee().results
    found = rows(only(results, results.element <= 50), model)
    assert found["sign"].light == "green"
    assert -1 < found["sign"].value < 0
    assert (found["completeness"].light, found["completeness"].value) == ("amber", pytest.approx(50 / 120))
    keep = results.element <= 50
    keep[np.flatnonzero(results.element == 50)[0]] = False
    assert "1 at some nodes only" in rows(only(results, keep), model)["completeness"].finding


def test_foreign_mesh_is_red(model):
    """Shells that the mesh lacks, or has at other nodes, and forces of no shell at all."""
    results = tee().results
    other = np.where(results.element == 3, 999, results.element)
    assert rows(replace(results, element=other), model)["completeness"].light == "red"
    shifted = np.where(results.element == 3, results.node + 30, results.node)
    assert rows(replace(results, node=shifted), model)["completeness"].light == "red"
    solid = replace(results, element=np.where(results.element > 0, results.element + 5000, 0))
    assert rows(solid, model)["element balance"].light == "red"


def test_too_much_work_is_red(model):
    """Shapes scaled by 2 against their forces do twice the work."""
    results = tee().results
    assert rows(replace(results, shape=2 * results.shape), model)["sign"].light == "red"


def test_shapes_of_other_modes_are_red(model):
    """Forces and shapes in different orders: the works of elements have both signs above the lowest elastic mode."""
    results = tee().results
    for order in ([4, 3, 2, 1, 0], [0, 1, 3, 2, 4]):
        found = rows(replace(results, shape=results.shape[order]), model)["sign"]
        assert found.light == "red"
        assert "as if its shape were that of another mode" in found.finding
    shifted = rows(replace(results, shape=np.roll(results.shape, 1, axis=0)), model)["sign"]
    assert shifted.light != "green"
    assert "in no mode with a frequency" in shifted.finding


@pytest.mark.parametrize("single", [False, True])
@pytest.mark.parametrize("analysis", ["modal", "static"])
def test_an_element_of_the_other_sign_is_told(model, analysis, single):
    """One of all shells turned, in a file without totals: it is in balance, and its strain energy is negative."""
    results = only(tee().results, tee().results.of_element)
    kind = np.float32 if single else np.float64
    results = replace(results, force=results.force.astype(kind), shape=results.shape.astype(kind), analysis=analysis)
    if analysis == "static":
        results = replace(results, frequency=np.full(5, np.nan), modal_mass=np.full(5, np.nan))
    assert rows(results, model)["sign"].light == "green"
    for element in (5, 60, 100):
        force = np.where((results.element == element)[:, None], -results.force, results.force)
        found = rows(replace(results, force=force), model)
        assert found["element balance"].light == "green"
        assert found["sign"].light == "amber"
        assert f"1 of 120 elements do work of the other sign, element {element} in mode" in found["sign"].finding


def test_modes_without_any_force_are_told(model):
    """A mode with a frequency strains something; zeros are those of a run that did not recover it."""
    results = tee().results
    force = results.force * np.array([1, 0, 1, 0, 1])[:, None, None]
    found = rows(replace(results, force=force), model)["completeness"]
    assert found.light == "amber"
    assert "in 2 modes with a frequency all forces are zero, mode 2 the first" in found.finding


def test_sign_without_frequencies(model):
    """Element works of one sign decide where no mode has a frequency; mixed ones do not."""
    results = replace(tee().results, frequency=np.zeros(5))
    assert rows(results, model)["sign"].value == pytest.approx(-1)
    force = results.force.copy()
    force[:, results.element % 2 == 0] *= -1
    found = audit(replace(results, force=force), model)
    assert found.convention is None
    zero = audit(replace(results, shape=0 * results.shape), model)
    assert zero.convention is None


def test_sign_without_shapes(model):
    """Neither shapes nor loads: amber, and the stated sign is kept."""
    results = replace(tee().results, shape_node=np.empty(0, np.int64), shape=np.empty((5, 0, 6)))
    found = audit(results, model, "on_node")
    assert found.convention == "on_node"
    assert {row.check: row.light for row in found.rows}["sign"] == "amber"


def test_interface_modes_and_masses(model):
    """No interface mode is amber; masses other than 1 are told."""
    assert rows(tee().results, model)["interface modes"].light == "amber"
    mass = np.array([1.0, 2.0, 1.0, 1.0, 1.0])
    force = tee().results.force.copy()
    force[1] *= 2
    found = rows(replace(tee().results, modal_mass=mass, force=force), model)
    assert (found["generalised mass"].light, found["generalised mass"].value) == ("amber", 2.0)
    assert "generalised mass" not in rows(replace(tee().results, modal_mass=np.full(5, np.nan)), model)


@pytest.mark.parametrize(("factor", "light"), [(1.005, "green"), (1.02, "red")])
def test_frequency_match(model, factor, light):
    """Frequencies within 1 % match."""
    simulated = {2: tee().frequency[1] * factor}
    assert rows(tee().results, model, simulated=simulated)["frequency match"].light == light


def test_frequency_match_without_pairs(model):
    """No common mode leaves the match open."""
    assert rows(tee().results, model, simulated={77: 1.0})["frequency match"].light == "amber"


def static_results(sign):
    """The tension patch as a solver would deliver it."""
    model = ShellModel(np.array([[0.0, 0, 0], [10, 0, 0], [10, 10, 0], [0, 10, 0]]), np.array([[0, 1, 2, 3]]), 1.0)
    fixed = np.ones((4, 6), bool)
    fixed[1, :2] = fixed[2, :2] = False
    fixed[3, 1] = False
    load = np.zeros((4, 6))
    load[1:3, 0] = 50.0
    force = model.element_forces(model.solve(load, fixed))[0]
    reaction = np.where(fixed, force, 0.0)
    return FeResults(
        source="patch",
        solver="",
        analysis="static",
        mode=np.array([1]),
        frequency=np.array([np.nan]),
        modal_mass=np.array([np.nan]),
        node=np.tile(np.arange(1, 5), 3),
        element=np.repeat([1, 0, 0], 4),
        kind=np.repeat(["QUAD4", "APP-LOAD", "F-OF-SPC"], 4),
        force=np.concatenate([sign * force, load, reaction])[None],
        shape_node=np.empty(0, np.int64),
        shape=np.empty((1, 0, 6)),
    )


@pytest.mark.parametrize(("sign", "convention"), [(1, "on_element"), (-1, "on_node")])
def test_tension_patch(tmp_path, sign, convention):
    """One element in tension tells the sign by its forces, and by its loads in the audit."""
    path = tmp_path / "patch.bdf"
    path.write_text(DECK)
    results = static_results(sign)
    assert convention_of(results) == convention
    found = audit(results, read_bdf(path))
    assert found.convention == convention
    left_over = replace(results, element=np.where(results.kind == "APP-LOAD", 1, results.element))
    assert convention_of(left_over) == convention
    with pytest.raises(DataError, match=r"carries .* N at the pulled grids"):
        convention_of(replace(results, force=0.9 * results.force))


def test_static_sign_is_open_without_loads(tmp_path):
    """No load rows, zero loads, or loads that do not fit decide nothing."""
    path = tmp_path / "patch.bdf"
    path.write_text(DECK)
    model, results = read_bdf(path), static_results(1)
    assert audit(only(results, results.element > 0), model).convention is None
    assert audit(replace(results, force=results.force * (results.element > 0)[None, :, None]), model).convention is None
    assert (
        audit(
            replace(results, force=results.force * np.where(results.element > 0, 3, 1)[None, :, None]), model
        ).convention
        is None
    )


def test_real_files():
    """Real NASTRAN files: forces on nodes, balanced to single precision."""
    for name in ("modes_elements", "wingbox_stitched_together-000"):
        found = audit(read_op2(NASTRAN / f"{name}.op2"), read_bdf(NASTRAN / f"{name}.bdf"))
        values = {row.check: row.value for row in found.rows}
        assert found.convention == "on_node"
        assert values["element balance"] < 1e-6
        assert values["grid totals"] < 1e-6


def test_parts_of_elements_prove_no_sign(model):
    """Rows at some grids of an element do work of any sign; only whole elements count."""
    results = tee().results
    keep = np.isin(results.node, np.arange(30, 60)) | (results.element == 50)
    part = only(results, keep)
    found = rows(part, model)["sign"]
    assert found.light == "green"
    assert -1 < found.value < 0
    whole = only(results, np.isin(results.element, np.unique(part.element[part.element > 0])))
    assert abs(found.value) < abs(rows(whole, model)["sign"].value)


def test_generalised_mass_from_work(model):
    """Without masses the work over omega^2 is the mass, and its size no alarm."""
    results = replace(tee().results, modal_mass=np.full(5, np.nan))
    assert rows(results, model)["sign"].value == pytest.approx(-1)
    doubled = rows(replace(results, shape=2 * results.shape), model)["sign"]
    assert (doubled.light, doubled.value) == ("green", pytest.approx(-2))
    assert "the generalised mass, from -2 to -2" in doubled.finding


def test_rigid_modes_prove_no_sign(model):
    """Round-off of a rigid mode has works of both signs, whatever frequency round-off gives it."""
    results = tee().results
    noise = np.random.default_rng(1).normal(size=results.force[:1].shape)
    rigid = replace(
        results,
        force=np.concatenate([noise, results.force[1:]]),
        frequency=np.concatenate([[0.02], results.frequency[1:]]),
    )
    found = rows(rigid, model)["sign"]
    assert (found.light, found.value) == ("green", pytest.approx(-1))
    assert "in 4 modes" in found.finding
    assert rows(rigid, model)["element balance"].light == "red"
    still = replace(rigid, force=np.concatenate([1e-5 * noise, results.force[1:]]))
    assert rows(still, model)["element balance"].light == "green"
    slow = replace(rigid, frequency=np.concatenate([[1e-4], results.frequency[1:]]))
    assert rows(slow, model)["element balance"].light == "green"


def test_reactions_prove_the_sign_of_modes_without_shapes(model):
    """At a support the force on the elements is the reaction, in a mode as in a static case."""
    results = tee().results
    held = np.flatnonzero(tee().model.xyz[:, 0] < 1) + 1
    reaction = np.stack(
        [[-results.force[k][(results.node == n) & (results.element > 0)].sum(axis=0) for n in held] for k in range(5)]
    )
    with_reactions = replace(
        results,
        node=np.append(results.node, held),
        element=np.append(results.element, np.zeros(len(held), np.int64)),
        kind=np.append(results.kind, ["F-OF-SPC"] * len(held)),
        force=np.concatenate([results.force, reaction], axis=1),
        shape_node=np.empty(0, np.int64),
        shape=np.empty((5, 0, 6)),
    )
    found = audit(with_reactions, model)
    assert found.convention == "on_node"
    assert "no mode shapes" in next(row for row in found.rows if row.check == "sign").finding


def test_drilling_springs_tied_to_the_ground(tmp_path):
    """A shell out of balance by nothing but moments about its own normal is told as such; any other moment is red."""
    path = tmp_path / "patch.bdf"
    path.write_text(DECK)
    results, model = static_results(1), read_bdf(path)
    assert not audit(results, model).grounded_drilling
    for component, light in ((5, "amber"), (4, "red"), (0, "red")):
        force = results.force.copy()
        force[:, :4, component] += 30.0
        found = audit(replace(results, force=force), model)
        row = next(r for r in found.rows if r.check == "element balance")
        assert (row.light, found.grounded_drilling) == (light, component == 5)
        assert row.value > 0.1
        assert ("K6ROT" in row.remedy) == (component == 5)


@pytest.mark.parametrize("kind", ["HEXA", "TETRA", "RBE2", "RBE3", "RBAR"])
def test_solids_of_which_some_nodes_are_given_prove_nothing(model, kind):
    """Their rows do works of any sign and size, as those of a set of grids around welds."""
    results = tee().results
    nodes = np.array([20, 60, 100])
    extra = 1e3 * np.random.default_rng(2).normal(size=(5, 3, 6)) * np.abs(results.force).max()
    sound = rows(only(results, results.of_element), model)["sign"]
    part = only(results, results.of_element)
    mixed = replace(
        part,
        node=np.append(part.node, nodes),
        element=np.append(part.element, [9001] * 3),
        kind=np.append(part.kind, [kind] * 3),
        force=np.concatenate([part.force, extra], axis=1),
    )
    assert rows(mixed, model)["sign"] == sound
