"""Weld lines a user marks, and the register that is edited and given back."""

from itertools import pairwise

import pytest

from fatigue.errors import CaseError, DataError
from fatigue.readers.convert.options import WeldSources
from fatigue.readers.convert.weld_lines import find_welds, list_welds
from fatigue.readers.foreign.fe.model import in_mm
from fatigue.readers.foreign.nastran.deck.bdf import read_bdf
from fatigue.readers.neutral.register.register_file import open_register, register_text
from tests.readers.tee_model import bulk, tee


@pytest.fixture
def mesh(tmp_path):
    """Bulk data of the T joint with a set, plot elements and bars along the weld, and bars elsewhere."""
    line = joint_nodes()
    path = tmp_path / "tee.bdf"
    plotels = [f"PLOTEL,{9000 + k},{a},{b}" for k, (a, b) in enumerate(pairwise(line))]
    text = bulk(tee(), "\n".join([*plotels, "CBAR,9500,1,1,99", f"SET1,5,{','.join(str(n) for n in line[:6])}"]))
    path.write_text(text)
    return path


def joint_nodes():
    """Grids of the joint, in order."""
    xyz = tee().model.xyz
    at = (xyz[:, 1] == 40) & (xyz[:, 2] == 0) & (xyz[:, 0] >= 30) & (xyz[:, 0] <= 90)
    nodes = [int(k) for k in at.nonzero()[0]]
    return [k + 1 for k in sorted(nodes, key=lambda k: xyz[k, 0])]


def lines(mesh, **sources):
    """Names and node counts of the lines found."""
    found = find_welds(read_bdf(mesh), WeldSources(**sources))
    return sorted((row.kind, row.nodes) for row in found.rows)


def test_sources(mesh, tmp_path):
    """Sets, plot elements, node lists and detection name the same three sides; marks turn detection off."""
    assert lines(mesh) == [("tee", 7)] * 3
    assert lines(mesh, sets=(5,)) == [("set5", 6)] * 3
    assert lines(mesh, markers=("plotel",)) == [("plotel", 7)] * 3
    table = tmp_path / "lines.csv"
    table.write_text("\n".join(["weld,order,node", *_bracket()]) + "\n")
    assert lines(mesh, node_lists=table) == [("bracket", 4)] * 3
    assert lines(mesh, node_lists=table, detect=True) == [("bracket", 4)] * 3 + [("tee", 4)] * 3


def test_doubts_about_node_lists_are_told(mesh, tmp_path):
    """A column that nothing reads, for one."""
    table = tmp_path / "lines.csv"
    table.write_text("".join(f"{row}\n" for row in ["weld,order,node,colour", *_bracket("red")]))
    found = find_welds(read_bdf(mesh), WeldSources(node_lists=table))
    assert "lines.csv: column colour: the column is unknown" in " ".join(map(str, found.remarks))


def _bracket(*more):
    """Rows of a list of four nodes along the joint."""
    return [",".join(["bracket", str(k), str(n), *more]) for k, n in enumerate(joint_nodes()[:4])]


def test_marks_that_are_no_lines(mesh, tmp_path):
    """A bar off the mesh edges, a set without an edge and nodes that are no neighbours are refused."""
    with pytest.raises(DataError, match=r"no CBAR lies on a shell edge.*CBAR, PLOTEL"):
        lines(mesh, markers=("CBAR",))
    mesh.write_text(mesh.read_text().replace("SET 7 = 1 THRU 3", "SET 7 = 1, 60"))
    with pytest.raises(DataError, match="no shell edge lies in SET 7"):
        lines(mesh, sets=(7,))
    table = tmp_path / "lines.csv"
    table.write_text("weld,order,node\na,1,1\na,2,60\n")
    with pytest.raises(DataError, match="no shell edge joins the nodes 1 and 60"):
        lines(mesh, node_lists=table)


def test_register_file(mesh, tmp_path):
    """The register is written, read back, and not written over a file of somebody else."""
    out = tmp_path / "welds.csv"
    found = list_welds(mesh, WeldSources(), "mm-t-s", out, overwrite=False)
    assert {row.key: row for row in open_register(out, strict=False).rows} == {row.line: row for row in found.rows}
    with pytest.raises(DataError, match="the file exists"):
        list_welds(mesh, WeldSources(), "mm-t-s", out, overwrite=False)
    list_welds(mesh, WeldSources(register=out), "mm-t-s", out, overwrite=False)
    with pytest.raises(CaseError, match="unknown unit system 'cm'"):
        list_welds(mesh, WeldSources(), "cm", None, overwrite=False)
    metres = list_welds(mesh, WeldSources(), "m-kg-s", None, overwrite=False)
    assert metres.rows[0].length == pytest.approx(60_000)


def test_register_of_lines_that_are_gone(mesh, tmp_path):
    """A registered line that the mesh has no more is kept, excluded, and told."""
    out = tmp_path / "welds.csv"
    out.write_text("weld,line,status\nmine,tee_1_2_p9a,assess\n")
    found = find_welds(read_bdf(mesh), WeldSources(register=out))
    assert [row.reason for row in found.rows if row.weld == "mine"] == ["the mesh has this line no more"]
    assert found.remarks[0].code == "line_gone"


@pytest.mark.parametrize(
    ("row", "words"),
    [
        (",b,assess,,,", "column weld is missing"),
        ("a,b,,,,", "column status is missing"),
        ("a,b,perhaps,,,", "status is 'perhaps'"),
        ("a,b,assess,left,,", "surface is 'left'"),
        ("a,b,assess,,-1,", "end_length_mm is -1"),
        ("a,b,assess,,x,", "could not convert"),
        ("a,b,assess,,,true", "must be above 0"),
        ("a,b,assess,,,\nc,b,assess,,,", "given twice, in row 1"),
        ("a,,assess,,,\na,,assess,,,", "given twice, in row 1"),
        ("a,b,assess,,,maybe", "confirmed is 'maybe'"),
        ("a,b,excluded,,,,by hand, with care", "8 cells in a table of 6 columns"),
    ],
)
def test_register_refusals(tmp_path, row, words):
    """Impossible cells are named with their row."""
    path = tmp_path / "welds.csv"
    path.write_text("weld,line,status,surface,end_length_mm,confirmed\n" + row + "\n")
    with pytest.raises(DataError, match=words):
        open_register(path, strict=False)


def test_register_that_is_not_there(tmp_path):
    """A missing register is named."""
    with pytest.raises(DataError, match="cannot be read"):
        open_register(tmp_path / "none.csv", strict=False)


def test_unknown_thickness_is_excluded(mesh):
    """A side without property has no thickness to divide by; doubled shells are told."""
    text = mesh.read_text().replace("PSHELL,2,1,6.,1,,1\n", "").replace("ENDDATA", "CQUAD4,9999,1,1,2,15,14\nENDDATA")
    mesh.write_text(text)
    found = find_welds(read_bdf(mesh), WeldSources())
    assert ["not a PSHELL" in row.reason for row in found.rows if row.pid == 2] == [True]
    assert register_text(found.rows).count("excluded") == 1
    assert in_mm(read_bdf(mesh), 1000.0).mesh.xyz.max() == 120_000
