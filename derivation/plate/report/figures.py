"""The impact of the paper's example as published and corrected: figures and numbers."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from math import gamma, pi, sqrt
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator

from derivation.engine.report.figures import STYLE
from derivation.plate.report.setup import draw_setup
from derivation.scene.model import Model
from derivation.scene.output.map import figure as scene_map
from derivation.scene.result import Result
from generated.contact_law import indentation
from generated.impact import history, impact
from generated.perturbation import printed_motion

TRUNCATIONS = (25, 50, 100, 200, 400)
"""Numbers of modes of the published sums that are compared."""
COUNTS = np.unique(np.geomspace(5, 1000, 25).astype(int))
"""Numbers of modes in the figure of the divergent sum."""
THICKNESS = np.geomspace(0.04, 1.0, 49)
"""h/b in the figures of contact time and of largest force and indentation."""
PEAK_TICKS = (0.2, 0.5, 1.0, 2.0, 4.0)
"""Tick labels of the figure of largest force and indentation."""
PLATES = (0.02, 0.05, 0.1, 0.2, 0.53, 2.0)
"""h/b in the figure of the contact law; at 0.53 the coefficient c_1 changes sign."""


@dataclass(frozen=True)
class Extremes:
    """Contact time [s] and largest force [N] of an impact."""

    contact_time: float
    force: float


def corrected_impact(case: Model) -> Extremes:
    """Return contact time and largest force according to the corrected law."""
    extremes = impact(case.R, case.m, case.v0, case.h, case.b, case.lam, case.mu)
    return Extremes(float(extremes.contact_time), float(extremes.max_force))


def linear_impact(case: Model, modes: int) -> Extremes:
    """Return the same for the published linear term: half a period of a linear oscillator."""
    time = printed_motion(*case.numbers, modes).contact_time
    return Extremes(time, pi * case.m * case.v0 / time)


def figures(case: Model, impact_of: Result, gamma_2: float) -> dict[str, Callable[[], Figure]]:
    """Return functions that draw the figures of the example of the paper, by name.

    Parameters
    ----------
    case
        The example of the paper.
    impact_of
        The result of its simulation.
    gamma_2
        Coefficient of the linear term of the indentation as a function of the force, from a
        convergent sum [m/N].
    """
    drawings: dict[str, Callable[[Figure, Model], None]] = {
        "figure1": draw_history,
        "figure2": draw_contact_time,
        "peaks": draw_peaks,
        "law": draw_law,
        "setup": draw_setup,
        "divergence": lambda figure, case: draw_divergence(figure, case, gamma_2),
    }
    by_name = {name: partial(_figure, draw, case) for name, draw in drawings.items()}
    return {**by_name, "map": partial(_map, impact_of)}


def _map(impact_of: Result) -> Figure:
    """Return the map of the effects around the scene of a result."""
    with mpl.rc_context({"font.family": "serif"}):
        return scene_map(impact_of, impact_of.effects.rtol)


def _figure(draw: Callable[[Figure, Model], None], case: Model) -> Figure:
    """Return a figure in the style of the report, drawn by a function."""
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(6.3, 3.1), layout="constrained")
        draw(figure, case)
    return figure


def draw_history(figure: Figure, case: Model) -> None:
    """Draw the indentation over time as published, for two truncations, and as corrected.

    This corresponds to figure 1 of the paper.
    """
    axes = figure.subplots(1, 2, sharey=True)
    reference = impact(case.R, case.m, case.v0, case.h, case.b, case.lam, case.mu)
    t = np.linspace(0.0, float(reference.contact_time), 400)
    corrected = history(t, case.R, case.m, case.v0, case.h, case.b, case.lam, case.mu)
    for ax, modes in zip(axes, (100, 400), strict=True):
        motion = printed_motion(*case.numbers, modes)
        early = np.linspace(0.0, motion.contact_time, 4001)
        half = early[early <= motion.contact_time / 2]
        ax.plot(1e3 * t, 1e3 * corrected.indentation, "k", label="corrected law")
        ax.plot(1e3 * early, 1e3 * motion.linear(early), "--", label="linear term (15)")
        ax.plot(1e3 * half, 1e3 * motion.corrected(half), label="correction (16), as published")
        fixed = printed_motion(*case.numbers, modes, corrected=True)
        ax.plot(1e3 * half, 1e3 * fixed.corrected(half), ":", label=r"the same, $\xi_3$ corrected")
        breaks = np.array([motion.valid_until, fixed.valid_until])
        ax.plot(1e3 * breaks, 1e3 * motion.linear(breaks), "kx", label="(17), (18) no longer real")
        ax.set(title=f"sums truncated after {modes} modes", xlabel="time [ms]")
    axes[0].set_ylabel("indentation [mm]")
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, fontsize=7, loc="outside lower center", ncols=3)


def draw_contact_time(figure: Figure, case: Model) -> None:
    """Draw the contact time over h/b as published, for several truncations, and as corrected.

    This corresponds to figure 2 of the paper; the Hertz theory is shown, too.
    """
    ax = figure.subplots()
    plates = [replace(case, h=case.b * ratio) for ratio in THICKNESS]
    for modes in TRUNCATIONS:
        times = [printed_motion(*plate.numbers, modes).contact_time for plate in plates]
        ax.plot(THICKNESS, 1e3 * np.array(times), "--", lw=0.9, label=f"published, {modes} modes")
    corrected = impact(case.R, case.m, case.v0, THICKNESS * case.b, case.b, case.lam, case.mu)
    ax.plot(THICKNESS, 1e3 * corrected.contact_time, "k", label="corrected law")
    ax.axhline(1e3 * hertz_contact_time(case), color="tab:red", lw=0.9, label="Hertz")
    ax.set(xscale="log", xlabel="h/b [1]", ylabel="contact time [ms]")
    ax.legend(fontsize=7)


def draw_peaks(figure: Figure, case: Model) -> None:
    """Draw largest force and indentation over h/b, relative to Hertz theory."""
    ax = figure.subplots()
    corrected = impact(case.R, case.m, case.v0, THICKNESS * case.b, case.b, case.lam, case.mu)
    force, indentation = hertz_peaks(case)
    ax.plot(THICKNESS, corrected.max_force / force, "k", label="largest force")
    ax.plot(
        THICKNESS,
        corrected.max_indentation / indentation,
        "k--",
        label="largest indentation",
    )
    ax.axhline(1.0, color="tab:red", lw=0.9)
    ax.set(xscale="log", yscale="log", xlabel="h/b [1]", ylabel="relative to Hertz [1]")
    ax.set_yticks(PEAK_TICKS, [f"{tick:g}" for tick in PEAK_TICKS])
    ax.yaxis.set_minor_locator(NullLocator())
    ax.legend(fontsize=7)


def draw_law(figure: Figure, case: Model) -> None:
    """Draw indentation and force over a/h, relative to a half-space."""
    axes = figure.subplots(1, 2)
    for ratio in PLATES:
        h = ratio * case.b
        a = np.geomspace(1e-3 * h, min(6.0 * h, case.b), 200)
        ratio_to_hertz = indentation(a, case.R, h, case.b) * case.R / a**2
        axes[0].plot(a / h, ratio_to_hertz, label=f"h/b = {ratio:g}")
        axes[1].plot(a / h, ratio_to_hertz**-1.5, label=f"h/b = {ratio:g}")
    for ax, what in zip(axes, ("indentation", "force"), strict=True):
        ax.set(xscale="log", yscale="log", xlabel="a/h [1]", title=f"{what} / Hertz's [1]")
    axes[0].legend(fontsize=7)


def hertz_peaks(case: Model) -> tuple[float, float]:
    """Return largest force [N] and indentation [m] on a half-space."""
    K = 4 / 3 * case.modulus * np.sqrt(case.R)
    indentation = (5 * case.m * case.v0**2 / (4 * K)) ** 0.4
    return float(K * indentation**1.5), float(indentation)


def hertz_contact_time(case: Model) -> float:
    """Return the contact time on a half-space [s]."""
    _, indentation = hertz_peaks(case)
    return 4 * sqrt(pi) * gamma(0.4) / (5 * gamma(0.9)) * indentation / case.v0


def draw_divergence(figure: Figure, case: Model, gamma_2: float) -> None:
    """Draw the published coefficient gamma_2 over the number of modes."""
    ax = figure.subplots()
    times = [linear_impact(case, int(modes)).contact_time for modes in COUNTS]
    ax.plot(COUNTS, (np.array(times) / pi) ** 2 / case.m, "o-", ms=3, label="published sum")
    ax.axhline(gamma_2, color="k", lw=0.9, label="corrected: convergent coefficient")
    ax.set(xscale="log", yscale="log", xlabel="number of modes [1]", ylabel=r"$\gamma_2$ [m/N]")
    ax.legend(fontsize=8)


def motion_context(case: Model) -> dict[str, Any]:
    """Return the values of the template: example of the paper as published and as corrected."""
    extremes = impact(case.R, case.m, case.v0, case.h, case.b, case.lam, case.mu)
    corrected = corrected_impact(case)
    hertz = Extremes(hertz_contact_time(case), hertz_peaks(case)[0])
    laws = [(f"published, {n} modes", linear_impact(case, n), n) for n in TRUNCATIONS]
    rows = [
        " & ".join([name, *_compared(law, corrected), *_real_until(case, modes)])
        for name, law, modes in [*laws, ("Hertz, half-space", hertz, 0),
                                 ("corrected law", corrected, 0)]
    ]  # fmt: skip
    return {
        "R": f"{case.R:g}",
        "v0": f"{case.v0:g}",
        "ratio": f"{case.h / case.b:.2f}",
        "mass": f"{case.m:.1f}",
        "radius": f"{case.b:g}",
        "rows": rows,
        "contact_time": f"{1e3 * corrected.contact_time:.3f}",
        "half": f"{5e2 * corrected.contact_time:.3f}",
        "indentation": f"{1e3 * float(extremes.max_indentation):.3f}",
        "force": f"{1e-3 * corrected.force:.2f}",
        "contact_radius": f"{1e3 * float(extremes.max_contact_radius):.2f}",
        "hertz": f"{1e3 * hertz.contact_time:.3f}",
    }


def _compared(law: Extremes, corrected: Extremes) -> list[str]:
    """Return table cells of an impact: contact time and force, with ratios to corrected values."""
    return [
        f"{1e3 * law.contact_time:.3f}", f"{law.contact_time / corrected.contact_time:.3f}",
        f"{1e-3 * law.force:.2f}", f"{law.force / corrected.force:.3f}",
    ]  # fmt: skip


def _real_until(case: Model, modes: int) -> list[str]:
    """Return table cells: times up to which the correction (16) is real, for both forms of xi_3."""
    if not modes:
        return ["", ""]
    both = (printed_motion(*case.numbers, modes, corrected=fixed) for fixed in (False, True))
    return [f"{1e3 * motion.valid_until:.3f}" for motion in both]
