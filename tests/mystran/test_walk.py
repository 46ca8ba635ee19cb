"""The README's way from NASTRAN decks on the command line: modes and unit loads of a model, to report and workbook."""

import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from fatigue.errors import DataError
from fatigue.report.files.browser import find_browser
from tests.command_line import fatigue
from tests.mystran import plates as joints
from tests.mystran.chain import chain, waves_file
from tests.mystran.decks import plain
from tests.mystran.solver import needs_mystran

pytestmark = needs_mystran

UNITS = "m-kg-s"
UNIT_LOADS, NORMAL = (101, 102), (1, 2, 3, 4, 5, 6)


@dataclass(frozen=True)
class Walk:
    """Folder, output of the conversion, and the chains of the two runs by themselves."""

    folder: Path
    said: str
    static: object
    modal: object

    @property
    def result(self):
        """Result folder."""
        return self.folder / "result"


@pytest.fixture(scope="module")
def walk(tmp_path_factory):
    """A bracket: the unit loads of a static run are interface modes beside the normal modes of another."""
    folder = tmp_path_factory.mktemp("walk")
    model = joints.bracket(np.random.default_rng(8))
    static = chain(plain(model, 101, units=UNITS, first_subcase=101), folder, "static", modes=UNIT_LOADS)
    modal = chain(plain(model, 103, units=UNITS), folder, "modal")
    waves = waves_file(folder / "q.csv", [*NORMAL, *UNIT_LOADS], 1e-3)
    table = pd.read_csv(waves)
    table[[f"q_{m}" for m in UNIT_LOADS]] *= 1e3
    table.to_csv(waves, index=False)
    done = fatigue(
        "convert", "--mesh", modal.mesh, "--forces", modal.op2, "--unit-loads", static.op2,
        "--coordinates", waves, "--units", UNITS, "-o", folder / "body",
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assessed = fatigue("assess", folder / "body" / "case.toml", "-o", folder / "result", "--exit-zero")
    assert assessed.returncode == 0, assessed.stderr
    return Walk(folder, done.stdout, static, modal)


def test_audit_of_modes_and_unit_loads(walk):
    """Nothing is red, the sign is proven, the interface modes are counted, all lines are assessed."""
    assert "red" not in {line.split()[0] for line in walk.said.splitlines()}
    assert "green  interface modes: 2 2 of 8 modes are interface modes" in walk.said
    assert "forces on_element" in walk.said
    kinds = pd.read_csv(walk.folder / "body" / "modes.csv").set_index("mode").kind
    assert kinds.to_dict() == dict.fromkeys(NORMAL, "normal") | dict.fromkeys(UNIT_LOADS, "interface")


def test_every_mode_has_the_stress_of_its_own_run(walk):
    """Unit loads are not scaled with the modal coordinates of other units, modes are."""
    table = pd.read_parquet(walk.result / "structural_stress.parquet")
    columns = ["weld", "order", "mode", "membrane_MPa", "bending_MPa"]
    own = pd.concat([walk.static.stress(), walk.modal.stress()])
    for ours, theirs in zip(
        *(t[columns].sort_values(columns[:3]).itertuples(index=False) for t in (table, own)), strict=True
    ):
        assert ours[:3] == theirs[:3]
        assert ours[3:] == pytest.approx(theirs[3:], rel=1e-5, abs=1e-9 + 1e-5 * abs(theirs[3]) + 1e-5 * abs(theirs[4]))


def test_report_workbook_and_tables_hold_the_welds(walk):
    """What is written can be read and names every weld."""
    done = fatigue("report", walk.result, "--xlsx", "--csv")
    assert done.returncode == 0, done.stderr
    welds = pd.read_parquet(walk.result / "welds.parquet").weld
    page = (walk.result / "report.html").read_text()
    assert all(weld in page for weld in welds)
    assert "MYSTRAN" in page or "inertia forces" in page  # the audit's amber light
    assert (walk.result / "nodes.xlsx").stat().st_size > 10_000
    record = json.loads((walk.result / "provenance.json").read_text())
    assert {row["light"] for row in record["conversion"]["audit"]} == {"green", "amber"}


@pytest.mark.browser
def test_report_prints(walk):
    """The page becomes a PDF."""
    try:
        find_browser()
    except DataError as error:
        pytest.skip(str(error))
    done = fatigue("report", walk.result, "--pdf", "--force")
    assert done.returncode == 0, done.stderr
    assert (walk.result / "report.pdf").read_bytes().startswith(b"%PDF")
