"""Weld edges, lines and plate sides found in meshes: real ones, and small ones where every answer is plain."""

from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fatigue.readers.foreign.nastran.deck.bdf import read_bdf
from fatigue.weld.cuts import trace
from fatigue.weld.detection import WELDS, classify, stacked_elements, topology
from fatigue.weld.line_check import check_line
from fatigue.weld.line_geometry import corners, split_at_kinks
from fatigue.weld.mesh import ShellMesh
from tests.shell_fe import grid, joined

CARBODY = Path("data/carbody")


def shell_mesh(xyz, quads, pid, mid=None):
    """A mesh with ids from 1."""
    elements = len(quads)
    return ShellMesh(
        np.arange(1, len(xyz) + 1),
        np.asarray(xyz, float),
        np.arange(1, elements + 1),
        np.asarray(quads),
        np.full((elements, 4), -1) if mid is None else mid,
        np.asarray(pid),
        np.full(elements, 5.0),
        np.zeros(elements),
    )


def plate(axes, u, v, at=0.0):
    """Nodes and quads of a flat plate in the plane of two axes."""
    flat, quads = grid(np.asarray(u, float), np.asarray(v, float))
    xyz = np.full((len(flat), 3), float(at))
    xyz[:, list(axes)] = flat[:, :2]
    return xyz, quads


def assembly(*plates):
    """Join plates; each has its own property, from 1."""
    xyz, quads = joined(*plates)
    pid = np.concatenate([np.full(len(p[1]), k) for k, p in enumerate(plates, start=1)])
    return shell_mesh(xyz, quads, pid)


def welds(mesh, kinds=WELDS):
    """All cuts of the given kinds."""
    topo = topology(mesh)
    return trace(topo, {edge: key for edge, key in classify(topo).items() if key[0] in kinds})


TEE = (plate((0, 1), range(0, 90, 10), range(-30, 40, 10)), plate((0, 2), range(20, 70, 10), range(0, 30, 10)))


def test_tee_with_open_ends():
    """An upright on a plate: two base sides with one element beyond each end, and the upright itself."""
    cuts = welds(assembly(*TEE))
    assert [(c.kind, c.pid, c.line.node.size, c.elements.size) for c in cuts] == [
        ("tee", 1, 5, 6),
        ("tee", 1, 5, 6),
        ("tee", 2, 5, 4),
    ]
    a, b, upright = cuts
    assert np.allclose(a.line.normal, [0, 0, 1])
    assert np.allclose(a.line.outward, -b.line.outward)
    assert np.allclose(upright.line.outward, [0, 0, -1])
    assert not np.intersect1d(a.elements, b.elements).size
    assert {c.name for c in cuts} == {f"tee_{a.line.node[0]}_{a.line.node[-1]}_{end}" for end in ("p1a", "p1b", "p2a")}


def test_normals_point_to_the_attached_plate():
    """An upright below the plate turns its top face down."""
    base, upright = TEE
    cuts = welds(assembly(base, (upright[0] * [1, 1, -1], upright[1])))
    assert all(np.allclose(c.line.normal, [0, 0, -1]) for c in cuts if c.pid == 1)


def test_cross_joint_and_edge_joint():
    """Four shells at an edge give four sides; two plates at an angle of 90 degrees with two properties give two."""
    base, upright = TEE
    below = (upright[0] * [1, 1, -1], upright[1])
    assert [c.pid for c in welds(assembly(base, upright, below))] == [1, 1, 2, 3]
    corner = assembly(
        plate((0, 1), range(0, 40, 10), range(0, 30, 10)), plate((0, 2), range(0, 40, 10), range(0, 30, 10))
    )
    assert [(c.kind, c.pid, c.elements.size) for c in welds(corner)] == [("corner", 1, 3), ("corner", 2, 3)]


def test_candidates_are_no_welds():
    """A change of property in a plane and a fold of one property are candidates."""
    flat = assembly(
        plate((0, 1), range(0, 40, 10), range(0, 30, 10)), plate((0, 1), range(30, 70, 10), range(0, 30, 10))
    )
    assert not welds(flat)
    assert [c.kind for c in welds(flat, ("flat",))] == ["flat", "flat"]
    xyz, quads = joined(plate((0, 1), [0, 10, 20], [0, 10, 20]), plate((0, 2), [0, 10, 20], [0, 10, 20]))
    fold = shell_mesh(xyz, quads, np.ones(len(quads), int))
    assert not welds(fold)
    assert [c.kind for c in welds(fold, ("fold",))] == ["fold", "fold"]


def tube(axes=(0, 1)):
    """A square tube on a plate: four walls of one property."""
    base = plate((0, 1), range(0, 110, 10), range(0, 110, 10))
    wall_x = [plate((0, 2), range(30, 80, 10), [0, 10, 20]) for _ in range(2)]
    wall_y = [plate((1, 2), range(30, 80, 10), [0, 10, 20]) for _ in range(2)]
    for wall, at in zip(wall_x, (30.0, 70.0), strict=True):
        wall[0][:, 1] = at
    for wall, at in zip(wall_y, (30.0, 70.0), strict=True):
        wall[0][:, 0] = at
    xyz, quads = joined(base, *wall_x, *wall_y)
    return shell_mesh(xyz, quads, np.where(np.arange(len(quads)) < len(base[1]), 1, 2))


def test_closed_loop_with_corners():
    """The plate outside the tube is a closed line with 16 + 4 elements; each wall ends at its edges."""
    cuts = [c for c in welds(tube()) if c.kind == "tee"]
    loops = [c for c in cuts if c.line.closed]
    assert sorted(c.elements.size for c in loops) == [12, 20]
    assert [c.line.node.size for c in loops] == [16, 16]
    assert all(corners(c.line).sum() == 4 and len(split_at_kinks(c.line)) == 4 for c in loops)
    assert [(c.line.node.size, c.elements.size) for c in cuts if not c.line.closed] == [(5, 4)] * 4
    for cut in cuts:
        check_line(cut.line, cut.name)


def test_line_goes_on_through_a_crossing():
    """Two uprights that cross: each line passes the other; the plate sides of a line run through."""
    base = plate((0, 1), range(0, 90, 10), range(0, 90, 10))
    along = plate((0, 2), range(0, 90, 10), [0, 10])
    across = plate((1, 2), range(0, 90, 10), [0, 10])
    along[0][:, 1] = across[0][:, 0] = 40.0
    mesh = assembly(base, along, across)
    cuts = [c for c in welds(mesh) if c.pid == 1]
    assert sorted(c.line.node.size for c in cuts) == [9, 9, 9, 9]
    assert all(c.elements.size == 8 for c in cuts)
    same = shell_mesh(mesh.xyz, mesh.corner, np.minimum(mesh.pid, 2))
    assert sorted(c.line.node.size for c in welds(same) if c.pid == 1) == [9, 9, 9, 9]


def test_line_ends_at_a_branch():
    """A line that meets another of the same kind from the side ends there, and its side ends with it."""
    base = plate((0, 1), range(0, 90, 10), range(0, 90, 10))
    along = plate((0, 2), range(0, 90, 10), [0, 10])
    branch = plate((1, 2), range(40, 90, 10), [0, 10])
    along[0][:, 1] = branch[0][:, 0] = 40.0
    xyz, quads = joined(base, along, branch)
    mesh = shell_mesh(xyz, quads, np.where(np.arange(len(quads)) < 64, 1, 2))
    assert sorted(c.line.node.size for c in welds(mesh) if c.pid == 1) == [5, 5, 9, 9]


def test_change_of_property_ends_a_line_without_sharing_elements():
    """Where the attached plate changes its property the weld goes on as another line: no element serves both."""
    base, upright = TEE
    mesh = assembly(base, upright)
    pid = mesh.pid.copy()
    pid[(mesh.pid == 2) & (mesh.xyz[mesh.corner][:, :, 0].mean(axis=1) > 40)] = 3
    cuts = [c for c in welds(shell_mesh(mesh.xyz, mesh.corner, pid)) if c.pid == 1]
    assert [c.line.node.size for c in cuts] == [3] * 4
    assert [c.elements.size for c in cuts] == [3] * 4
    assert np.unique(np.concatenate([c.elements for c in cuts])).size == 12


def test_parabolic_edges():
    """Mid-side nodes stand between the corners of a line and are marked."""
    flat = assembly(*TEE)
    xyz, mid, found = list(flat.xyz), np.full(flat.corner.shape, -1), {}
    for row, quad in enumerate(flat.corner):
        for k in range(4):
            key = tuple(sorted((int(quad[k]), int(quad[(k + 1) % 4]))))
            if key not in found:
                found[key] = len(xyz)
                xyz.append((flat.xyz[key[0]] + flat.xyz[key[1]]) / 2)
            mid[row, k] = found[key]
    cuts = welds(shell_mesh(np.array(xyz), flat.corner, flat.pid, mid))
    for cut in cuts:
        assert cut.line.node.size == 9
        assert cut.line.edge_mid.tolist() == [False, True] * 4 + [False]
        check_line(cut.line, cut.name)


def test_triangles_and_fans():
    """Elements that touch the line at one corner only belong to the side."""
    base, upright = TEE
    mesh = assembly(base, upright)
    quads = mesh.corner[mesh.pid == 1]
    halves = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    corner = np.concatenate([np.column_stack([halves, np.full(len(halves), -1)]), mesh.corner[mesh.pid == 2]])
    pid = np.concatenate([np.ones(len(halves), int), np.full((mesh.pid == 2).sum(), 2)])
    cuts = welds(shell_mesh(mesh.xyz, corner, pid))
    touching = set(np.flatnonzero(np.isin(corner[pid == 1], cuts[0].line.node - 1).any(axis=1)) + 1)
    sides = [set(c.elements.tolist()) for c in cuts if c.pid == 1]
    assert sides[0] | sides[1] == touching
    assert not sides[0] & sides[1]


@settings(deadline=None, max_examples=25)
@given(st.integers(0, 2**32 - 1))
def test_edges_are_the_pairs_of_nodes_that_sides_join(seed):
    """Quads and triangles in any order: pairs ascending, and the sides of each edge are those that join its nodes."""
    rng = np.random.default_rng(seed)
    corner = np.array([rng.permutation(9)[:4] for _ in range(12)])
    corner[rng.random(12) < 0.4, 3] = -1
    topo = topology(shell_mesh(rng.normal(size=(9, 3)), corner, np.ones(12, int)))
    joins = {}
    for element, of_element in enumerate(corner.tolist()):
        nodes = [node for node in of_element if node >= 0]
        for k, (a, b) in enumerate(zip(nodes, nodes[1:] + nodes[:1], strict=True)):
            joins.setdefault((min(a, b), max(a, b)), []).append(4 * element + k)
    assert [tuple(pair) for pair in topo.ends.tolist()] == sorted(joins)
    for edge, pair in enumerate(sorted(joins)):
        assert topo.sides_of(edge) == joins[pair]
        assert all(topo.edge[side] == edge for side in joins[pair])
    assert (topo.edge.reshape(-1, 4)[corner[:, 3] < 0, 3] == -1).all()


def test_stacked_elements():
    """Two shells on the same nodes are told."""
    mesh = assembly(*TEE)
    doubled = shell_mesh(mesh.xyz, np.vstack([mesh.corner, mesh.corner[:1, [1, 2, 3, 0]]]), np.append(mesh.pid, 1))
    assert stacked_elements(doubled).tolist() == [1, mesh.element.size + 1]
    assert not stacked_elements(mesh).size


@settings(deadline=None, max_examples=15)
@given(st.integers(0, 2**32 - 1))
def test_numbering_does_not_matter(seed):
    """Renumbered nodes and elements, turned and flipped corners leave lines, sides and outward directions."""
    rng = np.random.default_rng(seed)
    mesh = tube()
    place = rng.permutation(mesh.node.size)  # old index -> new index
    xyz = np.empty_like(mesh.xyz)
    xyz[place] = mesh.xyz
    corner = place[mesh.corner]
    corner = np.array([np.roll(c, rng.integers(4))[:: rng.choice([-1, 1])] for c in corner])
    order = rng.permutation(len(corner))
    shuffled = shell_mesh(xyz, corner[order], mesh.pid[order])

    def picture(mesh, element):
        return {
            (
                c.pid,
                c.line.closed,
                frozenset(tuple(p) for p in c.line.xyz.round(6).tolist()),
                frozenset(element[c.elements - 1].tolist()),
                tuple(c.line.outward.sum(axis=0).round(6) + 0.0),
            )
            for c in welds(mesh)
        }

    assert picture(mesh, np.arange(len(corner))) == picture(shuffled, order)


def carbody():
    """Mesh of the shipped car body."""
    nodes, elements = (pq.read_table(CARBODY / f"{name}.parquet").to_pydict() for name in ("nodes", "elements"))
    node = np.array(nodes["node"])
    count = len(elements["element"])
    return ShellMesh(
        node,
        np.column_stack([nodes[f"{a}_mm"] for a in "xyz"]).astype(float),
        np.array(elements["element"]),
        np.searchsorted(node, np.column_stack([elements[f"n{k}"] for k in range(1, 5)])),
        np.full((count, 4), -1),
        np.array(elements["pid"]),
        np.array(elements["thickness_mm"], float),
        np.zeros(count),
    )


def test_car_body_lines():
    """All 14 given lines are found: each is a stretch of a detected line with its thickness, side and direction."""
    cuts = welds(carbody())
    assert sum(c.kind == "tee" for c in cuts) == 246
    given_lines: dict[str, list[list[str]]] = {}
    for row in (CARBODY / "weld_nodes.csv").read_text().splitlines()[1:]:
        cells = row.split(",")
        given_lines.setdefault(cells[0], []).append(cells)
    assert len(given_lines) == 14
    exact = 0
    for rows in given_lines.values():
        node = np.array([int(r[2]) for r in rows])
        thickness, outward = float(rows[0][6]), np.array(rows[1][10:13], float)
        for cut in cuts:
            if np.isin(node, cut.line.node).all() and cut.line.thickness[0] == thickness:
                at = int(np.flatnonzero(cut.line.node == node[1])[0])
                if cut.line.outward[at] @ outward > 0.5 * np.linalg.norm(outward):
                    exact += cut.line.node.size == node.size
                    break
        else:
            pytest.fail(f"{rows[0][0]} not found")
    assert exact == 12  # the two stretches of the floor seam lie on longer lines


def test_car_body_sides():
    """Sides of the shipped lines, corner elements and those beyond the ends included."""
    cuts = welds(carbody())
    given_sides: dict[str, set[int]] = {}
    for row in Path("tests/data/carbody_weld_elements.csv").read_text().splitlines()[1:]:
        weld, element = row.split(",")
        given_sides.setdefault(weld, set()).add(int(element))
    found = [set(c.elements.tolist()) for c in cuts]
    assert len(given_sides) == 5
    assert all(side in found for side in given_sides.values())


def test_wing_box():
    """8 T lines of 33 nodes, three sides each."""
    mesh = read_bdf(Path("data/nastran/wingbox_stitched_together-000.bdf")).mesh
    assert [(c.line.node.size, c.elements.size) for c in welds(mesh)] == [(33, 32)] * 24
