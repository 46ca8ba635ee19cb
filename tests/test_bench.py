"""Bench programmes of a finished result: against its own tables, and every mistake in one line."""

import json
import shutil
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pandas as pd
import pyarrow.parquet as pq
import pytest

from fatigue.assess import assess
from fatigue.bench import bench, mean_stress_warnings
from fatigue.case import load_case
from fatigue.decide import bench_points
from fatigue.decide.bench_files import read_points
from fatigue.errors import DataError
from fatigue.life.curves import catalogue, damage_law
from fatigue.results import read_provenance, read_table, strangers
from tests.small_case import BENDING, MEMBRANE, THICKNESS, sine_only, small_case

POINTS = "weld,order,surface,factor\nA,2,top,1\nA,3,bottom,0.5\nB,4,top,2\n"
BLOCKS = "block,q_1,q_2,q_7\none,100,,\ntwo,0,100,0\nmix,80,-80,10\nnone of it,1e-9,0,0\n"


def text(path, content):
    """Write a file; return its path."""
    path.write_text(content, encoding="utf-8")
    return path


@pytest.fixture
def folder(small_result, tmp_path):
    """A copy of the result of the small case."""
    return shutil.copytree(small_result, tmp_path / "result")


def run(folder, points=POINTS, blocks=BLOCKS):
    """Bench programme of texts."""
    return bench(folder, text(folder.parent / "points.csv", points), text(folder.parent / "blocks.csv", blocks))


def test_a_sine_takes_the_cycles_that_the_mission_has(tmp_path):
    """The block of the mission's own range: as many cycles as there are to the target, at every point alike."""
    case = sine_only()
    assess(load_case(case.write(tmp_path / "case")), tmp_path / "result", threads=1, report=False)
    found = run(tmp_path / "result", "weld,order,surface\nA,2,top\nA,5,bottom\nB,1,top\n", "q_1\n60\n")
    cycles = 1e6 / (180.0 / 3600.0 / 5.0)
    for programme in found.programmes:
        assert programme.cycles == pytest.approx([cycles], rel=1e-9)
        assert programme.achieved == pytest.approx(1.0, rel=1e-9)
    assert found.cycles.range[:, 0] == pytest.approx(
        60.0 * np.array([MEMBRANE + BENDING, MEMBRANE - BENDING, MEMBRANE + BENDING])
    )
    assert found.cycles.bending_ratio == pytest.approx(BENDING / (MEMBRANE + BENDING))
    curve = catalogue()["master-aluminium"]
    law = damage_law(curve, "mean-2sigma", "none", 1e7)
    damage = found.cycles.equivalent_range ** law.slopes[0] / np.exp(law.log_constants[0])
    np.testing.assert_allclose(found.cycles.damage, damage, rtol=1e-12)
    r = BENDING / (MEMBRANE + BENDING)
    I = (1.23 - 0.364 * r - 0.17 * r**2) / (1.007 - 0.306 * r - 0.178 * r**2)  # noqa: E741
    assert found.cycles.equivalent_range[0] == pytest.approx(90.0 * THICKNESS ** (1.6 / 7.2) / I, rel=1e-9)


def test_three_blocks_at_three_points_meet_the_targets_of_the_result(folder):
    """Targets are damage_per_km x target_km x factor; the tables say what was found and belong to the result."""
    found = run(folder)
    nodes = read_table(folder, "nodes").to_pandas().set_index(["weld", "order", "surface"]).damage_per_km
    expected = 1e6 * np.array([nodes["A", 2, "top"], 0.5 * nodes["A", 3, "bottom"], 2.0 * nodes["B", 4, "top"]])
    np.testing.assert_allclose(found.points.target, expected, rtol=1e-12)
    for programme in found.programmes:
        np.testing.assert_allclose(programme.achieved, 1.0, rtol=1e-9)
        assert found.unused(programme) == ["none of it"]
    blocks, points, damage = (
        read_table(folder, f"bench_{name}").to_pandas() for name in ("blocks", "points", "damage")
    )
    record = read_provenance(folder)
    assert not strangers(folder, record)
    assert {"bench_blocks.parquet", "bench_points.parquet"} <= {entry["file"] for entry in record["outputs"]}
    for method in ("least_squares", "cover"):
        n = blocks[blocks.method == method].set_index("block").whole_cycles
        done = (
            damage.assign(done=damage.damage_per_cycle * damage.block.map(n))
            .groupby(["weld", "order", "surface"])
            .done.sum()
        )
        of_method = points[points.method == method].set_index(["weld", "order", "surface"])
        achieved = done / of_method.target_damage
        np.testing.assert_allclose(achieved[of_method.index], of_method.achieved_over_target_whole, rtol=1e-12)
    for name in ("bench_blocks", "bench_points", "bench_damage"):
        assert all(field.metadata[b"description"] for field in pq.read_schema(folder / f"{name}.parquet"))


def test_stress_of_unit_loads(folder):
    """A table of stresses with a column unit_load: each load is one more coordinate, its unit that of the case."""
    path = folder / "structural_stress.parquet"
    stress = pd.read_parquet(path)
    load = stress[stress["mode"] == 2].assign(mode=pd.NA, unit_load="jack", membrane_MPa=2.0, bending_MPa=-1.0)
    both = pd.concat([stress.assign(unit_load=None), load]).sort_values(["weld", "part", "order"], kind="stable")
    both.astype({"mode": "Int64"}).to_parquet(path)
    record = read_provenance(folder)
    record["case_text"] = record["case_text"].replace(
        "[curve]", '[[body.unit_load]]\nname = "jack"\nunit = "kN"\n[curve]'
    )
    units = bench_points.units_of_coordinates(record)
    assert units == {"u_jack": "kN", "q_1": "", "q_2": "", "q_7": ""}
    wanted, _ = bench_points_of(folder.parent, POINTS)
    points = bench_points.points_of_result(folder, record, wanted)
    membrane, bending = bench_points.unit_stress(folder, points, ["u_jack", "q_1"])
    np.testing.assert_array_equal(membrane[:, 0], 2.0)
    np.testing.assert_array_equal(bending[:, 0], -1.0)
    assert membrane[:, 1] == pytest.approx(MEMBRANE)


def bench_points_of(folder, content):
    """Points of a text."""
    return read_points(text(folder / "points.csv", content))


def test_worst_points(folder):
    """Those of the register of welds, by name."""
    found = bench(folder, "worst", text(folder.parent / "blocks.csv", BLOCKS))
    welds = read_table(folder, "welds").to_pandas().set_index("weld")
    for row in found.points.key.itertuples():
        assert (row.part, row.order, row.surface) == tuple(
            welds.loc[row.weld, ["worst_part", "worst_order", "worst_surface"]]
        )
    assert set(found.points.key.weld) == {"A", "B"}


def test_by_node_and_with_a_register_of_units(folder):
    """A node in place of the position is the same point; several programmes replace each other."""
    first = run(folder)
    by_node = "weld,node,surface,factor\n" + "\n".join(
        f"{row.weld},{row.node},{row.surface},{factor}"
        for row, factor in zip(first.points.key.itertuples(), first.points.factor, strict=True)
    )
    again = run(folder, by_node)
    assert again.as_record() == first.as_record()
    assert len(read_table(folder, "bench_points")) == 2 * 3


def test_mean_stress_is_told(folder):
    """Targets with f_M, blocks without: one warning."""
    record = read_provenance(folder)
    assert not list(mean_stress_warnings(record))
    record["rules"]["mean_stress"] = "asme"
    (problem,) = mean_stress_warnings(record)
    assert problem.code == "bench_mean_stress"


MISTAKES = {
    "unknown weld": (
        "weld,order,surface\nAA,2,top\n",
        None,
        "points.csv: row 1: the result has no weld 'AA' that was assessed. Write 'A'",
    ),
    "unknown order": (
        "weld,order,surface\nA,99,top\n",
        None,
        "row 1: weld 'A' has no point at order 99. Give one of its orders, 1 to 7",
    ),
    "unknown node": (
        "weld,node,surface\nA,9,top\n",
        None,
        "row 1: weld 'A' has no point at node 9. Give one of its nodes, 100 to 106",
    ),
    "unknown part": ("weld,order,surface,part\nA,2,top,3\n", None, "has no point at order 2 of part 3"),
    "face": ("weld,order,surface\nA,2,left\n", None, "column surface, row 1: 'left' is not one of top, bottom"),
    "twice": ("weld,order,surface\nA,2,top\nA,2,top\n", None, "row 2: asks for the point of points.csv: row 1 again"),
    "negative factor": ("weld,order,surface,factor\nA,2,top,-1\n", None, "column factor, row 1: -1 is not above 0"),
    "zero factor": ("weld,order,surface,factor\nA,2,top,0\n", None, "column factor, row 1: 0 is not above 0"),
    "no weld column": ("name,order,surface\nA,2,top\n", None, "column weld: the column is missing"),
    "no place": ("weld,surface\nA,top\n", None, "column order: the column is missing"),
    "no load": (
        None,
        "block\none\n",
        "blocks.csv: there is no column of a load. Give the ranges of some of q_1, q_2, q_7",
    ),
    "unknown load": (
        None,
        "u_jack\n1\n",
        "column u_jack: the result has no unit load of this name. Name one of q_1, q_2, q_7",
    ),
    "unknown mode": (None, "q_3\n1\n", "column q_3: the result has no mode of this name"),
    "unit": (
        None,
        "q_1 [kN]\n1\n",
        r"column q_1 [kN]: the unit is 'kN', and the forces of the result are per 1 of the mode. Remove the unit",
    ),
    "two columns": (None, "q_1,q_1 []\n1,1\n", "the load has another column, q_1"),
    "no number": (None, "q_1\nx\n", "column q_1, row 1: 'x' is not a number"),
    "infinite": (None, "q_1\ninf\n", "column q_1, row 1: inf is not finite"),
    "same block": (
        None,
        "block,q_1,q_2\na,1,2\nb,3,1\nc,1,2\n",
        "row 3: block 'c' is block 'a' again. Keep one of the rows",
    ),
    "counter-phase": (None, "q_1,q_2\n1,-2\n-1,2\n", "row 2: block '2' is block '1' again"),
    "same name": (None, "block,q_1\na,1\na,2\n", "row 2: block 'a' has the name of row 1"),
    "at rest": (None, "block,q_1\na,1\nb,0\n", "row 2: all ranges of block 'b' are 0"),
    "not reached": (
        None,
        "q_7\n1e-9\n",
        "no block does damage there that would reach the target within 1e+12 cycles. Add a block",
    ),
}


@pytest.mark.parametrize("mistake", MISTAKES)
def test_mistakes(folder, mistake):
    """One clear line, and the result stays as it is."""
    points, blocks, said = MISTAKES[mistake]
    with pytest.raises(DataError) as caught:
        run(folder, points or POINTS, blocks or BLOCKS)
    assert said in str(caught.value)
    assert len(caught.value.problems) == 1
    assert not list(folder.glob("bench_*"))


def test_points_without_damage_and_with_bounds(tmp_path):
    """Neither gives a target; both are named."""
    case = small_case()
    case.histories["sine"]["q_1"] = case.histories["noise"][["q_1", "q_2", "q_7"]] = 0.0
    case.events = case.events[:2]
    case.counting["upsample"] = 1
    assess(load_case(case.write(tmp_path / "case")), tmp_path / "result", threads=1, report=False)
    with pytest.raises(DataError, match="nothing damages the point, so that there is no target"):
        run(tmp_path / "result")
    with pytest.raises(DataError, match="nothing damages any weld of the result"):
        bench(tmp_path / "result", "worst", text(tmp_path / "blocks.csv", BLOCKS))


def test_a_bound_is_no_target(folder):
    """Points that were not counted are refused together, with the way out."""
    record = read_provenance(folder)
    wanted, _ = bench_points_of(folder.parent, POINTS)
    nodes = pd.read_parquet(folder / "nodes.parquet")
    nodes.assign(screened="modal bound").to_parquet(folder / "nodes.parquet")
    with pytest.raises(DataError, match=r"a bound stands for its damage.*--exact") as caught:
        bench_points.points_of_result(folder, record, wanted)
    assert caught.value.problems[0].count == 3


def test_a_corner_has_two_points_at_a_place(folder):
    """The part tells them apart, and the refusal says so."""
    nodes = pd.read_parquet(folder / "nodes.parquet")
    twin = nodes[nodes.weld == "A"].assign(part=2)
    pd.concat([nodes, twin]).to_parquet(folder / "nodes.parquet")
    wanted, _ = bench_points_of(folder.parent, "weld,order,surface\nA,2,top\n")
    with pytest.raises(
        DataError, match=r"has 2 points at order 2, parts 1, 2, orders 2\. Give the column part as well"
    ):
        bench_points.points_of_result(folder, read_provenance(folder), wanted)
    found = bench_points.points_of_result(folder, read_provenance(folder), [replace(wanted[0], part=2)])
    assert found.key.part.tolist() == [2]


def test_a_file_of_somebody_else_is_not_overwritten(folder):
    """A sound table of that name that fatigue did not write."""
    pd.DataFrame({"a": [1]}).to_parquet(folder / "bench_blocks.parquet")
    with pytest.raises(DataError, match=r"bench_blocks\.parquet: is there already and was not written by fatigue"):
        run(folder)


def test_on_the_command_line(folder):
    """Text, JSON, CSV by the report, and the exit code of a mistake."""
    points, blocks = text(folder.parent / "p.csv", POINTS), text(folder.parent / "b.csv", BLOCKS)

    def fatigue(*arguments):
        command = [sys.executable, "-m", "fatigue", "-q", *map(str, arguments)]
        return subprocess.run(command, capture_output=True, text=True, check=False)

    told = fatigue("bench", folder, "--points", points, "--blocks", blocks)
    assert told.returncode == 0, told.stderr
    for part in (
        "least squares: closest to all targets",
        "cover: every target reached",
        "q_1 80, q_2 -80, q_7 10",
        "not used: none of it",
    ):
        assert part in told.stdout
    record = json.loads(fatigue("bench", folder, "--points", points, "--blocks", blocks, "--json").stdout)
    assert [one["method"] for one in record["programmes"]] == ["least_squares", "cover"]
    assert fatigue("report", folder, "--csv").returncode == 0
    assert (folder / "bench_blocks.csv").exists()
    wrong = fatigue("bench", folder, "--points", folder.parent / "none.csv", "--blocks", blocks)
    assert wrong.returncode == 3
    assert wrong.stderr.count("\n") == 1
