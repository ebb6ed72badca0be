"""Figure of the report: section through sphere and plate, with coordinates and lengths."""

from math import pi
from typing import Any

import numpy as np
from matplotlib.figure import Figure

RADIUS, HALF, EDGE, CONTACT, DEPTH = 1.0, 0.5, 3.2, 0.55, 0.36
"""R, h, b, a and delta as drawn, not to scale."""
LABELS = {
    "$r$": (EDGE + 0.72, -0.07), "$z$": (0.08, 2.42), "$R$": (-0.52, 1.4), "$b$": (-1.6, -1.0),
    "$a$": (0.21, -0.26), "$2h$": (-2.55, 0.14), r"$\delta$": (1.62, 0.24),
    "contact face $z=+h$": (1.5, 0.62), "back face $z=-h$": (1.3, -0.8),
    "edge $r=b$": (EDGE + 0.08, -0.45), "rigid sphere": (1.08, 1.5),
    "mass $m$, speed $v_0$": (1.08, 1.22),
}  # fmt: skip
"""Texts by the place where they begin."""


def draw_setup(figure: Figure, _: Any) -> None:
    """Draw sphere and plate in section, not to scale."""
    ax = figure.subplots()
    lowest = HALF - DEPTH
    centre = lowest + RADIUS
    r = np.linspace(-EDGE, EDGE, 801)
    back = -HALF - 0.13 * np.exp(-((r / 1.3) ** 2))
    ax.fill_between(r, back, _face(r), color="0.87", lw=0)
    outline = np.r_[r, r[::-1], r[0]], np.r_[_face(r), back[::-1], _face(r)[0]]
    ax.plot(*outline, "k", lw=1)
    angle = np.linspace(0.0, 2 * pi, 200)
    ax.plot(RADIUS * np.cos(angle), centre + RADIUS * np.sin(angle), "k", lw=1)
    ax.plot([-EDGE, EDGE], [HALF, HALF], "k--", lw=0.6)  # the face before the impact
    ax.plot([0, 1.6], [lowest, lowest], color="0.45", lw=0.5)
    ax.plot([CONTACT, CONTACT], [-0.08, _face(CONTACT)], color="0.45", lw=0.5)
    for start, end, style in (
        ((-EDGE - 0.1, 0), (EDGE + 0.7, 0), "->"),
        ((0, -1.0), (0, 2.6), "->"),
        ((0, centre), (-RADIUS * np.sin(1.2), centre + RADIUS * np.cos(1.2)), "->"),
        ((-EDGE, -1.05), (0, -1.05), "<->"),
        ((0, -0.05), (CONTACT, -0.05), "<->"),
        ((-2.65, -HALF), (-2.65, HALF), "<->"),
        ((1.55, lowest), (1.55, HALF), "<->"),
    ):
        ax.annotate(
            "", end, start, arrowprops={"arrowstyle": style, "lw": 0.7, "shrinkA": 0, "shrinkB": 0}
        )
    for text, position in LABELS.items():
        ax.text(*position, text, fontsize=9)
    ax.set(xlim=(-EDGE - 0.3, EDGE + 1.3), ylim=(-1.3, 2.7), aspect="equal")
    ax.axis("off")


def _face(r: Any) -> Any:
    """Return the height of the contact face: the sphere's in the contact, smooth at its edge."""
    distance = np.abs(r)
    inside = HALF - DEPTH + RADIUS - np.sqrt(RADIUS**2 - np.minimum(distance, CONTACT) ** 2)
    slope = CONTACT / np.sqrt(RADIUS**2 - CONTACT**2)
    depth = HALF - inside
    return np.where(
        distance < CONTACT, inside, HALF - depth * np.exp(-(distance - CONTACT) * slope / depth)
    )
