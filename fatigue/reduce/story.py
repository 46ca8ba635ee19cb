"""The story of a reduction: a finite element body in, a neutral folder of modes and weld forces out."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from numbers import Real
from pathlib import Path
from typing import get_args

from fatigue.errors import CaseError, DataError, Problem, given_path, refuse
from fatigue.files.hashes import sha256
from fatigue.files.recorded import refuse_foreign
from fatigue.flexbody.rounding import few_digits
from fatigue.readers.neutral.body.interface_shapes import DIRECTIONS
from fatigue.reduce.bases import Name, Recipe, Reduced, reduce_to
from fatigue.reduce.case_text import CASE, case_text
from fatigue.reduce.folder import EDITABLE, FILLED, Content, edited_case, write_folder
from fatigue.reduce.interface import (
    InterfacePoint,
    missing_directions,
    missing_nodes,
    read_interface,
    rotations_at_shells,
)
from fatigue.reduce.model import Model, read_given
from fatigue.reduce.summary import Reduction, rigid_body, stiff_points
from fatigue.reduce.tables import (
    ELEMENTS,
    FLEXIBILITY,
    FORCES,
    MODES,
    NODES,
    OBSERVED_SHAPES,
    POINTS,
    SHAPES,
    Modes,
    elements_table,
    flexibility_table,
    forces_table,
    modes_table,
    nodes_table,
    points_table,
    shapes_table,
)
from fatigue.stages import stage
from fatigue.vehicle.elastic import default_damping

RULE = (
    "damping_ratio is a rule and no property of the body: 1.5 % below 100 Hz, 10 % up to 1000 Hz, 100 % above "
    "(--damping none leaves it out)"
)


def reduce(
    model: Path | str,
    interface: Path | str,
    into: Path | str,
    recipe: Recipe | None = None,
    *,
    properties: Path | str | None = None,
    welds: Path | str | None = None,
    units: str = "mm-t-s",
    damping: bool = True,
    force: bool = False,
    strict: bool = False,
) -> Reduction:
    """Reduce a body to a basis and write its folder.

    Parameters
    ----------
    model : folder of shells (``nodes, elements, properties``, and ``welds, weld_nodes, weld_elements``), or of matrices
        (``K, M, dof``)
    interface : table ``name, node, side, components`` and optional ``pattern``
    into : folder for the tables, made if it is not there
    recipe : which basis, up to which frequency
    properties : table of properties in place of that of the model
    welds : folder of the tables of welds, by default that of the model
    units : of K and M
    damping : write a damping ratio by the default rule
    force : overwrite files that are not ours
    strict : take unknown columns for errors

    Raises
    ------
    CaseError, DataError : everything wrong with options, tables and matrices; files in the way in the folder
    NumericalError : the iteration for modes found no end
    """
    recipe = recipe or Recipe()
    refuse(CaseError, _senseless(recipe))
    model, interface, folder = given_path(model, "model"), given_path(interface, "interface"), given_path(into, "into")
    properties = None if properties is None else given_path(properties, "properties")
    welds = None if welds is None else given_path(welds, "welds")
    refuse_foreign(folder, FILLED, force=force, inputs=_inputs(model, interface, properties, welds), editable=EDITABLE)
    points, warnings = read_interface(interface, strict=strict)
    given = read_given(model, properties, welds, units, strict=strict)
    warnings += given.warnings
    refuse(DataError, missing_nodes(points, given.structure.node, interface.name, f"the model {model}"))
    refuse(DataError, missing_directions(points, given.structure, interface.name))
    if given.body is not None:
        warnings += rotations_at_shells(points, interface.name)
    reduced = reduce_to(given.structure, points, recipe)
    modes = Modes(reduced.basis, default_damping(reduced.basis.frequency) if damping else None)
    stage("weld forces and shapes of points")
    keep_case = not force and given.welds is not None and edited_case(folder)
    notes = [RULE] * damping + [f"{folder / CASE} was edited: it stays as it is"] * keep_case
    files = _files(given, points, reduced, modes, f"{model.resolve().name}, {recipe.name} basis")
    done = Reduction(
        folder,
        recipe,
        rigid_body(given.structure),
        points,
        reduced,
        () if given.welds is None else given.welds.lines.weld,
        0 if given.welds is None else int(given.welds.lines.node.size),
        tuple(notes),
        (
            *warnings,
            *few_digits(given.structure, float(reduced.basis.frequency[0]), f"K of {model.name}"),
            *_doubtful(recipe, reduced, points),
            *given.notes,
        ),
    )
    stage("writing")
    record = {
        "model": model.name,
        "units": units,
        "damping": "rule" if damping else "none",
        "inputs": {path.name: sha256(path) for path in (*given.files, interface)},
        **done.as_record(),
    }
    return replace(done, files=write_folder(folder, files, record, keep_case=keep_case))


def _files(
    given: Model, points: Sequence[InterfacePoint], reduced: Reduced, modes: Modes, title: str
) -> dict[str, Content]:
    """What goes into the folder, by name."""
    loaded, observed = [p for p in points if p.is_loaded], [p for p in points if not p.is_loaded]
    files: dict[str, Content] = {
        MODES: modes_table(modes),
        POINTS: points_table(points, given.structure),
        SHAPES: shapes_table(loaded, given.structure, modes),
        FLEXIBILITY: flexibility_table(loaded, reduced.static),
    }
    if observed:
        files[OBSERVED_SHAPES] = shapes_table(observed, given.structure, modes)
    if given.welds is not None and given.body is not None and given.mesh is not None:
        files[FORCES] = forces_table(given.welds, given.body, modes)
        files |= {NODES: nodes_table(given.mesh), ELEMENTS: elements_table(given.mesh)}
        files |= {path.name: path for path in given.welds.files[:2]}
        names = tuple(path.name for path in given.welds.files[:2])
        files[CASE] = case_text(title, names, float(given.body.E.max()))
    return files


def _doubtful(recipe: Recipe, reduced: Reduced, points: Sequence[InterfacePoint]) -> Iterator[Problem]:
    """Warnings about what the basis lost."""
    if reduced.dropped:
        what = f"{reduced.dropped} columns above {recipe.keep_hz:g} Hz were left out: they carry static force"
        remedy = "Keep all columns: a vehicle that swings slowly needs them as springs"
        yield Problem("columns_dropped", "--keep-hz", what, remedy, reduced.dropped)
    keys = [(p.name, DIRECTIONS[d]) for p in points if p.is_loaded for d in p.directions]
    yield from stiff_points(keys, reduced.kept)


def _inputs(model: Path, *others: Path | None) -> list[Path]:
    """Everything that is read: the files of the folders, and tables given by themselves."""
    inputs: list[Path] = []
    for path in (model, *others):
        if path is not None:
            inputs += sorted(path.iterdir()) if path.is_dir() else [path]
    return [path for path in inputs if path.is_file()]


def _senseless(recipe: Recipe) -> Iterator[Problem]:
    """Refusals of options that say nothing."""
    if recipe.name not in get_args(Name):
        what = f"there is no basis {recipe.name!r}"
        yield Problem("unknown_basis", "basis", what, f"Name one of {', '.join(get_args(Name))}")
    given = {"cut_hz": recipe.cut_hz, "keep_hz": recipe.keep_hz, "kuhar_hz": recipe.kuhar_hz}
    for name, value in given.items():
        if value is not None and not (isinstance(value, Real) and 0.0 < value < float("inf")):
            yield Problem("bad_frequency", name, f"{value!r} is no frequency", "Give Hz, above 0")
    if recipe.name == "kuhar" and recipe.kuhar_hz is None:
        what = "the dynamic condensation of Kuhar is exact at one frequency, which is not given"
        yield Problem("no_frequency", "kuhar_hz", what, "Give --kuhar-hz, as the frequency of the first mode")
    if recipe.name != "kuhar" and recipe.kuhar_hz is not None:
        what = f"it is the frequency of the basis kuhar, and {recipe.name} is asked for"
        yield Problem("needless_frequency", "kuhar_hz", what, "Leave it out, or take --basis kuhar")
