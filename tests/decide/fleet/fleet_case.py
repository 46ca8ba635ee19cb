"""A small fleet: two results of one body, and the fleet file and distances of the docs."""

import re
from pathlib import Path

from fatigue.assess import assess
from fatigue.case import load_case
from tests.small_case import SmallCase, small_case

ROOT = Path(__file__).parents[3]
PAGE = ROOT / "docs" / "fleet.md"
WELDS = {"A": "bracket", "B": "floor seam"}
EVENTS = {"sine": "tangent 350", "noise": "curves 160"}


def body(scale: float = 1.0) -> SmallCase:
    """The small case under the names of the docs, its coordinates times a factor."""
    case = small_case(seconds=6.0)
    for table in (case.welds, case.weld_nodes, case.nodal_forces):
        table["weld"] = table["weld"].replace(WELDS)
    for history in case.histories.values():
        history[["q_1", "q_2", "q_7"]] *= scale
    case.events = [event | {"name": EVENTS.get(event["name"], event["name"])} for event in case.events]
    return case


def result(case: SmallCase, folder: Path, into: Path) -> Path:
    """Result of a case; returns its folder."""
    assess(load_case(case.write(folder)), into, threads=1, report=False)
    return into


def blocks(language: str) -> list[str]:
    """Code blocks of the docs page."""
    return re.findall(rf"^```{language}\n(.*?)^```", PAGE.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)


def fleet_folder(folder: Path) -> Path:
    """Folder with ``fleet.toml`` and ``km.csv`` as the docs have them, and the results they name."""
    result(body(), folder / "sound", folder / "out" / "sound")
    result(body(1.3), folder / "worn", folder / "out" / "worn")
    (folder / "fleet.toml").write_text(blocks("toml")[0], encoding="utf-8")
    (folder / "km.csv").write_text(blocks("csv")[0], encoding="utf-8")
    return folder
