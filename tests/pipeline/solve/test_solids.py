"""Welds of solid elements in a case: both forms of forces, kinks, joints, mistakes, shells beside them, the recount."""

import numpy as np
import pandas as pd
import pytest

from fatigue.check import check_case
from fatigue.errors import DataError
from fatigue.pipeline.solve.model import read_model
from fatigue.weld.line import WeldLine
from fatigue.weld.structural_stress import assess_line
from tests.command_line import assess, fatigue
from tests.solid_case import FORCE, TOES, case_of, columns_on, stations, tee_case, tee_of_shells
from tests.solid_fe import SolidModel, block


def stress(case, folder):
    """Membrane and bending stress (n,) under mode 1 by weld, without treatment of ends."""
    case.tables["welds"]["end_length_mm"] = 0.0
    model = read_model(case.write(folder))
    treated, weld = model.stations.treated, model.stations.weld
    return {
        name: (treated.membrane[weld == i, 0], treated.bending[weld == i, 0])
        for i, name in enumerate(model.stations.names)
    }


def stress_of_shells(h, nu):
    """The same of the T joint of shells, read at the lines where the toes of the bricks are."""
    model, u = tee_of_shells(h, nu)
    centre = model.xyz[model.quads].mean(axis=1)
    found = {}
    for weld, (x, out) in TOES.items():
        _, groups = columns_on(model.xyz, x, (0, 0))
        nodes = np.concatenate(groups)
        side = (np.abs(centre[:, 2]) < 1e-9) & ((centre[:, 0] - x) * out < 0) & np.isin(model.quads, nodes).any(axis=1)
        n = len(nodes)
        line = WeldLine(
            weld=weld,
            part=1,
            order=np.arange(n),
            node=nodes,
            xyz=model.xyz[nodes],
            thickness=np.full(n, 10.0),
            normal=np.tile([0.0, 0, 1], (n, 1)),
            outward=np.tile([out, 0.0, 0], (n, 1)),
            edge_mid=np.zeros(n, dtype=bool),
            closed=False,
            end_length=0.0,
        )
        raw = assess_line(line, model.side_forces(u, np.flatnonzero(side), nodes)[:, None]).raw
        found[weld] = raw.membrane[:, 0], raw.bending[:, 0]
    return found


@pytest.mark.parametrize(
    ("h", "layers", "quadratic"),
    [(25.0, 2, False), (12.5, 2, False), (6.25, 2, False), (25.0, 1, True), (12.5, 1, True), (12.5, 2, True)],
)
def test_the_t_joint_of_bricks_is_that_of_statics_and_of_shells(h, layers, quadratic, tmp_path):
    """Left 1 and 14.25 MPa, right 0 and -14.25 MPa at the toes: bricks within 0.5 %, shells exactly."""
    bricks, shells = stress(tee_case(h, layers, quadratic, modes=1), tmp_path), stress_of_shells(h, 0.0)
    for weld, membrane, bending in (("left", 1.0, 14.25), ("right", 0.0, -14.25)):
        tolerance = 0.005 if quadratic else 1e-6
        for found, within in ((bricks, tolerance), (shells, 1e-6)):
            assert np.abs(found[weld][0] - membrane).max() < within
            assert np.abs(found[weld][1] / bending - 1).max() < within


@pytest.mark.parametrize(("h", "quadratic"), [(100 / 6, False), (12.5, False), (6.25, False), (25.0, True)])
def test_with_lateral_contraction_the_middle_of_the_toe_is_that_of_shells(h, quadratic, tmp_path):
    """Poisson 0.3 disturbs the edges of the plate only: within 3 % at mid-width, on three meshes."""
    bricks, shells = stress(tee_case(h, 2, quadratic, nu=0.3, modes=1), tmp_path), stress_of_shells(h, 0.3)
    for weld in TOES:
        a, b = (sum(found[weld]) for found in (bricks, shells))  # at the top
        assert a[len(a) // 2] == pytest.approx(b[len(b) // 2], rel=0.03)


@pytest.mark.parametrize("quadratic", [False, True])
def test_summed_forces_give_what_element_forces_give(quadratic, tmp_path):
    """The two forms of one case, also where the rows of the table of columns come in another order."""
    layers = 1 if quadratic else 2
    raw = stress(tee_case(25.0, layers, quadratic), tmp_path / "raw")
    case = tee_case(25.0, layers, quadratic, form="nodal_forces")
    case.tables["weld_columns"] = case.tables["weld_columns"].sample(frac=1, random_state=3)
    case.tables["nodal_forces"] = case.tables["nodal_forces"].sample(frac=1, random_state=4)
    summed = stress(case, tmp_path / "summed")
    for weld in TOES:
        assert np.allclose(raw[weld], summed[weld], rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("form", ["element_forces", "nodal_forces"])
def test_an_assessment_of_solid_welds_is_recounted_from_its_files(form, tmp_path):
    """Assess, recount, and the page: the line is at mid-thickness, the node on top; nothing is doubted."""
    path = tee_case(form=form).write(tmp_path)
    done = assess(path, "-o", tmp_path / "out")
    assert done.returncode == 1, done.stderr
    found = fatigue("verify", "--results", tmp_path / "out")
    assert found.returncode == 0, found.stdout
    assert "20 of 20 points recounted" in found.stdout
    nodes = pd.read_parquet(tmp_path / "out" / "nodes.parquet")
    assert (nodes["z_mm"] == 0).all()
    assert "weld_columns.csv" in (tmp_path / "out" / "provenance.json").read_text()
    assert fatigue("show", tmp_path / "out").returncode == 0


def test_unit_loads_are_summed_over_columns_too(tmp_path):
    """A unit load whose forces are those of mode 1 gives the stress of mode 1."""
    for form in ("element_forces", "nodal_forces"):
        case = tee_case(form=form, modes=1)
        case.tables["load"] = case.tables[form].drop(columns="mode").assign(unit_load="push")
        folder = tmp_path / form
        case.tables["load"].to_csv(tmp_path / f"{form}.csv", index=False)
        del case.tables["load"]
        case.extra = f'[[body.unit_load]]\nname = "push"\nunit = "N"\n{form} = "../{form}.csv"\n'
        case.extra += '[[mission.event.unit_load]]\nname = "push"\nunit = "N"\nconstant = 1.0\n'
        model = read_model(case.write(folder))
        bending = model.stations.treated.bending
        assert bending.shape[1] == 2
        assert np.allclose(bending[:, 0], bending[:, 1])


def angle(reentrant, quadratic, lines=("seam", "seam")):
    """A weld that turns by 90 degrees on a plate of bricks under a smooth displacement; in one line or in two."""
    x = stations(40, 10)
    model = SolidModel(*block(x, x, [-5.0, 0, 5], quadratic))
    at = model.xyz / 40
    shapes = [
        np.stack([np.sin(k + at @ [1, 2, 3]), np.cos(k * at @ [2, 1, 1]), np.sin(at @ [k, 1, 2])], axis=1) * 1e-3
        for k in (1.0, 2.0)
    ]
    case = case_of(model, shapes, {"seam": (20.0, 1.0)}, "element_forces")
    sign = -1.0 if reentrant else 1.0
    places, groups = columns_on(model.xyz, 20.0, (-5, 5))
    first = [(place, group) for place, group in zip(places, groups, strict=True) if place <= 20]
    around = np.flatnonzero(np.abs(model.xyz[:, 1] - 20) < 1e-9)
    second = [(p, around[np.abs(model.xyz[around, 0] - p) < 1e-6]) for p in places[places < 20][::-1]]
    rows = [(20.0, place, group, (sign, 0)) for place, group in first]
    rows += [(place, 20.0, group, (0, sign)) for place, group in second]
    corner = len(first) - 1
    nodes, columns = [], []
    for weld, some in dict.fromkeys(lines, None).items() if len(set(lines)) == 1 else ((lines[0], 0), (lines[1], 1)):
        own = rows if some is None else rows[: corner + 1] if some == 0 else rows[corner:]
        for order, (px, py, group, out) in enumerate(own, 1):
            if some == 1 and order == 1:
                out = (0, sign)  # noqa: PLW2901 (the corner, seen from the second line)
            by_height = group[np.argsort(model.xyz[group, 2])]
            mid = quadratic and len(group) == 3
            nodes.append([weld, order, by_height[-1] + 1, px, py, 0.0, 10.0, 0, 0, 1, *out, 0, mid])
            columns.append(pd.DataFrame({"weld": weld, "order": order, "node": by_height + 1}))
    names = case.tables["weld_nodes"].columns
    case.tables["welds"] = pd.DataFrame({"weld": list(dict.fromkeys(lines))})
    case.tables["weld_nodes"] = pd.DataFrame(nodes, columns=names)
    case.tables["weld_columns"] = pd.concat(columns, ignore_index=True)
    centre = model.xyz[model.bricks[:, :8]].mean(axis=1)
    inside = (centre[:, :2] < 20).all(axis=1)
    sides, forces = [], []
    for weld in case.tables["welds"]["weld"]:
        own = case.tables["weld_columns"].loc[lambda t, w=weld: t["weld"] == w, "node"] - 1
        side = np.flatnonzero((~inside if reentrant else inside) & np.isin(model.bricks, own).any(axis=1))
        sides.append(pd.DataFrame({"weld": weld, "element": side + 1}))
    for mode, u in enumerate(shapes, 1):
        force = model.element_forces(u).reshape(-1, 3)
        table = pd.DataFrame(force, columns=FORCE[:3]).assign(**dict.fromkeys(FORCE[3:], 0.0), mode=mode)
        n = model.bricks.shape[1]
        forces.append(
            table.assign(node=model.bricks.ravel() + 1, element=np.repeat(np.arange(len(model.bricks)) + 1, n))
        )
    case.tables["element_forces"] = pd.concat(forces, ignore_index=True)
    case.tables["weld_elements"] = pd.concat(sides, ignore_index=True)
    return case


@pytest.mark.parametrize("quadratic", [False, True])
@pytest.mark.parametrize("reentrant", [False, True])
def test_a_corner_splits_the_forces_of_bricks_as_those_of_shells(reentrant, quadratic, tmp_path):
    """Two parts that add up to the whole, element by element seen from the top, and the recount finds the same."""
    path = angle(reentrant, quadratic).write(tmp_path)
    model = read_model(path)
    assert set(model.stations.part.tolist()) == {1, 2}
    assert assess(path, "-o", tmp_path / "out").returncode in (0, 1)
    assert fatigue("verify", "--results", tmp_path / "out").returncode == 0


@pytest.mark.parametrize("reentrant", [False, True])
def test_two_solid_lines_of_one_name_are_as_one_line(reentrant, tmp_path):
    """Joined by the register: the stress of the line that was never cut, and of the recount."""
    whole = read_model(angle(reentrant, False).write(tmp_path / "whole"))
    case = angle(reentrant, False, ("a", "b"))
    path = case.write(tmp_path / "cut")
    register = pd.DataFrame({"line": ["a", "b"], "weld": "seam", "status": "assess", "reason": ""})
    register.to_csv(tmp_path / "cut" / "welds_register.csv", index=False)
    cut = read_model(path)
    turned = np.argsort(cut.stations.node * 10 + cut.stations.part)
    ours = np.argsort(whole.stations.node * 10 + whole.stations.part)
    at_corner = whole.stations.at_corner[ours]
    assert np.array_equal(whole.stations.node[ours], cut.stations.node[turned])
    a, b = (m.stations.treated.bending[s] for m, s in ((whole, ours), (cut, turned)))
    assert np.allclose(a[~at_corner], b[~at_corner], rtol=1e-9, atol=1e-9)
    assert assess(path, "-o", tmp_path / "out").returncode in (0, 1)
    assert fatigue("verify", "--results", tmp_path / "out").returncode == 0


def problem(case, folder):
    """Code, place and words of the only mistake."""
    with pytest.raises(DataError) as caught:
        check_case(case.write(folder))
    (found,) = caught.value.problems
    return found.code, found.where, found.what


@pytest.mark.parametrize("form", ["element_forces", "nodal_forces"])
def test_a_row_that_is_missing_at_a_node_below_the_top_is_refused(form, tmp_path):
    """Every node of a column needs its force."""
    case = tee_case(form=form)
    node = int(case.tables["weld_columns"].query("weld == 'left' and order == 3")["node"].iloc[0])
    forces = case.tables[form]
    gone = (forces["node"] == node) & (forces["mode"] == 2)
    case.tables[form] = forces[~gone]
    code, where, _ = problem(case, tmp_path)
    if form == "nodal_forces":
        assert (code, where) == ("missing_row", f"nodal_forces.csv: weld left, node {node}, mode 2")
    else:
        assert code == "imbalance"  # its elements lack a corner


def test_a_node_that_no_element_of_the_side_touches_is_refused(tmp_path):
    """A layer of the plate is not in weld_elements."""
    case = tee_case()
    sides = case.tables["weld_elements"]
    nodes = case.tables["nodes"].set_index("node")["z_mm"]
    low = case.tables["element_forces"].groupby("element")["node"].agg(lambda node: nodes[node].mean() < 0)
    case.tables["weld_elements"] = sides[~sides["element"].map(low)]
    code, where, what = problem(case, tmp_path)
    assert (code, where) == ("bare_node", "element_forces.csv: weld left")
    assert "no element of the assessed side touches node" in what


@pytest.mark.parametrize("form", ["element_forces", "nodal_forces"])
def test_moments_at_nodes_of_solids_are_told(form, tmp_path):
    """Shells among the elements of the side: their moments count, and the user hears of them."""
    case = tee_case(form=form)
    table = case.tables[form]
    table.loc[table["node"] == case.tables["weld_nodes"]["node"].iloc[0], "mx_Nmm"] = 50.0
    if form == "element_forces":
        del case.tables["nodes"]  # no balance of moments
        positions = tee_case().tables["nodes"]
        case.tables["weld_columns"] = case.tables["weld_columns"].merge(positions, on="node")
        table.loc[table["node"] == case.tables["weld_nodes"]["node"].iloc[0], "mx_Nmm"] = 50.0
    model = read_model(case.write(tmp_path))
    assert "moments_of_solids" in [warning.code for warning in model.warnings]


def test_shells_beside_solids_keep_their_stress(tmp_path):
    """A line without rows in weld_columns is one of shells, bit for bit as without the table."""
    case = tee_case(form="nodal_forces")
    columns = case.tables["weld_columns"]
    case.tables["weld_columns"] = columns[columns["weld"] == "left"]
    with_solids = read_model(case.write(tmp_path / "both"))
    del case.tables["weld_columns"]
    of_shells = read_model(case.write(tmp_path / "shells"))
    right = with_solids.stations.weld == 1
    for name in ("membrane", "bending", "shear", "twist"):
        if hasattr(of_shells.stations.treated, name):
            one, other = (getattr(m.stations.treated, name)[right] for m in (with_solids, of_shells))
            assert np.array_equal(one, other)


@pytest.mark.parametrize("form", ["element_forces", "nodal_forces"])
def test_forces_of_bricks_without_the_table_of_columns_are_told(form, tmp_path):
    """Only the top nodes would count: no moment anywhere gives it away."""
    case = tee_case(form=form)
    of_solids = check_case(case.write(tmp_path / "solid")).warnings
    assert "no_moments" not in [warning.code for warning in of_solids]
    del case.tables["weld_columns"]
    told = [one for one in check_case(case.write(tmp_path / "shells")).warnings if one.code == "no_moments"]
    assert len(told) == 1
    assert "weld_columns" in told[0].remedy


def test_a_case_needs_positions_of_its_columns(tmp_path):
    """Neither nodes nor coordinates."""
    case = tee_case(form="nodal_forces")
    del case.tables["nodes"]
    assert problem(case, tmp_path)[0] == "no_positions"


def test_the_recount_reads_positions_of_the_table_itself(tmp_path):
    """Coordinates in weld_columns instead of the table of nodes."""
    case = tee_case(form="nodal_forces")
    case.tables["weld_columns"] = case.tables["weld_columns"].merge(case.tables.pop("nodes"), on="node")
    path = case.write(tmp_path)
    assert assess(path, "-o", tmp_path / "out").returncode == 1
    assert fatigue("verify", "--results", tmp_path / "out").returncode == 0
