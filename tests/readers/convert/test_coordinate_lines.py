"""Weld lines as points in space: found on any mesh under the same names, and refused with the place where not."""

import numpy as np
import pytest

from fatigue.errors import DataError
from fatigue.readers.convert.options import WeldSources
from fatigue.readers.convert.weld_lines import find_welds
from fatigue.readers.convert.written_lines.points import lines_text
from fatigue.readers.foreign.fe.model import FeModel, Section, Shell, shell_mesh
from fatigue.readers.neutral.register.register_file import register_text
from fatigue.weld.along.named import named_along
from fatigue.weld.along.polyline import Polyline
from fatigue.weld.cuts import WeldCut
from fatigue.weld.line import WeldLine
from tests.shell_fe import grid, joined

HEAD = "line,point,x_mm,y_mm,z_mm\n"
BRACKET = HEAD + "bracket,1,30,40,0\nbracket,2,90,40,0\n"


def model(*parts, pids, seed=0, triangles=False, move=0.0):
    """Shells of plates joined where they meet, numbered at random."""
    rng = np.random.default_rng(seed)
    xyz, quads = joined(*parts)
    pid = np.repeat(pids, [len(part[1]) for part in parts])
    ids = rng.permutation(len(xyz)) + 1 if seed else np.arange(1, len(xyz) + 1)
    grids = {int(n): place for n, place in zip(ids, xyz + move, strict=True)}
    corners = [(tuple(ids[q].tolist()), int(p)) for q, p in zip(quads, pid, strict=True)]
    if triangles:
        corners = [(c, p) for q, p in corners for c in ((q[0], q[1], q[2]), (q[0], q[2], q[3]))]
    numbers = rng.permutation(len(corners)) + 1 if seed else np.arange(1, len(corners) + 1)
    shells = [Shell(int(e), p, c) for e, (c, p) in zip(numbers, corners, strict=True)]
    sections = {1: Section(8.0), 2: Section(6.0)}
    return FeModel("model", shell_mesh("model", grids, shells, sections), np.zeros(0, np.int64), np.zeros((0, 3, 3)))


def tee(x, y, z, **more):
    """A plate with an upright on it from x = 30 to 90 mm at y = 40 mm."""
    x = np.asarray(x, float)
    base = grid(x, y)
    xz, quads = grid(x[(x >= 30) & (x <= 90)], z)
    return model(base, (np.column_stack([xz[:, 0], np.full(len(xz), 40.0), xz[:, 1]]), quads), pids=(1, 2), **more)


UNEVEN = np.array([0, 12, 21, 30, 41, 50, 62, 71, 80, 90, 101, 111, 120.0])
MESHES = {
    "coarse": tee(np.linspace(0, 120, 13), np.linspace(0, 80, 9), np.linspace(0, 40, 5)),
    "fine": tee(np.linspace(0, 120, 49), np.linspace(0, 80, 33), np.linspace(0, 40, 17), seed=3),
    "uneven": tee(UNEVEN, np.linspace(0, 80, 9), np.linspace(0, 40, 4), seed=5),
    "triangles": tee(np.linspace(0, 120, 25), np.linspace(0, 80, 17), np.linspace(0, 40, 9), seed=7, triangles=True),
}


def found_on(mesh, tmp_path, text, **more):
    """Weld lines of a model by a table of points."""
    path = tmp_path / "lines.csv"
    path.write_text(text)
    return find_welds(mesh, WeldSources(lines=path, **more))


def refused(mesh, tmp_path, text):
    """The refusal of a table."""
    with pytest.raises(DataError) as caught:
        found_on(mesh, tmp_path, text)
    return caught.value.problems[0]


@pytest.mark.parametrize("name", MESHES)
def test_every_mesh_gives_the_same_welds(tmp_path, name):
    """Names, direction and sides are those of the line, however nodes, elements and edges are numbered."""
    found = found_on(MESHES[name], tmp_path, BRACKET)
    assert [row.line for row in found.rows] == ["bracket:p1a", "bracket:p1b", "bracket:p2a"]
    assert not found.warnings
    for cut in found.cuts.values():
        np.testing.assert_allclose(cut.line.xyz[[0, -1]], [[30, 40, 0], [90, 40, 0]])
        assert (np.diff(cut.line.xyz[:, 0]) > 0).all()
    across = [found.cuts[f"bracket:{side}"].line.outward.mean(axis=0) for side in ("p1a", "p1b", "p2a")]
    np.testing.assert_allclose(across, [[0, -1, 0], [0, 1, 0], [0, 0, -1]], atol=1e-12)


def test_a_register_survives_another_mesh(tmp_path):
    """Names, faces and a confirmed thickness of the first mesh hold on the second."""
    first = found_on(MESHES["coarse"], tmp_path, BRACKET)
    text = register_text(first.rows)
    text = text.replace("bracket:p1a,bracket:p1a,assess", "inner toe,bracket:p1a,assess")
    text = text.replace("bracket:p2a,bracket:p2a,assess,", "upright,bracket:p2a,excluded,bolted")
    (tmp_path / "register.csv").write_text(text)
    second = found_on(MESHES["fine"], tmp_path, BRACKET, register=tmp_path / "register.csv")
    rows = {row.line: row for row in second.rows}
    assert rows["bracket:p1a"].weld == "inner toe"
    assert (rows["bracket:p2a"].status, rows["bracket:p2a"].reason) == ("excluded", "bolted")
    assert second.cuts["bracket:p1a"].line.node.size == 25


def test_the_direction_of_the_points_is_that_of_the_weld(tmp_path):
    """The other way round the line runs back, and its sides keep their letters."""
    found = found_on(MESHES["fine"], tmp_path, HEAD + "bracket,1,90,40,0\nbracket,2,30,40,0\n")
    line = found.cuts["bracket:p1a"].line
    np.testing.assert_allclose(line.xyz[0], [90, 40, 0])
    np.testing.assert_allclose(line.outward.mean(axis=0), [0, -1, 0], atol=1e-12)


def test_points_beside_the_nodes_are_near_enough(tmp_path):
    """Within half an edge; the distance is told from a quarter on."""
    near = HEAD + "bracket,1,31,41,0.5\nbracket,2,60,39,0\nbracket,3,89,41,-0.5\n"
    found = found_on(MESHES["coarse"], tmp_path, near)
    assert found.cuts["bracket:p1a"].line.node.size == 7
    far = HEAD + "bracket,1,30,43,0\nbracket,2,90,43,0\n"
    assert [problem.code for problem in found_on(MESHES["coarse"], tmp_path, far).warnings] == ["line_off_mesh"]


def box(n, seed=0):
    """Four walls on a plate, with n edges each."""
    step = 30.0 / n
    base = grid(np.arange(0, 90 + step / 2, step), np.arange(0, 90 + step / 2, step))
    uv, quads = grid(np.linspace(30, 60, n + 1), np.linspace(0, 20, 3))
    u, z = uv[:, 0], uv[:, 1]
    sides = [(u, 0 * u + 30), (0 * u + 60, u), (u, 0 * u + 60), (0 * u + 30, u)]
    walls = [(np.column_stack([x, y, z]), quads) for x, y in sides]
    return model(base, *walls, pids=(1, 2, 2, 2, 2), seed=seed)


LOOP = (
    HEAD.strip()
    + ",closed\n"
    + "".join(f"ring,{k},{x},{y},0,true\n" for k, (x, y) in enumerate([(30, 30), (60, 30), (60, 60), (30, 60)], 1))
)


@pytest.mark.parametrize(("n", "seed"), [(3, 0), (6, 4), (10, 9)])
def test_a_closed_line_goes_all_the_way_round(tmp_path, n, seed):
    """From its first point; the plate inside and outside are two sides, the walls one that turns with them."""
    found = found_on(box(n, seed), tmp_path, LOOP)
    rings = [cut for cut in found.cuts.values() if cut.pid == 1]
    assert [cut.name for cut in rings] == ["ring:p1a", "ring:p1b"]
    for cut in rings:
        assert cut.line.closed
        assert cut.line.node.size == 4 * n
        np.testing.assert_allclose(cut.line.xyz[0], [30, 30, 0])


def test_written_lines_find_the_same_welds(tmp_path):
    """Corners and ends are enough; on the mesh they were written for every node comes back."""
    for mesh in (MESHES["uneven"], box(6, 4)):
        first = find_welds(mesh, WeldSources())
        text = lines_text(cut for _, cut in first.assessed())
        second = found_on(mesh, tmp_path, text)
        nodes = [sorted(sorted(cut.line.node.tolist()) for _, cut in some.assessed()) for some in (first, second)]
        assert nodes[0] == nodes[1]
        assert len(text.splitlines()) < 8
        assert lines_text(second.cuts.values()).count("\n") == text.count("\n")


@pytest.mark.parametrize(
    ("text", "code", "said"),
    [
        (HEAD + "a,1,30,40,0\na,2,60,52,0\n", "no_edges_along", "no mesh edges follow it from"),
        (HEAD + "a,1,30,40,300\na,2,90,40,300\n", "no_edges_along", "the nearest node is 260 mm away"),
        (HEAD + "a,1,0.03,0.04,0\na,2,0.09,0.04,0\n", "no_edges_along", "in mm"),
        (HEAD + "a,1,30,40,0\na,2,1090,40,0\n", "no_edges_along", "(120, 40, 0) mm on, 90 mm along it, for 970 mm"),
        (HEAD + "a,1,30,40,0\na,2,90,40,0\na,3,60,40,0\n", "line_turns_back", "twice. Number its points"),
        (HEAD + "a,1,30,40,0\n", "short_line", "1 point"),
        (HEAD + "a,1,30,40,0\na,2,30,40,0\n", "short_line", "that differ"),
        (HEAD + "a,1,30,40,0\na,1,90,40,0\n", "duplicate_row", "a"),
        (BRACKET + "other,1,50,40,0\nother,2,70,40,0\n", "edge_twice", "belongs to the line bracket, too"),
    ],
)
def test_what_fits_no_mesh_is_refused_by_its_place(tmp_path, text, code, said):
    """A weld never vanishes silently."""
    problem = refused(MESHES["coarse"], tmp_path, text)
    assert said in str(problem)
    assert code in (problem.code, "duplicate_row")


def test_nodes_that_are_not_merged_are_told(tmp_path):
    """Two parts that lie side by side are not joined: the line breaks off there."""
    left, right = (
        grid(np.linspace(0, 60, 7), np.linspace(0, 40, 5)),
        grid(np.linspace(60, 120, 7), np.linspace(0, 40, 5)),
    )
    xyz = np.concatenate([left[0], right[0]])
    quads = np.concatenate([left[1], right[1] + len(left[0])])
    grids = {k + 1: place for k, place in enumerate(xyz)}
    shells = [Shell(k + 1, 1, tuple((q + 1).tolist())) for k, q in enumerate(quads)]
    mesh = shell_mesh("model", grids, shells, {1: Section(8.0)})
    apart = FeModel("model", mesh, np.zeros(0, np.int64), np.zeros((0, 3, 3)))
    problem = refused(apart, tmp_path, HEAD + "seam,1,0,20,0\nseam,2,120,20,0\n")
    assert "(60, 20, 0)" in problem.what
    assert "1 other nodes lie where the edges end" in problem.what
    assert problem.remedy == "Merge the nodes that coincide"


def test_an_end_beyond_the_mesh_is_told(tmp_path):
    """The line is as long as the mesh, and a note says by how much it is shorter than its points."""
    found = found_on(MESHES["fine"], tmp_path, HEAD + "bracket,1,30,40,0\nbracket,2,124,40,0\n")
    assert [problem.code for problem in found.warnings] == ["line_end_off"]


@pytest.mark.parametrize("shift", [0.0, 5.0, 10.0, 13.0, 17.0])
def test_a_plate_close_by_draws_no_line_to_it(tmp_path, shift):
    """The way stays on the plate that the points lie on, wherever the nodes of the other are."""
    lower = grid(np.linspace(0, 120, 7), np.linspace(0, 80, 5))
    xy, quads = grid(np.linspace(0, 120, 7) + shift, np.linspace(0, 80, 5))
    xy = np.column_stack([xy[:, :2], np.full(len(xy), 4.0)])
    found = found_on(model(lower, (xy, quads), pids=(1, 2)), tmp_path, HEAD + "a,1,0,40,0\na,2,95,40,0\n")
    assert {cut.pid for cut in found.cuts.values()} == {1}
    np.testing.assert_allclose(found.cuts["a:p1a"].line.xyz[:, 2], 0.0)


def test_edges_that_turn_where_the_line_does_not_are_told(tmp_path):
    """As where points run from one row of nodes to the next."""
    text = HEAD.strip() + ",tolerance_mm\na,1,0,40,0,6\na,2,120,50,0,6\n"
    (problem,) = (one for one in found_on(MESHES["coarse"], tmp_path, text).warnings if one.code == "line_turns")
    assert "turn by 90 deg at node" in problem.what


def test_a_seam_of_nodes_that_are_not_merged_is_told(tmp_path):
    """Only one of the plates there has the line."""
    left = grid(np.linspace(0, 60, 7), np.linspace(0, 40, 5))
    right = grid(np.linspace(60, 120, 7), np.linspace(0, 40, 5))
    quads = np.concatenate([left[1], right[1] + len(left[0])])
    grids = {k + 1: place for k, place in enumerate(np.concatenate([left[0], right[0]]))}
    shells = [Shell(k + 1, 1, tuple((q + 1).tolist())) for k, q in enumerate(quads)]
    mesh = shell_mesh("model", grids, shells, {1: Section(8.0)})
    apart = FeModel("model", mesh, np.zeros(0, np.int64), np.zeros((0, 3, 3)))
    (problem,) = found_on(apart, tmp_path, HEAD + "seam,1,60,0,0\nseam,2,60,40,0\n").warnings
    assert problem.code == "nodes_apart"
    assert problem.what.startswith("at 5 of its nodes lie others that are not merged")


@pytest.mark.parametrize("seed", [0, 3, 5, 8])
def test_the_name_has_the_property_where_the_line_begins(tmp_path, seed):
    """A plate that goes on with another property is one side, however the nodes are numbered."""
    rows = np.linspace(0, 40, 5)
    parts = grid(np.linspace(0, 50, 6), rows), grid(np.linspace(50, 100, 6), rows)
    found = found_on(model(*parts, pids=(1, 2), seed=seed), tmp_path, HEAD + "a,1,0,20,0\na,2,100,20,0\n")
    assert [row.line for row in found.rows] == ["a:p1a", "a:p1b"]
    back = found_on(model(*parts, pids=(1, 2), seed=seed), tmp_path, HEAD + "a,1,100,20,0\na,2,0,20,0\n")
    assert [row.line for row in back.rows] == ["a:p2a", "a:p2b"]


@pytest.mark.parametrize("lean_deg", [0.0, 2.9, 45.0, 87.1, 90.0, 92.9, 135.0, 178.0])
def test_letters_of_sides_do_not_change_with_small_turns(tmp_path, lean_deg):
    """A side that a mesh sees turned by a degree keeps its letter."""
    ahead = np.array([np.cos(np.radians(lean_deg)), np.sin(np.radians(lean_deg)), 0.0])
    line = Polyline(np.array([0.0 * ahead, 100.0 * ahead]))
    firsts = set()
    for turn, roll in np.radians([(x, y) for x in (-5, 0, 5) for y in (-5, 0, 5)]):
        level = np.array([-np.sin(np.radians(lean_deg) + turn), np.cos(np.radians(lean_deg) + turn), 0.0])
        across = np.cos(roll) * level + np.sin(roll) * np.array([0.0, 0.0, 1.0])
        sides = named_along([side_of(line, s * across) for s in (1, -1)], line, "a", MESHES["coarse"].mesh)
        firsts.add(bool(min(sides, key=lambda cut: cut.name).line.outward[0] @ across > 0))
    assert len(firsts) == 1


def side_of(line, across):
    """A cut of a polyline that lies in a direction across it."""
    two = np.repeat(np.asarray(across)[None], 2, axis=0)
    own = WeldLine(
        "", 1, np.array([1, 2]), np.array([1, 2]), line.points, np.ones(2), two, -two, np.zeros(2, bool), False, None
    )
    return WeldCut("", "a", (), 1, own, np.array([1]))
