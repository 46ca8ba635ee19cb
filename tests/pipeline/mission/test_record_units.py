"""Times that cannot be s are refused, of those that hardly are there is a warning, and what is simulated passes."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fatigue.pipeline.mission.record_units import step_problems, step_warnings
from fatigue.readers.neutral.body.modes import Modes
from fatigue.readers.neutral.history import TimeGrid


def modes(*hz, kind="normal"):
    """Modes of these frequencies, all of a kind."""
    ones = np.ones(len(hz))
    return Modes(np.arange(1, len(hz) + 1), np.array(hz), np.nan * ones, ones, (kind,) * len(hz), ones)


def said(find, step, some, samples=100):
    """Return what is found about a step [s], as text."""
    return [str(problem) for problem in find(TimeGrid(samples, step, 0.0), some, "q.csv", "run")]


def test_a_record_in_ms_names_file_event_values_and_remedies():
    """The slowest mode is the one that counts."""
    (line,) = said(step_problems, 5.0, modes(40.0, 8.0))
    assert line == (
        "q.csv: column time_s: the step of event 'run' is 5 s, longer than a period of the slowest normal mode "
        "(0.125 s, 8 Hz), so the record cannot hold any vibration of the body. Give time_s in s, it looks like ms (a "
        "step of 0.005 s); if the record is really quasi-static, interpolate it to a shorter step."
    )


def test_a_stiff_body_may_be_simulated_without_its_vibration():
    """A bracket of 300 Hz, sampled at 100 Hz: a warning, not refused; the same in ms is refused."""
    assert said(step_problems, 0.01, modes(300.0)) == []
    (line,) = said(step_warnings, 0.01, modes(300.0))
    assert line == (
        "q.csv: column time_s: the step of event 'run' is 0.01 s, longer than a period of the slowest normal mode "
        "(0.00333 s, 300 Hz), so the record cannot hold any vibration of the body. Check that time_s is in s, and "
        "sample the simulation more finely unless the body is quasi-static."
    )
    (line,) = said(step_problems, 10.0, modes(300.0))
    assert "it looks like ms (a step of 0.01 s)" in line


def test_a_record_far_too_coarse_in_ms_too_is_not_said_to_be_in_ms():
    """A thousandth of the step is still longer than any of a simulation."""
    (line,) = said(step_problems, 100.0, modes(8.0))
    assert "ms" not in line
    assert "Give time_s in s; if the record is really quasi-static" in line


def test_a_step_far_too_short_names_file_event_and_values():
    """The fastest mode is the one that counts."""
    (line,) = said(step_warnings, 1e-6, modes(40.0, 8.0))
    assert line == (
        "q.csv: column time_s: the step of event 'run' is 1e-06 s, less than a thousandth of a period of the fastest "
        "normal mode (0.025 s, 40 Hz). Check that time_s is in s."
    )


@pytest.mark.parametrize(
    ("some", "samples"),
    [
        (modes(8.0), 99),
        (modes(), 10**6),
        (modes(8.0, kind="interface"), 10**6),
        (modes(0.0, 1e-5), 10**6),
    ],
    ids=["typed by hand", "no mode", "no normal mode", "rigid-body modes without kind"],
)
def test_what_cannot_be_judged_is_left_alone(some, samples):
    """Any step passes."""
    for step in (1e-9, 0.01, 1e4):
        assert said(step_problems, step, some, samples) == said(step_warnings, step, some, samples) == []


def test_a_rigid_body_mode_without_kind_does_not_hide_the_others():
    """Its frequency is what the digits of the solver leave of 0."""
    assert len(said(step_problems, 5.0, modes(1e-5, 8.0))) == 1


@given(st.lists(st.floats(0.1, 1e3), min_size=1), st.floats(1.0, 200.0))
def test_sampled_as_simulations_are_it_passes(hz, samples_per_period):
    """One to 200 samples in a period of the fastest mode of a body: neither refused nor warned of."""
    some, step = modes(*hz), 0.999 / max(hz) / samples_per_period
    assert said(step_problems, step, some) == said(step_warnings, step, some) == []


@given(st.lists(st.floats(1.0, 1e3), min_size=1), st.floats(1e-4, 0.02))
def test_the_steps_of_simulations_pass_and_in_ms_they_are_refused(hz, step):
    """Whatever the body; in ms where its slowest mode is faster than the wrong step."""
    some = modes(*hz)
    assert said(step_problems, step, some) == []
    assert len(said(step_problems, 1000.0 * step, some)) == (1000.0 * step * min(hz) > 1.0)
