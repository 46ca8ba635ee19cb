"""The record of an event with unit loads: own columns, own files on other grids, static load cases, refusals."""

import numpy as np
import pandas as pd
import pytest

from fatigue.errors import DataError
from fatigue.life.records.history import kept, upsampled
from fatigue.life.records.spool import Spool
from fatigue.life.records.unit_load import LoadSource
from fatigue.readers.neutral import history as history_module
from fatigue.readers.neutral import long_history
from fatigue.readers.neutral.event.event_record import EventFiles, check_event, read_event
from fatigue.readers.neutral.history import read_history
from fatigue.readers.neutral.record_outline import RecordOutline

MODES = np.array([2, 5])
STEP, SAMPLES = 0.01, 400
SUFFIXES = pytest.mark.parametrize("suffix", [".csv", ".parquet"])


def signal(t):
    """Content far below half the coarsest sampling rate, one period in 4 s."""
    return 0.4 + np.sin(2 * np.pi * 0.75 * t) + 0.3 * np.cos(2 * np.pi * 1.5 * t + 0.4)


def write(path, columns, dtype=np.float64):
    """Write a table."""
    table = pd.DataFrame({name: np.asarray(values, dtype) for name, values in columns.items()})
    if path.suffix == ".csv":
        table.to_csv(path, index=False)
    else:
        table.astype({"time_s": np.float64}).to_parquet(path, index=False)
    return path


def own_record(folder, suffix=".csv", dtype=np.float64, start=0.0, **more):
    """The event's own record, two modes and what is given."""
    t = start + STEP * np.arange(SAMPLES)
    q = {"time_s": t, "q_2": np.sin(3.0 * t), "q_5": np.cos(2.0 * t)}
    return write(folder / f"q{suffix}", q | {name: of(t) for name, of in more.items()}, dtype)


def own_load(folder, step=0.05, samples=80, start=0.0, values=signal, suffix=".csv", **source):
    """A load with a file of its own."""
    t = start + step * np.arange(samples)
    path = write(folder / f"p{suffix}", {"time_s": t, "u_p": values(t)})
    return LoadSource("p", "file", column="u_p", path=path, unit="kPa", **source)


def files_of(path, *loads, start_s=0.0, residue="repeat", strict=True) -> EventFiles:
    """What a record is read from."""
    return EventFiles("run", path, MODES, (), start_s, residue, loads, strict)


@SUFFIXES
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_own_columns_are_rows_like_modes(tmp_path, suffix, dtype):
    """Behind the modes, in the precision of the file; the same samples under the name of a mode are the same row."""
    path = own_record(tmp_path, suffix, dtype, u_p=signal)
    loads = (LoadSource("z", "missing"), LoadSource("p", "column", column="u_p"))
    found = read_event(files_of(path, *loads, start_s=1.0))
    path = own_record(tmp_path, suffix, dtype, q_7=signal)
    whole, _ = read_history(path, "run", np.array([2, 5, 7]), (), strict=True)
    expected = kept(whole, 1.0)
    assert found.history.q.dtype == expected.q.dtype
    np.testing.assert_array_equal(found.history.q[[0, 1, 3]], expected.q)
    assert not found.history.q[2].any()
    assert found.history.mode.tolist() == [2, 5, 6, 7]
    assert (found.refined, found.between, found.duration) == (1, (), expected.duration)


@SUFFIXES
def test_long_records_on_disk(tmp_path, suffix, monkeypatch):
    """Block by block into a file: the same samples, also of rows that come from another file."""
    path = own_record(tmp_path, suffix, u_p=signal)
    loads = (LoadSource("g", "constant", constant=2.0), LoadSource("p", "column", column="u_p"), own_load(tmp_path))
    files = files_of(path, *loads, start_s=0.0)
    short = read_event(files)
    monkeypatch.setattr(history_module, "is_long", lambda path: True)
    monkeypatch.setattr(long_history, "NUMBERS_AT_ONCE", 300)
    in_memory, on_disk = read_event(files), read_event(files, tmp_path / "scratch" / "q")
    assert isinstance(on_disk.history.q, Spool)
    np.testing.assert_array_equal(in_memory.history.q, short.history.q)
    np.testing.assert_array_equal(np.asarray(on_disk.history.q), short.history.q)
    fine = on_disk.upsampled(4, "repeat", tmp_path / "scratch" / "fine")
    np.testing.assert_allclose(np.asarray(fine.q), short.upsampled(4, "repeat").q, atol=1e-12)


@pytest.mark.parametrize("residue", ["repeat", "half"])
@pytest.mark.parametrize("step", [0.01, 0.02, 0.05, 0.08])
def test_a_coarser_load_is_read_at_the_instants_of_the_record(tmp_path, residue, step):
    """One period of the event, on any grid: exact. Mirrored records bend at their ends and nowhere else."""
    whole = round(4.0 / step)
    load = own_load(tmp_path, step, whole if residue == "repeat" else whole + 40)
    found = read_event(files_of(own_record(tmp_path), load, residue=residue))
    for record in (found.history, found.upsampled(4, residue)):
        t = record.step * np.arange(record.q.shape[1])
        inner = (t > 1.0) | (residue == "repeat")
        atol = 1e-10 if residue == "repeat" else 0.01
        np.testing.assert_allclose(record.q[2, inner], signal(t[inner]), atol=atol)


@pytest.mark.parametrize("residue", ["repeat", "half"])
def test_upsampling_a_load_on_the_grid_of_the_record(tmp_path, residue):
    """It is interpolated like a mode, whether a column or a file of its own that lasts longer."""
    path = own_record(tmp_path, u_p=signal)
    load = own_load(tmp_path, STEP, SAMPLES + 70, start=-0.2)
    loads = (LoadSource("c", "column", column="u_p"), load)
    found = read_event(files_of(path, *loads, start_s=0.5, residue=residue, strict=False))
    fine = found.upsampled(8, residue)
    expected = upsampled(found.history, 8, residue)
    np.testing.assert_array_equal(fine.q, expected.q)
    np.testing.assert_allclose(fine.q[2], fine.q[3], atol=1e-12)


@pytest.mark.parametrize("residue", ["repeat", "half"])
@pytest.mark.parametrize(("step", "factor"), [(0.005, 2), (0.004, 4), (0.00999, 2), (0.00125, 8)])
def test_a_finer_load_upsamples_the_record(tmp_path, residue, step, factor):
    """By the smallest power of 2, the modes as ever; the duration stays that of the file."""
    path, load = own_record(tmp_path), own_load(tmp_path, step, round(4.2 / step))
    found = read_event(files_of(path, load, residue=residue), None)
    assert found.refined == factor
    assert found.duration == pytest.approx(STEP * SAMPLES)
    plain, _ = read_history(path, "run", MODES, (), strict=True)
    np.testing.assert_array_equal(found.history.q[:2], upsampled(plain, factor, residue).q)
    spooled = read_event(files_of(path, load, residue=residue), tmp_path / "s" / "record")
    np.testing.assert_allclose(np.asarray(spooled.history.q), found.history.q, atol=1e-12)
    assert [file.name for file in (tmp_path / "s").iterdir()] == ["record-finer"]
    again = found.upsampled(2 * factor, residue)
    assert again.step == pytest.approx(STEP / (2 * factor))
    assert found.upsampled(factor, residue) is found.history


def test_a_step_stays_a_step(tmp_path):
    """Linear interpolation, upsampled or not, leaves no value outside the two that were sampled."""
    load = own_load(tmp_path, 0.1, 41, values=lambda t: (t > 1.7) * 3.0, interpolation="linear")
    found = read_event(files_of(own_record(tmp_path), load, residue="half"))
    fine = found.upsampled(8, "half")
    for q in (found.history.q[2], fine.q[2]):
        assert (q.min(), q.max()) == (0.0, 3.0)


def test_shift_and_scale(tmp_path):
    """Both are applied to the file: a load of later times, in another unit."""
    load = own_load(tmp_path, STEP, SAMPLES, start=7.0, shift_s=-7.0, scale=0.001)
    found = read_event(files_of(own_record(tmp_path), load))
    np.testing.assert_allclose(found.history.q[2], 0.001 * signal(7.0 + STEP * np.arange(SAMPLES)), rtol=1e-12)


def test_file_times_count_from_where_the_record_begins(tmp_path):
    """Both files are on one clock, behind the start-up of the record too."""
    path = own_record(tmp_path, start=5.0)
    found = read_event(files_of(path, own_load(tmp_path, 0.02, 500), start_s=1.0, residue="half"))
    t = 6.0 + STEP * np.arange(300)
    np.testing.assert_allclose(found.history.q[2], signal(t), atol=0.01)


def test_precision(tmp_path):
    """Single only where all files are."""
    path = own_record(tmp_path, ".parquet", np.float32)
    t = STEP * np.arange(SAMPLES)
    single = write(tmp_path / "s.parquet", {"time_s": t, "u_p": signal(t)}, np.float32)
    double = write(tmp_path / "d.parquet", {"time_s": t, "u_p": signal(t)})
    for file, dtype in ((single, np.float32), (double, np.float64)):
        load = LoadSource("p", "file", column="u_p", path=file)
        assert read_event(files_of(path, load)).history.q.dtype == dtype


def test_a_static_load_case():
    """No file: modes at zero, values a second apart, constants not in the samples; never upsampled."""
    loads = (
        LoadSource("p", "values", values=(0.0, 1.0, 0.5)),
        LoadSource("g", "constant", constant=1.0),
        LoadSource("r", "values", values=(2.0, 0.0, 0.0)),
    )
    found = read_event(files_of(None, *loads, residue="half"))
    assert found.history.q.tolist() == [[0.0] * 3, [0.0] * 3, [0.0, 1.0, 0.5], [0.0] * 3, [2.0, 0.0, 0.0]]
    assert (found.is_static, found.history.step, found.duration) == (True, 1.0, 3.0)
    assert found.upsampled(8, "half") is found.history


def checked(files):
    """Check and outline of a record."""
    outline = RecordOutline(files.start_s)
    return check_event(files, outline), outline


def test_a_check_sees_what_is_read(tmp_path):
    """Every coordinate has its outline; constants are told apart and do not move."""
    path = own_record(tmp_path, u_c=signal)
    loads = (
        LoadSource("g", "constant", constant=1.5),
        LoadSource("c", "column", column="u_c"),
        own_load(tmp_path, 0.005, 820),
        LoadSource("z", "missing"),
    )
    found, outline = checked(files_of(path, *loads))
    assert (found.refined, found.warnings) == (2, [])
    assert outline.moves.tolist() == [True, True, False, True, True, False]
    assert outline.columns[2].whole.high == 1.5


@pytest.mark.parametrize("read", [checked, read_event], ids=["check", "read"])
@pytest.mark.parametrize(
    ("start", "samples", "residue"), [(0.0, 70, "repeat"), (0.3, 90, "half"), (0.0, 70, "half"), (-9.0, 80, "repeat")]
)
def test_a_short_load_is_refused(tmp_path, read, start, samples, residue):
    """The error names both spans; nothing is extrapolated."""
    load = own_load(tmp_path, 0.05, samples, start)
    with pytest.raises(DataError) as refusal:
        read(files_of(own_record(tmp_path), load, residue=residue))
    (problem,) = refusal.value.problems
    end = start + 0.05 * (samples - 1)
    assert problem.code == "short_load"
    assert f"lasts from {start:g} to {end:g} s" in problem.what
    assert "the kept record of event 'run' from 0 to 3.99 s" in problem.what


@pytest.mark.parametrize(
    ("spoil", "message"),
    [
        (lambda t: t.rename(columns={"u_p": "u_q"}), "p.csv: column u_p: the column is missing"),
        (lambda t: t.assign(u_p=t.u_p.where(t.index != 3)), "p.csv: column u_p, row 4: the value is missing or NaN"),
        (lambda t: t.drop(index=7), "steps differ by more than 1e-3"),
        (lambda t: t.head(1), "the history has one sample"),
        (lambda t: t.assign(u_p="x"), "'x' is not a number"),
    ],
)
def test_a_spoilt_file_is_refused(tmp_path, spoil, message):
    """In the words of any record."""
    load = own_load(tmp_path)
    spoil(pd.read_csv(load.path)).to_csv(load.path, index=False)
    with pytest.raises(DataError) as refusal:
        checked(files_of(own_record(tmp_path), load))
    assert message in str(refusal.value)


def test_a_load_beyond_all_sampling_is_refused(tmp_path):
    """Times in ms taken for s, or the reverse."""
    t = np.arange(3) * 10.0
    slow = write(tmp_path / "slow.csv", {"time_s": t, "q_2": t, "q_5": t})
    with pytest.raises(DataError, match="more than 1024 times as long"):
        checked(files_of(slow, own_load(tmp_path, 0.009, 3000)))


def test_an_overshoot_is_a_warning(tmp_path):
    """The interpolant of a step leaves the range of its samples; the remedy is named, and works."""
    door = own_load(tmp_path, 0.1, 41, values=lambda t: (t > 1.7) * 3.0)
    (warning,) = checked(files_of(own_record(tmp_path), door, residue="half"))[0].warnings
    assert warning.code == "load_overshoot"
    assert "interpolation = 'linear'" in warning.remedy
    linear = own_load(tmp_path, 0.1, 41, values=lambda t: (t > 1.7) * 3.0, interpolation="linear")
    assert checked(files_of(own_record(tmp_path), linear, residue="half"))[0].warnings == []
    same = own_load(tmp_path, STEP, SAMPLES, values=lambda t: (t > 1.7) * 3.0)
    assert checked(files_of(own_record(tmp_path), same, residue="half"))[0].warnings == []


@pytest.mark.parametrize(("unit", "fits"), [("kPa", True), ("[kPa]", True), ("Pa", False), ("", True)])
def test_units_in_a_row_of_units(tmp_path, unit, fits):
    """The unit of a column is that of its load, in the event's own record and in a file of its own."""
    path, load = own_record(tmp_path, u_p=signal), own_load(tmp_path)
    for file, units in ((path, f"s,mm,mm,{unit}"), (load.path, f"s,{unit}")):
        names, *rows = file.read_text().splitlines()
        file.write_text("\n".join([names, units, *rows]) + "\n")
    for loads in ((LoadSource("p", "column", column="u_p", unit="kPa"),), (load,)):
        files = files_of(path, *loads, strict=False)
        if fits:
            codes = {warning.code for warning in checked(files)[0].warnings}
            assert codes <= {"unknown_column"}
        else:
            with pytest.raises(DataError, match="the unit is Pa, and the unit load 'p' is in kPa"):
                checked(files)


def test_a_column_that_is_given_otherwise_is_not_read(tmp_path):
    """It is an unknown column: a warning, refused where strict."""
    path, load = own_record(tmp_path, u_p=signal), own_load(tmp_path)
    found, _ = checked(files_of(path, load, strict=False))
    assert [warning.code for warning in found.warnings] == ["unknown_column"]
    with pytest.raises(DataError, match="column u_p"):
        checked(files_of(path, load))


@pytest.mark.parametrize("residue", ["repeat", "half"])
def test_a_load_on_the_grid_beside_a_finer_one(tmp_path, residue):
    """The record is upsampled for the finer load; the other one is upsampled with it, as a mode is."""
    path, finer = own_record(tmp_path, u_p=signal), own_load(tmp_path, STEP / 2, 2 * SAMPLES)
    (tmp_path / "long").mkdir()
    longer = own_load(tmp_path / "long", STEP, SAMPLES + 70, start=-0.2)
    column = LoadSource("c", "column", column="u_p")
    found = read_event(files_of(path, column, longer, finer, residue=residue))
    assert found.refined == 2
    np.testing.assert_allclose(found.history.q[2], found.history.q[3], atol=1e-12)
    assert found.between == ()
    fine = found.upsampled(8, residue)
    np.testing.assert_allclose(fine.q[2], fine.q[3], atol=1e-12)
