"""Commands, options, keys of a case, columns, curves, codes and names, collected from the program for the docs.

``python -m tests.reference`` writes the collected parts of ``docs/**/*.md`` again, and what refusals say into
``fatigue/explain/told.json``. What warnings mean is written in ``fatigue/explain/warnings.toml`` by hand.
"""

import inspect
import json
from collections.abc import Mapping
from itertools import groupby
from pathlib import Path
from typing import Any

import click

import fatigue
from fatigue.case import case_schema
from fatigue.cli import cli
from fatigue.decide.fleet.fleet_file import Fleet
from fatigue.explain import Explanation, all_codes
from fatigue.life.curves import catalogue
from fatigue.results.columns import TABLES
from fatigue.results.dictionary.basis import BASIS
from fatigue.results.dictionary.claims import CLAIMED
from fatigue.results.dictionary.decided.backsolve import BACKSOLVED
from fatigue.results.dictionary.decided.compare import COMPARED
from fatigue.results.dictionary.decided.correlation import CORRELATED
from fatigue.results.dictionary.decided.fleet import FLEET
from fatigue.results.dictionary.decided.gauges import GAUGE_TABLES
from fatigue.results.dictionary.decided.history import HISTORIES
from fatigue.results.dictionary.decided.whatif import WHATIFS
from fatigue.results.dictionary.graph import GRAPH
from fatigue.results.dictionary.study import STUDY
from fatigue.study.study_file import Study
from fatigue.study.vehicle_file import keys_of
from fatigue.study.vehicle_keys import KEYS, Key
from fatigue.study.vehicle_text import toml_value
from fatigue.vehicle.definition import Vehicle
from fatigue.verify.table import verification_table
from tests.equations import equation_list, equation_pages
from tests.told_problems import told

ROOT = Path(__file__).parents[1]
DOCS = ROOT / "docs"
TOLD = ROOT / "fatigue" / "explain" / "told.json"
AREAS = (  # where the refusals of a room are met by users; the first that fits
    ("case", "The case file"),
    ("readers/neutral", "Tables and histories of a case, weld register"),
    ("readers/text", "Text files"),
    ("readers/units", "Units"),
    ("readers/foreign/histories", "Simulation exports"),
    ("readers/foreign", "FE files"),
    ("readers/convert", "Conversion"),
    ("weld", "Weld lines and their elements"),
    ("life/bench", "Bench programmes"),
    ("life", "Signals, records and curves"),
    ("spectrum", "Signals, records and curves"),
    ("pipeline", "Assessment"),
    ("results", "Result folders and documents"),
    ("report", "Result folders and documents"),
    ("documents", "Result folders and documents"),
    ("point", "Result folders and documents"),
    ("verify", "Result folders and documents"),
    ("decide/bench_files", "Bench programmes"),
    ("decide/bench_points", "Bench programmes"),
    ("decide", "Decisions"),
    ("bench", "Bench programmes"),
    ("gauges", "Strain gauges"),
    ("study", "Studies of a vehicle"),
    ("vehicle", "Studies of a vehicle"),
    ("", "Commands and arguments"),
)
CASE_TABLES = {  # of case.toml, and the models that describe them
    "[body]": "Body",
    "[[body.unit_load]]": "UnitLoad",
    "[curve]": "Curve",
    "[curves.NAME]": "CustomCurve",
    "[counting]": "Counting",
    "[spectrum]": "Spectrum",
    "[mission]": "Mission",
    "[[mission.event]]": "Event",
    "[[mission.event.unit_load]]": "GivenLoad",
    "[[mission.unit_load]]": "MissionLoad",
    "[[mission.sequence]]": "Sequence",
    "[multiaxial]": "Multiaxial",
    "[checks]": "Checks",
    "[checks.stress_category]": "StressCategory",
    "[[checks.interaction]]": "Interaction",
    "[[checks.endurance]]": "EnduranceCheck",
}
FLEET_TABLES = {  # of fleet.toml
    "Fleet: the keys above all tables": "Fleet",
    "Fleet: [[condition]]": "Condition",
    "Fleet: [[correlation]]": "Correlation",
}
STUDY_TABLES = {  # of study.toml
    "Study: the keys above all tables": "Study",
    "Study: [base]": "Base",
    "Study: [[vary]]": "Vary",
    "Study: [[variant]]": "GivenVariant",
    "Study: [source]": "Source",
    "Study: [[source.run]]": "SourceRun",
}


def commands() -> dict[str, click.Command]:
    """Commands of the program in the order of their names, the program itself under the empty one.

    Those of a group stand behind it, as ``study graph``.
    """
    found: dict[str, click.Command] = {"": cli}
    for name, command in sorted(cli.commands.items()):
        found[name] = command
        if isinstance(command, click.Group):
            found |= {f"{name} {part}": command.commands[part] for part in sorted(command.commands)}
    return found


def options(command: click.Command) -> list[click.Option]:
    """Options of a command."""
    return [p for p in command.params if isinstance(p, click.Option)]


def section(text: str, heading: str) -> str:
    """Text under a heading of the second level."""
    return text.split(f"\n## {heading}\n", 1)[1].split("\n## ", 1)[0]


def command_text() -> str:
    """Commands with arguments and options, as ``--help`` has them."""
    parts = []
    for name, command in commands().items():
        context = click.Context(command, info_name=f"fatigue {name}".strip())
        usage = " ".join(command.collect_usage_pieces(context))
        lines = [f"## fatigue {name}".rstrip(), "", f"`{context.info_name} {usage}`", "", _first_words(command), ""]
        rows = [_option_row(option) for option in options(command)]
        lines += ["| option | what it does |", "|---|---|", *rows] if rows else []
        parts.append("\n".join(lines))
    return "\n\n".join(parts)


def _first_words(command: click.Command) -> str:
    """Help of a command without its examples, on one line for each paragraph."""
    text = (command.help or "").split("\b")[0]
    return "\n\n".join(" ".join(paragraph.split()) for paragraph in text.strip().split("\n\n"))


def _option_row(option: click.Option) -> str:
    """Names, value, meaning and default of an option; not as click lays them out, which differs between versions."""
    names = ", ".join(option.opts) + "".join(f" / {name}" for name in option.secondary_opts)
    value = option.metavar or "" if option.is_flag else option.metavar or _kind(option.type)
    default = "" if not option.show_default or option.is_flag else _default(option)
    meaning = " ".join((option.help or "").split()) + default
    return "| {} | {} |".format(*(text.replace("|", r"\|") for text in (f"`{f'{names} {value}'.strip()}`", meaning)))


def _kind(of: click.ParamType) -> str:
    return "|".join(map(str, of.choices)) if isinstance(of, click.Choice) else of.name.split()[0].upper()


def _default(option: click.Option) -> str:
    return f" Default: {option.show_default if isinstance(option.show_default, str) else option.default}."


def key_text() -> str:
    """Keys of ``case.toml`` with default and meaning, table by table."""
    return _keys_of_models(CASE_TABLES, case_schema())


def study_key_text() -> str:
    """Keys of ``study.toml`` with default and meaning, table by table."""
    return _keys_of_models(STUDY_TABLES, Study.model_json_schema())


def fleet_key_text() -> str:
    """Keys of ``fleet.toml`` with default and meaning, table by table."""
    return _keys_of_models(FLEET_TABLES, Fleet.model_json_schema())


def _keys_of_models(tables: dict[str, str], schema: dict[str, Any]) -> str:
    """Keys of the models of some tables, by heading and name; the schema itself is the model of its title."""
    models = {**schema["$defs"], schema["title"]: schema}
    parts = []
    for heading, model in tables.items():
        of, rows = models[model], []
        for key, about in of["properties"].items():
            given = None if isinstance(about.get("default"), dict) else about.get("default")
            default = "required" if key in of.get("required", ()) else "" if given is None else f"`{json.dumps(given)}`"
            rows.append(f"| `{key}` | {default} | {about['description']} |")
        lines = [f"## {heading}", "", of["description"], "", "| key | default | what it is |", "|---|---|---|", *rows]
        parts.append("\n".join(lines))
    return "\n\n".join(parts)


def vehicle_key_text() -> str:
    """Keys of ``vehicle.toml`` with the values of the reference trailer, their origin and range, table by table."""
    reference, parts = keys_of(Vehicle()), []
    for table, keys in KEYS.items():
        rows = [
            f"| `{name}` | {_value_of(reference[f'{table}.{name}'])} | {key.origin} | {key.meaning}{_allowed(key)} |"
            for name, key in keys.items()
        ]
        lines = [f"## Vehicle: [{table}]", "", "| key | value | origin | what it is |", "|---|---|---|---|", *rows]
        parts.append("\n".join(lines))
    return "\n\n".join(parts)


def _value_of(value: object) -> str:
    return "" if value is None else f"`{toml_value(value)}`"


def _allowed(key: Key) -> str:
    """Choices of a key, or its range."""
    if key.choices and key.choices[0] not in key.meaning:
        return ": " + ", ".join(f"`{choice}`" for choice in key.choices)
    return "" if key.choices or str(key.range) == "finite" else f"; {key.range}"


WRITTEN = TABLES | HISTORIES | COMPARED | WHATIFS | BACKSOLVED | FLEET | GAUGE_TABLES | CORRELATED
WRITTEN |= BASIS | GRAPH | STUDY | CLAIMED  # every table that a command writes


def column_text() -> str:
    """Columns of every table with type, unit and meaning."""
    parts = []
    for table, its in WRITTEN.items():
        rows = [f"| `{c.name}` | {c.type} | {c.unit} | {c.meaning} |" for c in its]
        parts.append(
            "\n".join([f"## {table}.parquet", "", "| column | type | unit | meaning |", "|---|---|---|---|", *rows])
        )
    return "\n\n".join(parts)


def curve_text() -> str:
    """Every curve of the catalogue with its numbers, then with source and clause."""
    curves = catalogue().values()
    numbers = [
        f"| `{c.name}` | {c.applies} | {c.quantity} | {_numbers(c.slopes)} | {_numbers(c.knees_cycles)} "
        f"| {_levels(c.reference_range)} | {c.reference_cycles:g} |"
        for c in curves
    ]
    sources = [f"| `{c.name}` | {_cell(c.source)} | {c.status} |" for c in curves]
    return "\n".join(
        [
            *("## Numbers", "", "| curve | applies to | quantity | slopes k | knees [cycles] | range | at cycles |"),
            *("|---|---|---|---|---|---|---|", *numbers),
            *("", "## Sources", "", "| curve | source, edition and clause | status |", "|---|---|---|", *sources),
        ]
    )


def _levels(ranges: Mapping[str, float]) -> str:
    return "; ".join(f"{level} {value:.6g}" for level, value in ranges.items())


def _numbers(values: tuple[float, ...]) -> str:
    return ", ".join(f"{value:.4g}" for value in values)


def warning_text(of: str) -> str:
    """Families of the warnings of results or of commands: why they matter, what each says and what to do."""
    pages = [page for page in all_codes().values() if page.kind == f"warning of a {of}"]
    parts = []
    for family, its in groupby(pages, key=lambda page: page.family):
        listed = list(its)
        rows = [f"| `{page.code}` | {_cell(page.says)} | {_cell(page.do)} |" for page in listed]
        table = ["| code | what it says | what to do |", "|---|---|---|", *rows]
        parts.append("\n".join([f"## {family}", "", listed[0].why, "", *table]))
    return "\n\n".join(parts)


def refusal_text() -> str:
    """Refusals by the place where they are met, with what they say and advise there."""
    areas: dict[str, dict[str, tuple[str, str]]] = {area: {} for _, area in AREAS}
    for page in all_codes().values():
        for area, said in _by_area(page).items():
            if page.kind == "refusal":
                areas[area][page.code] = said
    parts = []
    for area, found in areas.items():
        rows = [f"| `{code}` | {_cell(says)} | {_cell(do)} |" for code, (says, do) in sorted(found.items())]
        if rows:
            table = ["| code | what it says | what to do |", "|---|---|---|", *rows]
            parts.append("\n".join([f"## {area}", "", *table]))
    return "\n\n".join(parts)


def _by_area(page: Explanation) -> dict[str, tuple[str, str]]:
    """Of each area the words of the first place in it that has some."""
    found: dict[str, tuple[str, str]] = {}
    for place in page.places:
        area = next(a for room, a in AREAS if place.module.startswith((f"{room}/", f"{room}.py")) or not room)
        before = found.get(area, ("", ""))
        found[area] = (before[0] or page.says or place.what, before[1] or page.do or place.remedy)
    return found


def _cell(text: str) -> str:
    return text.replace("|", r"\|")


def python_text() -> str:
    """Public names with signature and docstring."""
    parts = []
    for name in sorted(set(fatigue.__all__) - {"__version__"}):
        thing = getattr(fatigue, name)
        signature = str(inspect.signature(thing)) if not inspect.isclass(thing) else ""
        module = inspect.getmodule(thing)
        lines = [f"## fatigue.{name}", "", f"`{name}{signature}`", "", f"In `{module.__name__ if module else name}`."]
        parts.append("\n".join([*lines, "", "```text", inspect.getdoc(thing) or "", "```"]))
    return "\n\n".join(parts)


def known_value_text() -> str:
    """Known values by topic: what is expected, how near it has to be, where it comes from."""
    parts = []
    for topic, its in groupby(verification_table().checks, key=lambda check: check.topic):
        rows = [
            f"| {_cell(c.case)} | {_cell(c.quantity)} | {c.expected:.9g} {c.unit} "
            f"| {c.tolerance:.0e} | {_cell(c.source)} |"
            for c in its
        ]
        table = ["| case | quantity | expected | tolerance | source |", "|---|---|---|---|---|", *rows]
        parts.append("\n".join([f"## {topic[0].upper()}{topic[1:]}", "", *table]))
    return "\n\n".join(parts)


PAGES = {  # of the docs, and what is written into each
    "reference/commands": command_text,
    "reference/case-keys": key_text,
    "reference/vehicle-keys": vehicle_key_text,
    "reference/study-keys": study_key_text,
    "reference/fleet-keys": fleet_key_text,
    "reference/columns": column_text,
    "reference/curves": curve_text,
    "reference/warnings-of-results": lambda: warning_text("result"),
    "reference/warnings-of-commands": lambda: warning_text("command"),
    "reference/errors": refusal_text,
    "reference/python": python_text,
    "theory": equation_list,
    "verification/known-values": known_value_text,
}
BEGIN, END = "<!-- written by python -m tests.reference -->", "<!-- end of what is written -->"


def told_text() -> str:
    """What every problem says and advises where it is made, for ``fatigue explain``."""
    return json.dumps(told(), ensure_ascii=False, indent=1) + "\n"


def with_collected(name: str, page: str) -> str:
    """Page of the reference with its collected part as the program has it now."""
    before, rest = page.split(BEGIN, 1)
    return f"{before}{BEGIN}\n\n{PAGES[name]()}\n\n{END}{rest.split(END, 1)[1]}"


if __name__ == "__main__":
    TOLD.write_text(told_text(), encoding="utf-8")
    for its_name in PAGES:
        its_page = DOCS / f"{its_name}.md"
        its_page.write_text(with_collected(its_name, its_page.read_text(encoding="utf-8")), encoding="utf-8")
    for its_name, its_text in equation_pages().items():
        (DOCS / "theory" / its_name).write_text(its_text, encoding="utf-8")
