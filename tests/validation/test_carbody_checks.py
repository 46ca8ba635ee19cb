"""The shipped car body with checks beside the toe: its files belong together, and the case says what is invented."""

from pathlib import Path

from fatigue.case import load_case
from fatigue.pipeline.solve.body import read_body

FOLDER = Path(__file__).parents[2] / "data" / "carbody"


def test_the_case_with_checks_is_whole():
    """Every curve that throats and points name is there, and only unverified or invented ones."""
    case = load_case(FOLDER / "case_checks.toml")
    body = read_body(case, strict=True)
    status = {name: rated.curve.status for name, rated in body.curves.items() if name != "master-aluminium"}
    assert set(status.values()) == {"user", "unverified"}
    assert all("invented" in case.curves[name].source for name, is_from in status.items() if is_from == "user")
