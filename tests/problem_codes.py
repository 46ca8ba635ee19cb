"""Codes of the problems that the package can tell, read from its source: as written, or from whoever hands them on."""

import ast
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

PACKAGE = Path(__file__).parents[1] / "fatigue"
REFUSED = {"unit"}  # although it comes from a function that is named for warnings
_WARNS = re.compile("warning|remark|doubt")


@cache
def codes() -> dict[str, set[str]]:
    """Codes with the modules that tell them, as paths inside the package."""
    found: dict[str, set[str]] = {}
    for module, tree in trees().items():
        for code in _told(tree):
            found.setdefault(code, set()).add(module)
    return found


def codes_of_warnings() -> set[str]:
    """Codes of problems that are made where warnings are: in a function named for them, or added to a list of them."""
    found: set[str] = set()
    for node in (node for tree in trees().values() for node in ast.walk(tree)):
        is_named = isinstance(node, ast.FunctionDef) and _WARNS.search(node.name)
        is_added = isinstance(node, ast.AugAssign | ast.Call) and _WARNS.search(_list_added_to(node))
        if is_named or is_added:
            found |= {code for call in problems(node) for code in constants(call.args[0])}
    return found - REFUSED


@cache
def trees() -> dict[str, ast.Module]:
    """Syntax of every module."""
    return {path.relative_to(PACKAGE).as_posix(): ast.parse(path.read_text()) for path in PACKAGE.rglob("*.py")}


@cache
def _calls() -> dict[str, list[ast.Call]]:
    """Calls of the whole package by the name of the function."""
    found: dict[str, list[ast.Call]] = {}
    for node in (node for tree in trees().values() for node in ast.walk(tree)):
        if isinstance(node, ast.Call):
            found.setdefault(_name(node.func), []).append(node)
    return found


def _told(tree: ast.Module) -> Iterator[str]:
    """Codes written into one module, or handed to a function of it that makes a problem of them."""
    for made in (node for node in tree.body if isinstance(node, ast.Assign)):  # once, for the whole module
        yield from (code for call in problems(made) for code in constants(call.args[0]))
    for holder in ast.walk(tree):
        if isinstance(holder, ast.ClassDef) and holder.name != "Problem":
            yield from _of_field("code", holder)
        if not isinstance(holder, ast.FunctionDef):
            continue
        for call in problems(holder):
            code = call.args[0]
            yield from constants(code)
            if isinstance(code, ast.Name):
                yield from _of_name(code.id, holder)
            if isinstance(code, ast.JoinedStr):
                yield from _composed(code)


def problems(node: ast.AST) -> Iterator[ast.Call]:
    """Problems that are made inside a node."""
    return (
        call for call in ast.walk(node) if isinstance(call, ast.Call) and call.args and _name(call.func) == "Problem"
    )


def _of_name(name: str, function: ast.FunctionDef) -> Iterator[str]:
    """Codes that a name stands for in a function: its parameter, or what a loop over a written table gives."""
    parameters = [p.arg for p in (*function.args.posonlyargs, *function.args.args) if p.arg != "self"]
    if name in parameters:
        yield from _handed(function.name, parameters.index(name), name)
        for default in function.args.defaults:
            yield from constants(default)
    for loop in (node for node in ast.walk(function) if isinstance(node, ast.For)):
        if isinstance(loop.target, ast.Tuple) and isinstance(loop.iter, ast.Tuple):
            names = [_name(target) for target in loop.target.elts]
            rows = [row for row in loop.iter.elts if isinstance(row, ast.Tuple)]
            if name in names:
                yield from (code for row in rows for code in constants(row.elts[names.index(name)]))


def _composed(code: ast.JoinedStr) -> Iterator[str]:
    """Codes that begin alike and end with a field of a record, as ``f"no_{extra.package}"``."""
    begin, value = (part.value for part in code.values)
    for holder in (node for tree in trees().values() for node in ast.walk(tree) if isinstance(node, ast.ClassDef)):
        yield from (f"{begin}{end}" for end in _of_field(_name(value), holder))


def _of_field(name: str, holder: ast.ClassDef) -> Iterator[str]:
    """Values of a field wherever a record of this class is made."""
    fields = [_name(field.target) for field in holder.body if isinstance(field, ast.AnnAssign)]
    if name in fields:
        yield from _handed(holder.name, fields.index(name), name)


def _handed(function: str, place: int, name: str) -> Iterator[str]:
    """Codes handed to the functions of a name, by position or by name, anywhere in the package."""
    for call in _calls().get(function, []):
        given = [k.value for k in call.keywords if k.arg == name] or call.args[place : place + 1]
        yield from (code for value in given for code in constants(value))


def constants(value: ast.expr) -> Iterator[str]:
    """Codes that an expression holds as they are."""
    if isinstance(value, ast.IfExp):
        yield from (*constants(value.body), *constants(value.orelse))
    if isinstance(value, ast.Constant) and isinstance(value.value, str) and re.fullmatch(r"[a-z0-9_]+", value.value):
        yield value.value


def _list_added_to(node: ast.AST) -> str:
    """Name of the list in ``list += ...`` or ``list.append(...)``; empty for anything else."""
    if isinstance(node, ast.AugAssign):
        return _name(node.target)
    is_addition = isinstance(node, ast.Call) and _name(node.func) in ("append", "extend")
    return _name(node.func.value) if is_addition and isinstance(node.func, ast.Attribute) else ""


def _name(node: ast.AST) -> str:
    """Last name of ``name`` or ``thing.name``; empty for anything else."""
    return str(getattr(node, "id", getattr(node, "attr", "")))
