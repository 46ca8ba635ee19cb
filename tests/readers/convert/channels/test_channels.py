"""Channels of recordings listed and written, and read by a case as if they had always been a table."""

import json

import numpy as np
import pandas as pd
import pyarrow.parquet as pq
import pytest

from fatigue.errors import CaseError, DataError
from fatigue.gauges.measured.channel_file import Channel
from fatigue.gauges.measured.record_files import open_records
from fatigue.readers.convert.channels.listed import list_channels
from fatigue.readers.convert.channels.written import write_channels
from fatigue.readers.neutral.event.channel_file import read_channel
from tests.command_line import fatigue as run
from tests.readers.foreign.channels.rpc_writer import write_rpc

VALUES = np.random.default_rng(3).standard_normal((3, 256))
T = 0.5 + 0.002 * np.arange(256)


@pytest.fixture
def archive(tmp_path):
    """A recording with two groups: fast channels, and one slow one."""
    np.savez(tmp_path / "plain.npz", time=T, strain=VALUES[0], load=VALUES[1])
    return tmp_path / "plain.npz"


def test_a_recording_is_listed(tmp_path):
    """Names, units, rate and start of every group."""
    write_rpc(tmp_path / "run.rsp", VALUES, step=0.002, names=["e1", "e2", "v"], units=["ue", "ue", "km/h"], kind="f4")
    found = list_channels(tmp_path / "run.rsp")
    (group,) = found.groups
    assert group.channels == (("e1", "ue"), ("e2", "ue"), ("v", "km/h"))
    assert (group.samples, group.start, group.is_even) == (256, 0.0, True)
    assert group.step == pytest.approx(0.002)
    assert "every 0.002 s (500 Hz)" in found.as_text()
    assert found.as_text().startswith("run.rsp is an RPC III file")


@pytest.mark.parametrize("ending", [".csv", ".parquet"])
def test_a_written_table_is_read_as_a_channel_of_a_case(tmp_path, archive, ending):
    """Values and times to the last bit, the start kept; under the name it was given."""
    out = tmp_path / f"table{ending}"
    written = write_channels(archive, out, channels=["strain=s", "load"])
    assert written.columns == (("s", ""), ("load", ""))
    found = read_channel(out, "s", "-")
    np.testing.assert_array_equal(found.values, VALUES[0])
    assert (found.grid.start, found.grid.samples) == (0.5, 256)
    frame = pd.read_parquet(out) if ending == ".parquet" else pd.read_csv(out)
    assert list(frame.columns) == ["time_s", "s", "load"]
    np.testing.assert_array_equal(frame["time_s"], T)


@pytest.mark.parametrize("ending", [".csv", ".parquet"])
def test_units_go_with_the_columns(tmp_path, ending):
    """A case that says another one is refused by them."""
    write_rpc(tmp_path / "run.rsp", VALUES, names=["a", "b", "c"], units=["g", "m/s2", ""], kind="f4")
    out = tmp_path / f"table{ending}"
    write_channels(tmp_path / "run.rsp", out)
    assert read_channel(out, "a", "g").grid.samples == 256
    with pytest.raises(DataError, match="unit"):
        read_channel(out, "a", "m/s2")
    if ending == ".parquet":
        assert pq.read_schema(out).field("b").metadata == {b"unit": b"m/s2"}


def test_text_parquet_and_mcf_are_recordings_too(tmp_path):
    """Time is recognised by its name and turned into seconds."""
    pd.DataFrame({"Time [ms]": 1e3 * T, "q_1 [mm]": VALUES[0]}).to_csv(tmp_path / "a.csv", index=False)
    pd.DataFrame({"time_s": T, "q_1": VALUES[0]}).to_parquet(tmp_path / "a.parquet")
    for name in ("a.csv", "a.parquet"):
        (group,) = list_channels(tmp_path / name).groups
        assert len(group.channels) == 1
        assert group.start == pytest.approx(0.5)
        assert group.step == pytest.approx(0.002)


def test_several_groups_are_told_by_name_or_by_their_channels(tmp_path):
    """Nothing is mixed on other times."""
    xlsxwriter = pytest.importorskip("xlsxwriter")
    pytest.importorskip("python_calamine")
    path = tmp_path / "run.xlsx"
    with xlsxwriter.Workbook(path) as book:
        for name, step in (("fast", 1), ("slow", 4)):
            sheet = book.add_worksheet(name)
            for k, cell in enumerate(["time", f"v_{name}"]):
                sheet.write(0, k, cell)
            for r, (t, v) in enumerate(zip(T[::step], VALUES[0, ::step], strict=True), 1):
                sheet.write(r, 0, t)
                sheet.write(r, 1, v)
    with pytest.raises(DataError, match="its groups with time are 'fast', 'slow'"):
        write_channels(path, tmp_path / "x.csv")
    assert write_channels(path, tmp_path / "x.csv", group="slow").samples == 64
    assert write_channels(path, tmp_path / "y.csv", channels=["v_fast"]).samples == 256
    with pytest.raises(DataError, match="there is no group 'none'"):
        write_channels(path, tmp_path / "z.csv", group="none")
    with pytest.raises(DataError, match="has no channel 'v_slow'"):
        write_channels(path, tmp_path / "z.csv", group="fast", channels=["v_slow"])


def test_what_a_case_could_not_read_is_refused(tmp_path, archive):
    """No time, uneven steps, names twice, an ending, a file in the way."""
    np.savez(tmp_path / "uneven.npz", time=np.where(np.arange(256) < 100, T, T + 1.0), a=VALUES[0])
    with pytest.raises(DataError, match="between samples 100 and 101"):
        write_channels(tmp_path / "uneven.npz", tmp_path / "x.csv")
    with pytest.raises(DataError, match="two columns would be named 'load'"):
        write_channels(archive, tmp_path / "y.csv", channels=["strain=load", "load"])
    with pytest.raises(CaseError, match=r"ends in '\.txt'"):
        write_channels(archive, tmp_path / "y.txt")
    (tmp_path / "x.csv").write_text("in the way")
    with pytest.raises(DataError, match="the file exists"):
        write_channels(archive, tmp_path / "x.csv")
    assert write_channels(archive, tmp_path / "x.csv", force=True).samples == 256
    with pytest.raises(DataError, match="the recording itself"):
        write_channels(tmp_path / "x.csv", tmp_path / "x.csv", force=True)


def test_the_command(tmp_path, archive):
    """Listed for eyes and machines, written, and refused with exit code 2 or 3."""
    listed = run("channels", archive)
    assert listed.returncode == 0
    assert "2 channels, 256 samples, from 0.5 s for 0.51 s, every 0.002 s (500 Hz)" in listed.stdout
    record = json.loads(run("channels", archive, "--json").stdout)
    assert [one["channel"] for one in record["groups"][0]["channels"]] == ["strain", "load"]
    written = run("channels", archive, "-o", tmp_path / "out.parquet", "--channel", "strain=e")
    assert written.returncode == 0
    assert "time_s and 1 channel, 256 samples" in written.stdout
    assert run("channels", archive, "--group", "a").returncode == 2
    assert run("channels", tmp_path / "none.mf4").returncode == 3
    assert run("channels", archive, "-o", tmp_path / "out.parquet").returncode == 3


@pytest.mark.parametrize("ending", [".csv", ".parquet"])
def test_gauges_read_what_is_written(tmp_path, ending):
    """Strain with its unit and its missing samples, which are told when they are written."""
    strain = np.where(np.arange(256) == 9, np.nan, VALUES[0])
    np.savez(tmp_path / "run.npz", **{"time": T, "SG 1": strain})
    out = tmp_path / f"table{ending}"
    (problem,) = write_channels(tmp_path / "run.npz", out).warnings
    assert problem.code == "missing_samples"
    assert "1 of all samples are missing or no numbers, sample 10 the first" in problem.what
    gauge = Channel("SG 1", "channels.csv", "SG 1", (), "", "ue")
    (record,), _ = open_records([out], [gauge], 500.0)
    np.testing.assert_array_equal(record.read(gauge), strain)
    with pytest.raises(DataError, match="SG 1"):
        read_channel(out, "SG 1", "-")


@pytest.mark.parametrize(
    ("head", "units", "step"),
    [
        ("time,a,b\nms,g,kN\n", ["g", "kN"], 0.002),
        ("Time;a;b\n[ms];[ue];[km/h]\n", ["ue", "km/h"], 0.002),
        ("time\ta\tb\ns\tm/s2\t1/min\n", ["m/s2", "1/min"], 2.0),
        ("time,a [g],b\n", ["g", ""], 2.0),
    ],
)
def test_a_row_of_units_is_read_whatever_they_are(tmp_path, head, units, step):
    """Time in milliseconds is never taken for seconds because a channel beside it has an unknown unit."""
    separator = next(sign for sign in ",;\t" if sign in head)
    rows = "".join(separator.join(map(str, row)) + "\n" for row in ((0, 1, 2), (2, 3, 4), (4, 5, 6)))
    (tmp_path / "run.csv").write_text(head + rows)
    (group,) = list_channels(tmp_path / "run.csv").groups
    assert [unit for _, unit in group.channels] == units
    assert group.step == pytest.approx(step)


def test_gaps_are_told(tmp_path):
    """Where, how long, and the step of the rest."""
    np.savez(tmp_path / "run.npz", time=np.where(np.arange(256) < 100, T, T + 1.0), a=VALUES[0])
    listed = list_channels(tmp_path / "run.npz")
    ((begin, length),) = listed.groups[0].gaps
    assert (begin, length) == (pytest.approx(T[99]), pytest.approx(1.002))
    assert listed.groups[0].step == pytest.approx(0.002)
    assert "in uneven steps; 1 gap, the first at 0.698 s of 1.002 s" in listed.as_text()
    assert listed.as_record()["groups"][0]["gaps"] == [{"from_s": begin, "length_s": length}]


def test_channels_of_one_name_and_names_with_an_equals_sign(tmp_path):
    """Numbered, and told; taken as they are."""
    (tmp_path / "twice.csv").write_text("time,a,a,b=c\n0,1,2,5\n1,3,4,6\n")
    written = write_channels(tmp_path / "twice.csv", tmp_path / "x.csv")
    assert [name for name, _ in written.columns] == ["a (1)", "a (2)", "b=c"]
    assert [problem.code for problem in written.warnings] == ["names_twice"]
    written = write_channels(tmp_path / "twice.csv", tmp_path / "y.csv", channels=["b=c"])
    assert [name for name, _ in written.columns] == ["b=c"]
    written = write_channels(tmp_path / "twice.csv", tmp_path / "z.csv", channels=["b=c=d", "a=e"])
    assert [name for name, _ in written.columns] == ["e (1)", "e (2)", "d"]


def test_columns_without_numbers_are_told(tmp_path):
    """Names and dates are no channels."""
    frame = pd.DataFrame({"time_s": T, "a": VALUES[0], "who": "x"})
    frame.to_parquet(tmp_path / "run.parquet")
    listed = list_channels(tmp_path / "run.parquet")
    assert [problem.code for problem in listed.warnings] == ["no_numbers"]
    assert "'who'" in listed.as_text()
