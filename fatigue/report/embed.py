"""Figures and data inside the page: as JSON that no name can break out of, arrays as base64 in single precision."""

import base64
import json
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import plotly.graph_objects as go
from markupsafe import Markup
from numpy.typing import NDArray

_CODES = {"float32": "f4", "int32": "i4"}


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
    """Numbers the figures of a page in the order in which they are added."""

    shown: list[Shown] = field(default_factory=list)

    def add(self, id_: str, fig: go.Figure, caption: str, *, wide: bool = False) -> Shown:
        """Keep a figure; the template they all share is in the page once and not in each."""
        content = json.loads(fig.to_json(remove_uids=True))
        content["layout"].pop("template")
        height = int(content["layout"].pop("height"))
        shown = Shown(id_, len(self.shown) + 1, caption, height, embedded(content), wide)
        self.shown.append(shown)
        return shown


def embedded(value: Any) -> Markup:
    """JSON that is safe inside a script element, whatever the texts in it."""
    text = json.dumps(value, ensure_ascii=True, separators=(",", ":"), allow_nan=False)
    return Markup(text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026"))


def packed(values: NDArray[np.generic]) -> dict[str, str]:
    """Write an array as plotly.js reads it: type and base64 of its bytes, infinite and missing values included."""
    little = values.astype(values.dtype.newbyteorder("<"))
    return {"dtype": _CODES[values.dtype.name], "bdata": base64.b64encode(little.tobytes()).decode()}
