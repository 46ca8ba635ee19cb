"""A vehicle as the text of ``vehicle.toml``: every key with its value, what it is and where its value is from."""

from typing import Any

from fatigue.study.vehicle_keys import KEYS, OF_SETTING, Key
from fatigue.vehicle.definition import SETTINGS, Vehicle

HEAD = """\
# {title}
#
# SI units, speeds in km/h. x forward, y left, z up from the top of the rail, origin at the middle of the vehicle.
# A key that is left out has the value below. Origin of the values: P published for another high-speed vehicle,
# S the source paper, K Hertz and Kalker, rounded, O invented, T invented and picked among five combinations.
# None of them is a property of a real train.
"""
TITLE = "The reference trailer"


def vehicle_text(vehicle: Vehicle, title: str = TITLE) -> str:
    """Text that ``load_vehicle`` reads as this very vehicle; a key without value is a comment."""
    reference = Vehicle()
    parts = [HEAD.format(title=title)]
    for table, keys in KEYS.items():
        rows = [_row(table, name, key, vehicle, reference) for name, key in keys.items()]
        width = max(len(row) for row, _ in rows)
        parts.append("\n".join([f"[{table}]", *(f"{row.ljust(width)}  # {about}" for row, about in rows), ""]))
    return "\n".join(parts)


def _row(table: str, name: str, key: Key, vehicle: Vehicle, reference: Vehicle) -> tuple[str, str]:
    """One key with its value, and its comment: the origin where the value is that of the reference trailer."""
    value = getattr(getattr(vehicle, table), name)
    is_reference = value == getattr(getattr(reference, table), name)
    about = f"{f'({key.origin}) ' if is_reference else ''}{key.meaning}"
    if key.choices and key.choices[0] not in key.meaning:
        about += f": {', '.join(key.choices)}"
    if value is not None:
        return f"{name} = {toml_value(value)}", about
    if key.none:
        return f'{name} = "{key.none}"', about
    return f"# {name} = {_unset(table, name, vehicle)}", about


def _unset(table: str, name: str, vehicle: Vehicle) -> str:
    """What a key that is left out stands for."""
    if f"{table}.{name}" in OF_SETTING or name == "worn_conicity":
        return toml_value(getattr(SETTINGS[vehicle.suspension.setting], name))
    return "0.3"


def toml_value(value: Any) -> str:
    """Value as TOML writes it, large and small numbers with an exponent."""
    if isinstance(value, str):
        return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
    if isinstance(value, tuple):
        return f"[{', '.join(map(toml_value, value))}]"
    if isinstance(value, int):
        return str(value)
    text = repr(value)
    if value and (abs(value) >= 1e5 or abs(value) < 1e-3):
        mantissa, _, exponent = f"{value:e}".partition("e")
        short = f"{mantissa.rstrip('0').rstrip('.')}e{int(exponent)}"
        return short if float(short) == value else text
    return text
