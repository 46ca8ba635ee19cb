"""What output databases have besides the plain case: double precision, solids, varying thickness, other modes."""

import importlib.util
from pathlib import Path
from types import SimpleNamespace as Is

import numpy as np
import pytest

from fatigue.errors import DataError
from fatigue.readers.foreign.read import read_forces, read_model
from tests.readers.foreign.export.odb_stand_in import tee_database
from tests.readers.tee_model import tee


@pytest.fixture(scope="module")
def export():
    """Function of the script itself."""
    spec = importlib.util.spec_from_file_location("abaqus_export", Path("data/requests/abaqus_export.py"))
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.export


class HomogeneousSolidSection:
    """A section of solids, which has no thickness, or 1."""

    thickness = None


class DoubleValue:
    """A value in double precision: Abaqus refuses the other attribute."""

    precision = "DOUBLE_PRECISION"

    def __init__(self, value):
        """As the single one."""
        self.__dict__.update({k: v for k, v in vars(value).items() if k != "data"})
        self.dataDouble = value.data

    @property
    def data(self):
        """Refused."""
        raise RuntimeError("OdbError: use dataDouble")


def test_double_precision(export, tmp_path):
    """The same numbers."""
    odb = tee_database(tee())
    for frame in odb.steps["modes"].frames:
        for output in frame.fieldOutputs.values():
            output.values = [DoubleValue(value) for value in output.values]
    export(odb, str(tmp_path / "double.txt"))
    export(tee_database(tee()), str(tmp_path / "single.txt"))
    assert (tmp_path / "double.txt").read_bytes() == (tmp_path / "single.txt").read_bytes()


def test_sections_of_solids_are_passed_by(export, tmp_path):
    """They are no doubt and no thickness."""
    odb = tee_database(tee())
    odb.sections["upright"] = HomogeneousSolidSection()
    assert export(odb, str(tmp_path / "t.txt")) == []
    assert np.isnan(read_model(tmp_path / "t.txt").mesh.thickness[-1])


def test_thickness_by_the_field_sth(export, tmp_path):
    """Each element has its own; where it varies over one it is unknown, and told."""
    odb = tee_database(tee())
    own = odb.rootAssembly.instances["TEE-1"]
    odb.sections["base"].thicknessField = "field-1"
    values = [Is(instance=own, elementLabel=e, data=7.0 + e % 2) for e in range(1, 90) for _ in range(4)]
    values[0] = Is(instance=own, elementLabel=1, data=9.0)
    odb.steps["modes"].frames[0].fieldOutputs["STH"] = Is(values=values)
    told = export(odb, str(tmp_path / "t.txt"))
    assert [line for line in told if "section base" in line and "unknown at" in line]
    thickness = read_model(tmp_path / "t.txt").mesh.thickness
    assert np.isnan(thickness[0])
    assert thickness[1:5].tolist() == [7.0, 8.0, 7.0, 8.0]


def test_buckling_modes_are_no_modes(export, tmp_path):
    """Their frames have a mode number as well."""
    odb = tee_database(tee())
    odb.steps["modes"].procedure = "*FREQUENCY"
    odb.steps["buckle"] = Is(**(vars(odb.steps["modes"]) | {"name": "buckle", "procedure": "*BUCKLE"}))
    assert export(odb, str(tmp_path / "t.txt")) == ["step buckle has no real modes of vibration and is left out"]


def test_masses_belong_to_their_modes(export, tmp_path):
    """By the number of the mode and not by the row: modes may be left out of the database."""
    odb = tee_database(tee())
    step = odb.steps["modes"]
    step.historyRegions["Assembly"].historyOutputs["GM"].data = [(k + 1.0, 10.0 * (k + 1)) for k in range(5)]
    del step.frames[2]
    assert export(odb, str(tmp_path / "t.txt")) == []
    found = read_forces(tmp_path / "t.txt", None)
    assert found.mode.tolist() == [1, 3, 4, 5]
    assert found.modal_mass.tolist() == [10.0, 30.0, 40.0, 50.0]


@pytest.mark.parametrize(("old", "new"), [("\n1 1 ", "\n1 1.5 "), ("\n1 0.000", "\n1 nan ")])
def test_numbers_that_are_none_in_the_mesh(export, tmp_path, old, new):
    """Half an id, a place that is not finite."""
    export(tee_database(tee()), str(tmp_path / "t.txt"))
    text = (tmp_path / "t.txt").read_text()
    assert old in text
    (tmp_path / "t.txt").write_text(text.replace(old, new, 1))
    with pytest.raises(DataError, match="line"):
        read_model(tmp_path / "t.txt")
