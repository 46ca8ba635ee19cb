"""Welds of solids from a deck and its forces to lives: tables, audit, register, marks, refusals."""

from dataclasses import replace

import numpy as np
import pyarrow.csv as pc
import pyarrow.parquet as pq
import pytest

from fatigue.errors import DataError
from fatigue.readers.convert.convert import convert
from fatigue.readers.convert.options import ConvertOptions, WeldSources
from fatigue.readers.convert.weld_forces import with_forces_only
from fatigue.readers.convert.weld_lines import find_welds, list_welds
from fatigue.readers.foreign.read import read_forces, read_model
from fatigue.readers.neutral.forces.convention import COMPONENTS
from tests.command_line import assess, fatigue
from tests.readers.op2_writer import modal_op2
from tests.readers.solid_tee import solid_bulk, solid_tee
from tests.solid_meshes import Solids, deck, tee

PLATES = [(200, 0, 0), (210, 0, 0), (210, 10, 0), (200, 10, 0), (210, 20, 0), (200, 20, 0), (210, 10, 9), (200, 10, 9)]
NAMES = ("solid_toe_24_93_p1a", "solid_toe_36_99_p1a", "solid_toe_24_93_p2a", "solid_toe_36_99_p2a")


@pytest.fixture(scope="module", params=[False, True], ids=["hex8", "hex20"])
def files(request, tmp_path_factory):
    """Bulk data, forces and coordinates of the T joint of bricks."""
    folder = tmp_path_factory.mktemp("solid")
    case = solid_tee(request.param)
    (folder / "tee.bdf").write_text(solid_bulk(case))
    (folder / "tee.op2").write_bytes(modal_op2(case.results, word=8))
    time = np.arange(300) / 100
    q = np.stack([2e-5 * (k + 1) * np.sin((3 * k + 2) * time) for k in range(4)])
    rows = [f"{t:.9g}," + ",".join(f"{x:.9g}" for x in q[:, k]) for k, t in enumerate(time)]
    (folder / "straight.csv").write_text("\n".join(["time," + ",".join(f"q_{k}" for k in range(1, 5)), *rows]) + "\n")
    return ConvertOptions(
        forces=folder / "tee.op2", mesh=folder / "tee.bdf", out=folder / "body", coordinates=(folder / "straight.csv",)
    )


@pytest.fixture(scope="module")
def converted(files):
    """The conversion, its model case."""
    return convert(files), solid_tee(files.forces.read_bytes() == modal_op2(solid_tee(True).results, word=8))


def rows_of(path):
    """Rows of a CSV as dictionaries."""
    return pc.read_csv(path).to_pylist()


def test_solids_of_the_deck_and_their_force_rows(files):
    """Elements, nodes and mid-side nodes are those of the model; rows of HEXA have no moments."""
    model = read_model(files.mesh)
    results = read_forces(files.forces, None)
    assert model.mesh.element.size == 0
    assert model.solids.element.size == 60
    assert set(results.kind[results.of_element]) == {"HEXA"}
    assert not results.force[:, results.of_element, 3:].any()


def test_the_audit_proves_sign_balance_and_completeness(converted):
    """All lights are green that can be: balance of bricks by forces alone, sign by the work of the shapes."""
    found, _ = converted
    lights = {row.check: row for row in found.audit.rows}
    assert found.audit.convention == "on_node"
    for check in ("element balance", "displacement frames", "grid totals", "sign", "completeness"):
        assert lights[check].light == "green", lights[check]
    assert "worst of 60 solids" in lights["element balance"].finding
    assert lights["completeness"].finding == "60 of 60 solids have forces at all their nodes"


def test_the_register_has_every_toe_from_each_side(converted):
    """Four lines, all to assess at their top, where the toe is."""
    found, _ = converted
    assert {row.line for row in found.welds} == set(NAMES)
    assert {(row.status, row.surface, row.kind) for row in found.welds} == {("assess", "top", "solid_toe")}
    assert sorted(row.thickness for row in found.welds) == pytest.approx([6, 6, 10, 10])


def test_the_tables_hold_the_line_force_and_moment_of_the_solids(files, converted):
    """Forces of the assessed solids, summed over their columns, are those of a free body of the same solids."""
    _, case = converted
    body = files.out
    columns, nodes = rows_of(body / "weld_columns.csv"), rows_of(body / "weld_nodes.csv")
    sides = rows_of(body / "weld_elements.csv")
    table = pq.read_table(body / "element_forces.parquet").to_pandas()
    xyz = {n + 1: x for n, x in enumerate(case.model.xyz)}
    for weld in NAMES:
        stations = {row["order"]: np.array([row[f"{a}_mm"] for a in "xyz"]) for row in nodes if row["weld"] == weld}
        own = [row["element"] for row in sides if row["weld"] == weld]
        of_side = table[table["element"].isin(own)]
        at_column = [(row["order"], row["node"]) for row in columns if row["weld"] == weld]
        assert {order for order, _ in at_column} == set(stations)
        for mode in range(1, 5):
            rows = of_side[of_side["mode"] == mode]
            total = np.zeros(6)
            for _, node in at_column:
                f = rows[rows["node"] == node][list(COMPONENTS[:3])].to_numpy().sum(axis=0)
                total += [*f, *np.cross(xyz[node], f)]
            wanted = np.zeros(6)
            cut = {node for _, node in at_column}
            for element in own:
                for node, f in zip(case.model.bricks[element - 1] + 1, case.force[mode - 1, element - 1], strict=True):
                    if int(node) in cut:
                        wanted -= [*f, *np.cross(xyz[int(node)], f)]
            assert total == pytest.approx(wanted, abs=1e-6 * np.abs(wanted).max())


def test_the_folder_can_be_assessed(files, converted, tmp_path):
    """Lives of every station of every weld at its top, and the recount agrees."""
    assert (files.out / "case.toml").read_text().count('weld_columns = "weld_columns.csv"') == 1
    ended = assess(files.out / "case.toml", "-o", tmp_path / "result", "--exit-zero")
    assert ended.returncode == 0, ended.stderr
    table = pq.read_table(tmp_path / "result" / "nodes.parquet")
    stations = 7 if converted[1].parabolic else 4
    assert table.num_rows == 2 * 4 * stations  # both faces are told, the upper has the toe
    assert {s for s, toe in zip(*(table[name].to_pylist() for name in ("surface", "toe")), strict=True) if toe} == {
        "top"
    }
    recounted = fatigue("verify", "--results", tmp_path / "result", "--all")
    assert recounted.returncode == 0, recounted.stdout + recounted.stderr


def test_welds_lists_them(files, tmp_path):
    """The command writes the register, which wins when it is given back."""
    out = tmp_path / "register.csv"
    ended = fatigue("welds", files.mesh, "-o", out)
    assert ended.returncode == 0, ended.stderr
    assert "solid_toe_24_93_p1a" in out.read_text()
    out.write_text(
        out.read_text().replace("solid_toe_24_93_p1a,solid_toe_24_93_p1a,assess", "foot,solid_toe_24_93_p1a,assess")
    )
    found = list_welds(files.mesh, WeldSources(register=out), "mm-t-s", None, False)
    assert "foot" in {row.weld for row in found.rows}


def model_of(tmp_path, text):
    """Model of a deck."""
    (tmp_path / "m.bdf").write_text(text)
    return read_model(tmp_path / "m.bdf")


def test_lines_joined_by_name(tmp_path):
    """A toe marked as two lists is one weld, with the columns and solids of the toe in one piece."""
    model = model_of(tmp_path, deck(tee()))
    whole = find_welds(model, WeldSources())
    cut = next(c for c in whole.cuts.values() if c.pid == 1 and c.line.xyz[0, 1] < 30)
    nodes = cut.line.node.tolist()
    parts = (("a", nodes[:3]), ("b", nodes[2:]))
    lists = tmp_path / "lists.csv"
    rows = [f"{name},{k},{n}" for name, part in parts for k, n in enumerate(part, 1)]
    lists.write_text("\n".join(["weld,order,node", *rows]) + "\n")
    marked = find_welds(model, WeldSources(node_lists=lists))
    own = [row for row in marked.rows if row.pid == 1]
    assert len(own) == 2
    register = tmp_path / "register.csv"
    head = "weld,line,status,reason,kind,pids,pid,nodes,length_mm,thickness_mm,confirmed,surface,curve,"
    head += "end_length_mm,description"
    lines = [f"foot,{row.line},assess,,,,1,{row.nodes},{row.length},10,false,top,,," for row in own]
    register.write_text("\n".join([head, *lines]) + "\n")
    joined = find_welds(model, WeldSources(node_lists=lists, register=register)).joined["foot"]
    assert sorted(joined.columns) == sorted(cut.columns)
    assert joined.elements.tolist() == cut.elements.tolist()
    assert joined.line.thickness == pytest.approx(10.0)
    assert np.sort(joined.line.xyz, axis=0) == pytest.approx(np.sort(cut.line.xyz, axis=0))


def test_marks_on_the_skin(tmp_path):
    """A set and a list on flat skin: a cut either way; nodes inside are no line."""
    solids = Solids().block([0, 10, 20], [0, 10, 20, 30], [0, 5, 10])
    inner = [solids.node((x, 10, 5)) for x in (0, 10, 20)]
    outer = [solids.node((x, 10, 10)) for x in (0, 10, 20)]
    model = model_of(tmp_path, deck(solids, extra="SET1,9," + ",".join(map(str, outer))))
    found = find_welds(model, WeldSources(sets=(9,)))
    sides = sorted(cut.line.outward[0, 1] for cut in found.cuts.values())
    assert sides == pytest.approx([-1.0, 1.0])
    assert {len(cut.columns) for cut in found.cuts.values()} == {3}
    lists = tmp_path / "lists.csv"
    lists.write_text("weld,order,node\n" + "".join(f"w,{k},{n}\n" for k, n in enumerate(inner)))
    with pytest.raises(DataError, match="no edge of shells or of the skin of solids joins") as refused:
        find_welds(model, WeldSources(node_lists=lists))
    assert refused.value.problems[0].code == "no_edge"


def test_lines_in_space_lie_on_the_skin(tmp_path):
    """A polyline along a toe gives its cuts under the name of the line."""
    lines = tmp_path / "lines.csv"
    lines.write_text("line,point,x_mm,y_mm,z_mm\nfoot,1,0,27,10\nfoot,2,40,27,10\n")
    found = find_welds(model_of(tmp_path, deck(tee())), WeldSources(lines=lines))
    assert {row.kind for row in found.rows} == {"line"}
    assert {len(cut.columns) for cut in found.cuts.values()} == {4}


def test_shells_that_end_at_solids_are_told(tmp_path):
    """A shell upright on a plate of bricks: its foot is in the register, excluded, with the reason."""
    solids = Solids().block([0, 10, 20], [0, 10, 20], [0, 10])
    a, b, c = (solids.node((x, 10, 10)) for x in (0, 10, 20))
    upright = "GRID,901,,0.,10.,20.\nGRID,902,,10.,10.,20.\nGRID,903,,20.,10.,20.\nPSHELL,7,1,5.,1,,1\n"
    upright += f"CQUAD4,801,7,{a},{b},902,901\nCQUAD4,802,7,{b},{c},903,902"
    model = model_of(tmp_path, deck(solids, extra=upright))
    assert (model.mesh.element.size, model.solids.element.size) == (2, 4)
    rows = find_welds(model, WeldSources()).rows
    assert [(row.kind, row.status) for row in rows] == [("shell_on_solid", "excluded")]
    assert "shells end at solids there" in rows[0].reason


def test_forces_of_a_part_leave_welds_out(files, tmp_path):
    """A weld whose column lacks forces is excluded with the reason."""
    results = read_forces(files.forces, None)
    model = read_model(files.mesh)
    found = find_welds(model, WeldSources())
    cut = found.cuts[NAMES[0]]
    kept = ~(results.of_element & (results.element == cut.elements[0]))
    some = replace(
        results,
        node=results.node[kept],
        element=results.element[kept],
        kind=results.kind[kept],
        force=results.force[:, kept],
    )
    row = next(row for row in with_forces_only(found, some).rows if row.line == NAMES[0])
    assert row.status == "excluded"
    assert f"1 of {cut.elements.size} elements have no grid point forces" in row.reason


def test_lives_are_those_of_a_case_made_by_hand(files, converted, tmp_path):
    """A case of forces and moments summed over the columns by hand, of the model's own K u, has the same lives."""
    _, case = converted
    body = tmp_path / "hand"
    body.mkdir()
    for name in ("modes.csv", "welds.csv", "weld_nodes.csv", "nodes.parquet", "elements.parquet", "q_straight.parquet"):
        (body / name).write_bytes((files.out / name).read_bytes())
    sides, nodes = rows_of(files.out / "weld_elements.csv"), rows_of(files.out / "weld_nodes.csv")
    columns = rows_of(files.out / "weld_columns.csv")
    lines = [",".join(("weld", "mode", "node", *COMPONENTS))]
    for station in nodes:
        own = [row["element"] for row in sides if row["weld"] == station["weld"]]
        key = station["weld"], station["order"]
        column = {row["node"] for row in columns if (row["weld"], row["order"]) == key}
        middle = np.array([station[f"{a}_mm"] for a in "xyz"])
        for mode in range(1, 5):
            total = np.zeros(6)
            for element in own:
                for at, f in zip(case.model.bricks[element - 1], case.force[mode - 1, element - 1], strict=True):
                    if int(at) + 1 in column:
                        total += [*f, *np.cross(case.model.xyz[at] - middle, f)]
            lines.append(",".join(map(str, (station["weld"], mode, station["node"], *total.tolist()))))
    (body / "nodal_forces.csv").write_text("\n".join(lines) + "\n")
    text = (files.out / "case.toml").read_text()
    gone = ("weld_columns", "element_forces", "weld_elements", "register", "force_convention")
    kept = [line for line in text.splitlines() if not line.startswith(gone)]
    kept.insert(kept.index("[body]") + 1, 'nodal_forces = "nodal_forces.csv"\nforce_convention = "on_element"')
    (body / "case.toml").write_text("\n".join(kept) + "\n")
    tables = []
    for number, folder in enumerate((files.out, body)):
        out = tmp_path / f"result_{number}"
        ended = assess(folder / "case.toml", "-o", out, "--exit-zero")
        assert ended.returncode == 0, ended.stderr
        tables.append(pq.read_table(out / "nodes.parquet"))
    of_files, by_hand = tables
    assert of_files.select(["weld", "node", "surface"]).equals(by_hand.select(["weld", "node", "surface"]))
    lives = [np.array(table["life_km"].to_pylist(), float) for table in tables]
    assert np.isfinite(lives[0]).sum() > 10
    assert lives[0] == pytest.approx(lives[1], rel=1e-5, nan_ok=True)  # forces of the file are in single precision


def test_written_lines_find_the_same_cuts(tmp_path):
    """Lines are written where the toes are, on the surface, and give the same columns and solids."""
    (tmp_path / "m.bdf").write_text(deck(tee(wedge=4.0)))
    lines = tmp_path / "lines.csv"
    found = list_welds(tmp_path / "m.bdf", WeldSources(), "mm-t-s", None, False, lines)
    again = find_welds(read_model(tmp_path / "m.bdf"), WeldSources(lines=lines))

    def key(cuts):
        return sorted((sorted(cut.columns), cut.elements.tolist()) for cut in cuts.values())

    assert key(again.cuts) == key(found.cuts)


def test_one_name_for_lines_of_shells_and_solids(tmp_path):
    """They do not join."""
    grids = "".join(f"GRID,{900 + k},,{x}.,{y}.,{z}.\n" for k, (x, y, z) in enumerate(PLATES))
    shells = "CQUAD4,801,7,900,901,902,903\nCQUAD4,802,7,903,902,904,905\nCQUAD4,803,7,903,902,906,907\n"
    model = model_of(tmp_path, deck(tee(), extra=grids + shells + "PSHELL,7,1,5.,1,,1"))
    found = find_welds(model, WeldSources())
    assert {row.kind for row in found.rows} == {"tee", "solid_toe"}
    register = tmp_path / "register.csv"
    shell = next(row for row in found.rows if row.kind == "tee")
    solid = next(row for row in found.rows if row.kind == "solid_toe")
    text = ["weld,line,status"] + [f"both,{row.line},assess" for row in (shell, solid)]
    register.write_text("\n".join(text) + "\n")
    with pytest.raises(DataError) as refused:
        find_welds(model, WeldSources(register=register))
    assert "lines of shells and of solids" in str(refused.value)
