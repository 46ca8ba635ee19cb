"""README and docs keep to what is there: files and headings they link to, commands, options and names they tell."""

import re
from importlib import import_module
from pathlib import Path

import click
import pytest

from fatigue.cli import cli

ROOT = Path(__file__).parents[1]
PAGES = [ROOT / "README.md", ROOT / "CHANGELOG.md", *sorted((ROOT / "docs").glob("*.md"))]
ELSEWHERE = {"--count", "--seed"}  # options of `python -m tests.fuzz`


def anchors(page):
    """Headings of a page as addresses."""
    headings = re.findall(r"^#+ (.+)$", page.read_text(encoding="utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading).lower().replace(" ", "-") for heading in headings}


def options():
    """Options of all commands of the program."""
    commands = [cli, *cli.commands.values()]
    parameters = [p for command in commands for p in command.params if isinstance(p, click.Option)]
    return {name for p in parameters for name in (*p.opts, *p.secondary_opts)}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_somewhere(page):
    """Every link is a file of the project, and its heading is there."""
    links = re.findall(r"\]\(([^)\s]+)\)", page.read_text(encoding="utf-8"))
    assert links or page.name == "CHANGELOG.md"
    for link in links:
        name, _, heading = link.partition("#")
        target = (page.parent / name).resolve() if name else page
        assert target.is_relative_to(ROOT), link
        assert target.is_file(), link
        assert not heading or heading in anchors(target), link


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_options_are_those_of_the_commands(page):
    """No option is told that no command has."""
    told = set(re.findall(r"(?<![\w-])--[a-z][a-z-]+", page.read_text(encoding="utf-8")))
    assert told
    assert told <= options() | ELSEWHERE


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_commands_are_those_of_the_program(page):
    """No command is told that the program has not."""
    told = set(re.findall(r"(?:`|^|&& )fatigue ([a-z][a-z-]*)", page.read_text(encoding="utf-8"), re.MULTILINE))
    assert told <= set(cli.commands)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_names_of_python_can_be_imported(page):
    """Every dotted name in code is a module or a name in one."""
    for module, name in re.findall(r"`(fatigue(?:\.[a-z_]+)*)\.(\w+)`", page.read_text(encoding="utf-8")):
        if name == "log":
            continue
        found = import_module(module)
        assert hasattr(found, name) or import_module(f"{module}.{name}")


def test_readme_leads_to_every_page():
    """Nothing of the docs is hidden."""
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    assert not [page.name for page in PAGES[2:] if f"(docs/{page.name})" not in readme]
