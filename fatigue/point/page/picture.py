"""The picture of a point: its figures in two columns under its name and numbers, for a mail or a slide."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from fatigue.point.page.gathered import Gathered
from fatigue.point.page.page import ROOM, drawn, facts_of
from fatigue.report.files.png import WIDTH, draw_png
from fatigue.report.page_text import page_text
from fatigue.report.sections.embed import Figures, Shown

HEAD, LINE, CAPTION, FOOT = 150, 25, 34, 44  # px; so many of each line beneath the numbers
ROWS = (
    (520, ("along", "history")),
    (300, ("matrix", "exceedance", "sn", "damage-modes", "modes", "damage-bands", "track")),
    (400, ("psd", "domain-ranges")),
)  # height of a figure [px], and the figures that are two by two in rows of it
MOST_LINES = 4  # beneath the numbers


@dataclass(frozen=True, slots=True)
class PictureRow:
    """Two figures beside each other, or one in the first column, and their common height [px]."""

    figures: tuple[Shown, ...]
    height: int


def draw_picture(found: Gathered, png: Path) -> None:
    """Draw a point as a PNG picture.

    Raises
    ------
    DataError : no browser is installed, or it fails
    """
    page, height = picture_page(found)
    draw_png(page, png, height)


def picture_page(found: Gathered) -> tuple[str, int]:
    """Return the page that is drawn as text, and its height [px]: 1600 are its width."""
    figs = Figures()
    of = drawn(found, figs)
    shown = [of.along, *of.over_time, *of.ranges, *of.damage, *of.domains, *of.spectrum]
    rows = _rows({one.id: one for one in shown})
    facts = facts_of(found)
    lines = [line for line in (facts["band"], *(f"{note}." for note in facts["notes"])) if line][:MOST_LINES]
    head = HEAD + LINE * len(lines)
    height = head + FOOT + sum(row.height + CAPTION for row in rows)
    sizes = {"width": WIDTH, "head": head, "caption": CAPTION, "foot": FOOT}
    context = {**facts, **sizes, "lines": lines, "rows": rows}
    return page_text(ROOM, "picture.html", context, figs), height


def _rows(shown: Mapping[str, Shown]) -> list[PictureRow]:
    """Figures two by two, those of a height together so that no row has a gap; what there is not is left out."""
    rows = []
    for height, names in ROWS:
        there = [shown[name] for name in names if name in shown]
        rows += [PictureRow(tuple(there[i : i + 2]), height) for i in range(0, len(there), 2)]
    return rows
