"""The picture of a point: its figures in two columns under its name and numbers, for a mail or a slide."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from fatigue.point.page.gathered import Gathered
from fatigue.point.page.page import ROOM, drawn, facts_of
from fatigue.report.files.png import WIDTH, draw_png
from fatigue.report.page_text import page_text
from fatigue.report.sections.embed import Figures, Shown

HEAD, CAPTION, FOOT = 236, 34, 44  # px
TALL, LOW = 430, 340  # figures with panels one above the other, and others [px]
PANELS = ("along", "history", "psd")
MOST_NOTES = 3


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
    history = [shown for shown in of.over_time if shown.id == "history"]
    left_to_right = [of.along, *history, *of.ranges, *of.damage, *of.spectrum, *of.domains]
    rows = _rows(left_to_right)
    height = HEAD + FOOT + sum(row.height + CAPTION for row in rows)
    facts = facts_of(found)
    sizes = {"width": WIDTH, "head": HEAD, "caption": CAPTION, "foot": FOOT}
    context = {**facts, **sizes, "notes": facts["notes"][:MOST_NOTES], "rows": rows}
    return page_text(ROOM, "picture.html", context, figs), height


def _rows(shown: Sequence[Shown]) -> list[PictureRow]:
    """Figures two by two, tall ones together so that no row has a gap."""
    tall = [one for one in shown if one.id in PANELS]
    low = [one for one in shown if one.id not in PANELS]
    rows = []
    for some, height in ((tall[:2], TALL), (low, LOW), (tall[2:], TALL)):
        rows += [PictureRow(tuple(some[i : i + 2]), height) for i in range(0, len(some), 2)]
    return rows
