"""Tables of the report: the effect selection for example scenes."""

from collections.abc import Mapping
from typing import Any

from derivation.engine.report.latex import code, escape, prose
from derivation.scene import explain
from derivation.scene.effects import EFFECTS
from derivation.scene.scene import Scene

HEADS = ("effect", "parameter", "value", "max. change", "status", "reason")
"""Headings of the table, shorter than those of `platecontact explain`."""


def effects_context(scenes: Mapping[str, Scene]) -> dict[str, Any]:
    """Return all effects, and the selection for each scene."""
    return {
        "effects": [" & ".join([code(e.name), prose(e.adds), escape(e.source)]) for e in EFFECTS],
        "heads": HEADS,
        "scenes": [scene_context(name, scene) for name, scene in scenes.items()],
    }


def scene_context(name: str, scene: Scene) -> dict[str, Any]:
    """Return the table of effects of a scene, and a sentence that states the selection."""
    explanation = explain(scene)
    rows = [
        " & ".join(
            [code(effect), code(parameter), *map(cell, (value, bound)), status, prose(reason)]
        )
        for effect, parameter, value, bound, status, reason in explanation.effects.lines()
    ]
    return {
        "name": name,
        "rows": rows,
        "says": sentence(str(explanation)),
        "notes": [_with_code(note) for note in explanation.notes],
    }


def _with_code(text: str) -> str:
    """Return a sentence as LaTeX, with text between backticks in typewriter type."""
    parts = text.split("`")
    return "".join(code(part) if odd % 2 else prose(part) for odd, part in enumerate(parts))


def cell(text: str) -> str:
    """Return a cell of the table; very small and large numbers as powers of ten."""
    mantissa, e, power = text.partition("e")
    if not (e and power.lstrip("+-").isdigit()):
        return f"${text}$" if text.startswith("-") else text
    return rf"${mantissa}\cdot10^{{{int(power)}}}$" if int(power) else mantissa


def sentence(text: str) -> str:
    """Return a text with effect names in typewriter and numbers as powers of ten."""
    head, stop, rest = text.partition(". ")
    label, _, names = head.partition(": ")
    shown = ", ".join(code(name) for name in names.split(", "))
    return f"{label[:1].upper() + label[1:]}: {shown}{stop}{prose(rest)}"
