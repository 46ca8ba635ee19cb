"""Every value is tried before anything runs: what vehicle and case say of it stands behind its place in the study."""

import pytest

from fatigue.errors import FatigueError
from fatigue.study.study_file import load_study
from fatigue.study.variants.story import listed_study
from tests.small_case import small_case

BASE = '[base]\nvehicle = "vehicle.toml"\ncase = "body/case.toml"\n[source]\ncommand = "x"\nevents = ["noise"]\n'


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """The small case and the reference vehicle."""
    folder = tmp_path_factory.mktemp("checked")
    small_case(1.0).write(folder / "body")
    (folder / "vehicle.toml").write_text("")
    return folder


def refused(folder, text):
    """Lines of the refusal of a study."""
    (folder / "study.toml").write_text(text)
    with pytest.raises(FatigueError) as found:
        listed_study(folder / "study.toml", folder / "out")
    return [str(problem) for problem in found.value.problems]


def vary(key, value):
    """One thing that is varied."""
    return BASE + f"[[vary]]\nkey = {key!r}\nvalues = [{value}]\n"


def test_a_sound_study(folder):
    """Keys of vehicle, case, an event by its name with blanks, and a list with a label."""
    text = BASE + (
        '[[vary]]\nkey = "vehicle.converter.fe_hz"\nvalues = [14]\n'
        '[[vary]]\nkey = "case.mission.event.load and unload.per_1000_km"\nvalues = [4.0]\n'
        '[[vary]]\nkey = "vehicle.contact.worn_sections_m"\nvalues = [[[1.0, 2.0]]]\nlabels = ["short"]\n'
    )
    (folder / "study.toml").write_text(text)
    listed = listed_study(folder / "study.toml", folder / "out")
    assert [run["variant"] for run in listed.runs] == ["base", "fe=14", "per_1000_km=4", "worn_sections=short"]
    assert listed.runs[0]["settings"] == {"fe": 9.2, "per_1000_km": 2.0, "worn_sections": "base"}


@pytest.mark.parametrize(
    ("key", "value", "words"),
    [
        ("vehicle.converter.fe", "14.0", "vary[1] (fe = 14): vehicle.toml: converter.fe: unknown key"),
        ("vehicle.converter.fe_hz", "'14'", "should be a number"),
        ("vehicle.converter.fe_hz", "-1.0", "vehicle.toml: converter.fe_hz: -1.0"),
        ("vehicle.contact.state", "'broken'", "none of the choices"),
        ("vehicle.car.body", "'none'", "there is no folder"),
        ("vehicle.run.seed", "3", "'seed' has a meaning of its own in every study"),
        ("case.curve.survival", "'low'", "vary[1] (survival = low): case.toml: curve.survival"),
        ("case.curve.survivl", "'mean'", "unknown key"),
        ("case.mission.target_km", "'far'", "should be a valid number"),
        ("case.mission.event.nose.stress_factor", "2.0", "no table of the name 'nose'. Write 'noise'"),
        ("case.mission.event.noise.share", "0.5", "sum to 1.25, not to 1"),
        ("case.body.nodal_forces", "'none.csv'", "there is no file"),
        ("case", "'none.toml'", "there is no such file"),
        ("own.a.b", "1", "is no key that can be varied"),
        ("stress_factor", "1", "is no key that can be varied"),
    ],
)
def test_keys_and_values(folder, key, value, words):
    """Place and value in the study, then what is wrong with it."""
    lines = refused(folder, vary(key, value))
    assert any(words in line for line in lines), lines


def test_the_seed_is_not_varied(folder):
    """Under another name neither."""
    (line,) = refused(folder, vary("vehicle.run.seed", "3") + 'name = "number"\n')
    assert "'vehicle.run.seed' is what seeds are for" in line


def test_all_of_them_at_once(folder):
    """One line each; a mistake that several variants would make again is told once."""
    text = vary("vehicle.converter.fe_hz", "-1.0, -2.0") + '[[vary]]\nkey = "case.curve.survival"\nvalues = ["low"]\n'
    assert len(refused(folder, text)) == 3


def test_values_that_are_wrong_together(folder):
    """Each is right alone: the variant that has both is named."""
    text = BASE + ('[[variant]]\nname = "x"\nset = { vehicle.run.dropped_s = 20.0, vehicle.run.speed_km_h = 900.0 }\n')
    (line,) = refused(folder, text)
    assert "variant 'x'" in line
    assert "leaves nothing of a run" in line


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (BASE.replace('"x"', '"x {fe} {sed}"'), "no setting is called 'sed'. Write {seed}"),
        (BASE.replace('"x"', '"x {"'), "has a brace alone"),
        (BASE.replace('"x"', '"x {seed} && y"'), "&& is for a shell, and the command is started without one. Write a"),
        (BASE.replace('"x"', '"x {seed} > out.txt"'), "> is for a shell"),
        (BASE.replace('command = "x"', 'files = "{run}/x"'), "{run} is made for a command only"),
        (BASE.replace('["noise"]', '["nose"]'), "case.toml has no event 'nose'. Write 'noise'"),
        (
            BASE.replace('["noise"]', '["noise"]\n[[source.run]]\nevent = "noise"'),
            "events and [[source.run]] are both given",
        ),
        (
            BASE.replace('events = ["noise"]', "")
            + '[[source.run]]\nevent = "noise"\nset = { own.a = 1 }\n[[vary]]\nkey = "own.a"\nvalues = [1]\n',
            "'own.a' is varied by vary[1], and every run of event 'noise' would set it again",
        ),
        (
            BASE.replace('events = ["noise"]', "")
            + '[[source.run]]\nevent = "noise"\nset = { case.curve.survival = "mean" }\n',
            "is of the case, which all events of a run share",
        ),
        (BASE.replace('command = "x"\n', ""), "the car body is the built-in frame, which has no welds"),
        (BASE.replace('command = "x"\nevents = ["noise"]', ""), "has 3 events with a history, and nothing says which"),
        (
            BASE.replace('command = "x"', "builtin = true") + '[[vary]]\nkey = "own.a"\nvalues = [1]\n',
            "a source of your own only",
        ),
        (BASE + '[[claim]]\ntext = "t"\nleft = "x[fe=14]"\noperator = ">"\nright = 1\n', "does not vary 'fe'"),
    ],
)
def test_sources(folder, text, words):
    """Placeholders, events and what a source cannot know."""
    lines = refused(folder, text)
    assert any(words in line for line in lines), lines


def test_a_command_cannot_leave_files_elsewhere(folder):
    """An absolute path, or one that leads out of the folder of the run, is told before anything runs."""
    case = folder / "body" / "case.toml"
    other = folder / "body" / "absolute.toml"
    other.write_text(
        case.read_text().replace('history = "noise.csv"', f'history = "{folder.as_posix()}/body/noise.csv"')
    )
    (line,) = refused(folder, BASE.replace("case.toml", "absolute.toml"))
    assert "which a command in the folder of its run cannot leave there" in line


def test_files_of_the_case_that_are_not_there(folder):
    """Those that the source makes need not be."""
    missing = folder / "missing"
    small_case(1.0).write(missing)
    (missing / "noise.csv").unlink()
    (folder / "study.toml").write_text(BASE.replace("body/", "missing/"))
    assert listed_study(folder / "study.toml", folder / "out").runs
    (missing / "sine.csv").unlink()
    (line,) = refused(folder, BASE.replace("body/", "missing/"))
    assert "mission.event[1].history: there is no file" in line


def test_the_study_itself_is_given(folder):
    """A study that was read is taken as it is."""
    (folder / "study.toml").write_text(BASE)
    assert listed_study(load_study(folder / "study.toml"), folder / "out").runs
