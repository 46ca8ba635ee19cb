"""One known value against what the installed program finds, and the table of all of them."""

from dataclasses import asdict, dataclass
from typing import Any


@dataclass(frozen=True, slots=True)
class Check:
    """A quantity of a case with a known answer.

    ``tolerance`` is relative to the expected value, absolute where that is 0; ``source`` is where the answer is from.
    """

    topic: str
    case: str
    quantity: str
    unit: str
    expected: float
    found: float
    tolerance: float
    source: str

    @property
    def difference(self) -> float:
        """Distance from the expected value, relative unless that is 0."""
        return abs(self.found - self.expected) / (abs(self.expected) or 1.0)

    @property
    def passed(self) -> bool:
        """Whether the difference is within the tolerance; NaN is not."""
        return self.difference <= self.tolerance


@dataclass(frozen=True, slots=True)
class VerificationTable:
    """All checks, in the order of the computation from nodal forces to kilometres."""

    checks: tuple[Check, ...]

    @property
    def passed(self) -> bool:
        """Whether every check passed."""
        return all(check.passed for check in self.checks)

    def as_record(self) -> dict[str, Any]:
        """Record for machines."""
        rows = [asdict(check) | {"difference": check.difference, "passed": check.passed} for check in self.checks]
        return {"passed": self.passed, "checks": rows}

    def as_text(self) -> str:
        """Text for people: one line for each check, the verdict last."""
        heading = ["topic", "case", "quantity", "expected", "found", "difference", "allowed", ""]
        cells = [heading]
        for check in self.checks:
            unit = "" if check.unit == "-" else f" {check.unit}"
            numbers = [
                f"{check.expected:.9g}{unit}",
                f"{check.found:.9g}",
                f"{check.difference:.1e}",
                f"{check.tolerance:.0e}",
            ]
            cells.append([check.topic, check.case, check.quantity, *numbers, "ok" if check.passed else "WRONG"])
        widths = [max(len(row[i]) for row in cells) for i in range(len(heading))]
        lines = [
            "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in cells
        ]
        missed = sum(not check.passed for check in self.checks)
        verdict = (
            f"all {len(self.checks)} checks passed" if not missed else f"{missed} of {len(self.checks)} checks FAILED"
        )
        return "\n".join([*lines, "", verdict])
