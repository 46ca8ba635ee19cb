"""What the program can say (commands, options, columns, codes), collected from the program, and its page of the docs.

``python -m tests.reference`` writes the collected parts of ``docs/reference.md`` again; what each warning means is
written there by hand.
"""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import click

from fatigue.cli import cli
from fatigue.results.columns import TABLES

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / "fatigue"
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
    ("life", "Signals, records and curves"),
    ("spectrum", "Signals, records and curves"),
    ("pipeline", "Assessment"),
    ("results", "Result folders and documents"),
    ("report", "Result folders and documents"),
    ("documents", "Result folders and documents"),
    ("verify", "Result folders and documents"),
    ("", "Commands and arguments"),
)
REFUSED = {"unit"}  # although it comes from a function that is named for warnings
_WARNS = re.compile("warning|remark|doubt")


def commands() -> dict[str, click.Command]:
    """Commands of the program by name, the program itself under the empty one."""
    return {"": cli, **cli.commands}


def options(command: click.Command) -> list[click.Option]:
    """Options of a command."""
    return [p for p in command.params if isinstance(p, click.Option)]


def columns() -> set[str]:
    """Columns of all result tables."""
    return {column.name for table in TABLES.values() for column in table}


def codes() -> dict[str, set[str]]:
    """Codes of all problems the package can tell, with the modules that tell them, as paths inside the package."""
    trees = {path.relative_to(PACKAGE).as_posix(): ast.parse(path.read_text()) for path in PACKAGE.rglob("*.py")}
    found: dict[str, set[str]] = {}
    for module, tree in trees.items():
        for code in _codes_told(tree, trees):
            found.setdefault(code, set()).add(module)
    return found


def _codes_told(tree: ast.Module, trees: dict[str, ast.Module]) -> Iterator[str]:
    """Codes written into one module, or handed to a function of it that makes a problem of them."""
    for holder in ast.walk(tree):
        if isinstance(holder, ast.ClassDef) and (place := _field_of_code(holder)) is not None:
            yield from _handed(holder.name, place, "code", trees)
        if not isinstance(holder, ast.FunctionDef):
            continue
        for call in _calls(holder, "Problem"):
            code = call.args[0]
            yield from _constants(code)
            if isinstance(code, ast.Name):
                yield from _of_name(code.id, holder, trees)


def _of_name(name: str, function: ast.FunctionDef, trees: dict[str, ast.Module]) -> Iterator[str]:
    """Codes that a name stands for in a function: its parameter, or what a loop over a written table gives."""
    parameters = [p.arg for p in (*function.args.posonlyargs, *function.args.args) if p.arg != "self"]
    if name in parameters:
        yield from _handed(function.name, parameters.index(name), name, trees)
        for default in function.args.defaults:
            yield from _constants(default)
    for loop in (node for node in ast.walk(function) if isinstance(node, ast.For)):
        if isinstance(loop.target, ast.Tuple) and isinstance(loop.iter, ast.Tuple):
            names = [getattr(target, "id", "") for target in loop.target.elts]
            rows = [row for row in loop.iter.elts if isinstance(row, ast.Tuple)]
            if name in names:
                yield from (code for row in rows for code in _constants(row.elts[names.index(name)]))


def _field_of_code(holder: ast.ClassDef) -> int | None:
    """Position of the field ``code`` of a record other than the problem itself."""
    fields = [f.target.id for f in holder.body if isinstance(f, ast.AnnAssign) and isinstance(f.target, ast.Name)]
    return fields.index("code") if "code" in fields and holder.name != "Problem" else None


def _handed(function: str, place: int, name: str, trees: dict[str, ast.Module]) -> Iterator[str]:
    """Codes handed to the function of a name, by position or by name, anywhere in the package."""
    for call in (call for tree in trees.values() for call in _calls(tree, function)):
        given = [k.value for k in call.keywords if k.arg == name] or call.args[place : place + 1]
        yield from (code for value in given for code in _constants(value))


def _calls(tree: ast.AST, function: str) -> Iterator[ast.Call]:
    """Calls of a function by its name."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and getattr(node.func, "id", getattr(node.func, "attr", "")) == function:
            yield node


def _constants(value: ast.expr) -> Iterator[str]:
    """Codes that an expression holds as they are."""
    if isinstance(value, ast.IfExp):
        yield from (*_constants(value.body), *_constants(value.orelse))
    if isinstance(value, ast.Constant) and isinstance(value.value, str) and re.fullmatch(r"[a-z0-9_]+", value.value):
        yield value.value


def codes_of_warnings() -> set[str]:
    """Codes of problems that are made where warnings are: in a function named for them, or added to a list of them."""
    found: set[str] = set()
    for path in PACKAGE.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            is_named = isinstance(node, ast.FunctionDef) and _WARNS.search(node.name)
            is_added = isinstance(node, ast.AugAssign | ast.Call) and _WARNS.search(_list_added_to(node))
            if is_named or is_added:
                found |= {code for call in _calls(node, "Problem") for code in _constants(call.args[0])}
    return found - REFUSED


def _list_added_to(node: ast.AST) -> str:
    """Name of the list in ``list += ...`` or ``list.append(...)``; empty for anything else."""
    target = node.target if isinstance(node, ast.AugAssign) else None
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr in ("append", "extend"):
        target = node.func.value
    return str(getattr(target, "id", getattr(target, "attr", "")))


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


def column_text() -> str:
    """Columns of every table with type, unit and meaning."""
    parts = []
    for table, its in TABLES.items():
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
    for name, text in (("commands", command_text()), ("columns", column_text()), ("codes", refusal_text(page))):
        begin, end = f"<!-- {name}: written by python -m tests.reference -->", f"<!-- end of {name} -->"
        before, rest = page.split(begin, 1)
        page = f"{before}{begin}\n\n{text}\n\n{end}{rest.split(end, 1)[1]}"
    return page


if __name__ == "__main__":
    PAGE.write_text(with_collected(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
