"""Lines and register of one mesh, given for another: names, faces, curves and thicknesses go along."""

import csv

import numpy as np
import pytest

from fatigue.readers.convert.options import WeldSources
from fatigue.readers.convert.weld_lines import list_welds
from fatigue.readers.convert.written_lines.points import lines_text
from fatigue.weld.cuts import WeldCut
from fatigue.weld.line import WeldLine
from tests.command_line import fatigue as run
from tests.readers.convert.test_coordinate_lines import MESHES, UNEVEN, box, tee


def deck(mesh):
    """Bulk data of a model."""
    shells = mesh.mesh
    lines = ["BEGIN BULK", "PSHELL,1,1,8.,1,,1", "PSHELL,2,1,6.,1,,1"]
    lines += [
        f"GRID,{n},,{x:.6f},{y:.6f},{z:.6f}" for n, (x, y, z) in zip(shells.node, shells.xyz.tolist(), strict=True)
    ]
    for e, pid, corner in zip(shells.element, shells.pid, shells.corner, strict=True):
        nodes = shells.node[corner[corner >= 0]].tolist()
        lines.append(f"C{'QUAD4' if len(nodes) == 4 else 'TRIA3'},{e},{pid}," + ",".join(map(str, nodes)))
    return "\n".join([*lines, "ENDDATA", ""])


def rows_of(path):
    """Rows of a register as they stand in the file."""
    with path.open() as file:
        return list(csv.DictReader(file))


EDITS = {
    "surface": "top",
    "curve": "FAT100",
    "end_length_mm": "4",
    "thickness_mm": "7.5",
    "confirmed": "true",
    "description": "bracket, inner toe",
}
FINER = [tee(np.linspace(0, 120, 25), np.linspace(0, 80, 17), np.linspace(0, 40, 9), seed=11), MESHES["triangles"]]


@pytest.mark.parametrize("finer", [*FINER, tee(UNEVEN, np.linspace(0, 80, 9), np.linspace(0, 40, 4), seed=13)])
def test_the_edits_of_a_register_go_to_another_mesh(tmp_path, finer):
    """By the commands: found, edited, written as points, found again on a renumbered mesh, nothing lost."""
    (tmp_path / "first.bdf").write_text(deck(MESHES["coarse"]))
    (tmp_path / "second.bdf").write_text(deck(finer))
    register, lines, moved = (tmp_path / name for name in ("register.csv", "lines.csv", "by_lines.csv"))
    assert run("welds", tmp_path / "first.bdf", "-o", register).returncode == 0
    first = rows_of(register)
    (toe,) = (row for row in first if row["pid"] == "1" and row["line"].endswith("p1a"))
    (upright,) = (row for row in first if row["pid"] == "2")
    toe |= {"weld": "inner toe", **EDITS}
    upright |= {"status": "excluded", "reason": "throat is checked by hand"}
    with register.open("w", newline="") as file:
        writer = csv.DictWriter(file, first[0])
        writer.writeheader()
        writer.writerows(first)
    asked = ("--register", register, "--write-lines", lines, "-o", moved)
    told = run("welds", tmp_path / "first.bdf", *asked)
    assert told.returncode == 0
    assert "note" not in told.stderr
    told = run("welds", tmp_path / "second.bdf", "--lines", lines, "--register", moved, "-o", tmp_path / "second.csv")
    assert told.returncode == 0
    assert "note" not in told.stderr
    found = rows_of(tmp_path / "second.csv")
    assert len(found) == 3
    (same,) = (row for row in found if row["weld"] == "inner toe")
    assert {key: same[key] for key in EDITS} == EDITS
    (excluded,) = (row for row in found if row["status"] == "excluded")
    assert (excluded["pid"], excluded["reason"]) == ("2", "throat is checked by hand")
    assert all(row["line"].split(":")[0] == same["line"].split(":")[0] for row in found)


def test_the_side_is_the_same_plate_on_both_meshes(tmp_path):
    """What was the side towards -y on the first mesh is it on the second."""
    paths = []
    for number, mesh in enumerate((MESHES["coarse"], MESHES["fine"])):
        paths.append(tmp_path / f"{number}.bdf")
        paths[-1].write_text(deck(mesh))
    lines, moved = tmp_path / "lines.csv", tmp_path / "register.csv"
    first = list_welds(paths[0], WeldSources(), "mm-t-s", moved, False, lines)
    names = {row["line"]: row for row in rows_of(moved)}
    second = list_welds(paths[1], WeldSources(lines=lines, register=moved), "mm-t-s", None, False)
    assert set(second.cuts) == set(names)
    across = sorted(cut.line.outward.mean(axis=0).round(6).tolist() for cut in first.cuts.values())
    assert sorted(cut.line.outward.mean(axis=0).round(6).tolist() for cut in second.cuts.values()) == across


def test_closed_lines_move_as_well(tmp_path):
    """A box on a plate, twice as fine."""
    for name, mesh in (("a", box(3)), ("b", box(6, 4))):
        (tmp_path / f"{name}.bdf").write_text(deck(mesh))
    moved, lines = tmp_path / "register.csv", tmp_path / "lines.csv"
    first = list_welds(tmp_path / "a.bdf", WeldSources(), "mm-t-s", moved, False, lines)
    assert not first.warnings
    second = list_welds(tmp_path / "b.bdf", WeldSources(lines=lines, register=moved), "mm-t-s", None, False)
    assert not second.warnings
    assert {row.line for row in second.rows} == {row["line"] for row in rows_of(moved)}
    assert len(second.rows) == len([row for row in first.rows if row.status != "candidate"])


def cut_of(nodes, name, *, closed=False):
    """A cut of nodes on a circle of a hundred places, whose edges are a tenth long."""
    nodes = np.asarray(nodes)
    xyz = np.column_stack([np.cos(nodes / 3), np.sin(nodes / 3), 0.0 * nodes])
    size = nodes.size
    vectors = np.tile([0.0, 0.0, 1.0], (size, 1))
    no = np.zeros(size, bool)
    line = WeldLine(name, 1, np.arange(size), nodes, xyz, np.ones(size), vectors, vectors, no, closed, None)
    return WeldCut(name, "tee", (), 1, line, np.array([1]))


def points_of(text):
    """Lines of a table with their numbers of points."""
    names = [row.split(",")[0] for row in text.splitlines()[1:]]
    return {name: names.count(name) for name in names}


def test_sides_that_overlap_in_part_lose_no_edge():
    """What a side has beyond another is a line of its own."""
    text = lines_text([cut_of(range(10), "a_p1a"), cut_of(range(5, 14), "b_p2a")])
    assert set(points_of(text)) == {"a", "b"}
    b = [row.split(",") for row in text.splitlines() if row.startswith("b,")]
    np.testing.assert_allclose([float(b[0][2]), float(b[-1][2])], np.cos(np.array([9, 13]) / 3))
    ring = cut_of(range(12), "ring_p1a", closed=True)
    text = lines_text([cut_of(range(-6, 20), "long_p3a"), ring])
    assert set(points_of(text)) == {"long", "ring"}, "the edge that closes the ring"
    assert points_of(text)["ring"] == 2
