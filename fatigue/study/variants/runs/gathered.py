"""What the runs of a study came to: numbers of all of them, also empty ones with a reason, warnings and failures."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from math import nan

from fatigue.errors import FatigueError, Problem
from fatigue.study.quantities import Number, StudyRun
from fatigue.study.study_file import Study
from fatigue.study.variants.runs.outcomes import Failed, Outcome
from fatigue.study.variants.runs.planned_runs import PlannedRun, has_source
from fatigue.study.variants.runs.run import Done

NOT_RUN = "it was not asked for, and no earlier command finished it"


@dataclass(frozen=True, slots=True)
class Gathered:
    """Runs and numbers in the order of the study; ``warnings`` are one of each kind, ``failures`` all there are."""

    runs: tuple[StudyRun, ...]
    numbers: tuple[Number, ...]
    warnings: tuple[Problem, ...]
    failures: tuple[Problem, ...]
    exit_code: int
    reused: int


def gathered(study: Study, runs: Sequence[PlannedRun], outcomes: Sequence[Outcome]) -> Gathered:
    """What the runs came to."""
    pairs = list(zip(runs, outcomes, strict=True))
    failed = [outcome.error for _, outcome in pairs if isinstance(outcome, Failed)]
    warnings = [*_of_runs(pairs), *_seeds_alike(study, pairs), *_variants_alike(study, pairs)]
    codes = [error.exit_code for error in failed]
    return Gathered(
        runs=tuple(_run(run, outcome) for run, outcome in pairs),
        numbers=tuple(_numbers(pairs)),
        warnings=tuple(warnings),
        failures=tuple(_failures(pairs)),
        exit_code=max(codes, default=0),
        reused=sum(isinstance(outcome, Done) and outcome.reused for _, outcome in pairs),
    )


def _run(run: PlannedRun, outcome: Outcome) -> StudyRun:
    sources = {asked.event: folder for folder, asked in run.asked.items()}
    if isinstance(outcome, Done):
        return StudyRun(run.variant, run.seed, run.folder, sources, "done")
    reason = _why(outcome.error) if isinstance(outcome, Failed) else NOT_RUN
    return StudyRun(
        run.variant, run.seed, run.folder, sources, "failed" if isinstance(outcome, Failed) else "not run", reason
    )


def _why(error: FatigueError) -> str:
    """Why a run failed, in one line."""
    first, *others = error.problems
    more = f" (and {len(others)} more)" if others else ""
    return f"{first.where}: {first.what}{more}"


def _numbers(pairs: Sequence[tuple[PlannedRun, Outcome]]) -> Iterator[Number]:
    """Numbers of every run; one without has the quantities of the others, empty, with the reason."""
    done = [outcome for _, outcome in pairs if isinstance(outcome, Done)]
    units = {(n.quantity, n.weld): n.unit for outcome in done for n in outcome.numbers}
    for run, outcome in pairs:
        if isinstance(outcome, Done):
            yield from outcome.numbers
            continue
        reason = f"the run failed: {_why(outcome.error)}" if isinstance(outcome, Failed) else f"not run: {NOT_RUN}"
        for (quantity, weld), unit in units.items():
            yield Number(run.variant, run.seed, quantity, weld, nan, unit, reason)


def _failures(pairs: Sequence[tuple[PlannedRun, Outcome]]) -> Iterator[Problem]:
    """What every failed run says, with the run before it."""
    for run, outcome in pairs:
        if isinstance(outcome, Failed):
            for problem in outcome.error.problems:
                where = problem.where if run.place in problem.where else f"{run.place}: {problem.where}"
                yield replace(problem, where=where)


def _of_runs(pairs: Sequence[tuple[PlannedRun, Outcome]]) -> Iterator[Problem]:
    """Warnings of the runs: the first of each kind, and one that stands for the others."""
    kinds: dict[str, list[tuple[PlannedRun, Problem]]] = {}
    for run, outcome in pairs:
        for problem in outcome.warnings if isinstance(outcome, Done) else ():
            kinds.setdefault(problem.code, []).append((run, problem))
    for code, (first, *others) in kinds.items():
        run, problem = first
        yield replace(problem, where=f"{run.place}: {problem.where}")
        if others:
            runs = {run.place for run, _ in (first, *others)}
            what = f"{len(others)} more of this kind in {len(runs)} run{'s' * (len(runs) != 1)}"
            remedy = "See provenance.json of their results"
            yield Problem(code, f"{run.place} and others", what, remedy, sum(one.count for _, one in others))


def _seeds_alike(study: Study, pairs: Sequence[tuple[PlannedRun, Outcome]]) -> Iterator[Problem]:
    """Warning of seeds under which the source gave the same histories, byte for byte."""
    if len(study.seeds) < 2 or study.base.case is None:
        return
    found = []
    for name, of in _by_variant(pairs).items():
        seen: dict[tuple[tuple[str, str], ...], int] = {}
        for run, done in of:
            other = seen.setdefault(tuple(sorted(done.histories.items())), run.seed)
            if other != run.seed:
                found.append((name, other, run.seed))
                break
    if found:
        name, one, two = found[0]
        what = f"seeds {one} and {two} of variant '{name}' have the same histories, byte for byte"
        remedy = "Give one seed: the case has its histories whatever the seed"
        if has_source(study):
            remedy = "Hand {seed} on to the source, or give one seed"
        yield Problem("seeds_alike", f"{study.path.name}: seeds", what, remedy, len(found))


def _variants_alike(study: Study, pairs: Sequence[tuple[PlannedRun, Outcome]]) -> Iterator[Problem]:
    """Warning of variants all of whose numbers are those of the base: what they set has no effect."""
    by_variant = _by_variant(pairs)
    base, *others = by_variant.items() if by_variant else [("", [])]
    numbers = {run.seed: _values(done) for run, done in base[1]}
    same = []
    for name, of in others:
        own = {run.seed: _values(done) for run, done in of}
        common = own.keys() & numbers.keys()
        if common and all(own[seed] and own[seed] == numbers[seed] for seed in common):
            same.append(name)
    if same:
        what = f"all numbers of variant '{same[0]}' are those of variant '{base[0]}'"
        remedy = "Look whether what it sets reaches the source, or leave it out"
        yield Problem("variants_alike", study.path.name, what, remedy, len(same))


def _values(done: Done) -> list[tuple[str, str, str]]:
    return [(number.quantity, number.weld, repr(number.value)) for number in done.numbers]


def _by_variant(pairs: Iterable[tuple[PlannedRun, Outcome]]) -> dict[str, list[tuple[PlannedRun, Done]]]:
    found: dict[str, list[tuple[PlannedRun, Done]]] = {}
    for run, outcome in pairs:
        of = found.setdefault(run.variant, [])
        if isinstance(outcome, Done):
            of.append((run, outcome))
    return found
