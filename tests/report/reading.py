"""Read a page as a person does: its visible text, its tables, its figures."""

import base64
import json
import zlib
from dataclasses import dataclass, field
from html.parser import HTMLParser

import numpy as np
import pytest

_SILENT = {"script", "style"}


@dataclass
class Page(HTMLParser):
    """A parsed page: visible text by element, tables as rows of cell texts, figures by id, all points."""

    html: str
    text: list[str] = field(default_factory=list)
    tables: dict[str, list[list[str]]] = field(default_factory=dict)
    figures: dict[str, dict] = field(default_factory=dict)
    tags: list[tuple[str, dict]] = field(default_factory=list)
    points: dict = field(default_factory=dict)

    def __post_init__(self):
        """Read the page."""
        super().__init__(convert_charrefs=True)
        self._silent, self._table, self._cell, self._json = 0, None, None, None
        self.feed(self.html)
        self.close()

    def handle_starttag(self, tag, attrs):
        """Note the element."""
        given = dict(attrs)
        self.tags.append((tag, given))
        if tag in _SILENT:
            self._silent += 1
            if given.get("id", "").startswith("json-"):
                self._json = given["id"].removeprefix("json-")
            if given.get("id") == "points-data":
                self._json = "points-data"
        if tag == "table":
            self._table = self.tables.setdefault(given.get("id", f"table {len(self.tables)}"), [])
        if tag == "tr" and self._table is not None:
            self._table.append([])
        if tag in ("td", "th") and self._table is not None:
            self._cell = []

    def handle_endtag(self, tag):
        """End the element."""
        if tag in _SILENT:
            self._silent -= 1
            self._json = None
        if tag == "table":
            self._table = None
        if tag in ("td", "th") and self._cell is not None:
            self._table[-1].append("".join(self._cell).strip())
            self._cell = None

    def handle_data(self, data):
        """Keep text where it belongs."""
        if self._json == "points-data":
            self.points = json.loads(data)
        elif self._json is not None:
            self.figures[self._json] = json.loads(data)
        if self._silent:
            return
        self.text.append(data)
        if self._cell is not None:
            self._cell.append(data)

    @property
    def words(self):
        """All visible text, spaces made equal."""
        return " ".join("".join(f" {t} " for t in self.text).split())


def values(array):
    """Decode the data of a trace: a list, or type and base64 as plotly.js reads them."""
    if isinstance(array, dict):
        return np.frombuffer(base64.b64decode(array["bdata"]), dtype=array["dtype"]).reshape(
            [int(n) for n in array.get("shape", "-1").split(",")]
        )
    return np.asarray(array)


def inflated(packed):
    """Columns of ``deflated`` as the script of the page reads them: first bytes of all values, then second ones."""
    content, start, columns = zlib.decompress(base64.b64decode(packed["deflate"])), 0, {}
    for name, code, rows in packed["heads"]:
        size = np.dtype(code).itemsize
        planes = np.frombuffer(content, np.uint8, rows * size, start).reshape(size, rows)
        columns[name] = np.ascontiguousarray(planes.T).view(f"<{code}").reshape(rows)
        start += rows * size
    return columns


def cells_of(path, name):
    """Cells of a sheet of a workbook by their address, the empty ones left out; skips where openpyxl is missing."""
    openpyxl = pytest.importorskip("openpyxl")
    rows = openpyxl.load_workbook(path)[name].iter_rows()
    return {cell.coordinate: cell.value for row in rows for cell in row if cell.value is not None}
