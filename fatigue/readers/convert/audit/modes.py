"""What the modes tell: interface modes, frequencies and generalised masses, and the frequencies of the simulation."""

import numpy as np

from fatigue.readers.convert.audit.row import AuditRow
from fatigue.readers.foreign.fe.results import FeResults
from fatigue.readers.neutral.body.modes import LOWEST_HZ

FREQUENCY_LIMIT = 0.01


def interface_rows(results: FeResults, marked: set[int]) -> list[AuditRow]:
    """Row on the interface modes: without them local welds lose nearly all of their force."""
    if results.analysis == "static":
        return []
    count = len(marked & set(results.mode.tolist()))
    if count:
        return [
            AuditRow(
                "interface modes",
                "green",
                float(count),
                f"{count} of {results.of_basis.sum()} modes are interface modes",
            )
        ]
    return [
        AuditRow(
            "interface modes",
            "amber",
            0.0,
            "no mode is marked as an interface (residual, constraint, attachment) mode",
            "Name them (--interface-modes); without them brackets and hangers lose most of their force",
        )
    ]


def unknown_frequency_rows(results: FeResults, marked: set[int]) -> list[AuditRow]:
    """Row on modes of vibration without a frequency, if there are any; static subcases have none by nature."""
    if results.analysis == "static":
        return []
    is_unknown = np.isnan(results.frequency) & ~np.isin(results.mode, sorted(marked))
    if not is_unknown.any():
        return []
    count, first = int(is_unknown.sum()), int(results.mode[is_unknown][0])
    return [
        AuditRow(
            "frequencies",
            "red",
            float(count),
            f"{count} of {results.mode.size} modes have no frequency, mode {first} the first: there is no eigenvalue "
            "summary, and no eigenvalue stands beside their shapes or forces",
            "Request DISPLACEMENT(PLOT) or the eigenvalue summary (LAMA) in the same file, or name modes that are "
            "static by nature as interface modes",
        )
    ]


def mass_rows(results: FeResults) -> list[AuditRow]:
    """Row on the generalised masses, which a simulation may have normalised otherwise."""
    mass = results.modal_mass[np.isfinite(results.modal_mass)]
    if not mass.size:
        return []
    low, high = float(mass.min()), float(mass.max())
    if abs(low - 1) < 1e-3 and abs(high - 1) < 1e-3:
        return [AuditRow("generalised mass", "green", 1.0, "all modes have unit generalised mass")]
    return [
        AuditRow(
            "generalised mass",
            "amber",
            high,
            f"generalised masses from {low:.4g} to {high:.4g}",
            "Give the simulation's generalised masses if it normalises otherwise",
        )
    ]


def frequency_match_rows(results: FeResults, simulated: dict[int, float] | None) -> list[AuditRow]:
    """Row on the frequencies of both sides, compared mode by mode."""
    if not simulated:
        return []
    pairs = [
        (int(m), f, simulated[int(m)])
        for m, f in zip(results.mode, results.frequency, strict=True)
        if int(m) in simulated
    ]
    misses = [(abs(s - f) / max(f, LOWEST_HZ), m, f, s) for m, f, s in pairs if f > LOWEST_HZ]
    if not misses:
        return [
            AuditRow("frequency match", "amber", None, "no mode has a frequency on both sides", "Compare them by hand")
        ]
    worst, mode, ours, theirs = max(misses)
    finding = f"mode {mode}: {ours:.4g} Hz in the forces, {theirs:.4g} Hz in the simulation, worst of {len(misses)}"
    if worst <= FREQUENCY_LIMIT:
        return [AuditRow("frequency match", "green", worst, finding)]
    return [
        AuditRow(
            "frequency match", "red", worst, finding, "Map the coordinates to the right modes, or use one modal basis"
        )
    ]
