"""Assembles the code of one scene: modules to copy, constants of its law, its docstring.

Laws with a closed form keep it. All others are represented by polynomials of the contact radius a
on panels: p, the force over that of Hertz's law, and F, the increase of the indentation over that
of Hertz's law,

    P = K a^3 p,   delta = (a^2/R) (1 + a F),   K = (4/3) E*/R

Panels are halved until the last coefficients are of the size of rounding.
"""

import json
import math
import textwrap
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial.chebyshev import cheb2poly

from derivation.scene.code.compose import WIDTH, summary
from derivation.scene.contact_law.edge_remainder import edge_remainder
from derivation.scene.contact_law.law import ContactLaw
from derivation.scene.contact_law.limits import last_radius
from derivation.scene.effects import BY_NAME
from derivation.scene.errors import SceneError
from derivation.scene.impact import selected_effects, simulate
from derivation.scene.numerics.crossing import last_true
from derivation.scene.numerics.quadrature import NODES
from derivation.scene.output.answer import model_note
from derivation.scene.quantity import rounded_up
from derivation.scene.quasi_static.closed_form import bend_of, only_bends
from derivation.scene.quasi_static.motion import Motion
from derivation.scene.quasi_static.viscous_law import bending_of
from derivation.scene.result import Result
from derivation.scene.scene import Scene
from derivation.scene.selection import method_selection
from derivation.scene.selection.effect_selection import SelectedEffects
from generated.arrays import Double as Array
from generated.simple_impact_numbers import HERTZ_TIME

COEFFICIENTS = 16
"""Number of coefficients of a polynomial."""
CONVERGED, NARROWEST = 5e-14, 1e-3
"""Largest accepted ratio of the last coefficients to the largest; smallest panel width [1]."""
POINTS, SMALL = 60, 1e-5
"""Number of contact radii at which code and law are compared, and the smallest over the limit."""
TOLERANCE = 1e-10
"""Largest allowed relative difference between code and law."""
LEAST_SLOPE = 0.1
"""Smallest slope of the indentation over that of Hertz's law: rounding errors of the contact radius
grow with its inverse [1]."""
STIFFEST = 2e-3
"""Smallest time scale of the internal state over the contact time for explicit steps [1]."""
STIFF = (
    "There is no function `impact`: a viscoelastic contact on a plate with elastic bending has an "
    "internal state (see `elastic_rate`), which is too stiff here for explicit time steps. Use "
    "`platecontact simulate` instead."
)
_HALVINGS = 50


class PanelTable(NamedTuple):
    """Polynomial coefficients in s from -1 to 1, the constant first, with a row for each panel.

    `ends` are the ends of the panels [m], `growth` is F, and `force` is p or None if p = 1.
    """

    ends: Array
    growth: Array
    force: Array | None


class Recipe(NamedTuple):
    """The law of a scene, its impact, and the parts of its code.

    `parts` are modules of `runtime`, `numbers` the constants of `runtime.data`, and `head` the
    lines of the docstring.
    """

    law: ContactLaw
    motion: Motion
    parts: tuple[str, ...]
    numbers: dict[str, object]
    head: tuple[str, ...]


def recipe(scene: Scene) -> Recipe:
    """Return the parts of the code of a scene.

    Raises
    ------
    SceneError
        As `simulate` does, and if the force is no function of indentation and rate.
    """
    _check_quasi_static(scene)
    result = simulate(scene)
    law: ContactLaw = result.effects.law
    motion = method_selection.moved(law)
    compliance = _compliance(law, motion.max_contact_radius)
    end = end_of(law, motion.max_contact_radius)
    table = tabulated(law, end) if _kind(law) == "table" else None
    form = "bent_" if compliance else ""
    stepped = not compliance or _slowness(law, motion, compliance) > STIFFEST
    parts = (
        *((f"{form}viscous_force", "elastic_force") if law.viscous else ("force",)),
        "stiffness",
        *(("inverse",) if table else ()),
        *(_impact_parts(law, form) if stepped else ()),
        *_law_parts(law, table),
        "domain",
    )
    return Recipe(
        law,
        motion,
        ("outcome", *parts) if stepped else parts,
        _numbers(law, motion, end, table) | {"COMPLIANCE": compliance},
        _head(scene, result, parts, stepped),
    )


def _law_parts(law: ContactLaw, table: PanelTable | None) -> tuple[str, ...]:
    """Return the modules of the contact law."""
    if table is None:
        return (f"{_kind(law)}_law",)
    return ("growth_law" if table.force is None else "pressure_law", "panels")


def _impact_parts(law: ContactLaw, form: str) -> tuple[str, ...]:
    """Return the modules of the impact: by time steps, from energy, or in closed form."""
    weight = "_in_gravity" if law.gravity else ""
    if law.viscous:
        return ("viscous_impact", f"{form}viscous_motion", f"acceleration{weight}", "steps")
    if law.gravity or not law.hertzian:
        return (f"energy_impact{weight}", "energy", f"acceleration{weight}")
    return ("hertz_impact",)


def _numbers(
    law: ContactLaw, motion: Motion, end: float, table: PanelTable | None
) -> dict[str, object]:
    """Return the constants of the law and of the impact."""
    model, last = law.model, np.array([end])
    numbers: dict[str, object] = {
        "R": model.R,
        "MODULUS": law.modulus,
        "BEND": _bend(law) if _kind(law) == "bent" else 0.0,
        "MASS": model.m,
        "SPEED": model.v0,
        "GRAVITY": law.gravity,
        "RETARDATION_TIME": model.retardation_time,
        "LIMIT": end,
        "MAX_INDENTATION": float(law.indentation(last, law.at(last))[0]),
        "LARGEST_RADIUS": motion.max_contact_radius,
        "RISE": motion.max_indentation / model.v0,
        "HERTZ_TIME": HERTZ_TIME,
        "NODES": NODES[2] if law.spherical else NODES[1],
    }
    if table is not None:
        numbers |= {"ENDS": table.ends, "GROWTH": table.growth, "FORCE": table.force}
    return numbers


def _check_quasi_static(scene: Scene) -> None:
    """Reject plate inertia and plasticity, where the force depends on the previous motion.

    Raises
    ------
    SceneError
        If the scene requires inertia or plasticity.
    """
    law = selected_effects(scene)[1].law
    if law.plastic:
        raise SceneError(
            "effects.plasticity: expected false, because in the code of a scene the force is a "
            "function of indentation and rate, got a plastic contact, whose force depends on the "
            "previous peak force; use `platecontact simulate --csv` for the impact and "
            "`platecontact indent` for loading, or set effects.plasticity = false and add "
            "plastic_indentation (loading) or flattening and dent (unloading) of "
            "generated.plasticity"
        )
    if law.dynamic:
        raise SceneError(
            "effects.inertia: expected false, because the code of a scene is for a quasi-static "
            "plate, got a plate with inertia; set effects.inertia = false"
        )


def _kind(law: ContactLaw) -> str:
    """Return the form of the law: Hertz, Hertz with bending, or polynomials."""
    if law.hertzian:
        return "hertz"
    return "bent" if only_bends(law) else "table"


def _bend(law: ContactLaw) -> float:
    """Return the bending deflection over Hertz's indentation, over the contact radius [1/m]."""
    return float(bend_of(law)[0]) / law.model.h


def _compliance(law: ContactLaw, a: float) -> float:
    """Return the elastic compliance [m/N] in a viscoelastic contact; 0 if there is none.

    Raises
    ------
    SceneError
        If the elastic deflection is not proportional to the force.
    """
    if not law.viscous:
        return 0.0
    bent = bending_of(law, a)
    if bent.other_edge:
        raise SceneError(
            "plate.edge: expected the paper's edge for the code of a viscoelastic contact with "
            f"bending, got a {law.model.edge} edge, with which the elastic deflection is not "
            "proportional to the force; set effects.edge = false, or remove retardation_time"
        )
    return float(bent.at(law.force(np.array([a]), law.at(np.array([a]))))[1][0])


def _slowness(law: ContactLaw, motion: Motion, compliance: float) -> float:
    """Return the time scale of the internal state over the contact time [1]."""
    a = np.array([motion.max_contact_radius])
    scale = law.model.retardation_time * compliance * float(law.stiffness(a, law.at(a))[0])
    return scale / motion.contact_time


def end_of(law: ContactLaw, a: float) -> float:
    """Return the largest contact radius [m] of the code, from the radius a of an impact.

    It is the limit of the law, or a smaller one where the model of a simply supported or clamped
    edge is not accurate, or where the indentation hardly grows with the radius, as on a plate
    without bending.
    """
    last = last_radius(law)

    def sound(a: float) -> bool:
        try:
            if law.other_edge:
                edge_remainder(law.model, a)
        except SceneError:
            return False
        return float(law.at(np.array([a])).slope[0]) >= LEAST_SLOPE

    return last if sound(last) else last_true(sound, a, last, _HALVINGS)


def tabulated(law: ContactLaw, last: float) -> PanelTable:
    """Return polynomials of the law on panels up to a contact radius [m]."""
    odd, step = np.arange(2 * COEFFICIENTS - 1, 0, -2), np.pi / (2 * COEFFICIENTS)
    nodes = np.cos(step * odd)
    # The polynomials are orthogonal over their nodes. Sums, unlike matrix products, do not depend
    # on the linear-algebra library. Whole turns are removed.
    turned = np.outer(np.arange(COEFFICIENTS), odd) % (4 * COEFFICIENTS)
    basis = 2.0 / COEFFICIENTS * np.cos(step * turned)
    basis[0] *= 0.5
    ends, rows, todo = [0.0], [], [(0.0, last)]
    while todo:
        low, high = todo.pop()
        a = low + (high - low) * (1.0 + nodes) / 2.0
        shape = law.at(a)
        values = np.array([(shape.depth - 1.0) / a, shape.force])
        coefficients = np.sum(basis[:, :, None] * values.T, axis=1)
        tail = np.max(np.abs(coefficients[-2:]), axis=0)
        off = max(tail[0] * a[-1] / shape.depth[-1], tail[1] / np.max(shape.force))
        if off > CONVERGED and high - low > NARROWEST * last:
            middle = 0.5 * (low + high)
            todo += [(middle, high), (low, middle)]
            continue
        ends.append(high)
        rows.append(np.array([_powers(column) for column in coefficients.T]))
    growth, force = np.stack(rows, axis=1)
    return PanelTable(np.array(ends), growth, force if law.spherical or law.solved else None)


def _powers(series: Array) -> Array:
    """Return the powers of a Chebyshev series; `cheb2poly` drops zeros at the end."""
    powers: Array = np.zeros(len(series))
    coefficients = cheb2poly(series)
    powers[: len(coefficients)] = coefficients
    return powers


def _head(scene: Scene, result: Result, parts: tuple[str, ...], stepped: bool) -> tuple[str, ...]:
    """Return the docstring: scene, included and omitted effects, error bound, warnings."""
    selected = result.effects
    keys = [
        f"[{table}] " + ", ".join(f"{key} = {json.dumps(value)}" for key, value in keys.items())
        for table, keys in scene.to_json().items()
    ]
    included = [
        f"{row.name}: {BY_NAME[row.name].equation}; "
        f"{row.parameter} = {row.parameter_value:.3g}, {row.reason}"
        for row in selected.rows
        if row.included and BY_NAME[row.name].selectable  # other rows are not effects of the law
    ]
    omitted = [
        f"{row.name}: "
        + ("" if math.isnan(row.parameter_value) else f"{_bound(row.bound)}; ")
        + row.reason
        for row in selected.rows
        if not row.included
    ]
    notes = (*result.warnings, *filter(None, [model_note(result)]))
    title = f"Contact law{' and impact' if stepped else ''} of one scene"
    title += ": a sphere striking a plate, in SI units; requires only NumPy."
    formula = next(summary(part) for part in parts if part.endswith("_law"))
    return (
        title,
        *("", "Law::", "", f"    {formula}"),
        *("", "Scene:", "", *_wrapped(keys)),
        *("", "Included effects:", "", *_wrapped(included)),
        *("", "Omitted effects:", "", *_wrapped(omitted)),
        *("", *textwrap.wrap(_omission(selected, result), WIDTH)),
        *(("", "Validity:", "", *_wrapped(notes)) if notes else ()),
        *(() if stepped else ("", *textwrap.wrap(STIFF, WIDTH))),
    )


def _omission(selected: SelectedEffects, result: Result) -> str:
    """Return the bound on the change by omitted effects, in words."""
    if not selected.error:
        return "No applicable effect is omitted, unless the scene disables it."
    deepest = result.max_indentation
    return (
        "The omitted effects, except those disabled in the scene, change each result of this "
        f"impact by at most {rounded_up(selected.error)} (tolerance {selected.rtol:.3g}). This "
        f"bound is valid up to the largest indentation of this impact, {deepest:.6g} m. The same "
        "effects are used for larger indentations, up to MAX_INDENTATION, where the bound may be "
        "exceeded."
    )


def _bound(bound: float) -> str:
    return f"max. change {rounded_up(bound)}" if math.isfinite(bound) else "no bound"


def _wrapped(items: list[str] | tuple[str, ...]) -> list[str]:
    """Return list items, wrapped to the width of the text."""
    return [
        line
        for item in items
        for line in textwrap.wrap(item, WIDTH, initial_indent="- ", subsequent_indent="  ")
    ]


def errors(recipe: Recipe, module: Mapping[str, Any]) -> dict[str, float]:
    """Return the relative differences between code and law (restitution: absolute).

    Parameters
    ----------
    recipe
        The parts of the code.
    module
        The names that the code defines.

    Raises
    ------
    SceneError
        If a difference is too large, as is possible for extreme scenes.
    """
    law = recipe.law
    small, even = np.geomspace(SMALL, 1.0, POINTS), np.linspace(0.01, 1.0, POINTS)
    a = module["LIMIT"] * np.unique(np.append(small, even))
    shape = law.at(a)
    delta = np.minimum(law.indentation(a, shape), module["MAX_INDENTATION"])  # exact at the limit
    static = module["elastic_force" if "elastic_force" in module else "force"]
    differences = {
        "force": (static(delta), law.force(a, shape)),
        "stiffness": (module["stiffness"](delta), law.stiffness(a, shape)),
        "contact_radius": (module["contact_radius"](delta), a),
    }
    worst = {name: float(np.max(np.abs(x / y - 1.0))) for name, (x, y) in differences.items()}
    if "impact" in module:
        numbers, reference = np.array(module["impact"]()), np.array(recipe.motion.numbers)
        worst["impact"] = float(np.max(np.abs(numbers - reference) / np.append(reference[:4], 1.0)))
    for name, error in worst.items():
        if not error <= TOLERANCE:
            raise SceneError(
                f"scene: expected code with a {name.replace('_', ' ')} accurate to "
                f"{TOLERANCE:g}, got an error of {error:.1e}; use less extreme values"
            )
    return worst
