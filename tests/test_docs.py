"""README and docs keep to what is there: links, paths, commands, names, verdicts, codes, equations and examples."""

import inspect
import re
from importlib import import_module
from pathlib import Path

import pytest

from fatigue.pipeline.count.block import TIERS
from fatigue.spectrum import trust
from tests import problem_codes, reference
from tests.small_case import small_case

ROOT = Path(__file__).parents[1]
PAGES = [ROOT / name for name in ("README.md", "CHANGELOG.md", "CONTRIBUTING.md")] + sorted(ROOT.glob("docs/*.md"))
ELSEWHERE = {"--help", "--count", "--seed"}  # of every command; of `python -m tests.fuzz`
ELSEWHERE |= {"--rooms", "--sample", "--first", "--tree", "--near", "--at"}  # of `python -m tests.mutation`
ELSEWHERE |= {"--host", "--protocol"}  # of dask
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
    assert links or page.name == "CHANGELOG.md"
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
        exec(compile(block, page.name, "exec"), names)


def test_readme_leads_to_every_page():
    """Nothing of the docs is hidden."""
    readme = read(PAGES[0])
    pages = [page.relative_to(ROOT).as_posix() for page in PAGES[1:]]
    assert not [page for page in pages if f"({page})" not in readme]


def test_readme_lists_every_command():
    """A command that is not in the table of the README is not found."""
    assert not [name for name in reference.commands() if f"| `fatigue {name}".rstrip() not in read(PAGES[0])]


def test_reference_is_that_of_the_program():
    """Commands, options, columns and codes; ``python -m tests.reference`` writes them again."""
    page = read(reference.PAGE)
    assert page == reference.with_collected(page)


def test_every_warning_has_its_meaning():
    """A code that is told as a warning stands in a table with what it says and what to do."""
    told = reference.warnings_told(read(reference.PAGE))
    assert not told - set(problem_codes.codes())
    assert not problem_codes.codes_of_warnings() - told


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
