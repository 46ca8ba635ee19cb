"""Every likely cause is found from the displacement alone, and nothing is blamed that cannot be told."""

from dataclasses import replace

import numpy as np
import pytest

from tests.readers.convert.displacement.modal_records import resonances, row_of


@pytest.fixture(scope="module")
def modes():
    """Twelve modes and ten seconds."""
    return resonances()


def test_the_sum_itself_is_green(modes):
    """Scale 1, correlation 1, no error, and it tells which signs it proves."""
    row = row_of(modes, modes.weight @ modes.q)
    assert (row.check, row.light) == ("displacement", "green")
    assert row.value == pytest.approx(0.0, abs=1e-7)
    assert "scale 1, correlation 1" in row.finding
    assert "a wrong sign would show for modes 1, 2, 3" in row.finding


@pytest.mark.parametrize("seed", range(20))
def test_noise_of_one_percent_stays_green(seed):
    """Whatever the modes are; the value is the noise."""
    drawn = resonances(modes=30, samples=1500, seed=seed)
    row = row_of(drawn, drawn.weight @ drawn.q + drawn.noise(0.01, seed))
    assert row.light == "green"
    assert row.value == pytest.approx(0.01, rel=0.2)


@pytest.mark.parametrize("k", range(12))
def test_a_flipped_mode_is_named(modes, k):
    """Each of them, under noise."""
    weight = modes.weight
    weight[k] *= -1
    row = row_of(modes, weight @ modes.q + modes.noise(0.01))
    assert row.light == "red"
    assert f"likely cause: the sign of mode {k + 1} is opposite" in row.finding


@pytest.mark.parametrize("flipped", [(3, 6), (2, 3, 6, 8), (1, 4, 5, 9, 12)])
def test_several_flipped_modes_are_named(modes, flipped):
    """Two by trying all pairs, more by a fit."""
    weight = modes.weight
    weight[np.array(flipped) - 1] *= -1
    row = row_of(modes, weight @ modes.q + modes.noise(0.01))
    assert f"the sign of the modes {', '.join(map(str, flipped))} is opposite" in row.finding


@pytest.mark.parametrize(
    ("factor", "words"),
    [
        (1000.0, "1000 times the sum: metres against millimetres"),
        (0.001, "0.001 times the sum: metres against millimetres"),
        (1 / 25.4, "0.03937 times the sum: inches against millimetres"),
        (1000**0.5, "31.62 times the sum: modes of unit mass in kilograms against tonnes"),
        (-1.0, "the sign of the direction, or of all modes, is opposite ("),
        (-1000.0, "is opposite and the displacement is 1000 times the sum"),
        (1.3, "the displacement is 1.3 times the sum ("),
    ],
)
def test_factors_on_all_modes_are_named(modes, factor, words):
    """Units and sign; a factor that no units explain is told as it is."""
    row = row_of(modes, factor * (modes.weight @ modes.q + modes.noise(0.01)))
    assert row.light == "red"
    assert words in row.finding


def test_modes_that_changed_places_are_named(modes):
    """A permuted pair."""
    weight = modes.weight
    weight[[1, 4]] = weight[[4, 1]]
    row = row_of(modes, weight @ modes.q + modes.noise(0.01))
    assert "the modes 2 and 5 have changed places" in row.finding
    assert "--columns" in row.remedy


def test_a_numbering_that_begins_elsewhere_is_named(modes):
    """Coordinates 1 to 6 are those of FE modes 7 to 12."""
    measured = modes.weight[6:] @ modes.q[:6]
    row = row_of(replace(modes, q=modes.q[:6]), measured)
    assert row.light == "red"
    assert "the coordinates belong to the modes 6 further on in the FE run" in row.finding


def test_another_direction_is_named(modes):
    """The simulation's axes are not those of the FE model."""
    row = row_of(modes, -modes.shape[:, 0] @ modes.q + modes.noise(0.01))
    assert "the direction is -x of the FE model" in row.finding


@pytest.mark.parametrize("shift", [0.037, -0.21, 100.0, -3600.0])
def test_a_shift_in_time_is_named(modes, shift):
    """Also one that leaves no instant in common."""
    row = row_of(modes, modes.weight @ modes.q + modes.noise(0.01), time=modes.time + shift)
    assert row.light == "red"
    assert f"the displacement is {abs(shift):.4g} s {'late' if shift > 0 else 'early'}" in row.finding


@pytest.mark.parametrize(("order", "word"), [(1, "a velocity"), (2, "an acceleration")])
@pytest.mark.parametrize("factor", [1.0, 1e-3])
def test_a_derivative_is_named(order, word, factor):
    """Another channel of the simulation, in mm/s or in m/s."""
    slow = resonances()
    slow = replace(slow, time=slow.time / 4)
    f = np.fft.rfftfreq(slow.time.size, slow.time[1])
    rate = np.fft.irfft((2j * np.pi * f) ** order * np.fft.rfft(slow.weight @ slow.q), slow.time.size)
    fine = np.repeat(slow.time, 4) + np.tile(np.arange(4) / 4 * slow.time[1], slow.time.size)
    padded = np.fft.irfft(np.fft.rfft(slow.q, axis=1), 4 * slow.time.size, axis=1) * 4
    row = row_of(replace(slow, time=fine, q=padded), factor * rate, time=slow.time)
    assert row.light == "red"
    assert f"it is {word}, not a displacement" in row.finding


def test_one_mode_with_another_factor_is_named(modes):
    """One that is normalised otherwise, and one that the simulation leaves out."""
    weight = modes.weight
    weight[2] *= 0.5
    assert "mode 3 takes part with a factor of 0.5" in row_of(modes, weight @ modes.q).finding
    weight[2] = 0.0
    assert "mode 3 takes part with a factor of 0 " in row_of(modes, weight @ modes.q).finding


def test_several_factors_are_listed(modes):
    """What a fit of all modes finds, where no single cause explains the displacement."""
    weight = modes.weight
    weight[[0, 2, 4]] *= (0.5, 2.0, 1.5)
    row = row_of(modes, weight @ modes.q + modes.noise(0.01))
    assert row.light == "red"
    for words in ("mode 1: 0.5", "mode 3: 2", "mode 5: 1.5"):
        assert words in row.finding
    assert "mode 2:" not in row.finding


def test_a_missing_mode_is_no_fault_of_the_others(modes):
    """No mode is blamed; the frequency of what is missing is told, and modes without coordinates."""
    row = row_of(replace(modes, q=modes.q[1:]), modes.weight @ modes.q, mode=range(2, 13), lacking=(1,))
    assert row.light == "red"
    assert "is no sum of these modes at this node, most of that near 5 Hz; modes 1 have no coordinates" in row.finding
    assert "likely cause" not in row.finding


def test_a_constant_difference_is_a_doubt_about_the_static_part(modes):
    """Vibration proves the modes; a position has its constant part beside it."""
    row = row_of(modes, modes.weight @ modes.q + 1500.0)
    assert row.light == "amber"
    assert "a constant difference of 1500 mm, as a position has" in row.finding


def test_what_cannot_be_told_is_no_answer(modes):
    """With one mode its sign and that of all are one; with a pure sine a shift in time does the same."""
    one = replace(modes, q=modes.q[:1], shape=modes.shape[:1])
    row = row_of(one, -one.weight @ one.q)
    assert row.light == "red"
    assert "several causes would explain it alike" in row.finding
    sine = replace(one, q=np.sin(2 * np.pi * 5 * one.time)[None])
    row = row_of(sine, -sine.weight @ sine.q)
    assert "several causes" in row.finding
    assert "s late" in row.finding


def test_a_displacement_of_something_else_blames_nothing(modes):
    """Noise of its own."""
    row = row_of(modes, modes.noise(1.0))
    assert row.light == "red"
    assert "is no sum of these modes" in row.finding
    assert "likely cause" not in row.finding


@pytest.mark.parametrize(
    ("measured", "shape", "light", "words"),
    [
        (3.0, 1.0, "amber", "does not change and proves nothing"),
        (0.0, 1.0, "amber", "does not change and proves nothing"),
        (None, 0.0, "red", "but no mode moves the node in this direction"),
    ],
)
def test_nodes_that_do_not_move(modes, measured, shape, light, words):
    """They prove nothing, or something is wrong with node or direction."""
    values = modes.weight @ modes.q if measured is None else np.full(modes.time.size, measured)
    row = row_of(replace(modes, shape=shape * modes.shape), values)
    assert row.light == light
    assert words in row.finding


def test_a_direction_in_which_the_node_hardly_moves_proves_nothing(modes):
    """Round-off of a plane of symmetry fits, and is no proof."""
    flat = replace(modes, shape=modes.shape * np.array([1.0, 1.0, 1e-12]))
    row = row_of(flat, flat.weight @ flat.q)
    assert row.light == "amber"
    assert "in this direction the node hardly moves" in row.finding


@pytest.mark.parametrize("kind", ["flip", "swap", "factor", "pair"])
def test_nobody_is_blamed_wrongly(kind):
    """Thirty modes of any size: the cause that is named is the right one, or a part of it, or none is."""
    for seed in range(12):
        drawn = resonances(modes=30, samples=1500, seed=seed)
        k, j = np.random.default_rng(seed + 99).choice(30, 2, replace=False)
        weight = drawn.weight
        if kind == "swap":
            weight[[k, j]] = weight[[j, k]]
        else:
            weight[k] *= 0.5 if kind == "factor" else -1
            weight[j] *= -1 if kind == "pair" else 1
        finding = row_of(drawn, weight @ drawn.q + drawn.noise(0.01, seed)).finding
        k, j = sorted((k + 1, j + 1)) if kind in {"swap", "pair"} else (k + 1, j + 1)
        right = {
            "flip": (f"the sign of mode {k} is",),
            "swap": (f"the modes {k} and {j} have changed",),
            "factor": (f"mode {k} takes part with a factor of 0.5",),
            "pair": (f"sign of the modes {k}, {j} is", f"sign of mode {k} is", f"sign of mode {j} is"),
        }[kind]
        assert "likely cause" not in finding or any(words in finding for words in right), finding


@pytest.mark.parametrize("factor", [0.25, 4.0])
def test_other_steps_are_interpolated(modes, factor):
    """A finer and a coarser record of the displacement; 40 Hz at 50 Hz sampling is no obstacle."""
    fine = replace(modes, q=modes.q, time=modes.time)
    count = int((modes.time.size - 1) / factor)
    time = np.linspace(modes.time[0] + 0.1, modes.time[-1] - 0.1, count)
    f = np.fft.rfftfreq(modes.time.size, 1 / 200.0)
    spectrum = np.fft.rfft(modes.weight @ modes.q) / modes.time.size
    exact = np.real(2 * np.exp(2j * np.pi * np.outer(time, f)) @ spectrum) - np.real(spectrum[0])
    row = row_of(fine, exact, time=time)
    assert row.light == "green"
    assert row.value < 0.01
