"""Cases whose stress vanishes to rounding, whole or in part: nothing of it is a number that two programs share."""

from collections.abc import Callable

import numpy as np
import pandas as pd

from tests.small_case import SmallCase, small_case

FORCES = ["fx_N", "fy_N", "fz_N", "mx_Nmm", "my_Nmm", "mz_Nmm"]


def case(*changes: Callable[[SmallCase], None], seconds: float = 1.6, stations: int = 2) -> SmallCase:
    """The small case with two of its events, short, at few stations of each weld, and changed."""
    made = small_case(seconds=seconds)
    made.nodal_forces = made.nodal_forces[made.nodal_forces["node"] % 100 < stations]
    made.weld_nodes = made.weld_nodes[made.weld_nodes["order"] <= stations]
    for change in changes:
        change(made)
    return made


def _of_record(change: Callable[[pd.DataFrame], None], *names: str) -> Callable[[SmallCase], None]:
    def of_case(made: SmallCase) -> None:
        for name in names or made.histories:
            change(made.histories[name])

    return of_case


def _constant(record: pd.DataFrame) -> None:
    for i, name in enumerate(record.columns[1:]):
        record[name] = 0.1 + 7.3 * i


def _still(record: pd.DataFrame) -> None:
    record[record.columns[1:]] = 0.0


def _static(size: float) -> Callable[[pd.DataFrame], None]:
    def change(record: pd.DataFrame) -> None:
        for i, name in enumerate(record.columns[1:]):
            record[name] = record[name] + size * (1.0 + 0.1 * i)

    return change


def _cancelling_faces(made: SmallCase) -> None:
    """Membrane equals bending in every mode: the bottom face has no stress."""
    t = made.weld_nodes["thickness_mm"].iloc[0]
    made.nodal_forces[["fx_N", "fz_N", "my_Nmm", "mz_Nmm"]] = 0.0
    made.nodal_forces["mx_Nmm"] = -made.nodal_forces["fy_N"] * t / 6.0


def _cancelling_modes(made: SmallCase) -> None:
    """Modes 1 and 2 have the same forces and opposite coordinates; the third is at rest."""
    forces = made.nodal_forces.set_index(["weld", "node", "mode"]).sort_index()
    first = forces.xs(1, level="mode", drop_level=False).to_numpy()
    forces.loc[forces.index.get_level_values("mode") == 2, :] = first / 3.0
    made.nodal_forces = forces.reset_index()
    for record in made.histories.values():
        record["q_2"], record["q_7"] = -3.0 * record["q_1"], 0.0


def _no_forces(made: SmallCase) -> None:
    made.nodal_forces[FORCES] = 0.0


def _no_forces_of_a_weld(made: SmallCase) -> None:
    made.nodal_forces.loc[made.nodal_forces["weld"] == "B", FORCES] = 0.0


def _bending_only(made: SmallCase) -> None:
    made.nodal_forces[["fx_N", "fy_N", "fz_N"]] = 0.0


def _faint(record: pd.DataFrame) -> None:
    record[record.columns[1:]] *= 1e-60


def _single_precision(record: pd.DataFrame) -> None:
    record[record.columns[1:]] = record[record.columns[1:]].astype(np.float32)


def _two_samples(made: SmallCase) -> None:
    made.histories["sine"] = made.histories["sine"].iloc[[0, 7]].reset_index(drop=True)
    made.histories["noise"] = made.histories["noise"].iloc[:2].reset_index(drop=True)
    made.events[1].pop("start_s")


def _multiaxial(text: str) -> Callable[[SmallCase], None]:
    def change(made: SmallCase) -> None:
        made.extra = f"[multiaxial]\n{text}\n"

    return change


def _cancelling_faces_in_shear(made: SmallCase) -> None:
    """The bottom face has no stress normal to the weld, and shear."""
    along = made.nodal_forces["fx_N"].copy()
    _cancelling_faces(made)
    made.nodal_forces["fx_N"] = along


def _set(table: str, **values: object) -> Callable[[SmallCase], None]:
    def change(made: SmallCase) -> None:
        setattr(made, table, {**getattr(made, table), **values})

    return change


_UP, _AUTO, _HALF = _set("counting", upsample=4), _set("counting", upsample="auto"), _set("counting", residue="half")
_BENT = _set("curve", name="master-steel", extension="haibach", mean_stress="asme", yield_MPa=200.0)
_MLP, _ASME = _multiaxial('method = "mlp"\nalpha = 1.0'), _multiaxial('method = "asme"')
_CUT = _set("curve", name="master-steel", extension="cutoff")

CASES: dict[str, SmallCase] = {
    "ordinary": case(),
    "constant record": case(_of_record(_constant)),
    "one constant record": case(_of_record(_constant, "noise")),
    "constant, upsampled": case(_of_record(_constant), _UP),
    "constant, auto upsampled": case(_of_record(_constant, "sine"), _AUTO),
    "constant, half": case(_of_record(_constant), _HALF),
    "constant, curve bends, mean stress": case(_of_record(_constant), _BENT),
    "cancelling faces": case(_cancelling_faces),
    "cancelling faces, curve bends": case(_cancelling_faces, _BENT),
    "cancelling faces, cut-off": case(_cancelling_faces, _CUT),
    "cancelling faces, upsampled": case(_cancelling_faces, _UP),
    "cancelling faces, auto upsampled": case(_cancelling_faces, _AUTO),
    "cancelling faces in shear": case(_cancelling_faces_in_shear),
    "cancelling faces in shear, curve bends": case(_cancelling_faces_in_shear, _BENT, _MLP),
    "cancelling faces in shear, by the ASME factor": case(_cancelling_faces_in_shear, _ASME),
    "cancelling modes": case(_cancelling_modes),
    "cancelling modes, upsampled half": case(_cancelling_modes, _UP, _HALF),
    "static 1e3": case(_of_record(_static(1e3))),
    "static 1e3, by path moment": case(_of_record(_static(1e3)), _MLP),
    "static 1e6": case(_of_record(_static(1e6))),
    "static 1e9": case(_of_record(_static(1e9))),
    "static 1e12": case(_of_record(_static(1e12))),
    "static 1e12, curve bends": case(_of_record(_static(1e12)), _BENT),
    "static 1e12, upsampled": case(_of_record(_static(1e12)), _UP),
    "static 1e12, by path moment": case(_of_record(_static(1e12)), _MLP),
    "static 1e15": case(_of_record(_static(1e15))),
    "static 1e12 of one event": case(_of_record(_static(1e12), "sine")),
    "single precision, static 1e6": case(_of_record(_static(1e6)), _of_record(_single_precision)),
    "zero modes": case(_of_record(_still)),
    "zero modes, upsampled": case(_of_record(_still), _UP),
    "zero modes of one event": case(_of_record(_still, "noise")),
    "no forces": case(_no_forces),
    "no forces of a weld": case(_no_forces_of_a_weld),
    "bending only": case(_bending_only),
    "faint": case(_of_record(_faint)),
    "two samples": case(_two_samples),
    "two samples, constant": case(_two_samples, _of_record(_constant)),
    "two samples, upsampled": case(_two_samples, _UP),
    "two samples, auto": case(_two_samples, _AUTO),
}
# an ordinary stress about a static part as of the dead load, of which every column has something to tell
ABOUT_DEAD_LOAD = case(_of_record(_static(1e3)), _MLP, seconds=2.4, stations=3)
