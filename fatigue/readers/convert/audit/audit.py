"""What can be known about foreign force files before they are believed: sign, balance, frames, completeness.

Every check gives a traffic light, a number and a remedy. The checks need no trust in the solver: stiffness forces of an
element are in equilibrium, a mode shape does the work of its own strain energy on them, and the rows of a grid point
force balance add up to the total that the file states.
"""

from collections.abc import Iterable
from dataclasses import dataclass

from fatigue.readers.convert.audit.completeness import completeness_row
from fatigue.readers.convert.audit.element_balance import balance_row, frames_row
from fatigue.readers.convert.audit.grid_totals import totals_row
from fatigue.readers.convert.audit.modes import (
    frequency_match_rows,
    interface_rows,
    mass_rows,
    unknown_frequency_rows,
)
from fatigue.readers.convert.audit.row import AuditRow
from fatigue.readers.convert.audit.sign_proof import sign_row
from fatigue.readers.foreign.fe.model import FeModel, to_basic
from fatigue.readers.foreign.fe.results import FeResults
from fatigue.readers.neutral.forces.convention import Convention


@dataclass(frozen=True, slots=True)
class Audit:
    """All checks of one force file, and what follows from them.

    Attributes
    ----------
    convention : sign of the forces that the checks support; None: undecided
    grounded_drilling : whether shells are out of balance by nothing but their moments about their own normals
    """

    rows: tuple[AuditRow, ...]
    convention: Convention | None
    grounded_drilling: bool = False

    @property
    def red(self) -> tuple[AuditRow, ...]:
        """The checks that failed."""
        return tuple(row for row in self.rows if row.light == "red")


def audit(
    results: FeResults,
    model: FeModel,
    stated: Convention | None = None,
    interface_modes: Iterable[int] = (),
    simulated: dict[int, float] | None = None,
) -> Audit:
    """Audit of grid point forces against their model, and against the simulation's modes.

    Parameters
    ----------
    results, model : as read, in the file's own units and displacement frames
    stated : sign convention claimed by the user
    interface_modes : modes marked as static (residual, constraint, attachment) modes
    simulated : frequency [Hz] of every mode in the simulation, where its file tells
    """
    force = to_basic(results.force, results.node, model)
    sign, convention = sign_row(results, model, stated)
    balanced, grounded_drilling = balance_row(results, model, force)
    rows = [
        balanced,
        frames_row(results, model, force),
        totals_row(results, convention),
        sign,
        completeness_row(results, model),
        *interface_rows(results, set(interface_modes)),
        *unknown_frequency_rows(results, {*interface_modes, *results.static_modes}),
        *mass_rows(results),
        *frequency_match_rows(results, simulated),
    ]
    return Audit(tuple(rows), convention, grounded_drilling)
