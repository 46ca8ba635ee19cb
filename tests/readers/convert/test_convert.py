"""From foreign files to a neutral folder: forces, frames, units, offsets, registers, refusals."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
import pytest

from fatigue.errors import CaseError, DataError
from fatigue.readers.convert.case_text import register_named
from fatigue.readers.convert.convert import convert
from fatigue.readers.convert.folder import TABLES
from fatigue.readers.convert.options import ConvertOptions, WeldSources
from fatigue.readers.convert.weld_lines import list_welds
from fatigue.readers.neutral.body.mesh import read_mesh
from fatigue.readers.neutral.body.modes import read_modes
from fatigue.readers.neutral.body.welds import read_welds
from fatigue.readers.neutral.forces.element_forces import read_element_forces, read_weld_elements
from fatigue.readers.neutral.history import read_history
from fatigue.weld.element_forces import balance, side_forces
from tests.readers.neutral_tables import read_weld_nodes
from tests.readers.op2_writer import modal_op2
from tests.readers.tee_model import bulk, tee

NASTRAN = Path("data/nastran")


@pytest.fixture
def files(tmp_path):
    """Bulk data, forces and coordinates of the T joint."""
    case = tee()
    (tmp_path / "tee.bdf").write_text(bulk(case))
    (tmp_path / "tee.op2").write_bytes(modal_op2(case.results, word=8))
    time = np.arange(200) / 100
    q = np.stack([np.sin((k + 1) * time) for k in range(5)])
    rows = [f"{t:.9g}," + ",".join(f"{x:.9g}" for x in q[:, k]) for k, t in enumerate(time)]
    (tmp_path / "straight.csv").write_text("\n".join(["time," + ",".join(f"q_{k}" for k in range(1, 6)), *rows]) + "\n")
    return ConvertOptions(
        forces=tmp_path / "tee.op2",
        mesh=tmp_path / "tee.bdf",
        out=tmp_path / "body",
        coordinates=(tmp_path / "straight.csv",),
        interface_modes=(5,),
    )


def neutral(folder):
    """Read a converted folder back with the neutral readers, strictly."""
    modes, _ = read_modes(folder / "modes.csv", (), strict=True)
    welds, _ = read_welds(folder / "welds.csv", (), strict=True)
    lines, _ = read_weld_nodes(folder / "weld_nodes.csv", welds, strict=True)
    convention = "on_node" if 'force_convention = "on_node"' in (folder / "case.toml").read_text() else "on_element"
    forces, _ = read_element_forces(folder / "element_forces.parquet", modes, convention, (), strict=True)
    sides, _ = read_weld_elements(folder / "weld_elements.csv", welds, strict=True)
    mesh, _ = read_mesh(folder / "nodes.parquet", folder / "elements.parquet", strict=True)
    return modes, lines, forces, sides, mesh


def test_neutral_forces_are_those_of_the_model(files):
    """The folder holds, in basic axes and after frames, sign and file format, exactly K_e u_e of every plate side."""
    result = convert(files)
    case = tee()
    modes, lines, forces, sides, mesh = neutral(files.out)
    assert set(TABLES) <= set(result.files)
    assert not [
        name
        for name in set(result.files) - set(TABLES)
        if not name.startswith("q_") and "." in name and name not in ("case.toml", "welds_register.csv", "convert.json")
    ]
    assert result.audit.convention == "on_node"
    assert not result.audit.red
    assert len(lines) == 3
    for line in lines:
        found = side_forces((line,), sides[line.weld], forces, modes.mode, line.weld)[0]
        for k, u in enumerate(case.shape):
            wanted = case.model.side_forces(u, sides[line.weld] - 1, line.node - 1)
            assert np.allclose(found[:, k], wanted, rtol=0, atol=1e-9 * np.abs(wanted).max())
    state = balance(forces, dict(zip(mesh.node.tolist(), mesh.xyz, strict=True)))
    assert state.force_residual.max() < 1e-9


def test_lines_have_thickness_ends_and_sides_of_the_joint(files):
    """Two sides of the base, 6 + 2 elements each, and the upright's 6; normals point to the upright."""
    convert(files)
    _, lines, _, sides, _ = neutral(files.out)
    counts = sorted((line.thickness[0], sides[line.weld].size) for line in lines)
    assert counts == [(6.0, 6), (8.0, 8), (8.0, 8)]
    for line in lines:
        if line.thickness[0] == 8.0:
            assert np.allclose(line.normal, [0, 0, 1])
            assert np.allclose(np.abs(line.outward), [0, 1, 0])


def test_history_survives(files):
    """The history of the folder is the one given, to single precision."""
    convert(files)
    modes, *_ = neutral(files.out)
    history, _ = read_history(files.out / "q_straight.parquet", "straight", modes.mode, (), strict=True)
    assert history.step == pytest.approx(0.01)
    assert np.allclose(history.q[1], np.sin(2 * np.arange(200) / 100), atol=1e-6)


def test_folder_can_be_assessed(files, tmp_path):
    """The folder of one command is a case that the assessment accepts."""
    from fatigue.assess import assess  # noqa: PLC0415
    from fatigue.case import load_case  # noqa: PLC0415

    convert(files)
    assess(load_case(files.out / "case.toml"), tmp_path / "result")
    nodes = pq.read_table(tmp_path / "result" / "nodes.parquet")
    assert nodes.num_rows == 3 * 7 * 2


def test_units_cancel(files, tmp_path):
    """The same model in m, kg, s gives the same forces in N and N mm; its coordinates grow by sqrt(1e-3) x 1000.

    One coordinate of unit generalised mass 1 kg moves the body by 1 m where 1 t moves it by sqrt(1000) mm.
    """
    convert(files)
    unit = np.sqrt(1e-3) * 1000
    ours = tee().results
    metric = replace(
        ours,
        force=ours.force * unit * np.array([1.0] * 3 + [1e-3] * 3),
        shape=ours.shape * unit * np.array([1e-3] * 3 + [1.0] * 3),
    )
    (tmp_path / "m.op2").write_bytes(modal_op2(metric, word=8))
    (tmp_path / "m.bdf").write_text(in_metres(bulk(tee())))
    out, units = tmp_path / "metric", "m-kg-s"
    convert(
        replace(
            files,
            forces=tmp_path / "m.op2",
            mesh=tmp_path / "m.bdf",
            out=out,
            force_units=units,
            coordinate_units=units,
        )
    )
    for name in ("fx_N", "mx_Nmm"):
        a, b = (pq.read_table(f / "element_forces.parquet")[name].to_numpy() for f in (files.out, out))
        assert np.allclose(a, b, rtol=0, atol=1e-9 * np.abs(a).max())
    a, b = (pq.read_table(f / "q_straight.parquet")["q_2"].to_numpy() for f in (files.out, out))
    assert np.allclose(b, unit * a, rtol=1e-5)


def in_metres(text):
    """Bulk data with lengths divided by 1000."""
    lines = []
    for line in text.splitlines():
        cells = line.split(",")
        if cells[0] == "GRID":
            cells[3:6] = [f"{float(c) / 1000:.9f}" for c in cells[3:6]]
        if cells[0] == "PSHELL":
            cells[3] = f"{float(cells[3]) / 1000:.6f}"
        lines.append(",".join(cells))
    return "\n".join(lines)


def test_offset_moves_the_moments(files, tmp_path):
    """A shell offset z in pure membrane force f carries the moment of f about its mid-surface away."""
    lines = []
    for line in bulk(tee()).splitlines():
        cells = line.split(",")
        lines.append(line + ",,2.5" if cells[0] == "CQUAD4" and cells[2] == "1" else line)
    (tmp_path / "offset.bdf").write_text("\n".join(lines))
    convert(files)
    convert(replace(files, mesh=tmp_path / "offset.bdf", out=tmp_path / "offset"))
    flat, moved = (pq.read_table(f / "element_forces.parquet").to_pandas() for f in (files.out, tmp_path / "offset"))
    base, size = flat["element"] <= 96, 1e-9 * flat["mx_Nmm"].abs().max()
    # the grid is 2.5 mm below the mid-surface: M' = M + (-2.5 z) x F
    assert np.allclose((moved["mx_Nmm"] - flat["mx_Nmm"])[base], 2.5 * flat["fy_N"][base], atol=size)
    assert np.allclose((moved["my_Nmm"] - flat["my_Nmm"])[base], -2.5 * flat["fx_N"][base], atol=size)
    assert np.allclose(moved["mx_Nmm"][~base], flat["mx_Nmm"][~base])


def test_register_wins_on_the_next_run(files):
    """An excluded line stays excluded with its reason, a renamed one keeps its name and its end length."""
    convert(files)
    register = files.out / "welds_register.csv"
    rows = register.read_text().splitlines()
    rows[1] = rows[1].replace(",assess,,", ",excluded,ground flush,")
    cells = rows[2].split(",")
    cells[0], cells[13] = "my weld", "4.5"
    rows[2] = ",".join(cells)
    register.write_text("\n".join(rows) + "\n")
    result = convert(files)
    assert {row.reason for row in result.welds if row.status == "excluded"} == {"ground flush"}
    _, lines, *_ = neutral(files.out)
    assert "my weld" in {line.weld for line in lines}
    assert {line.end_length for line in lines} == {4.5, None}


def test_layered_section_needs_a_confirmation(files):
    """A PCOMP side is excluded until the register confirms its thickness."""
    files.mesh.write_text(bulk(tee()).replace("PSHELL,1,1,8.,1,,1", "PCOMP,1\n,1,4.,0.,,1,4.,90."))
    first = convert(files)
    layered = [row for row in first.welds if row.pid == 1]
    assert all(row.status == "excluded" and "layered" in row.reason for row in layered)
    elements = pq.read_table(files.out / "elements.parquet").to_pandas()
    assert elements.loc[elements.pid == 1, "unconfirmed"].str.contains("layered").all()
    assert elements.loc[elements.pid != 1, "unconfirmed"].isna().all()
    register = files.out / "welds_register.csv"
    plain = ["weld,line,status,thickness_mm,confirmed"]
    plain += [f"{row.weld},{row.line},assess,{7.5 if row.pid == 1 else 6},true" for row in first.welds]
    register.write_text("\n".join(plain) + "\n")
    convert(files)
    _, lines, *_ = neutral(files.out)
    assert sorted(line.thickness[0] for line in lines) == [6.0, 7.5, 7.5]


@pytest.mark.parametrize(
    ("change", "code", "words"),
    [
        ({"convention": "on_element"}, "audit", "forces on_node, but on_element is stated"),
        ({"subcase": 9}, "no_subcase", "subcase 9"),
        ({"coordinates": (Path("data/nastran/geom.inc"),)}, "no_coordinates", "format bdf"),
        ({"mesh": NASTRAN / "modes_elements.op2"}, "no_mesh", "format op2"),
        ({"forces": NASTRAN / "geom.inc"}, "no_forces", "format bdf"),
        ({"mesh": NASTRAN / "modes_elements.bdf"}, "audit", "not in the mesh"),
        ({"ignore_modes": (4, 5), "match": "order"}, "column_count", "5 columns for 3 modes"),
        ({"ignore_modes": (1, 2, 3, 4, 5)}, "no_modes", "all 5 modes with forces are left out"),
        ({"welds": WeldSources(sets=(8,))}, "no_set", "Sets found: 7"),
        ({"welds": WeldSources(markers=("PLOTEL",))}, "no_marker", "no PLOTEL"),
    ],
)
def test_refusals(files, change, code, words):
    """Every contradiction is refused with what was found, and nothing is written."""
    with pytest.raises(DataError, match=words) as caught:
        convert(replace(files, **change))
    assert code in {problem.code for problem in caught.value.problems}
    assert not files.out.exists()


def test_modes_must_agree(files, tmp_path):
    """A mode on one side only is refused by name; listed under ignore_modes it is left out on both."""
    text = files.coordinates[0].read_text().replace("q_5", "q_6")
    files.coordinates[0].write_text(text)
    with pytest.raises(DataError, match=r"modes 6 have coordinates and no forces(.|\n)*modes 5 have forces"):
        convert(files)
    result = convert(replace(files, ignore_modes=(5, 6), interface_modes=(4,)))
    assert result.modes == 4


def test_foreign_files_are_not_overwritten(files):
    """A folder of somebody else, or an edited case, is refused without force; an untouched conversion is repeated."""
    convert(files)
    convert(files)
    case = files.out / "case.toml"
    case.write_text(case.read_text() + "\n# mine\n")
    with pytest.raises(DataError, match="changed since it was converted"):
        convert(files)
    convert(replace(files, force=True))
    (files.out / "convert.json").unlink()
    with pytest.raises(DataError, match="not the work of an earlier conversion"):
        convert(files)
    with pytest.raises(DataError, match="this is a file"):
        convert(replace(files, out=files.mesh))


def test_audit_is_kept(files):
    """convert.json holds every check with its number, and the hashes of the inputs."""
    convert(files)
    record = json.loads((files.out / "convert.json").read_text())
    assert {row["check"] for row in record["audit"]} >= {
        "element balance",
        "sign",
        "grid totals",
        "displacement frames",
    }
    assert len(record["inputs"]) == 3


def test_notes_and_files_of_the_deck_are_kept(files):
    """What was left out of the deck is told and recorded, and an included file has its hash."""
    part = files.mesh.parent / "part.inc"
    part.write_text("DEQATN  1       F(A,B)= A/B\n$ 5\nFORCE,1,2,3\n")
    files.mesh.write_text(files.mesh.read_text().replace("BEGIN BULK\n", "BEGIN BULK\nINCLUDE 'part.inc'\n"))
    said = " ".join(str(r) for r in convert(files).warnings)
    record = json.loads((files.out / "convert.json").read_text())
    assert "1 DEQATN (part.inc, line 1), 1 FORCE (part.inc, line 3)" in said
    assert "1 DEQATN (part.inc, line 1)" in " ".join(record["remarks"])
    assert set(record["inputs"]) == {str(p) for p in (files.mesh, part, files.forces, *files.coordinates)}


def test_simulation_modes_scale_and_compare(files, tmp_path):
    """Masses of the simulation give the scale sqrt(M_sim / M_fe); frequencies 2 % apart are refused."""
    table = tmp_path / "modes_sim.csv"
    f = tee().frequency
    table.write_text("mode,frequency_hz,modal_mass\n" + "".join(f"{k + 1},{f[k]:.9g},{4.0}\n" for k in range(5)))
    convert(replace(files, simulation_modes=table, match="frequency"))
    modes, *_ = neutral(files.out)
    assert np.allclose(modes.scale, 2.0)
    table.write_text("mode,frequency_hz\n" + "".join(f"{k + 1},{1.02 * f[k]:.9g}\n" for k in range(5)))
    with pytest.raises(DataError, match="frequency match"):
        convert(replace(files, simulation_modes=table))


def test_modes_to_ignore_that_nobody_has(files):
    """They are told; those of one side only are not."""
    renamed(files, "time,q_1,q_2,q_3,q_4,q_5")
    told = [str(r) for r in convert(replace(files, ignore_modes=(1, 77))).warnings if r.code == "ignored_nowhere"]
    assert len(told) == 1
    assert told[0].startswith("--ignore-modes: neither the forces nor the coordinates have the modes 77.")


def test_masses_that_the_forces_do_not_state(files, tmp_path):
    """1 is assumed where the simulation's masses ask for them, and that is told."""
    table, f = tmp_path / "sim.csv", tee().frequency
    table.write_text("mode,frequency_hz,modal_mass\n" + "".join(f"{k},{f[k - 1]:.9g},4\n" for k in range(1, 6)))
    told = [warning.code for warning in convert(replace(files, simulation_modes=table)).warnings]
    assert "assumed_mass" not in told
    files.forces.write_bytes(modal_op2(replace(tee().results, modal_mass=np.zeros(5)), word=8))
    found = convert(replace(files, simulation_modes=table, force=True)).warnings
    assert any("states no generalised masses of the modes 1, 2, 3, 4, 5; 1 is assumed" in str(r) for r in found)


def renamed(files, names):
    """Give the columns of the coordinates other names."""
    path = files.coordinates[0]
    path.write_text("\n".join([names, *path.read_text().splitlines()[1:]]) + "\n")
    return files


@pytest.mark.parametrize(
    ("unit", "options", "message"),
    [
        (
            "m",
            {},
            r"the file states m; --coordinate-units mm-t-s and --normalisation mass make it mm\*sqrt\(t\)\. State",
        ),
        (
            "mm",
            {"coordinate_units": "m-kg-s"},
            r"states mm; --coordinate-units m-kg-s .* State --coordinate-units mm",
        ),
        ("m*sqrt(kg)", {}, r"the file states m\*sqrt\(kg\); .* State --coordinate-units m-kg-s\."),
        (
            "kg^0.5 m",
            {"coordinate_units": "m-kg-s", "normalisation": "length"},
            r"--normalisation length make it m\. State --normalisation mass",
        ),
        ("in", {}, "State --coordinate-units in-lbf-s"),
        ("cm", {}, r"Export the coordinates in mm\*sqrt\(t\), or in a system that --coordinate-units knows"),
        ("mm*sqrt(kg)", {}, r"Export the coordinates in mm\*sqrt\(t\)"),
        ("m/s", {}, "the unit 'm/s' is none of a modal coordinate"),
        ("rad", {}, "the unit 'rad' is none of a modal coordinate"),
    ],
)
def test_stated_units_of_coordinates(files, unit, options, message):
    """A unit that the options do not have is refused and names them; nothing is converted by a label."""
    renamed(files, ",".join(["time", *(f"q_{k} [{unit}]" for k in range(1, 6))]))
    with pytest.raises(DataError, match=message):
        convert(replace(files, **options))


@pytest.mark.parametrize("unit", ["mm*sqrt(t)", "mm t^0.5", "-", "sqrt(t) mm", "√t·mm"])
def test_units_that_agree(files, unit):
    """The unit of the options, or none, changes nothing."""
    renamed(files, ",".join(["time", *(f"q_{k} [{unit}]" for k in range(1, 6))]))
    result = convert(files)
    assert not [warning for warning in result.warnings if warning.code == "coordinate_unit"]
    history, _ = read_history(files.out / "q_straight.parquet", "straight", np.arange(1, 6), (), strict=True)
    assert np.allclose(history.q[1], np.sin(2 * np.arange(200) / 100), atol=1e-6)


def test_a_length_for_modes_of_unit_mass_is_a_doubt(files):
    """Many programs label any coordinate with a length: read as the options say, and told once."""
    renamed(files, ",".join(["time", *(f"q_{k} [mm]" for k in range(1, 6))]))
    (warning,) = [warning for warning in convert(files).warnings if warning.code == "coordinate_unit"]
    assert warning.where.endswith("column 'q_1 [mm]' and 4 more columns")
    assert warning.what == "the file states mm, a length; --normalisation mass takes it as mm*sqrt(t)"
    result = convert(replace(files, normalisation="length", force=True))
    assert not [warning for warning in result.warnings if warning.code == "coordinate_unit"]


def test_time_in_milliseconds(files):
    """Time arrives in seconds by its header."""
    path = files.coordinates[0]
    rows = [line.split(",") for line in path.read_text().splitlines()[1:]]
    text = "\n".join(";".join([f"{float(r[0]) * 1000:.9g}", *r[1:]]) for r in rows)
    path.write_text("Time [ms];" + ";".join(f"q_{k}" for k in range(1, 6)) + "\n" + text.replace(".", ",") + "\n")
    convert(files)
    history, _ = read_history(files.out / "q_straight.parquet", "straight", np.arange(1, 6), (), strict=True)
    assert history.step == pytest.approx(0.01)


def test_stated_frequencies_of_other_modes(files):
    """Names with frequencies that fit other modes are refused by number and in order, and joined by frequency."""
    f = tee().frequency
    swapped = [2, 1, 3, 4, 5]
    renamed(files, ",".join(["time", *(f"q_{k} ({f[s - 1]:.9g} Hz)" for k, s in enumerate(swapped, 1))]))
    for match in ("id", "order"):
        with pytest.raises(DataError, match=r"column 'q_1 .*its mode 1 has .* Join by --match frequency"):
            convert(replace(files, match=match))
    convert(replace(files, match="frequency"))
    history, _ = read_history(files.out / "q_straight.parquet", "straight", np.arange(1, 6), (), strict=True)
    assert np.allclose(history.q[0], np.sin(2 * np.arange(200) / 100), atol=1e-6)
    table = files.mesh.with_name("sim.csv")
    table.write_text("mode,frequency_hz\n" + "".join(f"{k},{f[s - 1]:.9g}\n" for k, s in enumerate(swapped, 1)))
    renamed(files, "time,q_1,q_2,q_3,q_4,q_5")
    with pytest.raises(DataError, match=r"its mode 1 has .* Join by --match frequency|frequency match"):
        convert(replace(files, simulation_modes=table))


def test_simulation_that_counts_from_1(files):
    """FE modes 7 to 11 against 1 to 5 of the simulation: the way to join them is proposed, and works."""
    shifted = replace(tee().results, mode=tee().results.mode + 6)
    files.forces.write_bytes(modal_op2(shifted, word=8))
    files = replace(files, interface_modes=(11,))
    with pytest.raises(DataError, match=r"If modes 1-5 of the simulation are modes 7-11 of the FE run, state --match"):
        convert(files)
    convert(replace(files, match="order"))
    history, _ = read_history(files.out / "q_straight.parquet", "straight", np.arange(7, 12), (), strict=True)
    assert np.allclose(history.q[1], np.sin(2 * np.arange(200) / 100), atol=1e-6)


def test_simulation_that_counts_rigid_modes(files):
    """Modes 7 to 11 of the simulation against 1 to 5 of the FE run, the other way round."""
    renamed(files, "time,q_7,q_8,q_9,q_10,q_11")
    with pytest.raises(DataError, match=r"If modes 7-11 of the simulation are modes 1-5 of the FE run, state --match"):
        convert(files)
    convert(replace(files, match="order"))


def test_simulation_without_rigid_modes(files):
    """Elastic modes counted from 1 against an FE run with rigid ones: what to ignore is said."""
    rigid = replace(tee().results, frequency=tee().frequency * [0, 0, 1, 1, 1])
    files.forces.write_bytes(modal_op2(rigid, word=8))
    path = files.coordinates[0]
    path.write_text("\n".join(",".join(line.split(",")[:4]) for line in path.read_text().splitlines()) + "\n")
    remedy = (
        "If modes 1-3 of the simulation are the elastic modes of the FE run, state --match order --ignore-modes 1-2"
    )
    with pytest.raises(DataError, match=remedy):
        convert(files)
    convert(replace(files, match="order", ignore_modes=(1, 2)))


def test_normalisation_a_file_declares(files):
    """Modes normalised to unity contradict --normalisation mass."""
    path = files.coordinates[0]
    path.write_text("% modes normalised to unity\n" + path.read_text())
    with pytest.raises(DataError, match=r"declares modes normalised to unity; .* State --normalisation length"):
        convert(files)
    convert(replace(files, normalisation="length"))


def test_masses_of_a_simulation_that_counts_from_1(files, tmp_path):
    """The table of the simulation's modes has its own numbers: masses arrive at the FE modes they belong to."""
    shifted = replace(tee().results, mode=tee().results.mode + 6)
    files.forces.write_bytes(modal_op2(shifted, word=8))
    table, f = tmp_path / "sim.csv", tee().frequency
    table.write_text("mode,frequency_hz,modal_mass\n" + "".join(f"{k},{f[k - 1]:.9g},{k * k}\n" for k in range(1, 6)))
    files = replace(files, interface_modes=(11,), simulation_modes=table)
    for match, names in (("order", "time,q_1,q_2,q_3,q_4,q_5"), ("frequency", None), ("order", "time,a,b,c,d,e")):
        convert(replace(renamed(files, names) if names else files, match=match, force=True))
        assert neutral(files.out)[0].scale == pytest.approx([1, 2, 3, 4, 5])
    table.write_text("mode,frequency_hz\n1,10\n2,20\n")
    with pytest.raises(DataError, match=r"2 modes for 5 columns of .*, which name none"):
        convert(replace(files, match="order"))
    table.write_text("mode,frequency_hz\n1,10\n1,20\n")
    with pytest.raises(DataError, match="mode 1 repeats row 1"):
        convert(files)


def test_frequencies_of_file_and_table_differ(files, tmp_path):
    """A header and the table of the simulation's modes that state different frequencies are refused."""
    table, f = tmp_path / "sim.csv", tee().frequency
    table.write_text("mode,frequency_hz\n" + "".join(f"{k},{f[k - 1]:.9g}\n" for k in range(1, 6)))
    renamed(files, ",".join(["time", *(f"q_{k} ({f[k - 1]:.2f} Hz)" for k in range(1, 6))]))
    convert(replace(files, simulation_modes=table))
    renamed(files, ",".join(["time", *(f"q_{k} ({1.001 * f[k - 1]:.2f} Hz)" for k in range(1, 6))]))
    with pytest.raises(DataError, match=r"sim\.csv: mode 1 has .* Hz, and .* Hz in .*straight\.csv"):
        convert(replace(files, simulation_modes=table, force=True))


def test_doubts_of_the_tables_are_told(files, tmp_path):
    """An unknown column of a map or of the table of modes is a warning, as are warnings about the coordinates."""
    columns, table, f = tmp_path / "columns.csv", tmp_path / "sim.csv", tee().frequency
    columns.write_text("column,mode,note\n" + "".join(f"q_{k},{k},x\n" for k in range(1, 6)))
    table.write_text("mode,frequency_hz,modal_mas\n" + "".join(f"{k},{f[k - 1]:.9g},4\n" for k in range(1, 6)))
    result = convert(replace(files, columns=columns, simulation_modes=table))
    told = [str(warning) for warning in result.warnings]
    recorded = json.loads((files.out / "convert.json").read_text())["remarks"]
    for words in ("columns.csv: column note: the column is unknown", "Rename it to 'modal_mass'"):
        assert any(words in warning for warning in told)
        assert any(words in warning for warning in recorded)


def test_system_of_units_a_file_declares(files):
    """A line of units contradicts --coordinate-units."""
    path = files.coordinates[0]
    path.write_text("% Units: m, kg, s\n" + path.read_text())
    with pytest.raises(
        DataError, match=r"declares lengths in m; --coordinate-units mm-t-s .* State --coordinate-units m"
    ):
        convert(files)
    convert(replace(files, coordinate_units="m-kg-s"))


def test_tables_beside_the_coordinates_in_german(files, tmp_path):
    """The map of columns and the table of modes are read in any layout; a column mapped twice is refused."""
    renamed(files, "time,a,b,c,d,e")
    columns, modes, f = tmp_path / "columns.csv", tmp_path / "sim.csv", tee().frequency
    columns.write_bytes("sep=;\r\ncolumn;mode\r\na;1\r\nb;2\r\nc;3\r\nd;4\r\ne;5\r\n".encode("utf-16"))
    rows = "".join(f"{k};{f[k - 1]:.9g};4,0D+00\n" for k in range(1, 6)).replace(".", ",")
    modes.write_bytes(("# Prüfstand\nmode;frequency_hz;modal_mass\n" + rows).encode("cp1252"))
    convert(replace(files, columns=columns, simulation_modes=modes))
    assert np.allclose(neutral(files.out)[0].scale, 2.0)
    columns.write_text("column,mode\na,1\nb,2\na,3\n")
    with pytest.raises(DataError, match=r"column column, row 3: column a repeats row 1"):
        convert(replace(files, columns=columns))


def test_columns_by_a_map_and_rigid_modes(files, tmp_path):
    """Columns of any name are mapped by a table; a rigid mode without coordinates is left out and told."""
    rigid = replace(tee().results, frequency=tee().frequency * [1, 1, 0, 1, 1])
    files.forces.write_bytes(modal_op2(rigid, word=8))
    text = files.coordinates[0].read_text().splitlines()
    files.coordinates[0].write_text("\n".join(["time,a,b,c,d,e", *text[1:]]) + "\n")
    columns = tmp_path / "columns.csv"
    columns.write_text("column,mode\na,1\nb,2\nd,4\ne,5\n")
    result = convert(replace(files, columns=columns))
    assert result.modes == 4
    assert "rigid modes 3 are left out" in " ".join(str(r) for r in result.warnings)


def test_welds_without_forces_are_left_out(files):
    """A side without forces, or touched by another kind of element, is excluded with the reason."""
    results = tee().results
    side = results.element == 44
    files.forces.write_bytes(modal_op2(_only(results, ~side & (results.kind != "*TOTALS*")), word=8))
    first = convert(files)
    reasons = [row.reason for row in first.welds if row.status == "excluded"]
    assert reasons == ["1 of 8 elements have no grid point forces, element 44 the first"]
    solid = results.node == tee().turned[0]
    extra = replace(
        results,
        node=np.append(results.node, results.node[solid][0]),
        element=np.append(results.element, 999),
        kind=np.append(results.kind, "HEXA"),
        force=np.concatenate([results.force, 0 * results.force[:, :1]], axis=1),
    )
    files.forces.write_bytes(modal_op2(extra, word=8))
    with pytest.raises(DataError, match="an element of kind HEXA touches the line at node"):
        convert(files)


def _only(results, keep):
    """Results with some of the rows."""
    return replace(
        results,
        node=results.node[keep],
        element=results.element[keep],
        kind=results.kind[keep],
        force=results.force[:, keep],
    )


def test_events_of_one_name_and_unwritable_folder(files, tmp_path):
    """Two files of one name become two events; a folder that cannot be made is refused."""
    (tmp_path / "other").mkdir()
    second = tmp_path / "other" / "straight.csv"
    second.write_text(files.coordinates[0].read_text())
    result = convert(replace(files, coordinates=(*files.coordinates, second)))
    assert {"q_straight.parquet", "q_straight_2.parquet"} <= set(result.files)
    with pytest.raises(DataError, match="cannot be written"):
        convert(replace(files, out=files.mesh / "sub"))


def test_wing_box_from_inches(tmp_path):
    """The wing box gives its 8 T lines from 3 sides, which balance at every inner node to single precision."""
    name = "wingbox_stitched_together-000"
    options = ConvertOptions(
        NASTRAN / f"{name}.op2", NASTRAN / f"{name}.bdf", tmp_path / "wing", force_units="in-lbf-s"
    )
    result = convert(options)
    assert [row.nodes for row in result.welds if row.status == "assess"] == [33] * 24
    modes, lines, forces, sides, _ = neutral(options.out)
    sums: dict[int, np.ndarray] = {}
    largest = 0.0
    for line in lines:
        force = side_forces((line,), sides[line.weld], forces, modes.mode, line.weld)[0][1:-1, 0, :3]
        largest = max(largest, np.abs(force).max())
        for node, f in zip(line.node[1:-1].tolist(), force, strict=True):
            sums[node] = sums.get(node, 0.0) + f
    assert len(sums) == 8 * 31
    assert np.abs(list(sums.values())).max() < 1e-6 * largest


def test_a_check_to_accept_that_there_is_not(files):
    """A misspelt name accepts nothing: it is told with the names there are."""
    said = [str(problem) for problem in convert(replace(files, accept=("grid total", "sign"))).warnings]
    (line,) = [line for line in said if "--accept" in line]
    assert line.startswith("--accept 'grid total': the audit has no such check. Choose of completeness, ")
    assert "grid totals, " in line


def test_the_register_to_edit(tmp_path):
    """It is the one that the case names: a kept case may name another; one that cannot be read is another's matter."""
    case = tmp_path / "case.toml"
    assert register_named(case) == "welds_register.csv"
    for text, name in (('[body]\nregister = "mine ä.csv"', "mine ä.csv"), ("body = 3", ""), ("[body", "")):
        case.write_text(text, encoding="utf-8")
        assert register_named(case) == (name or "welds_register.csv")


def test_what_to_do_when_all_lines_are_left_out(files, tmp_path):
    """No register is written then: the command that writes one is told."""
    register = tmp_path / "mine.csv"
    list_welds(files.mesh, WeldSources(), "mm-t-s", register, overwrite=False)
    register.write_text(register.read_text().replace(",assess,", ",excluded,"))
    with pytest.raises(DataError, match=r"none of the 3 weld lines") as refused:
        convert(replace(files, welds=WeldSources(register=register)))
    assert f"`fatigue welds {files.mesh} -o welds_register.csv` writes it, --register reads it" in str(refused.value)


def test_undecided_sign_is_refused(files, tmp_path):
    """Without mode shapes nothing proves the sign: it has to be stated."""
    bare = replace(tee().results, shape_node=np.empty(0, np.int64), shape=np.empty((5, 0, 6)))
    files.forces.write_bytes(modal_op2(bare, word=8))
    with pytest.raises(CaseError, match="do not prove the sign"):
        convert(files)
    assert convert(replace(files, convention="on_node")).modes == 5
