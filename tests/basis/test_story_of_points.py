"""A case with shapes and a static solution, and another one beside it: findings, tables and page from files."""

import json

import numpy as np
import pandas as pd
import pytest

from fatigue.basis.story import basis
from fatigue.errors import DataError
from fatigue.results.dictionary.basis import BASIS
from tests.basis.loaded_beam import POINTS, flexibility_table, loaded_beam, shapes_table
from tests.command_line import fatigue
from tests.free_beam import free_beam
from tests.small_case import small_case

BEAM = free_beam()
DOF = list(POINTS.values())


def beam_case(folder, basis_of_beam):
    """The welds of the small case on the beam, whose elastic modes make its stress; with files of loaded points."""
    loaded, case = loaded_beam(BEAM, basis_of_beam), small_case(seconds=3.0)
    modes = loaded.modes
    case.modes = pd.DataFrame({"mode": modes.mode, "frequency_hz": modes.frequency, "kind": modes.kind})
    forces = case.nodal_forces[case.nodal_forces["mode"] == 1]
    scale = np.where(modes.frequency > 0.0, 1.0, 0.0)
    columns = ["fx_N", "fy_N", "fz_N", "mx_Nmm", "my_Nmm", "mz_Nmm"]
    of_modes = [forces.assign(mode=mode, **(forces[columns] * s)) for mode, s in zip(modes.mode, scale, strict=True)]
    case.nodal_forces = pd.concat(of_modes, ignore_index=True)
    case.histories = {
        name: pd.DataFrame({"time_s": table["time_s"]} | {f"q_{mode}": table["q_1"] / mode for mode in modes.mode})
        for name, table in case.histories.items()
    }
    case.body = {"interface_shapes": "shapes.csv", "flexibility": "static.csv"}
    path = case.write(folder)
    shapes_table(loaded).to_csv(folder / "shapes.csv", index=False)
    flexibility_table(loaded).to_csv(folder / "static.csv", index=False)
    return path


@pytest.fixture(scope="module")
def cases(tmp_path_factory):
    """Case files of a strong and of a weak basis of the beam."""
    folder = tmp_path_factory.mktemp("beam")
    strong = beam_case(folder / "strong", BEAM.with_residual(4, DOF))
    return strong, beam_case(folder / "weak", BEAM.with_residual(4, [0, 20]))


def test_every_question_of_two_cases(cases, tmp_path):
    """All tables are written as the dictionary has them; ratio 1 to 1e-9 comes through files to the table."""
    done = fatigue("basis", *cases, "-o", tmp_path / "out", "--json")
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)["findings"]
    for table in (
        "flexibility",
        "interface",
        "truncation",
        "bases",
        "bases_content",
        "bases_modes",
        "bases_flexibility",
    ):
        written = pd.read_parquet(tmp_path / "out" / f"{table}.parquet")
        assert list(written.columns) == [column.name for column in BASIS[table]]
        assert len(written) == len(found[table]["rows"]) > 0
    ratio = pd.read_parquet(tmp_path / "out" / "flexibility.parquet")["ratio"]
    np.testing.assert_allclose(ratio, 1.0, rtol=1e-9)
    between = pd.read_parquet(tmp_path / "out" / "bases_flexibility.parquet").set_index(["point", "direction"])["ratio"]
    np.testing.assert_allclose(between["left end", "z"], 1.0, rtol=1e-9)
    assert between["left end", "ry"] < 0.99
    interface = pd.read_parquet(tmp_path / "out" / "interface.parquet").set_index("point")
    assert interface.loc["left end", ["independent", "complete"]].tolist() == [2, True]
    page = (tmp_path / "out" / "basis.html").read_text(encoding="utf-8")
    assert "Shortest life of each weld without some modes" in page
    assert "No verdict about a design follows from it" in page


def test_a_mistake_in_either_file_is_refused_with_its_place(cases, tmp_path):
    """One line, and nothing is written."""
    folder = cases[0].parent
    table = pd.read_csv(folder / "static.csv")
    table.assign(direction="up").to_csv(folder / "bad.csv", index=False)
    case = cases[0].read_text(encoding="utf-8").replace("static.csv", "bad.csv")
    (folder / "bad.toml").write_text(case, encoding="utf-8")
    with pytest.raises(DataError, match=r"bad\.csv.*'up' is not one of x, y, z, rx, ry, rz"):
        basis(folder / "bad.toml", into=tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_a_static_solution_in_other_units_is_one_warning(cases):
    """Metres in place of millimetres: all directions, one warning."""
    folder = cases[0].parent
    table = pd.read_csv(folder / "static.csv")
    table.assign(value_mm_per_N=table["value_mm_per_N"] / 1000.0).to_csv(folder / "metres.csv", index=False)
    case = cases[0].read_text(encoding="utf-8").replace("static.csv", "metres.csv")
    (folder / "metres.toml").write_text(case, encoding="utf-8")
    warnings = [problem for problem in basis(folder / "metres.toml").warnings if problem.code == "soft_basis"]
    assert [(problem.count, problem.where) for problem in warnings] == [(4, "metres.csv")]
    assert "1000 times" in warnings[0].what


def test_without_damage(cases):
    """Damage without the highest modes is left out; two bases are compared all the same."""
    alone = [finding.table for finding in basis(cases[0], damage=False).findings]
    assert "truncation" not in alone
    assert "flexibility" in alone
    both = [finding.table for finding in basis(*cases, damage=False).findings]
    assert both[: len(alone)] == alone
    assert "bases" in both
    assert "truncation" not in both
