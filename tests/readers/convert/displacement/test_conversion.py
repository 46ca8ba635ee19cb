"""A displacement through `convert`: OP2 with mode shapes and displacement frames, units, events, refusals."""

import json
from dataclasses import replace

import numpy as np
import pytest

from fatigue.errors import CaseError, DataError
from fatigue.readers.convert.convert import convert
from fatigue.readers.convert.options import ConvertOptions, Displacement
from tests.command_line import fatigue
from tests.readers.convert.displacement.modal_records import resonances
from tests.readers.op2_writer import modal_op2
from tests.readers.tee_model import bulk, tee

AXES = "xyz"
NODE = 109  # all modes move it in z


def table(path, time, values, names):
    """Write a CSV of times and values (c, t)."""
    rows = [",".join(f"{x:.9g}" for x in (t, *values[:, k])) for k, t in enumerate(time)]
    path.write_text("\n".join([",".join(["time_s", *names]), *rows]) + "\n")
    return path


def moving(direction):
    """The grid with a displacement frame that moves most in a direction."""
    turned = tee().turned
    return int(turned[np.abs(tee().shape[:, turned - 1, AXES.index(direction)]).sum(axis=0).argmax()])


@pytest.fixture
def simulated(tmp_path):
    """The T joint, five modes in a simulation, and a function that writes the displacement of a node."""
    case = tee()
    (tmp_path / "tee.bdf").write_text(bulk(case))
    (tmp_path / "tee.op2").write_bytes(modal_op2(case.results, word=8))
    modes = resonances(modes=5, samples=1000)
    modes = replace(modes, q=modes.q / np.abs(case.shape[:, NODE - 1, 2, None]))
    coordinates = table(tmp_path / "run.csv", modes.time, modes.q, [f"q_{k}" for k in range(1, 6)])
    options = ConvertOptions(
        forces=tmp_path / "tee.op2",
        mesh=tmp_path / "tee.bdf",
        out=tmp_path / "body",
        coordinates=(coordinates,),
        interface_modes=(5,),
    )

    def displacement(node, direction, name="displacement_mm", change=lambda weight: weight, factor=1.0):
        weight = change(case.shape[:, node - 1, AXES.index(direction)].copy())
        file = table(tmp_path / f"u_{node}_{direction}.csv", modes.time, factor * (weight @ modes.q)[None], [name])
        return Displacement(file, node, direction)

    return options, displacement


def row(options):
    """The row of the audit that compares displacements."""
    return next(row for row in convert(options).audit.rows if row.check == "displacement")


@pytest.mark.parametrize("direction", AXES)
def test_a_right_displacement_is_green(simulated, direction):
    """Basic axes, also at a grid whose mode shapes are in a displacement frame turned by 90 degrees."""
    options, displacement = simulated
    node = moving(direction)
    found = row(replace(options, displacements=(displacement(node, direction),)))
    assert found.light == "green"
    assert found.value < 1e-4
    assert f"u_{node}_{direction}.csv, node {node} {direction}" in found.finding


def test_it_stands_in_the_record_of_the_conversion(simulated):
    """With its number, and the hash of its file."""
    options, displacement = simulated
    asked = displacement(NODE, "z")
    convert(replace(options, displacements=(asked, replace(asked, direction="z"))))
    record = json.loads((options.out / "convert.json").read_text())
    assert [r["light"] for r in record["audit"] if r["check"] == "displacement"] == ["green", "green"]
    assert str(asked.file) in record["inputs"]


def flip_two(weight):
    """Change the sign of mode 2."""
    weight[1] *= -1
    return weight


@pytest.mark.parametrize(
    ("change", "factor", "words"),
    [
        (flip_two, 1.0, "the sign of mode 2 is opposite"),
        (lambda w: w, 1e-3, "0.001 times the sum: metres against millimetres"),
        (lambda w: -w, 1.0, "the sign of the direction, or of all modes, is opposite"),
    ],
)
def test_a_wrong_one_stops_the_conversion(simulated, change, factor, words):
    """Red: nothing is written, unless it is accepted."""
    options, displacement = simulated
    node = NODE
    wrong = replace(options, displacements=(displacement(node, "z", change=change, factor=factor),))
    with pytest.raises(DataError, match=words) as caught:
        convert(wrong)
    assert "tee.op2, displacement" in str(caught.value)
    assert not options.out.exists()
    assert convert(replace(wrong, accept=("displacement",))).audit.red


def test_units_of_all_files_count(simulated, tmp_path):
    """FE files in m and kg, coordinates in m and kg, the displacement in m: green; with one unit forgotten, red."""
    options, displacement = simulated
    unit = np.sqrt(1e-3) * 1000
    ours = tee().results
    metric = replace(
        ours,
        force=ours.force * unit * np.array([1.0] * 3 + [1e-3] * 3),
        shape=ours.shape * unit * np.array([1e-3] * 3 + [1.0] * 3),
    )
    (tmp_path / "tee.op2").write_bytes(modal_op2(metric, word=8))
    lines = []
    for line in options.mesh.read_text().splitlines():
        cells = line.split(",")
        if cells[0] == "GRID":
            cells[3:6] = [f"{float(c) / 1000:.9f}" for c in cells[3:6]]
        if cells[0] == "PSHELL":
            cells[3] = f"{float(cells[3]) / 1000:.6f}"
        lines.append(",".join(cells))
    options.mesh.write_text("\n".join(lines))
    node = NODE
    # one unit of a coordinate in m and kg is sqrt(1000) of one in mm and t
    metres = displacement(node, "z", name="u", factor=unit * 1e-3)
    both = replace(options, force_units="m-kg-s", coordinate_units="m-kg-s", displacements=(metres,))
    assert row(both).light == "green"
    with pytest.raises(DataError, match="modes of unit mass in kilograms against tonnes"):
        convert(replace(both, coordinate_units="mm-t-s", displacements=(displacement(node, "z", factor=unit),)))


def test_masses_of_the_simulation_count(simulated, tmp_path):
    """The scale that the case gives to the forces of a mode is on its shape as well."""
    options, displacement = simulated
    masses = tmp_path / "modes.csv"
    masses.write_text(
        "mode,frequency_hz,modal_mass\n" + "".join(f"{k + 1},{f:.9g},4\n" for k, f in enumerate(tee().frequency))
    )
    asked = displacement(NODE, "z", factor=2.0)
    assert row(replace(options, displacements=(asked,), simulation_modes=masses)).light == "green"
    with pytest.raises(DataError, match="2 times the sum"):
        convert(replace(options, displacements=(asked,)))


def test_of_several_events_the_one_that_fits_is_named(simulated, tmp_path):
    """The displacement belongs to one of them."""
    options, displacement = simulated
    other = resonances(modes=5, samples=1000, seed=5)
    second = table(tmp_path / "other.csv", other.time, other.q, [f"q_{k}" for k in range(1, 6)])
    asked = displacement(NODE, "z")
    found = row(replace(options, coordinates=(second, *options.coordinates), displacements=(asked,)))
    assert found.light == "green"
    assert "of run.csv" in found.finding


def test_without_mode_shapes_it_says_so(simulated):
    """Amber, and what to request."""
    options, displacement = simulated
    bare = replace(tee().results, shape_node=np.empty(0, np.int64), shape=np.empty((5, 0, 6)))
    options.forces.write_bytes(modal_op2(bare, word=8))
    found = row(replace(options, convention="on_node", displacements=(displacement(NODE, "z"),)))
    assert found.light == "amber"
    assert "holds no mode shapes" in found.finding
    assert "Request DISPLACEMENT" in found.remedy


def test_a_mode_without_displacements_is_no_wrong_sum(simulated):
    """Unit loads whose displacements were not requested: nothing is compared."""
    options, displacement = simulated
    shape = tee().results.shape * np.array([1, 1, 1, 1, 0])[:, None, None]
    options.forces.write_bytes(modal_op2(replace(tee().results, shape=shape), word=8))
    found = row(replace(options, displacements=(displacement(NODE, "z"),)))
    assert found.light == "amber"
    assert "1 modes with coordinates have no displacements in the force file, mode 5 the first" in found.finding


def test_what_cannot_be_compared_is_refused(simulated):
    """A node that does not exist, no coordinates."""
    options, displacement = simulated
    asked = displacement(NODE, "z")
    with pytest.raises(DataError, match="node 99999 z: the node does not exist; 145 grids from 1 to 145"):
        convert(replace(options, displacements=(replace(asked, node=99999),)))
    with pytest.raises(CaseError, match="Give --coordinates"):
        convert(replace(options, coordinates=(), displacements=(asked,)))


def test_on_the_command_line(simulated):
    """FILE NODE DIRECTION, as often as wanted; the row is printed with the others."""
    options, displacement = simulated
    node = NODE
    first, second = displacement(node, "z"), displacement(node, "x")
    common = ["convert", "--mesh", options.mesh, "--forces", options.forces, "--coordinates", options.coordinates[0]]
    done = fatigue(
        *common, "--displacement", first.file, node, "z", "--displacement", second.file, node, "x", "-o", options.out
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("green  displacement:") == 2
    flipped = displacement(node, "z", change=flip_two)
    done = fatigue(*common, "--displacement", flipped.file, node, "z", "-o", options.out)
    assert done.returncode == 3
    assert "likely cause: the sign of mode 2 is opposite" in done.stderr
    assert fatigue(*common, "--displacement", first.file, node, "up", "-o", options.out).returncode == 2


@pytest.mark.parametrize("node", [60, 61, 110])
def test_the_displacement_of_another_node(simulated, node):
    """Factors that a fit gives every mode are no cause where a node explains the displacement."""
    options, displacement = simulated
    asked = replace(displacement(node, "z"), node=NODE)
    found = row(replace(options, displacements=(asked,), accept=("displacement",)))
    assert found.light == "red"
    assert f"likely cause: it is the displacement of node {node} (error then" in found.finding


def test_a_node_that_does_not_move(simulated):
    """The node that moves so is named, where no mode moves the one that is asked."""
    options, displacement = simulated
    asked = replace(displacement(NODE, "z"), node=1)
    found = row(replace(options, displacements=(asked,), accept=("displacement",)))
    assert f"likely cause: it is the displacement of node {NODE}" in found.finding
