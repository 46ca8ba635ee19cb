"""Mistakes in ``fleet.toml``, each with its place and what to do."""

import pytest

from fatigue.decide.fleet.fleet_file import PERCENT, load_fleet
from fatigue.errors import CaseError

ONE = '[[condition]]\nname = "a"\nresults = "out"\nevent = "x"\n'
TWO = ONE.replace('"a"', '"b"')


def told(tmp_path, text):
    """What is said of a file."""
    path = tmp_path / "fleet.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(CaseError) as refused:
        load_fleet(path)
    return str(refused.value)


def test_defaults(tmp_path):
    """Title, percentiles, no target; paths are beside the file."""
    path = tmp_path / "fleet.toml"
    path.write_text('km = "km.csv"\n' + ONE, encoding="utf-8")
    found = load_fleet(path)
    assert (found.title, found.percentiles, found.target_years, found.names) == ("Fleet", PERCENT, None, ("a",))
    assert found.resolve(found.km) == tmp_path / "km.csv"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ('km = "k.csv"\n' + ONE + ONE, "condition[2].name: 'a' is already the name of condition[1]"),
        (ONE, "km: the key is missing. Give the table of distances"),
        ('km = "k.csv"\n', "condition: the key is missing"),
        ('km = "k.csv"\ncondition = []\n', "condition"),
        ('km = "k.csv"\nyears = 3\n' + ONE, "years: unknown key"),
        ('km = "k.csv"\ntarget_years = 0\n' + ONE, "target_years"),
        ('km = "k.csv"\npercentiles = [101.0]\n' + ONE, "percentiles"),
        ('km = "a\\tb.csv"\n' + ONE, "holds a tab"),
        ('km = "k.csv"\n' + ONE + "damage_cv = -0.1\n", "damage_cv"),
        ('km = "k.csv"\n' + ONE + '[[correlation]]\nconditions = ["a", "c"]\nrho = 0.5\n', "no condition 'c'"),
        ('km = "k.csv"\n' + ONE + '[[correlation]]\nconditions = ["a", "a"]\nrho = 0.5\n', "stands there twice"),
        ('km = "k.csv"\n' + ONE + TWO + 2 * '[[correlation]]\nconditions = ["a", "b"]\nrho = 0.5\n', "stands in corr"),
        ('km = "k.csv"\n' + ONE + TWO + '[[correlation]]\nconditions = ["a", "b"]\nrho = 1.5\n', "rho"),
        ('km = "k.csv"\n' + ONE + "damage_cv = 0.1\n" + ONE.replace('"a"', '"b"'), "damage_cv: is none, and 0.1 in"),
        ("[body]\n[mission]\n", "this is a case (case.toml), not a fleet"),
        ("km = \n", "toml"),
    ],
)
def test_mistakes(tmp_path, text, words):
    """One line for each."""
    assert words.lower() in told(tmp_path, text).lower()


def test_no_file(tmp_path):
    """The path is named."""
    with pytest.raises(CaseError, match=r"none\.toml: there is no such file"):
        load_fleet(tmp_path / "none.toml")
