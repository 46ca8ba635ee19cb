"""Meshes of Abaqus decks: what the language allows, and CalculiX as another reader of it."""

import shutil
import subprocess

import numpy as np
import pytest

from fatigue.errors import DataError
from fatigue.readers.foreign.read import read_model, recognise
from tests.readers.tee_model import tee

PLATE = """** by hand
*Heading
 a plate, and a wall
*NODE, NSET=ALL
 1, 0., 0., 0.
 2, 10., 0., 0.
 3, 10., 10., 0.
 4, 0., 10.
5, 0., 0., 1.0D1
6,10.,0.,10.
*Element, type=S4R, elset="the plate"
 7, 1, 2, 3,
 4
*ELEMENT, TYPE=S3,
 ELSET=wall
 8, 1, 2, 5
 9, 2, 6, 5
*Element, type=B31
 20, 1, 2
*Elset, elset=both
the plate, wall
*Shell Section, elset="the plate", material=steel, offset=SPOS
 8., 5
*SHELL SECTION,ELSET=WALL,MATERIAL=STEEL
6.
*Material, name=steel
*Elastic
210000., 0.3
"""


def deck(tmp_path, text, name="model.inp"):
    """A deck in a file."""
    (tmp_path / name).write_text(text)
    return tmp_path / name


def test_nodes_shells_and_sections(tmp_path):
    """Comments, blanks, capitals, continued lines, numbers left out; the offset is that of the mid-surface."""
    path = deck(tmp_path, PLATE)
    model = read_model(path)
    assert recognise(path).key == "inp"
    assert model.mesh.node.tolist() == [1, 2, 3, 4, 5, 6]
    np.testing.assert_array_equal(model.mesh.xyz[3:5], [[0, 10, 0], [0, 0, 10]])
    assert model.mesh.element.tolist() == [7, 8, 9]
    assert model.mesh.thickness.tolist() == [8.0, 6.0, 6.0]
    assert model.mesh.offset.tolist() == [-4.0, 0.0, 0.0]
    assert model.other_cards == {"B31": 1}
    assert not model.unconfirmed_sections


@pytest.mark.parametrize(
    ("old", "new", "reason"),
    [
        ("offset=SPOS\n 8., 5", "composite\n 2., 3, steel\n 4., 3, steel", "is a layered section"),
        ("material=steel, offset=SPOS", "material=steel, nodal thickness", "has a thickness that varies"),
        ("offset=SPOS", "offset=field", "has the offset FIELD, which is not read"),
        ('*Shell Section, elset="the plate", material=steel, offset=SPOS\n 8., 5\n', "", "gives it a thickness"),
    ],
)
def test_doubtful_thickness_wants_a_confirmation(tmp_path, old, new, reason):
    """Layers, fields, and elements of no section."""
    model = read_model(deck(tmp_path, PLATE.replace(old, new)))
    assert reason in next(iter(model.unconfirmed_sections.values()))


def test_solids_have_the_order_of_all_solvers(tmp_path):
    """Mid-side nodes between bottom and top stand before those of the top, which Abaqus lists first."""
    rows = "\n".join(f"{k}, {k}., 0., {k * k}." for k in range(1, 21))
    hexa = "*ELEMENT, TYPE=C3D20R\n1, 1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,\n16,17,18,19,20\n"
    wedge = "*ELEMENT, TYPE=C3D15\n2, 1,2,3,4,5,6,7,8,9,10,11,12,13,14,15\n"
    solids = read_model(deck(tmp_path, f"*NODE\n{rows}\n{hexa}{wedge}")).solids
    ids = [solids.node[row[row >= 0]].tolist() for row in (*solids.corner, *solids.mid)]
    assert ids[0] == list(range(1, 9))
    assert ids[2] == [9, 10, 11, 12, 17, 18, 19, 20, 13, 14, 15, 16]
    assert ids[3] == [7, 8, 9, 13, 14, 15, 10, 11, 12]


PARTS = """*Heading
*Part, name=Plate
*Node
1, 0., 0., 0.
2, 10., 0., 0.
3, 10., 5., 0.
4, 0., 5., 0.
*Element, type=S4
1, 1, 2, 3, 4
*Elset, elset=all, generate
1, 1, 1
*Shell Section, elset=all, material=m
4.
*End Part
*Assembly, name=A
*Instance, name=Plate-1, part=Plate
 1., 2., 3.
 1., 2., 3., 1., 2., 4., 90.
*End Instance
*End Assembly
"""


def test_an_instance_is_moved_and_turned(tmp_path):
    """First moved, then turned about the axis through two points."""
    model = read_model(deck(tmp_path, PARTS))
    np.testing.assert_allclose(model.mesh.xyz, [[1, 2, 3], [1, 12, 3], [-4, 12, 3], [-4, 2, 3]], atol=1e-12)
    assert model.mesh.thickness.tolist() == [4.0]


def test_includes_are_followed(tmp_path):
    """Beside the deck; one that is missing is refused by its line."""
    head, nodes, rest = PLATE.partition("*NODE")
    deck(tmp_path, nodes + rest, "mesh.inc")
    model = read_model(deck(tmp_path, head + "*INCLUDE, INPUT=mesh.inc\n"))
    assert len(model.mesh.element) == 3
    assert [path.name for path in model.included] == ["mesh.inc"]
    with pytest.raises(DataError, match=r"line 4: the included file other.inc is not beside"):
        read_model(deck(tmp_path, head + "*INCLUDE, INPUT=other.inc\n"))


def test_a_section_of_a_set_that_is_not_defined_is_told(tmp_path):
    """Elements whose head is lost are missing without a word else."""
    text = PLATE.replace('elset="the plate"', "elset=lost", 1)
    warned = read_model(deck(tmp_path, text)).warnings
    assert any(problem.code == "no_elset" and "line" in problem.where for problem in warned)
    assert not any(problem.code == "no_elset" for problem in read_model(deck(tmp_path, PLATE)).warnings)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (PLATE.replace("*Element, type=S4R", "*NGEN\n1, 9, 1\n*Element, type=S4R"), "*NGEN the first"),
        (PLATE.replace(" 2, 10., 0., 0.", " 2, 1o., 0., 0."), "'1o.' is no number"),
        (PLATE.replace(" 4\n", " 4.5\n"), "no id"),
        (PLATE.replace(" 9, 2, 6, 5", " 8, 2, 6, 5"), "element 8 is given twice"),
        (PLATE.replace(" 9, 2, 6, 5", " 9, 2, 6, 77"), "grid 77 does not exist"),
        (PLATE.replace(" 9, 2, 6, 5", " 9, 2, 6"), "has 2 nodes, 3 are due"),
        (PLATE.replace("NSET=ALL", "SYSTEM=C"), "a system 'C', which is not read"),
        (
            PARTS.replace("*End Assembly", "*Instance, name=P2, part=Plate\n*End Instance"),
            "two instances have the label 1",
        ),
        (PARTS.replace("part=Plate\n", "part=Wall\n"), "the part 'Wall', which is not defined"),
        ("*HEADING\n*NODE\n1, 0, 0, 0\n", "neither shell nor solid"),
    ],
)
def test_what_cannot_be_read_is_refused(tmp_path, text, said):
    """With its line and the way out."""
    with pytest.raises(DataError) as caught:
        read_model(deck(tmp_path, text))
    assert said in str(caught.value)


@pytest.mark.parametrize("text", ["*KEYWORD\n*NODE\n", "$ a deck\nGRID,1\n*NODE\n", "time,q_1\n*NODE\n"])
def test_other_texts_are_not_mistaken(tmp_path, text):
    """LS-DYNA, NASTRAN, a table."""
    path = deck(tmp_path, text)
    try:
        key = recognise(path).key
    except DataError:
        return
    assert key != "inp"


def tee_deck(case, kind="S4"):
    """The T joint as a deck, its base fixed at two edges, a load on top of the upright."""
    xyz, quads = case.model.xyz, case.model.quads
    rows = [f"{k}, {x:.6f}, {y:.6f}, {z:.6f}" for k, (x, y, z) in enumerate(xyz.tolist(), 1)]
    text = ["*HEADING", "*NODE, NSET=NALL", *rows]
    for name, t in (("base", 8.0), ("upright", 6.0)):
        text.append(f"*ELEMENT, TYPE={kind}, ELSET={name}")
        text += [
            f"{k + 1}, " + ", ".join(str(n + 1) for n in quads[k]) for k in np.flatnonzero(case.model.thickness == t)
        ]
        text += [f"*SHELL SECTION, ELSET={name}, MATERIAL=EL", f"{t}"]
    fixed = [str(k + 1) for k in np.flatnonzero((xyz[:, 0] < 1) | (xyz[:, 0] > 119))]
    text += ["*MATERIAL, NAME=EL", "*ELASTIC", f"{case.model.E}, {case.model.nu}", "*DENSITY", "2.7e-9"]
    text += ["*NSET, NSET=FIX", *[", ".join(fixed[k : k + 8]) for k in range(0, len(fixed), 8)]]
    return "\n".join(text) + "\n"


def test_calculix_reads_the_same_mesh(tmp_path):
    """Another program that reads the language: positions and connectivity of every shell, from its result file."""
    ccx = shutil.which("ccx")
    if ccx is None:
        pytest.skip("CalculiX (ccx) is not installed")
    case = tee()
    step = "*STEP\n*STATIC\n*BOUNDARY\nFIX, 1, 6\n*CLOAD\n{top}, 2, 100.\n*NODE FILE, OUTPUT=2D\nU\n*END STEP\n"
    top = int(case.model.xyz[:, 2].argmax()) + 1
    path = deck(tmp_path, tee_deck(case) + step.format(top=top))
    subprocess.run([ccx, "-i", "model"], cwd=tmp_path, check=True, capture_output=True, timeout=120)
    nodes, elements, displaced = frd(tmp_path / "model.frd")
    model = read_model(path)
    np.testing.assert_array_equal(model.mesh.node, sorted(nodes))
    np.testing.assert_allclose(model.mesh.xyz, [nodes[n] for n in model.mesh.node.tolist()], atol=1e-5)
    corners = {int(e): model.mesh.node[c].tolist() for e, c in zip(model.mesh.element, model.mesh.corner, strict=True)}
    assert corners == elements
    ours = static(case, top)
    theirs = np.array([displaced[n] for n in model.mesh.node.tolist()])
    assert np.abs(theirs[:, 1]).max() == pytest.approx(np.abs(ours[:, 1]).max(), rel=0.05)


def static(case, top):
    """Displacements of the shells of the tests under the same load."""
    xyz = case.model.xyz
    fixed = np.zeros((len(xyz), 6), bool)
    fixed[(xyz[:, 0] < 1) | (xyz[:, 0] > 119)] = True
    load = np.zeros((len(xyz), 6))
    load[top - 1, 1] = 100.0
    return case.model.solve(load, fixed)


def frd(path):
    """Nodes, elements and displacements of a CalculiX result file."""
    nodes, elements, displaced, block = {}, {}, {}, ""
    for line in path.read_text().splitlines():
        if line.startswith("    2C"):
            block = "nodes"
        elif line.startswith("    3C"):
            block = "elements"
        elif line.startswith(" -4  DISP"):
            block = "displaced"
        elif line.startswith((" -3", " -4")):
            block = ""
        elif line.startswith(" -1"):
            number = int(line[3:13])
            if block == "elements":
                current = number
            elif block:
                values = [float(line[13 + 12 * k : 25 + 12 * k]) for k in range(3)]
                (nodes if block == "nodes" else displaced)[number] = values
        elif line.startswith(" -2") and block == "elements":
            elements[current] = [int(word) for word in line[3:].split()]
    return nodes, elements, displaced
