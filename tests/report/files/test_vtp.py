"""The ParaView file against the table it is made from."""

import base64
from xml.etree import ElementTree as ET

import numpy as np
import pandas as pd
import pytest

from fatigue.errors import DataError
from fatigue.report.files.vtp import write_vtp
from fatigue.results import NODES
from tests.report.tiny_result import Recipe, write_result

TYPES = {"Float64": "<f8", "Int64": "<i8", "UInt8": "u1", "Int8": np.int8}


def arrays(path):
    """All data arrays of the file by name, and the attributes of its piece."""
    piece = ET.parse(path).getroot().find("PolyData/Piece")
    found = {}
    for element in piece.iter("DataArray"):
        raw = base64.b64decode(element.text)
        length, content = int.from_bytes(raw[:8], "little"), raw[8:]
        assert length == len(content)
        if element.get("type") == "String":
            found[element.get("Name")] = content.decode().removesuffix("\0").split("\0")
        else:
            values = np.frombuffer(content, dtype=TYPES[element.get("type")])
            found[element.get("Name")] = values.reshape(-1, int(element.get("NumberOfComponents"))).squeeze()
    return found, piece.attrib


def test_every_column_of_both_faces_is_point_data(result_folder, tmp_path):
    """Columns equal the table of nodes bit for bit, texts and flags included."""
    found, piece = arrays(write_vtp(result_folder))
    nodes = pd.read_parquet(result_folder / "nodes.parquet")
    for face in ("top", "bottom"):
        rows = nodes[nodes["surface"] == face]
        assert piece["NumberOfPoints"] == str(len(rows))
        np.testing.assert_array_equal(found["Points"], rows[["x_mm", "y_mm", "z_mm"]])
        for column in NODES:
            if column.name in ("x_mm", "y_mm", "z_mm", "surface"):
                continue
            name = column.name if column.name in found else f"{column.name}_{face}"
            missing = {"text": "", "flag": -1}.get(column.type)
            expected = rows[column.name] if missing is None else rows[column.name].fillna(missing)
            np.testing.assert_array_equal(found[name], expected, err_msg=name)


def test_one_line_for_each_weld(result_folder):
    """Lines join the nodes of a weld in their order and no others."""
    found, piece = arrays(write_vtp(result_folder))
    assert piece["NumberOfLines"] == "2"
    np.testing.assert_array_equal(found["offsets"], [6, 12])
    np.testing.assert_array_equal(found["connectivity"], np.arange(12))
    np.testing.assert_array_equal(found["weld_number"], np.repeat([1, 2], 6))


def test_a_closed_line_returns_to_its_first_point(tmp_path):
    """The ring is closed by the first point, which is not repeated in the data."""
    found, piece = arrays(write_vtp(write_result(tmp_path, Recipe(welds=("ring",), stations=4, closed=True))))
    assert piece["NumberOfPoints"] == "4"
    np.testing.assert_array_equal(found["connectivity"], [0, 1, 2, 3, 0])


def test_names_cannot_break_the_file(tmp_path):
    """Markup, quotes and other scripts come back as they were; the file is ASCII and well-formed."""
    names = ('<a href="x">&\'</DataArray>', "שלום", "\x01 control")
    path = write_vtp(write_result(tmp_path, Recipe(welds=names, stations=2)))
    path.read_text(encoding="ascii")
    found, _ = arrays(path)
    assert found["weld"] == [name for name in names for _ in range(2)]


def test_the_same_result_gives_the_same_bytes(result_folder):
    """No clock and no chance in the file."""
    assert write_vtp(result_folder).read_bytes() == write_vtp(result_folder).read_bytes()


def test_a_folder_without_result_is_refused(tmp_path):
    """The message says which table is missing."""
    with pytest.raises(DataError, match=r"nodes\.parquet: no such result table"):
        write_vtp(tmp_path)


def test_lines_can_be_coloured_and_made_tubes_at_once(tmp_path):
    """The array shown at first is finite: utilisation and life of the worse toe face, whatever the other one says."""
    folder = write_result(tmp_path, Recipe(toes="bottom", stations=4))
    path = write_vtp(folder)
    found, _ = arrays(path)
    bottom = pd.read_parquet(folder / "nodes.parquet").query("surface == 'bottom'")
    np.testing.assert_array_equal(found["worst_utilisation"], bottom["utilisation"])
    np.testing.assert_array_equal(found["worst_life_km"], bottom["life_km"])
    assert '<PointData Scalars="worst_utilisation">' in path.read_text(encoding="ascii")
    ends = np.append(0, found["offsets"])
    assert all(np.diff(ends) >= 2)


def test_an_infinite_life_does_not_spoil_the_colour_scale(tmp_path):
    """It is 1e12 km there."""
    found, _ = arrays(write_vtp(write_result(tmp_path, Recipe(level=0.0, stations=2))))
    assert set(found["worst_life_km"]) == {1e12}
    assert np.isinf(found["life_km_top"]).all()


def test_of_two_toe_faces_the_worse_one_is_shown(result_folder):
    """The larger utilisation of both."""
    found, _ = arrays(write_vtp(result_folder))
    largest = np.maximum(found["utilisation_top"], found["utilisation_bottom"])
    np.testing.assert_array_equal(found["worst_utilisation"], largest)
