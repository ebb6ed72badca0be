"""A result as text: summary, details, and HTML for a notebook."""

import math
from collections.abc import Iterator
from html import escape
from typing import TYPE_CHECKING

from derivation.engine.text import aligned, paragraph
from derivation.scene.contact_law.yield_warnings import assumed_yield_stress, risen_pressure
from derivation.scene.dynamic.stretching_error import USABLE, stress_change
from derivation.scene.output.error_causes import (
    MEASURED,
    PLATE,
    SPHERE,
    STRETCHING,
    TIMES,
    causes,
)
from derivation.scene.output.result_errors import largest_within_error, stated_accuracy, unknown
from derivation.scene.quantity import (
    counted,
    digits_of,
    percent,
    prefixed,
    rounded_up,
    significant,
    up_to,
)

if TYPE_CHECKING:
    from derivation.scene.dynamic.wave_motion import DynamicImpact
    from derivation.scene.result import Result

UNLIKE = 0.5
"""Ratio of the smallest to the largest model error, below which the result with the largest is
named."""
NEGLIGIBLE = 1e-3
"""Ratio of a part of the model error to the total, below which its cause is not named, except for
the edge."""
INCLUDES = "which effects.stretching = true includes"
"""Remedy of a model error by stretching of the plate."""
CONTACT_HEADS = "#start [s]", "#end [s]", "#impulse [N s]", "#peak force [N]", "#speed ratio"
"""Column heads of the table of contacts."""


def quantities(result: "Result") -> list[tuple[str, str, str]]:
    """Return name, value with significant digits, and unit with SI prefix of each result."""
    rows = result.numbers()
    contacts = len(result.dynamics.inertia.contacts) if result.dynamics is not None else 1
    if contacts == 1:  # the total time is the contact time
        rows = [row for row in rows if row[0] != "total_time"]
    return [
        (_named(name, contacts, result), *prefixed(value, unit, result.digits_of_result(name)))
        for name, value, unit in rows
    ]


def _named(name: str, contacts: int, result: "Result") -> str:
    """Return the displayed name of a result."""
    if name == "contact_time" and contacts > 1:
        return f"contact time (first of {contacts})"
    if name == "max_tensile_stress" and result.tensile_stress.static:
        return "max tensile stress (static)"
    return name.replace("_", " ")


def plain(result: "Result") -> str:
    """Return name, value and SI unit of each result, one result per line."""
    lines = []
    for name, value, unit in result.numbers():
        digits = result.digits_of_result(name)
        number = significant(value, digits) if math.isfinite(value) and digits else "unknown"
        lines.append(f"{name} {number} {unit}")
    return "\n".join(lines)


def short(result: "Result") -> str:
    """Return the results with error bound and included effects."""
    rows = quantities(result)
    names, values = (max(len(row[column]) for row in rows) for column in (0, 1))
    table = (f"{name:{names}}  {value:>{values}} {unit}".rstrip() for name, value, unit in rows)
    blocks = ["\n".join(table), "\n".join(map(paragraph, _remarks(result)))]
    for note in (result.unusable_note, result.incomplete_note):
        if note:
            blocks.insert(0, paragraph(note))
    if result.comparison:
        blocks.append(result.comparison.to_text())
    return "\n\n".join(blocks)


def _remarks(result: "Result") -> Iterator[str]:
    """Yield the lines below the table of results."""
    accuracy, others = stated_accuracy(result)
    larger = "".join(
        f", of {name.replace('_', ' ')} {rounded_up(bound)}"
        for name, bound in others.items()
        if digits_of(bound)
    )
    errors = f"{larger}{_model_error(result)}{_stress_error(result)}"
    yield f"Accuracy: {accuracy.summary}{_without_bound(result)}{errors}"
    rise = risen_pressure(result.effects.law, result.max_contact_radius)
    if rise is not None:
        yield (
            "Not included: beyond the onset of yield of a ductile solid, restitution and force "
            f"may be larger by factors of about {rise.restitution:.2g} and {rise.force:.2g} (see "
            "the warning)"
        )
    if result.complete and not digits_of(accuracy.bound) and math.isfinite(accuracy.bound):
        yield f"Unknown: the error by {accuracy.largest_part} may be as large as the results"
    elif not digits_of(result.model_error) and not result.unusable_note:
        yield "Uncertain: the model error may be as large as the results"
    elif without := unknown(result):
        names = ", ".join(name.replace("_", " ") for name in without)
        named = any(name in result.accuracy.outputs for name in without)
        why = "" if named else ", which accuracy.outputs does not name"
        them = "it" if len(without) == 1 else "them"
        yield f"Unknown: {names}{why}: omitted effects or modes may change {them} by 100 % or more"
    yield f"Effects: {result.effects.summary}"
    if result.energy_balance is not None and result.complete:
        error = result.bound_of("restitution") + result.model_errors["restitution"]
        yield f"Energy: {result.energy_balance.in_words(error)}"
    if result.measured_note:
        yield f"Measured: {result.measured_note}"
    if result.disabled_note:
        yield result.disabled_note
    if math.isnan(result.max_tensile_stress):
        yield (
            "Tensile stress: unknown, because the contact ends before a pressure wave has returned "
            "from the back face"
        )
    if result.strength_note:
        yield f"Strength: {result.strength_note}"
    if not result.effects.law.viscous:  # only the elastic part of its pressure is computed
        largest = largest_within_error(result, "max_pressure")
        # A yielding contact does not exceed the limit of the softer body.
        pressure = min(largest, result.effects.law.pressure_limit)
        bending = largest_within_error(result, "max_tensile_stress")
        assumed = assumed_yield_stress(result.scene, pressure, bending)
        if assumed:
            yield f"Yield: {assumed}"


def _without_bound(result: "Result") -> str:
    """Return why the modes that the scene gives have no error bound; empty if there is one."""
    motion = result.dynamics
    if motion is None or not result.complete:
        return ""
    from derivation.scene.dynamic.mode_count import least_modes

    if not (least := least_modes(motion.law)):
        return ""
    modes = motion.law.model.inertia.modes
    return (
        f", because the {counted(modes, 'mode')} of inertia.modes are slower than the contact "
        f"(a useful bound needs about {2 * least})"
    )


def _model_error(result: "Result") -> str:
    """Return the largest model error, with the result that has it if others have less."""
    if not result.model_error:
        return ""
    errors = result.model_errors
    name = _with_largest_error(result)
    others = min(errors[output] for output in result.effects.outputs)
    notes = [name.replace("_", " ")] if others < UNLIKE * result.model_error else []
    if result.model_error >= USABLE:
        parts = causes(result, name)
        largest = max(parts, key=parts.__getitem__)
        notes.append(f"mostly by {_in_words(result)[largest]}")
        if largest == STRETCHING and _can_stretch(result):
            notes.append(INCLUDES)
    remark = f" ({', '.join(notes)})" if notes else ""
    return f", model error {up_to(result.model_error)}{remark}"


def _can_stretch(result: "Result") -> bool:
    """Return whether the plate does not stretch, but can."""
    law = result.effects.law
    return law.dynamic and not (law.stretches or law.model.inertia.infinite_plate)


def _with_largest_error(result: "Result") -> str:
    """Return the requested output with the largest model error."""
    return max(result.effects.outputs, key=lambda output: result.model_errors[output])


def _in_words(result: "Result") -> dict[str, str]:
    """Return the causes of a model error in words."""
    law, stretching = result.effects.law, "stretching of the plate"
    own = "plate and edge" if result.dynamics is not None else f"the {result.model.edge} edge"
    strains = "finite strains"
    if law.stretches:
        stretching = "the simplified stretching of the plate"
    return {
        PLATE: own,
        STRETCHING: stretching,
        SPHERE: f"the finite size of the sphere and {strains}" if law.softness else strains,
        TIMES: "different retardation times of sphere and plate",
        MEASURED: "the measurement of the restitution",
    }


def _stress_error(result: "Result") -> str:
    """Return the error of the tensile stress, which the bound does not include."""
    error = result.bound_of("max_tensile_stress") + result.tensile_stress.error
    if result.dynamics is None or not math.isfinite(error):
        return ""
    remark = "estimated"
    if error >= USABLE and _can_stretch(result):
        by_stretching = stress_change(result.effects.law, result.dynamics)
        if by_stretching >= 0.5 * error:
            said = INCLUDES in _model_error(result)
            remark += f", mostly by stretching of the plate{'' if said else f', {INCLUDES}'}"
    return f"; of max tensile stress {up_to(error)} ({remark})"


def model_note(result: "Result") -> str:
    """Return the model error as a sentence; empty if there is none."""
    if not result.model_error:
        return ""
    name = _with_largest_error(result)
    measured = (
        "measured against explicit finite-element simulations"
        if result.dynamics is not None
        else "measured against a 3-D elastic solution"
    )
    applies = result.dynamics is not None or result.effects.law.other_edge
    words = _in_words(result)
    parts = [
        f"of {words[cause]} ({measured if cause == PLATE else 'estimated'}) {percent(error)}"
        for cause, error in causes(result, name).items()
        if error >= NEGLIGIBLE * result.model_error or (cause == PLATE and applies)
    ]
    return (
        f"Not included in this bound: model error {up_to(result.model_error)} in "
        f"{name.replace('_', ' ')}, {', '.join(parts)}"
    )


def details(result: "Result") -> str:
    """Return the summary, then method and bound, the effects table, and the table of contacts."""
    notes = [str(result.accuracy), model_note(result)]
    blocks = [short(result), "\n".join(paragraph(text) for text in notes if text)]
    blocks.append(f"Effects\n\n{result.effects.to_text()}")
    if result.dynamics is not None:
        blocks.append(_contacts(result.dynamics))
    return "\n\n".join(blocks)


def with_warnings(text: str, result: "Result") -> str:
    """Return a text with the warnings below it."""
    return "\n\n".join([text, *(paragraph(f"Warning: {x}") for x in result.warnings)])


def _contacts(dynamics: "DynamicImpact") -> str:
    """Return the table of contacts, and how the impact ended."""
    title = "Contacts (speed ratio: approach speed / impact speed)"
    notes = "\n".join(map(paragraph, dynamics.notes()))
    return f"{title}\n\n{aligned(CONTACT_HEADS, dynamics.lines())}\n\n{notes}"


def html(result: "Result") -> str:
    """Return the summary and warnings as HTML; the details are folded."""
    cells = (
        f"<tr><td>{name}</td><td style='text-align:right'>{value}</td><td>{unit}</td></tr>"
        for name, value, unit in quantities(result)
    )
    notes = result.incomplete_note, result.unusable_note
    first = "".join(f"<p><b>{escape(note)}</b></p>" for note in notes if note)
    remarks = "".join(f"<p>{escape(text)}</p>" for text in _remarks(result))
    paper = result.comparison.to_html() if result.comparison else ""
    warnings = "".join(f"<p><b>Warning:</b> {escape(text)}</p>" for text in result.warnings)
    notes = (str(result.accuracy), model_note(result))
    more = "".join(f"<p>{escape(text)}</p>" for text in notes if text) + result.effects.to_html()
    if result.dynamics is not None:
        more += result.dynamics.to_html()
    folded = f"<details><summary>Details</summary>{more}</details>"
    return f"{first}<table>{''.join(cells)}</table>{remarks}{paper}{warnings}{folded}"
