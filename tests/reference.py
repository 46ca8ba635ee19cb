"""Commands, options, keys of a case, columns and codes, collected from the program, and their page of the docs.

``python -m tests.reference`` writes the collected parts of ``docs/reference.md`` again; what each warning means is
written there by hand.
"""

import json
import re
from pathlib import Path
from typing import Any

import click

from fatigue.case import case_schema
from fatigue.cli import cli
from fatigue.results.columns import TABLES
from fatigue.results.dictionary.basis import BASIS
from fatigue.results.dictionary.claims import CLAIMED
from fatigue.results.dictionary.decided.correlation import CORRELATED
from fatigue.results.dictionary.decided.gauges import GAUGE_TABLES
from fatigue.results.dictionary.graph import GRAPH
from fatigue.results.dictionary.study import STUDY
from fatigue.study.study_file import Study
from fatigue.study.vehicle_file import keys_of
from fatigue.study.vehicle_keys import KEYS, Key
from fatigue.study.vehicle_text import toml_value
from fatigue.vehicle.definition import Vehicle
from tests.problem_codes import codes

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "reference.md"
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
    ("verify", "Result folders and documents"),
    ("decide", "Bench programmes"),
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


def named_in(text: str) -> set[str]:
    """Codes that stand in the first column of a table, each in backticks."""
    return {
        name for cell in re.findall(r"^\| (`[^|]+) \|", text, re.MULTILINE) for name in re.findall(r"`(\w+)`", cell)
    }


def section(text: str, heading: str) -> str:
    """Text under a heading of the second level."""
    return text.split(f"\n## {heading}\n", 1)[1].split("\n## ", 1)[0]


def warnings_told(text: str) -> set[str]:
    """Codes that the page tells as warnings, by hand."""
    return named_in(section(text, "Warnings of a result")) | named_in(section(text, "Warnings of other commands"))


def command_text() -> str:
    """Commands with arguments and options, as ``--help`` has them."""
    parts = []
    for name, command in commands().items():
        context = click.Context(command, info_name=f"fatigue {name}".strip())
        usage = " ".join(command.collect_usage_pieces(context))
        lines = [f"### fatigue {name}".rstrip(), "", f"`{context.info_name} {usage}`", "", _first_words(command), ""]
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
        lines = [f"### {heading}", "", of["description"], "", "| key | default | what it is |", "|---|---|---|", *rows]
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
        lines = [f"### Vehicle: [{table}]", "", "| key | value | origin | what it is |", "|---|---|---|---|", *rows]
        parts.append("\n".join(lines))
    return "\n\n".join(parts)


def _value_of(value: object) -> str:
    return "" if value is None else f"`{toml_value(value)}`"


def _allowed(key: Key) -> str:
    """Choices of a key, or its range."""
    if key.choices and key.choices[0] not in key.meaning:
        return ": " + ", ".join(f"`{choice}`" for choice in key.choices)
    return "" if key.choices or str(key.range) == "finite" else f"; {key.range}"


def column_text() -> str:
    """Columns of every table with type, unit and meaning."""
    parts = []
    for table, its in (TABLES | BASIS | GAUGE_TABLES | CORRELATED | GRAPH | STUDY | CLAIMED).items():
        rows = [f"| `{c.name}` | {c.type} | {c.unit} | {c.meaning} |" for c in its]
        parts.append(
            "\n".join([f"### {table}.parquet", "", "| column | type | unit | meaning |", "|---|---|---|---|", *rows])
        )
    return "\n\n".join(parts)


def refusal_text(page: str) -> str:
    """Codes of all refusals by the place where they are met."""
    warnings, areas = warnings_told(page), dict.fromkeys(area for _, area in AREAS)
    listed: dict[str, set[str]] = {area: set() for area in areas}
    for code, modules in codes().items():
        for module in modules:
            area = next(area for room, area in AREAS if module.startswith((f"{room}/", f"{room}.py")) or not room)
            listed[area] |= {code} - warnings
    rows = [
        f"| {area} | {', '.join(f'`{code}`' for code in sorted(found))} |" for area, found in listed.items() if found
    ]
    return "\n".join(["| where | codes |", "|---|---|", *rows])


def with_collected(page: str) -> str:
    """Page with its collected parts as the program has them now."""
    collected = {
        "commands": command_text(),
        "keys": key_text(),
        "vehicle keys": vehicle_key_text(),
        "study keys": study_key_text(),
        "columns": column_text(),
        "codes": refusal_text(page),
    }
    for name, text in collected.items():
        begin, end = f"<!-- {name}: written by python -m tests.reference -->", f"<!-- end of {name} -->"
        before, rest = page.split(begin, 1)
        page = f"{before}{begin}\n\n{text}\n\n{end}{rest.split(end, 1)[1]}"
    return page


if __name__ == "__main__":
    PAGE.write_text(with_collected(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
