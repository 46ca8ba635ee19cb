"""What the checks of a weld say of it: the worst of them, how many have no verdict, whether one that counts fails."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import Problem
from fatigue.pipeline.checks.rows import NOT_ASSESSED, CheckRows
from fatigue.shown import few

NAMED = 5  # welds in a warning


@dataclass(frozen=True, slots=True, eq=False)
class Verdicts:
    """Checks of w welds.

    Attributes
    ----------
    worst : (w,) check with the largest stress utilisation; empty: none was assessed
    utilisation : (w,) that utilisation; NaN: none was assessed
    not_assessed : (w,) rows of the table without a verdict
    failed : (w,) whether a check that counts is not fulfilled
    """

    worst: list[str]
    utilisation: NDArray[np.float64]
    not_assessed: NDArray[np.int64]
    failed: NDArray[np.bool_]


def verdicts(rows: CheckRows, welds: Sequence[str], counts: Collection[str]) -> Verdicts:
    """Verdicts of some welds by their rows; rows of other welds are passed over. ``counts``: checks that decide.

    The worst check is told by stress utilisation, 1 / the factor that the target leaves room for: a damage sum is its
    third to fifth power, and would put one check before another that fails under a smaller rise of the load.
    """
    worst, utilisation = [""] * len(welds), np.full(len(welds), np.nan)
    place = {weld: i for i, weld in enumerate(welds)}
    of_weld = np.array([place.get(name, -1) for name in rows["weld"].tolist()], dtype=np.int64)
    for row in np.flatnonzero((of_weld >= 0) & ~np.isnan(rows["utilisation_stress"])):
        weld, value = of_weld[row], rows["utilisation_stress"][row]
        if not value <= utilisation[weld]:  # the first, too, where there is none yet
            worst[weld], utilisation[weld] = str(rows["check"][row]), value
    return Verdicts(
        worst=worst,
        utilisation=utilisation,
        not_assessed=_count(of_weld[rows["fulfilled"] == NOT_ASSESSED], len(welds)),
        failed=_count(of_weld[fails(rows, counts)], len(welds)) > 0,
    )


def fails(rows: CheckRows, counts: Collection[str]) -> NDArray[np.bool_]:
    """Which rows are of a check that counts, and are not fulfilled."""
    return np.asarray(np.isin(rows["check"], list(counts)) & (rows["fulfilled"] == 0))


@dataclass(slots=True, eq=False)
class Decisive:
    """The checks that count, while their rows stream by.

    ``fulfilled`` as long as none of them fails; ``missing`` are the welds or points of each that have rows without a
    verdict, ``why`` the first note of them.
    """

    fulfilled: bool = True
    missing: dict[str, dict[str, None]] = field(default_factory=dict)
    why: dict[str, str] = field(default_factory=dict)

    def add(self, rows: CheckRows, counts: Collection[str]) -> None:
        """Take some rows in; ``counts`` are the checks that decide."""
        if not rows.size:  # nor does an empty array of a case without checks have the columns
            return
        self.fulfilled &= not fails(rows, counts).any()
        for row in rows[np.isin(rows["check"], list(counts)) & (rows["fulfilled"] == NOT_ASSESSED)]:
            check = str(row["check"])
            self.missing.setdefault(check, {})[str(row["weld"] or row["point"])] = None
            self.why.setdefault(check, str(row["note"]))

    def warnings(self, file: str) -> list[Problem]:
        """Warning about every check that counts and was not assessed somewhere: there it decides nothing."""
        warnings = []
        for check, names in self.missing.items():
            what = f"{check} counts, but is not assessed at {few(list(names), NAMED)}: {self.why[check]}"
            remedy = "Read the notes in checks.parquet: what is not assessed does not decide"
            warnings.append(Problem("check_not_assessed", f"{file}: checks.counts", what, remedy, len(names)))
        return warnings


def _count(weld: NDArray[np.int64], welds: int) -> NDArray[np.int64]:
    return np.bincount(weld[weld >= 0], minlength=welds)
