"""README and docs keep to what is there: links, paths, commands, names, verdicts, codes, equations and examples."""

import csv
import inspect
import re
import shlex
import tomllib
from importlib import import_module
from pathlib import Path

import click
import pytest

from fatigue.pipeline.count.block import TIERS
from fatigue.spectrum import trust
from tests import reference
from tests.command_line import fatigue
from tests.equations import equation_pages
from tests.small_case import small_case

ROOT = Path(__file__).parents[1]
PAGES = [ROOT / name for name in ("README.md", "CHANGELOG.md", "CONTRIBUTING.md", "SECURITY.md")] + sorted(
    ROOT.glob("docs/**/*.md")
)
ELSEWHERE = {"--help", "--count", "--seed"}  # of every command; of `python -m tests.fuzz`
ELSEWHERE |= {"--rooms", "--sample", "--first", "--tree", "--near", "--at"}  # of `python -m tests.mutation`
ELSEWHERE |= {"--host", "--protocol"}  # of dask
NEEDS = re.compile(r"# needs: (a SLURM cluster)\n")  # what no test machine has: the only blocks that do not run
THEORY, NOTATION = ROOT / "docs" / "how-it-works.md", ROOT / "docs" / "notation.md"

each_page = pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)


def read(page: Path) -> str:
    """Text of a page."""
    return page.read_text(encoding="utf-8")


def anchors(page):
    """Headings of a page as addresses."""
    headings = re.findall(r"^#+ (.+)$", read(page), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading).lower().replace(" ", "-") for heading in headings}


def found(name):
    """Module, function, class or member of a dotted name."""
    parts = name.split(".")
    for end in range(len(parts), 0, -1):
        try:
            thing = import_module(".".join(parts[:end]))
        except ModuleNotFoundError:
            continue
        for part in parts[end:]:
            fields = getattr(thing, "__dataclass_fields__", {})
            thing = fields[part] if part in fields else getattr(thing, part)
        return thing
    raise ModuleNotFoundError(name)


@each_page
def test_links_lead_somewhere(page):
    """Every link is a file or folder of the project, and its heading is there."""
    links = re.findall(r"\]\(([^)\s]+)\)", read(page))
    assert (
        links
        or page.name == "CHANGELOG.md"
        or page.relative_to(ROOT / "docs").with_suffix("").as_posix() in reference.PAGES
    )
    for link in links:
        name, _, heading = link.partition("#")
        target = (page.parent / name).resolve() if name else page
        assert target.is_relative_to(ROOT), link
        assert target.exists(), link
        assert not heading or heading in anchors(target), link


@each_page
def test_paths_are_there(page):
    """Every path that begins with a folder of the project exists; a star stands for any name."""
    paths = re.findall(r"(?<![\w./-])((?:fatigue|tests|docs|data|examples|benchmarks|\.ci)/[\w./*-]*[\w*])", read(page))
    gone = [path for path in paths if not any(ROOT.glob(path))]
    assert not gone


@each_page
def test_options_are_those_of_the_commands(page):
    """No option is told that no command has."""
    had = {
        name for c in reference.commands().values() for o in reference.options(c) for name in o.opts + o.secondary_opts
    }
    told = set(re.findall(r"(?<![\w-])--[a-z][a-z-]+", read(page)))
    assert told <= had | ELSEWHERE


@each_page
def test_commands_are_those_of_the_program(page):
    """No command is told that the program has not."""
    told = set(re.findall(r"(?:`|^|&& )fatigue ([a-z][a-z-]*)", read(page), re.MULTILINE))
    assert told <= set(reference.commands())


@each_page
def test_names_of_python_can_be_imported(page):
    """Every dotted name in code is a module or a name in one."""
    for name in re.findall(r"`(fatigue(?:\.\w+)+)(?:\(.*?\))?`", read(page)):
        assert name == "fatigue.log" or found(name) is not None


@each_page
def test_examples_run(page, tmp_path, monkeypatch):
    """What stands under ``python`` runs, beside a case ``demo/case.toml``."""
    blocks = re.findall(r"^```python\n(.*?)^```", read(page), re.MULTILINE | re.DOTALL)
    if blocks:
        small_case().write(tmp_path / "demo")
        monkeypatch.chdir(tmp_path)
    names = {}
    for block in blocks:
        if NEEDS.match(block):
            continue
        exec(compile(block, page.name, "exec"), names)


@each_page
def test_toml_and_csv_can_be_read(page):
    """What stands under ``toml`` is TOML; what stands under ``csv`` has as many fields in each row."""
    for block in blocks_of("toml", page):
        tomllib.loads(block)
    for block in blocks_of("csv", page):
        assert len({len(row) for row in csv.reader(block.splitlines()) if row}) == 1


@each_page
def test_commands_can_be_given(page):
    """Each line of ``bash`` that calls the program has options that the program takes.

    Paths are those of the reader, so that the commands are not run; those of the walk through the example are.
    """
    for words in command_lines(page):
        given, command = words[1:], reference.commands()[""]
        while isinstance(command, click.Group):
            given = [word for word in given if word not in ("-q", "-v")]
            if not given or given[0].startswith("-"):
                break
            command = command.commands[given.pop(0)]
        parser = command.make_parser(click.Context(command, info_name=command.name))
        parser.parse_args(args=[word for word in given if word not in ("-h", "--help", "--version")])


def test_example_of_the_first_page_runs(tmp_path):
    """The ten minutes with the example, word for word; nothing of it is refused."""
    for words in command_lines(ROOT / "docs" / "start" / "example.md"):
        done = fatigue(*words[1:], cwd=tmp_path)
        assert done.returncode in (0, 1), (words, done.stderr)  # 1: done, a target is missed


def blocks_of(language, page):
    """Blocks of a language on a page."""
    return re.findall(rf"^```{language}\n(.*?)^```", read(page), re.MULTILINE | re.DOTALL)


def command_lines(page):
    """Words of every call of the program under ``bash``, continued lines joined."""
    for block in blocks_of("bash", page):
        for line in block.replace("\\\n", " ").splitlines():
            for part in re.split(r"&&|\|(?!\|)|;", line):
                words = shlex.split(part, comments=True)
                if words[:1] == ["fatigue"]:
                    yield words[: next((k for k, word in enumerate(words) if word in (">", "&", "2>")), None)]


def test_every_page_is_reached_by_links():
    """Nothing is hidden from a reader of the files: from the README, link by link, to every page."""
    reached, to_read = set(), [PAGES[0]]
    while to_read:
        page = to_read.pop()
        if page not in reached:
            reached.add(page)
            links = (link.partition("#")[0] for link in re.findall(r"\]\(([^)\s]+)\)", read(page)))
            to_read += [(page.parent / name).resolve() for name in links if name.endswith(".md")]
    assert not set(PAGES) - reached


def test_commands_at_a_glance_are_all():
    """A command that is not in the table is not found."""
    page = read(ROOT / "docs" / "how-to" / "commands.md")
    assert not [name for name in reference.commands() if f"| `fatigue {name}".rstrip() not in page]


@pytest.mark.parametrize("name", reference.PAGES)
def test_reference_is_that_of_the_program(name):
    """Commands, options, keys, columns, curves, codes and names; ``python -m tests.reference`` writes them again."""
    page = read(reference.DOCS / f"{name}.md")
    assert page == reference.with_collected(name, page)


def test_pages_of_equations_are_those_of_the_method():
    """Each equation has its page with source and place, and no page is left of one that is gone."""
    pages = {path.name: read(path) for path in sorted((reference.DOCS / "theory").glob("*.md"))}
    assert pages == equation_pages()


def test_the_house_is_drawn_as_it_is():
    """Every folder of the package stands in the plan of the house, and no other."""
    plan = read(ROOT / "CONTRIBUTING.md").split("```\nfatigue/\n", 1)[1].split("```", 1)[0]
    way, drawn = [], set()
    for indent, name in re.findall(r"^( +)(\w+)/ ", plan, re.MULTILINE):
        way[len(indent) // 2 - 1 :] = [name]
        drawn.add("/".join(way))
    rooms = {path.parent.relative_to(ROOT / "fatigue").as_posix() for path in ROOT.glob("fatigue/*/**/__init__.py")}
    assert drawn == rooms


def test_verdicts_are_those_of_the_program():
    """Each verdict has its row, in the order of the rule, with the limits that the rule has."""
    part = reference.section(read(THEORY), "May the spectrum be trusted")
    rows = dict(re.findall(r"^\| `(\w+)` \| (.+) \|$", part, re.MULTILINE))
    first, valid, *others = trust.VERDICTS
    assert list(rows) == [first, *others, valid]
    limits = {
        "outside_band": [round(100 * trust.missed_limit(k)) for k in trust.RATIO_BAND],
        "sampling": [trust.FEWEST_SAMPLES_PER_PEAK, trust.HIGHEST_PEAK_RATE],
        "quasi_static": [100 * trust.SLOW_SHARE],
        "single_event": [100 * trust.TOP_CYCLE_SHARE, 100 * trust.HALF_OF_DAMAGE],
        "non_stationary": [trust.MODULATED, trust.MODULATION_MATTERS],
        "harmonic": [trust.STEADY, trust.NARROW_PEAK, trust.STEADIER_THAN_CHANCE, 100 * trust.LINE_SHARE],
        "non_gaussian": [trust.KURTOSIS_OFF],
        "bandwidth": [number for slope, band in trust.RATIO_BAND.items() for number in (slope, *band)],
    }
    for name, numbers in limits.items():
        told = {float(number) for number in re.findall(r"(?<![\w.])\d+(?:\.\d+)?", rows[name])}
        assert told >= set(numbers), name
    assert f"above {100 * trust.CONFIDENT:.0f} %" in part


def test_tiers_of_screening_are_those_of_the_program():
    """Each tier that ``screened`` may name has its row."""
    part = reference.section(read(THEORY), "Points that need no counting")
    assert {tier for tier in TIERS if tier} == set(re.findall(r"^\| `([\w ]+)` \| ", part, re.MULTILINE)) - {"screened"}


def test_equations_are_numbered_and_cited():
    """Equations count up from 1; whoever cites one, in docs or docstrings, cites one there is."""
    numbers = [int(n) for n in re.findall(r"^\*\*Eq\. (\d+), ", read(THEORY), re.MULTILINE)]
    assert numbers == list(range(1, len(numbers) + 1))
    texts = [read(path) for path in (*PAGES, *ROOT.glob("fatigue/**/*.py"))]
    cited = {int(n) for text in texts for n in re.findall(r"\bEq\. (\d+)\b", text)}
    assert cited <= set(numbers)


def test_a_formula_cites_its_equation_where_it_stands():
    """The docstring of the function that an equation names has the number of the equation."""
    named = re.findall(r"^\*\*Eq\. (\d+), [^*]+\*\* \(`([\w.]+)`\)", read(THEORY), re.MULTILINE)
    assert len(named) > 15
    for number, place in named:
        text = found(place).__doc__
        assert re.search(rf"\bEq\. {number}\b", text), (number, place)


def test_symbols_stand_where_the_notation_says():
    """Each code name is a member, a parameter or a word of the thing that its row names."""
    rows = re.findall(r"^\|.*\| `(\w+)` \|[^|]*\|[^|]*\| `([\w.]+)` \|$", read(NOTATION), re.MULTILINE)
    assert len(rows) > 30
    for name, place in rows:
        thing = found(f"fatigue.{place}")
        has = hasattr(thing, name) or name in getattr(thing, "__dataclass_fields__", {})
        source = inspect.getsource(getattr(thing, "py_func", thing))
        assert has or re.search(rf"\b{name}\b", source), (name, place)
