"""The synthetic case: a valid case of the size asked for, with the stress levels it promises."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
import pytest

from fatigue import synth
from fatigue.case import load_case
from fatigue.check import check_case
from fatigue.errors import CaseError
from fatigue.synth import Size, synthesize

SMALL = Size(nodes=1000, modes=5, events=2, seconds=10.0, rate=100.0)


@pytest.fixture(scope="module")
def case(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A small case on disk."""
    return synthesize(tmp_path_factory.mktemp("synthetic"), SMALL)


def test_the_case_passes_every_check(case: Path) -> None:
    """As a user's case would."""
    check_case(load_case(case), strict=True)


def test_the_tables_have_the_size_asked_for(case: Path) -> None:
    """Every node once, with every mode, sorted by weld."""
    nodes = pq.read_table(case.parent / "weld_nodes.parquet").to_pandas()
    forces = pq.read_table(case.parent / "nodal_forces.parquet").to_pandas()
    assert nodes["node"].tolist() == list(range(1, 1001))
    assert len(forces) == 5000
    assert forces["weld"].is_monotonic_increasing
    assert nodes.groupby("weld").size().min() >= synth.WELD_LENGTHS[0]
    history = pq.read_table(case.parent / "q_2.parquet").to_pandas()
    assert history.shape == (1000, 6)
    np.testing.assert_allclose(history[[f"q_{m}" for m in range(1, 6)]].std(ddof=0), 1.0, rtol=1e-4)


def test_writing_in_pieces_gives_the_same_case(case: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """However many rows are written at once; the same seed draws the same welds."""
    monkeypatch.setattr(synth, "ROWS_AT_ONCE", 500)
    synthesize(tmp_path, SMALL)
    for name in ("welds", "weld_nodes", "nodal_forces", "q_1"):
        file = f"{name}.parquet"
        assert pq.read_table(tmp_path / file).equals(pq.read_table(case.parent / file))
    assert pq.ParquetFile(tmp_path / "nodal_forces.parquet").num_row_groups > 5


def test_the_line_load_comes_back_from_the_nodal_forces() -> None:
    """The consistent nodal values of a uniform load are half at the ends."""
    np.testing.assert_allclose(synth._nodal(np.ones((4, 1)))[:, 0], [5.0, 10.0, 10.0, 5.0])


def test_the_levels_of_the_welds_are_log_normal() -> None:
    """Median and spread of the rms membrane stress of 1500 welds."""
    welds = list(synth._welds(replace(SMALL, nodes=90_000, modes=60), seed=1))
    rms = np.array([np.sqrt((weld.force**2).sum(axis=1).mean()) / weld.thickness for weld in welds])
    assert np.median(rms) == pytest.approx(synth.MEDIAN_RMS, rel=0.15)
    assert np.log(rms).std() == pytest.approx(synth.LEVEL_SPREAD, rel=0.1)


def test_the_modal_stress_of_a_weld_has_the_rank_of_a_real_one() -> None:
    """Singular values of membrane and bending together above 1e-1 ... 1e-5 of the largest: 5th and 95th percentile."""
    rng = np.random.default_rng(1)
    ranks = []
    for _ in range(100):
        stress = synth._modal_stress(rng, int(rng.integers(20, 101)), 100)
        values = np.linalg.svd(np.concatenate(stress), compute_uv=False)
        ranks.append(np.count_nonzero(values[:, None] > [1e-1 * values[0], 1e-2 * values[0], 1e-5 * values[0]], axis=0))
    low, high = np.percentile(ranks, [5, 95], axis=0)
    assert (low >= [2, 3, 8]).all()
    assert (high <= [6, 12, 35]).all()


def test_stress_concentrates_at_a_few_nodes_of_a_weld() -> None:
    """Few nodes come close to the worst one, many stay far below it."""
    rng = np.random.default_rng(2)
    near, far = [], []
    for _ in range(200):
        rms = np.sqrt((synth._modal_stress(rng, 60, 50)[0] ** 2).sum(axis=1))
        near.append(np.mean(rms > rms.max() / 1.8 ** (1 / 3.5)))
        far.append(np.mean(rms < rms.max() / 30 ** (1 / 3.5)))
    assert 0.03 < np.median(near) < 0.15
    assert 0.4 < np.median(far) < 0.64


def test_records_too_short_are_refused(tmp_path):
    """A record of two samples is none."""
    with pytest.raises(CaseError, match=r"size: 0\.01 s at 250 Hz are 2 samples\. Give at least 16"):
        synthesize(tmp_path / "short", Size(30, 4, seconds=0.01))
    assert not (tmp_path / "short").exists()
