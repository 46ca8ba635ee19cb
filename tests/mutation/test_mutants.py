"""Mutants of small sources: each kind of mistake is made, once, and what is no program is left alone."""

import ast
from pathlib import Path

import pytest

from tests.mutation.__main__ import equivalents, every_mutant, score
from tests.mutation.mutants import defaults_of, mutants
from tests.mutation.tree import ROOT, stages


def after(source, defaults=None):
    """What the lines of a source become."""
    return [m.after for m in mutants(source, "m.py", defaults or {})]


@pytest.mark.parametrize(
    ("source", "expected"),
    [
        ("y = a + b", ["y = (a - b)"]),
        ("y = a**k", ["y = (a * k)"]),
        ("y = a < b", ["y = (a <= b)", "y = (a > b)"]),
        ("y = a is None and b", ["y = (a is None or b)", "y = (a is not None) and b"]),
        ("y = 2", ["y = 3", "y = 1"]),
        ("y = 0", ["y = 1"]),
        ("y = 2.5", ["y = 2.75"]),
        ("y = 1e-9", ["y = 1e-05"]),
        ("y = True", ["y = False"]),
        ("y = -a", ["y = (a)"]),
        ("y = not a", ["y = (a)"]),
        ("y += a", ["y -= a", "pass"]),
        ("x.sort()", ["pass"]),
        ("y = np.maximum(a, b)", ["y = np.minimum(a, b)"]),
        ("y = abs(a)", ["y = (a)"]),
        ("y = a.sum(axis=1)", ["y = a.sum()", "y = a.sum(axis=0)"]),
        ("y = x[i]", ["y = (x[i - 1])"]),
        ("y = x[a:b]", ["y = x[a + 1:b]", "y = x[a:b + 1]"]),
        ("def f(a):\n    a = g(a)\n    return a", ["pass"]),
        ("def f(a):\n    b = g(a)\n    return b", []),
        ("for i in j:\n    continue", ["pass"]),
    ],
)
def test_kinds_of_mistakes(source, expected):
    """One changed line for each, in the order of the source."""
    assert after(source) == expected


def test_arguments_go_where_they_have_a_default():
    """A keyword without a default would be missed at once; of functions of others every keyword may go."""
    (defaults,) = (defaults_of([Path(__file__)]),)
    assert defaults["after"] == {"defaults"}
    assert after("after(source=a, defaults=b)", defaults) == ["pass", "after(source=a)"]
    assert after("y = other(a=b)", defaults) == ["y = other()"]
    assert after("y = zip(a, b, strict=True)") == []


def test_texts_types_and_docstrings_are_left_alone():
    """Nobody mistakes them for numbers."""
    source = '''"""Text."""
from numpy import pi
Floats = NDArray[np.float64]
@dataclass(frozen=True)
class A:
    """Text."""
    x: tuple[int, 3]
def f(a: Literal[1]) -> NDArray[2]:
    """Text."""
    return f"{a:.3f} of {2}" + "b"
'''
    assert after(source) == []


def test_a_mutant_of_two_lines_in_brackets():
    """Columns count bytes, lines are joined in what is told, and the rest of the file stays."""
    source = "a = 'é' if x else (\n    b *\n    c\n)\nd = e\n"
    (mutant,) = mutants(source, "m.py", {})
    assert mutant.text == "a = 'é' if x else (\n    (b / c)\n)\nd = e\n"
    assert (mutant.before, mutant.after, mutant.line) == ("b * c", "(b / c)", 2)


def test_mutants_of_a_room_are_programs():
    """All that is tried can be read by Python, and differs from the source and from every other."""
    found = every_mutant("case")
    assert len({m.text for m in found}) == len(found) > 200
    for mutant in found[::10]:
        assert ast.dump(ast.parse(mutant.text)) != ast.dump(ast.parse((ROOT / mutant.module).read_text()))


def test_equivalents_have_a_reason():
    """Each names a module of a room, what stands there and, but for all mutants of a line, what may stand there."""
    for (module, _, before, changed), reason in equivalents().items():
        assert (ROOT / module).parts[-1].endswith(".py")
        assert before != changed
        assert len(reason) > 10


def test_tests_of_a_module_come_first():
    """Its own, though the folder of tests may be one above; then those that reach it, nearest first."""
    module = "fatigue/life/counting/single/kernels/power.py"
    own, others = stages(ROOT, module, ["tests/life/test_rule.py", "tests/life/counting/single/test_doubt.py"])
    assert own == ["tests/life/counting/single/test_power.py"]
    assert others == ["tests/life/counting/single/test_doubt.py", "tests/life/test_rule.py"]
    assert len(stages(ROOT, module, None)[1]) > 10


def test_score():
    """Wilson's bounds, as tabulated: 45 of 50 are 90 %, 78.6 to 95.7 %."""
    assert score("weld", 45, 50) == "weld: 45 of 50 killed, 90.0% (78.6% to 95.7%)"
