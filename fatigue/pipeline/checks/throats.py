"""Throats of fillet welds: stress across, along and at the root of the section, counted over the mission.

All of them are linear in the modal coordinates. The resultant of the stresses across the weld is not: its history would
have half the range of a force that changes its sign, and none under a force that turns. So the stress

    s(psi) = sigma_perp cos psi + tau_perp sin psi

is counted in directions psi, and the one with the largest damage of the whole mission decides; or, where the table asks
for it, both stresses are counted as a path in their plane.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fatigue.life.mission import Plan
from fatigue.pipeline.checks.linear.counted import ALL, counted_columns, counted_each
from fatigue.pipeline.checks.linear.directions import half_circle, worst_directions
from fatigue.pipeline.checks.linear.paths import counted_paths
from fatigue.pipeline.checks.linear.signals import Signals, counted_mission
from fatigue.pipeline.checks.rows import CheckRows, check_rows, joined
from fatigue.pipeline.mission.event_load import EventLoad
from fatigue.pipeline.solve.model import Model
from fatigue.pipeline.solve.rated.rated_curves import RatedCurve
from fatigue.pipeline.solve.stations import Stations
from fatigue.readers.neutral.body.throats import WeldThroat
from fatigue.weld.structural_stress import StructuralStress
from fatigue.weld.throat import Side, ThroatStress, line_force, throat_stress, weld_forces

Columns = Mapping[str, Any]

AT_SUMMED_CORNER = "forces of both legs of a corner in one sum, so no bound"
STEP_DEG = 5.0  # between directions: the range in the worst one is at most 0.1 % low


@dataclass(frozen=True, slots=True, eq=False)
class _Fillets:
    """The welds at one plate that ends: where its stations are, and the stress in each throat (n, c)."""

    throat: WeldThroat
    rows: slice
    stress: Mapping[Side, ThroatStress]

    def size(self, rated: RatedCurve) -> NDArray[np.float64]:
        """Factor (n,) of the throat, which is the thickness of its section, on the range."""
        return rated.size(np.full(self.rows.stop - self.rows.start, self.throat.throat))

    @property
    def names(self) -> str:
        """Whose stresses they are, in messages."""
        return f"throats of weld {self.throat.weld}"


def throat_checks(model: Model, loads: Sequence[EventLoad], plan: Plan) -> CheckRows:
    """Rows of ``throat_perp``, ``throat_par`` and ``throat_root`` of a group of welds, those that have throats.

    Raises
    ------
    NumericalError : stress or damage exceeds double precision
    """
    fillets = list(_fillets(model))
    checks = (_across, _along, _at_root)
    return joined([rows for check in checks for one in fillets for rows in check(one, model, loads, plan)])


def _fillets(model: Model) -> Iterator[_Fillets]:
    stations, first = model.stations, model.stations.first
    for number, weld in enumerate(model.welds):
        throat = model.body.throats.get(weld.name)
        if throat is not None:
            rows = slice(int(first[number]), int(first[number + 1]))
            yield _Fillets(throat, rows, throat_stresses(throat, stations, rows))


def throat_stresses(throat: WeldThroat, stations: Stations, rows: slice) -> dict[Side, ThroatStress]:
    """Stress per unit coordinate in the throat on each side of some stations, whose ends are treated as at the toe."""
    thickness, treated = stations.thickness[rows], stations.treated
    names = StructuralStress.__dataclass_fields__
    line = line_force(StructuralStress(*(getattr(treated, name)[rows] for name in names)), thickness)
    section = throat.section(thickness)
    forces = weld_forces(line, section, throat.sides, thickness, throat.lever)
    return {side: throat_stress(force, section, side) for side, force in forces.items()}


def _across(fillets: _Fillets, model: Model, loads: Sequence[EventLoad], plan: Plan) -> Iterator[CheckRows]:
    """Normal and shear stress across the weld, in the direction of the largest damage or as a path."""
    rated = model.body.curves[fillets.throat.curve]
    size, names, plan = fillets.size(rated), fillets.names, rated.plan(plan)
    if fillets.throat.combination == "path":
        for side, stress in fillets.stress.items():
            of_path = counted_paths(_parts(stress), size, rated.rule, loads, plan, names)
            yield _rows(
                "throat_perp", fillets, side, rated, model, of_path | {"component": "path of sigma_perp, tau_perp"}
            )
        return
    psi = half_circle(STEP_DEG)
    sums = np.stack([np.cos(np.radians(psi)), np.sin(np.radians(psi))], axis=1)
    worst: list[NDArray[np.intp]] = []
    stresses: list[NDArray[np.float64]] = []
    for stress in fillets.stress.values():
        parts = _parts(stress)
        worst.append(worst_directions(parts, sums, size, rated.rule, loads, plan, names))
        stresses.append(np.einsum("np,npc->nc", sums[worst[-1]], parts))
    found = counted_each(stresses, size, rated.rule, loads, plan, names)
    for side, direction, columns in zip(fillets.stress, worst, found, strict=True):
        more = {"direction_deg": psi[direction], "component": "sigma_perp cos + tau_perp sin"}
        yield _rows("throat_perp", fillets, side, rated, model, columns | more)


def _parts(stress: ThroatStress) -> NDArray[np.float64]:
    """The two stresses across the weld, (n, 2, c)."""
    return np.stack([stress.sigma_perp, stress.tau_perp], axis=1)


def _along(fillets: _Fillets, model: Model, loads: Sequence[EventLoad], plan: Plan) -> Iterator[CheckRows]:
    """Shear stress along the weld."""
    rated = model.body.curves[fillets.throat.curve_shear]
    stresses = [stress.tau_par for stress in fillets.stress.values()]
    found = counted_each(stresses, fillets.size(rated), rated.rule, loads, rated.plan(plan), fillets.names)
    for side, columns in zip(fillets.stress, found, strict=True):
        yield _rows("throat_par", fillets, side, rated, model, columns | {"component": "tau_par"})


def _at_root(fillets: _Fillets, model: Model, loads: Sequence[EventLoad], plan: Plan) -> Iterator[CheckRows]:
    """Structural stress of the throat at its root, and at its face where that does more damage."""
    if fillets.throat.curve_root is None:
        yield from _bent_and_not_assessed(fillets)
        return
    rated = model.body.curves[fillets.throat.curve_root]
    plan = rated.plan(plan)
    for side, stress in fillets.stress.items():
        signals = Signals(stress.sigma_perp, stress.bending, fillets.size(rated), rated.rule)
        mission = counted_mission(signals, loads, plan, fillets.names)
        root, face = (counted_columns(mission, ALL, number, plan) for number in range(2))
        decides = face["damage_per_km"] > root["damage_per_km"]
        both = {name: np.where(decides, face[name], value) for name, value in root.items()}
        more = {
            "surface": np.where(decides, "face", "root"),
            "component": np.where(decides, "sigma_face", "sigma_root"),
        }
        yield _rows("throat_root", fillets, side, rated, model, both | more)


def _bent_and_not_assessed(fillets: _Fillets) -> Iterator[CheckRows]:
    """A row that says that a weld on one side is bent, and that no curve is given for the stress at its root."""
    if len(fillets.stress) == 1:
        (side,) = fillets.stress
        note = "one weld, which the moment about its centroid bends: give curve_root"
        yield check_rows(
            1,
            check="throat_root",
            weld=fillets.throat.weld,
            side=side,
            surface="root",
            component="sigma_root",
            note=note,
        )


def _rows(check: str, fillets: _Fillets, side: Side, rated: RatedCurve, model: Model, columns: Columns) -> CheckRows:
    """Rows of a check of the weld on one side, at every station."""
    stations, rows = model.stations, fillets.rows
    surface = {"surface": "throat"} | dict(columns)
    note = _note(check, fillets.throat, rated)
    return check_rows(
        rows.stop - rows.start,
        check=check,
        weld=fillets.throat.weld,
        part=stations.part[rows],
        order=stations.order[rows],
        side=side,
        curve=rated.curve.name,
        note=np.where(stations.summed_corner[rows], f"{note}; {AT_SUMMED_CORNER}", note),
        **surface,
    )


def _note(check: str, throat: WeldThroat, rated: RatedCurve) -> str:
    """What is assumed of the throat, shortly."""
    if len(throat.sides) == 2:
        said = ["f_z shared equally", "moment as a couple" + " over t" * (throat.lever == "t")]
    else:
        said = ["twist neglected", "plate free but for this weld"]
    if throat.joint == "custom":
        said.append(f"section at {throat.angle_deg:g} deg")
    else:
        said.append(f"line offset {throat.line_offset:g} mm")
    if check == "throat_root" and rated.curve.applies != "throat":
        said.append(f"a curve for {rated.curve.applies} stress, not for throats")
    return "; ".join(said)
