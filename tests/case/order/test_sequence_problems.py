"""Mistakes in the order of events: each in one line, in the words of the case file."""

from pathlib import Path

import pytest

from fatigue.case import load_case
from fatigue.errors import CaseError
from tests.small_case import SmallCase, small_case


def problems(case: SmallCase, folder: Path) -> list[str]:
    """What is wrong with a case, without the name of its file."""
    with pytest.raises(CaseError) as error:
        load_case(case.write(folder))
    return [str(problem).removeprefix("case.toml: ") for problem in error.value.problems]


def loop(*names: str) -> str:
    """A loop over events of these names."""
    order = ", ".join(f'"{name}"' for name in names)
    return f"[[mission.sequence]]\norder = [{order}]\nper_1000_km = 1.0\n"


def test_order_is_read(tmp_path: Path) -> None:
    """Names may recur, and there may be several loops."""
    case = small_case()
    case.extra = loop("sine", "noise", "sine") + loop("noise")
    found = load_case(case.write(tmp_path)).mission.sequence
    assert [sequence.order for sequence in found] == [("sine", "noise", "sine"), ("noise",)]


def test_unknown_event_is_named_with_the_nearest_one(tmp_path: Path) -> None:
    """The place in the order, the name, and what to write."""
    case = small_case()
    case.extra = loop("sine", "nois") + loop("unheard of")
    first, second = problems(case, tmp_path)
    assert first == "mission.sequence[1].order[2]: there is no event 'nois'. Write 'noise'."
    assert second.startswith(
        "mission.sequence[2].order[1]: there is no event 'unheard of'. Add the event, or use one of"
    )


def test_name_in_parentheses_is_refused(tmp_path: Path) -> None:
    """It would be taken for a row of a sequence."""
    case = small_case()
    case.events[0]["name"] = "(sequence 1)"
    (problem,) = problems(case, tmp_path)
    assert problem.startswith("mission.event[1].name: the name '(sequence 1)' is in parentheses")
    assert problem.endswith("Write 'sequence 1'.")


def test_parentheses_inside_a_name_are_left_alone(tmp_path: Path) -> None:
    """Only a name that begins and ends with them is one of the tables."""
    case = small_case()
    case.events[0]["name"] = "sine (worn)"
    assert load_case(case.write(tmp_path)).mission.event[0].name == "sine (worn)"


def test_stints_beside_a_sequence_are_refused(tmp_path: Path) -> None:
    """An order is known or it is not."""
    case = small_case()
    case.extra = loop("sine", "noise")
    case.events[1]["stints_per_1000_km"] = 2.0
    (problem,) = problems(case, tmp_path)
    assert problem.startswith(
        "mission.event[2].stints_per_1000_km ('noise'): the key is for an order that is not known"
    )


@pytest.mark.parametrize(
    ("text", "what"),
    [
        ("[[mission.sequence]]\norder = []\nper_1000_km = 1.0\n", "is empty"),
        ('[[mission.sequence]]\norder = ["sine"]\n', "the key is missing"),
        ('[[mission.sequence]]\norder = "sine"\nper_1000_km = 1.0\n', "list"),
        ('[[mission.sequence]]\norder = ["sine"]\nper_1000_km = -1.0\n', "greater than or equal to 0"),
    ],
)
def test_keys_of_a_sequence_are_checked(text: str, what: str, tmp_path: Path) -> None:
    """Each with the place in the file."""
    case = small_case()
    case.extra = text
    (problem,) = problems(case, tmp_path)
    assert problem.startswith("mission.sequence[1]")
    assert what in problem
