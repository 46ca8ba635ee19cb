"""A small case with a closed-form answer: straight welds under uniform line loads, a few modes, short records."""

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pandas as pd

SPACING = 10.0  # mm between the nodes of a line
THICKNESS = 8.0  # mm
MEMBRANE, BENDING = 1.0, 0.5  # MPa per unit of mode 1, at the top face
STEP = 0.005  # s


@dataclass
class SmallCase:
    """Tables of a case before they are written; a test changes what it wants to see refused or moved."""

    modes: pd.DataFrame
    welds: pd.DataFrame
    weld_nodes: pd.DataFrame
    nodal_forces: pd.DataFrame
    histories: dict[str, pd.DataFrame]
    body: dict[str, str] = field(default_factory=dict)
    curve: dict[str, object] = field(default_factory=lambda: {"name": "master-aluminium"})
    counting: dict[str, object] = field(default_factory=lambda: {"upsample": 1})
    spectrum: dict[str, object] = field(default_factory=lambda: {"segment_s": 1.0})
    mission: dict[str, object] = field(
        default_factory=lambda: {"target_km": 1e6, "km_per_year": 2e5, "damage_limit": 1.0}
    )
    events: list[dict[str, object]] = field(default_factory=list)
    extra: str = ""

    def write(self, folder: Path, suffix: str = "csv") -> Path:
        """Write all files; return the path of the case file."""
        folder.mkdir(parents=True, exist_ok=True)
        for name in ("modes", "welds", "weld_nodes", "nodal_forces"):
            _write(getattr(self, name), folder / f"{name}.{suffix}")
        for name, table in self.histories.items():
            _write(table, folder / f"{name}.{suffix}")
        body = {name: f"{name}.{suffix}" for name in ("modes", "welds", "weld_nodes", "nodal_forces")}
        lines = ['title = "small case"', "[body]", *_toml(body | {"force_convention": "on_element"} | self.body)]
        lines += ["[curve]", *_toml(self.curve), "[counting]", *_toml(self.counting)]
        lines += ["[spectrum]", *_toml(self.spectrum), "[mission]", *_toml(self.mission)]
        for event in self.events:
            lines += ["[[mission.event]]", *_toml(event | {"history": f"{event['history']}.{suffix}"})]
        path = folder / "case.toml"
        path.write_text("\n".join([*lines, self.extra]) + "\n", encoding="utf-8")
        return path


def small_case(seconds: float = 12.0, pairs: int = 1) -> SmallCase:
    """Two welds (one with a toe on top only), three modes, a sine event, a random event and one counted by number.

    With more ``pairs`` of welds the body is cut into groups that are assessed one by one, eight pairs give three.
    """
    names = [f"{side}{pair or ''}" for pair in range(pairs) for side in "AB"]
    welds = pd.DataFrame({"weld": names, "surface": ["both", "top"] * pairs})
    nodes = pd.concat([_line(w, 100 * i + 100, 500.0 * i) for i, w in enumerate(names)], ignore_index=True)
    t = np.arange(round(seconds / STEP)) * STEP
    rng = np.random.default_rng(7)
    noise = np.stack([np.convolve(rng.standard_normal(len(t)), np.ones(6) / 6, mode="same") for _ in range(3)])
    return SmallCase(
        modes=pd.DataFrame(
            {"mode": [1, 2, 7], "frequency_hz": [5.0, 12.0, 60.0], "kind": ["normal", "normal", "interface"]}
        ),
        welds=welds,
        weld_nodes=nodes,
        nodal_forces=pd.concat([_forces(nodes[nodes.weld == w], i) for i, w in enumerate(names)], ignore_index=True),
        histories={
            "sine": pd.DataFrame({"time_s": t, "q_1": 30.0 * np.sin(2 * np.pi * 5.0 * t), "q_2": 0.0, "q_7": 0.0}),
            "noise": pd.DataFrame({"time_s": t, "q_1": 20 * noise[0], "q_2": 15 * noise[1], "q_7": 10 * noise[2]}),
            "load": pd.DataFrame({"time_s": [0.0, 1.0], "q_1": [0.0, 40.0], "q_2": [0.0, 5.0], "q_7": [0.0, 0.0]}),
        },
        events=[
            {"name": "sine", "history": "sine", "speed_km_h": 180.0, "share": 0.75},
            {"name": "noise", "history": "noise", "speed_km_h": 360.0, "share": 0.25, "start_s": 1.0},
            {"name": "load and unload", "history": "load", "per_1000_km": 2.0},
        ],
    )


def sine_only() -> SmallCase:
    """The small case with the sine as its only event: life follows by hand."""
    case = small_case()
    case.histories = {"sine": case.histories["sine"]}
    case.events = [{"name": "sine", "history": "sine", "speed_km_h": 180.0, "share": 1.0}]
    return case


def _line(weld: str, first_node: int, y: float, count: int = 7) -> pd.DataFrame:
    return pd.DataFrame(
        {
            "weld": weld,
            "order": np.arange(1, count + 1),
            "node": first_node + np.arange(count),
            "x_mm": SPACING * np.arange(count),
            "y_mm": y,
            "z_mm": 0.0,
            "thickness_mm": THICKNESS,
            "normal_x": 0.0,
            "normal_y": 0.0,
            "normal_z": 1.0,
            "outward_x": 0.0,
            "outward_y": 1.0,
            "outward_z": 0.0,
        }
    )


def _forces(nodes: pd.DataFrame, seed: int) -> pd.DataFrame:
    """Consistent nodal forces of uniform line loads: membrane and bending of mode 1 as stated, others drawn."""
    rng = np.random.default_rng(seed)
    tributary = np.full(len(nodes), SPACING)
    tributary[[0, -1]] /= 2.0
    tables = []
    for mode in (1, 2, 7):
        f, m = np.zeros(3), np.zeros(3)
        if mode == 1:
            f[1], m[0] = MEMBRANE * THICKNESS, -BENDING * THICKNESS**2 / 6.0
        else:
            f, m = rng.normal(0.0, 5.0, 3), rng.normal(0.0, 10.0, 3)
        load = tributary[:, None] * np.concatenate([f, m])
        table = pd.DataFrame(load, columns=["fx_N", "fy_N", "fz_N", "mx_Nmm", "my_Nmm", "mz_Nmm"])
        tables.append(table.assign(weld=nodes.weld.to_numpy(), node=nodes.node.to_numpy(), mode=mode))
    return pd.concat(tables, ignore_index=True)


def _write(table: pd.DataFrame, path: Path) -> None:
    if path.suffix == ".csv":
        table.to_csv(path, index=False)
    else:
        table.to_parquet(path, index=False)


def _toml(table: dict[str, object]) -> list[str]:
    return [f"{key} = {_value(value)}" for key, value in table.items()]


def _value(value: object) -> str:
    if isinstance(value, str):
        return f'"{value}"'
    return repr(value).replace("True", "true").replace("False", "false")
