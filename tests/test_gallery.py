"""The gallery: every program gives its number, from elsewhere, and makes the picture that is beside it."""

from importlib import import_module
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
NUMBERS = {  # program: its number by a closed form or from the publication
    "bending_ratio": (1.23 / 1.007) / ((1.23 - 0.364 - 0.17) / (1.007 - 0.306 - 0.178)),
    "slopes_of_joints": 3.0293239,
    "knee": 0.5 ** (1 / 0.27712 - 1),
    "rainflow_of_a_beat": 1.0,
    "white_band": 1.73862875 / 2.17080376,
}


@pytest.mark.parametrize("name", NUMBERS)
def test_number_and_picture(name, tmp_path):
    """The number is what it should be; the picture is the one that the page shows; the page tells the number."""
    program = import_module(f"examples.gallery.{name}")
    tolerance = 3e-4 if name == "rainflow_of_a_beat" else 1e-6  # tones whose peaks meet between samples
    assert program.number() == pytest.approx(NUMBERS[name], rel=tolerance)
    program.picture(tmp_path / "made.svg")
    assert (tmp_path / "made.svg").read_text() == (ROOT / "examples" / "gallery" / f"{name}.svg").read_text()
    page = (ROOT / "docs" / "gallery.md").read_text(encoding="utf-8")
    assert f"[{name}.py](../examples/gallery/{name}.py): {program.number():.3g}" in page


def test_every_program_is_shown():
    """No program stands beside the gallery without a number."""
    assert {path.stem for path in (ROOT / "examples" / "gallery").glob("*.py")} - {"drawing"} == set(NUMBERS)
