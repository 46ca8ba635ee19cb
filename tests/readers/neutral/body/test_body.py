"""The tables of a body together."""

from pathlib import Path

import numpy as np
import pytest

from fatigue.errors import DataError
from fatigue.readers.neutral.body.mesh import read_mesh
from fatigue.readers.neutral.body.modes import read_modes
from fatigue.readers.neutral.body.welds import read_welds
from tests.readers.neutral_tables import read_weld_nodes, write


@pytest.mark.parametrize("read", [lambda p, s: read_modes(p, (), strict=s), lambda p, s: read_welds(p, (), strict=s)])
def test_unknown_columns(tmp_path, read):
    """An unknown column is a warning, and an error where strict."""
    columns = {"mode": [1], "frequency_hz": [2.0], "kind": ["interface"], "weld": ["a"], "colour": ["red"]}
    path: Path = write(tmp_path / "t.csv", columns)
    _, warnings = read(path, False)
    assert "t.csv: column colour: the column is unknown and not read. Remove it." in map(str, warnings)
    with pytest.raises(DataError, match="column colour: the column is unknown"):
        read(path, True)


def test_shipped_body():
    """The shipped car body reads without a single warning."""
    folder = Path("data/carbody")
    modes, doubts = read_modes(folder / "modes.csv", (), strict=True)
    welds, more = read_welds(folder / "welds.csv", (), strict=True)
    lines, still_more = read_weld_nodes(folder / "weld_nodes.csv", welds, strict=True)
    mesh, last = read_mesh(folder / "nodes.parquet", folder / "elements.parquet", strict=True)
    assert doubts + more + still_more + last == []
    assert (modes.mode.size, modes.kind.count("interface"), len(welds)) == (52, 22, 14)
    assert (mesh.node.size, mesh.element.size) == (15734, 15492)
    assert [weld.name for weld in welds if weld.closed] == ["W4_roof_stub_loop"]
    at = np.searchsorted(mesh.node, np.concatenate([line.node for line in lines]))
    np.testing.assert_allclose(np.concatenate([line.xyz for line in lines]), mesh.xyz[at], atol=1e-3)
