"""Cases whose histories are looked at: plain, upsampled, at vertices, with unit loads, in two parts, in a loop."""

from pathlib import Path

import numpy as np
import pandas as pd

from fatigue.assess import assess
from tests.small_case import STEP, SmallCase, small_case
from tests.test_assess import element_form, write_element_form
from tests.test_sequences import LOOP, empty_and_laden
from tests.unit_load_case import as_unit_load, write_with_loads


def result_of(path: Path, folder: Path) -> Path:
    """Assess a case and return its result folder."""
    assess(path, folder, threads=1, report=False)
    return folder


def plain(seconds: float = 6.0, **counting: object) -> SmallCase:
    """The small case, short, its random event with a factor on all stresses."""
    case = small_case(seconds)
    case.counting = {"upsample": 1} | counting
    case.events[1]["stress_factor"] = 1.3
    return case


def loaded(folder: Path, **counting: object) -> Path:
    """Mode 7 as a unit load: over time in one event, constant in another, by values in a static load case."""
    case = plain(**counting)
    case.counting["mean_of_q"] = "remove"
    forces = as_unit_load(case, 7, "push")
    case.histories["noise"] = case.histories["noise"].drop(columns="u_push")
    case.histories["load"] = case.histories["load"].drop(columns="u_push")
    path = write_with_loads(case, folder, forces)
    text = path.read_text()
    for event, given in (("noise", "constant = 5.0"), ("load and unload", "constant = -2.0")):
        table = f'[[mission.event.unit_load]]\nname = "push"\nunit = "kN"\n{given}\n'
        text = _behind(text, event, table)
    text += '[[mission.event]]\nname = "stand"\nper_1000_km = 3.0\n'
    text += '[[mission.event.unit_load]]\nname = "push"\nunit = "kN"\nvalues = [0.0, 40.0, -25.0, 0.0]\n'
    path.write_text(text)
    return path


def finer(folder: Path, **counting: object) -> Path:
    """Mode 7 as a unit load with a file of its own in the random event, four times as fine as the record."""
    case = plain(2.0, **counting)
    forces = as_unit_load(case, 7, "push")
    case.histories["noise"] = case.histories["noise"].drop(columns="u_push")
    path = write_with_loads(case, folder, forces)
    t = np.arange(4 * 400 + 1) * STEP / 4
    pd.DataFrame({"time_s": t, "u_push": 20.0 * np.sin(2 * np.pi * 17.0 * t)}).to_csv(folder / "push.csv", index=False)
    given = '[[mission.event.unit_load]]\nname = "push"\nunit = "kN"\nhistory = "push.csv"\n'
    path.write_text(_behind(path.read_text(), "noise", given))
    return path


def _behind(text: str, event: str, table: str) -> str:
    """Text of a case with a table behind that of an event."""
    head, tail = text.split(f'name = "{event}"')
    of_event, found, rest = tail.partition("[[mission.event]]")
    return f'{head}name = "{event}"{of_event}{table}{found}{rest}'


def cornered(folder: Path) -> Path:
    """Weld A bent by a right angle at its fourth node, in element forces: two parts that share the order 4."""
    case = plain()
    of_a = case.weld_nodes.index[case.weld_nodes["weld"] == "A"]
    case.weld_nodes = case.weld_nodes.astype({"y_mm": float, "outward_x": float})
    for i, row in enumerate(of_a):
        if i > 3:
            case.weld_nodes.loc[row, ["x_mm", "y_mm"]] = [30.0, 10.0 * (i - 3)]
        case.weld_nodes.loc[row, "outward_x"] = -1.0 if i >= 3 else 0.0
        case.weld_nodes.loc[row, "outward_y"] = 1.0 if i <= 3 else 0.0
    return write_element_form(case, folder, *element_form(case))


def in_a_loop(folder: Path) -> Path:
    """Four events, and two sequences of them."""
    case = empty_and_laden()
    case.histories = {name: table[table["time_s"] < 4.0] for name, table in case.histories.items()}
    case.extra = LOOP + LOOP.replace('"load", "laden", "unload"', '"laden"').replace("1.5", "0.5")
    return case.write(folder)


SEQUENCES = ["(sequence 1)", "(sequence 2)"]


def largest_ranges(folder: Path, station: tuple[str, int, int]) -> pd.DataFrame:
    """Largest range of each event (row) at the top and the bottom face (column) of a station, as assessed [MPa]."""
    damage = pd.read_parquet(folder / "damage.parquet")
    weld, part, order = station
    here = damage[(damage["weld"] == weld) & (damage["part"] == part) & (damage["order"] == order)]
    return here.pivot_table(index="event", columns="surface", values="max_range_MPa")


def ranges_of(history: pd.DataFrame) -> pd.DataFrame:
    """The same of a history."""
    prefix = "counted" if "counted_top_MPa" in history else "structural"
    by_event = history.groupby("event")
    return pd.DataFrame({face: by_event[f"{prefix}_{face}_MPa"].agg(np.ptp) for face in ("top", "bottom")})


CASES = {
    "plain": lambda folder: plain().write(folder),
    "upsampled": lambda folder: plain(upsample=4).write(folder, "parquet"),
    "half": lambda folder: plain(residue="half", upsample=2).write(folder),
    "vertex": lambda folder: plain(reversals="vertex").write(folder),
    "vertex, half, upsampled": lambda folder: plain(reversals="vertex", residue="half", upsample=2).write(folder),
    "unit loads": loaded,
    "unit loads at vertices": lambda folder: loaded(folder, reversals="vertex", upsample=2),
    "finer load": finer,
    "corner": cornered,
    "loop": in_a_loop,
}
