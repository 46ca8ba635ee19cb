"""Displacements as simulations export them: units in the header, layouts, refusals."""

import numpy as np
import pandas as pd
import pytest

from fatigue.errors import DataError
from fatigue.readers.convert.displacement.record import read_displacement


def written(path, name, separator=",", values=(1.0, 2.0, 4.0)):
    """Write a table of three instants."""
    rows = [f"{k / 100}{separator}{v}" for k, v in enumerate(values)]
    path.write_text("\n".join([f"time_s{separator}{name}", *rows]) + "\n", encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("name", "factor"),
    [
        ("displacement_mm", 1.0), ("displacement_m", 1000.0), ("uz [m]", 1000.0), ("u_z (mm)", 1.0), ("z/cm", 10.0),
        ("disp_in", 25.4), ("w [µm]", 1e-3), ("M", 1000.0), ("displacement", 7.0), ("$B_Car.disp(3)", 7.0),
        ("maximum", 7.0),
    ],
)  # fmt: skip
def test_the_unit_of_the_header_holds(tmp_path, name, factor):
    """Without one the displacement is in the unit of length of the coordinates, here 7 mm."""
    record = read_displacement(written(tmp_path / "u.csv", name), 7.0)
    assert np.allclose(record.value, factor * np.array([1.0, 2.0, 4.0]))
    assert np.allclose(record.time, [0.0, 0.01, 0.02])


def test_other_layouts_and_parquet(tmp_path):
    """What the reader of coordinates takes, this takes."""
    semicolons = written(tmp_path / "u.txt", "u_mm", ";")
    semicolons.write_text(semicolons.read_text().replace(".", ","))
    pd.DataFrame({"time_s": [0.0, 0.01, 0.02], "u_mm": [1.0, 2.0, 4.0]}).to_parquet(tmp_path / "u.parquet")
    for path in (semicolons, tmp_path / "u.parquet"):
        assert np.allclose(read_displacement(path, 1.0).value, [1.0, 2.0, 4.0])


@pytest.mark.parametrize(("unit", "factor"), [("m", 1000.0), ("[mm]", 1.0), ("-", 7.0)])
def test_a_row_of_units_holds(tmp_path, unit, factor):
    """As a unit in the name does."""
    path = tmp_path / "u.csv"
    path.write_text(f"time,displacement\ns,{unit}\n0,1\n0.01,2\n0.02,4\n", encoding="utf-8")
    assert np.allclose(read_displacement(path, 7.0).value, factor * np.array([1.0, 2.0, 4.0]))


@pytest.mark.parametrize("unit", ["m/s", "rad", "mm/s^2", "kN"])
def test_what_is_no_length_is_refused(tmp_path, unit):
    """A velocity is no displacement."""
    with pytest.raises(DataError, match=f"u.csv, column 'uz .{unit[:2]}.*no unit of length"):
        read_displacement(written(tmp_path / "u.csv", f"uz [{unit}]"), 1.0)


def test_one_displacement_it_has_to_be(tmp_path):
    """Several columns are refused with some of their names."""
    path = tmp_path / "u.csv"
    path.write_text("time_s,ux_mm,uy_mm,uz_mm\n0,1,2,3\n1,1,2,3\n2,1,2,3\n")
    with pytest.raises(DataError, match="3 columns beside time, 'ux_mm' and 'uz_mm' among them"):
        read_displacement(path, 1.0)


def test_broken_files_are_refused_by_name(tmp_path):
    """Missing, not a number, time that runs back."""
    with pytest.raises(DataError, match=r"none.csv"):
        read_displacement(tmp_path / "none.csv", 1.0)
    with pytest.raises(DataError, match=r"u.csv"):
        read_displacement(written(tmp_path / "u.csv", "u_mm", values=(1.0, "nan", 2.0)), 1.0)
    with pytest.raises(DataError, match=r"u.csv, column 'u_mm': a value of 1e\+200 is no displacement"):
        read_displacement(written(tmp_path / "u.csv", "u_mm", values=(1.0, 1e200, 2.0)), 1.0)
    (tmp_path / "back.csv").write_text("time_s,u_mm\n0,1\n2,1\n1,1\n")
    with pytest.raises(DataError, match=r"back.csv, line 4, sample 3"):
        read_displacement(tmp_path / "back.csv", 1.0)


def test_of_an_instant_written_twice_the_later_sample_counts(tmp_path):
    """As it does of coordinates."""
    path = tmp_path / "twice.csv"
    path.write_text("time_s,u_mm\n0,1\n1,2\n1,3\n2,4\n")
    assert read_displacement(path, 1.0).value.tolist() == [1.0, 3.0, 4.0]


def test_a_name_and_a_row_of_units_that_disagree(tmp_path):
    """Neither is preferred."""
    path = tmp_path / "u.csv"
    path.write_text("time_s,u_mm\ns,m\n0,1\n1,2\n2,3\n")
    with pytest.raises(DataError, match=r"column 'u_mm': its name states mm, and the row of units .* m\. Correct"):
        read_displacement(path, 1.0)
