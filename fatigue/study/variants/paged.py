"""A finished study as its page is made of it."""

from fatigue.study.page import Studied, Varied
from fatigue.study.study_file import Study
from fatigue.study.variants.summary import StudyFound
from fatigue.study.variants.varied.expansion import Plan


def studied(study: Study, plan: Plan, found: StudyFound) -> Studied:
    """What the page of a study tells."""
    base = study.base
    return Studied(
        title=study.title,
        vehicle=base.vehicle,
        case=base.case,
        source=source_in_words(study),
        combine=study.combine,
        varied=[
            Varied(a.name, tuple(sorted(a.keys)), tuple(dict.fromkeys(level.setting for level in (a.base, *a.levels))))
            for a in plan.aspects
        ],
        seeds=study.seeds,
        variants=found.variants,
        runs=found.runs,
        numbers=found.numbers,
        ratios=found.ratios,
        verdicts=found.verdicts,
        warnings=found.warnings,
    )


def source_in_words(study: Study) -> str:
    """Where the histories of a study come from, as the end of a sentence."""
    if study.is_builtin:
        return "rides of the vehicle of this program"
    if study.source.command is not None:
        return f"what the command {study.source.command!r} leaves"
    return "the case itself" if study.source.files is None else f"files that were there, {study.source.files}"
