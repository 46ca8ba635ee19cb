"""Figures and data inside the page, as JSON that no name can break out of."""

import json
from dataclasses import dataclass, field
from typing import Any

from markupsafe import Markup

from fatigue.report.figures.drawn import Figure
from fatigue.shown import visible


@dataclass(frozen=True, slots=True)
class Shown:
    """A figure of the page: its number, height [px] and content as JSON; a wide one stands alone in its row."""

    id: str
    number: int
    caption: str
    height: int
    json: Markup
    wide: bool = False


@dataclass(slots=True)
class Figures:
    """Numbers the figures of a page in the order in which they are added; their ids begin with ``prefix``.

    ``mark`` ends the caption of every figure, unless it shows what rests on no S-N curve.
    """

    shown: list[Shown] = field(default_factory=list)
    prefix: str = ""
    mark: str = ""

    def under(self, prefix: str, mark: str = "") -> "Figures":
        """The same figures, numbered on; the ids of those to come begin with the prefix, and end with the mark."""
        return Figures(self.shown, prefix, mark)

    def add(self, id_: str, fig: Figure, caption: str, *, wide: bool = False, of_curve: bool = True) -> Shown:
        """Figure as the page shows it; the template that all share is in the page once and not in each."""
        caption += self.mark if of_curve else ""
        content = fig.content()
        height = int(content["layout"].pop("height"))
        shown = Shown(self.prefix + id_, len(self.shown) + 1, caption, height, embedded(content), wide)
        self.shown.append(shown)
        return shown


def embedded(value: Any) -> Markup:
    """JSON that is safe inside a script element, whatever the texts in it."""
    text = json.dumps(_shown(value), ensure_ascii=True, separators=(",", ":"), allow_nan=False)
    return Markup(text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026"))


def _shown(value: Any) -> Any:
    """The same value, its texts as the page shows them: what cannot be seen in them is spelled out."""
    if isinstance(value, str):
        return visible(value, keep="\n\t\u2028\u2029\u2068\u2069")  # the last two: isolates around a name
    if isinstance(value, dict):
        return {_shown(key): _shown(held) for key, held in value.items()}
    return [_shown(held) for held in value] if isinstance(value, list | tuple) else value
