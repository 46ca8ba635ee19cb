"""A study as a story: its file, its variants, every value tried; then the runs, side by side; then tables and page.

What is finished stays where it is: the same command goes on from there, and after a change of the study it runs what
the change concerns.
"""

from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from dataclasses import asdict, replace
from difflib import get_close_matches
from fnmatch import fnmatchcase
from pathlib import Path

from threadpoolctl import threadpool_limits

from fatigue.errors import CaseError, DataError, Problem, given_names, given_path, no_threads, refuse
from fatigue.files.hashes import sha256
from fatigue.files.naming import missing_file
from fatigue.results.dictionary.claims import CLAIMED
from fatigue.results.dictionary.study import STUDY
from fatigue.results.lock import locked
from fatigue.stages import stage
from fatigue.study.claims import Claim, claim_rows, claim_seed_rows, read_claims, refuse_unplaced, verdicts
from fatigue.study.page import study_page
from fatigue.study.study_file import Study, load_study
from fatigue.study.variants.dry import DryRun, dry_run
from fatigue.study.variants.folder import begin, left_over, refuse_foreign, write_study
from fatigue.study.variants.graphed import graphed
from fatigue.study.variants.paged import studied
from fatigue.study.variants.ratios import ratio_rows
from fatigue.study.variants.runs.case_of_run import body_files
from fatigue.study.variants.runs.gathered import Gathered, gathered
from fatigue.study.variants.runs.outcomes import outcomes
from fatigue.study.variants.runs.planned_runs import PlannedRun, planned_runs
from fatigue.study.variants.scatter import scatter_rows
from fatigue.study.variants.summary import StudyFound
from fatigue.study.variants.tables import Tables, run_rows, variant_rows
from fatigue.study.variants.varied.base_files import BaseFiles
from fatigue.study.variants.varied.checked import key_problems, placeholder_problems
from fatigue.study.variants.varied.expansion import Plan, expanded

Progress = Callable[[str, int, int], None]


def run_study(
    study: Study | Path | str,
    folder: Path | str,
    *,
    only: str | Sequence[str] = (),
    threads: int | None = None,
    force: bool = False,
    csv: bool = False,
    no_lock: bool = False,
    progress: Progress = lambda label, done, total: None,
) -> StudyFound:
    """Run every variant of a study under every seed, and lay their numbers beside each other.

    Parameters
    ----------
    study : the study or its file
    folder : where runs, tables and page go; finished runs in it are not computed again
    only : names of variants, or patterns of them, that are run; of the others what is finished is used
    threads : runs at a time, by default one per processor core; the bytes of the tables do not depend on it
    force : overwrite files in the folder that are not ours
    csv : write the tables as CSV as well
    no_lock : for a file system without locks, see ``fatigue.assess``
    progress : called with a label, runs done and runs in all

    Raises
    ------
    CaseError, DataError : every mistake of the study and its files; files in the way in the folder. A run that fails
        later is told in what is returned
    """
    refuse(CaseError, no_threads(threads))
    study = study if isinstance(study, Study) else load_study(study)
    folder = given_path(folder, "folder")
    stage("trying every variant of the study")
    files, plan, claims = planned_study(study)
    asked = _chosen(plan, given_names(only, "only"))
    inputs = [study.resolve(name) for name in _inputs(study)]
    refuse_foreign(folder, force=force, inputs=inputs)
    runs = planned_runs(study, files, plan, folder)
    refuse(DataError, _missing_files(runs))
    with locked(folder, no_lock=no_lock), threadpool_limits(limits=1, user_api="blas"):
        refuse_foreign(folder, force=force, inputs=inputs)
        begin(folder)
        of_runs = gathered(study, runs, outcomes(study, files, runs, asked, threads, progress))
        of_graph = tuple(graphed(claims, files, plan, study.seeds))
        of_runs = replace(of_runs, numbers=(*of_runs.numbers, *of_graph))
        return _written(study, plan, claims, of_runs, folder, csv=csv)


def listed_study(study: Study | Path | str, folder: Path | str, only: str | Sequence[str] = ()) -> DryRun:
    """What a study would run, with what each run sets; nothing is run or written.

    Raises
    ------
    CaseError, DataError : as ``run_study``
    """
    study = study if isinstance(study, Study) else load_study(study)
    files, plan, _ = planned_study(study)
    asked = _chosen(plan, given_names(only, "only"))
    runs = planned_runs(study, files, plan, given_path(folder, "folder"))
    refuse(DataError, _missing_files(runs))
    return dry_run(study, [run for run in runs if run.variant in asked])


def planned_study(study: Study) -> tuple[BaseFiles, Plan, tuple[Claim, ...]]:
    """Files, variants and claims of a study, every value tried.

    Raises
    ------
    CaseError : every mistake, of values before those of claims
    """
    files = BaseFiles(study)
    refuse(CaseError, _base_problems(files))
    plan = expanded(study, files.value)
    refuse(CaseError, [*key_problems(study, files, plan), *placeholder_problems(study, plan)])
    claims = read_claims(study.claim, study.seeds, study.path.name)
    keys = {aspect.name: next(iter(aspect.keys)) for aspect in plan.aspects if len(aspect.keys) == 1}
    refuse_unplaced(claims, [one.variant for one in plan.variants], keys=keys, file=study.path.name)
    return files, plan, claims


def _written(
    study: Study, plan: Plan, claims: Sequence[Claim], of_runs: Gathered, folder: Path, *, csv: bool
) -> StudyFound:
    """Write tables, page and record of what the runs came to."""
    variants = tuple(planned.variant for planned in plan.variants)
    found = StudyFound(
        title=study.title,
        variants=variants,
        runs=of_runs.runs,
        numbers=of_runs.numbers,
        scatter=tuple(scatter_rows(of_runs.numbers)),
        ratios=tuple(ratio_rows(variants, of_runs.numbers)),
        verdicts=verdicts(claims, variants, of_runs.numbers, study.seeds),
        warnings=of_runs.warnings,
        failures=of_runs.failures,
        exit_code=of_runs.exit_code,
        reused=of_runs.reused,
        left_over=tuple(left_over(folder, [run.folder for run in of_runs.runs])),
    )
    stage("writing tables and page")
    record = {
        "title": study.title,
        "seeds": list(study.seeds),
        "inputs": {name: sha256(study.resolve(name)) for name in _inputs(study)},
        "variants": [{"name": p.variant.name, "folder": p.folder, "changes": dict(p.changes)} for p in plan.variants],
        "warnings": [asdict(problem) for problem in found.warnings],
        "failures": [asdict(problem) for problem in found.failures],
    }
    page = study_page(studied(study, plan, found))
    written = write_study(folder, _tables(plan, found, folder), page, record, csv=csv)
    return replace(found, written=tuple(str(folder / name) for name in written))


def _tables(plan: Plan, found: StudyFound, folder: Path) -> Tables:
    """Rows of every table; those of claims where there are any."""
    tables: Tables = {
        "variants": (STUDY["variants"], list(variant_rows(plan))),
        "runs": (STUDY["runs"], run_rows(found.runs, folder)),
        "numbers": (STUDY["numbers"], found.numbers),
        "scatter": (STUDY["scatter"], found.scatter),
        "ratios": (STUDY["ratios"], found.ratios),
    }
    if not found.verdicts:
        return tables
    claimed: Tables = {
        "claims": (CLAIMED["claims"], claim_rows(found.verdicts)),
        "claim_seeds": (CLAIMED["claim_seeds"], claim_seed_rows(found.verdicts)),
    }
    return {**tables, **claimed}


def _base_problems(files: BaseFiles) -> Iterator[Problem]:
    """Mistakes of vehicle and case as they are."""
    for read in (lambda: files.vehicle, lambda: files.case):
        try:
            read()
        except CaseError as error:
            yield from error.problems


def _inputs(study: Study) -> Iterator[str]:
    """Files that the study names, and its own: none of them is overwritten."""
    yield study.path.name
    yield from filter(None, (study.base.vehicle, study.base.case, *study.source.inputs))


def _chosen(plan: Plan, only: Collection[str]) -> set[str]:
    """Names of the variants that are to be run.

    Raises
    ------
    CaseError : a name, or a pattern, of none
    """
    names = [planned.variant.name for planned in plan.variants]
    if not only:
        return set(names)
    refuse(CaseError, _unknown_names(only, names))
    return {name for name in names for wanted in only if name == wanted or fnmatchcase(name, wanted)}


def _unknown_names(only: Iterable[str], names: Sequence[str]) -> Iterator[Problem]:
    for wanted in only:
        if not any(name == wanted or fnmatchcase(name, wanted) for name in names):
            near = get_close_matches(wanted, names, n=1)
            remedy = f"Write {near[0]!r}" if near else f"Name one of {', '.join(map(repr, names))}"
            yield Problem("unknown_variant", "--only", f"the study has no variant {wanted!r}", remedy)


def _missing_files(runs: Sequence[PlannedRun]) -> Iterator[Problem]:
    """Refusals of files that cases name and that no source makes; each of them once."""
    seen: set[Path] = set()
    for run in runs:
        if run.case is None:
            continue
        case = run.case.case
        made = {event for asked in run.asked.values() for event in asked.files}
        for key, path in body_files(case, made).items():
            if path not in seen and not path.is_file():
                yield missing_file(path, f"{case.path.name}: {key}", base=case.path.parent)
            seen.add(path)
