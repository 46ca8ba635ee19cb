"""The equations of the method, one page each: formula, source, and the function that has it."""

import inspect
import re
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]
METHOD = ROOT / "docs" / "how-it-works.md"
DONG = "Dong, International Journal of Fatigue 23 (2001) 865; Dong and Hong 2003; ASME VIII-2 Annex 5-A"
MASTER = "ASME VIII-2 5.5.5.2; Dong 2001"
OWN = "defined here"
SOURCES = {  # of each equation: paper, clause, or that it is a definition of the program
    1: DONG,
    2: f"shape functions of the edges, integrated; {DONG}",
    3: f"{DONG}, 5.5.5.2",
    4: OWN,
    5: "linear modal superposition",
    6: "derived here, from the band-limited signal between its samples",
    7: MASTER,
    8: MASTER,
    9: MASTER,
    10: MASTER,
    11: "ASME VIII-2 Annex 3-F, equation 3-F.4",
    12: "Palmgren 1924, Miner 1945; cycles as in ASTM E1049-85 5.4.4 and ISO 12110-2",
    13: "ASME VIII-2 5.5.5.3, for a harmonic path",
    14: OWN,
    15: OWN,
    16: OWN,
    17: OWN,
    18: "Rice, Bell System Technical Journal 24 (1945); for modal models Braccesi, Cianetti et al., 2005 and later",
    19: OWN,
    20: "Dirlik, PhD thesis, University of Warwick, 1985",
    21: "Benasciutti and Tovo, International Journal of Fatigue 27 (2005)",
    22: "Markov's inequality; for q equal to the slope the crossing bound of Rychlik (1993)",
    23: OWN,
}


@dataclass(frozen=True)
class Equation:
    """One numbered equation: name, formula, the function that has it (if one has), its heading in the method."""

    number: int
    name: str
    formula: str
    place: str
    heading: str

    @property
    def file(self) -> str:
        """Name of its page."""
        return f"eq-{self.number:02d}.md"


def equations() -> list[Equation]:
    """All numbered equations in their order."""
    text, found = METHOD.read_text(encoding="utf-8"), []
    for match in re.finditer(r"^\*\*Eq\. (\d+), ([^*]+)\*\*(?: \(`([\w.]+)`)?", text, re.MULTILINE):
        formula = re.search(r"^```\n(.*?)^```", text[match.end() :], re.MULTILINE | re.DOTALL)
        heading = re.findall(r"^##+ (.+)$", text[: match.start()], re.MULTILINE)[-1]
        found.append(Equation(int(match[1]), match[2], formula[1] if formula else "", match[3] or "", heading))
    return found


def equation_list() -> str:
    """Table of all equations with source and place in the code."""
    rows = [
        f"| {e.number} | [{e.name}](theory/{e.file}) | {SOURCES[e.number]} | {f'`{e.place}`' if e.place else ''} |"
        for e in equations()
    ]
    return "\n".join(["| Eq. | what | source | in the code |", "|---|---|---|---|", *rows])


def equation_pages() -> dict[str, str]:
    """Page of every equation by the name of its file."""
    return {equation.file: _page(equation) for equation in equations()}


def _page(equation: Equation) -> str:
    anchor = re.sub(r"[^\w\- ]", "", equation.heading).lower().replace(" ", "-")
    parts = [
        f"# Eq. {equation.number}: {equation.name}",
        "<!-- written by python -m tests.reference -->",
        f"```text\n{equation.formula}```",
        f"**Source.** {SOURCES[equation.number]}.",
        f"**In the method.** [{equation.heading}](../how-it-works.md#{anchor}); symbols: [notation](../notation.md).",
    ]
    if equation.place:
        thing = _found(equation.place)
        path = Path(inspect.getsourcefile(inspect.getmodule(thing))).relative_to(ROOT).as_posix()
        parts += [
            f"**In the code.** `{equation.place}`, in [{path}](../../{path}):",
            f"```text\n{inspect.getdoc(getattr(thing, 'py_func', thing))}\n```",
        ]
    return "\n\n".join(parts) + "\n"


def _found(place: str) -> Any:
    module, _, name = place.rpartition(".")
    return getattr(import_module(module), name)
