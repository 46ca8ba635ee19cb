"""Rows of the audit that the docs quote are those of a T joint with each mistake made on purpose."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fatigue.errors import DataError
from fatigue.readers.convert.audit.audit import audit
from fatigue.readers.convert.convert import convert
from fatigue.readers.convert.options import ConvertOptions
from fatigue.readers.foreign.nastran.deck.bdf import read_bdf
from tests.readers.op2_writer import modal_op2
from tests.readers.tee_model import bulk, tee

DOCS = Path("docs")


@pytest.fixture(scope="module")
def joint(tmp_path_factory):
    """Results and mesh of the T joint."""
    path = tmp_path_factory.mktemp("tee") / "tee.bdf"
    path.write_text(bulk(tee()))
    return tee().results, read_bdf(path)


def without_shapes(results, model):
    """No DISPLACEMENT in the run."""
    return {"results": replace(results, shape_node=results.shape_node[:0], shape=results.shape[:, :0]), "model": model}


def wrong_convention(results, model):
    """Stated against the work of the forces."""
    return {"results": results, "model": model, "stated": "on_element"}


def other_order(results, model):
    """Shapes of modes 3 and 4 changed places."""
    return {"results": replace(results, shape=results.shape[[0, 1, 3, 2, 4]]), "model": model}


def scaled_shapes(results, model):
    """Shapes of another scale than the forces."""
    return {"results": replace(results, shape=2 * results.shape), "model": model}


def without_frames(results, model):
    """A deck that lacks the displacement frames."""
    plain = replace(model, frame_node=np.empty(0, np.int64), frame=np.empty((0, 3, 3)))
    return {"results": results, "model": plain}


def other_mesh(results, model):
    """An element that the deck lacks."""
    return {"results": replace(results, element=np.where(results.element == 3, 999, results.element)), "model": model}


def part(results, model):
    """Forces of some elements only."""
    keep = results.element <= 50
    own = {name: getattr(results, name)[keep] for name in ("node", "element", "kind")}
    return {"results": replace(results, **own, force=results.force[:, keep]), "model": model}


def other_modes(results, model):
    """A simulation of other frequencies."""
    return {"results": results, "model": model, "simulated": {1: 1.0}}


def sound(results, model):
    """All as it should be, but no interface mode named."""
    return {"results": results, "model": model}


MISTAKES = [
    (without_shapes, "sign", "amber", ["nastran"]),
    (wrong_convention, "sign", "red", ["nastran"]),
    (other_order, "sign", "red", ["nastran"]),
    (scaled_shapes, "sign", "red", ["nastran"]),
    (without_frames, "element balance", "red", ["nastran"]),
    (other_mesh, "completeness", "red", ["nastran"]),
    (part, "completeness", "amber", ["nastran"]),
    (sound, "interface modes", "amber", ["nastran", "adams", "simpack"]),
    (other_modes, "frequency match", "red", ["nastran", "adams", "simpack"]),
]


@pytest.mark.parametrize(
    ("mistake", "check", "light", "pages"), MISTAKES, ids=lambda value: getattr(value, "__name__", "")
)
def test_rows_are_quoted_as_they_are(joint, mistake, check, light, pages):
    """Light, check and finding."""
    row = next(row for row in audit(**mistake(*joint)).rows if row.check == check)
    assert row.light == light
    finding = row.finding.removesuffix(", worst of 1")
    for page in pages:
        assert f"{light} `{check}: {finding}" in (DOCS / f"{page}.md").read_text(encoding="utf-8"), page


def test_a_mode_without_coordinates_is_quoted(tmp_path):
    """As where the simulation deselects it."""
    (tmp_path / "tee.bdf").write_text(bulk(tee()))
    (tmp_path / "tee.op2").write_bytes(modal_op2(tee().results, word=8))
    rows = "".join(f"{0.01 * k},1,2,3,4\n" for k in range(9))
    (tmp_path / "q.csv").write_text("time,q_1,q_2,q_3,q_4\n" + rows)
    options = ConvertOptions(
        forces=tmp_path / "tee.op2",
        mesh=tmp_path / "tee.bdf",
        out=tmp_path / "body",
        coordinates=(tmp_path / "q.csv",),
    )
    with pytest.raises(DataError) as caught:
        convert(options)
    problem = caught.value.problems[0]
    for page in ("nastran", "adams", "simpack"):
        assert f"`{problem.what}. {problem.remedy}.`" in (DOCS / f"{page}.md").read_text(encoding="utf-8"), page
