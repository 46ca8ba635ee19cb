"""Rows of gauges: numbers of the specification, closed forms on a small plate, stand-ins, and what is refused."""

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pandas as pd
import pytest

from fatigue.case import load_case
from fatigue.errors import DataError
from fatigue.gauges.gauge_file import read_gauges
from fatigue.gauges.near import neighbours
from fatigue.gauges.rows import gauge_rows
from fatigue.pipeline.solve.body import read_body
from fatigue.pipeline.solve.model import read_model
from fatigue.pipeline.solve.weld_groups import weld_groups
from tests.carbody_loads import FOLDER
from tests.gauge_case import FACE_STRAIN, NU, SHEAR, STRAIN, E, gauge_case

HEAD = (
    "gauge,kind,element,x_mm,y_mm,z_mm,normal_x,normal_y,normal_z,angle_deg,dir_x,dir_y,dir_z,surface,point,weld,order,"
    "grid_length_mm,transverse_sensitivity,thickness_mm,E_MPa,nu\n"
)
MODES = (1, 2, 7)


def table(*rows):
    """Text of a table of gauges."""
    return HEAD + "".join(f"{row}\n" for row in rows)


def rows_of(case_file, gauges):
    """Rows of a case, and the warnings about them."""
    body = read_body(load_case(case_file), strict=False)
    with TemporaryDirectory() as scratch:
        return gauge_rows(weld_groups(body, Path(scratch)), read_gauges(gauges)[0])


def found(case, folder):
    """Rows of a small case by the name of the gauge, (3,) each [1e-6 per unit of modes 1, 2, 7]."""
    rows, _ = rows_of(*case.write(folder))
    return dict(zip(rows.names, rows.strain, strict=True))


def refused(case, folder):
    """What is said of gauges that cannot be had."""
    with pytest.raises(DataError) as error:
        rows_of(*case.write(folder))
    return str(error.value)


ORACLE = (  # measured_oracles.json, gauge_rows: element, surface, angle, modes 1 to 8, modes 50 to 52, rms at 350 sound
    (
        (15245, "top", 90),
        [-0.130961176, 0.0998431103, -0.0383510552, 0.0201907148, 0.0109262071, 0.171877564, 0.177503749, -0.790736052],
        [-46.8346424, 66.6219649, 16.0034824],
        30.9172211,
    ),
    (
        (8807, "top", 45),
        [0.774527323, 1.26252382, 1.45276576, -1.60531586, -3.49131517, -5.59382314, -5.55430557, 14.1082268],
        [365.297297, -141.674343, 17.4900123],
        8.97899153,
    ),
    (
        (2709, "bottom", 0),
        [-2.03132465, -4.87318583, -4.67033489, -0.149136777, 2.1636753, 3.92733062, -4.27877138, 4.92854949],
        [116.670007, 149.473776, 146.343639],
        1.98592292,
    ),
    (
        (2663, "top", 135),
        [-0.719806169, -1.1874747, -2.35747289, -2.19817902, -2.17714501, 2.13392023, 2.20822519, -0.421748387],
        [-714.38291, -861.391181, -353.085373],
        0.836645298,
    ),
)


@pytest.fixture(scope="module")
def carbody(tmp_path_factory):
    """Rows on the car body at the elements of the oracle and at a stress point on one of them, and the body."""
    folder = tmp_path_factory.mktemp("carbody")
    text = (FOLDER / "case_gauges.toml").read_text("utf-8")
    forces = FOLDER.parents[1] / "tests" / "data" / "carbody_element_forces.parquet"
    files = [line for line in text.splitlines() if ' = "' in line and (".parquet" in line or ".csv" in line)]
    for name in {line.split('"')[1] for line in files}:
        text = text.replace(f'"{name}"', f'"{(FOLDER / name).as_posix()}"')
    text = text.replace((FOLDER / "gauge_forces.parquet").as_posix(), forces.as_posix())
    (folder / "case.toml").write_text(text, encoding="utf-8")
    listed = [f"o{i},element,{e},,,,,,,{a},,,,{s},,,,,,,," for i, ((e, s, a), *_) in enumerate(ORACLE)]
    listed += ["haz_neg_300,table,,,,,,,,0,,,,top,,,,,,,,", "same,element,8807,,,,,,,,-1,0,0,top,,,,,,,,"]
    listed += ["below,table,,,,,,,,90,,,,bottom,haz_neg_300,,,,,,,", "under,element,8807,,,,,,,,0,1,0,bottom,,,,,,,,"]
    listed += ["hot,table,,,,,,,,0,,,,top,toe_neg_300,,,,,,,", "toe,toe,,,,,,,,,,,,bottom,,W1_roof_bracket_att,1,,,,,"]
    (folder / "gauges.csv").write_text(table(*listed), encoding="utf-8")
    rows, warnings = rows_of(folder / "case.toml", folder / "gauges.csv")
    assert warnings == []
    return rows, load_case(folder / "case.toml")


def test_the_rows_of_the_specification(carbody):
    """measured_oracles.json, gauge_rows: 1e-5 of the largest entry; rms of the reading in [0, 60) Hz."""
    rows, _ = carbody
    q = pd.read_parquet(FOLDER / "q_350_sound_14hz.parquet")
    q = q[q["time_s"] - q["time_s"].iloc[0] >= 1.0 - 0.002].drop(columns="time_s").to_numpy(float).T
    spectrum = np.fft.rfft(q - q.mean(axis=1, keepdims=True), axis=1)
    spectrum[:, np.fft.rfftfreq(q.shape[1], 0.004) >= 60.0] = 0.0
    limited = np.fft.irfft(spectrum, q.shape[1], axis=1)
    for row, (_, first, last, rms) in zip(rows.strain, ORACLE, strict=False):
        largest = np.abs(row).max()
        assert np.abs(row[:8] - first).max() < 1e-5 * largest
        assert np.abs(row[-3:] - last).max() < 1e-5 * largest
        assert float((row @ limited).std()) == pytest.approx(rms, rel=1e-5)


def test_a_stress_point_and_the_element_under_it_agree(carbody):
    """The same place by two ways: stress of the element's own field in a table, and the mean from corner forces."""
    rows, _ = carbody
    of = dict(zip(rows.names, rows.strain, strict=True))
    assert of["same"] == pytest.approx(of["haz_neg_300"], rel=1e-5, abs=1e-6)
    assert of["under"] == pytest.approx(of["below"], rel=1e-5, abs=1e-6)
    assert [grid.stand_in for grid in rows.grids] == [False] * 8 + [True, True]


def test_a_stand_in_is_the_raw_structural_stress_in_plane_strain(carbody):
    """measured_data.md 1.4: 1e6 (1 - nu^2)/E times the raw stress of the face, at a weld end that is treated."""
    rows, case = carbody
    stations = read_model(case).stations
    of_weld = np.array(stations.names)[stations.weld] == "W1_roof_bracket_att"
    at = int(np.flatnonzero(of_weld & (stations.order == 1))[0])
    raw = stations.raw_ends.stress
    end = int(np.flatnonzero(stations.raw_ends.rows == at)[0])
    expected = raw.membrane[end] - raw.bending[end]
    i = rows.names.index("toe")
    assert rows.strain[i] == pytest.approx(1e6 * (1 - 0.33**2) / 69000.0 * expected, rel=1e-12)
    assert rows.stress[i] == pytest.approx(expected, rel=1e-12)
    treated = stations.treated.membrane[at] - stations.treated.bending[at]
    assert np.abs(treated - expected).max() > 0.01 * np.abs(expected).max()


def test_closed_forms_of_a_plate_in_tension_bending_and_shear(tmp_path):
    """Along, across and at 45 degrees, on both faces: bending flips, tension and shear do not."""
    case = gauge_case(
        table(
            "x,element,101,,,,,,,0,,,,top,,,,,,,,",
            "y,element,101,,,,,,,90,,,,top,,,,,,,,",
            "d,element,101,,,,,,,45,,,,top,,,,,,,,",
            "xb,element,101,,,,,,,0,,,,bottom,,,,,,,,",
            "k,element,101,,,,,,,0,,,,top,,,,,0.01,,,",
        )
    )
    of = found(case, tmp_path)
    assert of["x"] == pytest.approx([1e6 * STRAIN, 1e6 * FACE_STRAIN, 0.0], abs=1e-7)
    assert of["y"] == pytest.approx([-NU * 1e6 * STRAIN, -NU * 1e6 * FACE_STRAIN, 0.0], abs=1e-7)
    half = 0.5 * (1 - NU)
    assert of["d"] == pytest.approx([half * 1e6 * STRAIN, half * 1e6 * FACE_STRAIN, 0.5e6 * SHEAR], abs=1e-7)
    assert of["xb"] == pytest.approx([1e6 * STRAIN, -1e6 * FACE_STRAIN, 0.0], abs=1e-7)
    assert of["k"] == pytest.approx((of["x"] + 0.01 * of["y"]) / (1.0 - 0.285 * 0.01))


def test_stress_is_that_along_the_grid(tmp_path):
    """Uniaxial tension: E strain along, nothing across."""
    rows, _ = rows_of(
        *gauge_case(table("x,element,101,,,,,,,0,,,,top,,,,,,,,", "y,element,101,,,,,,,90,,,,top,,,,,,,,")).write(
            tmp_path
        )
    )
    assert rows.stress[:, 0] == pytest.approx([E * STRAIN, 0.0], abs=1e-9)


def test_the_angle_is_that_from_the_elements_own_x(tmp_path):
    """Trap 6: element 104 lists its corners from another one on. Its x is the car's y; a vector does not care."""
    case = gauge_case(
        table(
            "angle,element,104,,,,,,,0,,,,top,,,,,,,,",
            "vector,element,104,,,,,,,,0,5,0,top,,,,,,,,",
            "car,element,104,,,,,,,,1,0,2,top,,,,,,,,",
        )
    )
    of = found(case, tmp_path)
    assert of["angle"][0] == pytest.approx(-NU * 4e6 * STRAIN)
    assert of["vector"] == pytest.approx(of["angle"])
    assert of["car"][0] == pytest.approx(4e6 * STRAIN)


def test_by_place_it_is_the_same_as_by_element(tmp_path):
    """From above and from below; the projection is what counts, and a triangle is found as well."""
    case = gauge_case(
        table(
            "above,element,,30,1005,1,0,0,1,,1,0,0,,,,,,,,,",
            "top,element,102,,,,,,,0,,,,top,,,,,,,,",
            "below,element,,30,1005,-1,0,0,-1,,1,0,0,,,,,,,,,",
            "bottom,element,102,,,,,,,0,,,,bottom,,,,,,,,",
            "triangle,element,,85,1003,1,0,0,1,,1,0,0,,,,,,,,,",
        )
    )
    of = found(case, tmp_path)
    assert of["above"] == pytest.approx(of["top"])
    assert of["below"] == pytest.approx(of["bottom"])
    assert of["triangle"] == pytest.approx([5e6 * STRAIN, 1e6 * FACE_STRAIN, 0.0], abs=1e-6)


def test_a_long_grid_is_the_mean_over_its_length(tmp_path):
    """20 mm on element 102, 10 mm on 103; across an edge to element 104, whose axes are others."""
    case = gauge_case(
        table(
            "mean,element,,35,1005,1,0,0,1,,1,0,0,,,,,30,,,,",
            "turned,element,,60,1005,1,0,0,1,,1,0,0,,,,,20,,,,",
        )
    )
    of = found(case, tmp_path)
    assert of["mean"][0] == pytest.approx(1e6 * STRAIN * (2 * 20 + 3 * 10) / 30)
    assert of["turned"][0] == pytest.approx(1e6 * STRAIN * (3 + 4) / 2)


def test_a_grid_across_two_materials_reads_each_in_its_own(tmp_path):
    """The same forces on half the modulus are twice the strain, under the grid and on a neighbour."""
    case = gauge_case(table("mean,element,,35,1005,1,0,0,1,,1,0,0,,,,,30,,,,", "x,element,102,,,,,,,0,,,,top,,,,,,,,"))
    case.elements.loc[case.elements.element == 103, "pid"] = 3
    soft = pd.DataFrame({"pid": [3], "E_MPa": E / 2, "nu": NU, "thickness_mm": 2.0, "bending_thickness_mm": 2.0})
    case.properties = pd.concat([case.properties, soft.assign(rho_t_mm3=0.0)])
    rows, _ = rows_of(*case.write(tmp_path))
    mean, at_102 = rows.strain[:, 0]
    assert mean == pytest.approx(1e6 * STRAIN * (2 * 20 + 2 * 3 * 10) / 30)
    tension = np.diag([1.0, 0.0, 0.0])
    beside = neighbours(rows.gauges[1], rows.grids[1], rows.plates, tension)  # 101 reads 1, 103 now 2 x 3 instead of 2
    assert (beside.count, beside.largest) == (2, pytest.approx(6.0 / 2.0 - 1.0))
    assert at_102 == pytest.approx(1e6 * STRAIN * 2)


def test_scale_of_modes_and_the_sense_of_forces_apply(tmp_path):
    """Trap 7: ``scale`` multiplies gauge rows as it does forces; ``on_node`` turns their sign."""
    text = table("x,element,101,,,,,,,0,,,,top,,,,,,,,")
    plain = found(gauge_case(text), tmp_path / "plain")["x"]
    scaled = gauge_case(text)
    scaled.case.modes["scale"] = [2.0, -1.0, 1.0]
    assert found(scaled, tmp_path / "scaled")["x"] == pytest.approx(plain * [2.0, -1.0, 1.0])
    other = gauge_case(text)
    other.body["force_convention"] = "on_node"
    assert found(other, tmp_path / "other")["x"] == pytest.approx(-plain)


def test_material_of_the_row_goes_before_that_of_the_property(tmp_path):
    """Strain from the same forces on half the modulus is twice as much; the stress is the same."""
    text = table("own,element,101,,,,,,,0,,,,top,,,,,,,35000,0.3", "toe,toe,,,,,,,,,,,,top,,A,2,,,,,")
    rows, _ = rows_of(*gauge_case(text).write(tmp_path))
    assert rows.strain[0, 0] == pytest.approx(2e6 * STRAIN)
    assert rows.grids[1].material.E == E  # both properties are of one material
    assert rows.stress[1, 0] == pytest.approx(1.5)  # membrane 1 and bending 0.5 MPa of the small case


def test_a_thickness_confirmed_by_hand_opens_a_layered_section(tmp_path):
    """As for welds: refused with both thicknesses, taken with that of the row; thinner is more stress."""
    row = "s,element,101,,,,,,,0,,,,top,,,,,,{},,"
    case = gauge_case(table(row.format("")))
    case.elements.loc[case.elements.element == 101, "pid"] = 2
    said = refused(case, tmp_path / "refused")
    assert "element 101, property 2, is 2 mm thick and bends as 30 mm: it is no homogeneous plate" in said
    assert "confirm the thickness of the plate there: thickness_mm in its row" in said
    opened = gauge_case(table(row.format(1)))
    opened.elements.loc[opened.elements.element == 101, "pid"] = 2
    of = found(opened, tmp_path / "opened")["s"]
    assert of[:2] == pytest.approx([2e6 * STRAIN, 4e6 * FACE_STRAIN])


def test_a_section_that_a_conversion_doubts_is_refused(tmp_path):
    """The column ``unconfirmed`` of the elements says why; by hand it can be confirmed."""
    row = "s,element,101,,,,,,,0,,,,top,,,,,,{},,"
    case = gauge_case(table(row.format("")))
    case.elements["unconfirmed"] = ["PCOMP 1 is a layered section", *[""] * (len(case.elements) - 1)]
    said = refused(case, tmp_path / "refused")
    assert "surface of element 101 does not follow from its forces: PCOMP 1 is a layered section" in said
    opened = gauge_case(table(row.format(2)))
    opened.elements["unconfirmed"] = case.elements["unconfirmed"]
    assert found(opened, tmp_path / "opened")["s"][0] == pytest.approx(1e6 * STRAIN)


@pytest.mark.parametrize(
    ("row", "message"),
    [
        ("g,element,999,,,,,,,0,,,,top,,,,,,,,", "there is no element 999 in the mesh of the case"),
        ("g,element,106,,,,,,,0,,,,top,,,,,,,,", "element 106 has no forces in gauge_forces.csv"),
        ("g,element,,30,1040,1,0,0,1,,1,0,0,,,,,,,,,", "no element whose normal is within 20 degrees of the given one"),
        (
            "g,element,,30,1005,4.5,0,0,1,,1,0,0,,,,,,,,,",
            "the nearest element 102 is 4.5 mm away, more than twice",
        ),
        ("g,element,101,,,,,,,,0,0,1,top,,,,,,,,", "its direction is along the normal of the plate"),
        ("g,element,,30,1005,1,0,0,1,,0,1,0,,,,,40,,,,", "its grid of 40 mm leaves the plate 5 mm from its middle"),
        ("g,table,,,,,,,,0,,,,top,P1,,,,,,,", "it is of kind table, and the case has no stress points"),
        ("g,toe,,,,,,,,,,,,top,,Z,1,,,,,", "there is no weld 'Z' that is assessed"),
        ("g,toe,,,,,,,,,,,,top,,A,99,,,,,", "weld A has no node of order 99, but 1 to 7"),
    ],
)
def test_what_cannot_be_had_is_told(tmp_path, row, message):
    """With the gauge and its row."""
    said = refused(gauge_case(table(row)), tmp_path)
    assert message in said
    assert "gauges.csv: gauge 'g' (row 1)" in said


def test_all_gauges_that_cannot_be_had_are_told_at_once(tmp_path):
    """Not only the first."""
    rows = ["a,element,999,,,,,,,0,,,,top,,,,,,,,", "b,toe,,,,,,,,,,,,top,,Z,1,,,,,"]
    said = refused(gauge_case(table(*rows)), tmp_path)
    assert "gauge 'a'" in said
    assert "gauge 'b'" in said


def test_material_is_never_assumed(tmp_path):
    """Without properties and without E and nu in the row, and with a property that the table does not have."""
    case = gauge_case(table("g,element,101,,,,,,,0,,,,top,,,,,,,,"))
    case.properties = None
    assert "E_MPa and nu are known from nowhere. Give them in the row" in refused(case, tmp_path / "none")
    case = gauge_case(table("g,element,101,,,,,,,0,,,,top,,,,,,,,"))
    case.properties = case.properties[case.properties.pid == 2]
    assert "property 1 is not in properties.csv" in refused(case, tmp_path / "other")
    case = gauge_case(table("g,toe,,,,,,,,,,,,top,,A,2,,,,,"))
    case.properties.loc[1, "E_MPa"] = 1.0
    assert "E_MPa and nu are empty, and properties.csv has several materials" in refused(case, tmp_path / "several")


def test_bad_rows_of_forces_are_told(tmp_path):
    """A corner without a mode, a node that the element does not have, forces out of balance, no file at all."""
    text = table("g,element,101,,,,,,,0,,,,top,,,,,,,,")
    gone = gauge_case(text)
    gone.forces = gone.forces[~((gone.forces.element == 101) & (gone.forces.node == 12) & (gone.forces["mode"] == 2))]
    assert "element 101 of gauge_forces.csv has no row at node 12 for mode 2" in refused(gone, tmp_path / "gone")
    lost = gauge_case(text)
    lost.forces = lost.forces[lost.forces["mode"] != 2]
    assert "element 101 of gauge_forces.csv has no row at node 1 for mode 2" in refused(lost, tmp_path / "lost")
    strange = gauge_case(text)
    of_one = (strange.forces.element == 101) & (strange.forces.node == 12)
    strange.forces.loc[of_one, "node"] = 13
    assert "has forces at node 13, which is none of its nodes" in refused(strange, tmp_path / "strange")
    loose = gauge_case(text)
    of_one = ((loose.forces.element == 101) & (loose.forces.node == 12)).to_numpy()
    loose.forces.loc[of_one, "fx_N"] *= 1.2
    assert "the forces of element 101 in gauge_forces.csv are out of balance by" in refused(loose, tmp_path / "loose")
    absent = gauge_case(text)
    case_file, gauges = absent.write(tmp_path / "absent")
    (case_file.parent / "gauge_forces.csv").unlink()
    with pytest.raises(DataError, match=r"gauge_forces.csv"):
        rows_of(case_file, gauges)
    without = case_file.read_text("utf-8").replace('gauge_forces = "gauge_forces.csv"', "")
    case_file.write_text(without, encoding="utf-8")
    with pytest.raises(DataError, match="gauges of kind element need element forces and the mesh"):
        rows_of(case_file, gauges)


def test_moments_about_the_normal_need_not_be_given(tmp_path):
    """Without mz the forces of shear do not balance in moment, and that is no fault of theirs."""
    case = gauge_case(table("g,element,101,,,,,,,45,,,,top,,,,,,,,"))
    before = found(case, tmp_path / "with")["g"]
    case = gauge_case(table("g,element,101,,,,,,,45,,,,top,,,,,,,,"))
    case.forces["mz_Nmm"] = 0.0
    assert found(case, tmp_path / "without")["g"] == pytest.approx(before)
