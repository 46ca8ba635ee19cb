"""Lines of one name in a mesh: the cut is that of a line never cut, on linear and parabolic shells."""

import numpy as np
import pytest

from fatigue.errors import DataError
from fatigue.readers.convert.options import WeldSources
from fatigue.readers.convert.weld_lines import find_welds
from fatigue.readers.foreign.nastran.deck.bdf import read_bdf
from tests.readers.box_model import box, corner_nodes


def bulk(parabolic):
    """Bulk data of the box; parabolic shells have a mid-side node on every edge."""
    model = box().model
    xyz, middle = model.xyz.tolist(), {}
    shells = []
    for k, (corners, t) in enumerate(zip(model.quads.tolist(), model.thickness, strict=True), start=1):
        mids = []
        for a, b in zip(corners, corners[1:] + corners[:1], strict=True):
            if (min(a, b), max(a, b)) not in middle:
                middle[min(a, b), max(a, b)] = len(xyz)
                xyz.append([(p + q) / 2 for p, q in zip(xyz[a], xyz[b], strict=True)])
            mids.append(middle[min(a, b), max(a, b)])
        nodes = ",".join(str(n + 1) for n in corners)
        pid = 1 if t == 8 else 2
        more = f",{mids[0] + 1},{mids[1] + 1}\n,{mids[2] + 1},{mids[3] + 1}"
        shells.append(f"CQUAD8,{k},{pid},{nodes}{more}" if parabolic else f"CQUAD4,{k},{pid},{nodes}")
    used = xyz if parabolic else model.xyz.tolist()
    grids = [f"GRID,{k},,{x:.6f},{y:.6f},{z:.6f}" for k, (x, y, z) in enumerate(used, start=1)]
    return "\n".join(["BEGIN BULK", "PSHELL,1,1,8.,1,,1", "PSHELL,2,1,6.,1,,1", *grids, *shells, "ENDDATA", ""])


def found(folder, lines, register=None):
    """Find the welds along lists of nodes."""
    table = folder / "lines.csv"
    rows = [f"{weld},{k},{node}" for weld, nodes in lines.items() for k, node in enumerate(nodes)]
    table.write_text("\n".join(["weld,order,node", *rows]) + "\n")
    return find_welds(read_bdf(folder / "box.bdf"), WeldSources(node_lists=table, register=register))


@pytest.mark.parametrize("parabolic", [False, True])
@pytest.mark.parametrize("walls", [2, 3, 4])
def test_a_joined_cut_is_one_never_cut(tmp_path, parabolic, walls):
    """Elements, nodes, thickness, normals and outward vectors of both sides of the plate, open and closed."""
    (tmp_path / "box.bdf").write_text(bulk(parabolic))
    legs = corner_nodes()[:walls]
    whole = found(tmp_path, {"whole": [n for leg in legs for n in leg[:-1]] + legs[-1][-1:]})
    whole = [cut for cut in whole.cuts.values() if cut.pid == 1]
    lines = {f"leg{k}": leg for k, leg in enumerate(legs)}
    pieces = found(tmp_path, lines)
    register = tmp_path / "register.csv"
    assert len(whole) == 2
    side = {line: int(len(set(cut.elements) & set(whole[0].elements)) < cut.elements.size / 2)
            for line, cut in pieces.cuts.items() if cut.pid == 1}  # fmt: skip
    names = {row.line: f"side {side[row.line]}" if row.pid == 1 else row.line for row in pieces.rows}
    register.write_text("\n".join(["weld,line,status", *(f"{n},{line},assess" for line, n in names.items())]) + "\n")
    joined = found(tmp_path, lines, register).joined
    assert set(joined) == {"side 0", "side 1"}
    for name, uncut in zip(("side 0", "side 1"), whole, strict=True):
        cut = joined[name]
        assert cut.elements.tolist() == uncut.elements.tolist()
        assert cut.line.closed == uncut.line.closed == (walls == 4)
        at = {node: k for k, node in enumerate(uncut.line.node.tolist())}
        order = [at[node] for node in cut.line.node.tolist()]
        assert sorted(order) == list(range(len(at)))
        for attribute in ("thickness", "normal", "outward", "edge_mid"):
            assert np.allclose(getattr(cut.line, attribute), getattr(uncut.line, attribute)[order], rtol=0, atol=1e-15)


def test_sides_that_do_not_go_on(tmp_path):
    """The walls of a box are plates of their own: at a corner they turn, and are no one weld."""
    (tmp_path / "box.bdf").write_text(bulk(parabolic=False))
    lines = {f"leg{k}": leg for k, leg in enumerate(corner_nodes()[:2])}
    walls = [row.line for row in found(tmp_path, lines).rows if row.pid == 2]
    register = tmp_path / "register.csv"
    register.write_text("\n".join(["weld,line,status", *(f"wall,{line},assess" for line in walls)]) + "\n")
    with pytest.raises(
        DataError, match=r"register.csv: weld wall: the assessed plate turns by 90 degrees between lines"
    ):
        found(tmp_path, lines, register)
