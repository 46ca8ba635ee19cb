"""Whether the mean of q holds the dead load: beta and cosine by hand, verdicts, and what is refused or warned of."""

from dataclasses import replace

import numpy as np
import pytest

from fatigue.pipeline.mission.gravity import (
    HeldGravity,
    Verdict,
    gravity_problems,
    gravity_warnings,
    verdict_of,
)

GRAVITY = np.array([12.0, -8.0, 20.0, 5.0, -15.0, 3.0])  # MPa
REST = np.array([1.0, 2.0, -1.5, 0.5, -0.5, 2.0])
ONCE = HeldGravity("run", "gravity", "keep", 0.98, 0.99, "contained", 1.0, True)


def found_of(a: np.ndarray, given: float = 0.0) -> tuple[float, float, Verdict]:
    """What is found of a mean stress beside the stress of gravity."""
    return verdict_of(float(a @ a), float(a @ GRAVITY), float(GRAVITY @ GRAVITY), given)


@pytest.mark.parametrize(
    ("a", "beta", "cos", "verdict"),
    [
        (GRAVITY + REST, 0.9792387543252595, 0.9932275579201866, "contained"),
        (REST, -0.020761245674740483, -0.1783380538729099, "absent"),
        (REST - GRAVITY, -1.0207612456747406, -0.993762290459588, "reversed"),
        (GRAVITY / 9.80665 + 0.1 * REST, 0.09989549673031879, 0.993489673802778, "units"),
        (0.4 * GRAVITY + 2.0 * REST, 0.3584775086505191, 0.8426210643109563, "unclear"),
    ],
)
def test_beta_and_cosine(a: np.ndarray, beta: float, cos: float, verdict: str) -> None:
    """Two programs, one dead load: factor and cosine of six stresses, and what they mean."""
    found = found_of(a)
    assert found[0] == pytest.approx(beta, rel=1e-12)
    assert found[1] == pytest.approx(cos, rel=1e-12)
    assert found[2] == verdict


@pytest.mark.parametrize(
    ("factor", "given", "verdict"),
    [
        (0.009, 0.0, "absent"),
        (0.02, 0.0, "units"),
        (0.5, 0.0, "contained"),
        (1.5, 1.0, "contained"),
        (1.6, 1.0, "units"),
        (9.81, 0.0, "units"),
        (9.81, 9.81, "contained"),  # forces per m/s2
        (1e-3, 1e-3, "absent"),
        (-1.0, 0.0, "reversed"),
        (-1.0, 1.0, "reversed"),
        (-1.0, -1.0, "contained"),  # forces per g upwards, given downwards
        (-9.81, 1.0, "units"),
    ],
)
def test_verdict_of_the_same_shape(factor: float, given: float, verdict: str) -> None:
    """Once, as the gravity load is given, or at 1; reversed, or of another unit."""
    assert found_of(factor * GRAVITY, given)[2] == verdict


def test_nothing_to_compare() -> None:
    """A record at rest, and a gravity load that makes no stress at any weld, are absent; the cosine is not known."""
    beta, cos, verdict = verdict_of(0.0, 0.0, 4.0)
    assert (beta, verdict, np.isnan(cos)) == (0.0, "absent", True)
    beta, cos, verdict = verdict_of(4.0, 0.0, 0.0)
    assert (verdict, np.isnan(beta), np.isnan(cos)) == ("absent", True, True)


def test_gravity_twice_is_refused_once_for_all_events() -> None:
    """In the mean of q and on top; not where the mean is removed, nothing is given on top, or q does not hold it."""
    others = [
        replace(ONCE, event="removed", mean_of_q="remove"),
        replace(ONCE, event="not given", given=0.0, is_on_top=False),
        replace(ONCE, event="absent", verdict="absent", beta=0.0),
    ]
    assert gravity_problems(others, [], "case.toml") == []
    (problem,) = gravity_problems([*others, ONCE, replace(ONCE, event="second", cos=0.97)], [], "case.toml")
    assert (problem.code, problem.count) == ("gravity_twice", 2)
    assert problem.where == "case.toml: mean_of_q of event 'run'"
    for words in ("0.98 times", "cosine 0.990", "gravity = 1", "likewise in 'second'"):
        assert words in problem.what
    assert 'mean_of_q = "remove"' in problem.remedy


@pytest.mark.parametrize(
    ("one", "other", "differ"),
    [
        ({}, {"beta": 1.2}, False),
        ({"given": 0.0}, {"verdict": "absent", "given": 0.0}, True),
        ({"given": 0.0}, {"verdict": "absent", "given": 1.0}, False),  # one has it by q, the other by the load
        ({"mean_of_q": "remove"}, {"verdict": "absent"}, False),
        ({"mean_of_q": "remove"}, {"mean_of_q": "remove", "verdict": "unclear"}, False),
        ({"given": 0.0}, {"given": 0.0, "verdict": "reversed"}, True),
        ({"verdict": "unclear"}, {"verdict": "absent"}, True),
        ({"verdict": "units"}, {"verdict": "units"}, False),
        ({"mean_of_q": "remove", "given": 0.0}, {"given": 0.0}, True),
    ],
)
def test_a_false_cycle_of_the_dead_load_is_refused(
    one: dict[str, object], other: dict[str, object], differ: bool
) -> None:
    """Events of one sequence whose levels hold different dead loads by their q, unless what is given evens that out."""
    some = [
        replace(ONCE, is_on_top=False, event="a", **one),  # type: ignore[arg-type]
        replace(ONCE, is_on_top=False, event="b", **other),  # type: ignore[arg-type]
    ]
    found = gravity_problems(some, [["a"], ["b", "a", "b"]], "case.toml")
    assert [problem.code for problem in found] == ["gravity_differs"] * differ
    if differ:
        assert found[0].where == "case.toml: mission.sequence[2].order"
        assert "'a'" in found[0].what
        assert "'b'" in found[0].what
    assert gravity_problems(some, [["a"], ["b"]], "case.toml") == []


def test_doubts_are_warnings_of_one_kind_each() -> None:
    """Unclear where it may be twice; reversed and other units wherever they are; the worst event with its numbers."""
    unclear = replace(ONCE, event="short basis", verdict="unclear", beta=0.36, cos=0.84)
    silent = [ONCE, replace(unclear, mean_of_q="remove"), replace(unclear, is_on_top=False)]
    assert gravity_warnings(silent, "case.toml") == []
    reversed_ = replace(ONCE, event="turned", verdict="reversed", beta=-1.02, cos=-0.99)
    in_m = replace(ONCE, event="in m", verdict="units", beta=1e-3, cos=0.99)
    found = gravity_warnings([unclear, reversed_, in_m, replace(in_m, event="too", beta=9.81)], "case.toml")
    assert [problem.code for problem in found] == ["gravity_unclear", "gravity_reversed", "gravity_units"]
    assert [problem.count for problem in found] == [1, 1, 2]
    assert "cosine 0.84" in found[0].what
    assert "-1.02 times" in found[1].what
    assert "0.001 times" in found[2].what
    assert "likewise in 'too'" in found[2].what
