"""The modes of a body in the neutral format."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import DataError, Problem
from fatigue.readers.neutral.tables import open_table

KINDS = ("normal", "interface", "rigid")
DAMPED_AS_RULED = 1000.0  # Hz: common multibody codes damp what lies above critically
MOST_DAMPING = 0.3  # [-] of a normal mode: car bodies have 0.005 to 0.05, with viscous layers 0.1
MOST_HZ = 1e6  # a wave through a plate of 5 mm; residual modes stay below
LOWEST_HZ = 1e-3  # below it a frequency is the round-off of a rigid mode


@dataclass(frozen=True, slots=True, eq=False)
class Modes:
    """Modes of the body that are used, sorted by id.

    Attributes
    ----------
    mode : (m,) mode id
    frequency : (m,) natural frequency [Hz]
    damping_ratio : (m,) damping ratio, NaN where the file gives none [-]
    modal_mass : (m,) modal mass, 1 where the file gives none
    kind : (m,) normal, interface or rigid
    scale : (m,) factor on the forces of the mode where FE run and simulation normalise it differently [-]
    """

    mode: NDArray[np.int64]
    frequency: NDArray[np.float64]
    damping_ratio: NDArray[np.float64]
    modal_mass: NDArray[np.float64]
    kind: tuple[str, ...]
    scale: NDArray[np.float64]

    @property
    def vibration_hz(self) -> NDArray[np.float64]:
        """Frequencies of the normal modes [Hz]; rigid-body modes that the table takes for normal ones left out."""
        return vibration_hz(self.frequency, self.kind)


def vibration_hz(frequency: NDArray[np.float64], kind: Sequence[str]) -> NDArray[np.float64]:
    """Those of the frequencies of some modes that belong to normal ones above ``LOWEST_HZ`` [Hz]."""
    return np.asarray(frequency[(np.array(kind) == "normal") & (frequency > LOWEST_HZ)])


def read_modes(path: Path, ignore_modes: Collection[int], *, strict: bool) -> tuple[Modes, list[Problem]]:
    """Read ``mode``, ``frequency_hz`` and, where present, ``damping_ratio, modal_mass, kind, scale``."""
    table = open_table(path, texts=("kind",))
    table.expect(("mode", "frequency_hz"), ("damping_ratio", "modal_mass", "kind", "scale"), strict=strict)
    mode = table.integers("mode")
    frequency = table.numbers("frequency_hz", least=0.0).astype(np.float64)
    damping_ratio = table.numbers("damping_ratio", default=np.nan, least=0.0).astype(np.float64)
    modal_mass = table.numbers("modal_mass", default=1.0, above=0.0).astype(np.float64)
    kind = table.texts("kind", default="normal")
    table.choices("kind", kind, KINDS)
    scale = table.numbers("scale", default=1.0).astype(np.float64)
    table.report(scale == 0, "bad_value", "scale", "0 takes the mode out", "List the mode under ignore_modes instead")
    table.unique({"mode": mode})
    table.refuse()
    used = [i for i in np.argsort(mode) if mode[i] not in ignore_modes]
    if not used:
        raise DataError(Problem("no_modes", path.name, "ignore_modes leaves no mode", "Take modes out of ignore_modes"))
    modes = Modes(
        mode[used], frequency[used], damping_ratio[used], modal_mass[used], tuple(kind[i] for i in used), scale[used]
    )
    if "interface" not in modes.kind:
        table.warnings.append(
            Problem(
                "no_interface_mode",
                table.where("kind"),
                f"none of the {len(modes.kind)} modes is an interface mode, so welds near local loads lose most of "
                "their force",
                "Add residual or constraint modes to the FE run and to the simulation, or mark those present",
            )
        )
    return modes, table.warnings + _warnings(modes, path.name)


def _warnings(modes: Modes, file: str) -> list[Problem]:
    """Warnings about damping in per cent, and about frequencies that no body of a vehicle has; each kind once."""
    of_body = np.array(modes.kind) == "normal"  # interface modes may be damped as one likes
    of_body &= modes.frequency < DAMPED_AS_RULED
    damping = np.where(of_body, np.nan_to_num(modes.damping_ratio), 0.0)
    return [
        *_above("unusual_damping", f"{file}: column damping_ratio", modes, damping, MOST_DAMPING),
        *_above("unusual_frequency", f"{file}: column frequency_hz", modes, modes.frequency, MOST_HZ),
    ]


def _above(code: str, where: str, modes: Modes, values: NDArray[np.float64], most: float) -> list[Problem]:
    """Warning about values above what modes have, with the largest of them."""
    over = int(np.count_nonzero(values > most))
    if not over:
        return []
    worst = int(values.argmax())
    what = f"{values[worst]:g} of mode {modes.mode[worst]} is above {most:g}"
    what += f"; so are those of {over - 1} more" if over > 1 else ""
    remedy = "Give the ratio to critical damping, 2 % are 0.02" if most < 1.0 else "Give Hz, and check the modal basis"
    return [Problem(code, where, what, remedy, over)]
