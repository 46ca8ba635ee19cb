"""What a vehicle leaves out, filled from the setting of its suspension."""

from dataclasses import fields

from fatigue.errors import CaseError, Problem
from fatigue.vehicle.definition import SETTINGS, Setting, Vehicle


def settled(vehicle: Vehicle) -> Setting:
    """Guidance, yaw dampers, wheelbase and worn conicity of a vehicle: its own values, else those of its setting.

    Raises
    ------
    CaseError : a setting nobody knows

    >>> from fatigue.vehicle.definition import Bogie, Suspension
    >>> settled(Vehicle(suspension=Suspension(setting="long_wheelbase"), bogie=Bogie(wheelbase_m=2.5)))
    ... # doctest: +NORMALIZE_WHITESPACE
    Setting(primary_x_N_m=120000000.0, primary_y_N_m=12500000.0, yaw_damper_N_m=8000000.0, yaw_damper_Ns_m=500000.0,
            wheelbase_m=2.5, worn_conicity=1.2)
    """
    name = vehicle.suspension.setting
    if name not in SETTINGS:
        remedy = f"Choose one of {', '.join(SETTINGS)}"
        raise CaseError(Problem("setting", "[suspension] setting", f"{name!r} is no known setting", remedy))
    given = {
        key: value
        for table in (vehicle.suspension, vehicle.bogie, vehicle.contact)
        for key in (field.name for field in fields(Setting))
        if (value := getattr(table, key, None)) is not None
    }
    setting = SETTINGS[name]
    return Setting(*(given.get(field.name, getattr(setting, field.name)) for field in fields(Setting)))


def axle_places(vehicle: Vehicle) -> tuple[float, float, float, float]:
    """Where the four axles stand, x [m] from mid vehicle, the leading one first.

    >>> axle_places(Vehicle())
    (10.0, 7.5, -7.5, -10.0)
    """
    half, a = vehicle.bogie.spacing_m / 2.0, settled(vehicle).wheelbase_m / 2.0
    return half + a, half - a, -half + a, -half - a
