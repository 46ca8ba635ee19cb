"""The docs as a site: ``sphinx-build -W -b html -c docs/site . out/site``.

The pages are the Markdown files as they lie, with the links that a git host follows; the root of the project is the
source, so that README, changes and rules are pages too. What each section holds is said here once.
"""

import re
from pathlib import Path
from typing import Any

project = "fatigue"
author = "the authors of fatigue"
extensions = ["myst_parser"]
root_doc = "docs/index"
include_patterns = [
    "README.md",
    "CHANGELOG.md",
    "CONTRIBUTING.md",
    "SECURITY.md",
    "docs/**.md",
    "data/carbody/README.md",
    "data/templates/README.md",
    "examples/*/README.md",
]
exclude_patterns = [".git", ".venv", "out", "build", "dist", "**/__pycache__", "**/.pytest_cache"]
myst_heading_anchors = 4
suppress_warnings = ["misc.highlighting_failure"]  # blocks of several formats in one
html_theme = "furo"
html_title = "fatigue"
html_show_sphinx = False
html_show_copyright = False
html_copy_source = False
html_static_path = ["static"]
html_css_files = ["site.css"]

SECTIONS = {  # page of a section, and its pages in the order of reading
    "docs/index": ("start", "how-to", "gallery", "reference", "theory", "verification", "quality"),
    "docs/start": ("start/example", "start/report", "bring-your-own-model", "notation", "../README"),
    "docs/how-to": (
        "how-to/commands",
        *("requests", "nastran", "ansys", "abaqus", "adams", "simpack", "other-simulations", "recordings"),
        *("modal-basis", "reduce", "lines-by-coordinates", "unit-loads", "offsets", "stress-points", "solid-welds"),
        *("root-and-throat", "endurance", "curves", "how-to/knee-and-thickness", "sequences", "shear", "life-band"),
        *("results", "report", "how-to/other-tools", "point", "load-spectra", "resonance", "ride", "shift"),
        *("compare", "whatif", "backsolve", "fleet", "bench", "study", "vehicle", "gauges", "correlation"),
        *("large-models", "how-to/cluster"),
    ),
    "docs/gallery": (
        *("../examples/notebook/README", "../examples/fluttering/README"),
        *("../data/carbody/README", "../data/templates/README"),
    ),
    "docs/reference": (
        *("reference/commands", "reference/case-keys", "reference/vehicle-keys", "reference/study-keys"),
        *("reference/fleet-keys", "reference/columns", "reference/curves", "reference/warnings-of-results"),
        *("reference/warnings-of-commands", "reference/errors", "reference/python"),
    ),
    "docs/theory": ("how-it-works", *(f"theory/eq-{n:02d}" for n in range(1, 24))),
    "docs/verification": ("verification/known-values", "verification/joint-tests", "ledger"),
    "docs/quality": ("quality/validation", "quality/citing", "../CHANGELOG", "../CONTRIBUTING", "../SECURITY"),
}


def with_contents(app: Any, page: str, source: list[str]) -> None:
    """Append the contents of a section, which a git host does not need; folders and licences are no pages."""
    folder = Path(app.env.doc2path(page)).parent

    def unless_no_page(link: re.Match[str]) -> str:
        return link[1] if (folder / link[2]).is_dir() or "LICENSE" in link[2] else link[0]

    text = re.sub(r"\[([^\]]*)\]\(((?!https?:)[^)\s#]+)\)", unless_no_page, source[0])
    if page in SECTIONS:
        names = "\n".join(SECTIONS[page])
        text += f"\n\n```{{toctree}}\n:hidden:\n:maxdepth: 2\n\n{names}\n```\n"
    source[0] = text


def setup(app: Any) -> None:
    """Register what is done with each page."""
    app.connect("source-read", with_contents)
