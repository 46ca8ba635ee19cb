"""Blocks joined into a run: which subcases, which frequencies, static subcases beside modes."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
import pytest

from fatigue.errors import DataError
from fatigue.readers.convert.audit.audit import audit
from fatigue.readers.convert.convert import convert
from fatigue.readers.convert.options import ConvertOptions
from fatigue.readers.foreign.nastran.deck.bdf import read_bdf
from fatigue.readers.foreign.nastran.results.op2 import read_op2
from fatigue.readers.neutral.body.modes import read_modes
from tests.readers.op2_files import ROW
from tests.readers.op2_writer import OPTISTRUCT, Op2Writer, modal_op2, modal_tables
from tests.readers.tee_model import bulk, tee
from tests.readers.unit_loads import SUBCASES, unit_load_op2, unit_loads

GENUINE = Path(__file__).parents[3] / "data" / "nastran"
LAMBDA = [(2 * np.pi * f) ** 2 for f in (3.0, 8.0)]


def lights(results, model=None, **options):
    """Lights of the audit by check."""
    return {row.check: row.light for row in audit(results, model, **options).rows}


@pytest.fixture
def model(tmp_path):
    """The T joint's geometry."""
    (tmp_path / "tee.bdf").write_text(bulk(tee()))
    return read_bdf(tmp_path / "tee.bdf")


def two_modes(writer, subcase=1, own=((0.0, 0.0), (0.0, 0.0))):
    """Add forces of two modes."""
    blocks = []
    for mode in (1, 2):
        blocks += [
            writer.identification(2, 19, mode, 10, subcase=subcase, own=own[mode - 1]),
            writer.forces([ROW]),
        ]
    writer.table("OGPFB1", blocks)


def beside(writer, name, values, code=7, subcase=1):
    """Add a table with eigenvalues in its identifications."""
    blocks = []
    for mode, value in enumerate(values, start=1):
        blocks += [
            writer.identification(2, code, mode, 8, subcase=subcase, eigenvalue=value),
            writer.shape([(1, [1.0, *[0.0] * 5])]),
        ]
    writer.table(name, blocks)


def summary(writer, values, subcase=1, approach=2):
    """Add an eigenvalue summary."""
    lama = b"".join(
        writer.ints(mode, mode) + writer.reals(v, abs(v) ** 0.5, abs(v) ** 0.5 / (2 * np.pi), 2.0, 2 * v)
        for mode, v in enumerate(values, start=1)
    )
    writer.table("LAMA", [writer.identification(approach, 6, 0, 7, subcase=subcase), lama])


def written(path, *tables, dialect=None):
    """A 64-bit file to which each of the functions adds a table."""
    writer = Op2Writer(8, **({"dialect": dialect} if dialect else {}))
    for add in tables:
        add(writer)
    path.write_bytes(writer.close())
    return path


def test_genuine_file_without_summary():
    """MSC file without LAMA: 71.27, 75.96 and 125.79 Hz from word 6 of OUGV1; shapes, sign and balance are sound."""
    found = read_op2(GENUINE / "mode_solid_shell_bar.op2")
    assert found.frequency == pytest.approx([71.27, 75.96, 125.79], abs=0.005)
    assert found.shape.shape == (3, 25, 6)
    rows = {row.check: row for row in audit(found, read_bdf(GENUINE / "mode_solid_shell_bar.bdf")).rows}
    assert "red" not in {row.light for row in rows.values()}
    assert rows["sign"].finding == "work over omega^2, the generalised mass, from -1 to -1 in 3 modes: forces on_node"


def test_forces_of_the_genuine_file_state_their_eigenvalue(tmp_path):
    """Without OUGV1 and OQG1 the same frequencies stand in words 14 and 16 of the forces' own identifications."""
    data = (GENUINE / "mode_solid_shell_bar.op2").read_bytes()
    path = tmp_path / "a.op2"
    path.write_bytes(data.replace(b"OUGV1   ", b"XXXXX   ").replace(b"OQG1    ", b"XXX     "))
    found = read_op2(path)
    assert found.shape_node.size == 0
    assert found.frequency == pytest.approx([71.27, 75.96, 125.79], abs=0.005)


@pytest.mark.parametrize(
    ("name", "code"), [("OUGV1", 7), ("OUG1", 1), ("BOUGV1", 7), ("OUGV1PAT"[:8], 7), ("OQG1", 3), ("OQMG1", 39)]
)
def test_tables_that_state_eigenvalues(tmp_path, name, code):
    """Displacements in any frame and reactions; only those in the nodes' own frames are shapes."""
    path = written(tmp_path / "a.op2", lambda w: beside(w, name, LAMBDA, code), two_modes)
    found = read_op2(path)
    assert found.frequency == pytest.approx([3.0, 8.0])
    assert (found.shape_node.size > 0) == (name in ("OUGV1", "OUG1"))


@pytest.mark.parametrize(
    ("values", "wanted"),
    [
        ([0.0, LAMBDA[1]], [0.0, 8.0]),
        ([-4e-7, 1e-9], [1.00658e-4, 5.03292e-6]),
        ([0.0, 0.0], [np.nan, np.nan]),
        ([5e-324, 1e-323], [np.nan, np.nan]),
        ([np.nan, LAMBDA[1]], [np.nan, 8.0]),
        ([np.inf, np.inf], [np.nan, np.nan]),
        ([LAMBDA[0]], [3.0, np.nan]),
    ],
)
def test_what_is_an_eigenvalue(tmp_path, values, wanted):
    """Zeros beside numbers are rigid modes, negative ones count by size; zeros or integers alone are nothing."""
    path = written(tmp_path / "a.op2", lambda w: beside(w, "OQG1", values, 3), two_modes)
    assert read_op2(path).frequency == pytest.approx(wanted, rel=1e-5, nan_ok=True)


def test_modes_without_frequency_are_red(tmp_path, model):
    """Eigenvectors without any eigenvalue are not at 0 Hz: a red light names them, but for interface modes."""
    data = modal_op2(tee().results, word=8)
    at = data.index(b"LAMA")
    path = tmp_path / "a.op2"
    path.write_bytes(data[:at] + b"XXXX" + data[at + 4 :])
    found = read_op2(path)
    assert np.isnan(found.frequency).all()
    row = next(row for row in audit(found, model).rows if row.check == "frequencies")
    assert (row.light, row.value) == ("red", 5.0)
    assert "5 of 5 modes have no frequency, mode 1 the first" in row.finding
    assert "frequencies" not in lights(found, model, interface_modes=range(1, 6))
    path.write_bytes(data)
    assert "frequencies" not in lights(read_op2(path), model)
    with pytest.raises(DataError, match="5 of 5 modes have no frequency"):
        path.write_bytes(data[:at] + b"XXXX" + data[at + 4 :])
        convert(ConvertOptions(forces=path, mesh=tmp_path / "tee.bdf", out=tmp_path / "body"))


@pytest.mark.parametrize("table", ["LAMA", "OUGV1"])
def test_unstable_modes_are_told(tmp_path, table):
    """A negative eigenvalue is no frequency, unless it is the round-off of a rigid mode."""
    writer = Op2Writer(8)
    add = summary if table == "LAMA" else lambda w, values: beside(w, "OUGV1", values)
    add(writer, [-1e-6, -LAMBDA[1]])
    two_modes(writer)
    (tmp_path / "a.op2").write_bytes(writer.close())
    found = read_op2(tmp_path / "a.op2")
    (warning,) = [r for r in found.warnings if r.code == "unstable_mode"]
    assert "1 modes have a negative eigenvalue, mode 2 the first (-2526.62)" in warning.what


def test_own_words_of_forces_must_agree(tmp_path):
    """Words 14 and 16 of the forces count if they are an eigenvalue and its frequency; none may contradict."""
    own = ((LAMBDA[0], 3.0), (LAMBDA[1], 8.0))
    assert read_op2(written(tmp_path / "a.op2", lambda w: two_modes(w, own=own))).frequency == pytest.approx([3, 8])
    own = ((LAMBDA[0], 3.1), (LAMBDA[1], 8.0))
    found = read_op2(written(tmp_path / "a.op2", lambda w: two_modes(w, own=own)))
    assert found.frequency == pytest.approx([np.nan, 8.0], nan_ok=True)
    path = written(
        tmp_path / "a.op2", lambda w: beside(w, "OQG1", [4 * v for v in LAMBDA]), lambda w: two_modes(w, own=own)
    )
    with pytest.raises(DataError, match="mode 2 of subcase 1 is given with 8 and 16 Hz"):
        read_op2(path)
    path = written(path, lambda w: summary(w, LAMBDA), lambda w: beside(w, "OQG1", [1.0, 1.0]), two_modes)
    assert read_op2(path).frequency == pytest.approx([3.0, 8.0])


def test_summaries_of_several_subcases(tmp_path):
    """Every subcase has the frequencies of its own summary; one that stands alone serves any subcase."""
    four = [4 * v for v in LAMBDA]
    path = written(
        tmp_path / "a.op2",
        lambda w: summary(w, LAMBDA, 1),
        lambda w: summary(w, four, 2),
        lambda w: two_modes(w, 1),
        lambda w: two_modes(w, 2),
    )
    assert read_op2(path, 1).frequency == pytest.approx([3.0, 8.0])
    assert read_op2(path, 2).frequency == pytest.approx([6.0, 16.0])
    path = written(
        path,
        *(lambda w, v=v: summary(w, v, 0) for v in (LAMBDA, four)),
        lambda w: beside(w, "OUGV1", four),
        two_modes,
    )
    assert read_op2(path).frequency == pytest.approx([6.0, 16.0])
    assert read_op2(path).modal_mass.tolist() == [2.0, 2.0]
    path = written(path, lambda w: summary(w, LAMBDA, 9), two_modes)
    assert read_op2(path).frequency == pytest.approx([3.0, 8.0])
    path = written(path, lambda w: summary(w, LAMBDA, 8), lambda w: summary(w, four, 9), two_modes)
    assert np.isnan(read_op2(path).frequency).all()


def buckling(writer):
    """Add what a run of SOL 105 writes for its second subcase: load factors, shapes and forces."""
    summary(writer, [1.7, 2.9], 2, approach=8)
    for mode in (1, 2):
        writer.table("OUGV1", [writer.identification(8, 7, mode, 8, subcase=2), writer.shape([(1, [0.0] * 6)])])
    for mode in (1, 2):
        writer.table("OGPFB1", [writer.identification(8, 19, mode, 10, subcase=2), writer.forces([ROW])])


def test_buckling_shapes_are_refused_as_such(tmp_path):
    """Load factors are no frequencies; the static subcase of such a run can be named."""

    def static(writer):
        writer.table("OGPFB1", [writer.identification(1, 19, 0, 10), writer.forces([ROW])])

    def shapes(writer):
        writer.table("OUGV1", [writer.identification(7, 7, 1, 8), writer.shape([(1, [0.0] * 6)])])

    with pytest.raises(DataError, match=r"the shapes belong to a solution of buckling"):
        read_op2(written(tmp_path / "a.op2", shapes))
    with pytest.raises(DataError, match=r"solution of buckling.*no modes of vibration") as caught:
        read_op2(written(tmp_path / "a.op2", buckling))
    assert [problem.code for problem in caught.value.problems] == ["wrong_analysis"]
    path = written(tmp_path / "a.op2", static, buckling, dialect=OPTISTRUCT)
    with pytest.raises(DataError, match=r"buckling.*name the subcase to use: \[1\]"):
        read_op2(path)
    assert read_op2(path, 1).analysis == "static"
    with pytest.raises(DataError, match="buckling"):
        read_op2(path, 2)


def test_a_frequency_response_beside_the_modes(tmp_path):
    """Complex forces of another subcase do not stand in the way of the modes once their subcase is named."""

    def response(writer):
        head = writer.identification(5, 19, 0, 16, subcase=2)
        writer.table("OGPFB1", [head, writer.reals(*[0.0] * 16)])

    path = written(tmp_path / "a.op2", lambda w: summary(w, LAMBDA), two_modes, response)
    with pytest.raises(DataError, match=r"frequency response.*name the subcase to use: \[1\]"):
        read_op2(path)
    assert read_op2(path, 1).frequency == pytest.approx([3.0, 8.0])


def both(path, subcases=SUBCASES):
    """Modes of subcase 1 with their unit loads in one file."""
    writer = modal_tables(Op2Writer(8), tee().results)
    path.write_bytes(unit_load_op2(writer, subcases=subcases).close())
    return path


def test_unit_loads_beside_modes(tmp_path, model):
    """Static subcases named as interface modes join the modes; those not named are left out and told."""
    path = both(tmp_path / "both.op2")
    alone = read_op2(path)
    assert (alone.analysis, alone.mode.tolist()) == ("modal", [1, 2, 3, 4, 5])
    assert str(alone.warnings[0]).endswith(
        "3 static subcases (21, 22, 23) are left out beside the modes. Name them as interface modes if they are unit "
        "loads of the modal basis."
    )
    found = read_op2(path, interface=(21, 23))
    assert found.mode.tolist() == [1, 2, 3, 4, 5, 21, 23]
    assert found.static_modes == (21, 23)
    assert np.array_equal(found.frequency, [*alone.frequency, np.nan, np.nan], equal_nan=True)
    assert found.warnings[0].what.startswith("1 static subcases (22)")
    assert found.shape.shape == (7, len(tee().model.xyz), 6)
    count = 4 * len(tee().model.quads)
    assert np.array_equal(found.force[:5, :count], alone.force[:, :count])
    assert np.array_equal(found.force[6, :count], [row[3] for row in unit_loads()[2].rows[:count]])
    assert set(lights(found, model, interface_modes=(21, 23)).values()) == {"green"}
    assert read_op2(path, subcase=1, interface=(21,)).mode.tolist() == [1, 2, 3, 4, 5, 21]
    assert read_op2(path, subcase=22).mode.tolist() == [22]


def test_unit_loads_without_forces_are_told(tmp_path):
    """A request within one subcase holds there only; a subcase that is asked for lacks nothing."""
    writer = Op2Writer(8)
    for case in (21, 22):
        rows = [row[:2] for row in unit_loads()[0].shape]
        writer.table("OUGV1", [writer.identification(1, 1, 0, 8, subcase=case), writer.shape(rows)])
    writer.table("OGPFB1", [writer.identification(1, 19, 0, 10, subcase=22), writer.forces(unit_loads()[0].rows)])
    (tmp_path / "a.op2").write_bytes(writer.close())
    (warning,) = read_op2(tmp_path / "a.op2").warnings
    assert "1 static subcases have displacements and no grid point forces, subcase 21 the first" in warning.what
    assert not read_op2(tmp_path / "a.op2", 22).warnings


def test_shapes_in_any_order_of_grids(tmp_path, model):
    """Shapes whose grids do not ascend prove the sign as well; unit loads without displacements do not disturb it."""
    case = tee().results
    order = np.random.default_rng(2).permutation(case.shape_node.size)
    turned = replace(case, shape_node=case.shape_node[order], shape=case.shape[:, order])
    writer = modal_tables(Op2Writer(8), turned)
    path = tmp_path / "a.op2"
    path.write_bytes(unit_load_op2(writer, shapes=False).close())
    found = read_op2(path, interface=SUBCASES)
    assert np.array_equal(found.shape_node, case.shape_node)
    assert np.array_equal(found.shape[:5], case.shape)
    assert not found.shape[5:].any()
    assert lights(found, model, interface_modes=SUBCASES)["sign"] == "green"


def test_a_unit_load_with_the_number_of_a_mode(tmp_path):
    """A subcase cannot be told from a mode of the same number: it stays out, and the warning says why."""
    found = read_op2(both(tmp_path / "both.op2", (5, 21, 22)), interface=(5, 21, 22))
    assert found.mode.tolist() == [1, 2, 3, 4, 5, 21, 22]
    assert "subcase 5 has the number of a mode and needs another" in found.warnings[0].remedy


def test_coordinates_of_subcases_not_asked_for_remind_of_them(tmp_path):
    """Their forces are in the file, and the option that takes them is named."""
    (tmp_path / "tee.bdf").write_text(bulk(tee()))
    names = [f"q_{mode}" for mode in (1, 2, 3, 4, 5, *SUBCASES)]
    rows = [",".join(str(x) for x in (0.1 * k, *[0.0] * len(names))) for k in range(4)]
    (tmp_path / "q.csv").write_text("\n".join([",".join(["time_s", *names]), *rows]))
    options = ConvertOptions(
        forces=both(tmp_path / "both.op2"),
        mesh=tmp_path / "tee.bdf",
        out=tmp_path / "body",
        coordinates=(tmp_path / "q.csv",),
        static_subcases="leave_out",
    )
    with pytest.raises(DataError, match=r"modes 21, 22, 23 have .* 3 static subcases .*, name them with --interface"):
        convert(options)


def test_interface_modes_that_are_not_there(tmp_path):
    """Names of interface modes that are neither a mode nor a static subcase are told."""
    found = read_op2(both(tmp_path / "both.op2"), interface=(4, 21, 22, 23, 24, 25))
    assert found.mode.tolist() == [1, 2, 3, 4, 5, 21, 22, 23]
    assert [warning.what for warning in found.warnings] == [
        "of the interface modes named, 2 have no forces, 24 the first"
    ]


@pytest.mark.parametrize(("units", "length", "force"), [("mm-t-s", 1.0, 1.0), ("m-kg-s", 1000.0, 1.0)])
def test_unit_loads_in_the_neutral_folder(tmp_path, model, units, length, force):
    """Modes and unit loads from convert: kinds, frequencies, and forces and coordinates in the units of each."""
    both(tmp_path / "both.op2")
    names = ["time", *(f"q_{m}" for m in (1, 2, 3, 4, 5, *SUBCASES))]
    rows = [",".join(f"{0.01 * t if c == 'time' else c[2:]}" for c in names) for t in range(20)]
    (tmp_path / "q.csv").write_text("\n".join([",".join(names), *rows, ""]))
    convert(
        ConvertOptions(
            forces=tmp_path / "both.op2",
            mesh=tmp_path / "tee.bdf",
            out=tmp_path / "body",
            coordinates=(tmp_path / "q.csv",),
            interface_modes=SUBCASES,
            coordinate_units=units,
        )
    )
    modes, _ = read_modes(tmp_path / "body" / "modes.csv", (), strict=True)
    assert modes.kind == ("normal",) * 5 + ("interface",) * 3
    assert modes.frequency[5:].tolist() == [0.0] * 3
    forces = pq.read_table(tmp_path / "body" / "element_forces.parquet").to_pandas()
    wanted = -tee().model.element_forces(unit_loads()[1].displacement).reshape(-1, 6)
    part = forces[forces["mode"] == SUBCASES[1]].set_index(["element", "node"])
    for row, (element, corner) in enumerate(np.ndindex(len(tee().model.quads), 4)):
        key = (element + 1, tee().model.quads[element, corner] + 1)
        if key in part.index:
            assert part.loc[key, ["fx_N", "fy_N", "fz_N"]].to_numpy(float) == pytest.approx(wanted[row, :3], abs=1e-9)
    history = pq.read_table(tmp_path / "body" / "q_q.parquet").to_pandas()
    assert history["q_2"][3] == pytest.approx(2 * length * (1e-3 if units == "m-kg-s" else 1.0) ** 0.5, rel=1e-6)
    assert history[f"q_{SUBCASES[0]}"][3] == SUBCASES[0] * force
