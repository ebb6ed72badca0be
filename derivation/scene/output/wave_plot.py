"""Draws an impact on a plate with inertia: time history, energies and restitution."""

from typing import TYPE_CHECKING

import numpy as np

from derivation.scene.dynamic.infinite_plate_impact import infinite_plate_impact
from derivation.scene.dynamic.time_element import E, P, V, W, Z
from derivation.scene.output.plot import BLUE, BROWN, frame, scaled, title
from derivation.scene.result import Result
from derivation.scene.scales import zener_number
from generated.arrays import Double as Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

POINTS = 1201
"""Number of times in the figure."""
ZENER = np.geomspace(1e-3, 10.0, 25)
"""Zener parameters of the curve of restitution [1]."""
TITLES = {
    "z": "Displacement, positive into the plate",
    "P": "Contact force",
    "v": "Velocity",
    "energy": "Energy",
    "e": "Restitution, compared with an infinite plate",
}
"""Titles of the panels."""
GREEN = "#5a8f5a"


def figure(result: Result) -> "Figure":
    """Return the impact as a Matplotlib figure."""
    from matplotlib.figure import Figure

    dynamics = result.dynamics
    assert dynamics is not None
    times = np.linspace(0.0, result.total_time, POINTS)
    rows = dynamics.rows(times)
    t, label = scaled(times, "time $t$", "s")
    made = Figure(figsize=(8.0, 9.5), layout="constrained")
    drawn = made.subplot_mosaic([["z", "z"], ["P", "v"], ["energy", "e"]])
    (sphere, face), w_label = scaled(rows[[Z, W]], "displacement $z$, $w$", "m")
    drawn["z"].plot(t, sphere, color=BLUE, linewidth=1.5, label="sphere, $z$")
    plate = "plate at the axis (without local indentation), $w$"
    drawn["z"].plot(t, face, color=BROWN, linewidth=1.2, label=plate)
    force, f_label = scaled(rows[P], "contact force $P$", "N")
    drawn["P"].plot(t, force, color=BLUE, linewidth=1.5)
    velocity, v_label = scaled(rows[V], "sphere velocity $v$", "m/s")
    drawn["v"].plot(t, velocity, color=BLUE, linewidth=1.5)
    _energies(drawn["energy"], result, t, rows)
    _restitution(drawn["e"], result)
    e_label = "energy / initial kinetic energy [1]"
    for name, y_label in (("z", w_label), ("P", f_label), ("v", v_label), ("energy", e_label)):
        frame(drawn[name], label, y_label)
        for touch in dynamics.inertia.contacts:
            begin, end = np.array([touch.start, touch.end]) * (t[-1] / times[-1])
            drawn[name].axvspan(begin, end, color="0.9", zorder=0, linewidth=0)
    drawn["z"].patches[0].set_label("in contact")
    drawn["z"].legend(framealpha=1.0)  # on white, the grey of the contact is visible
    drawn["z"].invert_yaxis()
    for name, text in TITLES.items():
        drawn[name].set_title(text, fontsize=10)
    made.suptitle(title(result), fontsize=11)
    return made


def _energies(axes: "Axes", result: Result, t: Array, rows: Array) -> None:
    """Draw the energies of sphere, plate and contact, stacked."""
    m, v0 = result.model.m, result.model.v0
    sphere, plate = (rows[V] / v0) ** 2, 2.0 * rows[E] / m / v0**2
    contact = np.maximum(1.0 - sphere - plate, 0.0)
    names, law = ["sphere", "plate", "contact"], result.effects.law
    if law.viscous or law.plastic or law.damping_ratio:
        names[2] = "contact and dissipated"
    axes.stackplot(t, sphere, plate, contact, labels=names, colors=(BLUE, BROWN, GREEN), alpha=0.75)
    axes.legend(frameon=True, loc="center right")
    axes.set_ylim(0.0, 1.0)


def _restitution(axes: "Axes", result: Result) -> None:
    """Draw the restitution of the impact and that of an infinite plate."""
    curve = [infinite_plate_impact(float(number))[1] for number in ZENER]
    axes.semilogx(ZENER, curve, color="0.4", linewidth=1.2, label="infinite plate (Zener, 1941)")
    number = zener_number(result.model)
    axes.plot([number], [result.restitution], "o", color=BROWN, label="this impact")
    frame(axes, r"Zener parameter $\lambda$ [1]", "coefficient of restitution $e$ [1]")
    axes.set_ylim(0.0, 1.05)
    axes.legend(loc="lower left", fontsize=8, frameon=False)
