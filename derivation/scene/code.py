"""What the code for one scene is made of: modules to copy, the numbers of its law, its head.

Effects that have a closed form keep it. All others together become polynomials of the contact
radius a on panels: p, the force over Hertz's at that radius, and F, by which the indentation over
Hertz's grows,

    P = K a^3 p,   delta = (a^2/R) (1 + a F),   K = (4/3) E*/R

Panels are halved until the last coefficients are rounding.
"""

import json
import math
import textwrap
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial.chebyshev import cheb2poly

from derivation.scene import method_selection
from derivation.scene.compose import WIDTH, summary
from derivation.scene.edge_remainder import edge_remainder
from derivation.scene.effect_selection import SelectedEffects
from derivation.scene.effects import BY_NAME
from derivation.scene.effects.effect import Array
from derivation.scene.impact import selected_effects, simulate
from derivation.scene.law import ContactLaw
from derivation.scene.limits import last_radius
from derivation.scene.motion import Motion
from derivation.scene.quadrature import NODES
from derivation.scene.result import Result
from derivation.scene.scene import Scene, SceneError
from derivation.scene.viscous_law import bending_of

COEFFICIENTS = 16
"""Of a panel's polynomial."""
SETTLED, NARROWEST = 5e-14, 1e-3
"""Last coefficients over the largest that are small enough; least width of a panel [1]."""
POINTS, SMALL = 60, 1e-5
"""Contact radii at which code is compared with the law, and the least of them over its limit."""
WRONG = {"force": 1e-10, "stiffness": 1e-6, "contact_radius": 1e-10, "impact": 1e-10}
"""Relative difference from the law above which code is not given out.

The law's own stiffness, the pressure solved for, is right to 1e-7 alone at a = 0.99 R."""
STIFFEST = 2e-3
"""Least time scale, over the contact time, of an inner state that explicit steps follow [1]."""
STIFF = (
    "There is no `impact`: the contact is viscoelastic and bending is not, so that the contact has "
    "an inner state, see `elastic_rate`, too stiff here for explicit steps; `platecontact "
    "simulate` follows it."
)
_HALVINGS = 50


class PanelTable(NamedTuple):
    """Coefficients on panels, a row each, of s from -1 to 1, the constant first.

    `ends` are the contact radii [m] where panels begin and end; `growth` is F, `force` is p, or
    None where that is 1.
    """

    ends: Array
    growth: Array
    force: Array | None


class Recipe(NamedTuple):
    """The law of a scene, its impact, and what its code is made of.

    `parts` are modules of `runtime`, `numbers` those of `runtime.data`, `head` the lines that say
    what is in the code.
    """

    law: ContactLaw
    motion: Motion
    parts: tuple[str, ...]
    numbers: dict[str, object]
    head: tuple[str, ...]


def recipe(scene: Scene) -> Recipe:
    """What the code of a scene is made of.

    Raises
    ------
    SceneError
        As `simulate` does, and where no force follows from indentation and rate.
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
    """Modules of the contact law."""
    if table is None:
        return (f"{_kind(law)}_law",)
    return ("growth_law" if table.force is None else "pressure_law", "panels")


def _impact_parts(law: ContactLaw, form: str) -> tuple[str, ...]:
    """Modules of the impact: by steps, from energy, or in closed form."""
    weight = "_in_gravity" if law.gravity else ""
    if law.viscous:
        return ("viscous_impact", f"{form}viscous_motion", f"acceleration{weight}", "steps")
    if law.gravity or not law.hertzian:
        return (f"energy_impact{weight}", "energy", f"acceleration{weight}")
    return ("hertz_impact",)


def _numbers(
    law: ContactLaw, motion: Motion, end: float, table: PanelTable | None
) -> dict[str, object]:
    """The numbers of the law and of the impact."""
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
        "HERTZ_TIME": 0.8 * math.sqrt(math.pi) * math.gamma(0.4) / math.gamma(0.9),
        "NODES": NODES[2] if law.spherical else NODES[1],
    }
    if table is not None:
        numbers |= {"ENDS": table.ends, "GROWTH": table.growth, "FORCE": table.force}
    return numbers


def _check_quasi_static(scene: Scene) -> None:
    """Refuse plate inertia and yielding contacts, whose force depends on the motion so far.

    Raises
    ------
    SceneError
        If the scene calls for inertia or plasticity.
    """
    law = selected_effects(scene)[1].law
    if law.plastic:
        raise SceneError(
            "effects.plasticity: expected false for the code of a scene, whose force follows from "
            "indentation and rate alone, got a contact that yields, whose force depends on the "
            "largest force before; `platecontact simulate --csv` gives its impact and "
            "`platecontact indent` its loading, or write effects.plasticity = false and add to the "
            "code's indentation what generated.plasticity gives: plastic_indentation on loading, "
            "flattening and dent on unloading"
        )
    if law.dynamic:
        raise SceneError(
            "effects.inertia: expected false for the code of a scene, whose plate is quasi-static, "
            "got a plate with inertia; write effects.inertia = false"
        )


def _kind(law: ContactLaw) -> str:
    """What the law's formula is: Hertz's, with bending added, or polynomials."""
    if law.hertzian:
        return "hertz"
    return "bent" if all(e.hertzian or e.bends for e in law.chosen) else "table"


def _bend(law: ContactLaw) -> float:
    """Deflection over Hertz's indentation, over the contact radius [1/m], of bending alone."""
    h = law.model.h
    return float(law.deflection(np.array([h])).depth[0]) / (1.0 + law.softness) / h


def _compliance(law: ContactLaw, a: float) -> float:
    """Deflection over force [m/N] of what is elastic in a viscous contact, 0 for none.

    Raises
    ------
    SceneError
        If it is not proportional to the force.
    """
    if not law.viscous:
        return 0.0
    bent = bending_of(law, a)
    if bent.law.other_edge:
        raise SceneError(
            "plate.edge: expected the paper's edge for the code of a viscous scene with bending, "
            f"as the deflection on a {law.model.edge} edge, which is elastic, is not proportional "
            "to the force; write effects.edge = false, or leave out retardation_time"
        )
    return float(bent.at(law.force(np.array([a]), law.at(np.array([a]))))[1][0])


def _slowness(law: ContactLaw, motion: Motion, compliance: float) -> float:
    """Time scale of a viscous contact's inner state over the contact time [1]."""
    a = np.array([motion.max_contact_radius])
    slack = law.model.retardation_time * compliance * float(law.stiffness(a, law.at(a))[0])
    return slack / motion.contact_time


def end_of(law: ContactLaw, a: float) -> float:
    """Contact radius [m] at which the code's range ends, from one in an impact's on.

    That of the law's limit, or before it where a held edge's model is not known to be right, or
    says that the plate gives way towards the sphere.
    """
    last = last_radius(law)
    if not law.other_edge:
        return last

    def sound(a: float) -> bool:
        try:
            edge_remainder(law.model, a)
        except SceneError:
            return False
        return float(law.at(np.array([a])).slope[0]) > 0.0

    low, high = a, last
    for _ in range(0 if sound(last) else _HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if sound(middle) else (low, middle)
    return last if sound(last) else low


def tabulated(law: ContactLaw, last: float) -> PanelTable:
    """Polynomials of the law on panels up to a contact radius [m]."""
    odd, step = np.arange(2 * COEFFICIENTS - 1, 0, -2), np.pi / (2 * COEFFICIENTS)
    nodes = np.cos(step * odd)
    # The polynomials are orthogonal over their nodes. Sums, unlike products of matrices, are the
    # same to the last bit whatever library does linear algebra. Whole turns are left out.
    turned = np.outer(np.arange(COEFFICIENTS), odd) % (4 * COEFFICIENTS)
    basis = 2.0 / COEFFICIENTS * np.cos(step * turned)
    basis[0] *= 0.5
    ends, rows, todo = [0.0], [], [(0.0, last)]
    while todo:
        low, high = todo.pop()
        a = low + (high - low) * (1.0 + nodes) / 2.0
        shape = law.at(a)
        values = np.array([(shape.depth - 1.0) / a, shape.force])
        found = np.sum(basis[:, :, None] * values.T, axis=1)
        tail = np.max(np.abs(found[-2:]), axis=0)
        off = max(tail[0] * a[-1] / shape.depth[-1], tail[1] / np.max(shape.force))
        if off > SETTLED and high - low > NARROWEST * last:
            middle = 0.5 * (low + high)
            todo += [(middle, high), (low, middle)]
            continue
        ends.append(high)
        rows.append(np.array([_powers(column) for column in found.T]))
    growth, force = np.stack(rows, axis=1)
    return PanelTable(np.array(ends), growth, force if law.spherical or law.solved else None)


def _powers(series: Array) -> Array:
    """Powers of a Chebyshev series, the same number of them: `cheb2poly` drops zeros at the end."""
    powers: Array = np.zeros(len(series))
    found = cheb2poly(series)
    powers[: len(found)] = found
    return powers


def _head(scene: Scene, result: Result, parts: tuple[str, ...], stepped: bool) -> tuple[str, ...]:
    """The module's head: the scene, effects included and omitted, tolerance, what to know."""
    selected = result.effects
    keys = [
        f"[{table}] " + ", ".join(f"{key} = {json.dumps(value)}" for key, value in keys.items())
        for table, keys in scene.to_json().items()
    ]
    included = [
        f"{row.name}: {BY_NAME[row.name].equation}; "
        f"{row.parameter} = {row.parameter_value:.3g}, {row.reason}"
        for row in selected.rows
        if row.included and BY_NAME[row.name].selectable  # what is only compared is not in the law
    ]
    omitted = [
        f"{row.name}: "
        + ("" if math.isnan(row.parameter_value) else f"{_bound(row.bound)}; ")
        + row.reason
        for row in selected.rows
        if not row.included
    ]
    notes = (*result.warnings, *([result.model_note] if result.model_note else []))
    title = f"Contact law{' and impact' if stepped else ''} of one scene"
    title += ": a sphere striking a plate, in SI units; needs NumPy alone."
    formula = next(summary(part) for part in parts if part.endswith("_law"))
    return (
        title,
        *("", "Law::", "", f"    {formula}"),
        *("", "Scene:", "", *_wrapped(keys)),
        *("", "Included effects:", "", *_wrapped(included)),
        *("", "Omitted effects:", "", *_wrapped(omitted)),
        *("", *textwrap.wrap(_promise(selected, result), WIDTH)),
        *(("", "To know:", "", *_wrapped(notes)) if notes else ()),
        *(() if stepped else ("", *textwrap.wrap(STIFF, WIDTH))),
    )


def _promise(selected: SelectedEffects, result: Result) -> str:
    """What the omitted effects may change."""
    if not selected.error:
        return "No applicable effect is omitted, unless the scene disables it."
    deepest = result.max_indentation
    return (
        "The omitted effects, unless the scene disables them, change each result of this "
        f"impact by at most {selected.error:.1e} (tolerance {selected.rtol:.3g}). This holds "
        f"up to its largest indentation, {deepest:.6g} m; beyond, up to MAX_INDENTATION, the "
        "effects stay the same."
    )


def _bound(bound: float) -> str:
    return f"max. change {bound:.1e}" if math.isfinite(bound) else "no bound"


def _wrapped(items: list[str] | tuple[str, ...]) -> list[str]:
    """Items of a list, broken into lines that fit below a margin."""
    return [
        line
        for item in items
        for line in textwrap.wrap(item, WIDTH, initial_indent="- ", subsequent_indent="  ")
    ]


def errors(of: Recipe, made: Mapping[str, Any]) -> dict[str, float]:
    """Relative differences of code from its law, absolute ones of the restitution.

    Parameters
    ----------
    of
        What the code is made of.
    made
        The names that the code defines.

    Raises
    ------
    SceneError
        If one is too large, as extreme scenes may make it.
    """
    law = of.law
    small, even = np.geomspace(SMALL, 1.0, POINTS), np.linspace(0.01, 1.0, POINTS)
    a = made["LIMIT"] * np.unique(np.append(small, even))
    shape = law.at(a)
    delta = np.minimum(law.indentation(a, shape), made["MAX_INDENTATION"])  # to the last bit
    static = made["elastic_force" if "elastic_force" in made else "force"]
    found = {
        "force": (static(delta), law.force(a, shape)),
        "stiffness": (made["stiffness"](delta), law.stiffness(a, shape)),
        "contact_radius": (made["contact_radius"](delta), a),
    }
    worst = {name: float(np.max(np.abs(x / y - 1.0))) for name, (x, y) in found.items()}
    if "impact" in made:
        told, truth = np.array(made["impact"]()), np.array(of.motion.numbers)
        worst["impact"] = float(np.max(np.abs(told - truth) / np.append(truth[:4], 1.0)))
    for name, error in worst.items():
        if not error <= WRONG[name]:
            raise SceneError(
                f"scene: expected code that repeats its {name.replace('_', ' ')} to "
                f"{WRONG[name]:g}, got {error:.1e}; give less extreme numbers"
            )
    return worst
