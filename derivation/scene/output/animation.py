"""Animates an impact on a plate with inertia: deflection profile and position of the sphere."""

import re
import tempfile
from pathlib import Path

import numpy as np

from derivation.scene.dynamic.time_element import Z
from derivation.scene.errors import SceneError
from derivation.scene.output.plot import BLUE, BROWN, frame, scaled, title
from derivation.scene.result import Result
from generated.arrays import Double as Array

SUFFIXES = ".gif", ".html"
FRAMES, POINTS, PER_SECOND = 120, 201, 20
"""Number of frames, points of the profile, and frames per second."""
BUTTONS = {
    "minus": "&minus;", "plus": "+", "pause": "&#10074;&#10074;", "play": "&#9654;",
    "play fa-flip-horizontal": "&#9664;", "step-backward": "&#9664;|", "step-forward": "|&#9654;",
    "fast-backward": "|&#9664;&#9664;", "fast-forward": "&#9654;&#9654;|",
}  # fmt: skip
"""Text of each button by the name of its symbol in Matplotlib's page."""


def render(result: Result, suffix: str) -> bytes:
    """Return the animation as the content of a file.

    Parameters
    ----------
    suffix
        Format: ``.gif``, or ``.html`` with embedded frames.

    Raises
    ------
    SceneError
        If the plate has no inertia.
    """
    import matplotlib as mpl
    from matplotlib.animation import FuncAnimation, PillowWriter
    from matplotlib.figure import Figure

    if result.dynamics is None:
        raise SceneError(
            "--animate needs plate inertia, but the plate is quasi-static; set effects.inertia = "
            "true, or remove --animate"
        )
    times = np.linspace(0.0, result.total_time, FRAMES)
    r = np.linspace(-1.0, 1.0, POINTS) * result.model.b
    profiles, displacement = (
        result.dynamics.profiles(times, np.abs(r)),
        result.dynamics.rows(times)[Z],
    )
    t, t_label = scaled(times, "time $t$", "s")
    both, w_label = scaled(
        np.vstack((profiles, displacement[:, None] * np.ones_like(r))),
        "displacement $z$, $w$",
        "m",
    )
    profiles, displacement = both[:FRAMES], both[FRAMES:, 0]
    x, x_label = scaled(r, "distance from the axis $r$", "m")
    made = Figure(figsize=(7.0, 3.5), layout="constrained")
    axes = made.subplots()
    frame(axes, x_label, w_label)
    axes.set_ylim(*_limits(profiles, displacement))
    made.suptitle(title(result), fontsize=9)
    (plate,) = axes.plot(x, profiles[0], color=BROWN, linewidth=2.0)
    plate.set_label("plate (without local indentation), $w(r, t)$")
    (sphere,) = axes.plot([0.0], [displacement[0]], "v", color=BLUE, markersize=12.0)
    sphere.set_label("lowest point of the sphere, $z(t)$")
    axes.legend(loc="lower right", fontsize=8, frameon=False)
    unit = t_label[t_label.index("[") + 1 : -1]

    def draw(k: int) -> list[object]:
        plate.set_ydata(profiles[k])
        sphere.set_ydata([displacement[k]])
        axes.set_title(f"$t$ = {t[k]:.3g} {unit}", fontsize=10)
        return [plate, sphere]

    draw(0)  # with its title, which needs room
    made.draw_without_rendering()
    made.set_layout_engine(None)  # the layout of the first frame remains
    movie = FuncAnimation(made, draw, frames=FRAMES, interval=1000.0 / PER_SECOND)  # type: ignore[arg-type]
    if suffix.lower() == ".html":
        with mpl.rc_context({"animation.embed_limit": 50.0}):
            return _without_fonts(movie.to_jshtml(fps=PER_SECOND)).encode()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "impact.gif"
        movie.save(path, writer=PillowWriter(fps=PER_SECOND), dpi=100)
        return path.read_bytes()


def _without_fonts(page: str) -> str:
    """Return a page of Matplotlib whose buttons need no symbols from the network."""
    page = re.sub(r'<link[^>]*href="https?:[^>]*>', "", page)
    return re.sub(r'<i class="fa fa-([^"]+)"></i>', lambda icon: BUTTONS[icon[1]], page)


def _limits(profiles: Array, displacement: Array) -> tuple[float, float]:
    """Return the limits of the vertical axis, which points downwards, with a margin."""
    low, high = min(profiles.min(), displacement.min()), max(profiles.max(), displacement.max())
    room = 0.1 * (high - low)
    return float(high + room), float(low - 3.0 * room)
