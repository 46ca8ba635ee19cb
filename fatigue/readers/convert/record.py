"""What a conversion writes down for later: the lines of its welds, and the command that would convert once more."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from fatigue.readers.convert.options import ConvertOptions
from fatigue.readers.neutral.register.weld_register import RegisterRow


def lines_of_welds(rows: Sequence[RegisterRow]) -> dict[str, dict[str, float | None]]:
    """Record the lines of every weld that is assessed, with the thickness confirmed for each."""
    welds: dict[str, dict[str, float | None]] = {}
    for row in rows:
        if row.status == "assess":
            welds.setdefault(row.weld, {})[row.line] = row.thickness if row.confirmed else None
    return welds


def arguments_of(options: ConvertOptions) -> list[str]:
    """Arguments of the command that converts with these options, without target and register; paths are absolute."""
    default, sources = type(options)(options.forces, options.mesh, options.out), options.welds
    named = {
        "--forces": options.forces,
        "--mesh": options.mesh,
        "--convention": options.convention,
        "--subcase": options.subcase,
        "--columns": options.columns,
        "--time-column": options.time_column,
        "--resample": options.resample_s,
        "--simulation-modes": options.simulation_modes,
        "--interface-modes": ",".join(map(str, options.interface_modes)) or None,
        "--ignore-modes": ",".join(map(str, options.ignore_modes)) or None,
        "--node-lists": sources.node_lists,
        **_changed(options, default, {"units": "force_units", "title": "title", "curve": "curve", "match": "match"}),
        **_changed(options, default, {"coordinate-units": "coordinate_units", "normalisation": "normalisation"}),
        **_changed(options, default, {"speed": "speed_km_h", "target-km": "target_km"}),
    }
    words = [word for name, value in named.items() if value is not None for word in (name, _word(value))]
    repeated = {"--coordinates": options.coordinates, "--accept": options.accept}
    repeated |= {"--unit-loads": options.unit_loads, "--set": sources.sets, "--marker": sources.markers}
    words += [word for name, values in repeated.items() for value in values for word in (name, _word(value))]
    words += [w for d in options.displacements for w in ("--displacement", _word(d.file), str(d.node), d.direction)]
    words += [] if sources.detect is None else ["--detect" if sources.detect else "--no-detect"]
    return words + ["--candidates"] * sources.candidates


def _changed(options: ConvertOptions, default: ConvertOptions, names: Mapping[str, str]) -> dict[str, object]:
    """Options that differ from their default."""
    values = {f"--{name}": getattr(options, attribute) for name, attribute in names.items()}
    return {f"--{name}": values[f"--{name}"] for name, a in names.items() if values[f"--{name}"] != getattr(default, a)}


def _word(value: object) -> str:
    return str(value.resolve()) if isinstance(value, Path) else str(value)
