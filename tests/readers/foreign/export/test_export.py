"""The text that the Abaqus script writes, from a stand-in of an output database, read and converted."""

import ast
import importlib.util
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
import pytest

from fatigue.errors import DataError
from fatigue.readers.convert.convert import convert
from fatigue.readers.convert.options import ConvertOptions
from fatigue.readers.foreign.read import read_forces, read_model, recognise
from tests.command_line import fatigue
from tests.readers.foreign.export.odb_stand_in import (
    assign,
    database,
    frame,
    frequency_step,
    instance,
    static_step,
    tee_database,
)
from tests.readers.op2_writer import modal_op2
from tests.readers.tee_model import bulk, tee

SCRIPT = Path("data/requests/abaqus_export.py")


@pytest.fixture(scope="module")
def script():
    """The script itself, imported."""
    spec = importlib.util.spec_from_file_location("abaqus_export", SCRIPT)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def text(script, tmp_path_factory):
    """Export of the T joint."""
    path = tmp_path_factory.mktemp("abaqus") / "tee.txt"
    assert script.export(tee_database(tee()), str(path), None, "2023") == []
    return path


def test_the_script_is_python_2_and_3():
    """No syntax that the older interpreter of Abaqus lacks: f-strings, annotations, keyword-only arguments."""
    tree = ast.parse(SCRIPT.read_text(), feature_version=(3, 4))
    newer = (
        ast.JoinedStr,
        ast.AnnAssign,
        ast.NamedExpr,
        ast.Nonlocal,
        ast.Starred,
        ast.YieldFrom,
        ast.AsyncFunctionDef,
    )
    assert not [node for node in ast.walk(tree) if isinstance(node, newer)]
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef):
            assert not node.args.kwonlyargs
            assert node.returns is None


def test_forces_shapes_and_frequencies_come_back(text):
    """In the sign of Abaqus, which is that of the force on the node."""
    case, found = tee(), read_forces(text, None)
    assert recognise(text).key == "export"
    assert found.solver == "Abaqus 2023"
    np.testing.assert_allclose(found.frequency, case.frequency, rtol=1e-8)
    np.testing.assert_array_equal(found.modal_mass, np.ones(5))
    np.testing.assert_allclose(found.shape, case.shape, rtol=1e-8, atol=1e-14)
    order = np.lexsort((found.node, found.element))
    own = np.lexsort(((case.model.quads + 1).ravel(), np.repeat(np.arange(len(case.model.quads)), 4)))
    scale = np.abs(case.element_force).max()
    np.testing.assert_allclose(found.force[:, order], -case.element_force.reshape(5, -1, 6)[:, own], atol=1e-8 * scale)
    assert set(found.kind.tolist()) == {"QUAD4"}


def test_the_mesh_comes_back(text):
    """Places, corners and thicknesses by section."""
    case, model = tee(), read_model(text)
    np.testing.assert_allclose(model.mesh.xyz, case.model.xyz, atol=1e-7)
    np.testing.assert_array_equal(model.mesh.corner, case.model.quads)
    np.testing.assert_array_equal(model.mesh.thickness, case.model.thickness)
    assert not model.unconfirmed_sections


def converted(tmp_path, name, **files):
    """A converted folder."""
    time = np.arange(200) / 100
    q = pq_rows(time)
    (tmp_path / "q.csv").write_text(q)
    options = ConvertOptions(out=tmp_path / name, coordinates=(tmp_path / "q.csv",), interface_modes=(5,), **files)
    return convert(options)


def pq_rows(time):
    """A history of five modes."""
    rows = [f"{t:.9g}," + ",".join(f"{np.sin((k + 1) * t):.9g}" for k in range(5)) for t in time]
    return "\n".join(["time," + ",".join(f"q_{k}" for k in range(1, 6)), *rows]) + "\n"


def test_the_whole_way_gives_what_nastran_gives(text, tmp_path):
    """The same welds and forces from the text as from OP2 and deck; sign, balance and work are proved green."""
    case = tee()
    (tmp_path / "tee.bdf").write_text(bulk(case))
    (tmp_path / "tee.op2").write_bytes(modal_op2(case.results, word=8))
    theirs = converted(tmp_path, "nastran", forces=tmp_path / "tee.op2", mesh=tmp_path / "tee.bdf")
    ours = converted(tmp_path, "abaqus", forces=text, mesh=text)
    assert [row.line for row in ours.welds] == [row.line for row in theirs.welds]
    lights = {row.check: row.light for row in ours.audit.rows}
    assert "red" not in lights.values()
    tables = [pq.read_table(tmp_path / name / "element_forces.parquet").to_pandas() for name in ("abaqus", "nastran")]
    keys = ["mode", "element", "node"]
    ours_rows, their_rows = (table.sort_values(keys).reset_index(drop=True) for table in tables)
    assert ours_rows[keys].equals(their_rows[keys])
    columns = [name for name in ours_rows if name not in keys]
    scale = np.abs(their_rows[columns].to_numpy()).max()
    np.testing.assert_allclose(ours_rows[columns], their_rows[columns], atol=1e-6 * scale)


def test_static_steps_stand_beside_the_modes(script, tmp_path):
    """By the name of the step; one without NFORC is left out and told."""
    case = tee()
    odb = tee_database(case, pressure=(case.shape[0], case.element_force[0]))
    bare = static_step(frame(odb.rootAssembly.instances["TEE-1"], case.shape[1], case.element_force[1], []), "bare")
    bare.frames[0].fieldOutputs.pop("NFORC1")
    odb.steps["bare"] = bare
    told = script.export(odb, str(tmp_path / "tee.txt"))
    assert told == ["step pressure is static case 1001", "step bare has no NFORC and is left out"]
    found = read_forces(tmp_path / "tee.txt", None, loads=None)
    assert found.static_modes == (1001,)
    np.testing.assert_allclose(found.force[found.mode == 1001][0], found.force[0], rtol=1e-8)
    assert found.static_cases[0].heading.subtitle == "pressure"


def test_only_the_elements_of_a_set(script, tmp_path):
    """As a weld set of the assembly; another name is refused with those that are there."""
    from types import SimpleNamespace as Is  # noqa: PLC0415

    odb = tee_database(tee())
    odb.rootAssembly.elementSets["WELDS"] = Is(elements=[odb.rootAssembly.instances["TEE-1"].elements[:10]])
    script.export(odb, str(tmp_path / "tee.txt"), "WELDS")
    assert sorted(set(read_forces(tmp_path / "tee.txt", None).element.tolist())) == list(range(1, 11))
    with pytest.raises(SystemExit, match="there is no element set NONE; sets: WELDS"):
        script.export(odb, str(tmp_path / "other.txt"), "NONE")


def test_instances_are_told_apart(script, tmp_path):
    """Equal labels of two instances are shifted, in mesh and forces alike, and the shift is told."""
    from types import SimpleNamespace as Is  # noqa: PLC0415

    square = np.array([[0.0, 0, 0], [10, 0, 0], [10, 10, 0], [0, 10, 0]])
    quads = np.array([[0, 1, 2, 3]])
    pair = [instance("A-1", square, quads), instance("B-1", square + np.array([10.0, 0, 0]), quads)]
    for own in pair:
        assign(own, "plate", [0], offsetType="TOP_SURFACE")
    force = np.arange(24.0).reshape(1, 4, 6)
    frames = [frame(own, np.ones((4, 6)), force, quads, mode=1, frequency=9.0) for own in pair]
    both = frames[0]
    for name, output in frames[1].fieldOutputs.items():
        both.fieldOutputs[name].values.extend(output.values)
    odb = database(pair, {"plate": Is(thickness=5.0)}, [frequency_step([both])])
    told = script.export(odb, str(tmp_path / "two.txt"))
    assert "labels of the instance B-1 are shifted by 10" in told
    model = read_model(tmp_path / "two.txt")
    assert model.mesh.node.tolist() == [1, 2, 3, 4, 11, 12, 13, 14]
    assert model.mesh.element.tolist() == [1, 11]
    assert model.mesh.offset.tolist() == [-2.5, -2.5]  # nodes on the top: the mid-surface lies below
    assert sorted(set(read_forces(tmp_path / "two.txt", None).element.tolist())) == [1, 11]


def test_layered_sections_want_a_confirmation(script, tmp_path):
    """Their thickness is the sum of the layers."""
    from types import SimpleNamespace as Is  # noqa: PLC0415

    odb = tee_database(tee())
    odb.sections["upright"] = Is(layup=[Is(thickness=2.0), Is(thickness=4.0)])
    script.export(odb, str(tmp_path / "tee.txt"))
    model = read_model(tmp_path / "tee.txt")
    assert model.unconfirmed_sections == {2: "section 2 is a layered section"}
    assert model.mesh.thickness[-1] == 6.0


def test_missing_masses_are_told(script, tmp_path):
    """They matter where modes are normalised to displacement."""
    told = script.export(tee_database(tee(), masses=False), str(tmp_path / "tee.txt"))
    assert told == ["no generalised masses (GM): they count where modes are not normalised to mass"]
    assert np.isnan(read_forces(tmp_path / "tee.txt", None).modal_mass).all()


def damaged(text, tmp_path, change):
    """The refusal of a changed text."""
    whole = text.read_text()
    (tmp_path / "bad.txt").write_text(change(whole))
    with pytest.raises(DataError) as caught:
        read_forces(tmp_path / "bad.txt", None)
    return caught.value.problems[0]


def in_forces(text, old, new):
    """Change the forces of the first mode."""
    at = text.index("*forces")
    return text[:at] + text[at:].replace(old, new, 1)


@pytest.mark.parametrize(
    ("change", "code", "said"),
    [
        (lambda text: text.replace("export 1", "export 2", 1), "other_version", "version 2, and 1 is read"),
        (lambda text: text.replace("*end\n", ""), "cut", "ends without *end"),
        (
            lambda text: text[: text.rindex("\n", 0, len(text) // 2) + 1],
            "export_damaged",
            "a block of 480 rows ends behind",
        ),
        (lambda text: text[: text.index("*mode")], "cut", "ends without *end"),
        (lambda text: text.replace("*mode 3 1\n", "*mode 3 2\n", 1), "export_damaged", "no number"),
        (lambda text: in_forces(text, "e-", "x-"), "export_damaged", "no number"),
        (
            lambda text: in_forces(
                text,
                " ",
                "",
            ),
            "export_damaged",
            "head of a block",
        ),
        (lambda text: in_forces(text, "\n1 ", "\n0 "), "export_damaged", "0 is no id"),
        (
            lambda text: in_forces(text, "\n1 ", "\n99999 "),
            "export_damaged",
            "element 99999 has forces and is",
        ),
        (lambda text: in_forces(text, "\n1 ", "\n1 1 "), "export_damaged", "9 numbers stand in a row of 8"),
        (lambda text: text.replace("*shape", "*sahpe", 1), "export_damaged", "*sahpe is no block"),
        (lambda text: text.replace("*elements 6", "*elements 5", 1), "export_damaged", "6 numbers stand in a row of 5"),
    ],
)
def test_a_damaged_text_is_refused_with_its_line(text, tmp_path, change, code, said):
    """Cut anywhere, another version, a row that is not whole."""
    problem = damaged(text, tmp_path, change)
    assert said in problem.what
    assert problem.code == code
    assert "line" in problem.where


def test_the_script_reaches_its_user(tmp_path):
    """On the terminal, or as a file, which is not overwritten unasked."""
    out = tmp_path / "abaqus_export.py"
    assert fatigue("request", "abaqus", "-o", out).returncode == 0
    assert out.read_bytes() == SCRIPT.read_bytes()
    assert fatigue("request", "abaqus", "-o", out).returncode == 3
    for solver, word in (("ansys", "FORCE,STATIC"), ("nastran", "GPFORCE")):
        assert word in fatigue("request", solver).stdout
