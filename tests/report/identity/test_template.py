"""A company template: what it may hold, and every mistake in one line."""

import pytest

from fatigue.case import load_case
from fatigue.errors import DataError
from fatigue.report.identity.template import PLAIN, TEMPLATE, look_of
from tests.case.case_text import MINIMAL
from tests.report.identity.pictures import PNG, svg


@pytest.fixture
def look(tmp_path):
    """Look of a case with this table, and a template of this text beside it."""

    def of(report, template=None):
        (tmp_path / "brand").mkdir(exist_ok=True)
        (tmp_path / "brand" / "logo.svg").write_bytes(svg())
        (tmp_path / "own.png").write_bytes(PNG)
        if template is not None:
            (tmp_path / "brand" / TEMPLATE).write_text(template, encoding="utf-8")
        (tmp_path / "case.toml").write_text(MINIMAL + f"\n[report]\n{report}\n", encoding="utf-8")
        return look_of(load_case(tmp_path / "case.toml"))

    return of


def told(look, report, template=None):
    """Lines that refuse a look."""
    with pytest.raises(DataError) as error:
        look(report, template)
    return [str(problem) for problem in error.value.problems]


BRAND = 'template = "brand"'


def test_a_case_without_one_has_the_plain_look(look):
    """An author alone changes no look."""
    assert look('author = "A"') == PLAIN


def test_all_a_template_may_hold(look):
    """Logo, language, colours and texts; the files it is made of are told by their hashes."""
    found = look(BRAND, 'logo = "logo.svg"\nlanguage = "de"\n[colours]\naccent = "#003366"\n[texts]\nfoot = "Geheim"\n')
    assert found.logo.startswith("data:image/svg+xml")
    assert found.language.tag == "de"
    assert found.colours == {"accent": "#003366"}
    assert found.texts == {"foot": "Geheim"}
    assert sorted(found.files) == ["logo", "template"]
    assert look(BRAND, "").logo == ""


def test_the_case_comes_before_its_template(look):
    """Logo and language of the case."""
    found = look(f'{BRAND}\nlogo = "own.png"\nlanguage = "en"', 'logo = "logo.svg"\nlanguage = "de"')
    assert found.logo.startswith("data:image/png")
    assert found.language.tag == "en"


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("[colours]\naccent = '#ffee00'", "template.toml: colours.accent: '#ffee00' can hardly be read: its contrast"),
        ("[colours]\nmissed = 'red'", "template.toml: colours.missed: 'red' is no colour"),
        ("[colours]\nink = 7", "template.toml: colours.ink: '7' is no colour"),
        ("[colours]\naccents = '#003366'", "template.toml: colours.accents: unknown key. Write 'accent'."),
        ("[colors]", "template.toml: colors: unknown key. Write 'colours'."),
        ("colours = 7", "template.toml: colours: '7' is no table"),
        ("[texts]\nfoot = 7", "template.toml: texts.foot: '7' is no text"),
        (f"[texts]\nfoot = '{'x' * 2001}'", "template.toml: texts.foot: has 2001 letters"),
        ("logo = 7", "template.toml: logo: '7' is no text"),
        ("logo = 'none.svg'", "template.toml: logo: "),
        ("language = 'xx'", "template.toml: language: there is no language 'xx'. Give one of en, de."),
        ("language = ''", "template.toml: language: '' is no text"),
        ("[texts", "case.toml: report.template: "),
    ],
)
def test_every_mistake_of_a_template(look, text, line):
    """One line with place, value and remedy; of an empty language two."""
    assert told(look, BRAND, text)[0].startswith(line)


def test_a_template_that_is_not_there(look, tmp_path):
    """No folder, a file, a folder without template.toml."""
    assert "is not there" in told(look, 'template = "nowhere"')[0]
    assert "is a file, not a folder" in told(look, 'template = "own.png"')[0]
    assert f"Write {TEMPLATE} into the folder" in told(look, BRAND)[0]


def test_a_language_that_is_not_there(look):
    """Told with those that are."""
    assert told(look, 'language = "fr"') == [
        "case.toml: report.language: there is no language 'fr'. Give one of en, de."
    ]
