"""The page in other languages: complete in headings, columns and verdicts; what is missing stays English, counted."""

import ast
import re
from pathlib import Path

import pytest

from fatigue.report.identity.identity import NAMES, Identity
from fatigue.report.identity.template import PLAIN
from fatigue.report.language import ENGLISH, Language, language_named, languages
from fatigue.report.page import report_page
from fatigue.report.sections.evidence.section import WORDS
from fatigue.report.sections.evidence.warnings import grouped
from tests.report.reading import Page

REPORT = Path(__file__).parents[3] / "fatigue" / "report"
OTHERS = [code for code in languages() if code != "en"]
MISSED_ON_THE_PAGE = 0  # texts of the page of the small result that have no German word


def templates():
    """Texts that templates say in the language of the page, as they stand there."""
    return {text for path in REPORT.rglob("*.html") for text in re.findall(r'\bt\("([^"]+)"', path.read_text("utf-8"))}


def headings():
    """Heads of columns, where they stand as a text."""
    trees = (ast.parse(path.read_text("utf-8")) for path in (REPORT / "sections").rglob("*.py"))
    calls = (node for tree in trees for node in ast.walk(tree) if isinstance(node, ast.Call) and node.args)
    heads = (node.args[0] for node in calls if getattr(node.func, "id", "") == "Heading")
    return {head.value for head in heads if isinstance(head, ast.Constant)}


@pytest.mark.parametrize("code", OTHERS)
def test_headings_columns_and_verdicts_are_complete(code):
    """Everything that templates and tables say, the entries of the identity, evidence, groups of warnings."""
    language = language_named(code)
    known = grouped([{"code": one, "where": ""} for one in ("short_edge", "sampling", "few_lines", "not_utf8")])
    groups = {text for group in known for text in (group.title, group.meaning)}
    wanted = templates() | headings() | set(NAMES.values()) | set(WORDS.values()) | groups
    assert len(groups) == 8
    assert len(wanted) > 200
    assert {text for text in wanted if language.translated(text) is None} == set()


@pytest.mark.parametrize("code", OTHERS)
def test_places_for_names_are_the_same(code):
    """In both languages, so that no text lacks its number."""
    language = language_named(code)
    for english, text in language.words.items():
        assert sorted(re.findall(r"\{\w*\}", english)) == sorted(re.findall(r"\{\w*\}", text))
    assert all(len(re.findall(r"\{\d?\}", text)) == pattern.groups for pattern, text in language.patterns)


def test_what_is_missing_is_english():
    """A text that has no word stays as it is, with what it was given."""
    german = language_named("de")
    assert german("No such words") == "No such words"
    assert german("{n} of them", n=3) == "3 of them"
    assert german("Shortest life") == "Kürzeste Lebensdauer"
    assert ENGLISH("Shortest life") == "Shortest life"


def test_composed_texts():
    """A caption with names in it, whatever is in the names."""
    german = language_named("de")
    caption = "W{1}: life, load factor and stress along the weld"
    assert german(caption) == "W{1}: Lebensdauer, Lastfaktor und Spannung entlang der Naht"
    assert german("A: S-N curve and the cycles of 12 km") == "A: Wöhlerlinie und die Zyklen von 12 km"


def test_a_page_in_german(result_folder, monkeypatch):
    """Verdict, contents, columns and captions; all texts that are looked up have their word but those counted."""
    missed, find = set(), Language.translated

    def noted(self, english):
        """The text, and a note where there is none."""
        found = find(self, english)
        if found is None and self.tag == "de":
            missed.add(english)
        return found

    monkeypatch.setattr(Language, "translated", noted)
    html = report_page(result_folder, identity=Identity({}, PLAIN.in_language("de")))
    page = Page(html)
    assert '<html lang="de">' in html
    for words in (
        "Ziel nicht erfüllt",
        "ENTWURF, nicht identifiziert",
        "Bild 1",
        "Kürzeste Lebensdauer",
        "Nahtverzeichnis",
    ):
        assert words in page.words
    assert "maßg. Ereignis" in page.tables["worst-welds"][0]
    assert page.tables["worst-welds"][1][1] == "✕ verfehlt"
    assert 'counter(page) " " "von" " "' in html
    assert len(missed) == MISSED_ON_THE_PAGE, sorted(missed)
