"""The story of an analysis graph: tables, page and record; map and lines agree; nothing foreign is overwritten."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
import pytest
from click.testing import CliRunner

from fatigue.cli import cli
from fatigue.cli.commands.study import SETTINGS as OFFERED
from fatigue.errors import CaseError, DataError
from fatigue.results.dictionary.graph import GRAPH
from fatigue.study.graph.asked import Asked
from fatigue.study.graph.stability import least_damped
from fatigue.study.graph.story import graph
from fatigue.vehicle.definition import SETTINGS
from fatigue.vehicle.roots import is_stable, roots
from tests.vehicle_oracles import trailer

SHIPPED = Path("data/vehicle/vehicle.toml")
FEW = Asked(np.array([150.0, 350.0, 550.0]), np.geomspace(0.02, 1.0, 5), (), (0.3,))


@pytest.fixture(scope="module")
def out(tmp_path_factory):
    """Folder of a graph of two settings with few points, and what it says."""
    folder = tmp_path_factory.mktemp("graph")
    return folder, graph([SHIPPED], ["hard", "soft"], asked=FEW, into=folder, csv=True)


def table(folder, name):
    """Rows of a table as dictionaries."""
    return pq.read_table(folder / f"{name}.parquet").to_pylist()


def test_tables_are_as_the_dictionary_says(out):
    """Every column stands with its unit and meaning, as Parquet and as CSV."""
    folder, _ = out
    for name, columns in GRAPH.items():
        found = pq.read_table(folder / f"{name}.parquet")
        assert found.column_names == [column.name for column in columns]
        assert [field.metadata[b"unit"].decode() for field in found.schema] == [column.unit for column in columns]
        lines = (folder / f"{name}.csv").read_text(encoding="utf-8").splitlines()
        assert len(lines) == found.num_rows + 1 > 1


def test_the_map_is_that_of_all_roots(out):
    """Stability is that of all roots; the damping shown is below zero where they grow, and of a root of the vehicle."""
    folder, _ = out
    rows = table(folder, "stability")
    assert len(rows) == 2 * 3 * 5
    for row in rows:
        vehicle = trailer(row["vehicle"]).at(row["speed_km_h"], row["conicity"])
        assert row["stable"] == is_stable(vehicle) == (row["damping"] > 0.0)
        dampings = [root.damping for root in roots(vehicle, 40.0)]
        assert min(abs(row["damping"] - damping) for damping in dampings) < 1e-9
        if not row["stable"]:
            assert row["damping"] == pytest.approx(min(dampings), abs=1e-9)


def test_crossings_lie_between_a_stable_and_an_unstable_side(out):
    """On either side of every critical value the vehicle is what the row says, and its root is undamped there."""
    folder, _ = out
    rows = table(folder, "critical")
    assert {row["along"] for row in rows} == {"conicity", "speed"}
    for row in rows:
        assert abs(row["damping"]) < 1e-6
        for factor, stable in ((1 - 1e-4, row["change"] == "loses"), (1 + 1e-4, row["change"] == "gains")):
            at = {"speed_km_h": row["speed_km_h"], "conicity": row["conicity"]}
            at["conicity" if row["along"] == "conicity" else "speed_km_h"] *= factor
            assert is_stable(trailer(row["vehicle"]).at(at["speed_km_h"], at["conicity"])) == stable


def test_roots_of_a_line_are_all_roots_and_shares_are_whole(out):
    """At every place of every line all roots up to 25 Hz are rows, once, and their shares of energy sum to 1."""
    folder, _ = out
    rows = [row for row in table(folder, "roots") if row["vehicle"] == "hard" and row["along"] == "conicity"]
    for conicity in FEW.conicities:
        here = [row for row in rows if row["conicity"] == conicity]
        expected = [root.frequency_hz for root in roots(trailer("hard").at(350.0, float(conicity)))]
        assert sorted(row["frequency_hz"] for row in here) == pytest.approx(sorted(expected))
        assert len({row["locus"] for row in here}) == len(here)
    shares = [sum(value for key, value in row.items() if key.startswith("share_")) for row in rows]
    assert shares == pytest.approx([1.0] * len(rows))
    assert all(row["stable"] == (row["damping"] > 0.0) for row in rows)


def test_the_same_command_gives_the_same_bytes(out, tmp_path):
    """Tables, page and record do not depend on when or where they are written."""
    folder, _ = out
    graph([SHIPPED], ["hard", "soft"], asked=FEW, into=tmp_path / "again", csv=True)
    for path in sorted(folder.iterdir()):
        assert path.read_bytes() == (tmp_path / "again" / path.name).read_bytes()


def test_nothing_foreign_is_overwritten(out):
    """A page that was changed since, or is somebody else's, stays; ``force`` takes it."""
    folder, _ = out
    page = folder / "graph.html"
    kept = page.read_bytes()
    page.write_text("mine", encoding="utf-8")
    with pytest.raises(DataError, match=r"graph\.html: is there already"):
        graph([SHIPPED], ["hard", "soft"], asked=FEW, into=folder)
    assert page.read_text(encoding="utf-8") == "mine"
    page.write_bytes(kept)


def test_the_page_needs_nothing_and_says_what_it_is(out):
    """Every vehicle has its section and figures; nothing is loaded, no claim of validation is made."""
    folder, answer = out
    page = (folder / "graph.html").read_text(encoding="utf-8")
    plain = page.split('<script type="text/plain"')[0]
    assert "https://" not in plain
    assert plain.count("validation of the paper") == 1
    for name in ("boundaries", "v1-map", "v2-map", "v1-plane-conicity", "v1-over-speed", "v1-energy"):
        assert f'id="json-{name}"' in plain
    assert {"critical.parquet", "graph.html", "graph.json"} <= {Path(path).name for path in answer.written}
    record = json.loads((folder / "graph.json").read_text(encoding="utf-8"))
    assert list(record["vehicles"]) == ["hard", "soft"]
    assert record["vehicles"]["soft"]["vehicle"]["suspension.setting"] == "soft"
    assert set(record["outputs"]) == {path.name for path in folder.iterdir()} - {"graph.json"}


def test_mistakes_of_all_vehicles_are_told_once(tmp_path):
    """Two files with a mistake each are refused with both; a mistake is told once for several settings."""
    for name in ("a", "b"):
        (tmp_path / f"{name}.toml").write_text("[run]\nspeed_km_h = -1\n", encoding="utf-8")
    with pytest.raises(CaseError) as error:
        graph([tmp_path / "a.toml", tmp_path / "b.toml"], ["hard", "soft"])
    assert [problem.where for problem in error.value.problems] == ["a.toml: run.speed_km_h", "b.toml: run.speed_km_h"]


def test_a_root_that_grows_without_swinging_is_unstable():
    """Its damping is -1: a vehicle that falls over is no stable one."""
    of = trailer("hard").at(350.0, 0.1)
    A = of.A.copy()
    A[-1, -1] = 5.0  # a yaw damper that runs away
    damping, _, stable, _ = least_damped(replace(of, A=A))
    assert not stable
    assert damping == pytest.approx(-1.0, abs=0.1)


@pytest.mark.parametrize(
    "arguments",
    [
        ["--speeds", "5"],
        ["--speeds", "200:100"],
        ["--conicities", "0.1,0.05"],
        ["--csv"],
        ["--setting", "softer"],
        ["--at-speed", "0"],
    ],
)
def test_wrong_usage_is_refused_before_anything_is_read(arguments):
    """Exit code 2, and the option in the message."""
    done = CliRunner().invoke(cli, ["study", "graph", "nowhere.toml", *arguments])
    assert done.exit_code == 2
    assert arguments[0] in done.output


def test_the_command_prints_ranges_and_json(tmp_path):
    """People get a line for each line of the graph, machines the record; settings offered are those there are."""
    few = ["--speeds", "300,350", "--conicities", "0.05:1.0:0.19", "--at-conicity", "0.1", "--at-speed", "350"]
    said = CliRunner().invoke(cli, ["-q", "study", "graph", str(SHIPPED), *few])
    assert said.exit_code == 0, said.output
    assert "at 350 km/h" in said.output
    assert "0.0825 (1.70 Hz) to 0.709 (7.78 Hz)" in said.output
    told = CliRunner().invoke(cli, ["-q", "study", "graph", str(SHIPPED), *few, "--json", "-o", str(tmp_path / "g")])
    record = json.loads(told.output)
    numbers = record["vehicles"]["vehicle"]["numbers"]
    assert numbers["conicity_max"]["value"] == pytest.approx(0.70876, rel=1e-4)
    assert tuple(SETTINGS) == OFFERED
