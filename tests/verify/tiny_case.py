"""A small body with one weld of every kind, random forces and random records, written as a case."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

MODES = 4
STEP = 0.01  # s
FORCES = ["fx_N", "fy_N", "fz_N", "mx_Nmm", "my_Nmm", "mz_Nmm"]


@dataclass(frozen=True)
class TinyCase:
    """What differs between the cases of the tests; every text is TOML."""

    body: str = 'force_convention = "on_element"'
    curve: str = 'name = "master-aluminium"\nyield_MPa = 20.0'
    curves: str = ""
    counting: str = ""
    spectrum: str = "segment_s = 0.8"
    seam_curve: str = ""
    by_element: bool = False
    scale: tuple[float, ...] = (1.0,) * MODES
    dead_load: float = 2.0
    extra_mode: bool = False
    files: str = "parquet"
    welds: tuple[str, ...] = ("seam", "curved", "ring", "angle", "square", "short")
    samples: int = 240
    dead: str = ""  # a weld without forces
    still: str = ""  # an event in which nothing moves
    target_km: float = 1e6


def write_case(folder: Path, tiny: TinyCase) -> Path:
    """Write the case and its files; return the case file."""
    folder.mkdir(parents=True, exist_ok=True)
    rng = np.random.default_rng(7)
    lines = _lines(rng)
    lines = {name: lines[name] for name in tiny.welds}
    _write_welds(folder, lines, tiny)
    modes = np.array([11, 3, 7, 5])
    pd.DataFrame(
        {
            "mode": modes,
            "frequency_hz": [8.0, 3.0, 12.0, 20.0],
            "kind": ["normal", "normal", "normal", "interface"],
            "scale": tiny.scale,
        }
    ).to_csv(folder / "modes.csv", index=False)
    forced = np.append(modes, 99) if tiny.extra_mode else modes
    if tiny.by_element:
        _write_element_forces(folder, lines, forced, rng)
    else:
        rows = [
            {"weld": name, "node": node, "mode": mode}
            | dict(zip(FORCES, _force(rng) * (name != tiny.dead), strict=True))
            for name, line in lines.items()
            for node in line["node"]
            for mode in forced
        ]
        _write(pd.DataFrame(rows).sample(frac=1.0, random_state=1), folder / f"nodal_forces.{tiny.files}")
    for name, seed in (("rough", 1), ("smooth", 2)):
        moves = 0.0 if name == tiny.still else 1.0
        history = _history(np.random.default_rng(seed), forced, moves, tiny)
        _write(history, folder / f"q_{name}.{tiny.files}")
    pd.DataFrame({"time_s": [0.0, 1.0]} | {f"q_{m}": [0.1 * i, 0.5 + i] for i, m in enumerate(forced)}).to_csv(
        folder / "q_load.csv", index=False
    )
    case = folder / "case.toml"
    case.write_text(_text(tiny), encoding="utf-8")
    return case


def _text(tiny: TinyCase) -> str:
    forces = (
        'element_forces = "element_forces.csv"\nweld_elements = "weld_elements.csv"'
        if tiny.by_element
        else f'nodal_forces = "nodal_forces.{tiny.files}"'
    )
    return f"""title = "Tiny body"
[body]
modes = "modes.csv"
welds = "welds.csv"
weld_nodes = "weld_nodes.csv"
{forces}
{tiny.body}
[curve]
{tiny.curve}
{tiny.curves}
[counting]
{tiny.counting}
[spectrum]
{tiny.spectrum}
[mission]
target_km = {tiny.target_km}
km_per_year = 2e5
damage_limit = 0.8
[[mission.event]]
name = "rough"
history = "q_rough.{tiny.files}"
speed_km_h = 200.0
share = 0.6
start_s = 0.5
[[mission.event]]
name = "smooth"
history = "q_smooth.{tiny.files}"
length_km = 0.35
share = 0.4
stress_factor = 1.1
residue = "half"
[[mission.event]]
name = "load"
history = "q_load.csv"
per_1000_km = 1.5
"""


def _history(rng: np.random.Generator, modes: np.ndarray, moves: float, tiny: TinyCase) -> pd.DataFrame:
    """Make noisy sines of a few Hz about the dead load; ``moves`` of 0 keeps only the latter."""
    t = 3.0 + STEP * np.arange(tiny.samples)
    frequency, phase = 3 + rng.random((len(modes), 1)) * 9, rng.random((len(modes), 1))
    q = 0.5 * np.sin(2 * np.pi * frequency * t + phase)
    q = moves * (q + 0.2 * rng.standard_normal(q.shape)) + tiny.dead_load * (1 + 0.1 * np.arange(len(modes))[:, None])
    return pd.DataFrame({"time_s": t} | {f"q_{m}": row for m, row in zip(modes, q, strict=True)})


def _lines(rng: np.random.Generator) -> dict[str, dict]:
    """One line of each kind: nodes, coordinates and outward vectors."""
    s = np.array([0.0, 6.0, 15.0, 22.0, 40.0, 51.0])
    phi = np.linspace(0.2, 1.4, 7)
    ring = 2 * np.pi * np.arange(14) / 14
    leg = np.arange(5) * 12.0
    angle = np.concatenate([np.stack([leg, 0 * leg], 1), np.stack([0 * leg[1:] + 48.0, leg[1:]], 1)])
    side = np.arange(4) * 15.0
    square = np.concatenate(
        [
            np.stack(xy, 1)
            for xy in ((side, 0 * side), (60 + 0 * side, side), (60 - side, 60 + 0 * side), (0 * side, 60 - side))
        ]
    )

    def line(xy, outward, mid=False, closed=False, surface="both", end="") -> dict:
        xy = np.asarray(xy, float)
        n = len(xy)
        return {
            "xyz": np.column_stack([xy, 0.02 * xy[:, 0]]),
            "outward": np.broadcast_to(outward, (n, 2)),
            "edge_mid": np.arange(n) % 2 == 1 if mid else np.zeros(n, bool),
            "closed": closed,
            "surface": surface,
            "end": end,
        }

    arc = np.stack([np.cos(phi), np.sin(phi)], 1)
    round_ = np.stack([np.cos(ring), np.sin(ring)], 1)
    lines = {
        "seam": line(np.stack([s, 0.1 * s], 1), (0.0, 2.0), surface="top"),
        "curved": line(60 * arc, arc, mid=True, end=18.0),
        "ring": line(40 * round_, round_, mid=True, closed=True),
        "angle": line(angle, np.array([[0, -1.0]] * 4 + [[1, -1.0]] + [[1.0, 0]] * 4), end=0.0),
        "square": line(square, (square - 30.0), closed=True, end=0.0),
        "short": line([[0, 0], [7.0, 0]], (0, 1.0), surface="bottom"),
    }
    for first, one in enumerate(lines.values()):
        one["node"] = 100 * (first + 1) + rng.permutation(len(one["xyz"]))
    return lines


def _write_welds(folder: Path, lines: dict[str, dict], tiny: TinyCase) -> None:
    pd.DataFrame(
        [
            {
                "weld": name,
                "closed": line["closed"],
                "surface": line["surface"],
                "curve": tiny.seam_curve if name in ("seam", "curved") else "",
                "end_length_mm": line["end"],
            }
            for name, line in lines.items()
        ]
    ).to_csv(folder / "welds.csv", index=False)
    rows = []
    for name, line in lines.items():
        for i, node in enumerate(line["node"]):
            x, y, z = line["xyz"][i]
            ox, oy = line["outward"][i]
            rows.append(
                {"weld": name, "order": 10 * (i + 1), "node": node, "x_mm": x, "y_mm": y, "z_mm": z}
                | {"thickness_mm": 4.0 + 30.0 * (name == "curved"), "normal_x": -0.02, "normal_y": 0.0, "normal_z": 1.0}
                | {"outward_x": ox, "outward_y": oy, "outward_z": 0.3, "edge_mid": bool(line["edge_mid"][i])}
            )
    pd.DataFrame(rows).sample(frac=1.0, random_state=2).to_csv(folder / "weld_nodes.csv", index=False)


def _write_element_forces(folder: Path, lines: dict[str, dict], modes: np.ndarray, rng: np.random.Generator) -> None:
    """Write strips of quadrilaterals along every line, each in balance, and triangles that touch one node only."""
    rows, owners = [], []
    element = 1000
    for name, line in lines.items():
        node, n = line["node"], len(line["node"])
        inner = node + 5000
        step = 2 if line["edge_mid"].any() else 1
        edges = [[node[(i + k) % n] for k in range(step + 1)] for i in range(0, n if line["closed"] else n - 1, step)]
        fans = [[*edge, inner[list(node).index(edge[-1])], inner[list(node).index(edge[0])]] for edge in edges]
        fans += [[corner, inner[i], 9000 + corner] for i, corner in enumerate(node) if i % step == 0]
        for corners in fans:
            element += 1
            owners.append({"weld": name, "element": element})
            for mode in modes:
                force = np.array([_force(rng) for _ in corners])
                force[:, :3] -= force[:, :3].mean(axis=0)
                rows += [
                    {"mode": mode, "node": corner, "element": element} | dict(zip(FORCES, f, strict=True))
                    for corner, f in zip(corners, force, strict=True)
                ]
    pd.DataFrame(rows).to_csv(folder / "element_forces.csv", index=False)
    pd.DataFrame(owners).to_csv(folder / "weld_elements.csv", index=False)


def _force(rng: np.random.Generator) -> np.ndarray:
    return rng.standard_normal(6) * [400.0, 400.0, 400.0, 800.0, 800.0, 800.0]


def _write(frame: pd.DataFrame, path: Path) -> None:
    if path.suffix == ".csv":
        frame.to_csv(path, index=False)
    else:
        frame.to_parquet(path, index=False)
