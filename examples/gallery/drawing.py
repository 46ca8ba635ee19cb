"""A picture of a few lines over two axes as SVG, small enough to be kept beside the script that makes it."""

from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

WIDTH, HEIGHT, LEFT, TOP, BOTTOM = 640, 360, 70, 30, 50
COLOURS = ("#1f5fa8", "#c4501b", "#3a7d44")
TEXT = 'font-family="sans-serif" font-size="13"'


def draw(path: Path, lines: dict[str, tuple[ArrayLike, ArrayLike]], x_name: str, y_name: str) -> None:
    """Write a picture of named lines; what goes along an axis, with its unit, is its name."""
    xs, ys = (np.concatenate([np.asarray(line[axis], float) for line in lines.values()]) for axis in (0, 1))
    right, bottom = WIDTH - 20, HEIGHT - BOTTOM
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}">',
        '<rect width="100%" height="100%" fill="#fff"/>',
        f'<path d="M{LEFT} {TOP}V{bottom}H{right}" fill="none" stroke="#444"/>',
        f'<text x="{(LEFT + right) / 2}" y="{HEIGHT - 10}" text-anchor="middle" {TEXT}>{x_name}</text>',
        f'<text x="{LEFT}" y="{TOP - 12}" text-anchor="middle" {TEXT}>{y_name}</text>',
    ]
    for value, x, y, anchor in (
        (xs.min(), LEFT, bottom + 18, "middle"),
        (xs.max(), right, bottom + 18, "end"),
        (ys.min(), LEFT - 6, bottom, "end"),
        (ys.max(), LEFT - 6, TOP + 10, "end"),
    ):
        parts.append(f'<text x="{x}" y="{y}" text-anchor="{anchor}" {TEXT}>{value:.4g}</text>')
    for k, (name, (x, y)) in enumerate(lines.items()):
        u = LEFT + (np.asarray(x, float) - xs.min()) / np.ptp(xs) * (right - LEFT)
        v = bottom - (np.asarray(y, float) - ys.min()) / np.ptp(ys) * (bottom - TOP)
        points = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(u, v, strict=True))
        parts.append(f'<polyline points="{points}" fill="none" stroke="{COLOURS[k]}" stroke-width="2"/>')
        parts.append(f'<text x="{right}" y="{TOP + 16 * k}" text-anchor="end" fill="{COLOURS[k]}" {TEXT}>{name}</text>')
    path.write_text("\n".join([*parts, "</svg>\n"]), encoding="utf-8")
