"""A synthetic case of any size in the neutral format, to try the program on as many welds as a train has.

Force tables are written weld by weld, so that the size of the case is limited by the disk. What the tables hold is as
hard to assess as a real body, and no harder:

- Between welds the rms stress is log-normal with the standard deviation ``LEVEL_SPREAD`` of its logarithm: a few welds
  carry much, most carry little. ``MEDIAN_RMS`` makes the design a sound one: of 20 000 welds, about 20 miss the target.
- The modal stress of each mode along a weld is a random smooth field, a sum of cosines with amplitudes that decay
  geometrically, by another factor on every weld. Membrane and bending modal stresses of a weld together have the
  numerical rank 2 to 5 at 1e-1 of the largest singular value, 4 to 11 at 1e-2, 7 to 17 at 1e-3, 11 to 30 at 1e-5;
  on a car body 2 to 4, 3 to 11, 4 to 19, 8 to 35 were found.
- Stress is concentrated at one end of a weld or at some spot, and varies smoothly elsewhere. On the median weld 6 %,
  25 % and 50 % of the points have damage within a factor 1.8, 7 and 30 of the worst; on that body typically 3 to 15 %,
  12 to 45 % and 36 to 60 %.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import NDArray

from fatigue.errors import CaseError, Problem, given_path
from fatigue.files.whole import staged

Floats = NDArray[np.float64]

EDGE = 10.0  # [mm] between neighbouring nodes
THICKNESSES = (4.0, 6.0, 8.0, 12.0)  # [mm]
WELD_LENGTHS = (20, 100)  # nodes of a weld, from and to
MEDIAN_RMS = 0.02  # [MPa] membrane stress of the median weld
LEVEL_SPREAD = 1.0  # standard deviation of ln(rms) between welds: 1 in 40 has 7 times the median
BENDING_SHARE = 0.5  # bending over membrane stress
COSINES = 25  # along a weld, of 0, 1, 2 ... half waves
DECAY = (0.12, 0.52)  # from each cosine's amplitude to the next, from and to
NODE_SPREAD = 0.5  # standard deviation of ln(stress) along a weld, of SPREAD_WAVES half waves
SPREAD_WAVES = 5
PEAK = (2.0, 3.0)  # factor on the stress at the spot where it concentrates, from and to
PEAK_NODES = (1.5, 5.0)  # over which the excess falls to 1/e, from and to
LOWEST_HZ, HIGHEST_HZ = 4.0, 45.0
DAMPING = 0.02
ROWS_AT_ONCE = 1_000_000
CASE = "case.toml"
FEWEST_SAMPLES = 16  # of a record, so that it has a standard deviation worth the name


@dataclass(frozen=True, slots=True)
class Size:
    """How large a synthetic case is: weld-line nodes, modes, events, and duration [s] and rate [Hz] of each event."""

    nodes: int
    modes: int = 60
    events: int = 3
    seconds: float = 60.0
    rate: float = 250.0


@dataclass(frozen=True, slots=True, eq=False)
class _Weld:
    """One straight weld line: its first node, and line force [N/mm] and line moment [N] per mode (n, m)."""

    name: str
    first: int
    thickness: float
    origin: Floats
    force: Floats
    moment: Floats


def synthesize(folder: Path | str, size: Size, seed: int = 0) -> Path:
    """Write the case of a given size into a folder and return the path of its ``case.toml``.

    The same size and seed give the same case.

    Raises
    ------
    CaseError : records of less than 16 samples
    DataError : the disk is full or the folder cannot be written; then nothing of it is there
    """
    samples = round(size.seconds * size.rate)
    if samples < FEWEST_SAMPLES:
        what = f"{size.seconds:g} s at {size.rate:g} Hz are {samples} samples"
        raise CaseError(Problem("short_record", "size", what, f"Give at least {FEWEST_SAMPLES}"))
    folder = given_path(folder, "folder")
    with staged(folder, ".synth-") as stage:
        _write_all(stage, size, seed)
        for path in sorted(stage.iterdir(), key=lambda path: path.name == CASE):
            path.replace(folder / path.name)
    return folder / CASE


def _write_all(folder: Path, size: Size, seed: int) -> None:
    """Write all files of the case."""
    frequency = np.linspace(LOWEST_HZ, HIGHEST_HZ, size.modes)
    pq.write_table(
        pa.table({"mode": np.arange(1, size.modes + 1), "frequency_hz": frequency, "kind": _kinds(size.modes)}),
        folder / "modes.parquet",
    )
    _write_welds(folder, _welds(size, seed), size.modes)
    for event in range(size.events):
        rng = np.random.default_rng([seed, 1, event])
        pq.write_table(_history(rng, frequency, size), folder / f"q_{event + 1}.parquet")
    (folder / CASE).write_text(_case(size), encoding="utf-8")


def _kinds(modes: int) -> list[str]:
    """Kinds of the modes: normal but the last, which stands for the modes that carry the local load of the welds."""
    return ["normal"] * (modes - 1) + ["interface"]


def _welds(size: Size, seed: int) -> Iterator[_Weld]:
    """Welds drawn until all nodes are used up."""
    rng = np.random.default_rng([seed, 0])
    first, number = 1, 0
    while first <= size.nodes:
        left = size.nodes - first + 1
        n = min(int(rng.integers(WELD_LENGTHS[0], WELD_LENGTHS[1] + 1)), left)
        n += left - n if left - n < WELD_LENGTHS[0] else 0  # no short rest
        number += 1
        thickness = float(rng.choice(THICKNESSES))
        level = MEDIAN_RMS * np.exp(LEVEL_SPREAD * rng.normal())
        membrane, bending = level * _modal_stress(rng, n, size.modes)
        yield _Weld(
            name=f"W{number:06d}",
            first=first,
            thickness=thickness,
            origin=np.array([0.0, 50.0 * number, 0.0]),
            force=membrane * thickness,
            moment=-BENDING_SHARE * bending * thickness**2 / 6.0,
        )
        first += n


def _modal_stress(rng: np.random.Generator, n: int, modes: int) -> Floats:
    """Membrane and bending stress per unit modal coordinate along a weld, (2, n, m), drawn with a membrane rms of 1."""
    along = (np.arange(n) + 0.5) / n
    half_waves = np.arange(COSINES)
    cosines = np.cos(np.pi * half_waves * along[:, None])
    amplitude = rng.uniform(*DECAY) ** half_waves
    stress = cosines @ (amplitude[:, None] * rng.normal(size=(2, COSINES, modes)))
    stress *= _concentration(rng, cosines)[:, None]
    return np.asarray(stress / np.sqrt(np.sum(stress[0] ** 2) / n))


def _concentration(rng: np.random.Generator, cosines: Floats) -> Floats:
    """Factor on all modal stresses at each node of a weld, (n,), drawn smooth with a peak at an end or another spot."""
    node = np.arange(len(cosines))
    waves = slice(1, SPREAD_WAVES + 1)
    smooth = cosines[:, waves] @ (0.8 ** np.arange(SPREAD_WAVES) * rng.normal(size=SPREAD_WAVES))
    spot = rng.choice([0.0, node[-1], rng.uniform(0.0, node[-1])])
    peak = 1.0 + (rng.uniform(*PEAK) - 1.0) * np.exp(-np.abs(node - spot) / rng.uniform(*PEAK_NODES))
    return np.asarray(np.exp(NODE_SPREAD * smooth / smooth.std()) * peak)


def _write_welds(folder: Path, welds: Iterator[_Weld], modes: int) -> None:
    """Write ``welds``, ``weld_nodes`` and ``nodal_forces``, a million force rows at a time."""
    pending: list[_Weld] = []
    rows = 0
    with _Tables(folder) as tables:
        for weld in welds:
            pending.append(weld)
            rows += weld.force.size
            if rows >= ROWS_AT_ONCE:
                tables.write(pending, modes)
                pending, rows = [], 0
        if pending:
            tables.write(pending, modes)


class _Tables:
    """The three tables of the welds, open for writing."""

    names = ("welds", "weld_nodes", "nodal_forces")

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.writers: dict[str, pq.ParquetWriter] = {}

    def __enter__(self) -> "_Tables":
        return self

    def __exit__(self, *_: object) -> None:
        for writer in self.writers.values():
            writer.close()

    def write(self, welds: list[_Weld], modes: int) -> None:
        """Append some welds to all tables."""
        for name, table in zip(
            self.names, (_weld_rows(welds), _node_rows(welds), _force_rows(welds, modes)), strict=True
        ):
            if name not in self.writers:
                repeated = [column for column in ("weld", "node", "mode", "order") if column in table.column_names]
                self.writers[name] = pq.ParquetWriter(
                    self.folder / f"{name}.parquet", table.schema, use_dictionary=repeated
                )
            self.writers[name].write_table(table)


def _weld_rows(welds: list[_Weld]) -> pa.Table:
    return pa.table({"weld": [weld.name for weld in welds], "closed": [False] * len(welds)})


def _node_rows(welds: list[_Weld]) -> pa.Table:
    lengths = [len(weld.force) for weld in welds]
    order = np.concatenate([np.arange(1, n + 1) for n in lengths])
    origin = np.repeat([weld.origin for weld in welds], lengths, axis=0)
    count = len(order)
    return pa.table(
        {
            "weld": np.repeat([weld.name for weld in welds], lengths),
            "order": order,
            "node": np.repeat([weld.first for weld in welds], lengths) + order - 1,
            "x_mm": origin[:, 0] + EDGE * (order - 1),
            "y_mm": origin[:, 1],
            "z_mm": origin[:, 2],
            "thickness_mm": np.repeat([weld.thickness for weld in welds], lengths),
            "normal_x": np.zeros(count),
            "normal_y": np.zeros(count),
            "normal_z": np.ones(count),
            "outward_x": np.zeros(count),
            "outward_y": np.ones(count),
            "outward_z": np.zeros(count),
        }
    )


def _force_rows(welds: list[_Weld], modes: int) -> pa.Table:
    lengths = [len(weld.force) for weld in welds]
    force = np.concatenate([_nodal(weld.force) for weld in welds]).ravel().astype(np.float32)
    moment = np.concatenate([_nodal(weld.moment) for weld in welds]).ravel().astype(np.float32)
    nodes = np.concatenate([weld.first + np.arange(n) for weld, n in zip(welds, lengths, strict=True)])
    name = pa.DictionaryArray.from_arrays(
        np.repeat(np.arange(len(welds), dtype=np.int32), np.array(lengths) * modes), [weld.name for weld in welds]
    )
    nothing = np.zeros(force.size, np.float32)
    return pa.table(
        {
            "weld": name.cast(pa.string()),
            "node": np.repeat(nodes, modes),
            "mode": np.tile(np.arange(1, modes + 1), len(nodes)),
            "fx_N": nothing,
            "fy_N": force,
            "fz_N": nothing,
            "mx_Nmm": moment,
            "my_Nmm": nothing,
            "mz_Nmm": nothing,
        }
    )


def _nodal(line_load: Floats) -> Floats:
    """Nodal values of a line load (n, m), linear between the nodes: consistent, so that solving gives it back."""
    padded = np.pad(line_load, ((1, 1), (0, 0)))
    inner = np.full((len(line_load), 1), 4.0)
    inner[[0, -1]] = 2.0
    return np.asarray(EDGE / 6.0 * (padded[:-2] + inner * line_load + padded[2:]))


def _history(rng: np.random.Generator, frequency: Floats, size: Size) -> pa.Table:
    """Modal coordinates of unit rms over time: lightly damped resonances under broad-band excitation."""
    samples = round(size.seconds * size.rate)
    f = np.fft.rfftfreq(samples, 1.0 / size.rate)
    columns: dict[str, NDArray[np.floating]] = {"time_s": np.arange(samples) / size.rate}
    for number, f_n in enumerate(frequency, start=1):
        resonance = 1.0 / (1.0 - (f / f_n) ** 2 + 2j * DAMPING * f / f_n)
        noise = rng.normal(size=f.size) + 1j * rng.normal(size=f.size)
        q = np.fft.irfft(resonance * noise * (f < 1.5 * HIGHEST_HZ), samples)
        columns[f"q_{number}"] = ((q - q.mean()) / q.std()).astype(np.float32)
    return pa.table(columns)


def _case(size: Size) -> str:
    """Text of ``case.toml``: every event at its own speed and with the same share of the mileage."""
    shares = [round(1.0 / size.events, 9)] * size.events
    shares[-1] = round(1.0 - sum(shares[:-1]), 9)
    text = f"""title = "Synthetic: {size.nodes} nodes, {size.modes} modes, {size.events} events"
[body]
modes = "modes.parquet"
welds = "welds.parquet"
weld_nodes = "weld_nodes.parquet"
nodal_forces = "nodal_forces.parquet"
force_convention = "on_element"
[curve]
name = "master-aluminium"
[mission]
target_km = 1.2e7
km_per_year = 5.0e5
damage_limit = 1.0
"""
    for number, share in enumerate(shares, start=1):
        text += f"""[[mission.event]]
name = "event {number}"
history = "q_{number}.parquet"
speed_km_h = {200 + 10 * number}.0
share = {share}
"""
    return text
