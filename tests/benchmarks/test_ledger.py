"""The ledger: its reference is right, every way is compared with it as it should be, and what is missing is said."""

import csv
import io
import math
from pathlib import Path

import numpy as np
import pytest
import rainflow

from benchmarks.ledger import child, reference, story, ways
from benchmarks.ledger.command import main
from benchmarks.ledger.signals import BANDS, KINDS, RATE, FlatBand, signals_of
from benchmarks.ledger.written import page, table

EXACT = ("fatigue, sums in double precision", "fatigue, every cycle", "rainflow", "pyyeti", "pyLife")
ASTM = np.array([-2.0, 1, -3, 5, -1, 3, -4, 4, -2])  # E1049-85, figure 6
FACTS = {"processor": "one, or another", "numpy": "2.0"}


def test_the_example_of_the_standard():
    """Half cycles as figure 6 of ASTM E1049-85 lists them; as a block every cycle closes."""
    assert reference.half_cycles(ASTM).tolist() == [3, 4, 4, 4, 6, 8, 8, 9]
    assert reference.closed_cycles(ASTM).tolist() == [3, 3, 4, 4, 7, 7, 9, 9]
    assert reference.power_sum(np.array([1.0, 2.0, 2.0]), 3.0) == 8.5
    assert reference.turning_points(np.array([1.0, 1, 2, 2, 2, 1, 1])) == [1.0, 2.0, 1.0]
    assert reference.turning_points(np.full(3, 2.0)) == [2.0]


@pytest.mark.parametrize("seed", range(20))
def test_the_reference_is_the_count_of_another_package(seed):
    """On short records with ties and plateaus."""
    rng = np.random.default_rng(seed)
    x = np.repeat(rng.integers(-4, 5, 30), rng.integers(1, 3, 30)).astype(float)
    halves = [S for S, _, n, _, _ in rainflow.extract_cycles(x.tolist()) for _ in range(round(2 * n))]
    assert reference.half_cycles(x).tolist() == sorted(halves)


def test_damage_of_a_flat_band():
    """Numbers of the documented examples of ``fatigue.spectrum.methods``, N = 2e12 / S^3."""
    band = FlatBand(30.0, 10.0, 40.0)
    assert reference.dirlik(band, 3.0) / 2e12 == pytest.approx(9.883754e-06, rel=1e-6)
    assert reference.tovo_benasciutti(band, 3.0) / 2e12 == pytest.approx(9.659460e-06, rel=1e-6)


def test_signals_are_what_they_are_called():
    """The same in every process; one resonance passes its mean upwards as often as it has maxima, several do not."""
    irregularity = {}
    for kind in ("narrow band", "broad band"):
        (x,) = signals_of(kind, 1, 20_000)
        assert (x == signals_of(kind, 1, 20_000)).all()
        assert x.std() == pytest.approx(30.0)
        crossings = ((x[:-1] < 0) & (x[1:] >= 0)).sum()
        irregularity[kind] = crossings / (((x[1:-1] > x[:-2]) & (x[1:-1] > x[2:])).sum())
        if kind == "narrow band":
            assert crossings / (x.size / RATE) == pytest.approx(9.0, rel=0.05)
    assert irregularity["narrow band"] > 0.85
    assert irregularity["broad band"] < 0.8
    (x,) = signals_of("ties", 1, 20_000)
    assert (x == x.round()).all()
    assert 0.4 < (np.diff(x) == 0).mean() < 0.6
    assert KINDS["long record"].samples == 10_000_000


def measured(way, kind, folder, samples=700):
    """What one way finds in two short signals, beside the reference."""
    asked = child.Task(way.name, kind, 2, samples, str(folder / "found.npz"))
    numbers = child.measure(asked)
    with np.load(asked.out) as arrays:
        return numbers, story.compared(
            arrays["sums"].tolist(), arrays["halves"], story.exact(kind, 2, samples, way.residue)
        )


@pytest.mark.parametrize("kind", ["narrow band", "broad band", "ties"])
@pytest.mark.parametrize("way", ways.COUNTING, ids=lambda way: way.name)
def test_every_way_finds_what_the_reference_finds(way, kind, tmp_path, monkeypatch):
    """To rounding where a way is exact, in single precision within 1e-6, by classes roughly."""
    if not story.installed(way.package):
        pytest.skip(f"{way.package} is not installed")
    monkeypatch.setattr(child, "MOST_ROUNDS", 1)
    numbers, deviations = measured(way, kind, tmp_path)
    assert numbers["wall_ns"] > 0
    assert numbers["cpu_ns"] > 0
    if way.name in EXACT:
        assert all(abs(value) < 1e-12 for value in deviations.values())
    elif way.precision == "float32":
        assert abs(deviations["power_sum"]) < 1e-6
        assert abs(deviations["cycles"]) < 1e-12
        assert deviations["largest"] < 1e-6
    else:
        assert abs(deviations["power_sum"]) < 0.05


def test_both_faces_of_a_point_are_signals_of_their_own(monkeypatch):
    """The sums of ours are of all signals, not of half of them twice."""
    signals = signals_of("broad band", 4, 600)
    for single in (True, False):
        found = ways.summed(ways._ours_summed(single)(signals))
        each = [ways.listed(ways._ours_listed()(x[np.newaxis])) for x in signals]
        assert found.cycles == sum(one.cycles for one in each)
        assert found.power_sum == pytest.approx(sum(one.power_sum for one in each), rel=1e-6)
        assert found.largest == pytest.approx(max(one.largest for one in each), rel=1e-6)


@pytest.mark.parametrize("way", ways.SPECTRAL, ids=lambda way: way.name)
def test_every_way_finds_the_damage_of_the_spectra(way, tmp_path, monkeypatch):
    """To the quadrature of the moments; each spectrum has its own level."""
    if not story.installed(way.package):
        pytest.skip(f"{way.package} is not installed")
    monkeypatch.setattr(child, "MOST_ROUNDS", 1)
    for kind in BANDS:
        asked = child.Task(way.name, kind, 5, 0, str(tmp_path / "found.npz"))
        child.measure(asked)
        with np.load(asked.out) as arrays:
            rates = arrays["rates"]
        right = story.exact_rates(kind, 5, way.name)
        assert len(set(right)) == 5
        np.testing.assert_allclose(rates, right, rtol=2e-6)
        assert abs(story.largest_share(rates, right)) < 2e-6


def test_deviations():
    """A range that is off, a cycle that is missing, and a way that tells its largest range alone."""
    right = np.array([1.0, 1.0, 4.0, 4.0])
    off = story.compared([2.0, 1.0**5 + 4.0**5, 4.0], np.array([1.0, 1.1, 4.0, 4.0]), right)
    assert off["largest"] == pytest.approx(0.1 / 4.0)
    assert (off["cycles"], off["power_sum"]) == (0.0, 0.0)
    missing = story.compared([1.0, 4.0**5, 4.0], np.array([4.0, 4.0]), right)
    assert missing["largest"] == 0.25
    assert missing["cycles"] == -0.5
    assert missing["power_sum"] == pytest.approx(-1.0 / 1025.0)
    assert story.compared([2.0, 1025.0, 4.4], np.empty(0), right)["largest"] == pytest.approx(0.1)
    assert math.isnan(story.compared([math.nan, 1025.0, math.nan], np.empty(0), right)["cycles"])
    assert story.largest_share(np.array([1.0, 0.5, 1.2]), np.ones(3)) == -0.5


@pytest.fixture(scope="module")
def rows():
    """A small ledger without one package, measured in this process."""
    with pytest.MonkeyPatch.context() as patch:
        found = story.installed
        patch.setattr(story, "installed", lambda package: "" if package == "fatpack" else found(package))
        patch.setattr(story, "in_a_child", child.measure)
        patch.setattr(child, "MOST_ROUNDS", 1)
        return list(story.ledger(story.Size(2, 600, 3)))


def test_every_way_has_a_row_for_every_kind(rows):
    """Those of packages that are missing say so, with the command to install them."""
    assert len(rows) == len(KINDS) * len(ways.COUNTING) + len(BANDS) * len(ways.SPECTRAL)
    for row in rows:
        assert bool(row.missing) == (not row.version)
        assert math.isnan(row.wall_ns) == bool(row.missing)
    missing = [row for row in rows if row.package == "fatpack"]
    assert len(missing) == 2 * len(KINDS)
    assert {row.missing for row in missing} == {'not installed: pip install "fatpack>=0.7.8"'}
    ours = [row for row in rows if row.package == ways.OURS]
    assert all(abs(row.power_sum) < 2e-6 for row in ours)


def test_page_and_table_have_every_row(rows):
    """Versions and machine too; CSV has all digits."""
    text = page(rows, FACTS)
    assert "processor one, or another, numpy 2.0" in text
    assert f"rainflow {story.installed('rainflow')}" in text
    for way in (*ways.COUNTING, *ways.SPECTRAL):
        assert text.count(f"| {way.name} |") == (len(KINDS) if way in ways.COUNTING else len(BANDS))
    assert text.count('not installed: pip install "fatpack>=0.7.8"') == 2 * len(KINDS)
    for package in ("pyyeti", "pylife", "fatpack", "rainflow"):
        assert f"- {package}: no " in text
    read = list(csv.DictReader(io.StringIO(table(rows, FACTS))))
    assert [float(one["wall_ns"]) for one in read if one["wall_ns"] != "nan"] == [
        row.wall_ns for row in rows if not row.missing
    ]
    assert {one["processor"] for one in read} == {"one, or another"}


def test_a_child_measures_in_a_process_of_its_own(tmp_path):
    """A task there and back; what goes wrong there is told here."""
    asked = child.Task("rainflow", "ties", 2, 600, str(tmp_path / "found.npz"))
    assert set(story.in_a_child(asked)) == {"wall_ns", "cpu_ns", "memory_MB"}
    with pytest.raises(SystemExit, match=r"nobody on ties failed:\n(.|\n)*KeyError"):
        story.in_a_child(child.Task("nobody", "ties", 2, 600, str(tmp_path / "found.npz")))


def test_memory_is_that_of_the_call():
    """Of one that fills 80 MB and gives them back."""
    wall, cpu, memory, result = child.best(lambda: float(np.ones(10_000_000).sum()))
    assert result == 1e7
    assert 70.0 < memory < 120.0
    assert wall > 0
    assert cpu >= 0


@pytest.mark.parametrize(
    ("words", "what"),
    [
        (["--signals", "3"], "--signals 3: give an even number"),
        (["--samples", "100"], "--samples 100: give 512 or more"),
        (["-o", "ledger.txt"], r"-o ledger.txt: give a file that ends in .md or .csv"),
    ],
)
def test_bad_words_are_refused_before_anything_is_measured(words, what, capsys):
    """In one line, with what to give instead."""
    with pytest.raises(SystemExit):
        main(words)
    assert what in capsys.readouterr().err


@pytest.mark.parametrize(("name", "begins"), [("ledger.md", "# Ledger"), ("ledger.csv", "task,kind,way,package")])
def test_the_file_is_written(name, begins, rows, tmp_path, monkeypatch):
    """By its ending."""
    monkeypatch.setattr("benchmarks.ledger.command.ledger", lambda size, told: rows)
    main(["-o", str(tmp_path / name)])
    assert (tmp_path / name).read_text().startswith(begins)


def test_the_page_in_the_docs_is_one_of_this_program(rows):
    """Its sentences are those that are written now; its numbers are those of another machine."""
    written = Path("docs/ledger.md").read_text(encoding="utf-8")
    of_now = page(rows, FACTS)
    assert written.split("Measured on")[0] == of_now.split("Measured on")[0]
    sentences = [line for line in of_now.splitlines() if line.startswith(("- ", "## "))]
    assert [line for line in written.splitlines() if line.startswith(("- ", "## "))] == sentences
