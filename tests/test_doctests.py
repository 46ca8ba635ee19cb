"""Examples in docstrings run, those of compiled functions too, and give what they say."""

import ast
import doctest
from importlib import import_module
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[1] / "fatigue"


def examples():
    """Docstrings with examples: module, name and text of each. Only their modules are imported, when they run."""
    for path in sorted(PACKAGE.rglob("*.py")):
        if ">>>" not in (text := path.read_text(encoding="utf-8")):
            continue
        module = ".".join((PACKAGE.name, *path.relative_to(PACKAGE).with_suffix("").parts)).removesuffix(".__init__")
        for node in ast.walk(ast.parse(text)):
            if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef):
                words = ast.get_docstring(node) or ""
                if ">>>" in words:
                    name = getattr(node, "name", "")
                    yield pytest.param(module, words, id=f"{module.removeprefix('fatigue.')}.{name}".rstrip("."))


@pytest.mark.parametrize(("module", "text"), list(examples()))
def test_example_gives_what_it_says(module, text):
    """Every line after ``>>>`` prints what stands below it."""
    names = dict(vars(import_module(module)))
    example = doctest.DocTestParser().get_doctest(text, names, module, None, None)
    lines = []
    failed, _ = doctest.DocTestRunner(optionflags=doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE).run(
        example, out=lines.append
    )
    assert not failed, "".join(lines)
