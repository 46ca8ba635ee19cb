"""The recount reads every layout of a text table that the program reads, on its own."""

import pytest

from fatigue.readers.neutral.tables import open_table
from fatigue.verify.recount.inputs.tables import read_frame, read_pieces
from tests.readers.text.test_layout import DIALECTS


@pytest.mark.parametrize("content", DIALECTS.values(), ids=DIALECTS)
def test_dialects(tmp_path, content):
    """Names and numbers are those of the program's own reader."""
    path = tmp_path / "t.csv"
    path.write_bytes(content)
    table = open_table(path, texts=("weld",))
    for frame in (read_frame(path), *read_pieces(path)):
        assert list(frame.columns) == ["weld", "x_mm", "n"]
        assert frame["weld"].tolist() == table.texts("weld")
        assert frame["x_mm"].tolist() == table.numbers("x_mm").tolist()
        assert frame["n"].astype(int).tolist() == table.integers("n").tolist()
