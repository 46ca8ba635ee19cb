"""The example of figures outside the report runs as it stands."""

import runpy
import shutil
import sys
from pathlib import Path

SCRIPT = Path(__file__).parents[2] / "examples" / "weld_figures.py"


def test_the_example_makes_its_figures(result_folder, tmp_path, monkeypatch):
    """Four pages beside one copy of plotly.js, none with an upload button."""
    folder = shutil.copytree(result_folder, tmp_path / "result")
    monkeypatch.setattr(sys, "argv", [str(SCRIPT), str(folder)])
    names = runpy.run_path(str(SCRIPT))
    pages = sorted(path.name for path in folder.glob("figure_*.html"))
    assert pages == ["figure_along.html", "figure_domains.html", "figure_lives.html", "figure_ranges.html"]
    assert all('"showSendToCloud": false' in (folder / page).read_text(encoding="utf-8") for page in pages)
    assert len(names["lives"].data[1]["x"]) == 2
