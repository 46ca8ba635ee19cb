"""The recount reads a weld register in every layout that the program reads, on its own."""

import csv
import unicodedata
from io import StringIO

import pandas as pd
import pytest

from fatigue.readers.neutral.register.register_file import open_register
from fatigue.verify.recount.inputs.register import weld_entries

NAMES = "weld,line,status,reason,length_mm,thickness_mm,confirmed,surface,curve,end_length_mm,description,notes"
ROWS = [
    ["Naht ü, links", "a", "assess", "", "60.5", "10.5", "WAHR", "Top", "", "20.25", "x; y", "3"],
    ["b", "b", "Excluded", "ground, flush", "60.5", "", "", "", "", "", "", ""],
    ["c", "c", "candidate", "fold", "12", "8.5", "false", "both", "mine", "", "", "z"],
]
NUMBERS = (4, 5, 9)


def text(separator: str = ",", decimal: str = ".", end: str = "\n", quoting: int = csv.QUOTE_MINIMAL) -> str:
    """Register as a spreadsheet may save it."""
    file = StringIO()
    writer = csv.writer(file, delimiter=separator, lineterminator=end, quoting=quoting)
    writer.writerow(NAMES.split(","))
    writer.writerows([c.replace(".", decimal) if k in NUMBERS else c for k, c in enumerate(row)] for row in ROWS)
    return file.getvalue()


LAYOUTS = {
    "plain": text().encode(),
    "semicolons": text(";", ",", "\r\n").encode("cp1252"),
    "commas everywhere": text(",", ",").encode(),
    "all quoted": text(",", ",", quoting=csv.QUOTE_ALL).encode(),
    "tabs": text("\t", ",", "\r\n").encode("utf-16"),
    "without mark": text("\t").encode("utf-16-be"),
    "declared": ("sep=;\r\n" + text(";", ",", "\r\n")).encode("utf-8-sig"),
    "bars": text("|").encode(),
    "remark": (b"# mine, with; many; semicolons; in; it; more; than; there; are; columns; yes; indeed; it; is\n")
    + text().encode(),
    "classic macintosh": text(end="\r").encode(),
    "letters and accents apart": unicodedata.normalize("NFD", text()).encode(),
    "names twice": (text() + NAMES + "\n").encode(),
    "units": text().replace("\n", "\n,,,,mm,mm,,,,mm,,\n", 1).encode(),
    "empty rows and columns": (text().replace("\n", ",,,\n") + "," * 14 + "\n\n").encode(),
    "exponents": text().replace("10.5", "1.05D+01").replace("20.25", "2.025+01").encode(),
    "blank that does not break": text().replace("assess", "assess\u00a0").encode(),
}


@pytest.mark.parametrize("content", LAYOUTS.values(), ids=LAYOUTS)
def test_layouts(tmp_path, content):
    """Names, faces, lengths, thicknesses and reasons are those that the program's own reader finds."""
    path = tmp_path / "welds_register.csv"
    path.write_bytes(content)
    first, *others = open_register(path, strict=False).rows
    found = weld_entries({"body": {"welds": "welds.csv"}}, tmp_path, pd.DataFrame({"weld": ["a", "b", "c"]}))
    (weld,) = found.welds.values()
    assert weld.name == first.weld == "Naht ü, links"
    assert weld.sources == ("a",)
    assert weld.surface == first.surface == "top"
    assert weld.end_length == float(first.end_length) == 20.25
    assert weld.thickness == {"a": first.thickness} == {"a": 10.5}
    assert found.left_out == ("ground, flush", "candidate: fold")
    assert [row.reason for row in others] == ["ground, flush", "fold"]
