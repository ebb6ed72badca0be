"""Draws for which a/h and h/b the tolerance needs each effect, with the scene marked.

Sphere, materials, edge and tolerance are those of the scene. Thickness and speed vary; the speed is
that which gives the contact radius on a quasi-static plate. For each point the effects are selected
as for the scene itself (`selection.select`), so that the map agrees with `explain`.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from textwrap import fill
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.contact_law.limits import energy_of
from derivation.scene.effects import EFFECTS, PAPER
from derivation.scene.errors import SceneError
from derivation.scene.kernels import Numbers
from derivation.scene.model import Model
from derivation.scene.output.plot import saved
from derivation.scene.quasi_static.motion import largest_radius
from derivation.scene.result import Result
from derivation.scene.rows.selection import CLEAR, prepare
from derivation.scene.selection.candidates import Candidates, candidates_of
from derivation.scene.selection.selection import Rows, selections
from generated.arrays import Double as Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

THICKNESSES = np.geomspace(1e-3, 10.0, 25)
"""h/b of the map."""
RADII = np.geomspace(1e-3, 6.0, 25)
"""a/h of the map."""
COLOURS = ("#1f4e79", "#b35806", "#1b7837", "#762a83", "#b2182b", "#01665e", "#e7298a")
CHOICES = {"auto": "", True: " (enabled in the scene)", False: " (disabled in the scene)"}
"""Remark in the legend by the choice of the scene."""
OUTSIDE: dict[str, Any] = {"facecolor": "0.88", "edgecolor": "0.78", "hatch": "///"}
"""Grey with lines of points outside the range of the contact law, unlike any shading."""
REJECTED = "0.55"
"""Grey of points at which the scene is rejected."""
LABEL_WIDTH = 90
"""Largest number of characters of a line of the legend."""
TICKS = 9.0
"""Distance of the ticks on a line [pt]."""
MOST, SIDE = 100.0, 1.001
"""Largest ratio in the map, and smallest ratio where an effect is needed."""


@dataclass(frozen=True)
class Grid:
    """Result of the effect selection by thickness (columns) and contact radius (rows).

    Attributes
    ----------
    thicknesses, radii
        h/b and a/h, including those of the scene [1].
    ratios
        For each effect, its largest change of the results over the tolerance [1]: above 1 where it
        is needed, below 1 where it is not, NaN outside the range of the contact law and where the
        scene is rejected.
    rejected, reason
        Where the scene is rejected, and the reason at one of these points.
    """

    thicknesses: Array
    radii: Array
    ratios: dict[str, Array]
    rejected: NDArray[np.bool_]
    reason: str = ""


def drawn(result: Result) -> list[str]:
    """Return the names of the effects that the selection may include or omit."""
    model = _mapped(result)
    return [
        e.name
        for e in EFFECTS
        if e.selectable and not (e.always_included or e.not_applicable_reason(model))
    ]


def grid(result: Result, rtol: float) -> Grid:
    """Select the effects for all thicknesses and contact radii, at a tolerance [1]."""
    thicknesses, radii, known, points = _points(result)
    place, wanted = np.flatnonzero(known), result.scene.effects.model_dump()
    given = candidates_of(points.take(0), wanted)
    prepare(given, points)
    ratios = {name: np.full(known.shape, math.nan) for name in drawn(result)}
    applicable = [name for name in ratios if not given.reasons[name]]
    rejected, reason = np.zeros_like(known), ""
    for rows, needed, sizes in _sizes(given, points, rtol, result.effects.outputs):
        if isinstance(sizes, SceneError):
            rejected.flat[place[rows]], reason = True, str(sizes)
            continue
        for name in applicable:
            ratio = _ratio(sizes.get(name, math.inf), rtol, given.choice[name], name in needed)
            ratios[name].flat[place[rows]] = ratio
    return Grid(thicknesses, radii, ratios, rejected, reason)


def _points(result: Result) -> tuple[Array, Array, NDArray[np.bool_], Model]:
    """Return thicknesses, radii, the points in the range of the law, and their quantities.

    Points are those of all radii by all thicknesses; the quantities are columns.
    """
    model = _mapped(result)
    eta, wide = model.eta, result.max_contact_radius / model.h
    thicknesses = np.unique(np.append(THICKNESSES, eta))
    # The range includes the contact radius of the scene.
    low = min(RADII[0], wide / 2)
    radii = np.unique(np.append(np.geomspace(low, RADII[-1], RADII.size), wide))
    # By the paper's law the contact radius of the scene differs.
    try:
        stretch = largest_radius(_law(model)) / result.max_contact_radius
    except SceneError:
        stretch = math.nan
    half = np.where(thicknesses == eta, model.h, thicknesses * model.b)
    a, own = np.outer(radii, half), np.outer(radii == wide, thicknesses == eta)
    h = np.broadcast_to(half, a.shape)
    speed = _speed(_many(model, h=h), stretch * a.reshape(-1, 1)).reshape(a.shape)
    speed[own] = model.v0
    known = (own | (a < min(model.b, model.R))) & (speed > 0.0) & np.isfinite(speed)
    return thicknesses, radii, known, _many(model, h=h[known], v0=speed[known])


def _many(model: Model, **numbers: Array) -> Model:
    """Return a model with columns for some of its numbers."""
    columns: Any = {name: values.reshape(-1, 1) for name, values in numbers.items()}
    return replace(model, **columns)


def _sizes(
    given: Candidates, model: Model, rtol: float, outputs: Sequence[str], clear: float = CLEAR
) -> Iterator[tuple[Rows, frozenset[str], dict[str, Array] | SceneError]]:
    """Yield points with the same needed effects, these effects, and the sizes of all effects.

    Where the scene is rejected, the error replaces the sizes.
    """
    tolerances = np.full(np.size(model.v0), rtol)
    for branch, decided in selections(given, model, tolerances, outputs, clear=clear):
        if decided is None:  # rounding could decide
            for row in branch.rows.tolist():
                for _, needed, sizes in _sizes(given, model.take(row), rtol, outputs, clear=1.0):
                    yield np.array([row]), needed, sizes
        elif isinstance(decided, SceneError):
            yield branch.rows, branch.included, decided
        else:
            yield branch.rows, branch.included, decided.sizes(given, branch, outputs)


def _mapped(result: Result) -> Model:
    """Return the model at the points: they do not stretch only because the scene needs it."""
    model = result.model
    if not result.scene.effects.may_stretch:
        return model
    return replace(model, inertia=replace(model.inertia, stretching=False))


def _law(model: Model) -> ContactLaw:
    """Return the paper's law, which relates contact radius and speed."""
    return ContactLaw(replace(model, gravity=0.0), PAPER)


def _speed(model: Model, a: Array) -> Array:
    """Return the speeds [m/s] for largest contact radii [m] by the paper's law; NaN if none."""
    law = _law(model)
    with np.errstate(all="ignore"):
        energy = np.where(a < law.limit, energy_of(law, a), np.nan)
        return np.sqrt(2.0 * np.where(energy > 0.0, energy, np.nan) / model.m)


def _ratio(size: Numbers, rtol: float, choice: Any, needed: bool) -> Numbers:
    """Return the changes by an effect over the tolerance, above 1 if the effect is needed."""
    with np.errstate(over="ignore"):
        ratio = np.fmin(size / rtol, MOST)  # of an unknown change, too
    if choice is False:
        return ratio
    return np.maximum(ratio, SIDE) if needed else np.minimum(ratio, 1.0 / SIDE)


def lines(map_grid: Grid) -> dict[tuple[str, ...], Array]:
    """Return the ratios of the effects, grouped if they are needed at the same points."""
    groups: dict[bytes, list[str]] = {}
    for name, ratio in map_grid.ratios.items():
        groups.setdefault((ratio > 1.0).tobytes(), []).append(name)
    return {tuple(names): map_grid.ratios[names[0]] for names in groups.values()}


def figure(result: Result, rtol: float) -> "Figure":
    """Return the map of a scene as a Matplotlib figure."""
    from matplotlib.colors import ListedColormap
    from matplotlib.figure import Figure
    from matplotlib.patches import Patch

    point = result.model.eta, result.max_contact_radius / result.model.h
    map_grid, wanted = grid(result, rtol), result.scene.effects.model_dump()
    made = Figure(figsize=(7.5, 6.5), layout="constrained")
    axes = made.subplots()
    axes.set(xscale="log", yscale="log")
    axes.patch.set(**OUTSIDE)
    known = np.isfinite(np.array([*map_grid.ratios.values()])).any(axis=0)
    axes.contourf(
        map_grid.thicknesses, map_grid.radii, np.where(known, 0.0, np.nan), colors=["white"]
    )
    colours, constant = iter(COLOURS), dict[str, list[str]]()
    for names, ratio in lines(map_grid).items():
        label = ", ".join(name + CHOICES[wanted[name]] for name in names)
        finite = ratio[np.isfinite(ratio)]
        if not finite.size or finite.min() > 1.0 or finite.max() < 1.0:
            where = "everywhere" if finite.size and finite.min() > 1.0 else "nowhere"
            constant.setdefault(where, []).append(label)
            continue
        _line(axes, map_grid, ratio, next(colours), label)
    for where, labels in constant.items():
        axes.plot([], [], linestyle="none", label=f"{where}: {', '.join(labels)}")
    needed = result.scene.effects.may_stretch and result.effects.law.stretches
    scene = f"this scene{', which needs stretching' if needed else ''}"
    axes.plot(*point, marker="*", markersize=14, color="black", linestyle="none", label=scene)
    axes.set(xlabel="half-thickness / plate radius, $h/b$ [1]")
    axes.set(ylabel="largest contact radius / half-thickness, $a/h$ [1]")
    axes.set_xlim(min(THICKNESSES[0], point[0] / 2), max(THICKNESSES[-1], point[0] * 2))
    axes.set_ylim(map_grid.radii[0], max(map_grid.radii[-1], point[1] * 2))
    axes.set_title(
        "Shaded (the side with the ticks): omitting the effect\n"
        f"may change a result by more than {rtol:g} (relative)",
        fontsize=10,
    )
    handles, _ = axes.get_legend_handles_labels()
    handles.append(Patch(**OUTSIDE, label="outside the range of the contact law"))
    if map_grid.reason:
        axes.pcolormesh(
            *(map_grid.thicknesses, map_grid.radii),
            np.ma.masked_equal(map_grid.rejected, False),
            cmap=ListedColormap([REJECTED]), shading="nearest",
        )  # fmt: skip
        reason, _, _ = map_grid.reason.partition(", got ")
        label = f"rejected, for example because {reason}"
        handles.append(Patch(facecolor=REJECTED, label=label))
    for handle in handles:
        handle.set_label(fill(str(handle.get_label()), LABEL_WIDTH))
    made.legend(handles=handles, loc="outside lower center", fontsize=8, frameon=False)
    return made


def _line(axes: "Axes", map_grid: Grid, ratio: Array, colour: str, label: str) -> None:
    """Draw the line beyond which an effect is needed, with ticks and shading on that side."""
    from matplotlib.patheffects import withTickedStroke

    values = np.log(np.maximum(ratio, 1.0 / MOST))
    coordinates = map_grid.thicknesses, map_grid.radii, values
    axes.contourf(*coordinates, levels=[0.0, np.inf], colors=[colour], alpha=0.12)
    line = axes.contour(*coordinates, levels=[0.0], colors=[colour])
    # Matplotlib has the larger values on the left of a line.
    line.set_path_effects([withTickedStroke(spacing=TICKS, angle=90.0, length=0.8)])
    axes.plot([], [], color=colour, label=label)


def render(result: Result, rtol: float, suffix: str) -> bytes:
    """Return the map as the content of a file with the suffix `.png`, `.svg` or `.pdf`."""
    return saved(figure(result, rtol), suffix)
