"""What speaks for the numbers of a result, in one table: what was done, what it found, and what was not run."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from fatigue.report.result import ShownResult
from fatigue.report.sections.checks import Recomputed
from fatigue.report.sections.evidence.recount import read_recount
from fatigue.report.wording import listed, number, whole
from fatigue.results.beside.sensitivity import read_sensitivity

ENOUGH_SAMPLES = {"vertex": 8.0, "samples": 20.0}  # per peak, where reversals are read; docs/how-it-works.md
FROM = 1.0 - 1e-6  # of the enough ones


@dataclass(frozen=True, slots=True)
class Evidence:
    """One piece of evidence: what is looked at, how it stands (a key of ``SIGNS`` and ``WORDS``), and what was found.

    ``link`` leads to the part of the page that has more of it.
    """

    subject: str
    state: str
    finding: str
    link: str = ""


SIGNS = {"met": "✓", "doubt": "!", "missed": "✕", "open": "–", "none": "–"}
WORDS = {
    "met": "in order",
    "doubt": "look at it",
    "missed": "differs",
    "open": "not run",
    "none": "nothing on record",
}


def evidence(
    result: ShownResult, checks: Sequence[Recomputed], verification: Sequence[Mapping[str, Any]]
) -> list[Evidence]:
    """Everything that speaks for or against a result, in the order in which a reviewer asks."""
    record = result.record
    return [
        _recounted(read_recount(result.folder, record)),
        _recomputed(checks),
        _known(verification),
        _converted(record.get("conversion")),
        *_basis(record),
        _sampled(result),
        _ends(result),
        *_verdicts(result),
    ]


def _recounted(kept: Mapping[str, Any] | None) -> Evidence:
    subject = "Recount by independent code"
    if kept is None:
        return Evidence(subject, "open", "not run of this result: `fatigue verify --results DIR`, or `assess --verify`")
    points = f"{whole(kept['points'])} of {whole(kept['points_in_all'])} points counted again from the input files"
    columns, strangers = kept["columns"], len(kept["strangers"])
    wrong = [f"{column['table']}.{column['column']}" for column in columns if not column["passed"]]
    if kept["passed"]:
        worst = max((column["difference"] / column["tolerance"] for column in columns), default=0.0)
        finding = (
            f"{points}: all {len(columns)} columns agree, the largest difference is {worst:.2g} of the allowed one"
        )
        return Evidence(subject, "met", finding)
    found = [f"{listed(wrong[:3])} differ{'s' * (len(wrong) == 1)}"] if wrong else []
    found += [f"{strangers} files do not belong to the result"] if strangers else []
    return Evidence(subject, "missed", f"{points}: {listed(found)}")


def _recomputed(checks: Sequence[Recomputed]) -> Evidence:
    largest = max(check.difference for check in checks)
    state = "met" if all(check.agrees for check in checks) else "missed"
    words = f"damage of the worst points from their cycles and from their events: largest difference {largest:.1e}"
    return Evidence("Tables against each other", state, words, "trace")


def _known(verification: Sequence[Mapping[str, Any]]) -> Evidence:
    subject = "Known values"
    if not verification:
        return Evidence(subject, "open", "not computed for this page: `fatigue verify`")
    passed = sum(bool(check["passed"]) for check in verification)
    state = "met" if passed == len(verification) else "missed"
    words = f"{passed} of {len(verification)} closed forms and published values are met by the installed program"
    return Evidence(subject, state, words, "trace")


def _converted(conversion: Mapping[str, Any] | None) -> Evidence:
    subject = "Audit of the import"
    if conversion is None:
        return Evidence(subject, "none", "no conversion: the tables of the case were given as they are")
    lights = [str(row["light"]) for row in conversion["audit"]]
    counts = {light: lights.count(light) for light in dict.fromkeys(("red", "yellow", "green", *lights))}
    state = "missed" if counts["red"] else "doubt" if counts["yellow"] else "met"
    words = listed([f"{n} {light}" for light, n in counts.items() if n])
    looked_at = [str(row["check"]) for row in conversion["audit"] if row["light"] in ("red", "yellow")]
    return Evidence(subject, state, words + (f": {listed(looked_at)}" if looked_at else ""), "trace")


def _basis(record: Mapping[str, Any]) -> Iterator[Evidence]:
    kinds = [str(kind) for kind in record["modes"]["kind"]]
    modes = f"modes: {listed([f'{whole(kinds.count(kind))} {kind}' for kind in dict.fromkeys(kinds)])}"
    subject = "Modal basis"
    if set(kinds) != {"normal"}:
        words = f"{modes}; how complete it is for these welds says `fatigue basis CASE`, which is no part of a result"
        yield Evidence(subject, "open", words, "loads")
    else:
        yield Evidence(subject, "doubt", f"{modes}: welds near local loads lose most of their force", "warnings")


def _sampled(result: ShownResult) -> Evidence:
    subject, rules = "Sampling", result.record["rules"]
    enough = ENOUGH_SAMPLES.get(rules.get("reversals", "samples"), ENOUGH_SAMPLES["samples"])
    damaging = result.damage[result.damage["damage_per_pass"] > 0.0]
    samples = damaging["samples_per_peak"].dropna()
    if samples.empty:
        return Evidence(subject, "none", "samples per peak are not known: no spectrum, or nothing damages", "loads")
    at = damaging.loc[samples.idxmin()]
    state = "met" if float(samples.min()) >= enough * FROM else "doubt"
    words = (
        f"{number(samples.min(), 3)} samples per peak or more at the worst points as they were counted, least at "
        f"{at['weld']} in {at['event']}; {enough:g} are enough"
    )
    return Evidence(subject, state, words, "loads")


def _ends(result: ShownResult) -> Evidence:
    subject = "Weld ends"
    warnings = [one for one in result.record["warnings"] if one["code"] == "end_unresolved"]
    count = sum(int(one.get("count", 1)) for one in warnings)
    if count:
        words = f"at {whole(count)} weld{'s' * (count != 1)} the mesh does not resolve the end that is treated"
        return Evidence(subject, "doubt", words, "warnings-end_unresolved")
    return Evidence(subject, "met", "the mesh resolves every end that is treated")


def _verdicts(result: ShownResult) -> Iterator[Evidence]:
    found = read_sensitivity(result.folder, result.assessed)
    subject = "Verdict under other assumptions"
    if found is None:
        yield Evidence(subject, "none", "an older version made this result")
        return
    flipping = len(found.flipping)
    undecided = {str(weld) for rows in found.undecided.values() for weld in rows["weld"]}
    who = {0: "no weld changes its", 1: "1 weld changes its"}.get(flipping, f"{whole(flipping)} welds change their")
    words = f"{who} verdict when one assumption is changed"
    words += f"; not decided for {whole(len(undecided))} welds" if undecided else ""
    yield Evidence(subject, "doubt" if flipping or undecided else "met", words, "other-assumptions")
