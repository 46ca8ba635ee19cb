"""Loads that are not there are told, each kind once; what plane models leave out is not."""

import numpy as np
import pytest

from fatigue.case import load_case
from fatigue.check import check_case
from fatigue.pipeline.solve.absent_loads import load_warnings
from fatigue.pipeline.solve.body import read_body
from fatigue.pipeline.solve.model import solve_group
from fatigue.pipeline.solve.weld_groups import weld_groups
from tests.small_case import small_case

FORCES = ["fx_N", "fy_N", "fz_N"]
MOMENTS = ["mx_Nmm", "my_Nmm", "mz_Nmm"]
ALL = FORCES + MOMENTS


def warnings_of(tmp_path, change, pairs=1):
    """Tell the warnings about absent loads of a small case in which forces are changed."""
    case = small_case(seconds=0.1, pairs=pairs)
    change(case.nodal_forces, case)
    groups = weld_groups(read_body(load_case(case.write(tmp_path / "case")), strict=True), tmp_path / "scratch")
    extents = [extent for number in range(len(groups)) for extent in solve_group(groups, number).extents]
    return load_warnings(groups.body, extents)


def zero(columns, **where):
    """Change that sets columns to zero, of all rows or of those with one value."""

    def change(forces, _):
        rows = np.ones(len(forces), dtype=bool)
        for name, value in where.items():
            rows &= np.isin(forces[name], value)
        forces.loc[rows, columns] = 0.0

    return change


def test_sound_forces_are_silent(tmp_path):
    """Random forces in all components."""
    assert warnings_of(tmp_path, lambda forces, case: None) == []


@pytest.mark.parametrize(
    ("change", "code", "said"),
    [
        (zero(ALL), "no_weld_force", "all forces of all welds are zero"),
        (zero(ALL, weld="A"), "no_weld_force", "weld A: all forces of the weld are zero in every mode"),
        (zero(ALL, mode=2), "no_mode_force", "mode 2: all forces of normal mode 2 are zero at every weld"),
        (zero(MOMENTS), "no_moments", "all moments of all welds are zero, although forces act across the plates"),
        (zero(MOMENTS, weld="B"), "no_moments", "weld B: all moments of the weld are zero in every mode"),
        (zero("fx_N"), "no_component", "column fx_N: fx_N is zero at every node in every mode"),
        (zero("fz_N"), "no_component", "column fz_N"),
        (zero(["mx_Nmm"]), "no_component", "column mx_Nmm"),
        (zero(ALL, node=[102, 103, 104]), "bare_nodes", "weld A, node 102: 3 nodes of the weld have no force"),
        (zero(ALL, node=203), "bare_nodes", "weld B, node 203: the node has no force in any mode"),
    ],
)
def test_what_is_zero_is_told(tmp_path, change, code, said):
    """One warning, with its place."""
    (problem,) = warnings_of(tmp_path, change)
    assert problem.code == code
    assert said in str(problem)
    assert str(problem).startswith("nodal_forces.csv")


@pytest.mark.parametrize(
    "change",
    [
        zero(["mz_Nmm"]),  # about the normals of all plates
        zero(["fz_N", "mx_Nmm", "my_Nmm"]),  # loaded in its plane
        zero(["fz_N", *MOMENTS]),
        zero(["fx_N", "fy_N"]),  # plate bending
        zero(["fx_N", "fy_N", "mz_Nmm"]),
        zero(["fx_N", "fz_N", "my_Nmm"]),  # a strip across the weld
        zero(ALL, mode=7),  # an interface mode: of a body held statically it is a rigid movement
    ],
)
def test_what_plane_models_leave_out_is_silent(tmp_path, change):
    """Membranes and plates in bending have no other components."""
    assert warnings_of(tmp_path, change) == []


def test_a_flat_body_turned_into_another_plane(tmp_path):
    """The plane of the plates counts, not the name of the axis."""

    def upright(forces, case):
        case.weld_nodes[["normal_y", "normal_z", "outward_y", "outward_z"]] = [1.0, 0.0, 0.0, -1.0]
        forces[["fy_N", "fz_N", "my_Nmm", "mz_Nmm"]] = forces[["fz_N", "fy_N", "mz_Nmm", "my_Nmm"]].to_numpy()

    def membrane(forces, case):
        upright(forces, case)
        forces[["fy_N", "mx_Nmm", "mz_Nmm"]] = 0.0

    def lost(forces, case):
        upright(forces, case)
        forces["fy_N"] = 0.0

    assert warnings_of(tmp_path / "a", membrane) == []
    assert [p.code for p in warnings_of(tmp_path / "b", lost)] == ["no_component"]


def test_a_spatial_body_has_all_components(tmp_path):
    """With plates in two planes, a moment about the normal of one of them is no plane model's."""

    def change(forces, case):
        of_b = case.weld_nodes.weld == "B"
        case.weld_nodes.loc[of_b, ["normal_y", "normal_z", "outward_y", "outward_z"]] = [1.0, 0.0, 0.0, -1.0]
        forces["mz_Nmm"] = 0.0

    assert [p.code for p in warnings_of(tmp_path, change)] == ["no_component"]


@pytest.mark.parametrize(("factor", "told"), [(1e-5, False), (1e-7, True), (1e-12, True)])
def test_a_weld_with_next_to_no_force(tmp_path, factor, told):
    """A millionth of the median weld's line force, in every mode, is no load case."""

    def change(forces, _):
        forces.loc[forces.weld == "A1", ALL] *= factor

    found = warnings_of(tmp_path, change, pairs=3)
    assert [p.code for p in found] == ["small_weld_force"] * told
    if told:
        assert "weld A1" in found[0].where


def test_modes_of_very_different_size_are_silent(tmp_path):
    """A weld is compared mode by mode: one that only a mode of small coordinates loads is no doubt."""

    def change(forces, _):
        forces.loc[forces["mode"] == 7, ALL] *= 1e9
        forces.loc[(forces["mode"] == 7) & (forces.weld == "A"), ALL] *= 1e-15

    assert warnings_of(tmp_path, change, pairs=3) == []


def test_many_welds_are_one_warning(tmp_path):
    """The first are named, the others counted, in the dry run as in the assessment."""
    case = small_case(seconds=2.0, pairs=12)
    case.nodal_forces.loc[case.nodal_forces.weld >= "B", ALL] = 0.0
    told = [w for w in check_case(case.write(tmp_path)).warnings if w.code == "no_weld_force"]
    assert [problem.count for problem in told] == [12]
    assert "and 8 more" in told[0].what
