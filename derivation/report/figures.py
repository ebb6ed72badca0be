"""Figures 1 and 2 as the paper draws them and as they should be, and the peaks it speaks of."""

import io
from collections.abc import Callable
from dataclasses import replace
from math import gamma, pi, sqrt
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from derivation.scene.model import Model
from generated.impact import Impact, history, impact
from generated.perturbation import printed_motion

TRUNCATIONS = (25, 50, 100, 200, 400)
THICKNESS = np.geomspace(0.04, 1.0, 49)
"""h/b of figure 2 and of the peaks."""
STYLE: dict[Any, Any] = {
    "font.family": "serif",
    "font.size": 9,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.alpha": 0.3,
    "legend.frameon": False,
    "lines.linewidth": 1.3,
    "pdf.fonttype": 42,
    "svg.hashsalt": "platecontact",
}


def figures(case: Model) -> dict[str, bytes]:
    """Every figure as PDF by file name; the same bytes for the same case."""
    drawings: dict[str, Callable[[Figure, Model], None]] = {
        "figure1.pdf": draw_history,
        "figure2.pdf": draw_contact_time,
        "peaks.pdf": draw_peaks,
    }
    return {name: _pdf(draw, case) for name, draw in drawings.items()}


def _pdf(draw: Callable[[Figure, Model], None], case: Model) -> bytes:
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(6.3, 3.1), layout="constrained")
        draw(figure, case)
        buffer = io.BytesIO()
        figure.savefig(buffer, format="pdf", metadata={"CreationDate": None, "Producer": None})
    return buffer.getvalue()


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
