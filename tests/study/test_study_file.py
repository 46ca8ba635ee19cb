"""What ``study.toml`` may say, and what is refused with all mistakes at once."""

import pytest

from fatigue.errors import CaseError
from fatigue.study.study_file import load_study, short_name

BASE = '[base]\ncase = "case.toml"\n'


def refused(folder, text):
    """Lines of the refusal of a study."""
    path = folder / "study.toml"
    path.write_text(text)
    with pytest.raises(CaseError) as found:
        load_study(path)
    return [str(problem) for problem in found.value.problems]


def test_defaults(tmp_path):
    """One seed, one value at a time, histories of the case itself."""
    (tmp_path / "study.toml").write_text(BASE)
    study = load_study(tmp_path / "study.toml")
    assert (study.seeds, study.combine, study.vary, study.is_builtin) == ((1,), "one-at-a-time", (), False)
    assert study.resolve("case.toml") == tmp_path / "case.toml"


def test_tables_in_set_are_keys_with_dots(tmp_path):
    """TOML reads a dotted key without quotation marks as tables in one another."""
    text = BASE + '[[variant]]\nname = "a"\nset = { case.curve.survival = "mean", "case.title" = "x" }\n'
    (tmp_path / "study.toml").write_text(text)
    (variant,) = load_study(tmp_path / "study.toml").variant
    assert variant.set == {"case.curve.survival": "mean", "case.title": "x"}


def test_all_mistakes_are_told_at_once(tmp_path):
    """Each with its place, value and remedy."""
    lines = refused(
        tmp_path,
        BASE
        + 'seeds = [1, -1]\n[source]\ncommand = "x"\nfiles = "y"\nextra = 1\n[[vary]]\nkey = "own.a b"\nvalues = []\n',
    )
    assert any("base.seeds" in line for line in lines)
    assert any("vary[1].values: [] is empty" in line for line in lines)
    assert any("source.extra: unknown key" in line for line in lines)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "base: the key is missing"),
        ("[base]\n", "neither vehicle nor case is given"),
        ("seeds = []\n" + BASE, "seeds: [] is empty"),
        ("seeds = [1, 1]\n" + BASE, "seeds: 1 is there twice"),
        (BASE + '[[vary]]\nkey = "own.a"\nvalues = [350, 350.0]\n', "350.0 is there twice"),
        (BASE + '[[vary]]\nkey = "own.a"\n', "vary[1].values: the key is missing"),
        (BASE + "[[vary]]\nvalues = [1]\n", "neither key nor set is given"),
        (BASE + '[[vary]]\nkey = "own.a"\nvalues = [[1], [2]]\n', "values that are lists have no names"),
        (BASE + '[[vary]]\nkey = "own.a"\nvalues = [1, 2]\nlabels = ["x"]\n', "1 labels of 2 values"),
        (BASE + '[[vary]]\nkey = "own.seed"\nvalues = [1, 2]\n', "'seed' has a meaning of its own"),
        (BASE + '[[vary]]\nkey = "case.title"\nvalues = ["a"]\nbase = "b"\n', "vary[1].base"),
        (BASE + '[[vary]]\nname = "n"\nset = [{ own.a = 1 }]\n', "tables of set have no names"),
        (2 * '[[vary]]\nkey = "own.a"\nvalues = [1]\n' + BASE, "'a' is already the name of vary[1]"),
        (BASE + '[source]\ncommand = "x"\nfiles = "y"\n', "command and files are all given"),
        (BASE + '[source]\ninputs = ["x"]\n', "inputs are those of a command"),
        (BASE + "[source]\nbuiltin = true\n", "there is no vehicle"),
        (BASE + '[[source.run]]\nevent = "e"\n', "nothing says where these come from"),
        ('[base]\nvehicle = "v"\n[source]\nfiles = "y"\n', "base.case"),
        (BASE + "x = \n", "not valid TOML"),
        ("[body]\n[mission]\n", "this is a case (case.toml), not a study"),
        ("[track]\n", "this is a vehicle (vehicle.toml), not a study"),
    ],
)
def test_mistakes(tmp_path, text, words):
    """Each is one line that names the file and the place."""
    lines = refused(tmp_path, text)
    assert any(words in line and line.startswith("study.toml") for line in lines), lines


def test_a_file_that_is_not_there(tmp_path):
    """Its name is told."""
    with pytest.raises(CaseError, match=r"none\.toml: there is no such file"):
        load_study(tmp_path / "none.toml")


@pytest.mark.parametrize(
    ("key", "name"),
    [
        ("vehicle.suspension.primary_x_N_m", "primary_x"),
        ("vehicle.suspension.yaw_damper_Ns_m", "yaw_damper"),
        ("vehicle.suspension.anti_roll_Nm_rad", "anti_roll"),
        ("vehicle.contact.worn_amplitude_mm", "worn_amplitude"),
        ("case.mission.event.worn.stress_factor", "stress_factor"),
        ("own.m", "m"),
    ],
)
def test_short_names(key, name):
    """The last part without its unit; a name that is nothing but a unit stays."""
    assert short_name(key) == name
