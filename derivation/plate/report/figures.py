"""Figures 1 and 2 as the paper draws them and as they should be; the peaks, the law and its map."""

from collections.abc import Callable
from dataclasses import replace
from math import gamma, pi, sqrt
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from derivation.engine.report.figures import STYLE
from derivation.scene.map import figure as scene_map
from derivation.scene.model import Model
from derivation.scene.result import Result
from generated.contact_law import indentation
from generated.impact import Impact, history, impact
from generated.perturbation import printed_motion

TRUNCATIONS = (25, 50, 100, 200, 400)
THICKNESS = np.geomspace(0.04, 1.0, 49)
"""h/b of figure 2 and of the peaks."""
PLATES = (0.02, 0.05, 0.1, 0.2, 0.53, 2.0)
"""h/b of the law's figure; at 0.53 the first correction changes sign."""


def figures(case: Model, impact_of: Result) -> dict[str, Figure]:
    """Every figure of the paper's case by name, `impact_of` being its simulation."""
    drawings: dict[str, Callable[[Figure, Model], None]] = {
        "figure1": draw_history,
        "figure2": draw_contact_time,
        "peaks": draw_peaks,
        "law": draw_law,
    }
    found = {name: _drawn(draw, case) for name, draw in drawings.items()}
    with mpl.rc_context({"font.family": "serif"}):
        return found | {"map": scene_map(impact_of, impact_of.effects.rtol)}


def _drawn(draw: Callable[[Figure, Model], None], case: Model) -> Figure:
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(6.3, 3.1), layout="constrained")
        draw(figure, case)
    return figure


def draw_history(figure: Figure, case: Model) -> None:
    """Figure 1: indentation against time; printed at two truncations, and the right law's."""
    axes = figure.subplots(1, 2, sharey=True)
    truth = impact(case.R, case.m, case.v0, case.h, case.b, case.lam, case.mu)
    t = np.linspace(0.0, float(truth.contact_time), 400)
    right = history(t, case.R, case.m, case.v0, case.h, case.b, case.lam, case.mu)
    for ax, modes in zip(axes, (100, 400), strict=True):
        motion = printed_motion(*case.numbers, modes)
        early = np.linspace(0.0, motion.contact_time, 4001)
        half = early[early <= motion.contact_time / 2]
        ax.plot(1e3 * t, 1e3 * right.indentation, "k", label="right law")
        ax.plot(1e3 * early, 1e3 * motion.linear(early), "--", label="linear term (15)")
        ax.plot(1e3 * half, 1e3 * motion.corrected(half), label="with correction (16), printed")
        mended = printed_motion(*case.numbers, modes, corrected=True)
        ax.plot(1e3 * half, 1e3 * mended.corrected(half), ":", label=r"the same, $\xi_3$ mended")
        breaks = np.array([motion.breaks_at, mended.breaks_at])
        ax.plot(1e3 * breaks, 1e3 * motion.linear(breaks), "kx", label="(17), (18) break")
        ax.set(title=f"sums cut off at {modes} modes", xlabel="time [ms]")
    axes[0].set_ylabel("indentation [mm]")
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, fontsize=7, loc="outside lower center", ncols=3)


def draw_contact_time(figure: Figure, case: Model) -> None:
    """Figure 2: contact time against h/b for several truncations, the right law and Hertz."""
    ax = figure.subplots()
    plates = [replace(case, h=case.b * ratio) for ratio in THICKNESS]
    for modes in TRUNCATIONS:
        times = [printed_motion(*plate.numbers, modes).contact_time for plate in plates]
        ax.plot(THICKNESS, 1e3 * np.array(times), "--", lw=0.9, label=f"printed, {modes} modes")
    right = _impacts(case, THICKNESS)
    ax.plot(THICKNESS, 1e3 * right.contact_time, "k", label="right law")
    ax.axhline(1e3 * hertz_contact_time(case), color="tab:red", lw=0.9, label="Hertz")
    ax.set(xscale="log", xlabel="h/b", ylabel="contact time [ms]")
    ax.legend(fontsize=7)


def draw_peaks(figure: Figure, case: Model) -> None:
    """Largest force and indentation against h/b, over Hertz's."""
    ax = figure.subplots()
    right = _impacts(case, THICKNESS)
    force, indentation = hertz_peaks(case)
    ax.plot(THICKNESS, right.max_force / force, "k", label="maximum force / Hertz's")
    ax.plot(
        THICKNESS, right.max_indentation / indentation, "k--", label="maximum indentation / Hertz's"
    )
    ax.axhline(1.0, color="tab:red", lw=0.9)
    ax.set(xscale="log", yscale="log", xlabel="h/b")
    ax.legend(fontsize=7)


def draw_law(figure: Figure, case: Model) -> None:
    """Indentation and force over those on a half-space, against the contact radius."""
    axes = figure.subplots(1, 2)
    for ratio in PLATES:
        h = ratio * case.b
        a = np.geomspace(1e-3 * h, min(6.0 * h, case.b), 200)
        depth = indentation(a, case.R, h, case.b) * case.R / a**2
        axes[0].plot(a / h, depth, label=f"h/b = {ratio:g}")
        axes[1].plot(a / h, depth**-1.5, label=f"h/b = {ratio:g}")
    for ax, what in zip(axes, ("indentation", "force"), strict=True):
        ax.set(xscale="log", yscale="log", xlabel="a/h", title=f"{what} / Hertz's")
    axes[0].legend(fontsize=7)


def _impacts(case: Model, ratios: NDArray[np.float64]) -> Impact:
    """Impacts by the right law for several h/b at once."""
    return impact(case.R, case.m, case.v0, ratios * case.b, case.b, case.lam, case.mu)


def hertz_peaks(case: Model) -> tuple[float, float]:
    """Largest force [N] and indentation [m] on a half-space, P = (4/3) E* sqrt(R) delta^(3/2)."""
    K = 4 / 3 * case.modulus * np.sqrt(case.R)
    indentation = (5 * case.m * case.v0**2 / (4 * K)) ** 0.4
    return float(K * indentation**1.5), float(indentation)


def hertz_contact_time(case: Model) -> float:
    """Contact time on a half-space [s]: (2 sqrt(pi) Gamma(2/5)/(5/2 Gamma(9/10))) delta_max/v0."""
    _, indentation = hertz_peaks(case)
    return 4 * sqrt(pi) * gamma(0.4) / (5 * gamma(0.9)) * indentation / case.v0


def motion_context(case: Model) -> dict[str, Any]:
    """The paper's case in numbers: printed at several truncations, and by the right law."""
    truth = impact(case.R, case.m, case.v0, case.h, case.b, case.lam, case.mu)
    rows = []
    for modes in TRUNCATIONS:
        printed = printed_motion(*case.numbers, modes)
        mended = printed_motion(*case.numbers, modes, corrected=True)
        times = (printed.contact_time, printed.breaks_at, mended.breaks_at)
        rows.append((modes, *(f"{1e3 * time:.3f}" for time in times)))
    return {
        "R": f"{case.R:g}",
        "v0": f"{case.v0:g}",
        "ratio": f"{case.h / case.b:.2f}",
        "mass": f"{case.m:.1f}",
        "radius": f"{case.b:g}",
        "rows": rows,
        "contact_time": f"{1e3 * float(truth.contact_time):.3f}",
        "half": f"{5e2 * float(truth.contact_time):.3f}",
        "indentation": f"{1e3 * float(truth.max_indentation):.3f}",
        "force": f"{1e-3 * float(truth.max_force):.2f}",
        "contact_radius": f"{1e3 * float(truth.max_contact_radius):.2f}",
        "hertz": f"{1e3 * hertz_contact_time(case):.3f}",
    }
