"""Loads that are not there: a weld, a mode, the moments or a whole component at zero looks like a weld that is safe.

A case is consistent without them, and every formula gives its zero. So what is zero is compared with the rest of the
body: a force that other welds have, a component that a spatial body has. What a plane model leaves out is no doubt:
several components at once.
"""

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from fatigue.errors import Problem
from fatigue.pipeline.solve.body import Body
from fatigue.readers.neutral.body.coordinates import Coordinates
from fatigue.readers.neutral.body.modes import LOWEST_HZ, Modes
from fatigue.readers.neutral.forces.convention import COMPONENTS
from fatigue.shown import few
from fatigue.weld.load_extent import LoadExtent, of_welds

NEXT_TO_NOTHING = 1e-6  # of the line force of the median weld, in every mode: a million times less is no load case
FEWEST_MODES = 3  # with fewer, a test load along one axis may leave out components of a plane model


def load_warnings(body: Body, extents: Sequence[LoadExtent]) -> list[Problem]:
    """Warnings about loads that are not there in the whole body, each kind once; ``extents`` has all its welds."""
    forces = body.case.body.nodal_forces or body.case.body.element_forces or ""
    return list(_warnings(of_welds(list(extents)), body.coordinates, forces))


def _warnings(found: LoadExtent, coordinates: Coordinates, file: str) -> Iterator[Problem]:
    zero = np.asarray(~found.largest.any(axis=1))
    if zero.all():
        what, remedy = "all forces of all welds are zero", "Request the forces of the elements at the welds"
        yield Problem("no_weld_force", file, what, remedy, zero.size)
        return
    names = np.array(found.weld, dtype=object)
    yield from _weld_warnings(found, coordinates, names, zero, file)
    yield from _mode_warnings(found, coordinates.modes, file)
    yield from _unit_load_warnings(found, coordinates)
    yield from _component_warnings(found, coordinates, names, zero, file)
    yield from _node_warnings(found, coordinates, names, zero, file)


def _weld_warnings(
    found: LoadExtent, coordinates: Coordinates, names: NDArray[np.object_], zero: NDArray[np.bool_], file: str
) -> Iterator[Problem]:
    """Warnings about welds without any force, or with next to none."""
    if zero.any():
        what = "all forces of the weld are zero in every mode, so it has no stress and no damage"
        what += f"; so are those of {few(names[zero][1:].tolist())}" if np.count_nonzero(zero) > 1 else ""
        remedy = "Request the forces of the elements on its assessed side, or exclude the weld"
        yield Problem("no_weld_force", f"{file}: weld {names[zero][0]}", what, remedy, int(np.count_nonzero(zero)))
    bends = np.array([kind != "rigid" for kind in coordinates.kind])
    line_force = found.line_force[~zero][:, bends] if bends.any() else found.line_force[~zero]
    median = np.median(line_force, axis=0)
    if len(line_force) < 2 or not median.any():
        return
    with np.errstate(invalid="ignore"):
        share = np.nan_to_num(line_force[:, median > 0.0] / median[median > 0.0], nan=1.0).max(axis=1)
    small = np.flatnonzero(share < NEXT_TO_NOTHING)[np.argsort(share[share < NEXT_TO_NOTHING], kind="stable")]
    if small.size:
        some = names[~zero][small]
        what = f"the line force is at most {share[small[0]]:.2g} of that of the median weld in every mode, below "
        what += f"{NEXT_TO_NOTHING:g}: round-off, forces in another unit, or of the wrong elements"
        what += f"; likewise {few(some[1:].tolist())}" if small.size > 1 else ""
        remedy = "Check units and output request of the forces; exclude the weld if nothing loads it"
        yield Problem("small_weld_force", f"{file}: weld {some[0]}", what, remedy, small.size)


def _mode_warnings(found: LoadExtent, modes: Modes, file: str) -> Iterator[Problem]:
    """Warning about modes that bend the body and no weld; interface modes of a body held statically bend nothing."""
    vibrates = (np.array(modes.kind) == "normal") & (modes.frequency > LOWEST_HZ)
    lost = modes.mode[vibrates & ~found.line_force[:, : vibrates.size].any(axis=0)].tolist()
    if lost:
        what = f"all forces of normal mode {few(lost)} are zero at every weld, so its movement does no damage"
        remedy = "Request the forces of every mode, or list the mode under ignore_modes"
        yield Problem("no_mode_force", f"{file}: mode {lost[0]}", what, remedy, len(lost))


def _unit_load_warnings(found: LoadExtent, coordinates: Coordinates) -> Iterator[Problem]:
    """Warning about unit loads that load no weld."""
    of_loads = found.line_force[:, len(coordinates.modes.mode) :]
    lost = [name for name, force in zip(coordinates.unit_loads, of_loads.T, strict=True) if not force.any()]
    if lost:
        names = few([f"'{name}'" for name in lost])
        what = f"all forces of unit load {names} are zero at every weld, so it makes no stress"
        remedy = "Request the forces of its load case, or remove the load"
        yield Problem("no_unit_load_force", f"body.unit_load '{lost[0]}'", what, remedy, len(lost))


def _node_warnings(
    found: LoadExtent, coordinates: Coordinates, names: NDArray[np.object_], zero: NDArray[np.bool_], file: str
) -> Iterator[Problem]:
    """Warning about nodes without any force in welds that have some; a single one may be a zero of a few modes."""
    least = 1 if len(coordinates) >= FEWEST_MODES else 2
    bare = np.where(zero | (found.bare < least), 0, found.bare)
    at = np.argsort(-bare, kind="stable")[: np.count_nonzero(bare)]
    if at.size:
        where = f"{file}: weld {names[at[0]]}, node {found.first_bare[at[0]]}"
        nodes = f"{bare[at[0]]} nodes of the weld have" if bare[at[0]] > 1 else "the node has"
        what = f"{nodes} no force in any mode, and other nodes of the weld have"
        what += f"; so it is in {few(names[at[1:]].tolist())}" if at.size > 1 else ""
        yield Problem("bare_nodes", where, what, "Request the forces of all elements along the weld", at.size)


def _component_warnings(
    found: LoadExtent, coordinates: Coordinates, names: NDArray[np.object_], zero: NDArray[np.bool_], file: str
) -> Iterator[Problem]:
    """Warnings about moments that are zero, everywhere or in some welds, and about other components zero everywhere."""
    without = ~zero & ~found.largest[:, 3:].any(axis=1) & found.across_plate
    told: set[int] = set()
    if without.any() and not found.largest[:, 3:].any():
        told = {3, 4, 5}
        what = "all moments of all welds are zero, although forces act across the plates"
        remedy = "Give mx_Nmm, my_Nmm, mz_Nmm as well; of solid elements, which have none, give weld_columns"
        yield Problem("no_moments", f"{file}: columns mx_Nmm, my_Nmm, mz_Nmm", what, remedy, names.size)
    elif without.any():
        some = names[without]
        what = "all moments of the weld are zero in every mode, and other welds have some"
        what += f"; so are those of {few(some[1:].tolist())}" if some.size > 1 else ""
        remedy = "Give its moments as well; of solid elements, which have none, give its rows of weld_columns"
        yield Problem("no_moments", f"{file}: weld {some[0]}", what, remedy, some.size)
    absent = set(np.flatnonzero(~found.largest.any(axis=0)).tolist()) - told
    lost = sorted(absent - _left_out_by_plane_models(absent, found.flat_axis, len(coordinates)))
    if lost:
        columns = ", ".join(COMPONENTS[i] for i in lost)
        what = f"{columns} {'are' if len(lost) > 1 else 'is'} zero at every node in every mode"
        remedy = "Check that no column was lost on the way from the FE results"
        yield Problem("no_component", f"{file}: column {COMPONENTS[lost[0]]}", what, remedy, len(lost))


def _left_out_by_plane_models(absent: set[int], axis: int | None, modes: int) -> set[int]:
    """Components, 0 to 5, that a flat body may lack; ``axis`` is that of its normals, None of a spatial body.

    The moment about the normal makes no structural stress, and many shells have no such stiffness. Of the others a
    membrane lacks three, a plate in bending two, a strip across the weld three; one alone is a column that was lost.
    """
    if axis is None:
        return set()
    others = absent - {3 + axis}
    return absent if modes < FEWEST_MODES or len(others) > 1 else absent - others
