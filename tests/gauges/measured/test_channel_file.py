"""The table of channels: what each reads, and everything that makes no sense in it, told with row and remedy."""

import pytest

from fatigue.errors import DataError
from fatigue.gauges.measured.channel_file import read_channels


def channels(tmp_path, text, gauges=("A", "B", "roof left")):
    """Read a table from its text."""
    path = tmp_path / "channels.csv"
    path.write_text(text)
    return read_channels(path, gauges)


def test_a_table_with_everything(tmp_path):
    """Gauges, a bridge, reserved channels, full scale, group, modulus."""
    found = channels(
        tmp_path,
        "channel,file_column,gauge,bridge,unit,full_scale_ue,sync_group,E_MPa\n"
        "C1,SG 1,A,,ue,2000,amp 1,\n"
        "C2,SG 2,,A:0.5; roof left:-0.5,mV/V,,amp 1,\n"
        "C3,,B,,MPa,,,70000\n"
        "V,speed kmh,speed,,km/h,,,\n",
    )
    first, second, third = found.strain
    assert (first.name, first.column, first.gauge, first.terms) == ("C1", "SG 1", "A", (("A", 1.0),))
    assert (first.full_scale_ue, first.sync_group, first.ue_per_unit) == (2000.0, "amp 1", 1.0)
    assert second.terms == (("A", 0.5), ("roof left", -0.5))
    assert second.gauge == "A:0.5; roof left:-0.5"
    assert (third.column, third.full_scale_ue) == ("C3", None)
    assert third.ue_per_unit == pytest.approx(1e6 / 70000)
    assert list(found.reserved) == ["speed"]
    assert found.reserved["speed"].column == "speed kmh"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("channel,unit,gauge\nC1,ue,\n", "names no gauge. Give a gauge of the table of gauges"),
        ("channel,unit,gauge,bridge\nC1,ue,A,A:1\n", "names both a gauge and a bridge"),
        ("channel,unit,gauge\nC1,ue,roof lefft\n", "there is no gauge 'roof lefft'. Write 'roof left'"),
        ("channel,unit,gauge\nC1,ue,X\n", "column gauge, row 1: there is no gauge 'X'. Add a row"),
        ("channel,unit,bridge\nC1,ue,A:1; Q:2\n", "column bridge, row 1: there is no gauge 'Q'"),
        ("channel,unit,bridge\nC1,ue,A; B\n", "'A' is no gauge with a weight apart from 0. Write A:1; B:-1"),
        ("channel,unit,bridge\nC1,ue,A:0\n", "'A:0' is no gauge with a weight apart from 0"),
        ("channel,unit,bridge\nC1,ue,A:inf\n", "'A:inf' is no gauge with a weight"),
        ("channel,unit,gauge\nC1,um/m,A\n", "'um/m' is no unit of strain. Give one of ue, mV/V, V, MPa"),
        ("channel,unit,gauge\nV,mph,speed\nC1,ue,A\n", "'mph' is no unit of speed. Give one of km/h, m/s"),
        ("channel,unit,gauge\nC1,MPa,A\n", "is in MPa, and the modulus that made stress of its strain is not given"),
        ("channel,unit,gauge,E_MPa\nC1,ue,A,70000\n", "has a modulus E_MPa and is in ue"),
        ("channel,unit,gauge,E_MPa\nC1,MPa,A,-1\n", "column E_MPa, row 1: -1 is not above 0"),
        ("channel,unit,gauge,full_scale_ue\nC1,ue,A,0\n", "column full_scale_ue, row 1: 0 is not above 0"),
        ("channel,unit,gauge\nC1,ue,A\nC1,ue,B\n", "channel C1 repeats row 1"),
        ("channel,unit,gauge\nV,km/h,speed\nW,m/s,speed\nC1,ue,A\n", "has several channels of speed"),
        ("channel,unit,gauge\nV,km/h,speed\n", "names no channel of a gauge"),
        ("channel,gauge\nC1,A\n", "column unit"),
    ],
)
def test_mistakes_are_told(tmp_path, text, said):
    """Exit code 3, file and row, value and what to do."""
    with pytest.raises(DataError) as caught:
        channels(tmp_path, text)
    assert said in str(caught.value)
    assert "channels.csv" in str(caught.value)


def test_a_gauge_may_not_have_a_reserved_name(tmp_path):
    """A channel of the gauge "speed" would be a speed."""
    with pytest.raises(DataError, match="'speed' names what a channel measures, and a gauge has this name"):
        channels(tmp_path, "channel,unit,gauge\nC1,ue,A\n", gauges=("A", "speed"))


def test_all_mistakes_are_told_at_once(tmp_path):
    """One line each."""
    with pytest.raises(DataError) as caught:
        channels(tmp_path, "channel,unit,gauge\nC1,bar,A\nC2,ue,X\n")
    assert len(caught.value.problems) == 2
