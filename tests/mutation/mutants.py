"""Small mistakes in a source file: an operator, a constant, a sign, a bound, a statement or an argument changed."""

import ast
import re
from collections.abc import Iterator, Mapping
from copy import deepcopy
from dataclasses import dataclass
from pathlib import Path

OPERATORS: dict[type, type] = {
    ast.Add: ast.Sub,
    ast.Sub: ast.Add,
    ast.Mult: ast.Div,
    ast.Div: ast.Mult,
    ast.FloorDiv: ast.Mult,
    ast.Mod: ast.FloorDiv,
    ast.Pow: ast.Mult,
    ast.BitOr: ast.BitAnd,
    ast.BitAnd: ast.BitOr,
    ast.BitXor: ast.BitOr,
    ast.LShift: ast.RShift,
    ast.RShift: ast.LShift,
    ast.And: ast.Or,
    ast.Or: ast.And,
}
COMPARISONS: dict[type, tuple[type, ...]] = {
    ast.Lt: (ast.LtE, ast.Gt),
    ast.LtE: (ast.Lt, ast.GtE),
    ast.Gt: (ast.GtE, ast.Lt),
    ast.GtE: (ast.Gt, ast.LtE),
    ast.Eq: (ast.NotEq,),
    ast.NotEq: (ast.Eq,),
    ast.In: (ast.NotIn,),
    ast.NotIn: (ast.In,),
    ast.Is: (ast.IsNot,),
    ast.IsNot: (ast.Is,),
}
TWINS = (
    *(("min", "max"), ("minimum", "maximum"), ("argmin", "argmax"), ("nanmin", "nanmax"), ("fmin", "fmax")),
    *(("any", "all"), ("floor", "ceil"), ("sin", "cos"), ("zeros", "ones"), ("startswith", "endswith")),
)
SWAPPED = {a: b for pair in TWINS for a, b in (pair, pair[::-1])}
TOLERANCE = 1e-4  # numbers below are limits of rounding, of which only the power of ten means something
SPARED = (ast.Import, ast.ImportFrom, ast.JoinedStr)  # no mistakes in these; text is not a number
Defaults = Mapping[str, frozenset[str]]
"""The parameters that may be left out, by the name of the function or class."""


@dataclass(frozen=True, slots=True)
class Mutant:
    """One mistake: ``before`` and ``after`` are the changed lines without indentation, ``text`` the whole new file."""

    module: str
    function: str
    line: int
    before: str
    after: str
    text: str

    @property
    def key(self) -> tuple[str, str, str, str]:
        """What tells it from all others, wherever its function moves in the file."""
        return self.module, self.function, self.before, self.after


def mutants(source: str, module: str, defaults: Defaults) -> list[Mutant]:
    """Every mutant of a source file, in its order; each once."""
    found: dict[str, Mutant] = {}
    tree = ast.parse(source)
    lines = source.splitlines(keepends=True)
    for function, node, wanted in _changes(tree, "", defaults):
        text = _with(lines, node, wanted)
        if text != source and text not in found:
            before, after = _changed_lines(lines, text.splitlines(keepends=True))
            found[text] = Mutant(module, function, node.lineno, before, after, text)
    return list(found.values())


def defaults_of(files: list[Path]) -> Defaults:
    """The parameters of every function, and the fields of every class, that have a default."""
    kept: dict[str, frozenset[str]] = {}
    for path in files:
        for node in ast.walk(ast.parse(path.read_text())):
            names: set[str] | None = None
            if isinstance(node, ast.FunctionDef):
                plain = [*node.args.posonlyargs, *node.args.args]
                names = {a.arg for a in plain[len(plain) - len(node.args.defaults) :]}
                names |= {a.arg for a, d in zip(node.args.kwonlyargs, node.args.kw_defaults, strict=True) if d}
            elif isinstance(node, ast.ClassDef):
                fields = [f for f in node.body if isinstance(f, ast.AnnAssign) and f.value is not None]
                names = {f.target.id for f in fields if isinstance(f.target, ast.Name)}
            if names is not None:
                kept[node.name] = kept.get(node.name, frozenset(names)) & names
    return kept


def _changes(node: ast.AST, function: str, defaults: Defaults) -> Iterator[tuple[str, ast.AST, str]]:
    """Give function, node and the text to put in its place, without annotations, decorators and docstrings."""
    if isinstance(node, ast.FunctionDef | ast.ClassDef):
        function = f"{function}.{node.name}".lstrip(".")
    if isinstance(node, ast.expr | ast.stmt):
        for wanted in _mistakes(node, defaults):
            yield function, node, wanted
    known: set[str] = set()  # names that have a value before the statement
    if isinstance(node, ast.FunctionDef):
        known = {a.arg for a in ast.walk(node.args) if isinstance(a, ast.arg)}
    for name, value in ast.iter_fields(node):
        if name in ("annotation", "returns", "decorator_list", "type_params"):
            continue
        for child in value if isinstance(value, list) else [value]:
            if isinstance(child, ast.keyword) and child.arg in ("strict", "axis"):
                continue  # a guard of ``zip`` that sound programs never need; an axis is turned with its call
            if not isinstance(child, ast.AST) or isinstance(child, SPARED) or _is_type(child):
                continue
            if isinstance(child, ast.Assign) and _assigned(child) <= known:
                yield function, child, "pass"
            known |= _assigned(child) if isinstance(child, ast.Assign) else set()
            yield from _changes(child, function, defaults)


def _assigned(node: ast.Assign) -> set[str]:
    """Names an assignment gives a value to; an element or a field of one had a value before."""
    return {n.id for t in node.targets for n in ast.walk(t) if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Store)}


def _is_type(node: ast.AST) -> bool:
    """Whether a statement only names a type, as ``Numbers = NDArray[np.floating]`` does."""
    value = node.value if isinstance(node, ast.Assign) else None
    alias = isinstance(value, ast.Subscript) and ast.unparse(value.value) in ("NDArray", "tuple", "dict", "Callable")
    return alias or (isinstance(node, ast.Call) and ast.unparse(node.func) in ("cast", "TypeVar"))


def _mistakes(node: ast.expr | ast.stmt, defaults: Defaults) -> Iterator[str]:  # noqa: PLR0912 - one branch a kind
    """Give what may be written in place of a node by mistake."""
    if isinstance(node, ast.BinOp | ast.AugAssign | ast.BoolOp):
        if type(node.op) in OPERATORS and not _has_text(node):
            yield _put(node, op=OPERATORS[type(node.op)]())
    elif isinstance(node, ast.Compare):
        for at, comparison in enumerate(node.ops):
            for other in COMPARISONS[type(comparison)]:
                yield _put(node, ops=[*node.ops[:at], other(), *node.ops[at + 1 :]])
    elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub | ast.Not | ast.Invert):
        yield f"({ast.unparse(node.operand)})"
    elif isinstance(node, ast.Constant):
        yield from _constants(node.value)
    elif isinstance(node, ast.Subscript) and isinstance(node.slice, ast.Name) and len(node.slice.id) == 1:
        yield _put(node, slice=ast.BinOp(node.slice, ast.Sub(), ast.Constant(1)))
    elif isinstance(node, ast.Slice) and isinstance(node.lower or node.upper, ast.expr):
        for bound in ("lower", "upper"):
            if (value := getattr(node, bound)) and not isinstance(value, ast.Constant | ast.UnaryOp):
                yield _put(node, **{bound: ast.BinOp(value, ast.Add(), ast.Constant(1))})[1:-1]
    elif isinstance(node, ast.Call):
        yield from _calls(node, defaults)
    if _may_go(node):
        yield "pass"


def _may_go(node: ast.AST) -> bool:
    """Whether a statement can be left out without a name without value."""
    told = isinstance(node, ast.Expr) and not isinstance(node.value, ast.Constant | ast.Yield | ast.YieldFrom)
    return told or isinstance(node, ast.AugAssign | ast.Raise | ast.Continue | ast.Break)


def _constants(value: object) -> Iterator[str]:
    if isinstance(value, bool):
        yield str(not value)
    elif isinstance(value, int):
        yield str(value + 1)
        if value > 0:
            yield str(value - 1)
    elif isinstance(value, float):
        factor = 1.1 if value >= TOLERANCE else 1e4
        yield repr(float(f"{factor * value:.12g}") if value else 1.0)


def _calls(node: ast.Call, defaults: Defaults) -> Iterator[str]:
    """Give the twin of a function, its argument alone, or the call without one of its keywords."""
    name = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
    if name in SWAPPED:
        other = deepcopy(node.func)
        setattr(other, "attr" if isinstance(other, ast.Attribute) else "id", SWAPPED[name])
        yield _put(node, func=other)[1:-1]
    if name in ("abs", "sorted") and len(node.args) == 1:
        yield f"{'list' if name == 'sorted' else ''}({ast.unparse(node.args[0])})"
    for at, keyword in enumerate(node.keywords):
        if keyword.arg not in (None, "strict") and (name not in defaults or keyword.arg in defaults[name]):
            yield _put(node, keywords=[*node.keywords[:at], *node.keywords[at + 1 :]])[1:-1]
        axis = ast.unparse(keyword.value) if keyword.arg == "axis" else ""
        if axis in ("0", "1", "-1"):
            turned = ast.keyword("axis", ast.Constant(1 if axis == "0" else 0))
            yield _put(node, keywords=[*node.keywords[:at], turned, *node.keywords[at + 1 :]])[1:-1]


def _has_text(node: ast.AST) -> bool:
    """Whether an operator stands beside a text, where another one would be refused at once."""
    sides = [getattr(node, name, None) for name in ("left", "right", "value")]
    return any(isinstance(s, ast.JoinedStr) or isinstance(getattr(s, "value", None), str) for s in sides)


def _put(node: ast.AST, **changed: object) -> str:
    """Write a node anew with some fields changed, an expression in brackets."""
    other = deepcopy(node)
    for name, value in changed.items():
        setattr(other, name, value)
    text = ast.unparse(ast.fix_missing_locations(other))
    return text if isinstance(node, ast.stmt) else f"({text})"


def _with(lines: list[str], node: ast.AST, wanted: str) -> str:
    """Give the text of the file with ``wanted`` in place of a node; columns of the parser are bytes."""
    first, last = lines[node.lineno - 1].encode(), lines[node.end_lineno - 1].encode()
    changed = first[: node.col_offset] + wanted.encode() + last[node.end_col_offset :]
    return "".join([*lines[: node.lineno - 1], changed.decode(), *lines[node.end_lineno :]])


def _changed_lines(old: list[str], new: list[str]) -> tuple[str, str]:
    """Give the lines that differ, from the first to the last, with single spaces."""
    start = next((i for i, (a, b) in enumerate(zip(old, new, strict=False)) if a != b), min(len(old), len(new)))
    tail = next(i for i, (a, b) in enumerate(zip(old[::-1], new[::-1], strict=False)) if a != b)
    tail = min(tail, len(old) - start, len(new) - start)
    sides = ("".join(old[start : len(old) - tail]), "".join(new[start : len(new) - tail]))
    before, after = (re.sub(r"\s+", " ", side).strip() for side in sides)
    return before, after
