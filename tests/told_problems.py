"""What every problem says and advises, read from where the package makes it: templates with ``…`` for each value."""

import ast
from collections.abc import Iterator, Sequence

from tests import problem_codes

VALUE = "…"
LONGEST = 240  # characters of a template


def told() -> dict[str, list[dict[str, str]]]:
    """Of every code the modules that tell it, with what each says and advises; empty where a value holds all."""
    modules = problem_codes.codes()
    found = {code: {(module, "", "") for module in its} for code, its in modules.items()}
    for module, tree in problem_codes.trees().items():
        for function, values, handed in _listed(tree, tree):
            for place, value in enumerate(values):
                known = {code for code in problem_codes.constants(value) if code in found}
                for code in {code for code in known if handed or module in modules[code]}:
                    texts = [_template(other, function) for other in values[place + 1 :]]
                    if any(texts):
                        found[code].add((module, texts[-2] if len(texts) > 1 else "", texts[-1]))
    rows: dict[str, list[dict[str, str]]] = {}
    for code, its in sorted(found.items()):
        spoken = {row[0] for row in its if row[1] or row[2]}
        kept = sorted(row for row in its if row[1] or row[2] or row[0] not in spoken)
        rows[code] = [dict(zip(("module", "what", "remedy"), row, strict=True)) for row in kept]
    return rows


def _listed(node: ast.AST, function: ast.AST) -> Iterator[tuple[ast.AST, Sequence[ast.expr], bool]]:
    """Arguments of calls and elements of tuples, the function they stand in, and whether a table reports them."""
    inner = node if isinstance(node, ast.FunctionDef) else function
    if isinstance(node, ast.Call):
        named = [k.value for k in node.keywords if k.arg in ("code", "what", "remedy")]
        yield inner, [*node.args, *named], getattr(node.func, "attr", "") == "report"
    if isinstance(node, ast.Tuple):
        yield inner, node.elts, False
    for child in ast.iter_child_nodes(node):
        yield from _listed(child, inner)


def _template(value: ast.expr, function: ast.AST) -> str:
    """Text of an expression; nothing where it is a single word or holds values only."""
    text = _text(value, function)
    return "" if sum(c.isalpha() for c in text) < 3 or (" " not in text.strip()) else text[:LONGEST]


def _text(value: ast.expr, function: ast.AST) -> str:
    """Text as it is written; a name stands for the first text that its function assigns to it."""
    match value:
        case ast.Constant(value=str() as text):
            return " ".join(text.split()) if len(text) > 1 else text
        case ast.JoinedStr(values=parts):
            return "".join(str(p.value) if isinstance(p, ast.Constant) else VALUE for p in parts)
        case ast.BinOp(left=left, right=right):
            return _text(left, function) + _text(right, function)
        case ast.IfExp(body=body, orelse=other):
            return max(_text(body, function), _text(other, function), key=len)
        case ast.Name(id=name):
            return next((text for text in _assigned(name, function) if text.strip(VALUE)), VALUE)
    return VALUE


def _assigned(name: str, function: ast.AST) -> Iterator[str]:
    """Texts that a function assigns to a name, alone or in a tuple."""
    for node in (node for node in ast.walk(function) if isinstance(node, ast.Assign)):
        for target in node.targets:
            both = isinstance(target, ast.Tuple) and isinstance(node.value, ast.Tuple)
            pairs = zip(target.elts, node.value.elts, strict=False) if both else ((target, node.value),)
            for to, value in pairs:
                if isinstance(to, ast.Name) and to.id == name and not isinstance(value, ast.Name):
                    yield _text(value, function)
