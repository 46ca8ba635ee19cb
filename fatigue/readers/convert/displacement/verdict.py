"""The comparison of a displacement as a row of the audit: light, numbers, likely cause, remedy."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from fatigue.readers.convert.audit.row import AuditRow, Light
from fatigue.readers.convert.displacement.causes import EXPLAINED, Cause
from fatigue.readers.convert.displacement.comparison import Comparison, best_fit
from fatigue.readers.convert.displacement.side_by_side import EventComparison
from fatigue.shown import few

CHECK = "displacement"
GREEN, RED = 0.03, 0.10  # rms error over rms of the displacement
STATIC = 0.05  # constant difference over rms of the displacement

_OF_MODES = frozenset({"mode sign", "mode order"})
"""Causes that are an error however little they change at this node."""


def judged(name: str, found: EventComparison, causes: tuple[Cause, ...], lacking: Sequence[int]) -> AuditRow:
    """Row of the audit that a comparison makes.

    Parameters
    ----------
    name : file, node and direction
    found : the event that the displacement fits best
    causes : what would explain the misfit alike
    lacking : elastic modes of the FE run without coordinates
    """
    c = found.comparison
    if c is None:
        said = f"; {causes[0].text}" if len(causes) == 1 else ""
        return AuditRow(CHECK, "red", None, f"{name}: {found.span}{said}", "Export both over the same time")
    where = f"{name}, {found.span}"
    if not np.isfinite(found.misfit):
        what = f"{where}: the displacement does not change and proves nothing"
        return AuditRow(CHECK, "amber", None, what, "Give a node that moves, and a direction in which it does")
    if c.summed_rms < 1e-6 * c.rms and not causes:
        what = f"{where}: it moves by {c.rms:.3g} mm rms, but no mode moves the node in this direction"
        return AuditRow(
            CHECK, "red", found.misfit, what, "Correct node or direction; at a constraint name another node"
        )
    if c.rms < 1e-6 * c.largest_rms:
        what = f"{where}: in this direction the node hardly moves, {c.rms:.3g} mm rms, which proves nothing"
        return AuditRow(CHECK, "amber", found.misfit, what, "Give a direction in which the node moves")
    light: Light = "green" if found.misfit <= GREEN else "amber" if found.misfit <= RED else "red"
    if causes and all(cause.kind in _OF_MODES for cause in causes):
        light = "red" if len(causes) == 1 or light == "red" else "amber"
    if light != "green":
        finding, remedy = _likely_cause(c, found.misfit, causes, lacking)
    else:
        finding, remedy = _proof(c), ""
        constant = float(c.measured.mean() - c.weight @ c.q.mean(axis=1))
        if abs(constant) > STATIC * c.rms:
            light, remedy = "amber", "Export displacement and coordinates from one reference state"
            position = ", as a position has" if abs(constant) > 10 * c.rms else ""
            finding += f"; but a constant difference of {constant:.4g} mm{position}: the static part is not proven"
    return AuditRow(CHECK, light, found.misfit, f"{where}: {_numbers(c, found.misfit)}; {finding}", remedy)


def _numbers(c: Comparison, misfit: float) -> str:
    """Scale, correlation and error of the displacement against the sum."""
    error = f"rms error {misfit:.2g} of the rms {c.rms:.3g} mm"
    if c.summed_rms < 1e-6 * c.rms:
        return error
    together = float(c.weight @ c.products[1])
    scale, correlation = together / c.summed_rms**2, together / (c.summed_rms * c.rms)
    return f"scale {scale:.4g}, correlation {correlation:.5g}, {error}"


def _likely_cause(c: Comparison, misfit: float, causes: tuple[Cause, ...], lacking: Sequence[int]) -> tuple[str, str]:
    """Likely cause of a misfit and its remedy, or what is known where no single cause is certain."""
    if len(causes) == 1:
        return f"likely cause: {causes[0].text} (error then {causes[0].misfit:.2g})", causes[0].remedy
    if causes:
        alike = "; or ".join(cause.text for cause in causes[:3])
        more = f"; or {len(causes) - 3} more" if len(causes) > 3 else ""
        return f"several causes would explain it alike: {alike}{more}", "Give a displacement of another node as well"
    fit, rest = best_fit(c)
    if fit <= min(EXPLAINED, misfit / 2):
        return (
            "other factors on the same modes explain it, which ones cannot be told from this node",
            "Compare units, signs and order of the modes; give a displacement of another node as well",
        )
    also = f"; modes {', '.join(map(str, lacking[:10]))} have no coordinates" if lacking else ""
    power = np.abs(np.fft.rfft(rest * np.hanning(rest.size)))
    at = int(power[1:].argmax()) + 1
    hertz = at / (rest.size * float(np.median(np.diff(c.time))))
    return (
        f"{fit:.2g} of it is no sum of these modes at this node, most of that near {hertz:.3g} Hz{also}",
        "Modes are missing in the coordinates (ignored ones?), it holds rigid motion, or node or direction are others",
    )


def _proof(c: Comparison) -> str:
    """Modes whose wrong sign this displacement would show, and the modes it says nothing about, in words."""
    seen = c.flipped > EXPLAINED
    shows = f"a wrong sign would show for mode{'s' if seen.sum() != 1 else ''} {_short(c.mode[seen])}"
    if seen.all():
        return shows
    if not seen.any():
        return "no single mode decides it"
    return f"{shows}, not for {_short(c.mode[~seen])}"


def _short(modes: NDArray[np.int64]) -> str:
    """Mode numbers as text, at most ten of them."""
    return few(modes.tolist(), 10)
