"""Lines that the register gives one name: joined at the assessment as at the conversion, and as if never cut."""

import csv
from dataclasses import fields, replace

import numpy as np
import pandas as pd
import pytest

from fatigue.assess import assess
from fatigue.case import load_case
from fatigue.check import check_case
from fatigue.errors import DataError
from fatigue.pipeline.solve.model import read_model
from fatigue.readers.convert.convert import convert
from fatigue.readers.convert.options import ConvertOptions, WeldSources
from fatigue.verify.recount import recount
from tests.readers.box_model import HIGH, LOW, box, corner_nodes
from tests.readers.op2_writer import modal_op2
from tests.readers.tee_model import bulk


def converted(folder, walls):
    """Convert the box with its weld in one line for each wall, and with it in one line: options of both."""
    case, legs = box(walls), corner_nodes(walls)
    (folder / "box.bdf").write_text(bulk(case))
    (folder / "box.op2").write_bytes(modal_op2(case.results, word=8))
    time = np.arange(400) / 100
    rows = [f"{t:.9g}," + ",".join(f"{0.3 * np.sin(3 * (k + 1) * t):.9g}" for k in range(3)) for t in time]
    (folder / "q.csv").write_text("\n".join(["time,q_1,q_2,q_3", *rows]) + "\n")
    whole = [node for leg in legs for node in leg[:-1]] + legs[-1][-1:]
    for name, lines in (("legs", {f"leg{i}": leg for i, leg in enumerate(legs)}), ("whole", {"whole": whole})):
        rows = [f"{weld},{k},{node}" for weld, nodes in lines.items() for k, node in enumerate(nodes)]
        (folder / f"{name}.csv").write_text("\n".join(["weld,order,node", *rows]) + "\n")
    options = ConvertOptions(
        forces=folder / "box.op2",
        mesh=folder / "box.bdf",
        out=folder / "legs",
        coordinates=(folder / "q.csv",),
        interface_modes=(3,),
        welds=WeldSources(node_lists=folder / "legs.csv"),
    )
    whole = replace(options, out=folder / "whole", welds=WeldSources(node_lists=folder / "whole.csv"))
    convert(options)
    convert(whole)
    return options, whole


@pytest.fixture(scope="module", params=[4, 2], ids=["ring", "angle"])
def both(request, tmp_path_factory):
    """Folders of the box and of an angle, converted in pieces and whole; read them, never write to them."""
    return converted(tmp_path_factory.mktemp("box"), request.param)


@pytest.fixture
def pieces(both, tmp_path):
    """Convert in pieces into a folder that may be edited: its options."""
    options = replace(both[0], out=tmp_path / "body")
    convert(options)
    return options


def register_rows(folder):
    """Rows of the register."""
    with (folder / "welds_register.csv").open(newline="") as file:
        return list(csv.DictReader(file))


def write_register(folder, rows):
    """Write edited rows."""
    with (folder / "welds_register.csv").open("w", newline="") as file:
        writer = csv.DictWriter(file, rows[0])
        writer.writeheader()
        writer.writerows(rows)


def is_inside(folder, weld):
    """Whether the plate inside the walls is assessed, told by the first outward vector and the middle of the box."""
    line = next(line for line in model(folder).lines if line.weld == weld)
    middle = np.array([LOW + HIGH, LOW + HIGH, 0.0]) / 2
    return bool(line.outward[1] @ (middle - line.xyz[1]) < 0)


def model(folder):
    """Solve the welds of a folder."""
    return read_model(load_case(folder / "case.toml"), strict=True)


def named_by_side(folder):
    """Give the lines on the plate one name for each of its sides."""
    rows = register_rows(folder)
    for row in rows:
        if row["pid"] == "1":
            row["weld"] = "inner" if is_inside(folder, row["weld"]) else "outer"
    return rows


def stresses(folder, weld):
    """Node, position and stresses of the stations of a weld, part by part from the lower end of the line."""
    found = model(folder)
    at = found.stations.weld == [w.name for w in found.welds].index(weld)
    node, part = found.stations.node[at], found.stations.part[at]
    arrays = [getattr(found.stations.treated, f.name)[at] for f in fields(found.stations.treated)]
    arrays += [found.stations.xyz[at], found.stations.thickness[at], found.stations.arc_length[at]]
    keys = sorted(range(len(node)), key=lambda k: (sorted(node[part == part[k]].tolist()), node[k]))
    return node[keys].tolist(), [array[keys] for array in arrays]


@pytest.mark.parametrize("side", ["inner", "outer"])
def test_joined_at_the_assessment_as_at_the_conversion_and_as_never_cut(both, pieces, side):
    """Elements behind the other line at a corner stay out, those round the corner come in: 1e-12 of the largest."""
    write_register(pieces.out, named_by_side(pieces.out))
    nodes, ours = stresses(pieces.out, side)
    again = replace(
        pieces, out=pieces.out.parent / "again", welds=replace(pieces.welds, register=pieces.out / "welds_register.csv")
    )
    convert(again)
    whole = next(
        w.name
        for w in model(both[1].out).welds
        if "_p1" in w.name and is_inside(both[1].out, w.name) == (side == "inner")
    )
    for folder, weld in ((again.out, side), (both[1].out, whole)):
        others, theirs = stresses(folder, weld)
        assert nodes == others
        for a, b in zip(ours, theirs, strict=True):
            if a.ndim == 1 and folder == both[1].out:
                continue  # arc lengths of parts that another conversion runs the other way round
            assert np.allclose(a, b, rtol=0, atol=1e-12 * np.abs(b).max())
    assert len({w.name for w in model(again.out).welds}) == len(model(pieces.out).welds)


def test_a_joined_weld_is_assessed_and_recounted(pieces, tmp_path):
    """The recount reads the register itself and agrees; the joined weld says whether it is closed."""
    write_register(pieces.out, named_by_side(pieces.out))
    assess(load_case(pieces.out / "case.toml"), tmp_path / "result", threads=1, report=False)
    found = recount(tmp_path / "result", sample=None)
    assert found.passed, found.as_text()
    assert {w.name: w.closed for w in model(pieces.out).welds if "er" in w.name} == dict.fromkeys(
        ("inner", "outer"), len(register_rows(pieces.out)) == 12
    )


def test_lines_turned_and_in_any_order_join_alike(pieces):
    """Nodes of a line in the other order, rows of the register and of the tables in any order: the same weld."""
    rows = named_by_side(pieces.out)
    write_register(pieces.out, rows)
    nodes, before = stresses(pieces.out, "outer")
    table = pieces.out / "weld_nodes.csv"
    head, *lines = table.read_text().splitlines()
    first = lines[0].split(",")[0]
    turned = [
        line.replace(f",{line.split(',')[1]},", f",{100 - int(line.split(',')[1])},", 1)
        if line.split(",")[0] == first or "leg1" in line
        else line
        for line in lines
    ]
    table.write_text("\n".join([head, *turned[::-1]]) + "\n")
    write_register(pieces.out, rows[::-1])
    again, after = stresses(pieces.out, "outer")
    assert nodes == again
    for a, b in zip(before, after, strict=True):
        assert np.allclose(a, b, rtol=0, atol=1e-12 * max(1.0, np.abs(a).max()))
    assert check_case(load_case(pieces.out / "case.toml"), strict=True).welds == 2 + sum(r["pid"] == "2" for r in rows)


def test_a_gap_in_the_plate_at_a_joint_names_the_command(pieces):
    """Elements round the corner that neither line has cannot be known from the tables: refused, never left out."""
    write_register(pieces.out, named_by_side(pieces.out))
    sides = pd.read_csv(pieces.out / "weld_elements.csv")
    outer = [row["line"] for row in register_rows(pieces.out) if row["weld"] == "outer"]
    mesh = pd.read_parquet(pieces.out / "elements.parquet").set_index("element")[["n1", "n2", "n3", "n4"]]
    corner = corner_nodes(len(outer))[0][-1]
    on_line = set(pd.read_csv(pieces.out / "weld_nodes.csv").node)
    only_there = [e for e, nodes in mesh.iterrows() if set(nodes) & on_line == {corner}]
    assert only_there
    sides[~(sides.weld.isin(outer) & sides.element.isin(only_there))].to_csv(
        pieces.out / "weld_elements.csv", index=False
    )
    with pytest.raises(DataError) as caught:
        check_case(load_case(pieces.out / "case.toml"), strict=True)
    (problem,) = caught.value.problems
    assert problem.where == "welds_register.csv: weld outer"
    assert f"join at node {corner} do not make one plate round it" in problem.what
    assert problem.remedy.startswith("Run `fatigue convert --forces ")
    assert f"--register {pieces.out / 'welds_register.csv'} --keep-case`" in problem.remedy


def test_a_weld_converted_as_one_is_not_parted_by_the_tables(pieces):
    """Two names for the lines of one converted weld: the command is named, and does it."""
    rows = named_by_side(pieces.out)
    write_register(pieces.out, rows)
    convert(pieces)
    assert {w.name for w in model(pieces.out).welds} >= {"inner", "outer"}
    again = register_rows(pieces.out)
    next(row for row in again if row["weld"] == "outer")["weld"] = "outer, first"
    write_register(pieces.out, again)
    with pytest.raises(DataError, match=r"were converted as one weld and are to be parted. Run `fatigue convert"):
        model(pieces.out)
    convert(pieces)
    assert {w.name for w in model(pieces.out).welds} >= {"inner", "outer", "outer, first"}


def test_lines_of_one_converted_weld_left_out_together(pieces):
    """Excluded as a whole it needs no conversion; renamed as a whole it is the same weld."""
    rows = named_by_side(pieces.out)
    write_register(pieces.out, rows)
    convert(pieces)
    renamed = [
        row | {"weld": "round", "curve": "master-steel"} if row["weld"] == "outer" else row
        for row in register_rows(pieces.out)
    ]
    write_register(pieces.out, renamed)
    assert "round" in {w.name for w in model(pieces.out).welds if w.curve == "master-steel"}
    write_register(pieces.out, [row | {"status": "excluded"} if row["weld"] == "round" else row for row in renamed])
    assert "round" not in {w.name for w in model(pieces.out).welds}
