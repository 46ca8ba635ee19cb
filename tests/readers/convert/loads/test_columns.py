"""Columns of unit loads among modal coordinates."""

from dataclasses import replace

import pyarrow.parquet as pq
import pytest

from fatigue.errors import DataError
from fatigue.readers.convert.convert import convert
from fatigue.readers.convert.loads.names import LoadName
from tests.readers.static_files import MODES, static_files


def test_a_column_of_a_load_becomes_one_of_the_history(tmp_path):
    """Whatever numbers its name holds, and with a unit behind; it is not scaled as coordinates are."""
    columns = (*MODES, "u_tunnel_pressure [kPa]", "u_load_1_g_vertical")
    options = replace(
        static_files(tmp_path, columns=columns),
        unit_load_names=(LoadName(1, "tunnel_pressure", 5.0, "kPa"),),
        coordinate_units="m-kg-s",
    )
    done = convert(options)
    found = pq.read_table(options.out / "q_straight.parquet").to_pandas()
    assert list(found) == ["time_s", *MODES, "u_tunnel_pressure", "u_load_1_g_vertical"]
    assert found["u_tunnel_pressure"].to_numpy() == pytest.approx(
        found["q_1"].to_numpy() * 6 / found["q_1"].max() * (found["u_tunnel_pressure"].max() / 6), abs=1e-6
    )
    assert found["u_tunnel_pressure"].max() == pytest.approx(6, rel=1e-3)
    assert found["q_1"].max() == pytest.approx(1000 * 1e-3**0.5, rel=1e-3)
    told = [w for w in done.warnings if w.code == "unit_load_not_given"]
    assert [w.what for w in told] == [
        "events do not give unit load coupler_draft: until they do, or when_missing says zero, the case is refused"
    ]


def test_the_unit_of_a_column_is_that_of_the_load(tmp_path):
    """A unit that the load has not is refused, with the way to state it."""
    options = static_files(tmp_path, columns=(*MODES, "u_tunnel_pressure [kPa]"))
    said = r"it states kPa; the load is in subcase 1. State --unit-load-name 1 tunnel_pressure AMOUNT kPa"
    with pytest.raises(DataError, match=said):
        convert(options)


def test_a_load_has_one_column(tmp_path):
    """Two columns of one load cannot be told apart."""
    options = static_files(tmp_path, columns=(*MODES, "u_coupler_draft", "u_coupler_draft [subcase 2]"))
    with pytest.raises(DataError, match="another column gives this load, too"):
        convert(options)
