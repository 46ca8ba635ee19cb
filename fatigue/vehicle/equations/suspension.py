"""What hangs where: every spring and damper of a vehicle, between the points of its bodies."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem, refuse
from fatigue.vehicle.definition import Equipment, Vehicle
from fatigue.vehicle.elastic import ElasticBody
from fatigue.vehicle.equations.coordinates import BOGIES, CAR, CONVERTER, TRANSFORMER, WHEELSETS, Coordinates
from fatigue.vehicle.equations.springs import Maxwell, Spring, X, Y, Z, elongation
from fatigue.vehicle.settled import axle_places, settled

Floats = NDArray[np.float64]

ENDS = ("front", "rear")
SIDES = {"left": 1.0, "right": -1.0}
MOUNTS = range(1, 5)
SIGNALS, AXLES = 3, 4  # lateral, vertical and roll of the track under each axle, signal by signal
VERTICAL, ROLL = 1, 2
NEEDED = tuple(
    [f"bolster_{end}_{side}" for end in ENDS for side in SIDES]
    + [f"{equipment}_{mount}" for equipment in ("converter", "transformer") for mount in MOUNTS]
)
"""Points of the car body where the suspension takes hold."""


@dataclass(frozen=True, slots=True, eq=False)
class Places:
    """The points of a vehicle: how each moves with its coordinates."""

    vehicle: Vehicle
    body: ElasticBody
    at: Coordinates

    def car(self, name: str) -> Floats:
        """Displacement (3, n) of a point of the car body: its rigid motion and what the modes add."""
        point = self.body.points[name]
        motion = self.at.carried(CAR, self.body.cg, point.place)
        motion[:, self.at.flex] = point.shape[:3]
        return motion

    def equipment_cg(self, name: str) -> Floats:
        """Centre of gravity (3,) [m] of converter or transformer."""
        of = self.vehicle.converter if name == CONVERTER else self.vehicle.transformer
        return np.array([of.x_m, of.y_m, of.z_m])

    def bogie_cg(self, bogie: int) -> Floats:
        """Centre of gravity (3,) [m] of the front (0) or rear (1) bogie."""
        half = self.vehicle.bogie.spacing_m / 2.0
        return np.array([half if bogie == 0 else -half, 0.0, self.vehicle.bogie.z_m])

    def wheelset_cg(self, axle: int) -> Floats:
        """Centre of gravity (3,) [m] of a wheelset, 0 to 3 from the leading one."""
        return np.array([axle_places(self.vehicle)[axle], 0.0, self.vehicle.wheelset.z_m])

    def bogie(self, bogie: int, place: Floats) -> Floats:
        """Displacement (3, n) of a place on the front (0) or rear (1) bogie."""
        return self.at.carried(BOGIES[bogie], self.bogie_cg(bogie), place)


def require_points(body: ElasticBody, where: str = "car body") -> None:
    """Refuse a car body that lacks a point where the suspension takes hold, or does not say how modes move it.

    Raises
    ------
    DataError : names ``where`` the body is from
    """
    missing = [name for name in NEEDED if name not in body.points]
    unknown = [name for name in NEEDED if name not in missing and not np.isfinite(body.points[name].shape[:3]).all()]
    problems = []
    if missing:
        what = f"lacks the point{'s' * (len(missing) > 1)} {', '.join(missing)}, where the suspension takes hold"
        remedy = "Give the nodes these names in the table of `fatigue reduce`"
        problems.append(Problem("points", where, what, remedy))
    if unknown:
        what = f"does not say how its modes move {', '.join(unknown)} along x, y and z"
        problems.append(Problem("points", where, what, "Give the components 123 to these points"))
    if not missing:
        for end in ENDS:
            left, right = (body.points[f"bolster_{end}_{side}"].place[1] for side in SIDES)
            if not left > right:
                what = f"bolster_{end}_left at y = {left:g} m is not left of bolster_{end}_right at y = {right:g} m"
                problems.append(Problem("points", where, what, "Name the points left and right, y to the left"))
    refuse(DataError, problems)


def springs(of: Places) -> list[Spring]:
    """Every spring with its damper, from the wheelsets up; rails under the primary vertical ones."""
    return [*_primary(of), *_secondary(of), *_mounts(of, CONVERTER), *_mounts(of, TRANSFORMER)]


def yaw_dampers(of: Places) -> list[Maxwell]:
    """Yaw dampers, one per side of a bogie, along x between the car body and the bogie; none where k or c is 0."""
    k, c = settled(of.vehicle).yaw_damper_N_m, settled(of.vehicle).yaw_damper_Ns_m
    if k == 0.0 or c == 0.0:
        return []
    arm, height = of.vehicle.suspension.yaw_damper_half_distance_m, of.vehicle.suspension.yaw_damper_height_m
    dampers = []
    for bogie, end in enumerate(ENDS):
        for side, sign in SIDES.items():
            on_bogie = of.bogie(bogie, np.array([of.bogie_cg(bogie)[0], sign * arm, height]))
            row = elongation(X, of.car(f"bolster_{end}_{side}"), on_bogie)
            dampers.append(Maxwell(f"yaw damper {end} {side}", row, k, c))
    return dampers


def _primary(of: Places) -> list[Spring]:
    """Along x and y between bogie and wheelset, along z between bogie and rail, which moves by z + s r at side s."""
    suspension, setting = of.vehicle.suspension, settled(of.vehicle)
    found = []
    for axle, wheelset in enumerate(WHEELSETS):
        cg = of.wheelset_cg(axle)
        for side, sign in SIDES.items():
            s = sign * suspension.primary_half_distance_m
            place = np.array([cg[0], s, cg[2]])
            on_bogie, on_wheelset = of.bogie(axle // 2, place), of.at.carried(wheelset, cg, place)
            name = f"primary {axle + 1} {side}"
            along_x, along_y = (elongation(direction, on_bogie, on_wheelset) for direction in (X, Y))
            rail = np.zeros((SIGNALS, AXLES))
            rail[VERTICAL, axle], rail[ROLL, axle] = 1.0, s
            found += [
                Spring(f"{name} x", along_x, setting.primary_x_N_m, suspension.primary_x_Ns_m),
                Spring(f"{name} y", along_y, setting.primary_y_N_m, suspension.primary_y_Ns_m),
                Spring(f"{name} z", on_bogie[Z], suspension.primary_z_N_m, suspension.primary_z_Ns_m, rail.ravel()),
            ]
    return found


def _secondary(of: Places) -> list[Spring]:
    """Along x, y and z between the bolsters of the car body and the bogie, and the anti-roll bar."""
    suspension = of.vehicle.suspension
    arm, height = suspension.secondary_half_distance_m, suspension.secondary_height_m
    rates = (
        (suspension.secondary_x_N_m, suspension.secondary_x_Ns_m),
        (suspension.secondary_y_N_m, suspension.secondary_y_Ns_m),
        (suspension.secondary_z_N_m, suspension.secondary_z_Ns_m),
    )
    found = []
    for bogie, end in enumerate(ENDS):
        for side, sign in SIDES.items():
            on_car = of.car(f"bolster_{end}_{side}")
            on_bogie = of.bogie(bogie, np.array([of.bogie_cg(bogie)[0], sign * arm, height]))
            for direction, (k, c) in zip((X, Y, Z), rates, strict=True):
                found.append(
                    Spring(f"secondary {end} {side} {'xyz'[direction]}", elongation(direction, on_car, on_bogie), k, c)
                )
        found.append(Spring(f"anti-roll bar {end}", _twist(of, bogie), suspension.anti_roll_Nm_rad))
    return found


def _twist(of: Places, bogie: int) -> Floats:
    """Row (n,) of ``e = (z_left - z_right)/(y_left - y_right) - rx``: bolsters of the car body against the bogie."""
    left, right = (f"bolster_{ENDS[bogie]}_{side}" for side in SIDES)
    lever = of.body.points[left].place[1] - of.body.points[right].place[1]
    row = (of.car(left)[Z] - of.car(right)[Z]) / lever
    row[of.at.column(BOGIES[bogie], "rx")] -= 1.0
    return np.asarray(row)


def _mounts(of: Places, name: str) -> list[Spring]:
    """Four mounts along x, y and z between the car body and equipment, straight below or above at the height of its cg.

    With the body held still the equipment has the frequencies f: ``k = m (2 pi f)^2 / 4``, ``c = 2 zeta k/(2 pi f)``.
    """
    equipment, word = (
        (of.vehicle.converter, "converter") if name == CONVERTER else (of.vehicle.transformer, "transformer")
    )
    cg = of.equipment_cg(name)
    found = []
    for mount in MOUNTS:
        on_car = of.car(f"{word}_{mount}")
        x, y, _ = of.body.points[f"{word}_{mount}"].place
        on_equipment = of.at.carried(name, cg, np.array([x, y, cg[2]]))
        for direction, hz in zip((X, Y, Z), (equipment.fx_hz, equipment.fe_hz, equipment.fz_hz), strict=True):
            row = elongation(direction, on_car, on_equipment)
            found.append(Spring(f"{word} mount {mount} {'xyz'[direction]}", row, *mount_rates(equipment, hz)))
    return found


def mount_rates(equipment: Equipment, hz: float) -> tuple[float, float]:
    """Stiffness [N/m] and damping [N s/m] of one of four mounts that give a frequency with the body held still.

    >>> tuple(round(rate, 1) for rate in mount_rates(Vehicle().converter, 9.2))
    (5513397.9, 9537.9)
    """
    w = 2.0 * np.pi * hz
    return equipment.mass_kg * w**2 / 4.0, equipment.damping_ratio * equipment.mass_kg * w / 2.0
