"""Modal stresses at stress points from a genuine solver: closed forms of a strip, and the proof on any joint."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from fatigue.readers.convert.convert import convert
from fatigue.readers.convert.options import ConvertOptions
from tests.mystran import plates as joints
from tests.mystran.decks import plain
from tests.mystran.solver import needs_mystran, solve_text
from tests.mystran.strip import LENGTH, WIDTH, T, deck_text, stress_along, strip

pytestmark = needs_mystran


def points_file(path, rows, thickness=T):
    """Write stress points of (name, kind, x, y, z, e1, normal)."""
    columns = ["point", "kind", "x_mm", "y_mm", "z_mm", *(f"{n}_{a}" for n in ("e1", "normal") for a in "xyz")]
    table = pd.DataFrame([(*row[:5], *row[5], *row[6]) for row in rows], columns=columns)
    table.assign(thickness_mm=thickness, curve="iiw-steel-100").to_csv(path, index=False)
    return path


def converted(text, folder, rows, thickness=T, lines=range(11, 16), **more):
    """Table of modal stresses of a deck, and the lights of its audit."""
    mesh, op2 = solve_text(text, folder, "run")
    pd.DataFrame({"weld": "W", "order": range(len(lines)), "node": lines}).to_csv(folder / "lines.csv", index=False)
    asked = ConvertOptions(op2, mesh, folder / "body", stress_points=points_file(folder / "p.csv", rows, thickness))
    if lines:
        asked = replace(asked, welds=replace(asked.welds, node_lists=folder / "lines.csv"))
    done = convert(replace(asked, **more))
    return pd.read_parquet(folder / "body" / "modal_stresses.parquet"), {r.check: r for r in done.audit.rows}


@pytest.mark.parametrize("corner", ["CORNER", "CENTER"])
@pytest.mark.parametrize("triangles", [0.0, 0.5, 1.0])
def test_tension_and_bending_in_any_frame(tmp_path, corner, triangles):
    """Uniform stress states are exact at any place, in any frame, whatever way elements are cut, turned and flipped."""
    rng = np.random.default_rng(5)
    rows, turns = [], {}
    for k in range(12):
        angle, up = rng.uniform(-np.pi, np.pi), 1 if k % 2 else -1
        place = (rng.uniform(2, LENGTH - 2), rng.uniform(2, WIDTH - 2), rng.uniform(-T / 2, T / 2))
        rows.append((f"p{k}", "parent", *place, (np.cos(angle), np.sin(angle), 0.0), (0, 0, up)))
        turns[f"p{k}"] = angle, up
    table, lights = converted(deck_text(strip(triangles, seed=9), 101, corner), tmp_path, rows)
    assert lights["shell stresses"].light == "green"
    for row in table[table["mode"] < 3].itertuples():
        angle, up = turns[row.point]
        s = stress_along(row.mode - 1, 0.0, up if row.surface == "top" else -up)
        wanted = s * np.cos(angle) ** 2, s * np.sin(angle) ** 2, -up * s * np.sin(angle) * np.cos(angle)
        assert (row.sx_MPa, row.sy_MPa, row.txy_MPa) == pytest.approx(wanted, abs=1e-3 * 32)


def test_a_hot_spot_at_the_held_end(tmp_path):
    """Stress grows linearly towards the end: extrapolated, it is that of beam theory within 2 %."""
    sheets = [(1, *joints.sheet((0, 0, 0), joints.X, np.linspace(0, LENGTH, 41), joints.Y, np.linspace(0, WIDTH, 9)))]
    coarse = strip(0.0)
    fine = joints.assembled(sheets, (T,), lambda p: p[:, 0] < 1e-6)
    end = np.flatnonzero(fine.xyz[:, 0] > LENGTH - 1e-6)
    share = np.where(np.isin(fine.xyz[end, 1], [0, WIDTH]), 0.5, 1.0) * WIDTH / (len(end) - 1)
    total = [sum(case.values()) / WIDTH for case in coarse.loads]
    fine = replace(fine, loads=[{int(n): s * c for n, s in zip(end, share, strict=True)} for c in total])
    rows = [("toe", "hot_spot_a", 10.0, WIDTH / 2, T / 2, (1, 0, 0), (0, 0, 1))]
    table, _ = converted(deck_text(fine, 101), tmp_path, rows, lines=range(10, 19))
    own = table[(table["mode"] == 3) & (table.surface == "top")].set_index("read_out").sx_MPa
    assert own.to_numpy() == pytest.approx([stress_along(2, 10 + d, 1) for d in (2.0, 5.0)], rel=5e-3)
    assert 1.67 * own[1] - 0.67 * own[2] == pytest.approx(stress_along(2, 10.0, 1), rel=0.02)


@pytest.mark.parametrize("seed", range(4))
def test_every_joint_proves_its_stresses(tmp_path, seed):
    """Tees, laps, brackets and boxes of any formulation, distorted and cut: stresses do the work of the forces."""
    rng = np.random.default_rng(seed)
    model = (joints.tee, joints.lap, joints.bracket, joints.box)[seed](rng)
    model = joints.with_triangles(joints.distorted(model, rng), rng, 0.3)
    quad = ("MIN4", "MIN4T", "MITC4", "MITC4")[seed]
    text = plain(model, 103, quad=quad, modes=4).text()
    text = text.replace("DISP(PLOT) = ALL", "DISP(PLOT) = ALL\nSTRESS(PLOT,CORNER) = ALL")
    inside = model.xyz[list(model.shells[0])].mean(axis=0)
    rows = [("p", "parent", *inside, (1, 0, 0), (0, 0, 1))]
    _, lights = converted(text, tmp_path, rows, model.thickness[0], lines=())
    assert lights["shell stresses"].light == "green"
    assert lights["shell stresses"].value < 0.08  # MIN4T is not exact in constant bending


def test_a_point_at_the_web_of_a_tee(tmp_path):
    """On the line of the upright each side of the base plate has its own stress; across it the read-outs are told."""
    rng = np.random.default_rng(3)
    model = joints.tee(rng)
    t, c = model.thickness[0], float(model.xyz[model.xyz[:, 2] > 1][0, 0])
    text = (
        plain(model, 101, quad="MITC4")
        .text()
        .replace("DISP(PLOT) = ALL", "DISP(PLOT) = ALL\nSTRESS(PLOT,CORNER) = ALL")
    )
    y = float(model.xyz[:, 1].mean())
    rows = [(name, "hot_spot_a", c, y, 0.0, (sign, 0, 0), (0, 0, 1)) for name, sign in (("right", 1), ("left", -1))]
    table, _ = converted(text, tmp_path, rows, t, lines=())
    wide = table[table["mode"] == 1].pivot_table(
        index=["mode", "surface", "read_out"], columns="point", values="sx_MPa"
    )
    assert (np.abs(wide.right - wide.left) > 0.02 * np.abs(wide).max(axis=1)).all()
    mesh, op2 = tmp_path / "run.dat", tmp_path / "run.OP2"
    across = [("wrong", "hot_spot_a", c - 0.6 * t, y, 0.0, (1, 0, 0), (0, 0, 1))]
    asked = ConvertOptions(op2, mesh, tmp_path / "other", stress_points=points_file(tmp_path / "q.csv", across, t))
    (found,) = [problem for problem in convert(asked).warnings if problem.code == "across_plates"]
    assert found.count == 1
    assert "read-out 2" in found.what
    assert "Turn e1 round" in found.remedy
