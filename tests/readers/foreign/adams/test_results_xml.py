"""Adams results as XML, laid out as Adams Solver (C++) writes them."""

import numpy as np
import pytest

from fatigue.errors import DataError
from fatigue.readers.foreign.read import read_channels, read_coordinates, recognise

T = 0.02 * np.arange(1, 41)
Q = np.random.default_rng(8).standard_normal((2, 40))
HEAD = """<?xml version="1.0" encoding="UTF-8"?>
<Results xmlns="http://www.mscsoftware.com/:xrf10">
<Bibliography>
<File URI="file://C:\\car.res" schema="xrf" version="2.0.0.0" publicationDate="2026-03-21 17:42:24-05:00" />
<Revision version="1" derivedFrom="-unknown-">
<Comment>
</Comment>
</Revision>
</Bibliography>
"""
LAST = '<Component name="Q12" unitsValue="no_units" id="4" />\n'
ENTITY = '<!DOCTYPE x [<!ENTITY a "aaaa">]>\n'


def step(kind, values):
    """One step, its numbers wrapped as Adams wraps them."""
    words = [f"{value:.15G}" for value in values]
    return (
        f'<Step type="{kind}">\n'
        + "\n".join(" ".join(words[k : k + 3]) for k in range(0, len(words), 3))
        + "\n</Step>\n"
    )


def analysis(name="Dynamic Analysis", *, unit="sec", before=True, rows=None, kind="dynamic"):
    """One analysis: a part, a flexible body with two modal coordinates, time."""
    rows = np.vstack([T, np.sin(T), Q]).T if rows is None else rows
    text = f'<Analysis name="{name}" executionDate="2026-03-21 17:42:01" Solver="Adams C++">\n'
    text += f'<Units angle="deg" length="millimeter" mass="kg" time="{unit}" />\n<StepMap name="map_001">\n'
    text += f'<Entity name="time">\n<Component name="TIME" unitsValue="{unit}" id="1" />\n</Entity>\n'
    text += '<Entity name="PART_4_XFORM" entity="PART_4" entType="Part" objectId="4">\n'
    text += '<Component name="X" unitsValue="millimeter" id="2" />\n</Entity>\n'
    text += '<Entity name="FLEX_BODY_1_Q" entity="FLEX_BODY_1" entType="Flexible" objectId="5">\n'
    text += (
        '<Component name="Q7" unitsValue="no_units" id="3" />\n<Component name="Q12" unitsValue="no_units" id="4" />\n'
    )
    text += "</Entity>\n</StepMap>\n"
    text += '<Data name="modelInput_001" id="1">\n' + step("input", [0.0, 9.0, 9.0, 9.0]) + "</Data>\n"
    if before:
        start = step("initialConditions", [0.0, 0.0, 0.5, -0.5])
        text += '<Data name="initialConditions_001" id="2">\n' + start + "</Data>\n"
    text += f'<Data name="{kind}_001" id="3">\n' + "".join(step(kind, row) for row in rows) + "</Data>\n"
    return text + "</Analysis>\n"


def write(path, *analyses):
    """Write a file of results."""
    path.write_text(HEAD + "".join(analyses) + "</Results>\n")
    return path


def write_results(path, times, q, names):
    """Write one analysis of modal coordinates (m, t)."""
    text = analysis(rows=np.vstack([times, 0 * times, q]).T, before=False)
    i, j = text.index('<Component name="Q7"'), text.index("</Entity>\n</StepMap>")
    own = "".join(f'<Component name="{name}" unitsValue="no_units" id="{k}" />\n' for k, name in enumerate(names, 3))
    a, b = text.index('<Data name="modelInput'), text.index('<Data name="dynamic')
    return write(path, text[:i] + own + text[j:a] + text[b:])


def refused(path):
    """The refusal of a file."""
    with pytest.raises(DataError) as caught:
        read_coordinates(path, None, None)
    return caught.value.problems[0]


def test_modal_coordinates_among_all_results(tmp_path):
    """Those called Q; the position of part 4 is none. The initial conditions are the first sample."""
    path = write(tmp_path / "car.res", analysis())
    assert recognise(path).key == "res"
    history = read_coordinates(path, None, None)
    assert history.mode.tolist() == [7, 12]
    np.testing.assert_allclose(history.time, [0.0, *T])
    np.testing.assert_allclose(history.q[:, 1:], Q, rtol=1e-14)
    assert history.q[:, 0].tolist() == [0.5, -0.5]
    assert {warning.code for warning in history.warnings} == {"channels_left_out", "steps_left_out"}


def test_all_components_are_channels(tmp_path):
    """By entity and component, with their units."""
    (group,) = read_channels(write(tmp_path / "car.res", analysis(before=False)))
    assert (group.channels[0].name, group.channels[0].unit) == ("PART_4_XFORM.X", "millimeter")
    np.testing.assert_allclose(group.values([0])[0], np.sin(T), rtol=1e-14)


def test_time_in_ms_is_turned_into_seconds(tmp_path):
    """By its unit; a unit that is none is refused."""
    rows = np.vstack([1e3 * T, 0 * T, Q]).T
    path = write(tmp_path / "car.res", analysis(unit="millisecond", rows=rows, before=False))
    np.testing.assert_allclose(read_coordinates(path, None, None).time, T)
    assert refused(write(tmp_path / "b.res", analysis(unit="furlong", before=False))).code == "time_unit"


def test_a_step_that_repeats_a_time_is_one(tmp_path):
    """As where a simulation goes on from another; it is told."""
    rows = np.vstack([T, 0 * T, Q]).T
    path = write(tmp_path / "car.res", analysis(rows=np.vstack([rows[:20], rows[19:]]), before=False))
    history = read_coordinates(path, None, None)
    np.testing.assert_allclose(history.time, T)
    assert "step_again" in {warning.code for warning in history.warnings}


def test_ids_say_where_a_value_stands(tmp_path):
    """Components of an entity are listed together, and their values stand apart, as Adams writes velocities."""
    text = analysis(before=False)
    text = text.replace('"Q7" unitsValue="no_units" id="3"', '"Q7" unitsValue="no_units" id="40"')
    history = read_coordinates(write(tmp_path / "car.res", text), None, None)
    assert history.mode.tolist() == [12, 7]  # of ids 4 and 40
    np.testing.assert_allclose(history.q, Q, rtol=1e-14)


def test_a_run_from_static_equilibrium_starts_there(tmp_path):
    """The model as it was put together, before it found its equilibrium, would be a cycle that nothing ever makes."""
    equilibrium = '<Data name="static_001" id="4">\n' + step("static", [0.0, 0.0, 0.25, -0.25]) + "</Data>\n"
    text = analysis().replace('<Data name="dynamic_001"', equilibrium + '<Data name="dynamic_001"')
    history = read_coordinates(write(tmp_path / "car.res", text), None, None)
    assert history.time[0] == 0.0
    assert history.q[:, 0].tolist() == [0.25, -0.25]
    told = next(warning for warning in history.warnings if warning.code == "steps_left_out")
    assert told.what.endswith("1 of type 'input', 1 of type 'initialConditions'")


def test_a_run_that_goes_on_keeps_its_first_start(tmp_path):
    """Initial conditions of a simulation that goes on from another are its last step, and no new start."""
    rows = np.vstack([T, 0 * T, Q]).T
    start = '<Data name="initialConditions_002" id="9">\n' + step("initialConditions", rows[-1]) + "</Data>\n"
    later = '<Data name="dynamic_002" id="10">\n' + step("dynamic", rows[-1] + [0.02, 0, 0, 0]) + "</Data>\n"
    text = analysis().replace("</Analysis>", start + later + "</Analysis>")
    history = read_coordinates(write(tmp_path / "car.res", text), None, None)
    np.testing.assert_allclose(history.time, [0.0, *T, T[-1] + 0.02])
    assert history.q[:, 0].tolist() == [0.5, -0.5]


def test_values_are_read_of_the_components_asked_for(tmp_path):
    """A channel that is damaged where nobody asks for it does no harm; asked for, it is refused."""
    text = analysis(before=False).replace(f"{np.sin(T[4]):.15G}", "0.x1")
    (group,) = read_channels(write(tmp_path / "car.res", text))
    np.testing.assert_allclose(group.values([2, 1]), Q[::-1], rtol=1e-14)
    with pytest.raises(DataError, match=r"step 6 of Dynamic Analysis: it holds '0\.x1'"):
        group.values([0])


def test_modal_coordinates_of_two_bodies_are_told_apart(tmp_path):
    """A car body and a bogie frame, both with a mode 7: --columns names those of one."""
    text = analysis(before=False).replace('<Entity name="PART_4_XFORM"', '<Entity name="FRAME_Q"')
    path = write(
        tmp_path / "car.res", text.replace('<Component name="X" unitsValue="millimeter"', '<Component name="Q7"')
    )
    problem = refused(path)
    assert problem.code == "several_bodies"
    assert "'FRAME_Q.Q7', 'FLEX_BODY_1_Q.Q7'" in problem.what
    history = read_coordinates(path, {"FLEX_BODY_1_Q.Q7": 7, "FLEX_BODY_1_Q.Q12": 12}, None)
    np.testing.assert_allclose(history.q, Q, rtol=1e-14)


def test_two_analyses_are_two_groups(tmp_path):
    """On the same times they would be one event with every mode twice: channels of both are told apart by --columns."""
    path = write(tmp_path / "car.res", analysis("run 1"), analysis("run 2"))
    assert [group.name for group in read_channels(path)] == ["run 1", "run 2"]


@pytest.mark.parametrize(
    ("text", "code"),
    [
        (HEAD + analysis()[:-400], "res_damaged"),
        (
            HEAD + analysis().replace('<Component name="Q12" unitsValue="no_units" id="4" />\n', "") + "</Results>",
            "cut",
        ),
        (HEAD + analysis(kind="static") + "</Results>", "no_channels"),
        (
            HEAD.replace("<Results", '<!DOCTYPE x [<!ENTITY a "aaaa">]>\n<Results') + analysis() + "</Results>",
            "res_damaged",
        ),
        (HEAD + analysis().replace("\n0.02 ", "\n0.o2 ", 1) + "</Results>", "not_a_number"),
        (HEAD + analysis().replace("\n0.02 ", "\n0_02 ", 1) + "</Results>", "not_a_number"),
        (HEAD + analysis().replace('id="3" />\n<', 'id="4" />\n<') + "</Results>", "res_damaged"),
        (HEAD + analysis().replace('id="3" />\n<', 'id="x" />\n<') + "</Results>", "res_damaged"),
        (HEAD + analysis().replace('"TIME"', '"CLOCK"') + "</Results>", "no_time"),
        (
            HEAD + analysis().replace("</Analysis>", "<StepMap>" + LAST + "</StepMap></Analysis>") + "</Results>",
            "res_damaged",
        ),
    ],
)
def test_what_cannot_be_read_is_refused(tmp_path, text, code):
    """In one line with its place."""
    (tmp_path / "car.res").write_text(text)
    assert refused(tmp_path / "car.res").code == code


def test_entities_are_refused_in_any_encoding(tmp_path):
    """Ten lines of them would fill any memory."""
    text = HEAD.replace("UTF-8", "UTF-16").replace("<Results", ENTITY + "<Results") + analysis() + "</Results>"
    (tmp_path / "car.res").write_text(text, encoding="utf-16")
    assert refused(tmp_path / "car.res").code == "res_damaged"
