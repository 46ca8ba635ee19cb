"""What throats will take is told before anything is counted."""

from fatigue.case import load_case
from fatigue.pipeline.forecast.needs import job_needs
from fatigue.pipeline.forecast.size import job_size
from fatigue.pipeline.forecast.throats import THROAT, counted_throats, throat_seconds
from fatigue.pipeline.mission.plan import mission_plan
from fatigue.pipeline.solve.body import read_body
from tests.small_case import small_case
from tests.throat_case import row, with_throats


def test_time_grows_with_throats_and_samples(tmp_path):
    """Seven stations with two throats and seven with one; a case without throats takes what it took."""
    path = with_throats(small_case(), tmp_path / "a", [row("A", "both"), row("B", "top", "throat")])
    seconds = {}
    for name, file in (("throats", path), ("none", small_case().write(tmp_path / "b"))):
        body = read_body(load_case(file), strict=False)
        plan, _ = mission_plan(body)
        assert counted_throats(body) == (21 if name == "throats" else 0)
        seconds[name] = job_needs(job_size(body, plan, threads=1, report=False)).seconds
    assert seconds["throats"] - seconds["none"] >= throat_seconds(21, 2400 + 2200 + 2) > 0.0
    assert throat_seconds(2, 100) == 200 * THROAT
