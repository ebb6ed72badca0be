"""Draws where each effect matters, over a/h and h/b, with the scene marked.

Sphere, materials and edge are the scene's; thickness and contact radius vary. A line is where
the effect's bound, over the slope of the whole law, equals the tolerance; on the side of the
label it matters.
"""

import io
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from derivation.scene.effects import EFFECTS
from derivation.scene.effects.effect import Array, Effect, Place
from derivation.scene.model import Model
from derivation.scene.plot import METADATA
from derivation.scene.result import Result

if TYPE_CHECKING:
    from matplotlib.figure import Figure

THICKNESSES = np.geomspace(1e-3, 10.0, 61)
"""h/b of the map."""
RADII = np.geomspace(1e-3, 6.0, 61)
"""a/h of the map."""
WITHOUT = {"hertz", "gravity", "viscosity", "inertia"}
"""Effects that are always there, or depend on the speed beside the contact."""
COLOURS = ("#1f4e79", "#b35806", "#1b7837", "#762a83", "#b2182b", "#01665e", "#e7298a")


def shares(model: Model, effect: Effect, radii: Array = RADII) -> Array:
    """The effect's bound of S at every a/h (rows) and h/b (columns); NaN beyond min(b, R)."""
    columns = []
    for eta in THICKNESSES:
        plate = replace(model, h=float(eta) * model.b)
        a = radii * plate.h
        inside = a < min(model.b, model.R)
        with np.errstate(all="ignore"):
            bound = effect.bound(plate, Place(a))
        columns.append(np.where(inside, np.maximum(bound.low, bound.up), np.nan))
    return np.array(columns).T


def figure(result: Result, rtol: float) -> "Figure":
    """The map of a scene as a Matplotlib figure, its largest contact marked."""
    from matplotlib.figure import Figure

    model = result.model
    drawn = [e for e in EFFECTS if e.name not in WITHOUT and not e.absent(model)]
    place = model.eta, result.max_contact_radius / model.h
    # From the scene's own contact on, if that is smaller.
    radii = np.geomspace(min(RADII[0], place[1] / 2), RADII[-1], RADII.size)
    found = {effect.name: shares(model, effect, radii) for effect in drawn}
    whole = 1.0 + sum(np.where(np.isfinite(x), x, 0.0) for x in found.values())
    made = Figure(figsize=(7.5, 6.0), layout="constrained")
    axes = made.subplots()
    for colour, (name, share) in zip(COLOURS, found.items(), strict=False):
        ratio = np.where(np.isinf(share), 1.0, share / whole)
        if np.nanmin(ratio) > rtol or np.nanmax(ratio) < rtol:
            everywhere = "everywhere" if np.nanmin(ratio) > rtol else "nowhere"
            axes.plot([], [], color=colour, label=f"{name}: {everywhere}")
            continue
        axes.contour(THICKNESSES, radii, ratio, levels=[rtol], colors=[colour])
        axes.contourf(THICKNESSES, radii, ratio, levels=[rtol, np.inf], colors=[colour], alpha=0.1)
        axes.plot([], [], color=colour, label=name)
    axes.plot(*place, marker="*", markersize=14, color="black", linestyle="none", label="the scene")
    axes.set(xscale="log", yscale="log", xlabel="h/b", ylabel="a/h")
    axes.set_xlim(min(THICKNESSES[0], place[0] / 2), max(THICKNESSES[-1], place[0] * 2))
    axes.set_ylim(radii[0], max(radii[-1], place[1] * 2))
    axes.set_title(f"where an effect's bound is above {rtol:g} of the law's slope", fontsize=10)
    made.legend(loc="outside lower center", ncols=4, fontsize=8, frameon=False)
    return made


def render(result: Result, rtol: float, suffix: str) -> bytes:
    """The map as the content of a file of a format, `.png`, `.svg` or `.pdf`."""
    import matplotlib as mpl

    suffix, stream = suffix.lower(), io.BytesIO()
    with mpl.rc_context({"svg.hashsalt": "platecontact", "svg.fonttype": "none"}):
        figure(result, rtol).savefig(
            stream, format=suffix[1:], dpi=150, metadata=METADATA[suffix] or None
        )
    return stream.getvalue()
