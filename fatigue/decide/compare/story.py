"""Finished results beside the first of them: who lives longer, who shorter, and what exactly makes it.

Welds are matched by name, by a table of the user, or by where their lines lie; points by their places, faces by the
plate normals. Of each pair of points there is the ratio of the lives and, event by event and mode by mode, what makes
it: exact, with nothing left over. Nothing is counted again and nothing interpolated.
"""

from collections.abc import Sequence
from pathlib import Path

from fatigue.decide.beside_results import refuse_results
from fatigue.decide.compare.finished import LETTERS, read_results
from fatigue.decide.compare.folder import FILLED, inputs_of, write_compare
from fatigue.decide.compare.matched.welds import WeldMap, match_welds, read_map
from fatigue.decide.compare.pairs import pair_of
from fatigue.decide.compare.summary import Comparison
from fatigue.errors import CaseError, Problem, given_path, refuse
from fatigue.files.recorded import refuse_foreign
from fatigue.stages import stage


def compare(
    folders: Sequence[Path | str],
    *,
    weld_map: Path | str | None = None,
    accept_proposed: bool = False,
    into: Path | str | None = None,
    csv: bool = False,
    force: bool = False,
    no_lock: bool = False,
) -> Comparison:
    """Compare finished results with the first of them, and write tables and page into a folder where one is given.

    Parameters
    ----------
    folders : results of ``assess``, the reference first
    weld_map : table with the columns ``weld_a`` and ``weld_b``, of welds that the others name otherwise
    accept_proposed : take welds without a common name for one where their lines lie on each other
    into : folder for tables, page and record; None: nothing is written
    csv : write the tables as CSV as well
    force : overwrite files in it that are not ours
    no_lock : trust that no other run writes to the results

    Raises
    ------
    CaseError : fewer than two results, or one of them twice
    DataError : a folder without finished result, or a damaged one; no weld in common; a wrong map; files in the way
    """
    paths = [given_path(folder, "folders") for folder in folders]
    refuse(CaseError, _no_comparison(paths))
    folder = None if into is None else given_path(into, "into")
    map_file = None if weld_map is None else given_path(weld_map, "weld_map")
    if folder is not None:
        refuse_results(folder, paths)
    stage("reading results")
    results = read_results(paths, no_lock=no_lock)
    of_map = WeldMap() if map_file is None else read_map(map_file, results)
    if folder is not None:
        inputs = inputs_of(results) if map_file is None else [*inputs_of(results), map_file]
        refuse_foreign(folder, FILLED, force=force, inputs=inputs)
    first, pairs = results[0], []
    for other in results[1:]:
        stage("comparing %s with A", other.letter)
        pairs.append(pair_of(first, other, match_welds(first, other, of_map, accept_proposed=accept_proposed)))
    found = Comparison(tuple(results), tuple(pairs))
    if folder is None:
        return found
    stage("writing tables and page")
    written = write_compare(folder, found, csv=csv)
    return Comparison(found.results, found.pairs, tuple(str(folder / name) for name in written))


def _no_comparison(paths: Sequence[Path]) -> list[Problem]:
    """Refusal of too few or too many results, and of one that is given twice."""
    if not 2 <= len(paths) <= len(LETTERS):
        what = f"{len(paths)} result{'s are' if len(paths) != 1 else ' is'} given"
        return [Problem("argument", "folders", what, f"Give 2 to {len(LETTERS)} result folders, the reference first")]
    seen: dict[Path, int] = {}
    problems = []
    for number, path in enumerate(paths):
        first = seen.setdefault(path.resolve(), number)
        if first != number:
            what = f"is given twice, as {LETTERS[first]} and as {LETTERS[number]}"
            problems.append(Problem("argument", str(path), what, "Give each result once"))
    return problems
